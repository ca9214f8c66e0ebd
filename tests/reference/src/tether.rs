//! A body tied at its mass centre to the global origin by a spring and damper, free to turn.
//!
//! m r̈ = m g − (k (l − l0) + c l̇) r / l with l = |r| and l̇ = r·v / l; the force passes through the mass
//! centre, so the rotation is free. It is the centre that counts: a [`FreeBody`](crate::FreeBody) says how
//! such a body turns.

use crate::DoubleDouble;
use crate::extrapolation::State;
use crate::rotation::Precise;
use crate::trajectory::{decimal, decimals, rounded, smooth_trajectory};
use crate::vector::{dot, scale, sub};

/// The tied body and its start. Numbers are the decimals they print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tether {
    /// Mass, kg.
    pub mass: f64,
    /// k, N/m.
    pub stiffness: f64,
    /// c, N·s/m.
    pub damping: f64,
    /// l0, m.
    pub free_length: f64,
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Mass centre at time zero, m; not the origin.
    pub position: [f64; 3],
    /// Its velocity at time zero, m/s.
    pub velocity: [f64; 3],
}

/// A [`Tether`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TetherSample {
    /// Time, s.
    pub t: f64,
    /// Mass centre, m.
    pub position: [f64; 3],
    /// Its velocity, m/s.
    pub velocity: [f64; 3],
    /// Kinetic energy of the centre, −m g·r and ½ k (l − l0)², J.
    pub energy: f64,
    /// Work of the damper since time zero, J; never positive.
    pub work: f64,
}

struct PreciseTether {
    mass: DoubleDouble,
    stiffness: DoubleDouble,
    damping: DoubleDouble,
    free_length: DoubleDouble,
    gravity: Precise,
}

impl Tether {
    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or the centre meets the origin.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<TetherSample> {
        let tether = PreciseTether {
            mass: decimal(self.mass),
            stiffness: decimal(self.stiffness),
            damping: decimal(self.damping),
            free_length: decimal(self.free_length),
            gravity: decimals(self.gravity),
        };
        let ([x, y, z], [u, v, w]) = (decimals(self.position), decimals(self.velocity));
        let start = [x, y, z, u, v, w, DoubleDouble::ZERO];
        let motion = smooth_trajectory(|_, state| tether.derivative(state), start, times);
        motion.iter().map(|(t, state)| tether.sample(*t, state)).collect()
    }
}

fn parted(&[x, y, z, u, v, w, _]: &State<7>) -> (Precise, Precise) {
    ([x, y, z], [u, v, w])
}

impl PreciseTether {
    /// Velocity, acceleration and power of the damper.
    fn derivative(&self, state: &State<7>) -> State<7> {
        let (position, velocity) = parted(state);
        let length = dot(position, position).sqrt();
        let rate = dot(position, velocity) / length;
        let pull = self.stiffness * (length - self.free_length) + self.damping * rate;
        let [a, b, c] = sub(self.gravity, scale(pull / (length * self.mass), position));
        let [u, v, w] = velocity;
        [u, v, w, a, b, c, -(self.damping * rate * rate)]
    }

    fn sample(&self, t: DoubleDouble, state: &State<7>) -> TetherSample {
        let (position, velocity) = parted(state);
        let stretch = dot(position, position).sqrt() - self.free_length;
        let doubled = self.mass * dot(velocity, velocity) + self.stiffness * stretch * stretch;
        TetherSample {
            t: t.to_f64(),
            position: rounded(position),
            velocity: rounded(velocity),
            energy: (doubled.times(0.5) - self.mass * dot(self.gravity, position)).to_f64(),
            work: state[6].to_f64(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tether() -> Tether {
        Tether {
            mass: 0.5,
            stiffness: 40.0,
            damping: 0.3,
            free_length: 0.6,
            gravity: [0.0, 0.0, -9.81],
            position: [0.5, -0.2, -0.4],
            velocity: [0.3, 1.5, -0.2],
        }
    }

    #[test]
    fn energy_goes_into_the_damper() {
        let samples = tether().solve(&[0.0, 1.0, 3.0]);
        for sample in &samples[1..] {
            assert!(sample.work < -1e-2);
            assert!((sample.energy - samples[0].energy - sample.work).abs() < 1e-14, "{sample:?}");
        }
    }

    #[test]
    fn the_momentum_about_the_vertical_stays() {
        let momentum = |s: &TetherSample| s.position[0] * s.velocity[1] - s.position[1] * s.velocity[0];
        let samples = tether().solve(&[0.0, 3.0]);
        assert!((momentum(&samples[1]) - momentum(&samples[0])).abs() < 1e-15);
    }

    /// Hung straight down it bounces as a damped oscillator about l0 + m g / k.
    #[test]
    fn a_hanging_body_bounces_by_its_closed_form() {
        let hanging = Tether { position: [0.0, 0.0, -0.8], velocity: [0.0; 3], ..tether() };
        let rest = 0.6 + 0.5 * 9.81 / 40.0;
        let delta = 0.3;
        let omega = (80.0f64 - delta * delta).sqrt();
        let (sin, cos) = (omega * 1.3).sin_cos();
        let expected = rest + (0.8 - rest) * (-delta * 1.3f64).exp() * (cos + delta / omega * sin);
        assert!((hanging.solve(&[1.3])[0].position[2] + expected).abs() < 1e-15);
    }
}
