//! Motions with contacts that are known piece by piece.

use super::{Contact, Forced, Hybrid, Phase};
use crate::{Control, Dop853, Kutta4, Ode, Tsit5};
use core::ops::Range;

const GRAVITY: f64 = 9.81;

/// A mass of one kilogram under a force.
#[derive(Clone, Copy)]
struct Mass<F>(F);

impl<F: Fn(f64, f64, f64) -> f64> Ode for Mass<F> {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        self.forced(model, t, y, &[0.0], dy);
    }
}

impl<F: Fn(f64, f64, f64) -> f64> Forced for Mass<F> {
    fn rates(&self, _: &()) -> Range<usize> {
        1..2
    }

    fn forced(&self, _: &(), t: f64, y: &[f64; 2], forces: &[f64], dy: &mut [f64; 2]) {
        *dy = [y[1], (self.0)(t, y[0], y[1]) + forces[0]];
    }
}

fn fine() -> Control {
    Control::default().with_tolerance(1e-13)
}

#[test]
fn a_bouncing_mass_comes_to_rest_at_its_zeno_time() {
    for (e, floor) in [(0.5, 0.0), (0.9, 0.0), (0.1, 0.0), (0.5, -3.0), (0.8, 100.0), (0.0, 0.0)] {
        let contact = Contact::new(0, 1).with_stops([floor, f64::INFINITY], e).unwrap();
        let start = [floor + 1.0, 0.0];
        let fall = libm::sqrt(2.0 / GRAVITY);
        let zeno = fall * (1.0 + e) / (1.0 - e);
        let motion = Mass(|_, _, _| -GRAVITY);
        let mut ball = Hybrid::new(motion, [contact], Dop853::new(&start), 0.0, &start).with_control(fine());
        while ball.phases() != &[Phase::AtLower] {
            ball.step_towards(&(), 2.0 * zeno).unwrap();
        }
        // The height is rounded where the floor is not at zero: the last rebounds cannot be told from rest.
        let bound = if floor == 0.0 { 1e-11 } else { 1e-7 };
        assert!((ball.time() / zeno - 1.0).abs() < bound, "{e}: {} for {zeno}", ball.time());
        ball.advance_to(&(), 2.0 * zeno).unwrap();
        assert_eq!(*ball.state(), [floor, 0.0]);
        let record = ball.record();
        assert!((record.lost / GRAVITY - 1.0).abs() < 1e-12, "{e}: {record:?}");
        assert_eq!(ball.forces(&()), [GRAVITY]);
    }
}

/// A pendulum of one kilogram and one metre, whose stop is at its lowest point.
fn pendulum(
    e: f64,
    control: Control,
) -> Hybrid<Mass<impl Fn(f64, f64, f64) -> f64>, [f64; 2], f64, Dop853<[f64; 2], f64>, crate::Uncorrected, 1>
{
    let contact = Contact::new(0, 1).with_stops([0.0, f64::INFINITY], e).unwrap();
    let start = [1.0, 0.0];
    Hybrid::new(Mass(|_, x, _| -libm::sin(x)), [contact], Dop853::new(&start), 0.0, &start)
        .with_control(control)
}

fn energy(y: &[f64; 2]) -> f64 {
    let half = libm::sin(0.5 * y[0]);
    0.5 * y[1] * y[1] + 2.0 * half * half
}

#[test]
fn a_pendulum_on_a_stop_keeps_what_restitution_leaves() {
    let e = 1.0 - 1e-5;
    let mut motion = pendulum(e, Control::default().with_tolerance(1e-15));
    let start = energy(motion.state());
    let mut impacts = 0;
    while impacts < 3000 {
        motion.step_towards(&(), f64::MAX).unwrap();
        impacts = motion.record().impacts;
    }
    let expected = start * libm::pow(e, 2.0 * 3000.0);
    let found = energy(motion.state());
    assert!((found / expected - 1.0).abs() < 1e-12, "{:e}", found / expected - 1.0);
    let ledger = (found + motion.record().lost) / start - 1.0;
    assert!(ledger.abs() < 1e-12, "{ledger:e}");
}
