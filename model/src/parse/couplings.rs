//! Couplers between two joint coordinates, and drivers that prescribe one in time.

use super::formulas::Inputs;
use super::laws;
use super::lookup::wrong_within;
use super::reader::Reader;
use super::section::Section;
use super::{curves, motion, references, tables};
use crate::validate::{Owner, Side};
use crate::{Coupler, Coupling, Driver, Formula, JointCoordinate, Operation, OutputKind, Relative, Seen};

/// The tables of couplers and of constraints, whose formulas may name what is read later.
pub(super) struct Opened<'t> {
    couplers: Vec<(Section<'t>, String)>,
    constraints: Vec<(Section<'t>, String)>,
}

/// Opens all couplers and constraints, so that their names are known.
pub(super) fn open<'t>(reader: &mut Reader<'_>, page: &Section<'t>) -> Opened<'t> {
    let couplers = tables::each(reader, page, "coupler", Owner::Coupler);
    let before = couplers.len();
    let constraints = tables::each(reader, page, "constraint", |index| Owner::Coupler(before + index));
    Opened { couplers, constraints }
}

/// Reads all couplers, and constraints behind them.
pub(super) fn couplers(reader: &mut Reader<'_>, opened: Opened<'_>) -> Vec<Coupler> {
    let one = |(index, (section, name)): (usize, (Section<'_>, String))| {
        let mut end = |side: Side| {
            let title = format!("`{}` of {}", side.key(), section.title);
            let end = section.inner(reader, side.key(), (Owner::CouplerEnd(index, side), &title));
            end.map_or(references::NO_COORDINATE, |end| references::coordinate(reader, &end))
        };
        let second = end(Side::Second);
        if section.has("formula") {
            return Coupler { name, second: Some(second), by: by_formula(reader, &section, second) };
        }
        let first = end(Side::First);
        // With a formula neither may be there.
        section.require(reader, "first");
        section.require(reader, "ratio");
        let [ratio, offset] = ["ratio", "offset"].map(|key| section.number(reader, key));
        Coupler { name, second: Some(second), by: Coupling::Linear { first, ratio, offset } }
    };
    let mut couplers: Vec<_> = opened.couplers.into_iter().enumerate().map(one).collect();
    couplers.extend(opened.constraints.into_iter().map(|(section, name)| constraint(reader, &section, name)));
    couplers
}

/// How a row may depend on what is seen.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Level {
    /// On where everything is.
    Place,
    /// On how fast it moves.
    Rate,
    /// Not at all.
    Other,
}

pub(super) fn level(kinds: &[OutputKind], seen: Seen) -> Level {
    match seen {
        Seen::Coordinate(_) => Level::Place,
        Seen::Rate(_) => Level::Rate,
        Seen::Output { output, number } if matches!(kinds.get(output), Some(OutputKind::Relative(_))) => {
            if number < Relative::N_PLACES {
                Level::Place
            } else {
                Level::Rate
            }
        }
        _ => Level::Other,
    }
}

const HELP: &str =
    "write a formula of joint coordinates, parameters and numbers of [[output]]s of kind \"relative\"";

/// A row of one's own.
fn constraint(reader: &mut Reader<'_>, section: &Section<'_>, name: String) -> Coupler {
    let is_rate = section.has("rate");
    if is_rate {
        let message = format!("{} has `zero` and `rate`", section.title);
        section.refuse(reader, "zero", &message, "remove one: a constraint is one row");
    } else {
        section.require(reader, "zero");
    }
    let kinds = reader.outputs.clone();
    let refuse = |name: &str, seen: Seen| match level(&kinds, seen) {
        Level::Place => None,
        Level::Rate if is_rate => None,
        Level::Rate => Some([
            format!("a constraint of positions cannot depend on `{name}`"),
            "a rate".to_owned(),
            "write rate = \"...\" for a constraint of velocities".to_owned(),
        ]),
        Level::Other => Some([
            format!("a constraint cannot depend on `{name}`"),
            "neither a joint coordinate nor a relative place".to_owned(),
            HELP.to_owned(),
        ]),
    };
    let formula = of_coordinates(reader, section, if is_rate { "rate" } else { "zero" }, &refuse);
    if let Some((item, text)) = section.get("rate").and_then(|item| Some((item, item.text(reader)?)))
        && let Err(words) = linear_in_rates(&formula, &kinds)
        && formula.sees().next().is_some()
    {
        let words = [format!("`{text}` {}", words[0]), words[1].to_owned(), words[2].to_owned()];
        item.wrong(reader, words);
    }
    let by = if is_rate { Coupling::Rate(formula) } else { Coupling::Zero(formula) };
    Coupler { name, second: None, by }
}

/// Whether a formula is a sum of products with one rate each; what is wrong, where, and what to write.
fn linear_in_rates(formula: &Formula, kinds: &[OutputKind]) -> Result<(), [&'static str; 3]> {
    const POWERS: [&str; 3] = [
        "is not linear in rates",
        "a product, quotient, power or function of rates",
        "write a sum of rates, each times a formula of joint coordinates",
    ];
    const WITHOUT: [&str; 3] = [
        "has terms without a rate",
        "not every term has a rate",
        "write a sum of rates, each times a formula of joint coordinates; a [[driver]] prescribes a motion",
    ];
    // Of each operation how often rates are multiplied; of zero it may be any.
    let degree = formula.value(|operation, degrees: &[Option<u8>]| {
        let all_without = |all: &[usize]| all.iter().all(|a| degrees[*a].is_none_or(|degree| degree == 0));
        match *operation {
            Operation::Number(ref number) => Ok((!number.is_zero()).then_some(0)),
            Operation::Seen(seen) => Ok(Some(u8::from(level(kinds, seen) == Level::Rate))),
            Operation::Negative(a) => Ok(degrees[a]),
            Operation::Sum(a, b) | Operation::Difference(a, b) => match (degrees[a], degrees[b]) {
                (Some(a), Some(b)) if a != b => Err(WITHOUT),
                (a, b) => Ok(a.or(b)),
            },
            Operation::Product(a, b) => match (degrees[a], degrees[b]) {
                (Some(1), Some(1)) => Err(POWERS),
                (Some(a), Some(b)) => Ok(Some(a + b)),
                _ => Ok(None),
            },
            Operation::Quotient(a, b) if all_without(&[b]) => Ok(degrees[a]),
            Operation::Power(a, _) if all_without(&[a]) => Ok(Some(0)),
            Operation::Call(_, operands) if all_without(&operands) => Ok(Some(0)),
            Operation::Quotient(..) | Operation::Power(..) | Operation::Call(..) => Err(POWERS),
        }
    })?;
    if degree == Some(1) { Ok(()) } else { Err(WITHOUT) }
}

fn by_formula(reader: &mut Reader<'_>, section: &Section<'_>, second: JointCoordinate) -> Coupling {
    for key in ["first", "ratio", "offset"] {
        let message = format!("{} has a `formula` and `{key}`", section.title);
        section.refuse(reader, key, &message, "remove it: the formula says all of it");
    }
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
        let help = match seen {
            Seen::Output { .. } => {
                "write a [[constraint]], which may name numbers of [[output]]s of kind \"relative\""
            }
            _ => "write a formula of other joint coordinates and of parameters: a [[driver]] moves in time",
        };
        Some([message, label, help.to_owned()])
    };
    Coupling::Formula(of_coordinates(reader, section, "formula", &refuse))
}

