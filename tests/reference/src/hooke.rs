//! A body on a universal joint under gravity, by Lagrange's equations in the joint's two angles.
//!
//! The joint is at the global origin. Its first axis is global x; the second is the y axis of the body, which
//! stays at right angles to it: A = Rx(θ1) Ry(θ2). With u1 = (cos θ2, 0, sin θ2) and u2 = (0, 1, 0), the axes
//! in the body's frame, w = u1 θ̇1 + u2 θ̇2, and I the inertia about the joint,
//!
//! ```text
//! T = ½ w·I w,   V = −m c·Aᵀg
//! (ui·I uj) θ̈j = ui·(c × m Aᵀg − w × I w − I e),   e = (−sin θ2, 0, cos θ2) θ̇1 θ̇2
//! ```
//!
//! θ1 and θ2 are the joint's first and second angle for the frames (f, g, h) = (y, z, x) on the ground and f
//! = x, h = y on the body: `atan2(g_i·h_j, f_i·h_j)` and `atan2(−h_i·g_j, h_i·f_j)`.

use crate::extrapolation::State;
use crate::rotation::{Precise, Rotation, moved_tensor, tensor_times};
use crate::trajectory::{decimal, decimals, rounded, smooth_trajectory};
use crate::vector::{Turn, add, cross, dot, scale, sub};
use crate::{BodyState, DoubleDouble};

/// A body on a universal joint and its start. Numbers are the decimals they print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HookePendulum {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia tensor about the mass centre, kg·m²: `[xx, yy, zz, xy, xz, yz]`.
    pub inertia: [f64; 6],
    /// The mass centre from the joint, in the body's frame, m.
    pub centre: [f64; 3],
    /// Acceleration of gravity, global, m/s².
    pub gravity: [f64; 3],
    /// θ1 and θ2 at time zero, rad.
    pub start: [f64; 2],
    /// Their rates, rad/s.
    pub rates: [f64; 2],
}

/// A [`HookePendulum`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HookeSample {
    /// Time, s.
    pub t: f64,
    /// θ1 and θ2, rad.
    pub angles: [f64; 2],
    /// Their rates, rad/s.
    pub rates: [f64; 2],
    /// Their accelerations, rad/s².
    pub accelerations: [f64; 2],
    /// The body.
    pub body: BodyState,
    /// Kinetic energy and −m g·r, J.
    pub energy: f64,
}

struct Body {
    mass: DoubleDouble,
    /// About the joint.
    inertia: [DoubleDouble; 6],
    centre: Precise,
    gravity: Precise,
}

impl HookePendulum {
    /// A body with nothing special about it: skew inertia, mass centre off both axes, swinging wide under
    /// gravity along −z.
    #[must_use]
    pub fn example() -> Self {
        HookePendulum {
            mass: 2.0,
            inertia: [0.05, 0.06, 0.03, 0.002, -0.004, 0.003],
            centre: [0.03, -0.02, -0.4],
            gravity: [0.0, 0.0, -9.81],
            start: [0.9, -0.5],
            rates: [1.5, 2.0],
        }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend or a number is not finite.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<HookeSample> {
        let body = self.precisely();
        let motion = smooth_trajectory(|_, state| body.derivative(state), self.initial(), times);
        motion.iter().map(|(t, state)| body.sample(*t, state)).collect()
    }

    fn initial(&self) -> State<4> {
        let ([a, b], [c, d]) = (decimals(self.start), decimals(self.rates));
        [a, b, c, d]
    }

    fn precisely(&self) -> Body {
        let (mass, centre) = (decimal(self.mass), decimals(self.centre));
        let inertia = moved_tensor(decimals(self.inertia), mass, centre);
        Body { mass, inertia, centre, gravity: decimals(self.gravity) }
    }
}

/// A = Rx(θ1) Ry(θ2).
fn rotation(&[first, second, ..]: &State<4>) -> Rotation {
    let (first, second) = (Turn::new(first), Turn::new(second));
    Rotation(Rotation::IDENTITY.0.map(|axis| first.about_x(second.about_y(axis))))
}

/// u1, u2, and e without its factor θ̇1 θ̇2.
fn axes(second: DoubleDouble) -> [Precise; 3] {
    let (sin, cos) = second.sin_cos();
    let zero = DoubleDouble::ZERO;
    [[cos, zero, sin], [zero, DoubleDouble::new(1.0), zero], [-sin, zero, cos]]
}

impl Body {
    fn angular_velocity(state: &State<4>) -> Precise {
        let [u1, u2, _] = axes(state[1]);
        add(scale(state[2], u1), scale(state[3], u2))
    }

