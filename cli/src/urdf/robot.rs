//! The robot as its file describes it: a tree of links and joints.

use super::angle::{Angles, at};
use super::document::{Document, Node};
use super::element::{Findings, XACRO};
use super::inertia::Inertial;
use super::{Wishes, left_out, shapes};
use crate::words;
use nalgebra::{IsometryMatrix3, Matrix3, Vector3};
use std::collections::{BTreeMap, BTreeSet};

/// A robot whose joints make a tree.
#[derive(Debug)]
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) links: Vec<Link>,
    pub(super) joints: Vec<Joint>,
    /// Names of joints that transmissions name: in ROS those that have an actuator.
    pub(super) transmitted: BTreeSet<String>,
    /// What has no counterpart in a model file.
    pub(super) remarks: Vec<String>,
}

#[derive(Debug)]
pub(super) struct Link {
    pub(super) name: String,
    pub(super) line: u32,
    /// In the link's axes; `None` for a link without mass and inertia: a frame.
    pub(super) inertial: Option<Inertial>,
    /// What it looks like, as far as that is known.
    pub(super) shapes: Vec<shapes::Shape>,
    /// What it is made of, should it be weighed: the shapes that it collides with, or else those that are seen.
    pub(super) solids: Vec<shapes::Shape>,
}

#[derive(Debug)]
pub(super) struct Joint {
    pub(super) name: String,
    pub(super) line: u32,
    pub(super) kind: Kind,
    /// Indices of links.
    pub(super) parent: usize,
    pub(super) child: usize,
    /// Of the child's frame, in the parent's, where the joint is at zero.
    pub(super) origin: IsometryMatrix3<f64>,
    /// In the child's frame, of length 1.
    pub(super) axis: Vector3<f64>,
    /// Viscous friction.
    pub(super) damping: f64,
    /// Coulomb friction.
    pub(super) friction: f64,
    pub(super) mimic: Option<Mimic>,
    /// Of revolute and prismatic joints.
    pub(super) limit: Option<Limit>,
}

/// Where a joint's coordinate ends, and the greatest torque or force of its drive, 0 if it is not known.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) effort: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Revolute,
    Prismatic,
    Planar,
    Fixed,
    Floating,
}

/// The joint's coordinate is `multiplier` times the other's plus `offset`.
#[derive(Debug)]
pub(super) struct Mimic {
    /// Index of the other joint.
    pub(super) joint: usize,
    pub(super) multiplier: f64,
    pub(super) offset: f64,
}

impl Kind {
    /// Whether the joint has exactly one coordinate.
    pub(super) fn is_single(self) -> bool {
        matches!(self, Self::Revolute | Self::Prismatic)
    }
}

/// Reads a robot.
///
/// # Errors
/// Every mistake of the file, each with its line and element.
pub(super) fn read(file: &str, text: &str, wishes: Wishes<'_>) -> Result<Robot, Vec<String>> {
    let document = Document::parse(text).map_err(|(line, words)| {
        let cure = if text.contains("xacro:") { format!("; {XACRO}") } else { String::new() };
        vec![format!("{file}:{line}: not a whole XML file: {words}{cure}")]
    })?;
    let mut remarks = Vec::new();
    for name in wishes.ignored {
        let lines: Vec<u32> = document.all().filter(|node| node.is(name)).map(Node::line).collect();
        let number = words::count(lines.len() as u64, &format!("<{name}>"));
        remarks.push(match lines.as_slice() {
            [] => format!("--ignore {name}: the robot has no such element"),
            _ => format!("{number} ignored, as is asked for: {}", at(lines.iter())),
        });
    }
    let document = document.without(wishes.ignored);
    let Some(root) = document.root() else {
        return Err(vec![format!("{file}: a URDF file has one <robot>")]);
    };
    let mut findings = Findings {
        file,
        as_written: wishes.as_written,
        colors: shapes::materials(&document),
        problems: Vec::new(),
        remarks,
        angles: Angles::default(),
        unused: BTreeMap::new(),
    };
    if !root.is("robot") {
        findings.problem(root, "a URDF file has one <robot>");
        return Err(findings.problems);
    }
    let robot = robot(&mut findings, root, wishes);
    if findings.problems.is_empty() {
        Ok(Robot { remarks: findings.all_remarks(), ..robot })
    } else {
        Err(findings.problems)
    }
}

fn robot(findings: &mut Findings<'_>, root: Node<'_>, wishes: Wishes<'_>) -> Robot {
    let elements = |name: &'static str| root.children().filter(move |node| node.is(name));
    let links: Vec<Link> = elements("link").filter_map(|node| link(findings, node, wishes)).collect();
    let nodes: Vec<Node<'_>> = elements("joint").collect();
    let names: Vec<&str> = nodes.iter().map(|node| node.attribute("name").unwrap_or_default()).collect();
    refuse_repetition(findings, &elements("link").collect::<Vec<_>>());
    refuse_repetition(findings, &nodes);
    let joints: Vec<Joint> = nodes.iter().filter_map(|node| joint(findings, *node, &links, &names)).collect();
    if findings.problems.is_empty() {
        refuse_bad_mimics(findings, &nodes, &joints);
    }
    left_out::tell(findings, root, &["link", "joint"], &[]);
    remark_on_shapes(findings, root, &links);
    let name = root.attribute("name").unwrap_or("robot").to_owned();
    let transmissions = elements("transmission").flat_map(|node| node.descendants());
    let transmitted = transmissions.filter(|node| node.is("joint"));
    let transmitted = transmitted.filter_map(|node| node.attribute("name")).map(str::to_owned).collect();
    Robot { name, links, joints, transmitted, remarks: Vec::new() }
}

