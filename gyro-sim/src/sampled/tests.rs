//! Closed loops against the exact motion of a linear plant between samples.

use super::{Controller, Period, Pid, Quantised, Sampled, StateFeedback, TransferFunction};
use crate::{Control, Dop853, Kutta4, Ode, Solver};

/// `ẍ = u − k x − c ẋ`, its force being the model.
#[derive(Clone, Copy, Debug)]
struct Mass;

const STIFFNESS: f64 = 9.0;
const DAMPING: f64 = 0.4;

impl Ode<f64> for Mass {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, force: &f64, _: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        *dy = [y[1], force - STIFFNESS * y[0] - DAMPING * y[1]];
    }
}

/// The state after a time under a constant force: the exponential of the plant's matrix, in closed form.
fn exact([x, v]: [f64; 2], force: f64, t: f64) -> [f64; 2] {
    let (rest, decay) = (force / STIFFNESS, 0.5 * DAMPING);
    let frequency = libm::sqrt(STIFFNESS - decay * decay);
    let (sin, cos) = (libm::sin(frequency * t) / frequency, libm::cos(frequency * t));
    let (x, factor) = (x - rest, libm::exp(-decay * t));
    [
        rest + factor * (x * (cos + decay * sin) + v * sin),
        factor * (v * (cos - decay * sin) - STIFFNESS * x * sin),
    ]
}

const START: [f64; 2] = [0.5, -1.0];
const T_END: f64 = 3.0;

/// The laws at work in a loop, and their states at all times at which one of them acts, the motion being exact or
/// integrated.
fn closed<C, D>(mut one: Sampled<C, f64, 1>, mut other: Sampled<D, f64, 1>, is_exact: bool) -> [f64; 3]
where
    C: Controller<f64>,
    D: Controller<f64>,
{
    let control = Control::default().with_tolerance(1e-14);
    let mut solver = Solver::new(Mass, Dop853::new(&START), 0.0, &START).with_control(control);
    let (mut t, mut y, mut u, mut v) = (0.0, START, [0.0], [0.0]);
    while t < T_END {
        let outputs = y;
        let is_set = [one.act(t, &outputs, &mut u), other.act(t, &outputs, &mut v)];
        let (force, to) = (u[0] + v[0], one.next().min(other.next()).min(T_END));
        if is_exact {
            y = exact(y, force, to - t);
        } else {
            if is_set != [false; 2] {
                solver.system_has_changed();
            }
            solver.advance_to(&force, to).unwrap();
            y = *solver.state();
        }
        t = to;
    }
    [y[0], y[1], u[0] + v[0]]
}

fn pid(period: Period) -> Pid<f64> {
    Pid::new([6.0, 9.0, 1.2], period.seconds()).with_setpoint(0.3).with_limits([-2.0, 1.5])
}

fn assert_close(what: &str, found: [f64; 3], expected: [f64; 3]) {
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{what}: {found:e} for {expected:e}");
    }
}

#[test]
fn loops_of_several_controllers_move_as_matrix_exponentials_say() {
    let [fast, slow] = [(1, 100), (3, 70)].map(|(n, d)| Period::new(n, d).unwrap());
    let feedback = StateFeedback { gains: [[0.0, 0.7]], reference: [0.0; 2] };
    for delay in [0.0, 0.004, 0.01] {
        let both = || {
            let one = Sampled::new(pid(fast), fast).with_delay(delay).unwrap();
            (one, Sampled::new(feedback, slow))
        };
        let ((one, other), (again, and_other)) = (both(), both());
        let (found, expected) = (closed(one, other, false), closed(again, and_other, true));
        assert_close("pid and feedback", found, expected);
        assert!((expected[0] - 0.3).abs() < 0.2, "it comes to the set point: {expected:?}");
    }
    let coarse = || {
        let lag = TransferFunction::new(2.0, [0.5, -0.25], [-0.6, 0.1]);
        let converted = Quantised { controller: pid(slow), outputs: [1e-3], inputs: 0.02 };
        (Sampled::new(lag, fast), Sampled::new(converted, slow))
    };
    let ((one, other), (again, and_other)) = (coarse(), coarse());
    assert_close("quantised", closed(one, other, false), closed(again, and_other, true));
}

/// A delay of a whole period is one sample more in the loop: the force of the sample before.
#[test]
fn what_is_computed_takes_effect_after_its_delay() {
    struct Count(f64);
    impl Controller<f64> for Count {
        fn sample(&mut self, _: f64, _: &[f64], inputs: &mut [f64]) {
            self.0 += 1.0;
            inputs[0] = self.0;
        }
    }
    let period = Period::hertz(10).unwrap();
    for (delay, expected) in [(0.0, [1.0, 2.0, 3.0]), (0.05, [0.0, 1.0, 2.0]), (0.1, [0.0, 1.0, 2.0])] {
        let mut sampled = Sampled::new(Count(0.0), period).with_delay(delay).unwrap();
        let mut inputs = [0.0];
        for (k, expected) in (0..).zip(expected) {
            let time = period.times(k);
            while sampled.next() < time {
                sampled.act(sampled.next(), &[], &mut inputs);
            }
            sampled.act(time, &[], &mut inputs);
            assert_eq!(inputs[0], expected, "{delay} at {time}");
        }
    }
    assert!(Sampled::<_, f64, 1>::new(Count(0.0), period).with_delay(0.11).is_none());
}

#[test]
fn times_are_multiples_and_never_sums() {
    let [tenth, three] = [(1, 10), (3, 10)].map(|(n, d)| Period::new(n, d).unwrap());
    assert_eq!(tenth.times(3), 0.3);
    for k in 0..100_000 {
        assert_eq!(tenth.times(3 * k), three.times(k));
    }
    assert!(Period::new(0, 1).is_none() && Period::hertz(0).is_none());
}

/// Steps of fixed length end at rounded times: each still meets its sample, none twice.
#[test]
fn steps_of_fixed_length_meet_every_sample() {
    struct Times(u64);
    impl Controller<f64> for Times {
        fn sample(&mut self, t: f64, _: &[f64], _: &mut [f64]) {
            let expected = Period::hertz(1000).unwrap().times(self.0);
            assert!((t - expected).abs() < 1e-9, "{t} for {expected}");
            self.0 += 1;
        }
    }
    let mut sampled = Sampled::<_, f64, 1>::new(Times(0), Period::hertz(1000).unwrap());
    let mut inputs = [0.0];
    for step in 0..100_000 {
        sampled.act(f64::from(step) * 1e-4, &[], &mut inputs);
    }
    assert_eq!(sampled.controller_mut().0, 10_000);
    // The same in a solver, whose time is a compensated sum.
    let mut solver = Solver::new(Mass, Kutta4::new(&START), 0.0, &START);
    let mut sampled = Sampled::<_, f64, 1>::new(Times(0), Period::hertz(1000).unwrap());
    for _ in 0..10_000 {
        sampled.act(solver.time(), &[], &mut inputs);
        solver.step(&inputs[0], 1e-4).unwrap();
    }
    assert_eq!(sampled.controller_mut().0, 1000);
}

/// At a limit the integral waits, so that the output comes back as soon as its error does.
#[test]
fn the_integral_does_not_wind_up() {
    let mut law = Pid::new([0.5, 10.0, 0.0], 0.1).with_setpoint(1.0).with_limits([-1.0, 1.0]);
    let mut input = [0.0];
    for _ in 0..100 {
        law.sample(0.0, &[0.0], &mut input);
        assert_eq!(input[0], 1.0);
    }
    law.sample(0.0, &[2.0], &mut input);
    assert!(input[0] < 0.0, "{input:?}");
}
