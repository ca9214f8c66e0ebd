//! Bodies held at their mass centre by a line or a rod: the centre moves like a particle, the rotation is
//! free.
//!
//! A joint that exerts no torque about the mass centre leaves Euler's equations without one: the rotation is
//! that of a [`HeavyTop`] on its own mass centre.

use crate::base_motion::unit;
use crate::extrapolation::State;
use crate::rotation::Precise;
use crate::trajectory::{decimal, decimals, rounded, smooth_trajectory};
use crate::vector::{add, dot, scale, sub};
use crate::{BodyState, DoubleDouble, HeavyTop};

/// The rotating body that is carried, and how it starts to turn. Numbers are the decimals they print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeBody {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia tensor about the mass centre, kg·m²: `[xx, yy, zz, xy, xz, yz]`.
    pub inertia: [f64; 6],
    /// Euler parameters at time zero, of any length but zero.
    pub orientation: [f64; 4],
    /// Angular velocity in the body's frame at time zero, rad/s.
    pub angular_velocity: [f64; 3],
}

/// Point on line: the body's mass centre on a fixed line through the global origin. s̈ = g·u along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bead {
    /// The body.
    pub body: FreeBody,
    /// Direction of the line, of any length but zero.
    pub line: [f64; 3],
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Displacement along the line (m) and its rate (m/s) at time zero.
    pub start: [f64; 2],
}

/// A [`Bead`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeadSample {
    /// Time, s.
    pub t: f64,
    /// Displacement along the line and its rate, m and m/s.
    pub displacement: [f64; 2],
    /// The body.
    pub body: BodyState,
    /// Force of the line on the body, global, N: its weight's part across the line, turned round.
    pub force: [f64; 3],
}

/// Rod: the body's mass centre at a fixed distance from the global origin, as a spherical pendulum.
///
/// r̈ = g − r (v·v + g·r) / l², which has r·r̈ + v·v = 0 for r·r = l²: no angles, so no pole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodPendulum {
    /// The body.
    pub body: FreeBody,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Mass centre at time zero, m: its distance from the origin is the rod's length.
    pub position: [f64; 3],
    /// Velocity of the mass centre at time zero, m/s: at right angles to the rod.
    pub velocity: [f64; 3],
}

/// A [`RodPendulum`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RodSample {
    /// Time, s.
    pub t: f64,
    /// The body.
    pub body: BodyState,
    /// Pull in the rod, N: m (v·v + g·r) / l, positive where the rod is stretched. It is also the multiplier
    /// λ of the row ½ (d·d / l − l).
    pub tension: f64,
}

impl FreeBody {
    /// The rotation at `times`, as a body state at the origin.
    fn rotations(&self, times: &[f64]) -> Vec<BodyState> {
        let top = HeavyTop {
            mass: self.mass,
            inertia: self.inertia,
            centre: [0.0; 3],
            gravity: [0.0; 3],
            orientation: self.orientation,
            angular_velocity: self.angular_velocity,
        };
        top.solve(times).iter().map(|sample| sample.body).collect()
    }
}

impl Bead {
    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend or a number is not finite.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<BeadSample> {
        let (line, gravity, [start, first_rate]) =
            (unit(self.line), decimals(self.gravity), decimals(self.start));
        let pull = dot(line, gravity);
        let across = scale(-decimal(self.body.mass), sub(gravity, scale(pull, line)));
        let rotations = self.body.rotations(times);
        times
            .iter()
            .zip(rotations)
            .map(|(&t, body)| {
                let time = decimal(t);
                let rate = first_rate + pull * time;
                let displacement = start + (first_rate + rate).times(0.5) * time;
                let position = rounded(scale(displacement, line));
                let body = BodyState { position, velocity: rounded(scale(rate, line)), ..body };
                BeadSample { t, displacement: rounded([displacement, rate]), body, force: rounded(across) }
            })
            .collect()
    }
}

impl RodPendulum {
    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or the velocity is not at right angles to the rod.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<RodSample> {
        let (gravity, mass) = (decimals(self.gravity), decimal(self.body.mass));
        let (position, velocity) = (decimals(self.position), decimals(self.velocity));
        assert!(dot(position, velocity).to_f64().abs() < 1e-15, "the rod's length does not change");
        let squared = dot(position, position);
        let start = [position, velocity].concat().try_into().expect("two vectors");
        let motion = smooth_trajectory(|_, state| derivative(gravity, squared, state), start, times);
        let rotations = self.body.rotations(times);
        motion
            .iter()
            .zip(rotations)
            .map(|((t, state), body)| {
                let (position, velocity) = parted(state);
                let body = BodyState { position: rounded(position), velocity: rounded(velocity), ..body };
                let tension = mass * pull(gravity, squared, state) * squared.sqrt();
                RodSample { t: t.to_f64(), body, tension: tension.to_f64() }
            })
            .collect()
    }
}

fn parted(&[x, y, z, u, v, w]: &State<6>) -> (Precise, Precise) {
    ([x, y, z], [u, v, w])
}

