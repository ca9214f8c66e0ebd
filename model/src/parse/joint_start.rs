//! The start of a joint: values of its coordinates, its rates, and whether they are guesses.

use super::kinds::start_keys;
use super::numbers::{number, numbers, radians};
use super::reader::Reader;
use super::section::Section;
use crate::{CoordinateKind, JointKind, JointStartSpec, Number};

/// Reads the start; of a joint of unknown kind nothing.
pub(super) fn read(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    kind: Option<JointKind>,
) -> JointStartSpec {
    let Some(kind) = kind else { return JointStartSpec::default() };
    let position = kind.coordinates().iter().map(|&coordinate| value(reader, section, coordinate)).collect();
    JointStartSpec {
        position,
        rate: rate(reader, section, kind),
        orientation: section.given_vector(reader, "orientation"),
        is_rough: section.flag(reader, "rough"),
        set: Vec::new(),
    }
}

/// The value at which a coordinate starts; an angle may be in degrees.
fn value(reader: &mut Reader<'_>, section: &Section<'_>, coordinate: CoordinateKind) -> Option<Number> {
    let (plain, degrees) = start_keys(coordinate);
    let Some(degrees) = degrees else { return section.given(reader, plain) };
    section.either(reader, [plain, degrees], &format!("the {} is given twice", plain.replace('_', " ")))?;
    let given = section.given(reader, plain);
    given.or(section.plain(reader, degrees).map(radians))
}

/// One number of a joint with one coordinate, a list of the others'; three of a spherical joint.
fn rate(reader: &mut Reader<'_>, section: &Section<'_>, kind: JointKind) -> Option<Vec<Number>> {
    let item = section.get("rate")?;
    match kind.coordinates().len() {
        0 if kind == JointKind::Spherical => numbers(reader, item, 3),
        0 => None,
        1 => number(reader, item).map(|rate| vec![rate]),
        n => numbers(reader, item, n),
    }
}
