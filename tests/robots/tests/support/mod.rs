//! Double-double as a number type of generated mechanisms.

use gyro_reference::DoubleDouble;
use gyro_sim::{Elementary, Scalar, spline};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A number of 106 bits.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Fine(DoubleDouble);

impl Fine {
    pub fn to_f64(self) -> f64 {
        self.0.to_f64()
    }

    /// One Newton step from a value that is right to half of the digits.
    fn refined(near: f64, correction: impl FnOnce(DoubleDouble) -> DoubleDouble) -> Self {
        let near = DoubleDouble::new(near);
        Self(near + correction(near))
    }

    fn root(self) -> Self {
        let near = self.to_f64().sqrt();
        if near == 0.0 {
            return Self::constant(0.0);
        }
        Self::refined(near, |root| (self.0 - root * root) / DoubleDouble::new(2.0 * near))
    }

    /// By the series of the exponential function at 1/64 of the argument, up to 1.
    fn hyperbolic_tangent(self) -> Self {
        let one = DoubleDouble::new(1.0);
        let size = self.to_f64().abs();
        if size > 40.0 {
            return Self::constant(self.to_f64().signum());
        }
        let part = self.0 * DoubleDouble::new(2.0 / 1024.0);
        let mut power = (1..25).rev().fold(one, |sum, n| one + sum * part / DoubleDouble::new(f64::from(n)));
        for _ in 0..10 {
            power = power * power;
        }
        Self((power - one) / (power + one))
    }
}

impl Add for Fine {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Fine {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Fine {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Div for Fine {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl Neg for Fine {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Scalar for Fine {
    fn constant(value: f64) -> Self {
        Self(DoubleDouble::new(value))
    }

    fn call(function: Elementary, [x, y]: [Self; 2]) -> Self {
        match function {
            Elementary::Sqrt => x.root(),
            Elementary::Sin => Self(x.0.sin_cos().0),
            Elementary::Cos => Self(x.0.sin_cos().1),
            Elementary::Tanh => x.hyperbolic_tangent(),
            Elementary::Atan2 => Self::refined(x.to_f64().atan2(y.to_f64()), |angle| {
                let (sine, cosine) = angle.sin_cos();
                (x.0 * cosine - y.0 * sine) / (y.0 * cosine + x.0 * sine)
            }),
            other => unreachable!("{other:?} is in no robot"),
        }
    }

    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        let (start, piece) = spline::piece(knots, pieces, self.to_f64());
        let (h, [a, b, c, d]) = (self - Self::constant(start), piece.map(Self::constant));
        let [two, three, six] = [2.0, 3.0, 6.0].map(Self::constant);
        [a + h * (b + h * (c + h * d)), b + h * (two * c + h * three * d), two * c + six * h * d]
    }

    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
        Self::constant(spline::third(knots, pieces, self.to_f64()))
    }
}