/// (v·v + g·r) / l².
fn pull(gravity: Precise, squared: DoubleDouble, state: &State<6>) -> DoubleDouble {
    let (position, velocity) = parted(state);
    (dot(velocity, velocity) + dot(gravity, position)) / squared
}

fn derivative(gravity: Precise, squared: DoubleDouble, state: &State<6>) -> State<6> {
    let (position, velocity) = parted(state);
    let [a, b, c] = add(gravity, scale(-pull(gravity, squared, state), position));
    let [u, v, w] = velocity;
    [u, v, w, a, b, c]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BaseMotion, Chain, Link};

    const ROUNDING: f64 = 1e-14;

    fn body() -> FreeBody {
        FreeBody {
            mass: 0.7,
            inertia: [0.02, 0.05, 0.04, 0.0, 0.0, 0.0],
            orientation: [1.0, 0.5, -0.3, 0.2],
            angular_velocity: [3.0, 0.1, -4.0],
        }
    }

    fn all_near(found: [f64; 3], expected: [f64; 3]) {
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() < ROUNDING * (1.0 + e.abs()), "{found:?} but {expected:?}");
        }
    }

    fn turned(body: &BodyState, v: [f64; 3]) -> [f64; 3] {
        body.rotation.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
    }

    #[test]
    fn a_bead_slides_freely_and_keeps_its_angular_momentum() {
        let bead =
            Bead { body: body(), line: [1.0, 2.0, -2.0], gravity: [0.3, 0.0, -9.81], start: [0.4, -1.0] };
        let samples = bead.solve(&[0.0, 1.5]);
        // u = (1, 2, −2)/3 has g·u = 6.64.
        let expected = 0.4 - 1.5 + 0.5 * 6.64 * 2.25;
        assert!((samples[1].displacement[0] - expected).abs() < ROUNDING, "{:?}", samples[1]);
        assert!((samples[1].displacement[1] - (6.64 * 1.5 - 1.0)).abs() < ROUNDING);
        all_near(samples[1].body.position, [1.0, 2.0, -2.0].map(|x| expected * x / 3.0));
        let momentum = |body: &BodyState| {
            let w = body.angular_velocity;
            turned(body, [0.02 * w[0], 0.05 * w[1], 0.04 * w[2]])
        };
        all_near(momentum(&samples[1].body), momentum(&samples[0].body));
        // Weight and reaction add up to a force along the line.
        let sum: [f64; 3] = core::array::from_fn(|k| samples[0].force[k] + 0.7 * bead.gravity[k]);
        all_near(sum, [1.0, 2.0, -2.0].map(|x| 0.7 * 6.64 * x / 3.0));
    }

    /// A body with two equal moments: w3 is steady and the rest turns at (1 − C/A) w3, by Euler's equations.
    #[test]
    fn a_symmetric_body_nutates_by_its_closed_form() {
        let symmetric = FreeBody { inertia: [0.02, 0.02, 0.05, 0.0, 0.0, 0.0], ..body() };
        let bead = Bead { body: symmetric, line: [0.0, 0.0, 1.0], gravity: [0.0; 3], start: [0.0; 2] };
        // ẇ1 = (A − C)/A w2 w3, ẇ2 = −(A − C)/A w1 w3.
        let (sin, cos) = (-1.5f64 * -4.0 * 1.2).sin_cos();
        all_near(
            bead.solve(&[1.2])[0].body.angular_velocity,
            [3.0 * cos + 0.1 * sin, 0.1 * cos - 3.0 * sin, -4.0],
        );
    }

    #[test]
    fn a_rod_swings_like_a_point_on_two_axes() {
        let rod = RodPendulum {
            body: body(),
            gravity: [0.0, 0.0, -9.81],
            position: [0.3, 0.0, -0.4],
            velocity: [0.4, 1.2, 0.3],
        };
        // Rx(θ1) Ry(θ2) turns (0, 0, −½) to (−½ sin θ2, ½ sin θ1 cos θ2, −½ cos θ1 cos θ2): θ2 = −asin 0.6 at
        // the start.
        let links = [
            Link { rate: 3.0, ..Link::turning([1.0, 0.0, 0.0]) },
            Link {
                own: [0.0, 0.0, 0.5],
                mass: 0.7,
                start: -(0.6f64.asin()),
                rate: -1.0,
                ..Link::turning([0.0, 1.0, 0.0])
            },
        ];
        let chain = Chain { gravity: rod.gravity, base: BaseMotion::default(), links };
        for (found, expected) in rod.solve(&[0.0, 0.8, 2.0]).iter().zip(chain.solve(&[0.0, 0.8, 2.0])) {
            all_near(found.body.position, expected.bodies[1].position);
            all_near(found.body.velocity, expected.bodies[1].velocity);
            let force = expected.reactions[0].force;
            all_near(found.body.position.map(|x| -found.tension * x / 0.5), force);
        }
    }
}
