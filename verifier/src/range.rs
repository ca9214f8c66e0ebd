//! What values may be: bounds, and whether they keep from zero.

/// More than the roundings of a bound.
const MARGIN: f64 = 1e-12;

/// What a value may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Range {
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) is_nonzero: bool,
}

impl Range {
    pub(crate) const ANY: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, is_nonzero: false };
    pub(crate) const UNIT: Self = Self { low: -1.0, high: 1.0, is_nonzero: false };
    pub(crate) const POSITIVE: Self = Self { low: 0.0, high: f64::INFINITY, is_nonzero: true };

    /// Bounds that arithmetic gave; infinity less infinity may be anything.
    fn new(low: f64, high: f64, is_nonzero: bool) -> Self {
        let low = if low.is_nan() { f64::NEG_INFINITY } else { low };
        let high = if high.is_nan() { f64::INFINITY } else { high };
        // Bounds were rounded: what they keep from zero by less is not kept from it.
        let is_away = |bound: f64| bound > MARGIN;
        Self { low, high, is_nonzero: is_nonzero || is_away(low) || is_away(-high) }
    }

    pub(crate) fn add(self, other: Self) -> Self {
        let one_sided = |a: Self, b: Self| (a.low >= 0.0 && b.low >= 0.0) || (a.high <= 0.0 && b.high <= 0.0);
        let is_nonzero = one_sided(self, other) && (self.is_nonzero || other.is_nonzero);
        Self::new(self.low + other.low, self.high + other.high, is_nonzero)
    }

    pub(crate) fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low, ..self }
    }

    pub(crate) fn mul(self, other: Self) -> Self {
        // Zero times infinity is zero here: bounds are not reached.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let products = [self.low, self.high].map(|a| [other.low, other.high].map(|b| product(a, b)));
        let all = products.into_iter().flatten();
        let (low, high) = (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max));
        Self { low, high, is_nonzero: self.is_nonzero && other.is_nonzero }
    }

    pub(crate) fn square(self) -> Self {
        let square = self.mul(self);
        let low = if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { square.low.max(0.0) };
        Self { low, ..square }
    }

    pub(crate) fn recip(self) -> Self {
        match self.is_nonzero {
            true if self.low >= 0.0 => Self { low: 1.0 / self.high, high: 1.0 / self.low, is_nonzero: true },
            true if self.high <= 0.0 => self.neg().recip().neg(),
            is_nonzero => Self { is_nonzero, ..Self::ANY },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_keep_from_zero_what_cannot_be_zero() {
        let two = Range { low: 2.0, high: 2.0, is_nonzero: true };
        assert!(Range::UNIT.square().add(two).is_nonzero);
        assert!(!Range::UNIT.add(two.neg()).add(Range::UNIT).is_nonzero, "from −4 to 0");
        assert!(Range::UNIT.add(two).is_nonzero, "from 1 to 3");
        assert!(!Range::ANY.square().is_nonzero && Range::ANY.square().low == 0.0);
        assert!(Range::POSITIVE.add(Range::ANY.square()).is_nonzero);
        assert!(!Range::POSITIVE.add(Range::ANY.square().neg()).is_nonzero);
        assert!(Range::POSITIVE.mul(two.neg()).is_nonzero && Range::POSITIVE.mul(two.neg()).high <= 0.0);
        assert_eq!(two.recip(), Range { low: 0.5, high: 0.5, is_nonzero: true });
        assert!(Range::POSITIVE.recip().low >= 0.0 && !Range::ANY.recip().is_nonzero);
    }
}
