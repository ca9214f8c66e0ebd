//! The table `simulation`: how a run is to be made.

use toml::de::DeTable;

use super::reader::Reader;
use super::section::{Item, Section};
use crate::keys::SIMULATION;
use crate::validate::Owner;
use crate::{Rational, Simulation, to_f64};

/// The longest time of a run's settings, s: thirty million years.
const LONGEST: u64 = 1_000_000_000_000_000;

/// Times have defaults: one second in steps of a millisecond, a correction every five steps.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Simulation {
    let empty = DeTable::new();
    let table = page.get("simulation").and_then(|item| item.table(reader)).unwrap_or(&empty);
    let section = Section::open(reader, Owner::Simulation, "[simulation]", table, &SIMULATION);
    let ratio = |numerator: i64, denominator: i64| Rational::new(numerator.into(), denominator.into());
    let t_end = time(reader, &section, "t_end").unwrap_or_else(|| ratio(1, 1));
    let step = time(reader, &section, "step").unwrap_or_else(|| ratio(1, 1000));
    let correct_every = time(reader, &section, "correct_every").unwrap_or_else(|| &step * ratio(5, 1));
    let sample_every = time(reader, &section, "sample_every").unwrap_or_else(|| &t_end * ratio(1, 1000));
    // Words of earlier files stand for a correction.
    let (method, former) = match section.word(reader, "method") {
        Some("partitioned") => (None, Some("partition")),
        Some("direct") => (None, Some("none")),
        method => (method, None),
    };
    let correction = section.get("correction").and_then(|item| correction(reader, item));
    let simulation = Simulation {
        t_end: to_f64(&t_end),
        step: to_f64(&step),
        correct_every: to_f64(&correct_every),
        sample_every: to_f64(&sample_every),
        coordinates: section.word(reader, "coordinates"),
        method,
        tolerance: tolerance(reader, &section),
        correction: correction.or(former.map(str::to_owned)),
    };
    if simulation.method == Some("rk4") && simulation.tolerance.is_some() {
        let help = "remove it: rk4 has no error estimate, and takes `step`; or write method = \"dop853\"";
        section.refuse(reader, "tolerance", "method \"rk4\" takes no `tolerance`", help);
    }
    simulation
}

fn time(reader: &mut Reader<'_>, section: &Section<'_>, key: &'static str) -> Option<Rational> {
    let value = section.plain(reader, key)?;
    if value <= Rational::from_integer(LONGEST.into()) {
        return Some(value);
    }
    let help = format!("write at most {LONGEST:e} s");
    section.get(key)?.wrong(reader, [format!("`{key}` is too long"), format!("{} s", to_f64(&value)), help]);
    None
}

fn tolerance(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<f64> {
    let value = to_f64(&section.plain(reader, "tolerance")?);
    if value > 0.0 && value <= 1.0 {
        return Some(value);
    }
    let words = ["a tolerance is above 0 and at most 1", "an error of a step", "write tolerance = 1e-9"];
    section.get("tolerance")?.wrong(reader, words.map(str::to_owned));
    None
}

fn correction(reader: &mut Reader<'_>, item: Item<'_>) -> Option<String> {
    let written = item.text(reader)?;
    let rate = written.strip_prefix("baumgarte=").and_then(|rate| rate.parse::<f64>().ok());
    let is_known = ["partition", "closed-form", "mass-weighted", "none"].contains(&written)
        || rate.is_some_and(|rate| rate > 0.0 && rate.is_finite());
    if !is_known {
        let words = [
            format!("unknown correction `{written}`"),
            "not a correction".to_owned(),
            "the corrections are `partition`, `closed-form`, `mass-weighted`, `baumgarte=RATE` (such as `baumgarte=100`) and `none`"
                .to_owned(),
        ];
        item.wrong(reader, words);
    }
    is_known.then(|| written.to_owned())
}