/// One remark on all shapes that are left out.
fn remark_on_shapes(findings: &mut Findings<'_>, root: Node<'_>, links: &[Link]) {
    let number = |tag: &str| root.descendants().filter(|node| node.is(tag)).count();
    let kept: usize = links.iter().map(|link| link.shapes.len()).sum();
    let (visuals, collisions) = (number("visual").saturating_sub(kept), number("collision"));
    if visuals + collisions > 0 {
        let mut remark =
            format!("{visuals} <visual> and {collisions} <collision>: these shapes have no counterpart");
        let is_lost = |node: &Node<'_>| node.is("mesh") && node.ancestors().any(|outer| outer.is("visual"));
        let meshes =
            links.iter().flat_map(|link| &link.shapes).filter(|s| matches!(s.kind, shapes::Kind::Mesh(..)));
        if root.descendants().filter(is_lost).count() > meshes.count() {
            remark += " (or their meshes are not found, in folders above the robot or in ROS_PACKAGE_PATH)";
        }
        findings.remarks.push(remark);
    }
}

fn refuse_repetition(findings: &mut Findings<'_>, nodes: &[Node<'_>]) {
    for (k, node) in nodes.iter().enumerate() {
        let name = node.attribute("name");
        if name.is_some() && nodes[..k].iter().any(|earlier| earlier.attribute("name") == name) {
            findings.problem(*node, "an earlier one has this name");
        }
    }
}

fn link(findings: &mut Findings<'_>, node: Node<'_>, wishes: Wishes<'_>) -> Option<Link> {
    let name = findings.text(node, "name")?.to_owned();
    left_out::tell(findings, node, &["inertial", "visual", "collision"], &["inertial"]);
    let inertial = node.child("inertial").and_then(|inertial| read_inertial(findings, inertial));
    let shapes = shapes::read(findings, node, "visual");
    let collisions =
        if wishes.density.is_some() { shapes::read(findings, node, "collision") } else { Vec::new() };
    let solids = if collisions.is_empty() { shapes.clone() } else { collisions };
    Some(Link { name, line: node.line(), inertial, shapes, solids })
}

/// Mass, mass centre and inertia; `None` where both are zero.
fn read_inertial(findings: &mut Findings<'_>, node: Node<'_>) -> Option<Inertial> {
    let origin = findings.origin(node);
    let Some(mass_node) = node.child("mass") else {
        findings.problem(node, "<mass value=\"...\"/> is missing");
        return None;
    };
    let mass = findings.number(mass_node, "value")?;
    if mass < 0.0 {
        findings.problem(mass_node, &format!("the mass {mass:?} is negative"));
        return None;
    }
    let Some(tensor) = node.child("inertia") else {
        if mass > 0.0 {
            findings.remark(node, "a mass without <inertia> is taken for a point");
        }
        let point = Inertial { mass, centre: Vector3::zeros(), tensor: Matrix3::zeros() };
        return Some(point.seen(&origin?)).filter(|_| mass > 0.0);
    };
    let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|name| findings.number(tensor, name));
    let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|name| findings.number_or(tensor, name, 0.0));
    let (xx, yy, zz, xy, xz, yz) = (xx?, yy?, zz?, xy?, xz?, yz?);
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let is_nothing = mass == 0.0 && tensor == Matrix3::zeros();
    (!is_nothing).then_some(Inertial { mass, centre: Vector3::zeros(), tensor }.seen(&origin?))
}

fn joint(findings: &mut Findings<'_>, node: Node<'_>, links: &[Link], names: &[&str]) -> Option<Joint> {
    let name = findings.text(node, "name")?.to_owned();
    let kind = kind(findings, node);
    let parent = end(findings, node, "parent", links);
    let child_link = end(findings, node, "child", links);
    let origin = findings.origin(node);
    let axis = match kind {
        // URDF: these joints do not use it, and some programs write zeros.
        Some(Kind::Fixed | Kind::Floating) => Some(Vector3::x()),
        _ => axis(findings, node),
    };
    let (damping, friction) = dynamics(findings, node);
    let mimic = match node.child("mimic") {
        Some(mimic) if kind == Some(Kind::Fixed) => {
            findings.remark(mimic, "a fixed joint follows nothing");
            None
        }
        Some(mimic) => Some(read_mimic(findings, mimic, names)?),
        None => None,
    };
    let limit = limit(findings, node);
    let once = ["origin", "parent", "child", "axis", "dynamics", "mimic", "limit"];
    left_out::tell(findings, node, &once, &once);
    if kind.is_some_and(|kind| !kind.is_single()) && (damping > 0.0 || friction > 0.0) {
        findings.remark(node, "damping and friction are for revolute and prismatic joints only");
    }
    Some(Joint {
        name,
        line: node.line(),
        kind: kind?,
        parent: parent?,
        child: child_link?,
        origin: origin?,
        axis: axis?,
        damping,
        friction,
        mimic,
        limit,
    })
}

