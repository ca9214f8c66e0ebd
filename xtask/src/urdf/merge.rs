//! Links become bodies: those without mass are merged with what they are fixed to, and what is fixed to a root that does not float is ground.

use super::robot::{Joint, Kind, Link, Robot};
use nalgebra::IsometryMatrix3;

/// What the root link is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Root {
    /// The ground.
    Fixed,
    /// A body that floats.
    Floating,
}

/// Which body each link is part of.
#[derive(Debug)]
pub(super) struct Merged {
    /// The link that each body takes name, mass and inertia from; the first body is the root's, the others
    /// have the order of the file.
    pub(super) bodies: Vec<usize>,
    /// For each link its place.
    pub(super) places: Vec<Place>,
    /// Which links are no bodies of their own.
    pub(super) remarks: Vec<String>,
}

/// Where a link's frame is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Index into [`Merged::bodies`].
    pub(super) body: usize,
    /// The link's frame in the body's frame.
    pub(super) pose: IsometryMatrix3<f64>,
    /// The link's frame in the global frame, with all joints at zero.
    pub(super) zero: IsometryMatrix3<f64>,
}

/// Merges the links of a robot.
///
/// # Errors
/// Links that do not make a tree, and links that move without mass.
pub(super) fn merge(file: &str, robot: &Robot, root: Root) -> Result<Merged, Vec<String>> {
    let order = order(file, robot)?;
    let at_origin = Place { body: 0, pose: IsometryMatrix3::identity(), zero: IsometryMatrix3::identity() };
    let mut merging = Merging {
        robot,
        root,
        places: vec![None; robot.links.len()],
        bodies: Vec::new(),
        remarks: Vec::new(),
        problems: Vec::new(),
    };
    merging.place_root(order[0].1, at_origin, file);
    for (joint, link) in order.iter().skip(1) {
        merging.place(&robot.joints[*joint], *link, file);
    }
    let Merging { places, bodies, remarks, problems, .. } = merging;
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut sorted = bodies.clone();
    if let Some(others) = sorted.get_mut(1..) {
        others.sort_unstable();
    }
    let renumbered = |place: Place| {
        let link = bodies[place.body];
        Place { body: sorted.iter().position(|other| *other == link).unwrap_or(0), ..place }
    };
    let places = places.into_iter().flatten().map(renumbered).collect();
    Ok(Merged { bodies: sorted, places, remarks })
}

/// Links from the root to the leaves, each with the joint that carries it (any number for the root).
fn order(file: &str, robot: &Robot) -> Result<Vec<(usize, usize)>, Vec<String>> {
    let carriers = |link: usize| robot.joints.iter().filter(move |joint| joint.child == link);
    let problem = |link: &Link, words: String| format!("{file}:{}: link `{}` {words}", link.line, link.name);
    let mut problems = Vec::new();
    for (index, link) in robot.links.iter().enumerate() {
        let names: Vec<String> = carriers(index).map(|joint| format!("`{}`", joint.name)).collect();
        if names.len() > 1 {
            problems.push(problem(link, format!("is the child of several joints: {}", names.join(", "))));
        }
    }
    let roots: Vec<usize> = (0..robot.links.len()).filter(|link| carriers(*link).next().is_none()).collect();
    match roots.as_slice() {
        [] => problems.push(format!("{file}: no link is a root: every link is the child of a joint")),
        [_] => {}
        [_, others @ ..] => {
            let words = |link: &usize| {
                problem(&robot.links[*link], "is a second root: no joint has it as child".to_owned())
            };
            problems.extend(others.iter().map(words));
        }
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let mut order = vec![(usize::MAX, roots[0])];
    let mut next = 0;
    while next < order.len() {
        let parent = order[next].1;
        let children = robot.joints.iter().enumerate().filter(|(_, joint)| joint.parent == parent);
        order.extend(children.map(|(index, joint)| (index, joint.child)));
        next += 1;
    }
    let is_reached = |link: usize| order.iter().any(|(_, reached)| *reached == link);
    let cut_off = (0..robot.links.len()).filter(|link| !is_reached(*link));
    let problems: Vec<String> = cut_off
        .map(|link| {
            problem(&robot.links[link], "hangs in a circle of joints that no root carries".to_owned())
        })
        .collect();
    if problems.is_empty() { Ok(order) } else { Err(problems) }
}

struct Merging<'r> {
    robot: &'r Robot,
    root: Root,
    places: Vec<Option<Place>>,
    bodies: Vec<usize>,
    remarks: Vec<String>,
    problems: Vec<String>,
}

