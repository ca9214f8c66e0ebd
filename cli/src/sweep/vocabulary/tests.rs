use super::*;
use crate::columns::{Column, columns};
use gyro_runner::{BodySample, JointSample, Sample, Start};

/// A sample whose numbers all differ, and for each column its number: names and quantities belong together.
#[test]
fn names_are_those_of_the_table_and_mean_the_same() {
    for name in ["free-body", "spinning-top", "slider-crank", "gyroscope-coulomb"] {
        let path = crate::files::root().join("models").join(format!("{name}.toml"));
        let model = crate::scene::read_counting_work(&path).unwrap();
        let mut next = 0.0;
        let mut number = || {
            next += 1.0;
            next
        };
        let coordinates = coordinates(&model);
        let coordinates = coordinates.iter().map(|shown| match shown.kind {
            None => JointSample::Orientation {
                position: [0; 4].map(|_| number()),
                rate: [0; 3].map(|_| number()),
            },
            Some(kind) if kind.is_angle() => JointSample::Angle { position: number(), rate: number() },
            Some(_) => JointSample::Length { position: number(), rate: number() },
        });
        let coordinates = coordinates.collect();
        let outputs = outputs(&model).iter().map(|_| number()).collect();
        let body = |number: &mut dyn FnMut() -> f64| BodySample {
            pose: [0; 7].map(|_| number()),
            velocity: [0; 6].map(|_| number()),
        };
        let bodies = observed(&model).iter().map(|_| body(&mut number)).collect();
        let [kinetic, potential, work, position_violation] = [0; 4].map(|_| number());
        let sample = Sample {
            coordinates,
            outputs,
            bodies,
            kinetic,
            potential,
            work,
            position_violation,
            ..Sample::default()
        };
        let table = columns(&model, &Start::default(), std::slice::from_ref(&sample));
        let left_out = ["t", "energy error", "velocity violation", "norm violation", "chart switches"];
        let is_shown = |column: &&Column| {
            !left_out.contains(&column.name.as_str()) && model.inputs.iter().all(|i| i.name != column.name)
        };
        let expected: Vec<_> = table.iter().filter(is_shown).collect();
        let found = vocabulary(&model).columns;
        assert_eq!(found.len(), expected.len(), "{name}");
        for (found, expected) in found.iter().zip(expected) {
            assert_eq!((&found.name, &found.unit[..]), (&expected.name, expected.unit), "{name}");
            assert_eq!(found.of.of(&sample), expected.values[0], "{name}: {}", found.name);
        }
    }
}