fn kind(findings: &mut Findings<'_>, node: Node<'_>) -> Option<Kind> {
    let known = ["revolute", "continuous", "prismatic", "planar", "fixed", "floating"];
    match findings.text(node, "type")? {
        "revolute" | "continuous" => Some(Kind::Revolute),
        "prismatic" => Some(Kind::Prismatic),
        "planar" => Some(Kind::Planar),
        "fixed" => Some(Kind::Fixed),
        "floating" => Some(Kind::Floating),
        other => {
            findings.problem(node, &format!("unknown type `{other}`: {}", words::instead(other, &known)));
            None
        }
    }
}

/// Index of the link that a joint's parent or child is.
fn end(findings: &mut Findings<'_>, node: Node<'_>, tag: &str, links: &[Link]) -> Option<usize> {
    let Some(end) = node.child(tag) else {
        findings.problem(node, &format!("<{tag} link=\"...\"/> is missing"));
        return None;
    };
    let name = findings.text(end, "link")?;
    let index = links.iter().position(|link| link.name == name);
    if index.is_none() {
        let known: Vec<&str> = links.iter().map(|link| link.name.as_str()).collect();
        findings.problem(end, &format!("unknown link `{name}`: {}", words::instead(name, &known)));
    }
    index
}

/// The axis, of length 1; x if none is given.
fn axis(findings: &mut Findings<'_>, node: Node<'_>) -> Option<Vector3<f64>> {
    let Some(axis) = node.child("axis") else { return Some(Vector3::x()) };
    let xyz = findings.vector_or(axis, "xyz", [1.0, 0.0, 0.0])?;
    let unit = findings.direction(axis, &xyz);
    if unit.is_none() {
        findings.problem(axis, "the axis has no direction");
    }
    unit
}

/// Damping and friction; both are at least zero.
fn dynamics(findings: &mut Findings<'_>, node: Node<'_>) -> (f64, f64) {
    let Some(dynamics) = node.child("dynamics") else { return (0.0, 0.0) };
    let [damping, friction] = ["damping", "friction"].map(|name| {
        let value = findings.number_or(dynamics, name, 0.0).unwrap_or(0.0);
        if value < 0.0 {
            findings.problem(dynamics, &format!("{name} {value:?} is negative"));
        }
        value
    });
    (damping, friction)
}

/// Where a revolute or prismatic joint ends; a continuous one does not.
fn limit(findings: &mut Findings<'_>, node: Node<'_>) -> Option<Limit> {
    let limit =
        node.child("limit").filter(|_| matches!(node.attribute("type"), Some("revolute" | "prismatic")))?;
    let [lower, upper, effort] =
        ["lower", "upper", "effort"].map(|name| findings.number_or(limit, name, 0.0));
    Some(Limit { lower: lower?, upper: upper?, effort: effort?.max(0.0) })
}

fn read_mimic(findings: &mut Findings<'_>, node: Node<'_>, names: &[&str]) -> Option<Mimic> {
    let name = findings.text(node, "joint")?;
    let joint = names.iter().position(|other| *other == name);
    if joint.is_none() {
        findings.problem(
            node,
            &format!(
                "unknown joint `{name}`: {}, or let the joint move by itself: --ignore mimic",
                words::instead(name, names)
            ),
        );
    }
    let multiplier = findings.number_or(node, "multiplier", 1.0);
    let offset = findings.number_or(node, "offset", 0.0);
    Some(Mimic { joint: joint?, multiplier: multiplier?, offset: offset? })
}

/// Both joints of a mimic have one coordinate, and no joint follows itself.
fn refuse_bad_mimics(findings: &mut Findings<'_>, nodes: &[Node<'_>], joints: &[Joint]) {
    for (index, joint) in joints.iter().enumerate() {
        let Some(mimic) = &joint.mimic else { continue };
        if mimic.multiplier == 0.0 {
            let words = "a multiplier of 0 lets the joint follow nothing: make it a fixed joint";
            findings.problem(nodes[index], words);
        }
        if !joint.kind.is_single() || !joints[mimic.joint].kind.is_single() {
            findings.problem(
                nodes[index],
                "only revolute, continuous and prismatic joints can follow one another",
            );
        }
        let follows = |from: usize| joints[from].mimic.as_ref().map(|mimic| mimic.joint);
        let chain = std::iter::successors(Some(mimic.joint), |from| follows(*from));
        if chain.take(joints.len() + 1).any(|other| other == index) {
            findings.problem(nodes[index], "the joint follows itself");
        }
    }
}
