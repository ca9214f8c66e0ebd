//! The Jacobian of the joint form against differences of the dense runtime-assembled model's accelerations, by state,
//! time and inputs.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use crate::joint_space::random_state;
use gyro_runner::motion::{Linear, TreeWithJacobian};
use gyro_runner::{Approach, Event, Settings, run_by};
use gyro_sim::{Dual, Dynamics, JointJacobian, JointSpace, Mechanism};
use gyro_sim_suite::{Engine, Random, compiled, dense, interpreted, model, start_of};
use nalgebra::{DMatrix, DVector};

const STATES: usize = 20;

/// Of the five-point formula. Its error is the fourth power of this times a fifth derivative; the accelerations have
/// errors of 1e-11.
const STEP: f64 = 2e-3;

/// Relative to the largest derivative of a state.
const TOLERANCE: f64 = 1e-6;

/// The derivative at zero.
fn slope(step: f64, mut f: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * step));
    (0..a.len()).map(|k| (a[k] - d[k] + 8.0 * (c[k] - b[k])) / (12.0 * step)).collect()
}

/// The joint form as the runtime-assembled model has it.
struct Twin<'a, M> {
    mechanism: &'a M,
    dense: Engine,
    n_coordinates: usize,
    n_rates: usize,
}

impl<M: JointSpace<Scalar = f64>> Twin<'_, M> {
    fn maximal(&self, t: f64, x: &[f64]) -> Vec<f64> {
        let (mut joints, mut y) = (self.mechanism.joint_start(), self.mechanism.start());
        joints.as_mut().copy_from_slice(x);
        self.mechanism.to_maximal(t, &joints, &mut y);
        y.as_ref().to_vec()
    }

    fn velocities(&self, t: f64, x: &[f64]) -> Vec<f64> {
        let n = self.dense.description().bodies.len();
        self.maximal(t, x)[7 * n..13 * n].to_vec()
    }

    /// u̇ is what makes of the velocities `v = B u + v₀(x, t)` the accelerations that the runtime-assembled model
    /// solves eq. (17) for.
    fn derivative(&self, t: f64, x: &[f64]) -> Vec<f64> {
        let (mut joints, mut dx) = (self.mechanism.joint_start(), self.mechanism.joint_start());
        joints.as_mut().copy_from_slice(x);
        self.mechanism.joint_derivative(t, &joints, &mut dx);
        let mut dx = dx.as_ref().to_vec();
        let (y, mut dy) = (self.maximal(t, x), self.dense.start());
        self.dense.derivative(t, &y, &mut dy);
        let n = self.dense.description().bodies.len();
        let still = slope(STEP, |h| {
            let moved = x.iter().zip(&dx[..self.n_coordinates]).map(|(x, dx)| x + h * dx);
            let moved: Vec<_> = moved.chain(x[self.n_coordinates..].iter().copied()).collect();
            self.velocities(t + h, &moved)
        });
        let wanted = DVector::from_iterator(6 * n, dy[7 * n..13 * n].iter().zip(&still).map(|(a, b)| a - b));
        let velocities = self.velocities(t, x);
        let columns = (0..self.n_rates).map(|rate| {
            let mut faster = x.to_vec();
            faster[self.n_coordinates + rate] += 1.0;
            DVector::from_iterator(
                6 * n,
                self.velocities(t, &faster).iter().zip(&velocities).map(|(a, b)| a - b),
            )
        });
        let b = DMatrix::from_columns(&columns.collect::<Vec<_>>());
        let normal = (b.transpose() * &b).cholesky().expect("rates that all move something");
        let rates = normal.solve(&(b.transpose() * wanted));
        dx[self.n_coordinates..][..self.n_rates].copy_from_slice(rates.as_slice());
        if let Some(work) = dx.get_mut(self.n_coordinates + self.n_rates) {
            *work = dy[13 * n];
        }
        dx
    }
}

