//! Outputs: what is to be computed besides the motion.

use super::reader::Reader;
use super::section::Section;
use super::{references, tables};
use crate::validate::Owner;
use crate::{BodyFrame, Output, OutputKind};

/// Reads all outputs.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Output> {
    let sections = tables::each(reader, page, "output", Owner::Output).into_iter();
    sections
        .map(|(mut section, name)| {
            let kind = section.read_kind(reader, |_, _| None).map_or("energy", |kind| kind.word);
            Output { name, kind: output(reader, &section, kind) }
        })
        .collect()
}

fn output(reader: &mut Reader<'_>, section: &Section<'_>, kind: &str) -> OutputKind {
    let mut index = |what| references::index(reader, section, what);
    match kind {
        "reaction" => OutputKind::Reaction { joint: index("joint") },
        "driver" => OutputKind::Driver { driver: index("driver") },
        "coupler" => OutputKind::Coupler { coupler: index("coupler") },
        "spring" => OutputKind::Spring { force: index("force") },
        "link" => OutputKind::Link { force: index("force") },
        "power" => OutputKind::Power,
        "energy" => OutputKind::Energy,
        "velocity" => OutputKind::Velocity(frame(reader, section)),
        "acceleration" => OutputKind::Acceleration(frame(reader, section)),
        "inertial" => OutputKind::Inertial(frame(reader, section)),
        _ => OutputKind::Pose(frame(reader, section)),
    }
}

fn frame(reader: &mut Reader<'_>, section: &Section<'_>) -> BodyFrame {
    BodyFrame {
        body: references::index(reader, section, "body"),
        point: section.vector(reader, "point"),
        orientation: section.given_vector(reader, "orientation"),
    }
}
