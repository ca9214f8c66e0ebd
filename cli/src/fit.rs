//! A line plus one harmonic, fitted to a joint angle: `θ(t) = a + b t + A cos ωt + B sin ωt`.
//!
//! Given ω the rest is a linear least-squares problem, so ω alone is iterated (variable projection, Golub and Pereyra
//! 1973): from the peak of the spectrum by Gauss–Newton steps on the whole problem.

use crate::spectrum;
use nalgebra::{SMatrix, SVector};
use std::fmt;

/// What an angle does, as far as a line and one harmonic say it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fit {
    /// The line's value in the middle of the samples, rad.
    pub(crate) mean: f64,
    /// Slope of the line, rad/s.
    pub(crate) slope: f64,
    /// The harmonic, unless the line says it all.
    pub(crate) harmonic: Option<Harmonic>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Harmonic {
    /// Angular frequency, rad/s.
    pub(crate) omega: f64,
    /// Half the peak-to-peak value, rad.
    pub(crate) amplitude: f64,
}

/// Why there is no fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum NoFit {
    /// The angle stays where it is.
    Still,
    /// Fewer samples or cycles than a fit needs.
    TooShort,
    /// Line and harmonic leave this part of the harmonic's amplitude unexplained.
    Unexplained(f64),
}

/// Angles that change by less, rad, are at rest: corrections and rounding are of this order.
const STILL: f64 = 1e-11;

/// A line that leaves less than this part of the range says it all: what remains of a free spin is a second-order
/// ripple.
const STRAIGHT: f64 = 1e-6;

/// Rows of a fit for five unknowns that can be told from chance.
const FEWEST_SAMPLES: usize = 16;

/// Line and harmonic are told apart only over more than one cycle.
const FEWEST_CYCLES: f64 = 1.5;

/// The root mean square of the rest, as part of the amplitude, up to which a fit is worth printing: a
/// pendulum that swings by a right angle is not harmonic.
const EXPLAINED: f64 = 0.01;

/// Further samples would not make the fit better, only slower.
const MOST_SAMPLES: usize = 1 << 18;

impl fmt::Display for NoFit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Still => write!(f, "it does not move"),
            Self::TooShort => write!(f, "the run shows too few samples or cycles"),
            Self::Unexplained(rest) => {
                write!(f, "a line plus one harmonic leaves {:.1} % of the amplitude", rest * 100.0)
            }
        }
    }
}

/// Fits samples that were taken `interval` seconds apart, the first at time zero.
pub(crate) fn fit(interval: f64, values: &[f64]) -> Result<Fit, NoFit> {
    let stride = values.len().div_ceil(MOST_SAMPLES);
    let thinned: Vec<f64> = values.iter().step_by(stride.max(1)).copied().collect();
    let samples = Samples { interval: interval * stride.max(1) as f64, values: &thinned };
    let (low, high) = thinned.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
    if thinned.len() < FEWEST_SAMPLES {
        return Err(NoFit::TooShort);
    }
    if high - low <= STILL {
        return Err(NoFit::Still);
    }
    let line = samples.line();
    if samples.rms(&line) <= STRAIGHT * (high - low) {
        return Ok(Fit { mean: line.constant, slope: line.slope, harmonic: None });
    }
    samples.with_harmonic(&line)
}

/// A model of the samples; time runs from the middle, so that the unknowns hardly depend on each other.
#[derive(Clone, Copy, Debug, Default)]
struct Curve {
    constant: f64,
    slope: f64,
    cosine: f64,
    sine: f64,
    omega: f64,
}

impl Curve {
    fn at(&self, t: f64) -> f64 {
        let (sin, cos) = (self.omega * t).sin_cos();
        self.constant + self.slope * t + self.cosine * cos + self.sine * sin
    }

    fn amplitude(&self) -> f64 {
        self.cosine.hypot(self.sine)
    }
}

