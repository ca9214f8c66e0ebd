//! Couplers between two joint coordinates, and drivers that prescribe one in time.

use super::formulas::Inputs;
use super::laws;
use super::lookup::wrong_within;
use super::reader::Reader;
use super::section::Section;
use super::{curves, motion, references, seen, tables};
use crate::validate::{Owner, Side};
use crate::{Coupler, Coupling, Driver, Formula, JointCoordinate, Seen};

/// Reads all couplers.
pub(super) fn couplers(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Coupler> {
    let sections = tables::each(reader, page, "coupler", Owner::Coupler).into_iter().enumerate();
    let one = |(index, (section, name)): (usize, (Section<'_>, String))| {
        let mut end = |side: Side| {
            let title = format!("`{}` of {}", side.key(), section.title);
            let end = section.inner(reader, side.key(), (Owner::CouplerEnd(index, side), &title));
            end.map_or(references::NO_COORDINATE, |end| references::coordinate(reader, &end))
        };
        let second = end(Side::Second);
        if section.has("formula") {
            return Coupler { name, second, by: by_formula(reader, &section, second) };
        }
        let first = end(Side::First);
        // With a formula neither may be there.
        section.require(reader, "first");
        section.require(reader, "ratio");
        let [ratio, offset] = ["ratio", "offset"].map(|key| section.number(reader, key));
        Coupler { name, second, by: Coupling::Linear { first, ratio, offset } }
    };
    sections.map(one).collect()
}

fn by_formula(reader: &mut Reader<'_>, section: &Section<'_>, second: JointCoordinate) -> Coupling {
    for key in ["first", "ratio", "offset"] {
        let message = format!("{} has a `formula` and `{key}`", section.title);
        section.refuse(reader, key, &message, "remove it: the formula says all of it");
    }
    let item = section.find(reader, "formula");
    let text = item.and_then(|item| Some((item, item.text(reader)?)));
    let known = seen::known(reader, &[]);
    let refuse = |name: &str, seen: Seen| {
        let words = match seen {
            Seen::Coordinate(on) if on == second => [
                format!("a coupler's formula cannot name its second coordinate `{name}`"),
                "itself".to_owned(),
            ],
            Seen::Coordinate(_) => return None,
            _ => [
                format!("a coupler's formula cannot depend on `{name}`"),
                "not a joint coordinate".to_owned(),
            ],
        };
        let [message, label] = words;
        let help = "write a formula of other joint coordinates and of parameters: a [[driver]] moves in time";
        Some([message, label, help.to_owned()])
    };
    let formula = text.and_then(|(item, text)| {
        let read = laws::with_names(reader, &known, Inputs::Unknown, &refuse, |named| named.varying(text));
        read.map_err(|fault| wrong_within(reader, item, text, fault)).ok()
    });
    let formula = formula.unwrap_or_else(Formula::zero);
    if let Some((item, _)) = text {
        curves::refuse_kinks(reader, item, &formula, "a coupler");
    }
    let (found, most) = (formula.uses().count(), Coupler::MOST - 1);
    if let Some((item, _)) = text.filter(|_| found > most) {
        let message = format!("the formula of {} names {found} joint coordinates", section.title);
        let help = format!("write one of at most {most}");
        item.wrong(reader, [message, "too many".to_owned(), help]);
    }
    Coupling::Formula(formula)
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
