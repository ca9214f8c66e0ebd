//! Links become bodies: all links that are fixed to one another are one, and what is fixed to a root that does not
//! float is ground.

use super::Wishes;
use super::element::settled;
use super::inertia::{Elements, Inertial, is_inertia, rounded};
use super::robot::{Kind, Link, Robot};
use crate::words;
use nalgebra::{IsometryMatrix3, Translation3, Vector3};

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
    /// What had to be decided.
    pub(super) remarks: Vec<String>,
}

/// What links became.
#[derive(Debug)]
pub(super) struct Body {
    /// The link that it is named after: the ground's is the root, of others it is the first with mass.
    pub(super) link: usize,
    /// The joint that carries it; none for the root's.
    pub(super) carrier: Option<usize>,
    /// `None` for the ground.
    pub(super) inertial: Option<Settled>,
    /// The body's frame in the global frame, with all joints at zero.
    pub(super) zero: IsometryMatrix3<f64>,
}

/// Mass and inertia as they are written; the body's frame is at the mass centre.
#[derive(Clone, Debug)]
pub(super) struct Settled {
    pub(super) mass: f64,
    /// About the mass centre, in the body's frame.
    pub(super) inertia: Elements,
    /// Whether no body has such an inertia, and the file's is to be taken for all that.
    pub(super) as_written: bool,
}

/// Where a link's frame is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// Index into [`Merged::bodies`].
    pub(super) body: usize,
    /// The link's frame in the body's frame.
    pub(super) pose: IsometryMatrix3<f64>,
}

/// Links that are fixed to one another.
struct Group {
    /// The link that it is named after.
    named: usize,
    carrier: Option<usize>,
    /// The frame of the first link in the global frame, with all joints at zero.
    zero: IsometryMatrix3<f64>,
    /// Each link with its frame in that of the first.
    links: Vec<(usize, IsometryMatrix3<f64>)>,
    /// In the first link's frame; `None` without mass.
    inertial: Option<Inertial>,
}

/// A link that moves without mass takes this part of the mass and the inertia of what it carries.
const BORROWED: f64 = 1e-6;

/// The same where all numbers are to be those of the file: within rounding, in joint coordinates, of a link without
/// mass.
const BORROWED_AS_WRITTEN: f64 = 1e-12;

/// Merges the links of a robot.
///
/// # Errors
/// Links that do not make a tree, links that move without mass, and inertias that no body has.
pub(super) fn merge(
    file: &str,
    robot: &Robot,
    Wishes { root, as_written, .. }: Wishes<'_>,
) -> Result<Merged, Vec<String>> {
    let mut groups = grouped(robot, &order(file, robot)?, root);
    let mut problems = Vec::new();
    let mut remarks: Vec<String> = groups.iter().filter_map(|group| remark_on_links(robot, group)).collect();
    if root == Root::Fixed && groups.len() == 1 {
        let name = &robot.links[groups[0].links[0].0].name;
        problems
            .push(format!("{file}: all links are fixed to the root link `{name}`: --floating lets it move"));
    }
    let ground = usize::from(root == Root::Fixed);
    let part = if as_written { BORROWED_AS_WRITTEN } else { BORROWED };
    lend((file, part), robot, &mut groups[ground..], &mut remarks, &mut problems);
    let mut merged = Merged { bodies: Vec::new(), places: Vec::new(), remarks };
    let mut places = vec![None; robot.links.len()];
    // The root's first, then in the order of the file.
    groups[1..].sort_by_key(|group| group.named);
    for (body, group) in groups.iter().enumerate() {
        let link = group.named;
        let inertial = group.inertial.as_ref().filter(|_| body >= ground);
        let centre = inertial.map_or_else(Vector3::zeros, |inertial| inertial.centre.map(on_grid));
        let centre = Translation3::from(centre);
        let settled = inertial.map(|inertial| match inertial.elements(as_written) {
            Ok((inertia, remark)) => {
                let name = &robot.links[link].name;
                merged.remarks.extend(remark.map(|remark| format!("the body of link `{name}` {remark}")));
                Settled { mass: rounded(inertial.mass), inertia, as_written: !is_inertia(inertia) }
            }
            Err(flaw) => {
                problems.push(at(file, &robot.links[link], &format!("with what is fixed to it, {flaw}")));
                Settled { mass: inertial.mass, inertia: [0.0; 6], as_written }
            }
        });
        for (link, pose) in &group.links {
            places[*link] = Some(Place { body, pose: centre.inverse() * pose });
        }
        merged.bodies.push(Body {
            link,
            carrier: group.carrier,
            inertial: settled,
            zero: group.zero * centre,
        });
    }
    merged.places = places.into_iter().flatten().collect();
    if problems.is_empty() { Ok(merged) } else { Err(problems) }
}

/// A length, or a component of a direction, to 15 decimals: what was typed comes back from sums and differences, and
/// what rotations leave of a zero is zero.
pub(super) fn on_grid(length: f64) -> f64 {
    rounded(format!("{length:.15}").parse().unwrap_or(length))
}

