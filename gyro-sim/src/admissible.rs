//! Which numbers parameters may have: the rules of a model file that parameters can break, looked at again when they
//! are set.
//!
//! `cargo xtask simulate --set` decides them exactly, in rationals; here they are decided in floating point, and what
//! is on the boundary by no more than rounding is allowed. A generated module lists its rules in `Parameters::check`:
//! ```
//! # #[cfg(feature = "generated")]
//! # {
//! use gyro_sim::admissible::{Number, Rule, check};
//! let rules = [Rule::Positive(Number::Given(0))];
//! assert!(check(&[0.085], &rules).is_ok());
//! assert_eq!(check(&[-0.085], &rules).unwrap_err().parameter, 0);
//! assert!(check(&[f64::NAN], &rules).is_err());
//! # }
//! ```

use crate::Real;
use core::fmt;

/// A number of a model file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Number {
    /// Written out.
    Fixed(f64),
    /// The parameter of this place.
    Given(u16),
    /// The negative of the parameter of this place.
    Negated(u16),
    /// The sum of both.
    Sum(&'static [Self; 2]),
    /// The product of both.
    Product(&'static [Self; 2]),
    /// The first divided by the second.
    Quotient(&'static [Self; 2]),
    /// A power.
    Power(&'static Self, u32),
}

/// What must hold of numbers of which at least one is a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Rule {
    /// Masses, lengths, coefficients that hold something.
    Positive(Number),
    /// Coefficients that would drive the motion.
    NotNegative(Number),
    /// Ratios, leads, directions, Euler parameters: not all are zero.
    NotZero(&'static [Number]),
    /// An axis and a zero direction: they span a plane.
    NotParallel([Number; 3], [Number; 3]),
    /// `[xx, yy, zz, xy, xz, yz]`: positive definite, and no principal moment exceeds the sum of the other two.
    Inertia([Number; 6]),
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

/// What rounding may take from an inequality that is allowed to be an equality.
const ROUNDING: f64 = 8.0;

/// Whether parameters satisfy all rules, and are numbers that a model file may have: 0, or of a size from 1e-100 to
/// 1e100.
///
/// # Errors
/// [`Inadmissible`] names the first parameter that is not such a number, or that occurs in a rule which is broken.
pub fn check<T: Real>(values: &[T], rules: &[Rule]) -> Result<(), Inadmissible> {
    let is_number = |value: &T| {
        let size = value.to_f64().abs();
        size == 0.0 || (SIZES[0]..=SIZES[1]).contains(&size)
    };
    if let Some((parameter, _)) = (0u16..).zip(values).find(|(_, value)| !is_number(value)) {
        return Err(Inadmissible { parameter });
    }
    match rules.iter().find(|rule| !rule.holds(values)) {
        Some(rule) => Err(Inadmissible { parameter: rule.parameter() }),
        None => Ok(()),
    }
}

impl Number {
    fn value<T: Real>(self, values: &[T]) -> f64 {
        // A place that does not exist breaks any rule.
        let of = |place: u16| values.get(usize::from(place)).map_or(f64::NAN, |value| value.to_f64());
        match self {
            Self::Fixed(value) => value,
            Self::Given(place) => of(place),
            Self::Negated(place) => -of(place),
            Self::Sum([a, b]) => a.value(values) + b.value(values),
            Self::Product([a, b]) => a.value(values) * b.value(values),
            Self::Quotient([a, b]) => a.value(values) / b.value(values),
            Self::Power(base, exponent) => {
                let base = base.value(values);
                (0..exponent).fold(1.0, |power, _| power * base)
            }
        }
    }

    fn parameter(self) -> Option<u16> {
        match self {
            Self::Fixed(_) => None,
            Self::Given(place) | Self::Negated(place) => Some(place),
            Self::Sum([a, b]) | Self::Product([a, b]) | Self::Quotient([a, b]) => {
                a.parameter().or_else(|| b.parameter())
            }
            Self::Power(base, _) => base.parameter(),
        }
    }
}

impl Rule {
    fn holds<T: Real>(&self, values: &[T]) -> bool {
        match self {
            Self::Positive(number) => number.value(values) > 0.0,
            Self::NotNegative(number) => number.value(values) >= 0.0,
            Self::NotZero(numbers) => numbers.iter().any(|number| number.value(values) != 0.0),
            Self::NotParallel(a, b) => {
                let [a, b] = [a, b].map(|vector| vector.map(|number| number.value(values)));
                let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                let size = |v: [f64; 3]| libm::sqrt(v.iter().fold(0.0, |sum, x| sum + x * x));
                size(cross) > ROUNDING * f64::EPSILON * size(a) * size(b)
            }
            Self::Inertia(elements) => {
                // In the precision in which they are set equality is known to so much.
                let slack = ROUNDING * T::EPSILON.to_f64().max(f64::EPSILON);
                is_inertia(elements.map(|number| number.value(values)), slack)
            }
        }
    }

    /// The first parameter in it.
    fn parameter(&self) -> u16 {
        let of = |numbers: &[Number]| numbers.iter().find_map(|number| number.parameter());
        let parameter = match self {
            Self::Positive(number) | Self::NotNegative(number) => number.parameter(),
            Self::NotZero(numbers) => of(numbers),
            Self::NotParallel(a, b) => of(a).or_else(|| of(b)),
            Self::Inertia(elements) => of(elements),
        };
        parameter.unwrap_or_default()
    }
}

/// Positive definite by its leading principal minors (Sylvester); the tensor of second moments of mass, ½ tr(J) I − J,
/// positive semidefinite by all its principal minors, each but for rounding. Scaled by the trace, so that no product
/// leaves the numbers.
fn is_inertia(elements: [f64; 6], slack: f64) -> bool {
    let trace = elements[0] + elements[1] + elements[2];
    if trace.is_nan() || trace <= 0.0 {
        return false;
    }
    let j = elements.map(|x| x / trace);
    let [m2, m3] = [minors(&j), [determinant(&j); 3]];
    let is_positive = j[0] > 0.0 && m2[0] > 0.0 && m3[0] > 0.0;
    let m = [0.5 - j[0], 0.5 - j[1], 0.5 - j[2], -j[3], -j[4], -j[5]];
    let second = [m[0], m[1], m[2], minors(&m)[0], minors(&m)[1], minors(&m)[2], determinant(&m)];
    is_positive && second.iter().all(|minor| *minor >= -slack)
}

/// The principal minors of order two: of xy, xz and yz.
fn minors(&[xx, yy, zz, xy, xz, yz]: &[f64; 6]) -> [f64; 3] {
    [xx * yy - xy * xy, xx * zz - xz * xz, yy * zz - yz * yz]
}

fn determinant(&[xx, yy, zz, xy, xz, yz]: &[f64; 6]) -> f64 {
    xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Number; 6] = [
        Number::Given(0),
        Number::Given(1),
        Number::Given(2),
        Number::Given(3),
        Number::Given(4),
        Number::Given(5),
    ];

    #[test]
    fn inertias_are_decided_on_the_boundary() {
        let cases: [([f64; 6], bool); 9] = [
            ([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], true),
            ([1.0, 1.0, 2.0, 0.0, 0.0, 0.0], true),
            ([0.1, 0.2, 0.3, 0.0, 0.0, 0.0], true),
            ([1e6, 1e6, 2_000_001.0, 0.0, 0.0, 0.0], false),
            ([0.0, 1.0, 1.0, 0.0, 0.0, 0.0], false),
            ([2.0, 2.0, 2.0, 2.0, 0.0, 0.0], false),
            ([2.0, 2.0, 4.0, 1.0, 0.0, 0.0], true),
            ([2.0, 2.0, 4.1, 1.0, 0.0, 0.0], false),
            ([1e-90, 1e-90, 1e-90, 0.0, 0.0, 0.0], true),
        ];
        for (elements, is_allowed) in cases {
            assert_eq!(check(&elements, &[Rule::Inertia(ALL)]).is_ok(), is_allowed, "{elements:?}");
        }
    }

    /// `m L² / 12 − 1` of m = 3 and L = 2 is zero.
    #[test]
    fn computed_numbers_are_judged_by_their_values() {
        use Number::{Fixed, Given, Power, Product, Quotient, Sum};
        const SQUARE: Number = Power(&Given(1), 2);
        const INERTIA: Number = Quotient(&[Product(&[Given(0), SQUARE]), Fixed(12.0)]);
        let number = Sum(&[INERTIA, Fixed(-1.0)]);
        assert!(check(&[3.0, 2.0], &[Rule::NotNegative(number)]).is_ok());
        assert_eq!(check(&[2.9, 2.0], &[Rule::NotNegative(number)]), Err(Inadmissible { parameter: 0 }));
        assert!(check(&[3.0, 2.0], &[Rule::Positive(number)]).is_err());
        assert!(check(&[3.0, -2.1], &[Rule::Positive(number)]).is_ok());
    }

    #[test]
    fn what_is_no_number_of_a_page_breaks_any_rule() {
        for value in [f64::NAN, f64::INFINITY, 1e-101, -1e101] {
            assert_eq!(check(&[1.0, value], &[]), Err(Inadmissible { parameter: 1 }), "{value}");
        }
        assert!(check(&[1.0, 0.0, -5.0], &[]).is_ok());
        let one = [Number::Negated(0)];
        for (rule, good, bad) in [
            (Rule::Positive(one[0]), -1.0, 0.0),
            (Rule::NotNegative(one[0]), 0.0, 1.0),
            (Rule::NotZero(&[Number::Given(0)]), -1.0, 0.0),
        ] {
            assert!(check(&[good], &[rule]).is_ok() && check(&[bad], &[rule]).is_err(), "{rule:?}");
        }
        let fixed = [1.0, 2.0, 0.0].map(Number::Fixed);
        let rule = Rule::NotParallel(fixed, [Number::Given(0), Number::Given(1), Number::Fixed(0.0)]);
        assert!(check(&[2.0, 1.0], &[rule]).is_ok() && check(&[-3.0, -6.0], &[rule]).is_err());
    }
}