/// The formula of a row.
fn of_coordinates(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    key: &'static str,
    refuse: &dyn Fn(&str, Seen) -> Option<[String; 3]>,
) -> Formula {
    let item = section.find(reader, key);
    let text = item.and_then(|item| Some((item, item.text(reader)?)));
    let known = reader.visible.clone();
    let formula = text.and_then(|(item, text)| {
        let read = laws::with_names(reader, &known, Inputs::Unknown, refuse, |named| named.varying(text));
        read.map_err(|fault| wrong_within(reader, item, text, fault)).ok()
    });
    let formula = formula.unwrap_or_else(Formula::zero);
    if let Some((item, _)) = text {
        let what = if key == "formula" { "a coupler" } else { "a constraint" };
        curves::refuse_kinks(reader, item, &formula, what);
    }
    let coordinate = |seen| match seen {
        Seen::Coordinate(on) | Seen::Rate(on) => (on.joint, Some(on.coordinate)),
        Seen::Output { output, .. } => (output, None),
        _ => (0, None),
    };
    let mut named: Vec<_> = formula.sees().map(coordinate).collect();
    named.sort_unstable();
    named.dedup();
    // A coupler's row has its second coordinate, too.
    let (found, most) = (named.len(), Coupler::MOST - usize::from(key == "formula"));
    if let Some((item, _)) = text.filter(|_| found > most) {
        let message = format!("the formula of {} names {found} joint coordinates and outputs", section.title);
        let help = format!("write one of at most {most}");
        item.wrong(reader, [message, "too many".to_owned(), help]);
    }
    formula
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
