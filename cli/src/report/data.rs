//! Raw data as CSV.

use super::curve::{Outcome, Point, Setting, Treatment, who};
use super::drift::Drift;
use super::stability::Map;
use super::truth::Truth;

/// All runs of the diagrams.
pub(crate) fn runs(points: &[Point], truth: &Truth, t_end: f64) -> String {
    let mut head: Vec<String> = RUN_HEAD.iter().map(|s| (*s).to_owned()).collect();
    head.extend(truth.names.iter().map(|name| format!("error of {name}")));
    head.push("failure".to_owned());
    let row = |point: &Point| {
        let curve = &point.curve;
        let (coordinates, correction) = match curve.treatment {
            Treatment::Joint => ("joint".to_owned(), String::new()),
            Treatment::Maximal(correction) => ("maximal".to_owned(), correction.to_string()),
        };
        let (kind, value) = match point.setting {
            Setting::Tolerance(tolerance) => ("tolerance", tolerance),
            Setting::Steps(n) => ("step [s]", t_end / n as f64),
        };
        let mut row = vec![
            who(curve.engine).to_owned(),
            curve.precision.name().to_owned(),
            curve.integrator.to_string(),
        ];
        row.extend([coordinates, correction, kind.to_owned(), short(value)]);
        match &point.outcome {
            Ok(outcome) => {
                row.extend(figures(outcome));
                row.extend(outcome.errors.iter().map(|error| short(*error)));
                row.push(String::new());
            }
            Err(words) => {
                row.extend(vec![String::new(); head.len() - row.len() - 1]);
                row.push(words.clone());
            }
        }
        row
    };
    table(&head, points.iter().map(row))
}

const RUN_HEAD: [&str; 19] = [
    "engine",
    "precision",
    "integrator",
    "coordinates",
    "correction",
    "setting",
    "value",
    "error",
    "CPU time [s]",
    "as measured [s]",
    "over the hand-derived second",
    "steps",
    "rejected",
    "corrections",
    "evaluations",
    "Jacobians",
    "constraint violation",
    "velocity violation [1/s]",
    "energy drift",
];

fn figures(outcome: &Outcome) -> Vec<String> {
    let s = &outcome.statistics;
    let counts = [s.accepted, s.rejected, s.corrections, s.work.evaluations, s.work.jacobians];
    let mut row: Vec<String> =
        [outcome.error, outcome.seconds, outcome.measured, outcome.ratio].map(short).to_vec();
    row.extend(counts.map(|count| count.to_string()));
    row.extend([outcome.position_violation, outcome.velocity_violation, outcome.energy_drift].map(short));
    row
}

/// The long runs.
pub(crate) fn drifts(drifts: &[Drift]) -> String {
    let head = ["treatment", "t [s]", "constraint violation", "energy error", "failure"].map(str::to_owned);
    let rows = drifts.iter().flat_map(|drift| {
        let name = drift.treatment.name();
        match &drift.outcome {
            Ok(course) => (0..course.times.len())
                .map(|k| {
                    let values = [course.times[k], course.violations[k], course.energy[k]].map(short);
                    let mut row = vec![name.clone()];
                    row.extend(values);
                    row.push(String::new());
                    row
                })
                .collect(),
            Err(words) => vec![vec![name, String::new(), String::new(), String::new(), words.clone()]],
        }
    });
    table(&head, rows)
}

/// The steps that were tried.
pub(crate) fn trials(maps: &[Map], knob: &str) -> String {
    let head = ["integrator", knob, "limit in theory [s]", "limit found [s]", "step [s]", "stable"]
        .map(str::to_owned);
    let rows = maps.iter().flat_map(|map| {
        map.columns.iter().flat_map(move |column| {
            let limit = |limit: Option<f64>| limit.map_or(String::new(), short);
            column.found.trials.iter().map(move |trial| {
                vec![
                    map.integrator.to_string(),
                    short(column.value),
                    limit(column.theory),
                    limit(column.found.limit),
                    short(trial.step),
                    trial.is_stable.to_string(),
                ]
            })
        })
    });
    table(&head, rows)
}

/// Five digits: more would be noise.
fn short(value: f64) -> String {
    crate::words::number(value, 5)
}

/// Rows as CSV.
pub(crate) fn table(head: &[String], rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let mut write = |row: &[String]| writer.write_record(row).expect("memory can be written to");
    write(head);
    rows.for_each(|row| write(&row));
    let bytes = writer.into_inner().expect("memory can be written to");
    String::from_utf8(bytes).expect("all cells are text")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::best::tests::point;

    #[test]
    fn failures_are_rows_with_their_reason() {
        let path = crate::files::root().join("models/gyroscope.toml");
        let model = gyro_model::read("gyroscope.toml", &std::fs::read_to_string(path).unwrap()).unwrap();
        let reference = gyro_reference::scene("gyroscope").unwrap();
        let truth = Truth::of_reference(&model, &reference, 0.1);
        let mut good = point(1e-6, Ok((0.5, 1e-7)));
        good.outcome.as_mut().unwrap().errors = vec![1e-7, 2e-8, 3e-9];
        let text = runs(&[good, point(1e-3, Err("at t = 1 s, it \"fails\""))], &truth, 0.1);
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let head = reader.headers().unwrap().clone();
        let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
        let cell = |row: usize, name: &str| &rows[row][head.iter().position(|h| h == name).unwrap()];
        assert_eq!(cell(0, "error"), "1e-7");
        assert_eq!((cell(0, "error of phi"), cell(0, "failure")), ("3e-9", ""));
        assert_eq!((cell(1, "error"), cell(1, "failure")), ("", "at t = 1 s, it \"fails\""));
    }
}
