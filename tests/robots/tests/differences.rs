//! Derivatives against differences in double-double: of the functions that they are derivatives of, which are generated
//! for any number type. With 106 bits a symmetric difference is good to some 1e-20, so what is seen is the rounding of
//! the derivatives themselves.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

mod support;

use chacha20::ChaCha8Rng;
use gyro_robots::crane::Crane;
use gyro_robots::legged::Legged;
use gyro_robots::manipulator::Manipulator;
use gyro_sim::{
    DynamicsDerivatives, InverseDynamics, JointJacobian, JointPlace, JointSpace, ParameterJacobian, Scalar,
};
use rand::{RngExt, SeedableRng};
use support::Fine;

const STATES: usize = 8;

/// Of symmetric differences.
const STEP: f64 = 1e-9;

/// Of derivatives, relative to the largest: 4e-15 is seen.
const ROUNDING: f64 = 1e-13;

fn fine(values: &[f64]) -> Vec<Fine> {
    values.iter().map(|&value| Fine::constant(value)).collect()
}

/// A mechanism in `f64` and in double-double, at the same parameters and inputs.
struct Pair<M, F> {
    coarse: M,
    fine: F,
    n_parameters: usize,
    /// What sets a parameter.
    tune: (Tune<M, f64>, Tune<F, Fine>),
}

type Tune<M, T> = fn(&mut M, usize, T) -> bool;

/// A moment.
struct Moment {
    t: f64,
    x: Vec<f64>,
    /// u̇, as good as any.
    given: Vec<f64>,
    inputs: Vec<f64>,
    parameters: Vec<f64>,
}

impl Moment {
    /// Any; Euler parameters are unit vectors.
    fn any<M: JointSpace<Scalar = f64>>(mechanism: &M, n_parameters: usize, random: &mut ChaCha8Rng) -> Self {
        let mut signed = || random.random_range(-1.0..1.0);
        let mut x: Vec<f64> = Vec::new();
        for place in mechanism.joint_layout().places {
            let n = place.n_coordinates();
            let from = x.len();
            x.extend((0..n).map(|_| signed()));
            if !matches!(place, JointPlace::Scalar { .. }) {
                let p = &mut x[from + n - 4..];
                let length = p.iter().map(|e| e * e).sum::<f64>().sqrt();
                p.iter_mut().for_each(|e| *e /= length);
            }
        }
        let n_rates = mechanism.joint_layout().n_rates();
        x.extend((0..n_rates).map(|_| 3.0 * signed()));
        x.resize(mechanism.joint_start().as_ref().len(), 0.5);
        let description = mechanism.description();
        Self {
            t: signed(),
            given: (0..n_rates).map(|_| 5.0 * signed()).collect(),
            inputs: description.inputs.iter().map(|_| 5.0 * signed()).collect(),
            // Lengths, masses and coefficients.
            parameters: (0..n_parameters).map(|_| 0.7 + 0.5 * signed()).collect(),
            x,
        }
    }
}

/// `(f(h) − f(−h)) / 2h`.
fn slope(f: impl Fn(Fine) -> Vec<Fine>) -> Vec<f64> {
    let step = Fine::constant(STEP);
    let twice = step + step;
    f(step).into_iter().zip(f(-step)).map(|(after, before)| ((after - before) / twice).to_f64()).collect()
}

/// The joint state moved by a finite amount along a rate, or by a change of the rate itself: bodies and ball joints
/// turn by a finite rotation.
fn displaced<M: JointSpace<Scalar = Fine>>(mechanism: &M, x: &[Fine], column: usize, by: Fine) -> Vec<Fine> {
    let layout = mechanism.joint_layout();
    let mut x = x.to_vec();
    let Some(mut rate) = column.checked_sub(layout.n_rates()).map_or(Some(column), |rate| {
        x[layout.n_coordinates() + rate] = x[layout.n_coordinates() + rate] + by;
        None
    }) else {
        return x;
    };
    let mut at = 0;
    for place in layout.places {
        if rate < place.n_rates() {
            let n_straight = place.n_coordinates() - if place.n_rates() == 1 { 0 } else { 4 };
            if rate < n_straight {
                x[at + rate] = x[at + rate] + by;
            } else {
                turn(&mut x[at + n_straight..at + n_straight + 4], rate - n_straight, by);
            }
            break;
        }
        rate -= place.n_rates();
        at += place.n_coordinates();
    }
    x
}

