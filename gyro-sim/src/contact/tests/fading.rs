//! Stops that let go as the push on them fades.

use super::{Random, fine};
use crate::contact::{Contact, Forced, Hybrid, Phase};
use crate::{Dop853, Ode};
use core::ops::Range;

/// A mass on a stop and a hand that moves on at one metre each second, whose place makes the push on the mass: the
/// state is `(x, z, ẋ, ż)`. Nothing depends on time itself.
struct Pushed {
    size: f64,
    fade: f64,
    origin: f64,
}

impl Ode for Pushed {
    type Scalar = f64;
    type State = [f64; 4];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 4], dy: &mut [f64; 4]) {
        self.forced(model, t, y, &[0.0], dy);
    }
}

impl Forced for Pushed {
    fn rates(&self, _: &()) -> Range<usize> {
        2..4
    }

    fn forced(&self, (): &(), _: f64, y: &[f64; 4], forces: &[f64], dy: &mut [f64; 4]) {
        let push = self.size * libm::sin(1.0 - self.fade * (y[1] - self.origin));
        *dy = [y[2], y[3], push + forces[0], 0.0];
    }
}

/// At the time at which it lets go no force is left that could tell what is small, and what is left of the way of the
/// hand to where the push is zero may be less than a rounding of its place: no step leads there.
#[test]
fn a_push_that_fades_lets_go_when_it_has_gone() {
    let mut random = Random(5);
    for case in 0..200 {
        let (size, fade) = (random.between(0.1, 10.0), random.between(0.3, 2.0));
        let (end, origin) = (random.between(0.1, 2.0), random.between(-1e3, 1e3));
        let start = [end, origin, 0.0, 1.0];
        let stop = Contact::new(0, 2).with_stops([-1e3, end], 0.0).unwrap();
        let pushed = Pushed { size, fade, origin };
        let mut mass = Hybrid::new(pushed, [stop], Dop853::new(&start), 0.0, &start).with_control(fine());
        mass.step_towards(&(), 1e-3).unwrap();
        assert_eq!(mass.phases(), &[Phase::AtUpper], "case {case}");
        let (t_end, mut steps) = (1.0 / fade + 0.1, 0);
        while mass.record().released == 0 {
            mass.step_towards(&(), t_end).unwrap();
            steps += 1;
            assert!(mass.time() < t_end && steps < 100, "case {case}: {steps} steps, {}", mass.time());
        }
        // The place of the hand is rounded.
        let error = mass.time() - 1.0 / fade;
        assert!(error.abs() < 1e-11, "case {case}: {} for {}", mass.time(), 1.0 / fade);
        mass.advance_to(&(), t_end).unwrap();
        assert!(mass.state()[0] < end && mass.phases() == &[Phase::Free], "case {case}: {:?}", mass.state());
    }
}
