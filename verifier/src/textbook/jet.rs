//! Second-order dual numbers: a value with its first two derivatives along a path.

use crate::field::Field;
use std::borrow::Borrow;
use std::ops::{Add, Mul, Neg, Sub};

/// `x(τ)` up to `τ²`: value, first and second derivative at τ = 0. A derivative that is zero by structure is absent.
#[derive(Clone, Debug, PartialEq)]
pub struct Jet<F> {
    /// `x(0)`.
    pub value: F,
    /// `x'(0)`.
    pub rate: Option<F>,
    /// `x''(0)`.
    pub second: Option<F>,
}

impl<F: Field> Jet<F> {
    /// What does not change along the path.
    pub fn constant(value: F) -> Self {
        Self { value, rate: None, second: None }
    }

    /// What changes along the path at a constant rate.
    pub fn moving(value: F, rate: F) -> Self {
        Self { value, rate: Some(rate), second: None }
    }

    /// The value alone.
    pub fn frozen(&self) -> Self {
        Self::constant(self.value.clone())
    }

    /// The derivative with its own first derivative. (Its second one, which is not known, is absent.)
    pub fn derivative(&self, zero: &F) -> Self {
        let value = self.rate.clone().unwrap_or_else(|| zero.clone());
        Self { value, rate: self.second.clone(), second: None }
    }

    /// `f(x)` by the chain rule from `f(x)`, `f'(x)` and `f''(x)` at the value.
    pub fn chain(&self, [value, first, second]: [F; 3]) -> Self {
        let rate = self.rate.as_ref();
        let bend = rate.map(|rate| second.mul(&rate.mul(rate)));
        Self {
            value,
            rate: rate.map(|rate| first.mul(rate)),
            second: sum(bend.as_ref(), self.second.as_ref().map(|second| first.mul(second)).as_ref()),
        }
    }

    /// The same linear function of the value and of the derivatives.
    pub fn each(&self, function: impl Fn(&F) -> F) -> Self {
        Self {
            value: function(&self.value),
            rate: self.rate.as_ref().map(&function),
            second: self.second.as_ref().map(&function),
        }
    }

    /// `1 / x`; `None` where x is zero.
    pub fn reciprocal(&self) -> Option<Self> {
        let inverse = self.value.inv()?;
        let square = inverse.mul(&inverse);
        let cube = square.mul(&inverse);
        Some(self.chain([inverse, square.neg(), cube.add(&cube)]))
    }
}

impl<F: Field, R: Borrow<Jet<F>>> Add<R> for &Jet<F> {
    type Output = Jet<F>;
    fn add(self, other: R) -> Jet<F> {
        let other = other.borrow();
        Jet {
            value: self.value.add(&other.value),
            rate: sum(self.rate.as_ref(), other.rate.as_ref()),
            second: sum(self.second.as_ref(), other.second.as_ref()),
        }
    }
}

impl<F: Field, R: Borrow<Jet<F>>> Sub<R> for &Jet<F> {
    type Output = Jet<F>;
    fn sub(self, other: R) -> Jet<F> {
        let other = other.borrow();
        Jet {
            value: self.value.sub(&other.value),
            rate: sum(self.rate.as_ref(), other.rate.as_ref().map(F::neg).as_ref()),
            second: sum(self.second.as_ref(), other.second.as_ref().map(F::neg).as_ref()),
        }
    }
}

/// Leibniz: `(x y)' = x' y + x y'` and `(x y)'' = x'' y + 2 x' y' + x y''`.
impl<F: Field, R: Borrow<Jet<F>>> Mul<R> for &Jet<F> {
    type Output = Jet<F>;
    fn mul(self, other: R) -> Jet<F> {
        let other = other.borrow();
        let cross = product(self.rate.as_ref(), &other.value);
        let across = product(other.rate.as_ref(), &self.value);
        let both = self.rate.as_ref().and_then(|rate| product(other.rate.as_ref(), rate));
        let both = both.map(|both| both.add(&both));
        let ends = sum(
            product(self.second.as_ref(), &other.value).as_ref(),
            product(other.second.as_ref(), &self.value).as_ref(),
        );
        Jet {
            value: self.value.mul(&other.value),
            rate: sum(cross.as_ref(), across.as_ref()),
            second: sum(ends.as_ref(), both.as_ref()),
        }
    }
}

impl<F: Field, R: Borrow<Jet<F>>> Add<R> for Jet<F> {
    type Output = Self;
    fn add(self, other: R) -> Self {
        &self + other
    }
}

impl<F: Field, R: Borrow<Jet<F>>> Sub<R> for Jet<F> {
    type Output = Self;
    fn sub(self, other: R) -> Self {
        &self - other
    }
}

impl<F: Field, R: Borrow<Jet<F>>> Mul<R> for Jet<F> {
    type Output = Self;
    fn mul(self, other: R) -> Self {
        &self * other
    }
}

impl<F: Field> Neg for Jet<F> {
    type Output = Self;
    fn neg(self) -> Self {
        let opposite = |x: Option<F>| x.map(|x| x.neg());
        Self { value: self.value.neg(), rate: opposite(self.rate), second: opposite(self.second) }
    }
}

fn sum<F: Field>(a: Option<&F>, b: Option<&F>) -> Option<F> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.add(b)),
        (a, b) => a.or(b).cloned(),
    }
}

fn product<F: Field>(a: Option<&F>, b: &F) -> Option<F> {
    a.map(|a| a.mul(b))
}
