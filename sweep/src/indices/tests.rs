use super::*;
use crate::{Distribution, Draw, Plan, Sampling, Source, Target};
use std::f64::consts::PI;

/// Ishigami and Homma's function with a = 7, b = 0.1, whose indices are known.
#[test]
fn the_indices_of_ishigamis_function_are_the_known_ones() {
    let draw = |target| Draw::Alone { target, distribution: Distribution::Uniform([-PI, PI]) };
    let plan = Plan {
        seed: 3,
        sampling: Sampling::Saltelli,
        targets: (0..3).map(Target::Parameter).collect(),
        axes: Vec::new(),
        draws: (0..3).map(draw).collect(),
        repeats: 1 << 12,
    };
    let (mut source, mut indices) = (Source::new(&plan), Indices::new(1, 3));
    for k in 0..plan.scenarios() {
        let mut x = [0.0; 3];
        source.write(k, &mut x);
        let value = x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin();
        indices.add(&[1e3 + value]);
    }
    let found = &indices.finish()[0];
    let (a, b) = (7.0, 0.1 * PI.powi(4));
    let variance = a * a / 8.0 + b / 5.0 + b * b / 18.0 + 0.5;
    let first = [0.5 * (1.0 + b / 5.0).powi(2), a * a / 8.0, 0.0].map(|part| part / variance);
    let cross = 8.0 * b * b / 225.0 / variance;
    let total = [first[0] + cross, first[1], cross];
    for k in 0..3 {
        assert!((found.first[k] - first[k]).abs() < 0.01, "{k}: {found:?} {first:?}");
        assert!((found.total[k] - total[k]).abs() < 0.01, "{k}: {found:?} {total:?}");
    }
}
