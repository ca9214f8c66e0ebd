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
mod tests {
    use super::*;

    #[test]
    fn truncated_numbers_are_in_their_interval_and_as_likely_as_they_should_be() {
        for (from, to) in [(-1.0, 2.0), (8.0, 9.0), (-40.0, -39.0), (37.0, 60.0), (-0.5, 0.5)] {
            let distribution = Distribution::Truncated([0.0, 1.0], [from, to]);
            let mut last = f64::NEG_INFINITY;
            for k in 0..1000 {
                let x = distribution.quantile((f64::from(k) + 0.5) / 1000.0);
                assert!((from..=to).contains(&x) && x >= last, "{x} of {from} to {to}");
                last = x;
            }
        }
        // Far out it is nearly exponential: half of what lies beyond 37 lies within ln 2 / 37 of it.
        let median = Distribution::Truncated([0.0, 1.0], [37.0, 60.0]).quantile(0.5);
        assert!((median - 37.0 - std::f64::consts::LN_2 / 37.0).abs() < 2e-5, "{median}");
    }

    /// Against sums over what is equally likely, and for the far tail against an exponential distribution.
    #[test]
    fn moments_are_those_of_what_is_drawn() {
        for distribution in [
            Distribution::Uniform([-1.0, 3.0]),
            Distribution::LogUniform([1e-3, 20.0]),
            Distribution::Truncated([0.5, 2e-4], [0.4997, 0.5003]),
            Distribution::Truncated([0.0, 1.0], [-1.0, 2.0]),
            Distribution::Truncated([0.0, 1.0], [0.5, 0.509]),
            Distribution::Truncated([0.0, 1.0], [0.5, 0.511]),
            Distribution::Truncated([3.0, 2.0], [8.0, 9.0]),
        ] {
            let [mean, variance] = distribution.moments();
            let n = 100_000;
            let all = (0..n).map(|k| distribution.quantile((f64::from(k) + 0.5) / f64::from(n)));
            let sums = all.fold([0.0; 2], |[sum, squares], x| [sum + x, squares + (x - mean) * (x - mean)]);
            let [expected, spread] = sums.map(|sum| sum / f64::from(n));
            assert!(
                (mean - expected).abs() < 1e-7 * (1.0 + spread.sqrt()),
                "{distribution:?}: {mean} {expected}"
            );
            assert!((variance / spread - 1.0).abs() < 1e-6, "{distribution:?}: {variance} {spread}");
        }
        assert_eq!(Distribution::Normal([2.0, 3.0]).moments(), [2.0, 9.0]);
        let [mean, variance] = Distribution::Truncated([0.0, 1.0], [-60.0, -37.0]).moments();
        assert!((mean + 37.0 + 1.0 / 37.0).abs() < 1e-4 && (variance * 37.0 * 37.0 - 1.0).abs() < 5e-3);
        let [mean, variance] = Distribution::Truncated([0.0, 1.0], [-60.0, 60.0]).moments();
        assert!(mean.abs() < 1e-15 && (variance - 1.0).abs() < 1e-15);
    }

    #[test]
    fn numbers_drawn_together_have_their_covariance() {
        let (mean, factor) = (vec![1.0, -2.0], vec![2.0, 0.0, -0.9, 0.5]);
        let draw = Draw::Together { targets: vec![1, 0], mean, factor };
        let (mut sums, mut squares, n) = ([0.0; 2], [0.0; 3], 200);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let mut values = [0.0; 2];
            let u = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(n));
            draw.write(&u, &mut values);
            let [b, a] = [values[0] + 2.0, values[1] - 1.0];
            sums = [sums[0] + a, sums[1] + b];
            squares = [squares[0] + a * a, squares[1] + a * b, squares[2] + b * b];
        }
        let n = f64::from(n * n);
        assert!(sums.iter().all(|sum| sum.abs() / n < 1e-9), "{sums:?}");
        for (found, expected) in squares.iter().zip([4.0, -1.8, 0.81 + 0.25]) {
            assert!((found / n / expected - 1.0).abs() < 0.02, "{squares:?}");
        }
    }

    #[test]
    #[cfg(feature = "study")]
    fn a_factor_gives_its_matrix_back() {
        let matrix = [4.0, -1.8, 0.4, -1.8, 1.06, 0.1, 0.4, 0.1, 2.0];
        let factor = cholesky(&matrix, 3).unwrap();
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let product: f64 = (0..3).map(|k| factor[3 * i + k] * factor[3 * j + k]).sum();
            assert!((product - matrix[3 * i + j]).abs() < 1e-14);
        }
        assert_eq!(cholesky(&[1.0, 2.0, 2.0, 1.0], 2), None);
    }
}
