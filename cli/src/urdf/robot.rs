//! The robot as its file describes it: a tree of links and joints.

use super::element::{Findings, child};
use crate::words;
use nalgebra::{IsometryMatrix3, Matrix3, Vector3};
use roxmltree::{Document, Node};

/// A robot whose joints make a tree.
#[derive(Debug)]
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) links: Vec<Link>,
    pub(super) joints: Vec<Joint>,
    /// What has no counterpart in a model file.
    pub(super) remarks: Vec<String>,
}

#[derive(Debug)]
pub(super) struct Link {
    pub(super) name: String,
    pub(super) line: u32,
    /// `None` for a link without mass: a frame.
    pub(super) inertial: Option<Inertial>,
}

#[derive(Clone, Debug)]
pub(super) struct Inertial {
    /// Of the mass centre, in the link's frame.
    pub(super) origin: IsometryMatrix3<f64>,
    pub(super) mass: f64,
    /// Tensor elements xx, yy, zz, xy, xz, yz about the mass centre, in the frame of `origin`.
    pub(super) inertia: [f64; 6],
    /// Why it is not a rigid body's, if so: where it is written, and a cure.
    pub(super) flaw: Option<String>,
}

#[derive(Debug)]
pub(super) struct Joint {
    pub(super) name: String,
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
    let document = Document::parse(text).map_err(|e| vec![format!("{file}: not a whole XML file: {e}")])?;
    let root = document.root_element();
    let mut findings = Findings { file, document: &document, problems: Vec::new(), remarks: Vec::new() };
    if !root.has_tag_name("robot") {
        findings.problem(root, "a URDF file has one <robot>");
        return Err(findings.problems);
    }
    let robot = robot(&mut findings, root);
    if findings.problems.is_empty() {
        Ok(Robot { remarks: findings.remarks, ..robot })
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
            findings.problem(node, "this is xacro: expand the file with `xacro` first");
        } else if !node.has_tag_name("link") && !node.has_tag_name("joint") {
            findings.remark(node, "has no counterpart");
        }
    }
    shapes(findings, root);
    let name = root.attribute("name").unwrap_or("robot").to_owned();
    Robot { name, links, joints, remarks: Vec::new() }
}

/// One remark on all shapes.
fn shapes(findings: &mut Findings<'_>, root: Node<'_, '_>) {
    let number = |tag: &str| root.descendants().filter(|node| node.has_tag_name(tag)).count();
    let (visuals, collisions) = (number("visual"), number("collision"));
    if visuals + collisions > 0 {
        let remark = format!("{visuals} <visual> and {collisions} <collision>: shapes have no counterpart");
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
            findings.remark(other, "has no counterpart");
        }
    }
    let inertial = child(node, "inertial").and_then(|inertial| read_inertial(findings, inertial));
    Some(Link { name, line: findings.line(node), inertial })
}

/// Mass, mass centre and inertia; `None` also for a mass of zero.
fn read_inertial(findings: &mut Findings<'_>, node: Node<'_, '_>) -> Option<Inertial> {
    let origin = findings.origin(node);
    let Some(mass_node) = child(node, "mass") else {
        findings.problem(node, "<mass value=\"...\"/> is missing");
        return None;
    };
    let mass = findings.number(mass_node, "value")?;
    if mass == 0.0 {
        return None;
    }
    if mass < 0.0 {
        findings.problem(mass_node, &format!("the mass {mass:?} is negative"));
        return None;
    }
    let Some(tensor) = child(node, "inertia") else {
        findings.problem(node, "<inertia ixx=\"...\" .../> is missing");
        return None;
    };
    let [xx, yy, zz] = ["ixx", "iyy", "izz"].map(|name| findings.number(tensor, name));
    let [xy, xz, yz] = ["ixy", "ixz", "iyz"].map(|name| findings.number_or(tensor, name, 0.0));
    let inertia = [xx?, yy?, zz?, xy?, xz?, yz?];
    let flaw = unphysical(inertia).map(|words| findings.at(tensor, &words));
    Some(Inertial { origin: origin?, mass, inertia, flaw })
}

/// Principal moments that equal the sum of the others to this part are a lamina's, rounded.
const LAMINA: f64 = 1e-9;

/// Why a tensor is not an inertia, if so, and what to do.
pub(super) fn unphysical([xx, yy, zz, xy, xz, yz]: [f64; 6]) -> Option<String> {
    let tensor = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    let mut moments: Vec<f64> = tensor.symmetric_eigenvalues().iter().copied().collect();
    moments.sort_by(f64::total_cmp);
    if moments[0] <= 0.0 {
        return Some(format!(
            "the principal moments {moments:?} are not all positive: no body has these; write those of the real part (a thin \
             rod has a small one about itself too)"
        ));
    }
    (moments[2] > (moments[0] + moments[1]) * (1.0 + LAMINA)).then(|| {
        format!(
            "of the principal moments {moments:?} the largest exceeds the sum of the others: no body has these; write \
             those about the mass centre, in the axes of the <inertial>"
        )
    })
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
    without_counterpart(findings, node);
    if kind.is_some_and(|kind| !kind.is_single()) && (damping > 0.0 || friction > 0.0) {
        findings.remark(node, "damping and friction are for revolute and prismatic joints only");
    }
    Some(Joint {
        name,
        kind: kind?,
        parent: parent?,
        child: child_link?,
        origin: origin?,
        axis: axis?,
        damping,
        friction,
        mimic,
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
    let unit = xyz.try_normalize(0.0);
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

/// Remarks on the rest of a joint.
fn without_counterpart(findings: &mut Findings<'_>, node: Node<'_, '_>) {
    let known = ["origin", "parent", "child", "axis", "dynamics", "mimic"];
    for other in node.children().filter(Node::is_element) {
        if other.has_tag_name("limit") {
            let values: Vec<String> =
                other.attributes().map(|a| format!("{} = {}", a.name(), a.value())).collect();
            let help = "a stop is a [[force]] of kind \"stop\"";
            findings.remark(other, &format!("{}: no limit is set; {help}", values.join(", ")));
        } else if !known.contains(&other.tag_name().name()) {
            findings.remark(other, "has no counterpart");
        }
    }
}