impl Merging<'_> {
    /// Places the root: the ground, or a body with its own mass or that of what is fixed to it, its link's frame at the origin.
    fn place_root(&mut self, link: usize, at_origin: Place, file: &str) {
        self.places[link] = match self.root {
            Root::Fixed => {
                self.bodies.push(link);
                Some(at_origin)
            }
            Root::Floating => {
                self.first_of_body(link, file).map(|(body, pose)| Place { body, pose, ..at_origin })
            }
        };
    }

    /// Places a link whose parent has been placed.
    fn place(&mut self, joint: &Joint, link: usize, file: &str) {
        let Some(parent) = self.places[joint.parent] else { return };
        let zero = parent.zero * joint.origin;
        let (is_fixed, has_mass) = (joint.kind == Kind::Fixed, self.robot.links[link].inertial.is_some());
        let name = &self.robot.links[link].name;
        let merged = Place { body: parent.body, pose: parent.pose * joint.origin, zero };
        self.places[link] = if is_fixed && (self.is_ground(parent) || !has_mass) {
            let carrier = &self.robot.links[self.bodies[parent.body]].name;
            let mass = if has_mass { ", its mass with it" } else { "" };
            self.remarks.push(format!("link `{name}` is fixed to `{carrier}` and became a part of it{mass}"));
            Some(merged)
        } else if is_fixed && self.bodies.contains(&link) {
            // A link without mass before it has taken it for its body.
            Some(merged)
        } else {
            self.first_of_body(link, file).map(|(body, pose)| Place { body, pose, zero })
        };
    }

    fn is_ground(&self, place: Place) -> bool {
        place.body == 0 && self.root == Root::Fixed
    }

    /// A new body for a link and what is fixed to it; the body's frame is at the mass centre.
    fn first_of_body(&mut self, link: usize, file: &str) -> Option<(usize, IsometryMatrix3<f64>)> {
        let described = &self.robot.links[link];
        let Some((massive, pose)) = self.nearest_mass(link) else {
            self.problems.push(format!(
                "{file}:{}: link `{}` moves and has no mass, nor has anything that is fixed to it: give it an <inertial>",
                described.line, described.name
            ));
            return None;
        };
        if massive != link {
            let name = &self.robot.links[massive].name;
            let words = format!(
                "link `{}` has no mass and became a part of `{name}`, which is fixed to it",
                described.name
            );
            self.remarks.push(words);
        }
        let centre = self.robot.links[massive].inertial.as_ref()?.origin;
        self.bodies.push(massive);
        Some((self.bodies.len() - 1, (pose * centre).inverse()))
    }

    /// The first link with mass among a link and what is fixed to it by way of links without mass, and its frame in the
    /// link's.
    fn nearest_mass(&self, link: usize) -> Option<(usize, IsometryMatrix3<f64>)> {
        if self.robot.links[link].inertial.is_some() {
            return Some((link, IsometryMatrix3::identity()));
        }
        let fixed = self.robot.joints.iter().filter(|j| j.parent == link && j.kind == Kind::Fixed);
        fixed.into_iter().find_map(|joint| {
            let (massive, pose) = self.nearest_mass(joint.child)?;
            Some((massive, joint.origin * pose))
        })
    }
}
