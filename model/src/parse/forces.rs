//! Forces: in joints, between bodies and on bodies.

use toml::de::DeTable;

use super::couplings::NO_COORDINATE;
use super::numbers::{strength, strengths};
use super::reader::Reader;
use super::section::{self, Section};
use super::{references, tables};
use crate::validate::{Owner, Place, Side};
use crate::{Force, ForceKind, JointCoordinate, LoadFrame, Number, StopSide};

const KEYS: [&str; 21] = [
    "name",
    "kind",
    "joint",
    "coordinate",
    "stiffness",
    "free",
    "damping",
    "level",
    "rate",
    "limit",
    "side",
    "softness",
    "value",
    "first",
    "second",
    "free_length",
    "body",
    "point",
    "force",
    "torque",
    "frame",
];
const END_KEYS: [&str; 2] = ["body", "point"];
const SIDES: [(&str, StopSide); 2] = [("lower", StopSide::Lower), ("upper", StopSide::Upper)];
const FRAMES: [(&str, LoadFrame); 2] = [("global", LoadFrame::Global), ("body", LoadFrame::Body)];

/// The kinds in the model file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Spring,
    Damper,
    Coulomb,
    Stop,
    Motor,
    Link,
    Load,
}

const KINDS: [(&str, Kind); 7] = [
    ("spring", Kind::Spring),
    ("damper", Kind::Damper),
    ("coulomb", Kind::Coulomb),
    ("stop", Kind::Stop),
    ("motor", Kind::Motor),
    ("link", Kind::Link),
    ("load", Kind::Load),
];

impl Kind {
    /// The kind's own keys, after its name and kind.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Spring => &["joint", "coordinate", "stiffness", "free"],
            Self::Damper => &["joint", "coordinate", "damping"],
            Self::Coulomb => &["joint", "coordinate", "level", "rate"],
            Self::Stop => &["joint", "coordinate", "limit", "side", "stiffness", "damping", "softness"],
            Self::Motor => &["joint", "coordinate", "value"],
            Self::Link => &["first", "second", "stiffness", "damping", "free_length"],
            Self::Load => &["body", "point", "force", "torque", "frame"],
        }
    }
}

/// Reads all forces.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Force> {
    let tables = tables::tables(reader, page, "force");
    let names = tables::names(reader, &tables, Owner::Force, "force");
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            force(reader, index, table, name.unwrap_or_else(|| format!("force {}", index + 1)))
        })
        .collect()
}

fn force(reader: &mut Reader<'_>, index: usize, table: &DeTable<'_>, name: String) -> Force {
    let title = format!("force `{name}`");
    let section = Section::open(reader, Owner::Force(index), &title, table, &KEYS);
    let kind = section.require_choice(reader, "kind", &title, ("kind of force", &KINDS));
    if let Some(kind) = kind {
        let word = KINDS.iter().find(|(_, other)| *other == kind).map_or("", |(word, _)| word);
        let kinds = KINDS.map(|(word, kind)| (word, kind.keys()));
        section::refuse_others(reader, &section, &KEYS, (word, &kinds));
    }
    let force = Reading { section, title: &title, index };
    let kind = match kind {
        Some(Kind::Link) => force.link(reader),
        Some(Kind::Load) => force.load(reader),
        Some(kind) => force.along(reader, kind),
        // Of a force of unknown kind nothing is asked.
        None => ForceKind::Motor { on: NO_COORDINATE, value: Number::integer(0) },
    };
    Force { name, kind }
}

/// A force that is being read.
struct Reading<'t, 'a> {
    section: Section<'t>,
    title: &'a str,
    index: usize,
}

impl Reading<'_, '_> {
    /// A force along a joint coordinate.
    fn along(&self, reader: &mut Reader<'_>, kind: Kind) -> ForceKind {
        let on = references::coordinate(reader, &self.section, self.title).unwrap_or(NO_COORDINATE);
        match kind {
            Kind::Spring => ForceKind::Spring {
                on,
                stiffness: self.number(reader, "stiffness", "in N.m/rad or N/m"),
                free: self.section.number_or(reader, "free", 0),
            },
            Kind::Damper => {
                ForceKind::Damper { on, damping: self.strength(reader, "damping", "in N.m.s/rad or N.s/m") }
            }
            Kind::Coulomb => ForceKind::Coulomb {
                on,
                level: self.strength(reader, "level", "in N.m or N"),
                rate: self.number(
                    reader,
                    "rate",
                    "in rad/s or m/s, where friction reaches 76 % of its level",
                ),
            },
            Kind::Stop => self.stop(reader, on),
            Kind::Motor | Kind::Link | Kind::Load => {
                ForceKind::Motor { on, value: self.strength(reader, "value", "in N.m or N, or an input") }
            }
        }
    }