    fn derivative(&self, state: &State<4>) -> State<4> {
        let [_, second, rate1, rate2] = *state;
        let [u1, u2, bias] = axes(second);
        let w = Body::angular_velocity(state);
        let weight = scale(self.mass, rotation(state).transposed_times(self.gravity));
        let turning = add(
            cross(w, tensor_times(self.inertia, w)),
            tensor_times(self.inertia, scale(rate1 * rate2, bias)),
        );
        let moment = sub(cross(self.centre, weight), turning);
        let (i1, i2) = (tensor_times(self.inertia, u1), tensor_times(self.inertia, u2));
        let [m11, m12, m22] = [dot(u1, i1), dot(u1, i2), dot(u2, i2)];
        let [h1, h2] = [dot(u1, moment), dot(u2, moment)];
        let determinant = m11 * m22 - m12 * m12;
        [rate1, rate2, (m22 * h1 - m12 * h2) / determinant, (m11 * h2 - m12 * h1) / determinant]
    }

    fn energy(&self, state: &State<4>) -> DoubleDouble {
        let w = Body::angular_velocity(state);
        let kinetic = dot(w, tensor_times(self.inertia, w)).times(0.5);
        kinetic - self.mass * dot(self.gravity, rotation(state).times(self.centre))
    }

    fn sample(&self, t: DoubleDouble, state: &State<4>) -> HookeSample {
        let [first, second, rate1, rate2] = *state;
        let [.., acceleration1, acceleration2] = self.derivative(state);
        let (rotation, w) = (rotation(state), Body::angular_velocity(state));
        HookeSample {
            t: t.to_f64(),
            angles: rounded([first, second]),
            rates: rounded([rate1, rate2]),
            accelerations: rounded([acceleration1, acceleration2]),
            body: BodyState {
                position: rounded(rotation.times(self.centre)),
                rotation: rotation.rounded(),
                velocity: rounded(rotation.times(cross(w, self.centre))),
                angular_velocity: rounded(w),
            },
            energy: self.energy(state).to_f64(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BaseMotion, Chain, Link};

    #[test]
    fn the_chain_of_two_turns_moves_alike() {
        let hooke = HookePendulum::example();
        let [first, second] = [0, 1].map(|k| (hooke.start[k], hooke.rates[k]));
        let chain = Chain {
            gravity: hooke.gravity,
            base: BaseMotion::default(),
            links: [
                Link { start: first.0, rate: first.1, ..Link::turning([1.0, 0.0, 0.0]) },
                Link {
                    own: hooke.centre.map(|x| -x),
                    mass: hooke.mass,
                    inertia: hooke.inertia,
                    start: second.0,
                    rate: second.1,
                    ..Link::turning([0.0, 1.0, 0.0])
                },
            ],
        };
        for (found, expected) in hooke.solve(&[0.5, 3.0]).iter().zip(chain.solve(&[0.5, 3.0])) {
            assert_eq!(found.angles, expected.positions);
            assert_eq!(found.rates, expected.rates);
            assert_eq!(found.accelerations, expected.accelerations);
            assert_eq!(found.body, expected.bodies[1]);
            assert_eq!(found.energy, expected.energy);
        }
    }

    /// With gravity along the first axis θ1 does not enter the Lagrangian: energy and ∂T/∂θ̇1 = u1·I w stay.
    #[test]
    fn energy_and_the_momentum_about_the_first_axis_stay() {
        let hooke = HookePendulum { gravity: [7.0, 0.0, 0.0], ..HookePendulum::example() };
        let body = hooke.precisely();
        let invariants = |state: &State<4>| {
            let momentum = tensor_times(body.inertia, Body::angular_velocity(state));
            [body.energy(state), dot(axes(state[1])[0], momentum)]
        };
        let end = smooth_trajectory(|_, state| body.derivative(state), hooke.initial(), &[2.0])[0].1;
        for (a, b) in invariants(&hooke.initial()).iter().zip(invariants(&end)) {
            assert!((*a - b).to_f64().abs() < 1e-24, "{a:?} {b:?}");
        }
    }
}
