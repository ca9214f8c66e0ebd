//! Names that refer to other parts of the model file: bodies, joints and their coordinates, drivers.

use super::names;
use super::reader::{NamedJoint, Reader};
use super::section::{Item, Section};
use crate::{CoordinateKind, Force, JointCoordinate, JointKind};

/// Stands for a thing that the model file does not name correctly: the mistake is reported, and nothing has this index.
pub(super) const NOTHING: usize = usize::MAX;

/// Index of the body that a section names under `body`.
pub(super) fn body(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> Option<usize> {
    let known = reader.bodies.clone();
    named(reader, section, "body", title, &known)
}

/// Index of the joint that a section names under `joint`.
pub(super) fn joint(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> Option<usize> {
    let known: Vec<Option<String>> = reader.joints.iter().map(|joint| joint.name.clone()).collect();
    named(reader, section, "joint", title, &known)
}

/// Index of the driver that a section names under `driver`.
pub(super) fn driver(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> Option<usize> {
    let known = reader.drivers.clone();
    named(reader, section, "driver", title, &known)
}

/// Index of the coupler that a section names under `coupler`.
pub(super) fn coupler(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> Option<usize> {
    let known = reader.couplers.clone();
    named(reader, section, "coupler", title, &known)
}

/// Index of the force that a section names under `force`.
pub(super) fn force(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    forces: &[Force],
) -> Option<usize> {
    let known: Vec<_> = forces.iter().map(|force| Some(force.name.clone())).collect();
    named(reader, section, "force", title, &known)
}

/// The coordinate that a section names under `joint` and, where the joint has several, `coordinate`.
pub(super) fn coordinate(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
) -> Option<JointCoordinate> {
    let found = coordinate_of(reader, section, title);
    if found.is_none() {
        reader.doubt(section.place("joint"));
    }
    found
}

fn coordinate_of(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> Option<JointCoordinate> {
    let index = joint(reader, section, title)?;
    let NamedJoint { name: Some(name), kind: Some(kind) } = reader.joints[index].clone() else { return None };
    let coordinates = kind.coordinates();
    if coordinates.is_empty() {
        no_coordinate(reader, section, &name, kind);
        return None;
    }
    let names: Vec<&str> = coordinates.iter().map(|c| c.name()).collect();
    let Some(item) = section.get("coordinate") else {
        if let [_] = coordinates {
            return Some(JointCoordinate { joint: index, coordinate: 0 });
        }
        let example = format!("coordinate = {:?} (or {})", names[0], names::list(&names[1..]));
        section.require(reader, "coordinate", title, &example);
        return None;
    };
    let written = item.text(reader, &format!("coordinate = {:?}", names[0]))?;
    let coordinate = names.iter().position(|name| *name == written);
    if coordinate.is_none() {
        item.wrong(reader, unknown_coordinate(&name, coordinates, written));
    }
    coordinate.map(|coordinate| JointCoordinate { joint: index, coordinate })
}

fn unknown_coordinate(joint: &str, coordinates: &[CoordinateKind], written: &str) -> [String; 3] {
    let of = |c: &CoordinateKind| format!("`{}` ({})", c.name(), if c.is_angle() { "rad" } else { "m" });
    let listed: Vec<String> = coordinates.iter().map(of).collect();
    [
        format!("joint `{joint}` has no coordinate `{written}`"),
        "not a coordinate of this joint".to_owned(),
        format!("its coordinates are {}", listed.join(", ")),
    ]
}

fn no_coordinate(reader: &mut Reader<'_>, section: &Section<'_>, name: &str, kind: JointKind) {
    let Some(item) = section.get("joint") else { return };
    let (is, help) = match kind {
        JointKind::Spherical => (
            "spherical joint: it turns about every axis and has no coordinate",
            "name a joint with coordinates: three revolute joints, or a universal and a revolute one, turn as freely",
        ),
        JointKind::Rod => (
            "rod: it has no coordinate",
            "name another joint, or put a [[force]] of kind \"link\" between two points in place of the rod",
        ),
        _ => ("fixed joint: it does not move", "name a joint that moves"),
    };
    let words = [format!("joint `{name}` is a {is}"), "no coordinate here".to_owned(), help.to_owned()];
    item.wrong(reader, words);
}

/// Index of a thing among those of its kind. `what` is both the key and the word for it.
fn named(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    what: &'static str,
    title: &str,
    known: &[Option<String>],
) -> Option<usize> {
    let example = format!("{what} = \"...\", the name of a [[{what}]]");
    let item = section.require(reader, what, title, &example)?;
    let name = item.text(reader, &example)?;
    let index = known.iter().position(|other| other.as_deref() == Some(name));
    if index.is_none() {
        nothing_named(reader, item, name, known);
    }
    index
}

/// Reports a thing that is not there, unless it may be one whose own name is missing.
fn nothing_named(reader: &mut Reader<'_>, item: Item<'_>, name: &str, known: &[Option<String>]) {
    let what = item.key();
    let Some(known) = known.iter().map(Option::as_deref).collect::<Option<Vec<&str>>>() else {
        reader.doubt(item.place);
        return;
    };
    let help = match known.as_slice() {
        [] => format!("add a [[{what}]] with this name"),
        known => format!("{}, or add a [[{what}]] with this name", names::instead(name, known)),
    };
    reader.missing(item.place, [format!("there is no {what} `{name}`"), format!("no such {what}"), help]);
}
