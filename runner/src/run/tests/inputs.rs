//! Inputs that vary under error control: a rotor in a viscous bearing under a torque, which is linear, against matrix
//! exponentials.

use super::*;
use crate::approach::Integrator;
use crate::motion::{Any, COLUMNS, Implicit, Only};
use crate::spinner::Spinner;
use crate::{Between, JointSample};
use chacha20::ChaCha8Rng;
use gyro_sim::Dual;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
use rand::{RngExt, SeedableRng};

const FRICTION: f64 = 1.5;
const START: [f64; 2] = [0.0, -2.0];

/// Angle and rate at sample times, by the exponential of the plant together with the cubic that its input is: the
/// states are angle, rate and the input with its three derivatives.
fn exact(rows: &[[f64; 2]], between: Between, times: &[f64]) -> Vec<[f64; 2]> {
    let mut a = SMatrix::<f64, 6, 6>::zeros();
    (a[(0, 1)], a[(1, 1)], a[(1, 2)]) = (1.0, -FRICTION, 1.0);
    (a[(2, 3)], a[(3, 4)], a[(4, 5)]) = (1.0, 1.0, 1.0);
    let bends = curvatures(rows);
    let (mut t, mut x) = (0.0, START);
    let mut walk = |to: f64| {
        let stops = rows.iter().map(|row| row[0]).filter(|stop| *stop > t && *stop < to);
        for stop in stops.chain([to]).collect::<Vec<_>>() {
            let [u, u1, u2, u3] = derivatives(rows, between, &bends, t);
            let next = (a * (stop - t)).exp() * SVector::from([x[0], x[1], u, u1, u2, u3]);
            (t, x) = (stop, [next[0], next[1]]);
        }
        x
    };
    times.iter().map(|t| walk(*t)).collect()
}

/// Value and derivatives of an input just after a time.
fn derivatives(rows: &[[f64; 2]], between: Between, bends: &[f64], t: f64) -> [f64; 4] {
    let Some(k) = rows.iter().rposition(|row| row[0] <= t) else { return [rows[0][1], 0.0, 0.0, 0.0] };
    let Some(next) = rows.get(k + 1) else { return [rows[k][1], 0.0, 0.0, 0.0] };
    let (h, u) = (next[0] - rows[k][0], t - rows[k][0]);
    let slope = (next[1] - rows[k][1]) / h;
    match between {
        Between::Held => [rows[k][1], 0.0, 0.0, 0.0],
        Between::Linear => [rows[k][1] + slope * u, slope, 0.0, 0.0],
        Between::Smooth => {
            // Symmetric in both ends, from second derivatives, which are linear.
            let (m, n, v) = (bends[k], bends[k + 1], h - u);
            let (a, b) = (rows[k][1] / h - m * h / 6.0, next[1] / h - n * h / 6.0);
            [
                m * v.powi(3) / (6.0 * h) + n * u.powi(3) / (6.0 * h) + a * v + b * u,
                (n * u * u - m * v * v) / (2.0 * h) + b - a,
                (m * v + n * u) / h,
                (n - m) / h,
            ]
        }
    }
}

/// Second derivatives of the natural spline, by a dense solve.
fn curvatures(rows: &[[f64; 2]]) -> Vec<f64> {
    let n = rows.len();
    let (mut matrix, mut right) = (DMatrix::<f64>::identity(n, n), DVector::<f64>::zeros(n));
    for k in 1..n.saturating_sub(1) {
        let (before, after) = (rows[k][0] - rows[k - 1][0], rows[k + 1][0] - rows[k][0]);
        matrix[(k, k - 1)] = before / 6.0;
        matrix[(k, k)] = (before + after) / 3.0;
        matrix[(k, k + 1)] = after / 6.0;
        right[k] = (rows[k + 1][1] - rows[k][1]) / after - (rows[k][1] - rows[k - 1][1]) / before;
    }
    matrix.lu().solve(&right).unwrap().iter().copied().collect()
}

/// A run: the largest error of all samples, and what the steps have met.
fn moved(approach: &Approach, input: &Input, sample_every: f64) -> (f64, Summary) {
    let mut rotor = Spinner { rate: START[1], friction: FRICTION, ..Spinner::default() };
    let start = Start { inputs: vec![input.clone()], ..rotor.initial() };
    let settings = Settings { t_end: 1.0, step: 1e-3, correct_every: None, sample_every };
    let duals = Spinner { friction: Dual::new(FRICTION), rate: Dual::new(0.0), torque: Dual::new(0.0) };
    let implicit = Only { kind: Implicit::<Spinner<Dual<f64, COLUMNS>>>(duals), joint_space: false };
    let builder: &dyn MotionBuilder<Spinner> =
        if approach.integrator == Integrator::Rodas4 { &implicit } else { &Any };
    let (mut times, mut found) = (Vec::new(), Vec::new());
    let summary = run_by(&mut rotor, builder, (&settings, approach), &start, |event| {
        if let Event::Sample(sample) = event {
            let JointSample::Angle { position, rate } = sample.coordinates[0] else { panic!("an angle") };
            times.push(sample.t);
            found.push([position, rate]);
            // What is shown of an input is its value at the time.
            assert_eq!(sample.outputs[0], input.at(sample.t));
        }
        Ok(())
    });
    let expected = exact(&input.rows, input.between, &times);
    let apart = |(a, b): (&[f64; 2], &[f64; 2])| (a[0] - b[0]).abs().max((a[1] - b[1]).abs());
    let error = found.iter().zip(&expected).map(apart).fold(0.0, f64::max);
    (error, summary.unwrap_or_else(|failure| panic!("{approach}: {failure}")))
}

