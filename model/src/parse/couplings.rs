//! Couplers between two joint coordinates, and drivers that prescribe one in time.

use super::reader::Reader;
use super::section::Section;
use super::{motion, references, tables};
use crate::validate::{Owner, Side};
use crate::{Coupler, Driver};

/// Reads all couplers.
pub(super) fn couplers(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Coupler> {
    let sections = tables::each(reader, page, "coupler", Owner::Coupler).into_iter().enumerate();
    sections
        .map(|(index, (section, name))| {
            let [first, second] = Side::BOTH.map(|side| {
                let title = format!("`{}` of {}", side.key(), section.title);
                let end = section.inner(reader, side.key(), (Owner::CouplerEnd(index, side), &title));
                end.map_or(references::NO_COORDINATE, |end| references::coordinate(reader, &end))
            });
            let [ratio, offset] = ["ratio", "offset"].map(|key| section.number(reader, key));
            Coupler { name, first, second, ratio, offset }
        })
        .collect()
}

/// Reads all drivers.
pub(super) fn drivers(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Driver> {
    let sections = tables::each(reader, page, "driver", Owner::Driver).into_iter();
    sections
        .map(|(section, name)| {
            let coordinate = references::coordinate(reader, &section);
            let motion = section.find(reader, "motion").and_then(|item| motion::read(reader, item));
            Driver { name, coordinate, motion: motion.unwrap_or_else(motion::rest) }
        })
        .collect()
}
