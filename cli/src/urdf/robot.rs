//! The robot as its file describes it: a tree of links and joints.

use super::angle::Angles;
use super::element::{Findings, XACRO, child};
use super::inertia::Inertial;
use super::shapes;
use crate::words;
use nalgebra::{IsometryMatrix3, Matrix3, Vector3};
use roxmltree::{Document, Node};
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
pub(super) fn read(file: &str, text: &str) -> Result<Robot, Vec<String>> {
    let document = Document::parse(text).map_err(|e| {
        let cure = if text.contains("xacro:") { format!("; {XACRO}") } else { String::new() };
        vec![format!("{file}: not a whole XML file: {e}{cure}")]
    })?;
    let root = document.root_element();
    let mut findings = Findings {
        file,
        document: &document,
        problems: Vec::new(),
        remarks: Vec::new(),
        angles: Angles::default(),
        unused: BTreeMap::new(),
    };
    if !root.has_tag_name("robot") {
        findings.problem(root, "a URDF file has one <robot>");
        return Err(findings.problems);
    }
    let robot = robot(&mut findings, root);
    if findings.problems.is_empty() {
        Ok(Robot { remarks: findings.all_remarks(), ..robot })
    } else {
        Err(findings.problems)
    }
}

fn robot(findings: &mut Findings<'_>, root: Node<'_, '_>) -> Robot {
    let elements = |name: &'static str| root.children().filter(move |node| node.has_tag_name(name));
    let links: Vec<Link> = elements("link").filter_map(|node| link(findings, node)).collect();
    let nodes: Vec<Node<'_, '_>> = elements("joint").collect();
    let names: Vec<&str> = nodes.iter().map(|node| node.attribute("name").unwrap_or_default()).collect();
    refuse_repetition(findings, &elements("link").collect::<Vec<_>>());
    refuse_repetition(findings, &nodes);
    let joints: Vec<Joint> = nodes.iter().filter_map(|node| joint(findings, *node, &links, &names)).collect();
    if findings.problems.is_empty() {
        refuse_bad_mimics(findings, &nodes, &joints);
    }
    for node in root.children().filter(Node::is_element) {
        if node.tag_name().namespace().is_some_and(|n| n.contains("xacro")) {
            findings.problem(node, XACRO);
        } else if !node.has_tag_name("link") && !node.has_tag_name("joint") {
            findings.unused(node);
        }
    }
    remark_on_shapes(findings, root, &links);
    let name = root.attribute("name").unwrap_or("robot").to_owned();
    let transmissions = elements("transmission").flat_map(|node| node.descendants());
    let transmitted = transmissions.filter(|node| node.has_tag_name("joint"));
    let transmitted = transmitted.filter_map(|node| node.attribute("name")).map(str::to_owned).collect();
    Robot { name, links, joints, transmitted, remarks: Vec::new() }
}

/// One remark on all shapes that are left out.
fn remark_on_shapes(findings: &mut Findings<'_>, root: Node<'_, '_>, links: &[Link]) {
    let number = |tag: &str| root.descendants().filter(|node| node.has_tag_name(tag)).count();
    let kept: usize = links.iter().map(|link| link.shapes.len()).sum();
    let (visuals, collisions) = (number("visual").saturating_sub(kept), number("collision"));
    if visuals + collisions > 0 {
        let mut remark =
            format!("{visuals} <visual> and {collisions} <collision>: these shapes have no counterpart");
        let is_lost = |node: &Node<'_, '_>| {
            node.has_tag_name("mesh") && node.ancestors().any(|outer| outer.has_tag_name("visual"))
        };
        let meshes =
            links.iter().flat_map(|link| &link.shapes).filter(|s| matches!(s.kind, shapes::Kind::Mesh(..)));
        if root.descendants().filter(is_lost).count() > meshes.count() {
            remark += " (or their meshes are not found, in folders above the robot or in ROS_PACKAGE_PATH)";
        }
        findings.remarks.push(remark);
    }
}

fn refuse_repetition(findings: &mut Findings<'_>, nodes: &[Node<'_, '_>]) {
    for (k, node) in nodes.iter().enumerate() {
        let name = node.attribute("name");
        if name.is_some() && nodes[..k].iter().any(|earlier| earlier.attribute("name") == name) {
            findings.problem(*node, "an earlier one has this name");
        }
    }
}

fn link(findings: &mut Findings<'_>, node: Node<'_, '_>) -> Option<Link> {
    let name = findings.text(node, "name")?.to_owned();
    for other in node.children().filter(Node::is_element) {
        if !["inertial", "visual", "collision"].contains(&other.tag_name().name()) {
            findings.unused(other);
        }
    }
    let inertial = child(node, "inertial").and_then(|inertial| read_inertial(findings, inertial));
    let shapes = shapes::read(findings, node);
    Some(Link { name, line: findings.line(node), inertial, shapes })
}

