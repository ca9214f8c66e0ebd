//! Surfaces that hit each other, slide and roll.

use super::fine;
use crate::contact::{Contact, Forced, Hybrid, Phase, Restitution};
use crate::{Dop853, Ode};
use core::ops::Range;

const GRAVITY: f64 = 9.81;

/// A ball of one kilogram and this radius on a plane, with the moment of inertia 2/5 r²: place, velocity, angular
/// velocity.
#[derive(Clone, Copy)]
struct Ball {
    radius: f64,
    slope: f64,
}

type State = [f64; 9];

impl Ball {
    fn under(&self, y: &State, [push, along, across]: [f64; 3], dy: &mut State) {
        let moment = 0.4 * self.radius * self.radius;
        let [.., vx, vy, vz, _, _, _] = *y;
        let r = self.radius;
        *dy = [
            vx,
            vy,
            vz,
            along + GRAVITY * libm::sin(self.slope),
            across,
            push - GRAVITY * libm::cos(self.slope),
            r * across / moment,
            -r * along / moment,
            0.0,
        ];
    }
}

impl Ode for Ball {
    type Scalar = f64;
    type State = State;

    fn derivative(&self, _: &(), _t: f64, y: &State, dy: &mut State) {
        self.under(y, [0.0; 3], dy);
    }
}

impl Forced for Ball {
    const HAS_SURFACES: bool = true;

    fn rates(&self, _: &()) -> Range<usize> {
        3..9
    }

    fn forced(&self, _: &(), _t: f64, y: &State, forces: &[f64], dy: &mut State) {
        self.under(y, [forces[0], forces[1], forces[2]], dy);
    }

    fn seen(&self, model: &(), t: f64, y: &State, forces: &[f64], out: &mut [[f64; 3]]) {
        let mut dy = [0.0; 9];
        self.forced(model, t, y, forces, &mut dy);
        let r = self.radius;
        let of = |v: &[f64]| [v[2], v[0] - r * v[4], v[1] + r * v[3]];
        let (rates, accelerations) = (of(&y[3..]), of(&dy[3..]));
        out[0] = [y[2] - r, rates[0], accelerations[0]];
        out[1] = [0.0, rates[1], accelerations[1]];
        out[2] = [0.0, rates[2], accelerations[2]];
    }
}

fn ball(
    restitution: Restitution<f64>,
    friction: f64,
    slope: f64,
    start: &State,
) -> Hybrid<Ball, State, f64, Dop853<State, f64>, crate::Uncorrected, 3> {
    let contacts = Contact::surfaces(0, restitution, [friction; 2]).unwrap();
    Hybrid::new(Ball { radius: 0.1, slope }, contacts, Dop853::new(start), 0.0, start).with_control(fine())
}

/// Without rebound it slides until it rolls, at 5/7 of its velocity.
#[test]
fn a_ball_slides_until_it_rolls() {
    let start = [0.0, 0.0, 0.1, 3.0, -4.0, 0.0, 0.0, 0.0, 7.0];
    let mut motion = ball(Restitution::Newton(0.0), 0.2, 0.0, &start);
    motion.step_towards(&(), 1e-3).unwrap();
    assert_eq!(motion.phases(), &[Phase::AtLower, Phase::Slides, Phase::Slides]);
    // v = 5 - μ g t, ω r = 5/2 μ g t: they meet at 5/7 of 5 m/s.
    let ends = 2.0 * 5.0 / (7.0 * 0.2 * GRAVITY);
    while motion.phases()[1] == Phase::Slides {
        motion.step_towards(&(), 10.0).unwrap();
    }
    assert!((motion.time() - ends).abs() < 1e-12, "{} {ends}", motion.time());
    motion.advance_to(&(), 2.0).unwrap();
    let y = motion.state();
    for (found, expected) in y[3..].iter().zip([15.0 / 7.0, -20.0 / 7.0, 0.0, 200.0 / 7.0, 150.0 / 7.0, 7.0])
    {
        assert!((found - expected).abs() < 1e-11, "{y:?}");
    }
    assert!((y[2] - 0.1).abs() < 1e-15 && motion.phases()[1] == Phase::Sticks, "{y:?}");
}

