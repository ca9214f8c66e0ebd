//! Joints: their kind, where they are on each of their bodies, and how they start.

use toml::de::DeTable;

use super::numbers::{number, plain_number, vector};
use super::reader::Reader;
use super::section::{Item, Section};
use super::{names, page};
use crate::validate::{Owner, Place, Side};
use crate::{Joint, JointEnd, JointKind, JointStartSpec, Number, Rational, parse_decimal};

const KEYS: [&str; 12] = [
    "name",
    "kind",
    "first",
    "second",
    "point",
    "axis",
    "zero",
    "friction",
    "angle",
    "angle_deg",
    "rate",
    "orientation",
];
const END_KEYS: [&str; 4] = ["body", "point", "axis", "zero"];
const KINDS: [(&str, JointKind); 3] =
    [("revolute", JointKind::Revolute), ("spherical", JointKind::Spherical), ("fixed", JointKind::Fixed)];

/// π to more digits than any `f64` distinguishes, so that an angle in degrees is rounded once.
const PI: &str = "3.14159265358979323846264338327950288419717";

/// Reads all joints.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Joint> {
    let tables = page::tables(reader, page, "joint");
    let names = page::names(reader, &tables, Owner::Joint, "joint");
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            joint(reader, index, table, name.unwrap_or_else(|| format!("joint {}", index + 1)))
        })
        .collect()
}

fn joint(reader: &mut Reader<'_>, index: usize, table: &DeTable<'_>, name: String) -> Joint {
    let title = format!("joint `{name}`");
    let section = Section::open(reader, Owner::Joint(index), &title, table, &KEYS);
    let kind = kind(reader, &section, &title);
    if let Some(kind) = kind {
        refuse_misplaced(reader, &section, kind);
    }
    if matches!(kind, Some(JointKind::Revolute | JointKind::Fixed)) {
        require_direction(reader, &section, &title, "axis", "the joint's axis");
        require_direction(reader, &section, &title, "zero", "the direction from which the angle is measured");
    }
    let shared = Shared { section, title: &title, index, kind };
    let [first, second] = Side::BOTH.map(|side| end(reader, &shared, side));
    Joint {
        kind: kind.unwrap_or(JointKind::Revolute),
        first,
        second,
        friction: section.number_or(reader, "friction", 0),
        start: start(reader, &section, kind),
        name,
    }
}

