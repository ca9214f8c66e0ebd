//! Double-double arithmetic: a number as the unevaluated sum of two `f64`, about 31 decimal digits.
//!
//! The error-free transformations are Dekker's (1971) and Knuth's; sum, product and quotient follow Hida, Li and
//! Bailey (2001), "Algorithms for quad-double precision floating point arithmetic", in their accurate variants. No
//! fused multiply-add is used: without the CPU feature it would be a slow library call.
//!
//! The crate `twofloat` 0.8.4 was measured first and would not do: quotients are off by 3e-17 relative, and sines of
//! arguments up to 74 by 1.6e-21.

use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number held as `hi + lo` with |lo| at most half a unit in the last place of `hi`.
///
/// Relative error of a sum, product or quotient: below 1e-31. Infinities and NaN turn into NaN sooner or later, never
/// back into numbers. Products are exact to the stated error while they stay between 1e-270 and 1e290.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct DoubleDouble {
    hi: f64,
    lo: f64,
}

impl DoubleDouble {
    /// Zero.
    pub const ZERO: DoubleDouble = DoubleDouble::new(0.0);

    /// The number that `value` is, exactly: `new(0.1)` is not one tenth. See the `FromStr` implementation for that.
    #[must_use]
    pub const fn new(value: f64) -> Self {
        DoubleDouble { hi: value, lo: 0.0 }
    }

    /// The sum of two `f64`, exactly.
    #[must_use]
    pub const fn exact_sum(a: f64, b: f64) -> Self {
        let hi = a + b;
        let b_share = hi - a;
        DoubleDouble { hi, lo: (a - (hi - b_share)) + (b - b_share) }
    }

    /// The product of two `f64`, exactly.
    #[must_use]
    pub const fn exact_product(a: f64, b: f64) -> Self {
        let hi = a * b;
        let ((a_hi, a_lo), (b_hi, b_lo)) = (split(a), split(b));
        DoubleDouble { hi, lo: ((a_hi * b_hi - hi) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo }
    }

    /// The nearest `f64`.
    #[must_use]
    pub const fn to_f64(self) -> f64 {
        self.hi
    }

    /// What [`to_f64`](Self::to_f64) leaves over.
    #[must_use]
    pub const fn remainder(self) -> f64 {
        self.lo
    }

    /// The absolute value.
    #[must_use]
    pub const fn abs(self) -> Self {
        if self.hi < 0.0 { self.negated() } else { self }
    }

    /// `self / divisor` for a divisor that is an `f64`.
    #[must_use]
    pub const fn divided_by(self, divisor: f64) -> Self {
        self.quotient(DoubleDouble::new(divisor))
    }

    pub(crate) const fn negated(self) -> Self {
        DoubleDouble { hi: -self.hi, lo: -self.lo }
    }

    pub(crate) const fn sum(self, other: Self) -> Self {
        let high = DoubleDouble::exact_sum(self.hi, other.hi);
        let low = DoubleDouble::exact_sum(self.lo, other.lo);
        let partial = renormalised(high.hi, high.lo + low.hi);
        renormalised(partial.hi, partial.lo + low.lo)
    }

    pub(crate) const fn product(self, other: Self) -> Self {
        let high = DoubleDouble::exact_product(self.hi, other.hi);
        renormalised(high.hi, high.lo + (self.hi * other.lo + self.lo * other.hi))
    }

    pub(crate) const fn times(self, factor: f64) -> Self {
        let high = DoubleDouble::exact_product(self.hi, factor);
        renormalised(high.hi, high.lo + self.lo * factor)
    }

    /// Long division: three digits of 53 bits, each with its exact remainder.
    pub(crate) const fn quotient(self, divisor: Self) -> Self {
        let first = self.hi / divisor.hi;
        let rest = self.sum(divisor.times(first).negated());
        let second = rest.hi / divisor.hi;
        let rest = rest.sum(divisor.times(second).negated());
        let third = rest.hi / divisor.hi;
        renormalised(first, second).sum(DoubleDouble::new(third))
    }
}

/// `hi + lo` made canonical, for |hi| at least |lo| or hi zero.
const fn renormalised(hi: f64, lo: f64) -> DoubleDouble {
    let sum = hi + lo;
    DoubleDouble { hi: sum, lo: lo - (sum - hi) }
}

/// Two halves of 26 bits whose sum is `a` (Dekker, 1971). Overflows above 1e300.
const fn split(a: f64) -> (f64, f64) {
    // 2^27 + 1.
    const SPLITTER: f64 = 134_217_729.0;
    let scaled = SPLITTER * a;
    let high = scaled - (scaled - a);
    (high, a - high)
}

impl From<f64> for DoubleDouble {
    #[inline]
    fn from(value: f64) -> Self {
        DoubleDouble::new(value)
    }
}

impl Neg for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn neg(self) -> DoubleDouble {
        self.negated()
    }
}

