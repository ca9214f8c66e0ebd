//! Numbers over which both sides of an identity are evaluated.
//!
//! One interpreter and one textbook run over all of them: [`Modular`] integers decide identities, [`Degree`] bounds how
//! often they could be wrong, [`Exact`] rationals and [`Real`] floats are for measuring and for looking closely, `f64`
//! and `f32` compute what the emitted code computes, bit by bit.

mod degree;
mod exact;
mod float;
mod modular;
mod real;

pub use degree::{Degree, sum_log2};
pub use exact::Exact;
pub use modular::{Modular, Prime};
pub use real::{Precision, Real};

use gyro_model::Rational;
use std::fmt::Debug;

/// A number. Operations never panic; where a result does not exist it is *undefined* and equals nothing, itself
/// included, as a NaN does.
pub trait Field: Clone + PartialEq + Debug {
    /// What is needed to make a number: the prime, the precision.
    type Context: Copy + Debug;

    /// The number that a rational is.
    fn from_rational(context: Self::Context, value: &Rational) -> Self;
    /// The positive square root of a rational that is not negative. Of two rationals `√a √b = √(a b)` in every field.
    fn sqrt_rational(context: Self::Context, value: &Rational) -> Self;
    /// Sum.
    #[must_use]
    fn add(&self, other: &Self) -> Self;
    /// Difference.
    #[must_use]
    fn sub(&self, other: &Self) -> Self;
    /// Product.
    #[must_use]
    fn mul(&self, other: &Self) -> Self;
    /// The number with its sign turned.
    #[must_use]
    fn neg(&self) -> Self;
    /// Reciprocal; `None` of zero.
    #[must_use]
    fn inv(&self) -> Option<Self>;
    /// Quotient; `None` by zero. Floating-point numbers round it once.
    #[must_use]
    fn div(&self, other: &Self) -> Option<Self> {
        other.inv().map(|inverse| self.mul(&inverse))
    }
    /// Whether the number is zero.
    fn is_zero(&self) -> bool;

    /// The number behind a literal. Floating-point numbers that emitted code runs on take the literal itself.
    fn constant(context: Self::Context, constant: &Constant) -> Self {
        let factor = Self::from_rational(context, &constant.factor);
        match &constant.radicand {
            Some(radicand) => factor.mul(&Self::sqrt_rational(context, radicand)),
            None => factor,
        }
    }
    /// An integer.
    fn integer(context: Self::Context, value: i64) -> Self {
        Self::from_rational(context, &Rational::from_integer(value.into()))
    }
    /// Zero.
    fn zero(context: Self::Context) -> Self {
        Self::integer(context, 0)
    }
    /// One.
    fn one(context: Self::Context) -> Self {
        Self::integer(context, 1)
    }
}

/// A literal of emitted code and the exact number that it stands for, `factor · √radicand`.
#[derive(Clone, Debug, PartialEq)]
pub struct Constant {
    /// The number in the emitted text.
    pub literal: f64,
    /// Rational factor.
    pub factor: Rational,
    /// What the root is taken of, if any: greater than zero.
    pub radicand: Option<Rational>,
}
