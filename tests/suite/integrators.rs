//! Every integrator with every correction on the paper's scene: orders, long runs, single precision.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_mechanisms::gyroscope::Gyroscope;
use gyro_reference::Gyroscope as Reference;
use gyro_sim::integrate::Method;
use gyro_sim::{
    ByDuals, ClosedForm, Control, Corrected, Correction, Dop853, Dual, Exact, Joint, JointSpace, Kutta4,
    MassWeighted, Mechanism, Ode, Partitioning, Real, Rodas4, Solver, Tsit5, When,
};
use std::sync::LazyLock;

type State = <Gyroscope<f64> as Mechanism>::State;

/// Samples of a second.
const SAMPLES: u32 = 10;

/// α and β at each sample.
static EXPECTED: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| {
    let times: Vec<f64> = (0..=SAMPLES).map(|k| f64::from(k) / f64::from(SAMPLES)).collect();
    Reference::paper().solve(&times).iter().map(|sample| [sample.alpha, sample.beta]).collect()
});

/// max(|eα|, |eβ|) of joint coordinates at a sample.
fn error<T: Real>(sample: u32, x: &[T]) -> f64 {
    let error = |k: usize| (x[k].to_f64() - EXPECTED[sample as usize][k]).abs();
    error(0).max(error(1))
}

/// The same of a maximal state.
fn error_at<T: Real>(sample: u32, gyroscope: &Gyroscope<T>, y: &<Gyroscope<T> as Mechanism>::State) -> f64 {
    let mut x = gyroscope.joint_start();
    gyroscope.to_joints(T::constant(1.0), y, &mut x);
    error(sample, &x)
}

/// Errors between these are neither too coarse for an order to show nor rounding.
const FITTED: std::ops::RangeInclusive<f64> = 1e-11..=1e-7;

/// The slope of log error against log step by least squares.
fn order(errors: &[(u32, f64)]) -> f64 {
    let points: Vec<[f64; 2]> = errors
        .iter()
        .filter(|(_, e)| FITTED.contains(e))
        .map(|(n, e)| [-f64::from(*n).ln(), e.ln()])
        .collect();
    assert!(points.len() >= 3, "{errors:?}");
    let n = points.len() as f64;
    let mean = |k: usize| points.iter().map(|p| p[k]).sum::<f64>() / n;
    let means = [mean(0), mean(1)];
    let sum = |a: usize, b: usize| points.iter().map(|p| (p[a] - means[a]) * (p[b] - means[b])).sum::<f64>();
    sum(0, 1) / sum(0, 0)
}

/// Orders of a method in maximal coordinates with each correction after every step: with the equations for states that
/// are corrected, and with exact ones where the correction needs them. Numbers of steps for the former, then the
/// latter.
fn orders<D, E, A>(
    (corrected, exact): (D, E),
    method: impl Fn(&State) -> A,
    [steps, steps_of_exact]: [&[u32]; 2],
) -> [f64; 3]
where
    D: Ode<Gyroscope<f64>, Scalar = f64, State = State> + Clone,
    E: Ode<Gyroscope<f64>, Scalar = f64, State = State> + Clone,
    A: Method<D, Gyroscope<f64>> + Method<E, Gyroscope<f64>>,
    MassWeighted<Gyroscope<f64>>: Correction<E, Gyroscope<f64>>,
{
    fn run<D, A, C>(dynamics: D, method: A, correction: C, n: u32) -> (u32, f64)
    where
        D: Ode<Gyroscope<f64>, Scalar = f64, State = State>,
        A: Method<D, Gyroscope<f64>>,
        C: Correction<D, Gyroscope<f64>>,
    {
        let gyroscope = Gyroscope::default();
        let mut solver = Solver::with_correction(dynamics, method, correction, 0.0, &gyroscope.start());
        let mut worst: f64 = 0.0;
        for sample in 1..=SAMPLES {
            solver.advance(&gyroscope, 1.0 / f64::from(n), n / SAMPLES).unwrap();
            worst = worst.max(error_at(sample, &gyroscope, solver.state()));
        }
        (n, worst)
    }
    let (gyroscope, y) = (Gyroscope::<f64>::default(), Gyroscope::<f64>::default().start());
    let by = |steps: &[u32], run: &dyn Fn(u32) -> (u32, f64)| {
        order(&steps.iter().map(|n| run(*n)).collect::<Vec<_>>())
    };
    [
        by(steps, &|n| run(corrected.clone(), method(&y), Partitioning::new(&gyroscope, 0.0, &y), n)),
        by(steps, &|n| run(corrected.clone(), method(&y), ClosedForm::new(&gyroscope), n)),
        by(steps_of_exact, &|n| run(exact.clone(), method(&y), MassWeighted::new(&gyroscope), n)),
    ]
}

