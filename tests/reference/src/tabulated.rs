//! The tabulated scenes in `data/gyroscope.json`: values computed elsewhere, that this crate is judged by.

use serde_json::Value;

use crate::{DoubleDouble, Gyroscope, Sample, Start};

/// A scene with values of its motion from integrations that share nothing with this crate.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Its name in the table, such as `paper`.
    pub name: String,
    /// Its parameters, as the table has them.
    pub gyroscope: Gyroscope,
    /// Its motion, in ascending order of time.
    pub samples: Vec<Sample<DoubleDouble>>,
}

/// The scenes of `data/gyroscope.json`, in the order of the file; where its numbers come from stands in its `about`.
#[must_use]
pub fn tabulated() -> Vec<Scene> {
    scenes(include_str!("../data/gyroscope.json"))
        .expect("the embedded table is well formed, as the tests show")
}

fn scenes(text: &str) -> Option<Vec<Scene>> {
    let table: Value = serde_json::from_str(text).ok()?;
    table["scenes"].as_array()?.iter().map(scene).collect()
}

fn scene(entry: &Value) -> Option<Scene> {
    let samples = entry["samples"].as_array()?.iter().map(sample).collect::<Option<_>>()?;
    Some(Scene { name: entry["name"].as_str()?.to_owned(), gyroscope: gyroscope(entry)?, samples })
}

fn gyroscope(entry: &Value) -> Option<Gyroscope> {
    let inertia = entry["inertia"].as_array()?;
    let start = &entry["start"];
    Some(Gyroscope {
        mass: numbers(&entry["mass"])?,
        inertia: [numbers(inertia.first()?)?, numbers(inertia.get(1)?)?, numbers(inertia.get(2)?)?],
        ring_offset: numbers(&entry["ring_offset"])?,
        rotor_offset: numbers(&entry["rotor_offset"])?,
        gravity: numbers(&entry["gravity"])?,
        friction: numbers(&entry["friction"])?,
        start: Start {
            angles: numbers(&start["angles"])?,
            ring_rates: numbers(&start["ring_rates"])?,
            spin: number(&start["spin"])?,
        },
    })
}

fn sample(row: &Value) -> Option<Sample<DoubleDouble>> {
    let [t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy] = numbers(row)?;
    Some(Sample { t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy })
}

fn numbers<const N: usize>(list: &Value) -> Option<[DoubleDouble; N]> {
    let parsed: Option<Vec<DoubleDouble>> = list.as_array()?.iter().map(number).collect();
    parsed?.try_into().ok()
}

/// Numbers are strings in the table, so that no JSON reader rounds them.
fn number(text: &Value) -> Option<DoubleDouble> {
    text.as_str()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_with_a_value_missing_is_refused() {
        assert_eq!(sample(&serde_json::json!(["0", "1", "2", "3", "4", "5", "6"])), None);
    }
}
