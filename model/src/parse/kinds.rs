//! The kinds of joint in the model file, and which keys each of them has.

use super::reader::Reader;
use super::section::Section;
use crate::{CoordinateKind, JointKind};

/// The names of the kinds.
pub(super) const KINDS: [(&str, JointKind); 10] = {
    use JointKind::{
        Cylindrical, Fixed, Planar, PointOnLine, Prismatic, Revolute, Rod, Screw, Spherical, Universal,
    };
    let all =
        [Revolute, Spherical, Fixed, Universal, Cylindrical, Prismatic, Planar, Screw, PointOnLine, Rod];
    let mut named = [("", Revolute); 10];
    let mut k = 0;
    while k < all.len() {
        named[k] = (all[k].name(), all[k]);
        k += 1;
    }
    named
};

/// Keys that only some kinds have.
const OF_KINDS: [&str; 18] = [
    "axis",
    "zero",
    "damping",
    "armature",
    "lead",
    "pitch",
    "length",
    "angle",
    "angle_deg",
    "first_angle",
    "first_angle_deg",
    "second_angle",
    "second_angle_deg",
    "displacement",
    "x",
    "y",
    "orientation",
    "rate",
];

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
pub(super) fn directed_sides(kind: JointKind) -> &'static [crate::validate::Side] {
    use crate::validate::Side::{First, Second};
    match kind {
        JointKind::Spherical | JointKind::Rod => &[],
        JointKind::PointOnLine => &[First],
        _ => &[First, Second],
    }
}

/// Refuses the keys that mean nothing for a kind.
pub(super) fn refuse_misplaced(reader: &mut Reader<'_>, section: &Section<'_>, kind: JointKind) {
    for key in OF_KINDS.into_iter().chain(["rough"]) {
        if !has(kind, key) {
            let message = format!("a {} takes no `{key}`", title(kind));
            section.refuse(reader, key, &message, &help(kind, key));
        }
    }
}

/// A joint of the kind, in words.
pub(super) fn title(kind: JointKind) -> String {
    match kind {
        JointKind::Rod => "rod".to_owned(),
        _ => format!("{} joint", kind.name()),
    }
}

fn has(kind: JointKind, key: &str) -> bool {
    let starts = kind.coordinates().iter().any(|&coordinate| {
        let (plain, degrees) = start_keys(coordinate);
        key == plain || Some(key) == degrees
    });
    match key {
        "axis" | "zero" => !directed_sides(kind).is_empty(),
        "damping" => kind == JointKind::Spherical || kind.coordinates().len() == 1,
        "armature" => kind.turns_one_rotor(),
        "lead" | "pitch" => kind == JointKind::Screw,
        "length" => kind == JointKind::Rod,
        "orientation" => kind == JointKind::Spherical,
        "rate" | "rough" => kind == JointKind::Spherical || !kind.coordinates().is_empty(),
        _ => starts,
    }
}

/// What to write instead of a key that a kind does not have.
fn help(kind: JointKind, key: &str) -> String {
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
        _ => return start_help(kind),
    };
    help.to_owned()
}

fn start_help(kind: JointKind) -> String {
    let of = |&coordinate: &CoordinateKind| match start_keys(coordinate) {
        (plain, Some(degrees)) => format!("`{plain}`, in rad, or `{degrees}`"),
        (plain, None) => format!("`{plain}`, in m"),
    };
    let keys: Vec<String> = kind.coordinates().iter().map(of).collect();
    format!("start it with {}", keys.join("; "))
}