/// What an impact leaves of a ball that spins: friction μ times the push until nothing slips.
fn struck(y: &State, e: f64, friction: f64) -> State {
    let (mut after, r) = (*y, 0.1);
    after[5] = -e * y[5];
    let slip = [y[3] - r * y[7], y[4] + r * y[6]];
    let speed = libm::hypot(slip[0], slip[1]);
    // A unit impulse changes slip by 7/2.
    let impulse = (friction * (1.0 + e) * y[5].abs()).min(speed / 3.5);
    if speed > 0.0 {
        let [along, across] = slip.map(|slip| -impulse * slip / speed);
        after[3] += along;
        after[4] += across;
        after[6] += 2.5 * across / r;
        after[7] -= 2.5 * along / r;
    }
    after
}

/// Bounces, of Newton's law and of Poisson's, whose push does not depend on friction here.
#[test]
fn a_ball_with_spin_bounces_as_in_closed_form() {
    for friction in [0.0, 0.1, 0.5] {
        for law in [Restitution::Newton(0.8), Restitution::Poisson(0.8)] {
            let mut y = [0.0, 0.0, 1.1, 1.0, -0.5, 0.0, 30.0, -80.0, 7.0];
            let mut motion = ball(law, friction, 0.0, &y);
            let (mut t, mut fall) = (0.0, 1.0);
            for _ in 0..8 {
                // Up to the next impact.
                let flight = if t == 0.0 { libm::sqrt(2.0 * fall / GRAVITY) } else { 2.0 * y[5] / GRAVITY };
                t += flight;
                y[0] += y[3] * flight;
                y[1] += y[4] * flight;
                y[2] = 0.1;
                y[5] -= GRAVITY * flight;
                y = struck(&y, 0.8, friction);
                fall = 0.0;
                while motion.time() < t - 1e-9 {
                    motion.step_towards(&(), 20.0).unwrap();
                }
                assert!((motion.time() - t).abs() < 1e-12, "{} {t}", motion.time());
                for (found, expected) in motion.state().iter().zip(y) {
                    assert!((found - expected).abs() < 1e-11, "{friction}: {:?} {y:?}", motion.state());
                }
            }
            motion.advance_to(&(), 20.0).unwrap();
            assert_eq!(motion.phases()[0], Phase::AtLower);
            let y = motion.state();
            let slip = libm::hypot(y[3] - 0.1 * y[7], y[4] + 0.1 * y[6]);
            assert!((y[2] - 0.1).abs() < 1e-15 && (slip < 1e-14 || friction == 0.0), "{y:?}");
        }
    }
}

/// On a slope it rolls where friction is more than 2/7 of the slope's tangent, and slides where it is less.
#[test]
fn a_ball_on_a_slope_rolls_or_slides() {
    for (friction, rolls) in [(0.12, true), (0.11, false)] {
        let slope = libm::atan(0.4);
        let start = [0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let mut motion = ball(Restitution::Newton(0.5), friction, slope, &start);
        motion.advance_to(&(), 1.0).unwrap();
        let (down, normal) = (GRAVITY * libm::sin(slope), GRAVITY * libm::cos(slope));
        let expected = if rolls { 5.0 / 7.0 * down } else { down - friction * normal };
        let y = motion.state();
        assert!((y[3] - expected).abs() < 1e-12 && (y[0] - 0.5 * expected).abs() < 1e-12, "{y:?} {expected}");
        let phase = if rolls { Phase::Sticks } else { Phase::Slides };
        assert_eq!(motion.phases(), &[Phase::AtLower, phase, phase]);
        assert_eq!(motion.record().lost, 0.0);
    }
}
