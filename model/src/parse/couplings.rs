//! Couplers between two joint coordinates, and drivers that prescribe one in time.

use toml::de::DeTable;

use super::numbers::number;
use super::reader::Reader;
use super::section::Section;
use super::{motion, references, tables};
use crate::validate::{Owner, Place, Side};
use crate::{Coupler, Driver, JointCoordinate, Number};

const COUPLER_KEYS: [&str; 5] = ["name", "first", "second", "ratio", "offset"];
const COUPLER_END_KEYS: [&str; 2] = ["joint", "coordinate"];
const DRIVER_KEYS: [&str; 4] = ["name", "joint", "coordinate", "motion"];

/// Stands for a coordinate that the model file does not name correctly: the mistake is reported, and no joint has this
/// index.
pub(super) const NO_COORDINATE: JointCoordinate = JointCoordinate { joint: usize::MAX, coordinate: 0 };

/// Reads all couplers. Their names are with the reader before any output refers to them.
pub(super) fn couplers(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Coupler> {
    let tables = tables::tables(reader, page, "coupler");
    let names = tables::names(reader, &tables, Owner::Coupler, "coupler");
    reader.couplers.clone_from(&names);
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            coupler(reader, index, table, name.unwrap_or_else(|| format!("coupler {}", index + 1)))
        })
        .collect()
}

fn coupler(reader: &mut Reader<'_>, index: usize, table: &DeTable<'_>, name: String) -> Coupler {
    let title = format!("coupler `{name}`");
    let section = Section::open(reader, Owner::Coupler(index), &title, table, &COUPLER_KEYS);
    let [first, second] = Side::BOTH.map(|side| coupler_end(reader, &section, &title, index, side));
    let example = "ratio = ...: second = ratio * first + offset";
    let ratio = section.require(reader, "ratio", &title, example);
    let ratio = ratio.and_then(|item| number(reader, item)).unwrap_or_else(|| Number::integer(1));
    Coupler { name, first, second, ratio, offset: section.number_or(reader, "offset", 0) }
}

fn coupler_end(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    index: usize,
    side: Side,
) -> JointCoordinate {
    let example = format!("{} = {{ joint = \"...\" }}", side.key());
    let item = section.require(reader, side.key(), title, &example);
    let Some((item, table)) = item.and_then(|item| item.table(reader, &example).map(|table| (item, table)))
    else {
        return NO_COORDINATE;
    };
    let title = format!("`{}` of {title}", side.key());
    let owner = Owner::CouplerEnd(index, side);
    reader.mark(Place { owner, key: "" }, item.span());
    let section = Section::open(reader, owner, &title, table, &COUPLER_END_KEYS);
    references::coordinate(reader, &section, &title).unwrap_or(NO_COORDINATE)
}

/// Reads all drivers. Their names are with the reader before any output refers to them.
pub(super) fn drivers(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Driver> {
    let tables = tables::tables(reader, page, "driver");
    reader.drivers = tables::names(reader, &tables, Owner::Driver, "driver");
    let names = reader.drivers.clone();
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            driver(reader, index, table, name.unwrap_or_else(|| format!("driver {}", index + 1)))
        })
        .collect()
}

fn driver(reader: &mut Reader<'_>, index: usize, table: &DeTable<'_>, name: String) -> Driver {
    let title = format!("driver `{name}`");
    let section = Section::open(reader, Owner::Driver(index), &title, table, &DRIVER_KEYS);
    let coordinate = references::coordinate(reader, &section, &title).unwrap_or(NO_COORDINATE);
    let example = "motion = { sinusoid = { amplitude = 0.1, frequency_hz = 2 } }, or another motion";
    let motion = section.require(reader, "motion", &title, example);
    let motion = motion.and_then(|item| motion::read(reader, item)).unwrap_or_else(motion::rest);
    Driver { name, coordinate, motion }
}
