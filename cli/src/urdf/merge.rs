//! Links become bodies: those without mass are merged with what they are fixed to, and what is fixed to a root that
//! does not float is ground. Where a link's inertia is not a rigid body's (a point's, a rod's) all links that are fixed
//! to one another there become one body.

use super::robot::{Inertial, Joint, Kind, Link, Robot, unphysical};
use nalgebra::{IsometryMatrix3, Matrix3, Translation3, Vector3};

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
    /// The first body is the root's, the others have the order of the file.
    pub(super) bodies: Vec<Body>,
    /// For each link its place.
    pub(super) places: Vec<Place>,
    /// Which links are no bodies of their own.
    pub(super) remarks: Vec<String>,
}

/// What links became.
#[derive(Debug)]
pub(super) struct Body {
    /// The link that it is named after.
    pub(super) link: usize,
    /// Mass and inertia; `origin` is the body's frame in that of the link. `None` for the ground.
    pub(super) inertial: Option<Inertial>,
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
        is_one_body: vec![false; robot.links.len()],
        places: vec![None; robot.links.len()],
        bodies: Vec::new(),
        remarks: Vec::new(),
        problems: Vec::new(),
    };
    merging.place_root(order[0].1, at_origin, file);
    for (joint, link) in order.iter().skip(1) {
        merging.place(&robot.joints[*joint], *link, file);
    }
    let Merging { places, mut bodies, remarks, mut problems, .. } = merging;
    if problems.is_empty() && root == Root::Fixed && bodies.len() == 1 {
        let name = &robot.links[order[0].1].name;
        problems
            .push(format!("{file}: all links are fixed to the root link `{name}`: --floating lets it move"));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    let links: Vec<usize> = bodies.iter().map(|body| body.link).collect();
    if let Some(others) = bodies.get_mut(1..) {
        others.sort_unstable_by_key(|body| body.link);
    }
    let renumbered = |place: Place| {
        let link = links[place.body];
        Place { body: bodies.iter().position(|body| body.link == link).unwrap_or(0), ..place }
    };
    let places = places.into_iter().flatten().map(renumbered).collect();
    Ok(Merged { bodies, places, remarks })
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
        [] if robot.links.is_empty() => problems.push(format!("{file}: the robot has no links")),
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
    /// For each link whether it is part of a body with all that is fixed to it.
    is_one_body: Vec<bool>,
    places: Vec<Option<Place>>,
    bodies: Vec<Body>,
    remarks: Vec<String>,
    problems: Vec<String>,
}

impl Merging<'_> {
    /// Places the root: the ground, or a body with its own mass or that of what is fixed to it, its link's frame at the
    /// origin.
    fn place_root(&mut self, link: usize, at_origin: Place, file: &str) {
        self.places[link] = match self.root {
            Root::Fixed => {
                self.bodies.push(Body { link, inertial: None });
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
        let is_named_after = |body: &Body| body.link == link;
        self.places[link] = if is_fixed && self.bodies.iter().any(is_named_after) {
            // A link without mass before it has taken it for its body.
            Some(merged)
        } else if is_fixed && (self.is_ground(parent) || !has_mass || self.is_one_body[link]) {
            let carrier = &self.robot.links[self.bodies[parent.body].link].name;
            let mass = if has_mass { ", its mass with it" } else { "" };
            self.remarks.push(format!("link `{name}` is fixed to `{carrier}` and became a part of it{mass}"));
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
        let inertial = self.inertial(link, (massive, pose))?;
        let centre = inertial.origin;
        self.bodies.push(Body { link: massive, inertial: Some(inertial) });
        Some((self.bodies.len() - 1, (pose * centre).inverse()))
    }

    /// Mass and inertia of a body whose first link is `link`, in the frame of the link that it is named after: that
    /// link's alone, or, where one of the links that are fixed to one another has an inertia that is none, those of all
    /// of them.
    fn inertial(&mut self, link: usize, (massive, pose): (usize, IsometryMatrix3<f64>)) -> Option<Inertial> {
        let robot = self.robot;
        let mut parts = Vec::new();
        self.add_parts(link, IsometryMatrix3::identity(), &mut parts);
        let is_part =
            |part: &(usize, IsometryMatrix3<f64>)| Some((robot.links[part.0].inertial.as_ref()?, part.1));
        let massive_parts: Vec<_> = parts.iter().filter_map(is_part).collect();
        let flaws: Vec<_> = massive_parts.iter().filter_map(|(inertial, _)| inertial.flaw.clone()).collect();
        let own = robot.links[massive].inertial.as_ref()?;
        if flaws.is_empty() {
            return Some(own.clone());
        }
        parts.iter().for_each(|(part, _)| self.is_one_body[*part] = true);
        let to_massive = pose.inverse();
        let frames = massive_parts.iter().map(|(part, pose)| (*part, to_massive * pose * part.origin));
        let whole = sum(own, &frames.collect::<Vec<_>>());
        if unphysical(whole.inertia).is_some() {
            self.problems.extend(flaws);
            return None;
        }
        Some(whole)
    }

    /// A link and all that is fixed to it, with their frames in the first link's.
    fn add_parts(
        &self,
        link: usize,
        pose: IsometryMatrix3<f64>,
        parts: &mut Vec<(usize, IsometryMatrix3<f64>)>,
    ) {
        parts.push((link, pose));
        for joint in self.robot.joints.iter().filter(|j| j.parent == link && j.kind == Kind::Fixed) {
            self.add_parts(joint.child, pose * joint.origin, parts);
        }
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

/// Mass and inertia of parts together, each with its frame at its mass centre; in the axes of the first one.
fn sum(first: &Inertial, parts: &[(&Inertial, IsometryMatrix3<f64>)]) -> Inertial {
    let mass: f64 = parts.iter().map(|(part, _)| part.mass).sum();
    let moment: Vector3<f64> = parts.iter().map(|(part, at)| at.translation.vector * part.mass).sum();
    let centre = moment / mass;
    let axes = first.origin.rotation;
    let about_centre = |(part, at): &(&Inertial, IsometryMatrix3<f64>)| {
        let turned = (axes.inverse() * at.rotation).into_inner();
        let from = axes.inverse() * (at.translation.vector - centre);
        // Steiner's theorem.
        turned * tensor(part.inertia) * turned.transpose()
            + (Matrix3::identity() * from.norm_squared() - from * from.transpose()) * part.mass
    };
    let i: Matrix3<f64> = parts.iter().map(about_centre).sum();
    let inertia = [i.m11, i.m22, i.m33, i.m12, i.m13, i.m23];
    Inertial {
        origin: IsometryMatrix3::from_parts(Translation3::from(centre), axes),
        mass,
        inertia,
        flaw: None,
    }
}

fn tensor([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}