/// Euler parameters after a rotation by an angle about an axis of the body's frame.
fn turn(p: &mut [Fine], axis: usize, by: Fine) {
    let half = by * Fine::constant(0.5);
    let (cosine, sine, zero) = (half.cos(), half.sin(), Fine::constant(0.0));
    let [b, c, d] = [0, 1, 2].map(|k| if k == axis { sine } else { zero });
    let [e0, e1, e2, e3] = [p[0], p[1], p[2], p[3]];
    p.copy_from_slice(&[
        e0 * cosine - e1 * b - e2 * c - e3 * d,
        e0 * b + e1 * cosine + e2 * d - e3 * c,
        e0 * c - e1 * d + e2 * cosine + e3 * b,
        e0 * d + e1 * c - e2 * b + e3 * cosine,
    ]);
}

/// The largest difference of a matrix, row by row, from one that is given by columns, relative to the largest number.
fn difference(found: &[f64], expected: &[Vec<f64>]) -> f64 {
    let n = expected.len();
    let mut largest = (0.0_f64, 1e-300_f64);
    for (column, expected) in expected.iter().enumerate() {
        assert_eq!(found.len(), n * expected.len());
        for (row, value) in expected.iter().enumerate() {
            let off = (found[n * row + column] - value).abs();
            // What is not a number is as far off as can be.
            largest = (if off <= largest.0 { largest.0 } else { off }, largest.1.max(value.abs()));
        }
    }
    largest.0 / largest.1
}

impl<M, F> Pair<M, F>
where
    M: JointSpace<Scalar = f64>,
    F: JointSpace<Scalar = Fine> + Clone,
{
    fn set(&mut self, moment: &Moment) {
        for (index, &value) in moment.inputs.iter().enumerate() {
            assert!(self.coarse.set_input(index, value) && self.fine.set_input(index, Fine::constant(value)));
        }
        for (index, &value) in moment.parameters.iter().enumerate() {
            assert!((self.tune.0)(&mut self.coarse, index, value));
            assert!((self.tune.1)(&mut self.fine, index, Fine::constant(value)));
        }
    }

    fn state(&self, x: &[f64]) -> M::Joints {
        let mut state = self.coarse.joint_start();
        state.as_mut().copy_from_slice(x);
        state
    }

    /// f.
    fn derivative(fine: &F, t: Fine, x: &[Fine]) -> Vec<Fine> {
        let (mut state, mut out) = (fine.joint_start(), fine.joint_start());
        state.as_mut().copy_from_slice(x);
        fine.joint_derivative(t, &state, &mut out);
        out.as_ref().to_vec()
    }

    /// ∂f by all that it depends on: state, time, inputs, parameters.
    fn of_joint_form(&self, moment: &Moment) -> [f64; 4]
    where
        M: JointJacobian + ParameterJacobian,
    {
        let (t, x) = (Fine::constant(moment.t), fine(&moment.x));
        let by_state = (0..x.len()).map(|column| {
            slope(|h| {
                let mut x = x.clone();
                x[column] = x[column] + h;
                Self::derivative(&self.fine, t, &x)
            })
        });
        let by_time = slope(|h| Self::derivative(&self.fine, t + h, &x));
        let changed = |set: &dyn Fn(&mut F, Fine) -> bool| {
            slope(|h| {
                let mut changed = self.fine.clone();
                assert!(set(&mut changed, h));
                Self::derivative(&changed, t, &x)
            })
        };
        let by_inputs = moment
            .inputs
            .iter()
            .enumerate()
            .map(|(index, &value)| changed(&|fine, h| fine.set_input(index, Fine::constant(value) + h)));
        let by_parameters =
            moment.parameters.iter().enumerate().map(|(index, &value)| {
                changed(&|fine, h| (self.tune.1)(fine, index, Fine::constant(value) + h))
            });
        let (state, mut of_time) = (self.state(&moment.x), self.coarse.joint_start());
        let (mut buffers, mut of_parameters) =
            (self.coarse.jacobian_buffers(), self.coarse.parameter_buffer());
        self.coarse.joint_jacobian(moment.t, &state, &mut buffers.jacobian, &mut of_time);
        self.coarse.joint_input_jacobian(moment.t, &state, &mut buffers.input_jacobian);
        self.coarse.joint_parameter_jacobian(moment.t, &state, &mut of_parameters);
        [
            difference(buffers.jacobian.as_ref(), &by_state.collect::<Vec<_>>()),
            difference(of_time.as_ref(), &[by_time]),
            difference(buffers.input_jacobian.as_ref(), &by_inputs.collect::<Vec<_>>()),
            difference(of_parameters.as_ref(), &by_parameters.collect::<Vec<_>>()),
        ]
    }

    /// ∂τ and ∂u̇ along the rates and by them.
    fn of_dynamics(&self, moment: &Moment) -> [f64; 2]
    where
        M: DynamicsDerivatives,
        F: InverseDynamics,
    {
        let (t, x, n) = (Fine::constant(moment.t), fine(&moment.x), moment.given.len());
        let run = |x: &[Fine], function: &dyn Fn(&F::Joints, &mut F::Rates)| {
            let (mut state, mut out) = (self.fine.joint_start(), self.fine.joint_buffers().rates);
            state.as_mut().copy_from_slice(x);
            function(&state, &mut out);
            out.as_ref().to_vec()
        };
        let mut given = self.fine.joint_buffers().rates;
        given.as_mut().copy_from_slice(&fine(&moment.given));
        let columns = |function: &dyn Fn(&F::Joints, &mut F::Rates)| -> Vec<Vec<f64>> {
            let column = |column| slope(|h| run(&displaced(&self.fine, &x, column, h), function));
            (0..2 * n).map(column).collect()
        };
        let of_forces = columns(&|x, out| self.fine.inverse_dynamics(t, x, &given, out));
        let of_accelerations = columns(&|x, out| self.fine.joint_accelerations(t, x, out));
        let (state, mut rates) = (self.state(&moment.x), self.coarse.joint_buffers().rates);
        rates.as_mut().copy_from_slice(&moment.given);
        let (mut inverse, mut forward) = (self.coarse.inverse_buffer(), self.coarse.forward_buffer());
        self.coarse.inverse_derivatives(moment.t, &state, &rates, &mut inverse);
        self.coarse.forward_derivatives(moment.t, &state, &mut forward);
        let along: Vec<f64> = forward.as_ref().chunks(3 * n).flat_map(|row| &row[..2 * n]).copied().collect();
        [difference(inverse.as_ref(), &of_forces), difference(&along, &of_accelerations)]
    }
}