    fn stop(&self, reader: &mut Reader<'_>, on: JointCoordinate) -> ForceKind {
        let side = self.section.require_choice(reader, "side", self.title, ("side", &SIDES));
        ForceKind::Stop {
            on,
            limit: self.number(reader, "limit", "in rad or m"),
            side: side.unwrap_or(StopSide::Upper),
            stiffness: self.number(reader, "stiffness", "in N.m/rad or N/m"),
            damping: self.strength_or_zero(reader, "damping"),
            softness: self.number(
                reader,
                "softness",
                "in rad or m: the distance over which the force of the stop builds up",
            ),
        }
    }

    fn link(&self, reader: &mut Reader<'_>) -> ForceKind {
        let [first, second] = Side::BOTH.map(|side| self.end(reader, side));
        if !self.section.has("stiffness") && !self.section.has("damping") {
            let example = "stiffness = ..., in N/m, or damping = ..., in N.s/m";
            self.section.require(reader, "stiffness", self.title, example);
        }
        if self.section.has("stiffness") {
            self.section.require(reader, "free_length", self.title, "free_length = ..., in m");
        }
        ForceKind::Link {
            first,
            second,
            stiffness: self.section.number_or(reader, "stiffness", 0),
            damping: self.strength_or_zero(reader, "damping"),
            free_length: self.section.number_or(reader, "free_length", 0),
        }
    }

    /// A body and a point on it.
    fn end(&self, reader: &mut Reader<'_>, side: Side) -> (usize, [Number; 3]) {
        let example = format!("{} = {{ body = \"...\", point = [0, 0, 0] }}", side.key());
        let empty = DeTable::new();
        let item = self.section.require(reader, side.key(), self.title, &example);
        let table = item.and_then(|item| item.table(reader, &example));
        let owner = Owner::ForceEnd(self.index, side);
        if let Some(item) = item {
            reader.mark(Place { owner, key: "" }, item.span());
        }
        let title = format!("`{}` of {}", side.key(), self.title);
        let section = Section::open(reader, owner, &title, table.unwrap_or(&empty), &END_KEYS);
        let body = table.and_then(|_| references::body(reader, &section, &title));
        (body.unwrap_or(references::NOTHING), section.vector_or(reader, "point", [0; 3]))
    }

    fn load(&self, reader: &mut Reader<'_>) -> ForceKind {
        let body = references::body(reader, &self.section, self.title).unwrap_or(references::NOTHING);
        if !self.section.has("force") && !self.section.has("torque") {
            let example = "force = [0, 0, 0], in N, or torque = [0, 0, 0], in N.m";
            self.section.require(reader, "force", self.title, example);
        }
        let frame = self.section.get("frame");
        let frame = frame.and_then(|item| item.choice(reader, ("frame", &FRAMES)));
        let [force, torque] = ["force", "torque"].map(|key| {
            let vector = self.section.get(key).and_then(|item| strengths(reader, item));
            vector.unwrap_or_else(|| std::array::from_fn(|_| Number::integer(0)))
        });
        ForceKind::Load {
            body,
            point: self.section.vector_or(reader, "point", [0; 3]),
            force,
            torque,
            frame: frame.unwrap_or(LoadFrame::Global),
        }
    }

    /// A number that must be there and cannot be an input; one, which is never refused, where it is not.
    fn number(&self, reader: &mut Reader<'_>, key: &'static str, meaning: &str) -> Number {
        self.section.require(reader, key, self.title, &format!("{key} = ..., {meaning}"));
        self.section.number_or(reader, key, 1)
    }

    /// The strength of a force, which must be there.
    fn strength(&self, reader: &mut Reader<'_>, key: &'static str, meaning: &str) -> Number {
        self.section.require(reader, key, self.title, &format!("{key} = ..., {meaning}"));
        self.strength_or_zero(reader, key)
    }

    fn strength_or_zero(&self, reader: &mut Reader<'_>, key: &'static str) -> Number {
        let number = self.section.get(key).and_then(|item| strength(reader, item));
        number.unwrap_or_else(|| Number::integer(0))
    }
}
