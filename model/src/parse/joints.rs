//! Joints: their kind, where they are on each of their bodies, and the numbers of their kind.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::kinds::{self, KINDS};
use super::numbers::{number, per_turn, plain_number};
use super::reader::{NamedJoint, Reader};
use super::section::Section;
use super::{joint_start, references, tables};
use crate::validate::{Owner, Place, Side};
use crate::{Joint, JointEnd, JointKind, Number};

const KEYS: [&str; 24] = [
    "name",
    "kind",
    "first",
    "second",
    "point",
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
    "rough",
];
const END_KEYS: [&str; 4] = ["body", "point", "axis", "zero"];

/// Reads all joints. Their names and kinds are with the reader before anything refers to them.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Joint> {
    let tables = tables::tables(reader, page, "joint");
    let names = tables::names(reader, &tables, Owner::Joint, "joint");
    let mut joints = Vec::new();
    for (index, ((_, table), name)) in tables.iter().zip(names).enumerate() {
        let title = name.clone().unwrap_or_else(|| format!("joint {}", index + 1));
        let (joint, kind) = joint(reader, index, table, title);
        joints.push(joint);
        reader.joints.push(NamedJoint { name, kind });
    }
    joints
}

fn joint(
    reader: &mut Reader<'_>,
    index: usize,
    table: &DeTable<'_>,
    name: String,
) -> (Joint, Option<JointKind>) {
    let title = format!("joint `{name}`");
    let section = Section::open(reader, Owner::Joint(index), &title, table, &KEYS);
    let kind = section.require_choice(reader, "kind", &title, ("kind of joint", &KINDS));
    if let Some(kind) = kind {
        kinds::refuse_misplaced(reader, &section, kind);
        require_directions(reader, &section, &title, kind);
    }
    let shared = Shared { section, title: &title, index, kind };
    let [first, second] = Side::BOTH.map(|side| end(reader, &shared, side));
    let joint = Joint {
        kind: kind.unwrap_or(JointKind::Fixed),
        first,
        second,
        damping: section.number_or(reader, "damping", 0),
        armature: section.number_or(reader, "armature", 0),
        start: joint_start::read(reader, &section, kind),
        lead: lead(reader, &shared),
        length: length(reader, &shared),
        name,
    };
    (joint, kind)
}

/// Advance of a screw, m/rad, from `lead` or from `pitch`, in m a turn.
fn lead(reader: &mut Reader<'_>, joint: &Shared<'_, '_>) -> Number {
    let section = &joint.section;
    if section.has("lead") {
        section.refuse(
            reader,
            "pitch",
            "the advance of the screw is given twice",
            "remove `lead` or `pitch`",
        );
    }
    let lead = section.get("lead").and_then(|item| number(reader, item));
    let pitch = section.get("pitch").and_then(|item| plain_number(reader, item)).map(per_turn);
    let is_given = section.has("lead") || section.has("pitch");
    if joint.kind == Some(JointKind::Screw) && !is_given {
        let example = "lead = ..., in m/rad, or pitch = ..., in m a turn";
        section.require(reader, "lead", joint.title, example);
    }
    lead.or(pitch).unwrap_or_else(|| Number::integer(i64::from(is_given)))
}

/// Length of a rod, m.
fn length(reader: &mut Reader<'_>, joint: &Shared<'_, '_>) -> Number {
    if joint.kind != Some(JointKind::Rod) {
        return Number::integer(0);
    }
    let item = joint.section.require(reader, "length", joint.title, "length = ..., in m");
    item.and_then(|item| number(reader, item)).unwrap_or_else(|| Number::integer(1))
}

/// Each side on which the kind measures directions has them, or they are in the joint, for both.
fn require_directions(reader: &mut Reader<'_>, section: &Section<'_>, title: &str, kind: JointKind) {
    let sides = kinds::directed_sides(kind);
    if !sides.is_empty() {
        require_direction(reader, section, title, ("axis", "the joint's axis", sides));
        let meaning = match kind {
            JointKind::Prismatic | JointKind::PointOnLine => "a direction that is not parallel to the axis",
            _ => "the direction from which the angle is measured",
        };
        require_direction(reader, section, title, ("zero", meaning, sides));
    }
}

