//! Elements that a model file has nothing for: told, or refused where the robot would be another mechanism without
//! them.

use super::document::Node;
use super::element::{Findings, XACRO};
use super::shapes;

/// Elements with one of these words in their names hold a mechanism together or act on it.
const WORDS: [&str; 16] = [
    "joint",
    "link",
    "loop",
    "constraint",
    "closure",
    "equality",
    "weld",
    "tendon",
    "spring",
    "stiffness",
    "damp",
    "bushing",
    "force",
    "rotor",
    "gear",
    "screw",
];

/// These say how a robot is driven, sensed, planned for or drawn, whatever they name inside.
const HARMLESS: [&str; 12] = [
    "ros2_control",
    "transmission",
    "sensor",
    "material",
    "plugin",
    "contact",
    "group",
    "group_state",
    "end_effector",
    "disable_collisions",
    "calibration",
    "safety_controller",
];

/// What says it is part of a `<gazebo>` of which the robot's motion depends.
const IN_GAZEBO: [&str; 3] = ["joint", "link", "springStiffness"];

/// Tells of the children that are none of the known ones, and refuses those without which the robot is another, and a
/// second one of what a link or a joint has once.
pub(super) fn tell(findings: &mut Findings<'_>, node: Node<'_>, known: &[&str], once: &[&str]) {
    let is_kept = |child: &Node<'_>| known.contains(&child.name()) || shapes::color(*child).is_some();
    for other in node.children().filter(|child| !is_kept(child)) {
        let culprit = culprit(other);
        if other.name().starts_with("xacro:") {
            findings.problem(other, XACRO);
        } else if let Some(culprit) = culprit {
            let name = other.name();
            findings.problem(
                culprit,
                &format!("a model file has nothing for this, and without it the robot may be another mechanism: if it \
                          is not, give --ignore {name}"),
            );
        } else {
            findings.unused(other);
        }
    }
    for name in once {
        if let Some(second) = node.children().filter(|child| child.is(name)).nth(1) {
            findings.problem(second, "there is an earlier one, and a robot has it once: delete one of them");
        }
    }
}

/// The element inside of another, or that one, without which the mechanism is another.
fn culprit(node: Node<'_>) -> Option<Node<'_>> {
    if node.is("gazebo") {
        let counts = |child: &Node<'_>| {
            let name = child.name().split(':').next().unwrap_or_default();
            IN_GAZEBO.contains(&name)
        };
        return node.children().find(counts);
    }
    let words: &[&str] = if HARMLESS.contains(&node.name()) { &["rotor"] } else { &WORDS };
    let is_one = |inner: &Node<'_>| words.iter().any(|word| inner.name().to_ascii_lowercase().contains(word));
    node.descendants().find(is_one)
}