/// Links from the root to the leaves, each with the joint that carries it (any number for the root).
fn order(file: &str, robot: &Robot) -> Result<Vec<(usize, usize)>, Vec<String>> {
    let carriers = |link: usize| robot.joints.iter().filter(move |joint| joint.child == link);
    let problem = |link: &Link, words: String| at(file, link, &words);
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

/// Links that are fixed to one another, from the root outwards.
fn grouped(robot: &Robot, order: &[(usize, usize)], root: Root) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    // For each link its group, and its frame in that of the group's first link.
    let mut places = vec![(0, IsometryMatrix3::identity()); robot.links.len()];
    for &(carrier, link) in order {
        let joint = robot.joints.get(carrier);
        let at_zero = joint.map(|joint| {
            let (group, pose) = places[joint.parent];
            (group, settled(&(pose * joint.origin)))
        });
        let place = match (joint, at_zero) {
            (Some(joint), Some(place)) if joint.kind == Kind::Fixed => place,
            (_, at_zero) => {
                let in_global = |(group, pose): (usize, _)| settled(&(groups[group].zero * pose));
                let zero = at_zero.map_or_else(IsometryMatrix3::identity, in_global);
                let carrier = joint.map(|_| carrier);
                groups.push(Group { named: link, carrier, zero, links: Vec::new(), inertial: None });
                (groups.len() - 1, IsometryMatrix3::identity())
            }
        };
        places[link] = place;
        groups[place.0].links.push((link, place.1));
    }
    let ground = usize::from(root == Root::Fixed);
    for (index, group) in groups.iter_mut().enumerate() {
        let inertial = |link: usize| robot.links[link].inertial.as_ref();
        let part = |(link, pose): &(usize, _)| Some(inertial(*link)?.seen(pose));
        group.inertial = Inertial::sum(&group.links.iter().filter_map(part).collect::<Vec<_>>());
        let has_mass = |link: &usize| inertial(*link).is_some_and(|part| part.mass > 0.0);
        let massive = group.links.iter().map(|(link, _)| *link).find(has_mass);
        group.named = massive.filter(|_| index >= ground).unwrap_or(group.named);
    }
    groups
}

fn remark_on_links(robot: &Robot, group: &Group) -> Option<String> {
    let name = |link: usize| format!("`{}`", robot.links[link].name);
    let others = group.links.iter().map(|(link, _)| *link).filter(|link| *link != group.named);
    let others: Vec<String> = others.map(name).collect();
    let (number, list) = (others.len() as u64, words::listed(&others));
    let (number, named) = (others.first().map(|_| words::count(number, "link"))?, name(group.named));
    Some(format!("{number} fixed to {named}, one body with it: {list}"))
}

/// Gives links that move without mass a small part of what they carry.
fn lend(
    (file, part): (&str, f64),
    robot: &Robot,
    groups: &mut [Group],
    remarks: &mut Vec<String>,
    problems: &mut Vec<String>,
) {
    let mut loans = Vec::new();
    for (index, group) in groups.iter().enumerate().filter(|(_, group)| group.inertial.is_none()) {
        let link = &robot.links[group.links[0].0];
        let carrier = group.carrier.map(|joint| &robot.joints[joint]);
        let Some(carrier) = carrier.filter(|joint| joint.kind != Kind::Floating) else {
            // What it carries does not hold it.
            let cure = if carrier.is_none() { ", or import the robot without --floating" } else { "" };
            let words = format!(
                "moves and has no mass, nor has anything that is fixed to it: give it an <inertial>, or its shapes a \
                 --density{cure}"
            );
            problems.push(at(file, link, &words));
            continue;
        };
        let Some(lender) = carried_mass(robot, groups, index) else {
            let words = format!(
                "moves and has no mass, nor has anything that it carries: give it an <inertial>, or its shapes a \
                 --density, or make joint `{}` (line {}) a fixed one",
                carrier.name, carrier.line
            );
            problems.push(at(file, link, &words));
            continue;
        };
        let (share, lending) = (share(part), &robot.links[groups[lender].named].name);
        remarks.push(format!(
            "link `{}` moves and has no mass: it takes {share} of that of `{lending}`, which it carries",
            link.name
        ));
        loans.push((index, lender));
    }
    let whole: Vec<Option<Inertial>> = groups.iter().map(|group| group.inertial.clone()).collect();
    for (borrower, lender) in loans {
        let Some(inertial) = &whole[lender] else { continue };
        let pose = groups[borrower].zero.inverse() * groups[lender].zero;
        groups[borrower].inertial = Some(inertial.part(part).seen(&pose));
        let left = groups[lender].inertial.as_mut();
        if let Some(left) = left {
            left.mass -= inertial.mass * part;
            left.tensor -= inertial.tensor * part;
        }
    }
}

fn share(part: f64) -> &'static str {
    if part == BORROWED { "a millionth" } else { "1e-12" }
}

/// The nearest group with mass that a group carries.
fn carried_mass(robot: &Robot, groups: &[Group], group: usize) -> Option<usize> {
    let mut reached = vec![group];
    let mut next = 0;
    while let Some(&carrier) = reached.get(next) {
        if groups[carrier].inertial.is_some() {
            return Some(carrier);
        }
        let is_on = |group: &Group| {
            let parent = group.carrier.map(|joint| robot.joints[joint].parent);
            groups[carrier].links.iter().any(|(link, _)| Some(*link) == parent)
        };
        reached.extend((0..groups.len()).filter(|&other| is_on(&groups[other])));
        next += 1;
    }
    None
}

fn at(file: &str, link: &Link, words: &str) -> String {
    format!("{file}:{}: link `{}` {words}", link.line, link.name)
}
