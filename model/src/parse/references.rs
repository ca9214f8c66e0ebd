//! Names that refer to other parts of the model file: bodies, joints and their coordinates, drivers.

use super::names;
use super::reader::Reader;
use super::section::{Item, Section};
use crate::{CoordinateKind, JointCoordinate, JointKind};

/// Stands for a thing that the model file does not name correctly: the mistake is reported, and nothing has this index.
pub(super) const NOTHING: usize = usize::MAX;

/// Stands for a coordinate that the model file does not name correctly.
pub(super) const NO_COORDINATE: JointCoordinate = JointCoordinate { joint: NOTHING, coordinate: 0 };

/// Index of the thing that a section names, among those of its kind. `what` is both the key and the word for it.
pub(super) fn index(reader: &mut Reader<'_>, section: &Section<'_>, what: &'static str) -> usize {
    named(reader, section, what).unwrap_or(NOTHING)
}

/// The coordinate that a section names under `joint` and, where the joint has several, `coordinate`.
pub(super) fn coordinate(reader: &mut Reader<'_>, section: &Section<'_>) -> JointCoordinate {
    let found = coordinate_of(reader, section);
    if found.is_none() {
        reader.doubt(section.place("joint"));
    }
    found.unwrap_or(NO_COORDINATE)
}

fn coordinate_of(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<JointCoordinate> {
    let index = named(reader, section, "joint")?;
    let (name, kind) = (reader.named("joint")[index].clone()?, reader.joint_kinds[index]?);
    let coordinates = kind.coordinates();
    if coordinates.is_empty() {
        no_coordinate(reader, section, &name, kind);
        return None;
    }
    let names: Vec<&str> = coordinates.iter().map(|c| c.name()).collect();
    if !section.has("coordinate") {
        if let [_] = coordinates {
            return Some(JointCoordinate { joint: index, coordinate: 0 });
        }
        let example = format!("coordinate = {:?} (or {})", names[0], names::list(&names[1..]));
        section.require_as(reader, "coordinate", &example);
        return None;
    }
    let item = section.get("coordinate")?;
    let written = item.text(reader)?;
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

fn named(reader: &mut Reader<'_>, section: &Section<'_>, what: &'static str) -> Option<usize> {
    let item = section.find(reader, what)?;
    let name = item.text(reader)?;
    let index = reader.named(what).iter().position(|other| other.as_deref() == Some(name));
    if index.is_none() {
        nothing_named(reader, item, name);
    }
    index
}

/// Reports a thing that is not there, unless it may be one whose own name is missing.
fn nothing_named(reader: &mut Reader<'_>, item: Item<'_>, name: &str) {
    let what = item.key.name;
    let known = reader.named(what).iter().map(Option::as_deref).collect::<Option<Vec<&str>>>();
    let Some(known) = known else {
        reader.doubt(item.place);
        return;
    };
    let help = match known.as_slice() {
        [] => format!("add a [[{what}]] with this name"),
        known => format!("{}, or add a [[{what}]] with this name", names::instead(name, known)),
    };
    reader.missing(item.place, [format!("there is no {what} `{name}`"), format!("no such {what}"), help]);
}
