//! Outputs: what is to be computed besides the motion.

use toml::de::DeTable;

use super::numbers::vector;
use super::reader::Reader;
use super::section::{self, Section};
use super::{references, tables};
use crate::validate::Owner;
use crate::{BodyFrame, Force, Output, OutputKind};

const KEYS: [&str; 9] =
    ["name", "kind", "body", "point", "orientation", "joint", "driver", "coupler", "force"];

/// The kinds in the model file.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Pose,
    Velocity,
    Acceleration,
    Inertial,
    Reaction,
    Driver,
    Coupler,
    Spring,
    Link,
    Energy,
    Power,
}

const KINDS: [(&str, Kind); 11] = [
    ("pose", Kind::Pose),
    ("velocity", Kind::Velocity),
    ("acceleration", Kind::Acceleration),
    ("inertial", Kind::Inertial),
    ("reaction", Kind::Reaction),
    ("driver", Kind::Driver),
    ("coupler", Kind::Coupler),
    ("spring", Kind::Spring),
    ("link", Kind::Link),
    ("energy", Kind::Energy),
    ("power", Kind::Power),
];

impl Kind {
    /// The kind's own keys, after its name and kind.
    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Pose | Self::Velocity | Self::Acceleration | Self::Inertial => {
                &["body", "point", "orientation"]
            }
            Self::Reaction => &["joint"],
            Self::Driver => &["driver"],
            Self::Coupler => &["coupler"],
            Self::Spring | Self::Link => &["force"],
            Self::Energy | Self::Power => &[],
        }
    }
}

/// Reads all outputs.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>, forces: &[Force]) -> Vec<Output> {
    let tables = tables::tables(reader, page, "output");
    let names = tables::names(reader, &tables, Owner::Output, "output");
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            output(reader, (index, forces), table, name.unwrap_or_else(|| format!("output {}", index + 1)))
        })
        .collect()
}

fn output(
    reader: &mut Reader<'_>,
    (index, forces): (usize, &[Force]),
    table: &DeTable<'_>,
    name: String,
) -> Output {
    let title = format!("output `{name}`");
    let section = Section::open(reader, Owner::Output(index), &title, table, &KEYS);
    let kind = section.require_choice(reader, "kind", &title, ("kind of output", &KINDS));
    if let Some(kind) = kind {
        let word = KINDS.iter().find(|(_, other)| *other == kind).map_or("", |(word, _)| word);
        let kinds = KINDS.map(|(word, kind)| (word, kind.keys()));
        section::refuse_others(reader, &section, &KEYS, (word, &kinds));
    }
    let kind = match kind {
        Some(Kind::Reaction) => OutputKind::Reaction {
            joint: references::joint(reader, &section, &title).unwrap_or(references::NOTHING),
        },
        Some(Kind::Driver) => OutputKind::Driver {
            driver: references::driver(reader, &section, &title).unwrap_or(references::NOTHING),
        },
        Some(Kind::Coupler) => OutputKind::Coupler {
            coupler: references::coupler(reader, &section, &title).unwrap_or(references::NOTHING),
        },
        Some(Kind::Spring) => OutputKind::Spring {
            force: references::force(reader, &section, &title, forces).unwrap_or(references::NOTHING),
        },
        Some(Kind::Link) => OutputKind::Link {
            force: references::force(reader, &section, &title, forces).unwrap_or(references::NOTHING),
        },
        Some(Kind::Power) => OutputKind::Power,
        Some(Kind::Energy) | None => OutputKind::Energy,
        Some(kind) => of_body(reader, &section, &title, kind),
    };
    Output { name, kind }
}

fn of_body(reader: &mut Reader<'_>, section: &Section<'_>, title: &str, kind: Kind) -> OutputKind {
    let body = references::body(reader, section, title).unwrap_or(references::NOTHING);
    let point = section.vector_or(reader, "point", [0; 3]);
    let orientation = section.get("orientation").and_then(|item| vector(reader, item));
    let frame = BodyFrame { body, point, orientation };
    match kind {
        Kind::Velocity => OutputKind::Velocity(frame),
        Kind::Acceleration => OutputKind::Acceleration(frame),
        Kind::Inertial => OutputKind::Inertial(frame),
        _ => OutputKind::Pose(frame),
    }
}