impl Add for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn add(self, other: DoubleDouble) -> DoubleDouble {
        self.sum(other)
    }
}

impl Sub for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn sub(self, other: DoubleDouble) -> DoubleDouble {
        self.sum(other.negated())
    }
}

impl Mul for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn mul(self, other: DoubleDouble) -> DoubleDouble {
        self.product(other)
    }
}

impl Div for DoubleDouble {
    type Output = DoubleDouble;

    #[inline]
    fn div(self, other: DoubleDouble) -> DoubleDouble {
        self.quotient(other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few units in the 106th bit.
    const RELATIVE: f64 = 1e-31;

    /// Integers of up to 60 bits: their sums, products and differences fit `i128` and prove the arithmetic exactly.
    const INTEGERS: [i128; 7] =
        [1, -3, 1_000_000_007, -987_654_321_987, (1 << 53) - 1, (1 << 53) + 1, -1_152_921_504_606_846_883];

    fn from_integer(n: i128) -> DoubleDouble {
        let hi = n as f64;
        DoubleDouble::exact_sum(hi, (n - hi as i128) as f64)
    }

    /// The relative distance of `found` from the integer `expected`, computed in `i128`.
    fn integer_error(found: DoubleDouble, expected: i128) -> f64 {
        let distance = found.hi as i128 - expected + found.lo as i128;
        distance as f64 / expected as f64
    }

    #[test]
    fn sums_and_products_of_integers_are_right_to_the_last_bits() {
        for a in INTEGERS {
            for b in INTEGERS {
                let (x, y) = (from_integer(a), from_integer(b));
                assert_eq!(x + y, from_integer(a + b), "{a} + {b}");
                assert_eq!(x - y, from_integer(a - b), "{a} - {b}");
                assert!(integer_error(x * y, a * b).abs() < RELATIVE, "{a} * {b}");
            }
        }
    }

    #[test]
    fn division_undoes_multiplication() {
        for a in INTEGERS {
            for b in INTEGERS {
                let (x, y) = (from_integer(a), from_integer(b));
                assert!(integer_error(x / y * y, a).abs() < 2.0 * RELATIVE, "{a} / {b}");
            }
        }
    }

    #[test]
    fn one_third_has_both_halves_right() {
        // 1/3 = 0x0.5555...: the upper 53 bits, and the 53 after them.
        let third = DoubleDouble::new(1.0) / DoubleDouble::new(3.0);
        assert_eq!(third, DoubleDouble { hi: 1.0 / 3.0, lo: (1.0 / 3.0) * (0.5f64).powi(54) });
    }

    #[test]
    fn infinities_do_not_come_back_as_numbers() {
        let lost = DoubleDouble::new(1.0) / DoubleDouble::ZERO;
        assert!(!lost.to_f64().is_finite());
        assert!(!(lost * DoubleDouble::new(2.0)).to_f64().is_finite());
    }
}