/// Mass, mass centre and inertia; `None` where both are zero.
fn read_inertial(findings: &mut Findings<'_>, node: Node<'_, '_>) -> Option<Inertial> {
    let origin = findings.origin(node);
    let Some(mass_node) = child(node, "mass") else {
        findings.problem(node, "<mass value=\"...\"/> is missing");
        return None;
    };
    let mass = findings.number(mass_node, "value")?;
    if mass < 0.0 {
        findings.problem(mass_node, &format!("the mass {mass:?} is negative"));
        return None;
    }
    let Some(tensor) = child(node, "inertia") else {
        if mass > 0.0 {
            findings.problem(node, "<inertia ixx=\"...\" .../> is missing");
        }
        return None;
    };
    let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|name| findings.number(tensor, name));
    let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|name| findings.number_or(tensor, name, 0.0));
    let (xx, yy, zz, xy, xz, yz) = (xx?, yy?, zz?, xy?, xz?, yz?);
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let is_nothing = mass == 0.0 && tensor == Matrix3::zeros();
    (!is_nothing).then_some(Inertial { mass, centre: Vector3::zeros(), tensor }.seen(&origin?))
}

fn joint(findings: &mut Findings<'_>, node: Node<'_, '_>, links: &[Link], names: &[&str]) -> Option<Joint> {
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
    let mimic = match child(node, "mimic") {
        Some(mimic) if kind == Some(Kind::Fixed) => {
            findings.remark(mimic, "a fixed joint follows nothing");
            None
        }
        Some(mimic) => Some(read_mimic(findings, mimic, names)?),
        None => None,
    };
    let limit = limit(findings, node);
    without_counterpart(findings, node);
    if kind.is_some_and(|kind| !kind.is_single()) && (damping > 0.0 || friction > 0.0) {
        findings.remark(node, "damping and friction are for revolute and prismatic joints only");
    }
    Some(Joint {
        name,
        line: findings.line(node),
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

fn kind(findings: &mut Findings<'_>, node: Node<'_, '_>) -> Option<Kind> {
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
fn end(findings: &mut Findings<'_>, node: Node<'_, '_>, tag: &str, links: &[Link]) -> Option<usize> {
    let Some(end) = child(node, tag) else {
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
fn axis(findings: &mut Findings<'_>, node: Node<'_, '_>) -> Option<Vector3<f64>> {
    let Some(axis) = child(node, "axis") else { return Some(Vector3::x()) };
    let xyz = findings.vector_or(axis, "xyz", [1.0, 0.0, 0.0])?;
    let unit = findings.direction(axis, &xyz);
    if unit.is_none() {
        findings.problem(axis, "the axis has no direction");
    }
    unit
}

/// Damping and friction; both are at least zero.
fn dynamics(findings: &mut Findings<'_>, node: Node<'_, '_>) -> (f64, f64) {
    let Some(dynamics) = child(node, "dynamics") else { return (0.0, 0.0) };
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
fn limit(findings: &mut Findings<'_>, node: Node<'_, '_>) -> Option<Limit> {
    let limit =
        child(node, "limit").filter(|_| matches!(node.attribute("type"), Some("revolute" | "prismatic")))?;
    let [lower, upper, effort] =
        ["lower", "upper", "effort"].map(|name| findings.number_or(limit, name, 0.0));
    Some(Limit { lower: lower?, upper: upper?, effort: effort?.max(0.0) })
}

fn read_mimic(findings: &mut Findings<'_>, node: Node<'_, '_>, names: &[&str]) -> Option<Mimic> {
    let name = findings.text(node, "joint")?;
    let joint = names.iter().position(|other| *other == name);
    if joint.is_none() {
        findings.problem(node, &format!("unknown joint `{name}`: {}", words::instead(name, names)));
    }
    let multiplier = findings.number_or(node, "multiplier", 1.0);
    let offset = findings.number_or(node, "offset", 0.0);
    Some(Mimic { joint: joint?, multiplier: multiplier?, offset: offset? })
}

/// Both joints of a mimic have one coordinate, and no joint follows itself.
fn refuse_bad_mimics(findings: &mut Findings<'_>, nodes: &[Node<'_, '_>], joints: &[Joint]) {
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

/// What else a joint has.
fn without_counterpart(findings: &mut Findings<'_>, node: Node<'_, '_>) {
    let known = ["origin", "parent", "child", "axis", "dynamics", "mimic", "limit"];
    for other in node.children().filter(Node::is_element) {
        if !known.contains(&other.tag_name().name()) {
            findings.unused(other);
        }
    }
}
