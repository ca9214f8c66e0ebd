//! Joints: their kind, where they are on each of their bodies, and the numbers of their kind.

use toml::Spanned;
use toml::de::DeValue;

use super::kinds;
use super::numbers::per_turn;
use super::reader::Reader;
use super::section::Section;
use super::{joint_start, references, tables};
use crate::validate::{Owner, Side};
use crate::{Joint, JointEnd, JointKind, Number};

/// Reads all joints. Their kinds are with the reader before anything refers to them.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Joint> {
    let sections = tables::each(reader, page, "joint", Owner::Joint).into_iter().enumerate();
    sections.map(|(index, (section, name))| joint(reader, (index, section), name)).collect()
}

fn joint(reader: &mut Reader<'_>, (index, mut section): (usize, Section<'_>), name: String) -> Joint {
    let kind = section.read_kind(reader, kinds::cure).and_then(|kind| JointKind::named(kind.word));
    reader.joint_kinds.push(kind);
    if let Some(kind) = kind {
        require_directions(reader, &section, kind);
    }
    let shared = Shared { section, index, kind };
    let [first, second] = Side::BOTH.map(|side| end(reader, &shared, side));
    let Shared { section, .. } = shared;
    Joint {
        kind: kind.unwrap_or(JointKind::Fixed),
        first,
        second,
        damping: section.number(reader, "damping"),
        armature: section.number(reader, "armature"),
        start: joint_start::read(reader, &section, kind),
        lead: if kind == Some(JointKind::Screw) { lead(reader, &section) } else { Number::integer(0) },
        length: if kind == Some(JointKind::Rod) {
            section.number(reader, "length")
        } else {
            Number::integer(0)
        },
        name,
    }
}

/// Advance of a screw, m/rad, from `lead` or from `pitch`, in m a turn; one, which is never refused, where it is wrong.
fn lead(reader: &mut Reader<'_>, section: &Section<'_>) -> Number {
    let item = section.either(reader, ["lead", "pitch"], "the advance of the screw is given twice");
    if item.is_none() {
        section.require(reader, "lead");
    }
    let pitch = if section.has("lead") { None } else { section.plain(reader, "pitch") };
    let lead = section.given(reader, "lead").or(pitch.map(per_turn));
    lead.unwrap_or_else(|| Number::integer(1))
}

/// Each side on which the kind measures directions has them, or they are in the joint, for both.
fn require_directions(reader: &mut Reader<'_>, section: &Section<'_>, kind: JointKind) {
    let sides = kinds::directed_sides(kind);
    if !sides.is_empty() {
        require_direction(reader, section, ("axis", "the joint's axis", sides));
        let meaning = match kind {
            JointKind::Prismatic | JointKind::PointOnLine => "a direction that is not parallel to the axis",
            _ => "the direction from which the angle is measured",
        };
        require_direction(reader, section, ("zero", meaning, sides));
    }
}

fn require_direction(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
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
    let title = &section.title;
    let (of, place) = match missing.as_slice() {
        [side] => (format!("`{side}` of {title}"), format!("in `{side}`")),
        _ => (title.clone(), "in the joint, for both bodies".to_owned()),
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
struct Shared<'t> {
    section: Section<'t>,
    index: usize,
    kind: Option<JointKind>,
}

fn end(reader: &mut Reader<'_>, joint: &Shared<'_>, side: Side) -> JointEnd {
    let title = format!("`{}` of {}", side.key(), joint.section.title);
    let end = joint.section.inner(reader, side.key(), (Owner::End(joint.index, side), &title));
    if let Some(end) = &end {
        refuse_directions(reader, joint, end, side);
    }
    // A key of the end, or else of the joint, or else its default.
    let own = |key| end.as_ref().filter(|end| end.has(key)).unwrap_or(&joint.section);
    let is_directed = joint.kind.is_some_and(|kind| kinds::directed_sides(kind).contains(&side));
    let mut direction = |key, default: [i64; 3]| {
        let given = if is_directed { own(key).given_vector(reader, key) } else { None };
        given.unwrap_or_else(|| default.map(Number::integer))
    };
    let [axis, zero] = [direction("axis", [0, 0, 1]), direction("zero", [1, 0, 0])];
    let body = end.as_ref().map_or(0, |end| match references::index(reader, end, "body") {
        references::NOTHING => 0,
        body => body,
    });
    JointEnd { body, point: own("point").vector(reader, "point"), axis, zero }
}

/// An end of a joint that measures nothing on this side has no directions of its own.
fn refuse_directions(reader: &mut Reader<'_>, joint: &Shared<'_>, section: &Section<'_>, side: Side) {
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
