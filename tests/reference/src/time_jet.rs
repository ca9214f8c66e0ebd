//! A number that moves: its value with the first two derivatives in time.
//!
//! What is written in these numbers is differentiated twice by the rules of calculus, exactly: positions written once
//! give velocities and accelerations.

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::vector::{Vector, dot, scale};
use crate::{DoubleDouble, Real};

/// Value, first and second derivative in time.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(crate) struct Jet {
    pub(crate) value: DoubleDouble,
    pub(crate) rate: DoubleDouble,
    pub(crate) second: DoubleDouble,
}

impl Jet {
    pub(crate) const fn new(value: DoubleDouble, rate: DoubleDouble, second: DoubleDouble) -> Self {
        Jet { value, rate, second }
    }

    pub(crate) const fn constant(value: DoubleDouble) -> Self {
        Jet::new(value, DoubleDouble::ZERO, DoubleDouble::ZERO)
    }

    /// A function of the number, by its value and two derivatives there.
    fn mapped(self, [f, slope, curvature]: [DoubleDouble; 3]) -> Self {
        Jet::new(f, slope * self.rate, slope * self.second + curvature * self.rate * self.rate)
    }

    fn reciprocal(self) -> Self {
        let f = DoubleDouble::new(1.0) / self.value;
        self.mapped([f, -(f * f), (f * f * f).times(2.0)])
    }

    pub(crate) fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        let slope = DoubleDouble::new(0.5) / root;
        self.mapped([root, slope, -(slope.times(0.5) / self.value)])
    }

    /// The angle of the point (`x`, `self`), and how it changes.
    pub(crate) fn atan2(self, x: Jet) -> Self {
        // The angle's rate is (x ẏ − y ẋ) / (x² + y²).
        let (square, y) = (x.value * x.value + self.value * self.value, self);
        let rate = (x.value * y.rate - y.value * x.rate) / square;
        let turning = x.value * y.second - y.value * x.second;
        let growing = (x.value * x.rate + y.value * y.rate).times(2.0);
        Jet::new(self.value.atan2(x.value), rate, (turning - growing * rate) / square)
    }
}

impl From<f64> for Jet {
    fn from(value: f64) -> Self {
        Jet::constant(DoubleDouble::new(value))
    }
}

impl Neg for Jet {
    type Output = Jet;

    fn neg(self) -> Jet {
        Jet::new(-self.value, -self.rate, -self.second)
    }
}

impl Add for Jet {
    type Output = Jet;

    fn add(self, other: Jet) -> Jet {
        Jet::new(self.value + other.value, self.rate + other.rate, self.second + other.second)
    }
}

impl Sub for Jet {
    type Output = Jet;

    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Jet;

    fn mul(self, other: Jet) -> Jet {
        Jet::new(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            self.second * other.value + (self.rate * other.rate).times(2.0) + self.value * other.second,
        )
    }
}

impl Div for Jet {
    type Output = Jet;

    #[expect(clippy::suspicious_arithmetic_impl, reason = "a quotient is a product with the reciprocal")]
    fn div(self, other: Jet) -> Jet {
        self * other.reciprocal()
    }
}

impl Real for Jet {
    fn sin_cos(self) -> (Jet, Jet) {
        let (sin, cos) = self.value.sin_cos();
        (self.mapped([sin, cos, -sin]), self.mapped([cos, -sin, -cos]))
    }
}

/// A vector that stays.
pub(crate) fn constant(v: Vector<DoubleDouble>) -> Vector<Jet> {
    v.map(Jet::constant)
}

/// The vector at length one.
pub(crate) fn unit(v: Vector<Jet>) -> Vector<Jet> {
    scale(dot(v, v).sqrt().reciprocal(), v)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Central differences of this step err by its square; second ones are rounded by 1e-31 over it.
    const STEP: f64 = 1e-7;
    const DIFFERENCE: f64 = 1e-12;

    fn check(name: &str, f: impl Fn(Jet) -> Jet) {
        // A number that moves by 0.7 + 0.3 t − 0.2 t², at t = 0.
        let number = |x: f64| DoubleDouble::new(x);
        let at = |t: f64| {
            f(Jet::constant(number(0.7) + number(0.3).times(t) - number(0.2).times(t).times(t))).value
        };
        let found = f(Jet::new(number(0.7), number(0.3), number(-0.4)));
        let (before, here, after) = (at(-STEP), at(0.0), at(STEP));
        let rate = (after - before).divided_by(2.0 * STEP);
        let second = (after - here - here + before).divided_by(STEP).divided_by(STEP);
        for (found, expected) in [(found.value, here), (found.rate, rate), (found.second, second)] {
            assert!((found - expected).to_f64().abs() < DIFFERENCE, "{name}: {found:?} {expected:?}");
        }
    }

    #[test]
    fn derivatives_are_those_of_the_functions() {
        let two = || Jet::from(2.0);
        check("sum and product", |x| (x + two()) * x - x * x * x);
        check("quotient", |x| two() / (x + x * x));
        check("root", |x| (x * x + two()).sqrt());
        check("sine", |x| (x * x).sin_cos().0);
        check("cosine", |x| (x * two()).sin_cos().1);
        check("angle", |x| (x * x).atan2(x - two()));
        check("unit vector", |x| unit([x, two(), x * x])[2]);
    }
}
