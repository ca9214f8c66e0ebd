//! Peaucellier's linkage, reduced to the angle of its crank.
//!
//! The crank leads the inner corner C of a rhombus with sides b about its pivot; the two corners U and L beside it are
//! at the ends of long bars a that turn about the origin, where the circles about the origin and about C meet:
//!
//! ```text
//! U, L = x C ± y C⊥       x = ½ (a² − b² + C·C)/C·C       y² = a²/C·C − x²       D = U + L − C
//! ```
//!
//! If the crank is as long as its pivot is far from the origin, the outer corner D moves on a straight line (A.
//! Peaucellier, 1864).

use crate::DoubleDouble;
use crate::extrapolation::State;
use crate::jet::{Arrow, Jet, Moving, fixed, minus, outer, plus, unit};
use crate::one_freedom::{Heft, OneFreedom, acceleration, energy, motion};
use crate::rotation::Precise;
use crate::trajectory::{decimal, decimals};

/// Peaucellier's linkage and its start, of slender bars with their mass centres in the middle. Numbers are the decimals
/// they print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaucellier {
    /// Lengths of the crank, of the long bars and of the rhombus's sides, m.
    pub lengths: [f64; 3],
    /// Their masses, kg.
    pub masses: [f64; 3],
    /// Their moments of inertia across the bar through the mass centre, kg·m².
    pub inertias: [f64; 3],
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 2],
    /// Crank angle at time zero, rad.
    pub start: f64,
    /// Crank rate at time zero, rad/s.
    pub rate: f64,
}

/// A [`Peaucellier`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PeaucellierSample {
    /// Time, s.
    pub t: f64,
    /// Angles against x, rad, of the crank (continuous), and, within half a turn, of the bars from the origin to U and
    /// L, from U to C and D, and from L to C and D.
    pub angles: [f64; 7],
    /// Their rates, rad/s.
    pub rates: [f64; 7],
    /// The crank's acceleration, rad/s².
    pub acceleration: f64,
    /// The outer corner D, m.
    pub corner: [f64; 2],
    /// Kinetic energy and −Σ m g·r, J.
    pub energy: f64,
}

struct Linkage {
    crank: DoubleDouble,
    /// a² and b².
    squares: [DoubleDouble; 2],
    hefts: [Heft; 3],
    gravity: Precise,
}

impl Peaucellier {
    /// Bars of 1 kg a metre, the crank thrown at 8 rad/s from where the rhombus is widest open.
    #[must_use]
    pub fn thrown() -> Self {
        Peaucellier {
            lengths: [0.35, 1.0, 0.4],
            masses: [0.35, 1.0, 0.4],
            inertias: [0.00357291666667, 0.0833333333333, 0.00533333333333],
            gravity: [0.0, -9.81],
            start: 0.0,
            rate: 8.0,
        }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or the rhombus folds on the way.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<PeaucellierSample> {
        let [crank, long, side] = decimals(self.lengths);
        let [x, y] = decimals(self.gravity);
        let linkage = Linkage {
            crank,
            squares: [long * long, side * side],
            hefts: core::array::from_fn(|k| Heft::diagonal(self.masses[k], [0.0, 0.0, self.inertias[k]])),
            gravity: [x, y, DoubleDouble::ZERO],
        };
        let start = [decimal(self.start), decimal(self.rate)];
        motion(&linkage, start, times).iter().map(|(t, state)| linkage.sample(*t, state)).collect()
    }
}

impl Linkage {
    /// Origin, pivot, C, U, L and D.
    fn points(&self, angle: Jet) -> [Arrow; 6] {
        let zero = Jet::constant(DoubleDouble::ZERO);
        let (sin, cos) = angle.sin_cos();
        let pivot = [Jet::constant(self.crank), zero, zero];
        let inner_corner = plus(pivot, [cos, sin, zero].map(|x| x.scaled(self.crank)));
        let [x, y, _] = inner_corner;
        let squared = x * x + y * y;
        let [long, side] = self.squares.map(Jet::constant);
        let along = (long - side + squared) / (squared + squared);
        let across = (long / squared - along * along).sqrt();
        let middle = inner_corner.map(|c| along * c);
        let beside = [-(across * y), across * x, zero];
        let (upper, lower) = (plus(middle, beside), minus(middle, beside));
        [[zero; 3], pivot, inner_corner, upper, lower, minus(plus(upper, lower), inner_corner)]
    }

