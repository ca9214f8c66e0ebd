//! How many operations a derivation takes, counted while it is evaluated.

use gyro_sim::{Elementary, Scalar};
use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub};

/// A number with the sine and cosine of an angle at once, as whoever derives by hand would have them.
pub trait Number: Scalar {
    /// Sine and cosine.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);
}

impl Number for f64 {
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincos(self)
    }
}

impl Number for f32 {
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        libm::sincosf(self)
    }
}

/// The operations of an evaluation, as data sheets count them: negations cost nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Additions, subtractions, multiplications and divisions.
    pub flops: u64,
    /// Square roots.
    pub roots: u64,
    /// Angles of which sine and cosine are taken.
    pub angles: u64,
}

impl AddAssign for Operations {
    fn add_assign(&mut self, other: Self) {
        self.flops += other.flops;
        self.roots += other.roots;
        self.angles += other.angles;
    }
}

thread_local! {
    static COUNT: Cell<Operations> = const { Cell::new(Operations { flops: 0, roots: 0, angles: 0 }) };
}

/// What `evaluation` takes in [`Counted`] numbers on this thread.
pub fn operations(evaluation: impl FnOnce()) -> Operations {
    COUNT.set(Operations::default());
    evaluation();
    COUNT.get()
}

fn count(operation: Operations) {
    let mut all = COUNT.get();
    all += operation;
    COUNT.set(all);
}

/// An `f64` whose operations are counted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Counted(pub f64);

impl Counted {
    fn flop(value: f64) -> Self {
        count(Operations { flops: 1, ..Operations::default() });
        Self(value)
    }
}

impl Add for Counted {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::flop(self.0 + other.0)
    }
}

impl Sub for Counted {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::flop(self.0 - other.0)
    }
}

impl Mul for Counted {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::flop(self.0 * other.0)
    }
}

impl Div for Counted {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self::flop(self.0 / other.0)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Scalar for Counted {
    fn constant(value: f64) -> Self {
        Self(value)
    }
    fn call(function: Elementary, [x, y]: [Self; 2]) -> Self {
        match function {
            Elementary::Sqrt => {
                count(Operations { roots: 1, ..Operations::default() });
                Self(x.0.sqrt())
            }
            Elementary::Sin => x.sin_cos().0,
            Elementary::Cos => x.sin_cos().1,
            _ => Self::flop(f64::call(function, [x.0, y.0])),
        }
    }
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        self.0.spline(knots, pieces).map(Self)
    }
    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
        Self(self.0.spline_third(knots, pieces))
    }
}

impl Number for Counted {
    fn sin_cos(self) -> (Self, Self) {
        count(Operations { angles: 1, ..Operations::default() });
        let (sin, cos) = libm::sincos(self.0);
        (Self(sin), Self(cos))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_operation_counts_once_and_negations_do_not() {
        let x = Counted(2.0);
        let found = operations(|| {
            let (sin, cos) = x.sin_cos();
            let _ = Scalar::fused(-x, sin, cos) / (x - sin).sqrt();
        });
        assert_eq!(found, Operations { flops: 4, roots: 1, angles: 1 });
    }
}