fn require_direction(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    (key, meaning, sides): (&'static str, &str, &[Side]),
) {
    let has = |side: Side| {
        let end = section.get(side.key()).and_then(|item| item.value.get_ref().as_table());
        end.is_some_and(|end| end.contains_key(key))
    };
    let missing: Vec<&str> = sides.iter().filter(|&&side| !has(side)).map(|side| side.key()).collect();
    if section.has(key) || missing.is_empty() || reader.is_doubted(section.place(key)) {
        return;
    }
    let (of, place) = match missing.as_slice() {
        [side] => (format!("`{side}` of {title}"), format!("in `{side}`")),
        _ => (title.to_owned(), "in the joint, for both bodies".to_owned()),
    };
    let other = if key == "axis" { "zero" } else { "axis" };
    let of_ends = sides.iter().map(|side| {
        let end = section.get(side.key()).and_then(|item| item.value.get_ref().as_table());
        end.and_then(|end| end.get(other)).or_else(|| section.get(other).map(|item| item.value))
    });
    let others: Vec<&DeValue<'_>> = of_ends.flatten().map(Spanned::get_ref).collect();
    let example = format!("{key} = {}", off(key, &others));
    let words = [
        format!("{of} has no `{key}`"),
        format!("needs `{key}`"),
        format!("write {example} {place}: {meaning}"),
    ];
    reader.missing(section.place(key), words);
}

/// A coordinate direction for a key that is parallel to none of the others, which may be parameters or no directions at
/// all.
fn off(key: &str, others: &[&DeValue<'_>]) -> &'static str {
    let is_zero = |value: &DeValue<'_>| match value {
        DeValue::Integer(number) => number.as_str().trim_start_matches(['+', '-']) == "0",
        DeValue::Float(number) => number.as_str().parse() == Ok(0.0),
        _ => false,
    };
    let across = |direction: &DeValue<'_>, k: usize| {
        let element = direction.as_array().and_then(|elements| elements.get(k));
        element.is_none_or(|element| is_zero(element.get_ref()))
    };
    let alone = |direction: &DeValue<'_>, k: usize| (0..3).all(|l| l == k || across(direction, l));
    let order = if key == "axis" { [2, 0, 1] } else { [0, 1, 2] };
    let suits = |k: &usize| others.iter().all(|other| other.as_array().is_none() || !alone(other, *k));
    let clear = |k: &usize| others.iter().all(|other| across(other, *k));
    let best = order.into_iter().find(clear).or_else(|| order.into_iter().find(suits));
    ["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"][best.unwrap_or(order[0])]
}

/// What both ends of a joint share.
struct Shared<'t, 'a> {
    section: Section<'t>,
    title: &'a str,
    index: usize,
    kind: Option<JointKind>,
}

fn end(reader: &mut Reader<'_>, joint: &Shared<'_, '_>, side: Side) -> JointEnd {
    let written =
        joint.section.get(side.key()).and_then(|item| item.value.get_ref().as_str()).unwrap_or("...");
    let example = format!("{} = {{ body = {written:?} }}", side.key());
    let empty = DeTable::new();
    let item = joint.section.require(reader, side.key(), joint.title, &example);
    let table = item.and_then(|item| item.table(reader, &example));
    let title = format!("`{}` of {}", side.key(), joint.title);
    let owner = Owner::End(joint.index, side);
    if let Some(item) = item {
        reader.mark(Place { owner, key: "" }, item.span());
    }
    let section = Section::open(reader, owner, &title, table.unwrap_or(&empty), &END_KEYS);
    let body = table.and_then(|_| references::body(reader, &section, &title)).unwrap_or(0);
    refuse_directions(reader, joint, &section, side);
    JointEnd {
        body,
        point: inherited(reader, joint, &section, "point", [0; 3]),
        axis: direction(reader, joint, &section, side, "axis"),
        zero: direction(reader, joint, &section, side, "zero"),
    }
}

/// An end of a joint that measures nothing on this side has no directions of its own.
fn refuse_directions(reader: &mut Reader<'_>, joint: &Shared<'_, '_>, section: &Section<'_>, side: Side) {
    let Some(kind) = joint.kind.filter(|&kind| !kinds::directed_sides(kind).contains(&side)) else { return };
    for key in ["axis", "zero"] {
        let (message, help) = match kind {
            JointKind::PointOnLine => (
                format!("the second body of a point_on_line joint takes no `{key}`"),
                "remove it: its point stays on the axis of the first body",
            ),
            JointKind::Rod => (format!("a rod takes no `{key}`"), "remove it: a rod only joins two points"),
            _ => (
                format!("a spherical joint takes no `{key}`"),
                "remove it: a spherical joint only makes two points coincide",
            ),
        };
        section.refuse(reader, key, &message, help);
    }
}

/// A vector of the end, or else of the joint, or else a default.
fn inherited(
    reader: &mut Reader<'_>,
    joint: &Shared<'_, '_>,
    section: &Section<'_>,
    key: &'static str,
    default: [i64; 3],
) -> [Number; 3] {
    if section.has(key) {
        section.vector_or(reader, key, default)
    } else {
        joint.section.vector_or(reader, key, default)
    }
}

/// A direction of a joint frame; a default where the kind measures none on this side.
fn direction(
    reader: &mut Reader<'_>,
    joint: &Shared<'_, '_>,
    section: &Section<'_>,
    side: Side,
    key: &'static str,
) -> [Number; 3] {
    let default = if key == "axis" { [0, 0, 1] } else { [1, 0, 0] };
    match joint.kind {
        Some(kind) if kinds::directed_sides(kind).contains(&side) => {
            inherited(reader, joint, section, key, default)
        }
        _ => default.map(Number::integer),
    }
}