fn approaches(tolerance: f64) -> impl Iterator<Item = Approach> {
    let integrators = [Integrator::Tsit5, Integrator::Dop853, Integrator::Rodas4];
    integrators.into_iter().flat_map(move |integrator| {
        [Correction::Partition, Correction::None].map(|correction| Approach {
            integrator,
            correction,
            tolerance: Some(tolerance),
            ..Approach::default()
        })
    })
}

const KINDS: [Between; 3] = [Between::Held, Between::Linear, Between::Smooth];

/// Among the rows a jump within a millisecond, and a stretch in which nothing changes.
const ROWS: [[f64; 2]; 6] = [[0.1, 1.0], [0.31, -1.5], [0.311, 2.0], [0.5, 0.5], [0.83, 0.5], [0.9, -2.5]];

#[test]
fn all_methods_follow_inputs_of_all_kinds_to_their_tolerance() {
    for between in KINDS {
        for tolerance in [1e-5, 1e-8, 1e-11] {
            for approach in approaches(tolerance) {
                let (error, summary) = moved(&approach, &Input::new(0, ROWS.to_vec(), between), 0.037);
                assert!(error < 30.0 * tolerance, "{between:?}, {approach}: {error:e}");
                // A step across a knot is noticed by its error, and repeated until it is short.
                let met = summary.statistics;
                assert!(20 * met.rejected <= met.accepted + 100, "{between:?}, {approach}: {met:?}");
            }
        }
    }
}

/// Steps between knots multiply as the method's order says when the tolerance is divided.
#[test]
fn methods_keep_their_order_between_knots() {
    // It comes to some 30 rad/s: steps are many.
    let input = Input::new(0, vec![[0.0, 200.0], [0.5, -300.0], [1.0, 100.0]], Between::Smooth);
    for (integrator, order, tolerances) in [
        (Integrator::Tsit5, 5.0, [1e-8, 1e-12]),
        (Integrator::Dop853, 8.0, [1e-8, 1e-14]),
        (Integrator::Rodas4, 4.0, [1e-5, 1e-9]),
    ] {
        let by = |tolerance| Approach {
            integrator,
            correction: Correction::None,
            tolerance: Some(tolerance),
            ..Approach::default()
        };
        let steps = tolerances.map(|tolerance| moved(&by(tolerance), &input, 1.0).1.steps as f64);
        let found = (tolerances[0] / tolerances[1]).ln() / (steps[1] / steps[0]).ln();
        assert!((found - order).abs() < 0.2 * order, "{integrator}: order {found} by {steps:?} steps");
    }
}

/// Knots on samples, close together, before the start and after the end; values that differ by much or not at all.
fn random_input(random: &mut ChaCha8Rng) -> Input {
    let mut rows: Vec<[f64; 2]> = Vec::new();
    let mut t = random.random_range(-0.3..0.3);
    for _ in 0..random.random_range(1..30) {
        let value = match random.random_range(0..5) {
            0 => rows.last().map_or(0.0, |row| row[1]),
            1 => 100.0 * random.random_range(-1.0..1.0_f64),
            _ => random.random_range(-3.0..3.0),
        };
        rows.push([t, value]);
        let next = match random.random_range(0..6) {
            0 => t.max(0.0) + f64::EPSILON * random.random_range(1.0..10.0),
            1 => t + 1e-6 * random.random_range(0.1..1.0),
            2 => ((t / 0.037).floor() + 1.0) * 0.037,
            _ => t + random.random_range(0.01..0.2),
        };
        t = next.max(t.next_up());
    }
    // Splines through rows that nearly coincide swing without limit: they are asked for of others.
    let is_wild = rows.windows(2).any(|pair| pair[1][0] - pair[0][0] < 1e-3);
    Input::new(0, rows, KINDS[random.random_range(0..if is_wild { 2 } else { 3 })])
}

#[test]
fn random_inputs_hold_no_surprises() {
    let mut worst: f64 = 0.0;
    for seed in 0..60 {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let input = random_input(&mut random);
        let tolerance = 10.0_f64.powi(-random.random_range(4..12));
        let size = input.rows.iter().fold(2.0, |size: f64, row| size.max(row[1].abs()));
        for approach in approaches(tolerance) {
            let (error, summary) = moved(&approach, &input, 0.037);
            let times = error / (tolerance * size);
            assert!(times < 100.0, "seed {seed}: {approach}, {error:e} of {size}: {input:?}");
            let met = summary.statistics;
            assert!(met.rejected <= met.accepted + 20, "seed {seed}: {approach}: {met:?}");
            worst = worst.max(times);
        }
    }
    assert!(worst > 1e-3, "errors that small are not measured: {worst}");
}
