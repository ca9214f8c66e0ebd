//! How a scenario is run: the options of `simulate` under their names.

use super::reader::{Reader, Section};
use gyro_runner::{Coordinates, Correction, Integrator};

/// Options of a run; what is not given is the model file's or chosen, as with `simulate`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunOptions {
    /// Length of the run, s.
    pub t_end: Option<f64>,
    /// Largest step, s.
    pub step: Option<f64>,
    /// Interval between corrections, s.
    pub correct_every: Option<f64>,
    /// Interval between samples, s.
    pub every: Option<f64>,
    /// Error tolerated in each step.
    pub tolerance: Option<f64>,
    /// The method.
    pub integrator: Option<Integrator>,
    /// What is integrated.
    pub coordinates: Option<Coordinates>,
    /// How constraints are kept.
    pub correction: Option<Correction>,
    /// Steps after which a scenario is given up.
    pub budget: Option<u64>,
}

const KEYS: [&str; 9] = [
    "t_end",
    "step",
    "correct_every",
    "every",
    "tolerance",
    "integrator",
    "coordinates",
    "correction",
    "budget",
];

/// Reads `[run]`; `None` after a mistake.
pub(super) fn read(reader: &mut Reader, whole: &Section<'_>) -> Option<RunOptions> {
    let Some(item) = whole.get("run") else { return Some(RunOptions::default()) };
    let section = item.section(reader, "[run]", &KEYS)?;
    let before = reader.mistakes.len();
    let mut positive = |key| {
        let item = section.get(key)?;
        let number = item.number(reader)?;
        if number <= 0.0 {
            reader.wrong(item.span(), ["this must be above zero", "not positive", "write a positive number"]);
        }
        Some(number)
    };
    let [t_end, step, correct_every, every, tolerance] =
        ["t_end", "step", "correct_every", "every", "tolerance"].map(&mut positive);
    if step.is_some() && tolerance.is_some() {
        let help = "remove `step`: with a tolerance steps are as long as it allows";
        section.wrong(reader, "step", ["a run has a step or a tolerance", "both are given", help]);
    }
    let integrators: Vec<_> = Integrator::ALL.iter().map(|one| (one.name(), *one)).collect();
    let coordinates: Vec<_> = Coordinates::ALL.iter().map(|one| (one.name(), *one)).collect();
    let integrator = section.get("integrator").and_then(|item| item.choice(reader, &integrators));
    let coordinates = section.get("coordinates").and_then(|item| item.choice(reader, &coordinates));
    let correction = section.get("correction").and_then(|item| {
        let parsed = item.text(reader)?.parse().ok();
        if parsed.is_none() {
            let help = "write partition, closed-form, mass-weighted, baumgarte=RATE or none";
            reader.wrong(item.span(), ["unknown correction", "not known", help]);
        }
        parsed
    });
    let budget = section.get("budget").and_then(|item| item.positive(reader));
    (reader.mistakes.len() == before).then_some(RunOptions {
        t_end,
        step,
        correct_every,
        every,
        tolerance,
        integrator,
        coordinates,
        correction,
        budget,
    })
}
