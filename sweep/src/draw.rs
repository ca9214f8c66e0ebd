//! What is drawn at random.

use crate::normal;
use nanoserde::{DeBin, SerBin};

/// How one number is distributed.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub enum Distribution {
    /// Equally likely everywhere between two numbers.
    Uniform([f64; 2]),
    /// Its logarithm is.
    LogUniform([f64; 2]),
    /// Normal, with this mean and this standard deviation.
    Normal([f64; 2]),
    /// The same, given that it is between two numbers.
    Truncated([f64; 2], [f64; 2]),
}

/// What one or several numbers are drawn from.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Draw {
    /// One target by itself.
    Alone {
        /// Index of the target.
        target: usize,
        /// Its distribution.
        distribution: Distribution,
    },
    /// Targets that are normal together.
    Together {
        /// Indices of the targets.
        targets: Vec<usize>,
        /// Their means.
        mean: Vec<f64>,
        /// The lower Cholesky factor of their covariance, row by row.
        factor: Vec<f64>,
    },
}

impl Distribution {
    /// The number that a uniform one within (0, 1) stands for: it rises with it.
    pub fn quantile(&self, u: f64) -> f64 {
        match *self {
            Self::Uniform([from, to]) => from + u * (to - from),
            Self::LogUniform([from, to]) => {
                let (low, high) = (libm::log(from), libm::log(to));
                libm::exp(low + u * (high - low)).clamp(from, to)
            }
            Self::Normal([mean, deviation]) => mean + deviation * normal::quantile(u),
            Self::Truncated([mean, deviation], [from, to]) => {
                let [a, b] = [from, to].map(|end| (end - mean) / deviation);
                // In the upper tail Φ is one to rounding: seen from there it is the lower one.
                let within = if a > 0.0 { -truncated(1.0 - u, [-b, -a]) } else { truncated(u, [a, b]) };
                (mean + deviation * within).clamp(from, to)
            }
        }
    }

    /// Its mean and its variance.
    pub fn moments(&self) -> [f64; 2] {
        match *self {
            Self::Uniform([from, to]) => [0.5 * (from + to), (to - from) * (to - from) / 12.0],
            Self::Normal([mean, deviation]) => [mean, deviation * deviation],
            Self::LogUniform([from, to]) => {
                let length = libm::log(to / from);
                let [mean, square] = [(to - from) / length, 0.5 * (to - from) * (to + from) / length];
                if length < NARROW { self.summed() } else { [mean, square - mean * mean] }
            }
            Self::Truncated([mean, deviation], [from, to]) => {
                let [a, b] = [from, to].map(|end| (end - mean) / deviation);
                // Nearly uniform: the closed form below would cancel.
                if b - a < NARROW {
                    return self.summed();
                }
                // In the upper tail Φ is one to rounding: seen from there it is the lower one.
                let ([a, b], side) = if a > 0.0 { ([-b, -a], -1.0) } else { ([a, b], 1.0) };
                let all = normal::cumulative(b) - normal::cumulative(a);
                let [at_a, at_b] = [a, b].map(|end| normal::density(end) / all);
                let shift = at_a - at_b;
                let ends = if at_a > 0.0 { a * at_a } else { 0.0 } - if at_b > 0.0 { b * at_b } else { 0.0 };
                [mean + side * deviation * shift, deviation * deviation * (1.0 + ends - shift * shift)]
            }
        }
    }

    /// The same by the midpoint rule over what is equally likely, for distributions within a narrow range.
    fn summed(&self) -> [f64; 2] {
        let all = || (0..POINTS).map(|k| self.quantile((f64::from(k) + 0.5) / f64::from(POINTS)));
        let mean = all().sum::<f64>() / f64::from(POINTS);
        [mean, all().map(|x| (x - mean) * (x - mean)).sum::<f64>() / f64::from(POINTS)]
    }

    /// The numbers between which it is, infinite ones if need be.
    pub fn range(&self) -> [f64; 2] {
        match *self {
            Self::Uniform(range) | Self::LogUniform(range) | Self::Truncated(_, range) => range,
            Self::Normal(_) => [f64::NEG_INFINITY, f64::INFINITY],
        }
    }
}

/// Points of the midpoint rule.
const POINTS: u32 = 1 << 12;

/// A range, in standard deviations, over which a normal distribution is nearly uniform.
const NARROW: f64 = 0.01;

fn truncated(u: f64, [a, b]: [f64; 2]) -> f64 {
    let [below, up_to] = [a, b].map(normal::cumulative);
    normal::quantile((below + u * (up_to - below)).clamp(f64::MIN_POSITIVE, 1.0 - f64::EPSILON / 2.0))
}

impl Draw {
    /// How many uniform numbers it takes.
    pub fn dimensions(&self) -> usize {
        match self {
            Self::Alone { .. } => 1,
            Self::Together { targets, .. } => targets.len(),
        }
    }

    /// Writes the targets' values from uniform numbers, one for each dimension.
    pub(crate) fn write(&self, uniforms: &[f64], values: &mut [f64]) {
        match self {
            Self::Alone { target, distribution } => values[*target] = distribution.quantile(uniforms[0]),
            Self::Together { targets, mean, factor } => {
                let n = targets.len();
                for (row, target) in targets.iter().enumerate() {
                    let terms = uniforms[..=row].iter().zip(&factor[n * row..]);
                    values[*target] =
                        terms.fold(mean[row], |sum, (u, entry)| sum + entry * normal::quantile(*u));
                }
            }
        }
    }
}

/// The lower Cholesky factor of a symmetric matrix, row by row; `None` if it is not positive definite.
#[cfg(feature = "study")]
pub(crate) fn cholesky(matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut factor = vec![0.0; n * n];
    for i in 0..n {
        for j in 0..=i {
            let inner: f64 = (0..j).map(|k| factor[n * i + k] * factor[n * j + k]).sum();
            let rest = matrix[n * i + j] - inner;
            factor[n * i + j] = if i == j { libm::sqrt(rest) } else { rest / factor[n * j + j] };
            if i == j && !(rest > 0.0 && rest.is_finite()) {
                return None;
            }
        }
    }
    Some(factor)
}

#[cfg(test)]
mod tests;