    /// The bars, in the order of [`PeaucellierSample::angles`].
    fn bars(&self, angle: Jet) -> [Moving; 7] {
        let [origin, pivot, near, upper, lower, far] = self.points(angle);
        let ends = [
            (pivot, near),
            (origin, upper),
            (origin, lower),
            (upper, near),
            (upper, far),
            (lower, near),
            (lower, far),
        ];
        let half = DoubleDouble::new(0.5);
        let z = fixed([0.0, 0.0, 1.0].map(DoubleDouble::new));
        ends.map(|(from, to)| {
            let u = unit(minus(to, from));
            Moving { centre: plus(from, to).map(|x| x.scaled(half)), axes: [u, outer(z, u), z] }
        })
    }

    fn sample(&self, t: DoubleDouble, state: &State<2>) -> PeaucellierSample {
        let [angle, rate] = *state;
        let bars = self.bars(Jet::variable(angle));
        let mut angles = bars.map(|bar| {
            let [x, y, _] = bar.axes[0].map(|x| x.0[0]);
            y.atan2(x).to_f64()
        });
        angles[0] = angle.to_f64();
        let [.., corner] = self.points(Jet::variable(angle));
        PeaucellierSample {
            t: t.to_f64(),
            angles,
            rates: bars.map(|bar| (bar.turning()[0][2] * rate).to_f64()),
            acceleration: acceleration(self, *state).to_f64(),
            corner: [0, 1].map(|k| corner[k].0[0].to_f64()),
            energy: energy(self, *state).to_f64(),
        }
    }
}

impl OneFreedom for Linkage {
    fn bodies(&self, angle: Jet) -> Vec<(Heft, Moving)> {
        let [crank, long, side] = self.hefts;
        [crank, long, long, side, side, side, side].into_iter().zip(self.bars(angle)).collect()
    }

    fn gravity(&self) -> Precise {
        self.gravity
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_outer_corner_stays_on_its_line() {
        for sample in Peaucellier::thrown().solve(&[0.0, 0.1, 0.2]) {
            assert!((sample.corner[0] - 1.2).abs() < 1e-15, "{sample:?}");
        }
    }

    #[test]
    fn energy_is_kept_and_accelerations_are_derivatives() {
        const STEP: f64 = 1e-5;
        let samples = Peaucellier::thrown().solve(&[0.0, 0.1 - STEP, 0.1, 0.1 + STEP, 0.2]);
        for sample in &samples {
            assert!((sample.energy - samples[0].energy).abs() < 1e-13, "{sample:?}");
        }
        let slope = (samples[3].rates[0] - samples[1].rates[0]) / (2.0 * STEP);
        let found = samples[2].acceleration;
        assert!((found - slope).abs() < 1e-6 * slope.abs(), "{found} {slope}");
    }

    #[test]
    fn angles_change_at_their_rates() {
        const STEP: f64 = 1e-5;
        let samples = Peaucellier::thrown().solve(&[0.15 - STEP, 0.15, 0.15 + STEP]);
        for bar in 0..7 {
            let slope = (samples[2].angles[bar] - samples[0].angles[bar]) / (2.0 * STEP);
            let rate = samples[1].rates[bar];
            assert!((rate - slope).abs() < 1e-5 * (1.0 + rate.abs()), "bar {bar}: {rate} {slope}");
        }
    }
}