fn check<M>(page: &str, mechanism: &M)
where
    M: JointJacobian<Scalar = f64> + Clone,
{
    let (model, mut random) = (model(page), Random::new(5));
    let (n_rates, n) =
        (mechanism.joint_buffers().rates.as_ref().len(), mechanism.joint_start().as_ref().len());
    let n_coordinates = n - n_rates - usize::from(model.has_work());
    let mut worst = 0.0_f64;
    for _ in 0..STATES {
        let (t, x) = (random.signed(), random_state(&model, mechanism, &mut random));
        let (mut mechanism, mut dense) = (mechanism.clone(), dense(&model));
        let inputs: Vec<f64> = (0..mechanism.description().inputs.len()).map(|_| random.signed()).collect();
        for (index, &value) in inputs.iter().enumerate() {
            assert!(mechanism.set_input(index, value) && dense.set_input(index, value));
        }
        let (mut by_state, mut by_time) = (mechanism.jacobian_buffers().jacobian, mechanism.joint_start());
        mechanism.joint_jacobian(t, &x, &mut by_state, &mut by_time);
        let mut by_inputs = mechanism.jacobian_buffers().input_jacobian;
        mechanism.joint_input_jacobian(t, &x, &mut by_inputs);

        let twin = Twin { mechanism: &mechanism, dense, n_coordinates, n_rates };
        let x = x.as_ref();
        let mut columns: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
        for k in 0..n {
            let expected = slope(STEP, |h| {
                let mut moved = x.to_vec();
                moved[k] += h;
                twin.derivative(t, &moved)
            });
            columns.push((by_state.as_ref().iter().skip(k).step_by(n).copied().collect(), expected));
        }
        columns.push((by_time.as_ref().to_vec(), slope(STEP, |h| twin.derivative(t + h, x))));
        for k in 0..inputs.len() {
            let expected = slope(STEP, |h| {
                let mut dense = twin.dense.clone();
                assert!(dense.set_input(k, inputs[k] + h));
                Twin { mechanism: &mechanism, dense, ..twin }.derivative(t, x)
            });
            let column = by_inputs.as_ref().iter().skip(k).step_by(inputs.len());
            columns.push((column.copied().collect(), expected));
        }
        let entries = columns.iter().flat_map(|(_, expected)| expected);
        let largest = entries.fold(0.0, |largest: f64, x| largest.max(x.abs()));
        for (found, expected) in &columns {
            assert_eq!(found.len(), expected.len(), "{page}");
            let errors = found.iter().zip(expected).map(|(a, b)| (a - b).abs() / largest);
            worst = errors.fold(worst, |worst, error| if error <= worst { worst } else { error });
        }
    }
    println!("{page}: {worst:.1e}");
    assert!(worst <= TOLERANCE, "{page}: {worst:e}");
}

#[test]
fn jacobians_are_limits_of_the_twin_s_differences() {
    for page in [
        "compound-pendulum",
        "gyroscope",
        "gyroscope-combined-offsets",
        "gyroscope-maximal",
        "gyroscope-viscous",
        "pitching-gyroscope",
        "torsion",
        "cylindrical",
        "friction",
        "gyroscope-bearings",
        "motor",
        "pendulum",
        "pitching-bearings",
        "planar",
        "prismatic",
        "screw",
        "universal",
        "carried",
    ] {
        check(page, &compiled(page));
    }
}

/// The disc's speed loses friction/inertia = 1.5 a second and gains 50 rad/s^2 for a newton metre. The work that motor
/// and friction do is bookkeeping: it would be a third state and an eigenvalue 0 that the mechanism does not have.
#[test]
fn a_linearisation_has_the_mechanism_s_own_states_alone() {
    let model = model("motor");
    let builder = TreeWithJacobian(interpreted::<Dual<f64, 4>>("motor"));
    let approach = Approach { examine: true, ..Approach::default() };
    let settings = Settings { t_end: 0.01, step: 1e-3, correct_every: None, sample_every: 0.01 };
    let mut linear = Linear::default();
    let mut motor = compiled::<f64>("motor");
    run_by(&mut motor, &builder, (&settings, &approach), &start_of(&model), |event| {
        if let Event::Linear(found) = event {
            linear = found.clone();
        }
        Ok(())
    })
    .expect("a run");
    assert_eq!((linear.state.len(), linear.slope.len()), (2, 2));
    let close = |found: &[f64], expected: &[f64]| {
        found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
    };
    assert!(close(&linear.by_state, &[0.0, 1.0, 0.0, -1.5]), "{linear:?}");
    assert!(close(&linear.by_inputs, &[0.0, 50.0]), "{linear:?}");
}