fn assert_orders(name: &str, expected: f64, orders: [f64; 3]) {
    println!("{name}: orders {orders:.2?} with partition, closed form, mass-weighted projection");
    assert!(orders.iter().all(|order| (order - expected).abs() <= 0.5), "{name}: {orders:?} for {expected}");
}

#[test]
fn integrators_keep_their_orders_through_corrections() {
    let equations = (Corrected, Exact);
    assert_orders("rk4", 4.0, orders(equations, Kutta4::new, [&[1500, 2000, 3000, 4000, 6000]; 2]));
    // At coarse steps a sixth-order part of the error outweighs the fifth-order one: locally the order is 5.6 to 5.7,
    // and a fit of the mass-weighted projection from 400 steps on gives 5.52. These are the steps from which on the
    // error of β is the largest, to those at which it falls below what is fitted. The mass-weighted projection, whose
    // errors are some fifteen times smaller, reaches both sooner.
    let steps: [&[u32]; 2] = [&[1600, 1700, 1800, 1900], &[900, 1000, 1100]];
    assert_orders("tsit5", 5.0, orders(equations, Tsit5::new, steps));
    assert_orders("dop853", 8.0, orders(equations, Dop853::new, [&[110, 140, 180, 220, 260]; 2]));
    let duals = Gyroscope::<Dual<f64, 4>>::default();
    let by_duals = ByDuals::new(Exact, duals, duals.start());
    let method = |y: &State| Rodas4::new(y, vec![0.0; 39 * 39]);
    assert_orders(
        "rodas4",
        4.0,
        orders((by_duals.clone(), by_duals), method, [&[1500, 2000, 3000, 4000]; 2]),
    );
}

#[test]
fn single_precision_reaches_a_millionth() {
    let gyroscope = Gyroscope::<f32>::default();
    let best = |errors: &[f64]| errors.iter().copied().fold(f64::INFINITY, f64::min);
    let steps = [100_u32, 200, 400, 800, 1600];
    let (x, y) = (gyroscope.joint_start(), gyroscope.start());
    let joint = steps.map(|n| {
        let mut solver = Solver::new(Joint, Dop853::new(&x), 0.0, &x);
        solver.advance(&gyroscope, 1.0 / n as f32, n).unwrap();
        error(SAMPLES, solver.state())
    });
    let maximal = steps.map(|n| {
        let mut solver =
            Solver::with_correction(Corrected, Dop853::new(&y), ClosedForm::new(&gyroscope), 0.0, &y);
        solver.advance(&gyroscope, 1.0 / n as f32, n).unwrap();
        error_at(SAMPLES, &gyroscope, solver.state())
    });
    println!("f32, dop853: joint {joint:?}, maximal {maximal:?}");
    assert!(best(&joint) <= 1e-6 && best(&maximal) <= 5e-6, "{joint:?} {maximal:?}");
}

#[test]
fn corrections_wait_for_their_moment() {
    let gyroscope = Gyroscope::<f64>::default();
    let y = gyroscope.start();
    let run = |when| {
        let control = Control { when, ..Control::default() };
        let correction = MassWeighted::new(&gyroscope);
        let method = Kutta4::new(&y);
        let mut solver = Solver::with_correction(Exact, method, correction, 0.0, &y).with_control(control);
        solver.advance(&gyroscope, 1e-3, 1000).unwrap();
        (solver.statistics().corrections, error_at(SAMPLES, &gyroscope, solver.state()))
    };
    let [every, fifth, violated] = [When::Steps(1), When::Steps(5), When::Violation(1e-8)].map(run);
    println!("corrections and errors: {every:?}, {fifth:?}, {violated:?}");
    assert_eq!((every.0, fifth.0), (1000, 200));
    assert!(violated.0 > 0 && violated.0 < 1000, "{violated:?}");
    assert!([every, fifth, violated].iter().all(|(_, error)| *error < 1e-5));
}
