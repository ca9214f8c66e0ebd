//! Dual numbers: derivatives without a symbol, to the last bits.

use crate::{Differentiable, Ode, Scalar, Storage};
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number with its derivatives in `N` directions. Any kernel that is generic over its scalar can be evaluated with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, const N: usize> {
    /// The value.
    pub value: T,
    /// Its derivatives.
    pub slopes: [T; N],
}

impl<T: Scalar, const N: usize> Dual<T, N> {
    /// A number that does not depend on anything.
    pub fn new(value: T) -> Self {
        Self { value, slopes: [T::constant(0.0); N] }
    }

    /// Chain rule: a function's value, and its derivative at this number's value.
    #[inline(always)]
    fn chain(self, value: T, derivative: T) -> Self {
        self.with(self, value, |slope, _| derivative * slope)
    }

    /// An indexed loop: builds for tests make a dozen calls of `array::map` or of `zip`.
    #[inline(always)]
    fn with(mut self, other: Self, value: T, slope: impl Fn(T, T) -> T) -> Self {
        for k in 0..N {
            self.slopes[k] = slope(self.slopes[k], other.slopes[k]);
        }
        Self { value, ..self }
    }
}

impl<T: Scalar, const N: usize> Add for Dual<T, N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other, self.value + other.value, |a, b| a + b)
    }
}

impl<T: Scalar, const N: usize> Sub for Dual<T, N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self.with(other, self.value - other.value, |a, b| a - b)
    }
}

impl<T: Scalar, const N: usize> Mul for Dual<T, N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other, self.value * other.value, |a, b| T::fused(a, other.value, self.value * b))
    }
}

impl<T: Scalar, const N: usize> Div for Dual<T, N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let (inverse, value) = (T::constant(1.0) / other.value, self.value / other.value);
        self.with(other, value, |a, b| (a - value * b) * inverse)
    }
}

impl<T: Scalar, const N: usize> Neg for Dual<T, N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.with(self, -self.value, |slope, _| -slope)
    }
}

impl<T: Scalar, const N: usize> Scalar for Dual<T, N> {
    fn constant(value: f64) -> Self {
        Self::new(T::constant(value))
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, T::constant(0.5) / root)
    }
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.chain(self.value.cos(), -self.value.sin())
    }
    fn tanh(self) -> Self {
        let value = self.value.tanh();
        self.chain(value, T::constant(1.0) - value * value)
    }
    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        let (dy, dx) = (x.value / square, -self.value / square);
        self.with(x, self.value.atan2(x.value), |a, b| dy * a + dx * b)
    }
    /// The third derivative of a table's curve, a step function, counts as zero: tables are functions of time, and so the second
    /// derivative's own slope is asked for only by methods that differentiate with respect to time.
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        let [value, first, second] = self.value.spline(knots, pieces);
        [self.chain(value, first), self.chain(first, second), self.chain(second, T::constant(0.0))]
    }
}

/// A system with its Jacobian by [`Dual`] numbers, `N` columns at a time: for systems that come without one.
#[derive(Clone, Copy, Debug)]
pub struct ByDuals<'a, O, D, J, const N: usize> {
    system: O,
    in_duals: D,
    zeros: &'a J,
}

impl<'a, O, D, J, const N: usize> ByDuals<'a, O, D, J, N> {
    /// The same system twice, in plain and in dual numbers, and a zeroed buffer for the Jacobian, n × n numbers for a state of n.
    pub fn new(system: O, in_duals: D, zeros: &'a J) -> Self {
        Self { system, in_duals, zeros }
    }
}

impl<O: Ode, D, J, const N: usize> Ode for ByDuals<'_, O, D, J, N> {
    type Scalar = O::Scalar;
    type State = O::State;

    fn start(&self) -> Self::State {
        self.system.start()
    }
    fn derivative(&self, t: Self::Scalar, y: &Self::State, dy: &mut Self::State) {
        self.system.derivative(t, y, dy);
    }
}

impl<O, D, J, const N: usize> Differentiable for ByDuals<'_, O, D, J, N>
where
    O: Ode,
    D: Ode<Scalar = Dual<O::Scalar, N>>,
    J: Storage<O::Scalar>,
{
    type Jacobian = J;

    fn jacobian_buffer(&self) -> J {
        self.zeros.clone()
    }

    fn jacobian(&self, t: O::Scalar, y: &O::State, dfdy: &mut J, dfdt: &mut O::State) {
        let (mut arguments, n) = (self.in_duals.start(), y.as_ref().len());
        let mut slopes = arguments.clone();
        // The columns, and after them time.
        for from in (0..=n).step_by(N) {
            let unit = |index: usize| {
                core::array::from_fn(|k| O::Scalar::constant(if from + k == index { 1.0 } else { 0.0 }))
            };
            for (index, (argument, value)) in arguments.as_mut().iter_mut().zip(y.as_ref()).enumerate() {
                *argument = Dual { value: *value, slopes: unit(index) };
            }
            self.in_duals.derivative(Dual { value: t, slopes: unit(n) }, &arguments, &mut slopes);
            for (row, (slopes, dfdt)) in
                dfdy.as_mut().chunks_exact_mut(n).zip(slopes.as_ref().iter().zip(dfdt.as_mut()))
            {
                for (column, slope) in (from..).zip(slopes.slopes) {
                    match row.get_mut(column) {
                        Some(element) => *element = slope,
                        None if column == n => *dfdt = slope,
                        None => {}
                    }
                }
            }
        }
    }
}

impl<O: crate::Maximal, D, J, const N: usize> crate::Maximal for ByDuals<'_, O, D, J, N> {
    type Mechanism = O::Mechanism;

    fn mechanism(&self) -> &O::Mechanism {
        self.system.mechanism()
    }
}