fn kind(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> Option<JointKind> {
    let known = KINDS.map(|(name, _)| name);
    let example = format!("kind = \"revolute\" (or one of {})", names::list(&known[1..]));
    let item = section.require(reader, "kind", title, &example)?;
    let written = item.text(reader, &example)?;
    let kind = KINDS.iter().find(|(name, _)| *name == written).map(|(_, kind)| *kind);
    if kind.is_none() {
        let help = match names::nearest(written, &known) {
            Some(name) => format!("write `{name}`; the kinds are {}", names::list(&known)),
            None => format!("the kinds are {}", names::list(&known)),
        };
        item.wrong(reader, [format!("unknown kind of joint `{written}`"), "not a kind".to_owned(), help]);
    }
    kind
}

/// Keys that mean nothing for a kind.
fn refuse_misplaced(reader: &mut Reader<'_>, section: &Section<'_>, kind: JointKind) {
    let (name, keys): (_, &[(&'static str, &str)]) = match kind {
        JointKind::Revolute => {
            ("revolute", &[("orientation", "start it with `angle`, in rad, or `angle_deg`")])
        }
        JointKind::Spherical => (
            "spherical",
            &[
                ("axis", "remove it: a spherical joint turns about every axis"),
                ("zero", "remove it: a spherical joint has no angle to measure"),
                ("angle", "start it with orientation = [e0, e1, e2, e3]"),
                ("angle_deg", "start it with orientation = [e0, e1, e2, e3]"),
            ],
        ),
        JointKind::Fixed => (
            "fixed",
            &[
                ("angle", "remove it: turn `zero` on one of the ends to mount the body at an angle"),
                ("angle_deg", "remove it: turn `zero` on one of the ends to mount the body at an angle"),
                ("orientation", "remove it: choose `axis` and `zero` on the ends to mount the body turned"),
                ("rate", "remove it: a fixed joint does not move"),
                ("friction", "remove it: a fixed joint does not move"),
            ],
        ),
    };
    for (key, help) in keys {
        section.refuse(reader, key, &format!("a {name} joint has no `{key}`"), help);
    }
}

/// A joint with rotation rows has a direction for both ends, or one for each.
fn require_direction(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    key: &'static str,
    meaning: &str,
) {
    let has = |side: Side| {
        let end = section.get(side.key()).and_then(|item| item.value.get_ref().as_table());
        end.is_some_and(|end| end.contains_key(key))
    };
    let missing: Vec<&str> = Side::BOTH.into_iter().filter(|&side| !has(side)).map(Side::key).collect();
    if section.has(key) || missing.is_empty() || reader.is_doubted(section.place(key)) {
        return;
    }
    let (of, place) = match missing.as_slice() {
        [side] => (format!("`{side}` of {title}"), format!("in `{side}`")),
        _ => (title.to_owned(), "in the joint, for both bodies".to_owned()),
    };
    let example = if key == "axis" { "axis = [0, 0, 1]" } else { "zero = [1, 0, 0]" };
    let words = [
        format!("{of} has no `{key}`"),
        format!("needs `{key}`"),
        format!("write {example} {place}: {meaning}"),
    ];
    reader.missing(section.place(key), words);
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
    let body = if table.is_some() { body(reader, &section, &title) } else { 0 };
    if joint.kind == Some(JointKind::Spherical) {
        for key in ["axis", "zero"] {
            let message = format!("a spherical joint has no `{key}`");
            section.refuse(
                reader,
                key,
                &message,
                "remove it: a spherical joint only makes two points coincide",
            );
        }
    }
    JointEnd {
        body,
        point: inherited(reader, joint, &section, "point", [0; 3]),
        axis: direction(reader, joint, &section, "axis", [0, 0, 1]),
        zero: direction(reader, joint, &section, "zero", [1, 0, 0]),
    }
}

/// Index of the body that an end names.
fn body(reader: &mut Reader<'_>, section: &Section<'_>, title: &str) -> usize {
    let example = "body = \"...\", the name of a [[body]]";
    let Some(item) = section.require(reader, "body", title, example) else { return 0 };
    let Some(name) = item.text(reader, example) else { return 0 };
    let index = reader.bodies.iter().position(|body| body.as_deref() == Some(name));
    index.unwrap_or_else(|| {
        no_body(reader, item, name);
        0
    })
}

/// Reports a body that is not there, unless it may be one whose own name is missing.
fn no_body(reader: &mut Reader<'_>, item: Item<'_>, name: &str) {
    let known = reader.bodies.clone();
    let Some(known) = known.iter().map(Option::as_deref).collect::<Option<Vec<&str>>>() else {
        reader.doubt(item.place);
        return;
    };
    let help = match known.as_slice() {
        [] => "add a [[body]] with this name".to_owned(),
        known => format!("{}, or add a [[body]] with this name", names::instead(name, known)),
    };
    reader.missing(item.place, [format!("there is no body `{name}`"), "no such body".to_owned(), help]);
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

/// A direction of a joint frame; the default where the kind has none.
fn direction(
    reader: &mut Reader<'_>,
    joint: &Shared<'_, '_>,
    section: &Section<'_>,
    key: &'static str,
    default: [i64; 3],
) -> [Number; 3] {
    if joint.kind == Some(JointKind::Spherical) {
        return default.map(Number::integer);
    }
    inherited(reader, joint, section, key, default)
}

fn start(reader: &mut Reader<'_>, section: &Section<'_>, kind: Option<JointKind>) -> JointStartSpec {
    if section.has("angle") {
        section.refuse(reader, "angle_deg", "the angle is given twice", "remove `angle` or `angle_deg`");
    }
    let angle = section.get("angle").and_then(|item| number(reader, item));
    let degrees = section.get("angle_deg").and_then(|item| plain_number(reader, item));
    let rate = section.get("rate");
    JointStartSpec {
        angle: angle.or(degrees.map(radians)),
        rate: match kind {
            Some(JointKind::Revolute) => rate.and_then(|item| number(reader, item)).map(|rate| vec![rate]),
            Some(JointKind::Spherical) => rate.and_then(|item| vector::<3>(reader, item)).map(Vec::from),
            Some(JointKind::Fixed) | None => None,
        },
        orientation: section.get("orientation").and_then(|item: Item<'_>| vector(reader, item)),
    }
}

fn radians(degrees: Rational) -> Number {
    let pi = parse_decimal(PI).expect("π is a decimal");
    Number::Exact(degrees * pi / Rational::from_integer(180.into()))
}