/// The largest of some errors at some moments.
fn check<M, F, const N: usize>(
    name: &str,
    mut pair: Pair<M, F>,
    errors: impl Fn(&Pair<M, F>, &Moment) -> [f64; N],
) where
    M: JointSpace<Scalar = f64>,
    F: JointSpace<Scalar = Fine> + Clone,
{
    let (mut random, mut worst) = (ChaCha8Rng::seed_from_u64(6), [0.0_f64; N]);
    for _ in 0..STATES {
        let moment = Moment::any(&pair.coarse, pair.n_parameters, &mut random);
        pair.set(&moment);
        for (worst, error) in worst.iter_mut().zip(errors(&pair, &moment)) {
            *worst = worst.max(error);
        }
    }
    println!("{name}: {worst:?}");
    assert!(worst.iter().all(|error| *error <= ROUNDING), "{name}: {worst:?}");
}

fn manipulator() -> Pair<Manipulator<f64>, Manipulator<Fine>> {
    Pair {
        coarse: Manipulator::default(),
        fine: Manipulator::default(),
        n_parameters: Manipulator::<f64>::PARAMETERS.len(),
        tune: (Manipulator::set_parameter, Manipulator::set_parameter),
    }
}

fn crane() -> Pair<Crane<f64>, Crane<Fine>> {
    Pair {
        coarse: Crane::default(),
        fine: Crane::default(),
        n_parameters: Crane::<f64>::PARAMETERS.len(),
        tune: (Crane::set_parameter, Crane::set_parameter),
    }
}

fn legged() -> Pair<Legged<f64>, Legged<Fine>> {
    Pair {
        coarse: Legged::default(),
        fine: Legged::default(),
        n_parameters: Legged::<f64>::PARAMETERS.len(),
        tune: (Legged::set_parameter, Legged::set_parameter),
    }
}

/// By state, time, inputs and parameters; of three rates, of eleven with a ball on a moving base, and of twelve with
/// a floating base.
#[test]
fn derivatives_of_the_joint_form_are_limits_of_differences() {
    check("manipulator", manipulator(), Pair::of_joint_form);
    check("crane", crane(), Pair::of_joint_form);
    check("legged", legged(), Pair::of_joint_form);
}

/// Along the rates: free bodies and ball joints turn by finite rotations.
#[test]
fn derivatives_of_the_dynamics_are_limits_of_differences() {
    check("manipulator", manipulator(), Pair::of_dynamics);
    check("legged", legged(), Pair::of_dynamics);
}
