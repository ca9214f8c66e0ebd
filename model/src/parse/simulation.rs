//! The table `simulation`: how a run is to be made.

use num_traits::One;
use toml::de::DeTable;

use super::numbers::{plain_number, positive};
use super::reader::Reader;
use super::section::{Item, Section};
use crate::validate::Owner;
use crate::{Rational, Simulation, to_f64};

const KEYS: [&str; 8] =
    ["t_end", "step", "correct_every", "sample_every", "coordinates", "method", "tolerance", "correction"];

const COORDINATES: [&str; 2] = ["joint", "maximal"];

/// Integrators; and words of earlier files, which stand for a correction.
const METHODS: [(&str, Method); 6] = [
    ("rk4", Method::By("rk4")),
    ("tsit5", Method::By("tsit5")),
    ("dop853", Method::By("dop853")),
    ("rodas4", Method::By("rodas4")),
    ("partitioned", Method::Kept("partition")),
    ("direct", Method::Kept("none")),
];

#[derive(Clone, Copy)]
enum Method {
    By(&'static str),
    Kept(&'static str),
}

/// Times have defaults: one second in steps of a millisecond, a correction every five steps.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Simulation {
    let example = "[simulation] on a line of its own, then t_end = 1";
    let empty = DeTable::new();
    let table = page.get("simulation").and_then(|item| item.table(reader, example)).unwrap_or(&empty);
    let section = Section::open(reader, Owner::Simulation, "[simulation]", table, &KEYS);
    let ratio = |numerator: i64, denominator: i64| Rational::new(numerator.into(), denominator.into());
    let t_end = positive(reader, &section, "t_end").unwrap_or_else(Rational::one);
    let step = positive(reader, &section, "step").unwrap_or_else(|| ratio(1, 1000));
    let correct_every = positive(reader, &section, "correct_every").unwrap_or_else(|| &step * ratio(5, 1));
    let sample_every = positive(reader, &section, "sample_every").unwrap_or_else(|| &t_end * ratio(1, 1000));
    let method = section.get("method").and_then(|item| item.choice(reader, ("method", &METHODS)));
    let mut simulation = Simulation {
        t_end: to_f64(&t_end),
        step: to_f64(&step),
        correct_every: to_f64(&correct_every),
        sample_every: to_f64(&sample_every),
        coordinates: section.get("coordinates").and_then(|item| coordinates(reader, item)),
        method: None,
        tolerance: section.get("tolerance").and_then(|item| tolerance(reader, item)),
        correction: section.get("correction").and_then(|item| correction(reader, item)),
    };
    match method {
        Some(Method::By(method)) => simulation.method = Some(method),
        Some(Method::Kept(correction)) => {
            simulation.correction.get_or_insert_with(|| correction.to_owned());
        }
        None => {}
    }
    if simulation.method == Some("rk4") && simulation.tolerance.is_some() {
        let help = "remove it: rk4 has no error estimate, and takes `step`; or write method = \"dop853\"";
        section.refuse(reader, "tolerance", "method \"rk4\" takes no `tolerance`", help);
    }
    simulation
}

fn coordinates(reader: &mut Reader<'_>, item: Item<'_>) -> Option<&'static str> {
    let written = item.text(reader, "coordinates = \"joint\"")?;
    let known = COORDINATES.iter().find(|known| **known == written).copied();
    if known.is_none() {
        let words = [
            format!("unknown coordinates `{written}`"),
            "neither joint nor maximal ones".to_owned(),
            "write `joint`, or `maximal` for positions and Euler parameters of all bodies".to_owned(),
        ];
        item.wrong(reader, words);
    }
    known
}

fn tolerance(reader: &mut Reader<'_>, item: Item<'_>) -> Option<f64> {
    let value = to_f64(&plain_number(reader, item)?);
    if value > 0.0 && value <= 1.0 {
        return Some(value);
    }
    let words = ["a tolerance is above 0 and at most 1", "an error of a step", "write tolerance = 1e-9"];
    item.wrong(reader, words.map(str::to_owned));
    None
}

fn correction(reader: &mut Reader<'_>, item: Item<'_>) -> Option<String> {
    let written = item.text(reader, "correction = \"partition\"")?;
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