struct Samples<'a> {
    interval: f64,
    values: &'a [f64],
}

impl Samples<'_> {
    fn points(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let middle = 0.5 * (self.values.len() - 1) as f64;
        self.values.iter().enumerate().map(move |(k, &value)| ((k as f64 - middle) * self.interval, value))
    }

    fn length(&self) -> f64 {
        (self.values.len() - 1) as f64 * self.interval
    }

    fn line(&self) -> Curve {
        let solution = self.solve(&Curve::default(), |t| [1.0, t / self.length()]);
        solution.map_or(Curve::default(), |[constant, slope]| Curve {
            constant,
            slope: slope / self.length(),
            ..Curve::default()
        })
    }

    fn with_harmonic(&self, line: &Curve) -> Result<Fit, NoFit> {
        let ripple: Vec<f64> = self.points().map(|(t, value)| value - line.at(t)).collect();
        let mut omega = spectrum::strongest(&ripple) / self.interval;
        let mut curve = self.linear(omega).ok_or(NoFit::TooShort)?;
        for _ in 0..MOST_ITERATIONS {
            let change = self.omega_step(&curve).ok_or(NoFit::TooShort)?;
            omega += change;
            curve = self.linear(omega).ok_or(NoFit::TooShort)?;
            if change.abs() <= 1e-13 * omega.abs() {
                break;
            }
        }
        if omega * self.length() < FEWEST_CYCLES * std::f64::consts::TAU {
            return Err(NoFit::TooShort);
        }
        let rest = self.rms(&curve) / curve.amplitude();
        if rest.is_nan() || rest > EXPLAINED {
            return Err(NoFit::Unexplained(rest));
        }
        let harmonic = Some(Harmonic { omega, amplitude: curve.amplitude() });
        Ok(Fit { mean: curve.constant, slope: curve.slope, harmonic })
    }

    /// The best curve of a given frequency.
    fn linear(&self, omega: f64) -> Option<Curve> {
        let length = self.length();
        let columns = |t: f64| [1.0, t / length, (omega * t).cos(), (omega * t).sin()];
        let [constant, slope, cosine, sine] = self.solve(&Curve::default(), columns)?;
        Some(Curve { constant, slope: slope / length, cosine, sine, omega })
    }

    /// The Gauss–Newton step of ω, all unknowns free.
    fn omega_step(&self, curve: &Curve) -> Option<f64> {
        let length = self.length();
        let columns = |t: f64| {
            let (sin, cos) = (curve.omega * t).sin_cos();
            let by_omega = t / length * (curve.sine * cos - curve.cosine * sin) / curve.amplitude();
            [1.0, t / length, cos, sin, by_omega]
        };
        let [.., step] = self.solve(curve, columns)?;
        let change = step / (length * curve.amplitude());
        change.is_finite().then_some(change)
    }

    /// Least squares of what a curve leaves, by normal equations: the columns are nearly orthogonal and of one size.
    fn solve<const N: usize>(&self, curve: &Curve, columns: impl Fn(f64) -> [f64; N]) -> Option<[f64; N]> {
        let (mut matrix, mut right) = (SMatrix::<f64, N, N>::zeros(), SVector::<f64, N>::zeros());
        for (t, value) in self.points() {
            let row = SVector::from(columns(t));
            matrix.ger(1.0, &row, &row, 1.0);
            right.axpy(value - curve.at(t), &row, 1.0);
        }
        let solution = matrix.cholesky()?.solve(&right);
        Some(solution.into())
    }

    fn rms(&self, curve: &Curve) -> f64 {
        let sum: f64 = self.points().map(|(t, value)| (value - curve.at(t)).powi(2)).sum();
        (sum / self.values.len() as f64).sqrt()
    }
}

/// Gauss–Newton converges in four or five steps from the peak of the spectrum.
const MOST_ITERATIONS: usize = 20;

#[cfg(test)]
mod tests;
