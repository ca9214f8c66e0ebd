//! Which numbers parameters may have: the rules of a model file that parameters can break, looked at again when they
//! are set.
//!
//! `cargo xtask simulate --set` decides them exactly, in rationals; here they are decided in floating point, and what
//! is on the boundary by no more than rounding is allowed. A generated module computes the numbers of its rules in
//! `Parameters::check`:
//! ```
//! use gyro_sim::admissible::{Rule, check};
//! let rules = |p: [f64; 1]| [(0, Rule::Positive(p[0]))];
//! assert!(check(&[0.085], rules).is_ok());
//! assert_eq!(check(&[-0.085], rules).unwrap_err().parameter, 0);
//! assert!(check(&[f64::NAN], rules).is_err());
//! ```

use crate::Real;
use core::fmt;

/// What must hold of numbers that depend on parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Masses, lengths, coefficients that hold something.
    Positive(f64),
    /// Coefficients that would drive the motion.
    NotNegative(f64),
    /// Ratios, leads, directions, Euler parameters: not all are zero. Fewer than four numbers are followed by zeros.
    NotZero([f64; 4]),
    /// An axis and a zero direction: they span a plane.
    NotParallel([f64; 3], [f64; 3]),
    /// `[xx, yy, zz, xy, xz, yz]`: positive definite, and no principal moment exceeds the sum of the other two.
    Inertia([f64; 6]),
}

/// A parameter that a mechanism cannot have, on its own or with the others as they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inadmissible {
    /// Its place among the parameters.
    pub parameter: u16,
}

impl fmt::Display for Inadmissible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "parameter {} has a value that the mechanism cannot have", self.parameter)
    }
}

impl core::error::Error for Inadmissible {}

/// The sizes that a number other than zero may have in a model file.
const SIZES: [f64; 2] = [1e-100, 1e100];

/// What rounding may take from an inequality that is allowed to be an equality, in roundings of the precision.
const ROUNDING: f64 = 8.0;

/// As exactly, in parts of their size, as numbers are taken that others computed and wrote with fewer digits. The
/// reader of model files has the same (`gyro_model`, `validate`).
const ROUNDED: f64 = 1e-9;

/// Whether parameters are numbers that a model file may have, 0 or of a size from 1e-100 to 1e100, and satisfy all
/// rules. `rules` computes these of the parameters; each comes with the place of the first parameter in it.
///
/// # Errors
/// [`Inadmissible`] names the first parameter that is not such a number, or that occurs in a rule which is broken.
#[inline]
pub fn check<T: Real, const N: usize, const R: usize>(
    values: &[T; N],
    rules: impl FnOnce([f64; N]) -> [(u16, Rule); R],
) -> Result<(), Inadmissible> {
    let values = values.map(T::to_f64);
    check_all::<T>(&values, rules(values))
}

/// The same of any number of parameters and rules.
///
/// # Errors
/// As [`check`].
#[inline]
pub fn check_all<T: Real>(
    values: &[f64],
    rules: impl IntoIterator<Item = (u16, Rule)>,
) -> Result<(), Inadmissible> {
    let is_number = |value: &f64| *value == 0.0 || (SIZES[0]..=SIZES[1]).contains(&value.abs());
    if let Some((parameter, _)) = (0u16..).zip(values).find(|(_, value)| !is_number(value)) {
        return Err(Inadmissible { parameter });
    }
    match rules.into_iter().find(|(_, rule)| !rule.holds::<T>()) {
        Some((parameter, _)) => Err(Inadmissible { parameter }),
        None => Ok(()),
    }
}

/// A power with a whole exponent, as rules have it.
#[inline]
#[must_use]
pub fn power(base: f64, exponent: u32) -> f64 {
    (0..exponent).fold(1.0, |power, _| power * base)
}

impl Rule {
    #[inline]
    fn holds<T: Real>(self) -> bool {
        match self {
            Self::Positive(number) => number > 0.0,
            Self::NotNegative(number) => number >= 0.0,
            Self::NotZero(numbers) => numbers.iter().any(|number| *number != 0.0),
            Self::NotParallel(a, b) => {
                let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                let size = |v: [f64; 3]| libm::sqrt(v.iter().fold(0.0, |sum, x| sum + x * x));
                size(cross) > ROUNDED * size(a) * size(b)
            }
            Self::Inertia(elements) => {
                // In the precision in which they are set equality is known to so much.
                is_inertia(elements, (ROUNDING * T::EPSILON.to_f64()).max(ROUNDED))
            }
        }
    }
}

/// Positive definite by its leading principal minors (Sylvester); the tensor of second moments of mass, ½ tr(J) I − J,
/// positive semidefinite by all its principal minors, where `slack` is added to each moment. Scaled by the trace, so
/// that no product leaves the numbers.
fn is_inertia(elements: [f64; 6], slack: f64) -> bool {
    let trace = elements[0] + elements[1] + elements[2];
    if trace.is_nan() || trace <= 0.0 {
        return false;
    }
    let j = elements.map(|x| x / trace);
    let [m2, m3] = [minors(&j), [determinant(&j); 3]];
    let is_positive = j[0] > 0.0 && m2[0] > 0.0 && m3[0] > 0.0;
    let m = [0.5 + slack - j[0], 0.5 + slack - j[1], 0.5 + slack - j[2], -j[3], -j[4], -j[5]];
    let second = [m[0], m[1], m[2], minors(&m)[0], minors(&m)[1], minors(&m)[2], determinant(&m)];
    is_positive && second.iter().all(|minor| *minor >= 0.0)
}

/// The principal minors of order two: of xy, xz and yz.
fn minors(&[xx, yy, zz, xy, xz, yz]: &[f64; 6]) -> [f64; 3] {
    [xx * yy - xy * xy, xx * zz - xz * xz, yy * zz - yz * yz]
}

fn determinant(&[xx, yy, zz, xy, xz, yz]: &[f64; 6]) -> f64 {
    xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
}

#[cfg(test)]
mod tests;
