//! The kinds of joint in the model file: how they start, and what to do about keys of others.

use crate::keys::{self, Kind};
use crate::validate::Side;
use crate::{CoordinateKind, JointKind};

/// The keys with which a coordinate starts: of an angle a second one in degrees.
pub(super) fn start_keys(coordinate: CoordinateKind) -> (&'static str, Option<&'static str>) {
    match coordinate {
        CoordinateKind::Angle => ("angle", Some("angle_deg")),
        CoordinateKind::FirstAngle => ("first_angle", Some("first_angle_deg")),
        CoordinateKind::SecondAngle => ("second_angle", Some("second_angle_deg")),
        CoordinateKind::Displacement => ("displacement", None),
        CoordinateKind::X => ("x", None),
        CoordinateKind::Y => ("y", None),
    }
}

/// How many directions a kind measures from: an axis and a zero direction on each of these sides.
pub(super) fn directed_sides(kind: JointKind) -> &'static [Side] {
    match kind {
        JointKind::PointOnLine => &Side::BOTH[..1],
        _ if keys::JOINT.kind(kind.name()).is_some_and(|kind| kind.key("axis").is_some()) => &Side::BOTH,
        _ => &[],
    }
}

/// What to write instead of a key that a kind does not have.
pub(super) fn cure(kind: &Kind, key: &str) -> Option<String> {
    let kind = JointKind::named(kind.word)?;
    let help = match (key, kind) {
        ("axis", JointKind::Spherical) => "remove it: a spherical joint turns about every axis",
        ("zero", JointKind::Spherical) => "remove it: a spherical joint has no angle to measure",
        ("axis" | "zero", _) => "remove it: a rod only joins two points",
        ("lead" | "pitch", _) => "remove it: only a screw advances as it turns",
        ("length", _) => "remove it: only a rod has a length",
        ("angle" | "angle_deg", JointKind::Fixed) => {
            "remove it: turn `zero` on one of the ends to mount the body at an angle"
        }
        ("orientation", JointKind::Fixed) => {
            "remove it: choose `axis` and `zero` on the ends to mount the body turned"
        }
        (_, JointKind::Fixed) => "remove it: a fixed joint does not move",
        (_, JointKind::Rod) => "remove it: a rod has no coordinate",
        ("armature", _) => {
            "remove it: a rotor turns with a joint of one freedom, revolute, prismatic or screw"
        }
        ("damping", _) => "add a [[force]] of kind \"damper\" on each coordinate that is to resist",
        (_, JointKind::Spherical) => "start it with orientation = [e0, e1, e2, e3]",
        _ => return Some(start_help(kind)),
    };
    Some(help.to_owned())
}

fn start_help(kind: JointKind) -> String {
    let of = |&coordinate: &CoordinateKind| match start_keys(coordinate) {
        (plain, Some(degrees)) => format!("`{plain}`, in rad, or `{degrees}`"),
        (plain, None) => format!("`{plain}`, in m"),
    };
    let keys: Vec<String> = kind.coordinates().iter().map(of).collect();
    format!("start it with {}", keys.join("; "))
}
