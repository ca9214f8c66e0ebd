//! Dual numbers: automatic differentiation, accurate to rounding.

use crate::contract::Storage;
use crate::{Elementary, Jacobian, Ode, Scalar};
use core::marker::PhantomData;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number with its derivatives in `N` directions. Any kernel that is generic over its scalar can be evaluated with
/// it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, const N: usize> {
    /// The value.
    pub value: T,
    /// Its derivatives.
    pub slopes: [T; N],
}

impl<T: Scalar, const N: usize> Dual<T, N> {
    /// A constant: all derivatives are zero.
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
    fn call(function: Elementary, operands: [Self; 2]) -> Self {
        let ([x, y], given) = (operands, operands.map(|operand| operand.value));
        let value = T::call(function, given);
        if matches!(function, Elementary::When | Elementary::Unless) {
            // What is not chosen may change infinitely fast.
            return y.with(y, value, |slope, _| T::call(function, [x.value, slope]));
        }
        match function.slopes(given, value) {
            (by_x, None) => x.chain(value, by_x),
            (by_x, Some(by_y)) => x.with(y, value, |dx, dy| by_x * dx + by_y * dy),
        }
    }
    /// The third derivative of a table's curve is a step function; at a knot it is that of the piece that begins there,
    /// as a step that begins there needs it.
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        let [value, first, second] = self.value.spline(knots, pieces);
        let third = self.value.spline_third(knots, pieces);
        [self.chain(value, first), self.chain(first, second), self.chain(second, third)]
    }
    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
        Self::new(self.value.spline_third(knots, pieces))
    }
}

/// The equations `D` with their Jacobian by [`Dual`] numbers, `N` columns at a time: for equations that do not offer
/// one.
#[derive(Clone, Debug)]
pub struct ByDuals<D, M, S, J, const N: usize> {
    dynamics: D,
    in_duals: M,
    /// A state in dual numbers, of which the number of elements counts.
    state: S,
    jacobian: PhantomData<fn() -> J>,
}

impl<D, M, S, J, const N: usize> ByDuals<D, M, S, J, N> {
    /// The equations, the same model in dual numbers and a state of it.
    pub fn new(dynamics: D, in_duals: M, state: S) -> Self {
        Self { dynamics, in_duals, state, jacobian: PhantomData }
    }

    /// The model in dual numbers, for its inputs and parameters: they are not those of the model that is integrated.
    pub fn in_duals_mut(&mut self) -> &mut M {
        &mut self.in_duals
    }

    /// The derivative at constant time and state: its slopes are those of what the model itself holds, its inputs and
    /// parameters.
    pub fn derivative_of_model<T: Scalar>(&self, t: T, y: &[T]) -> S
    where
        D: Ode<M, Scalar = Dual<T, N>, State = S>,
        S: Storage<Dual<T, N>>,
    {
        let (mut argument, mut slopes) = (self.state.clone(), self.state.clone());
        argument.as_mut().iter_mut().zip(y).for_each(|(to, from)| *to = Dual::new(*from));
        self.dynamics.derivative(&self.in_duals, Dual::new(t), &argument, &mut slopes);
        slopes
    }
}

impl<D, M, Dualled, S, J, const N: usize> Ode<M> for ByDuals<D, Dualled, S, J, N>
where
    D: Ode<M> + Ode<Dualled, Scalar = Dual<<D as Ode<M>>::Scalar, N>, State = S>,
    J: Storage<<D as Ode<M>>::Scalar>,
    S: Storage<Dual<<D as Ode<M>>::Scalar, N>>,
{
    type Scalar = <D as Ode<M>>::Scalar;
    type State = <D as Ode<M>>::State;

    fn derivative(&self, model: &M, t: Self::Scalar, y: &Self::State, dy: &mut Self::State) {
        Ode::<M>::derivative(&self.dynamics, model, t, y, dy);
    }
    fn normalise(&self, model: &M, y: &mut Self::State) {
        Ode::<M>::normalise(&self.dynamics, model, y);
    }
}

impl<D, M, Dualled, S, J, const N: usize> Jacobian<M> for ByDuals<D, Dualled, S, J, N>
where
    D: Ode<M> + Ode<Dualled, Scalar = Dual<<D as Ode<M>>::Scalar, N>, State = S>,
    J: Storage<<D as Ode<M>>::Scalar>,
    S: Storage<Dual<<D as Ode<M>>::Scalar, N>>,
{
    type Matrix = J;

    fn jacobian(
        &self,
        _: &M,
        t: Self::Scalar,
        y: &Self::State,
        dfdy: &mut Self::Matrix,
        dfdt: &mut Self::State,
    ) {
        let (mut arguments, n) = (self.state.clone(), y.as_ref().len());
        let mut slopes = arguments.clone();
        // The columns, and after them time.
        for from in (0..=n).step_by(N) {
            let unit = |index: usize| {
                core::array::from_fn(|k| Self::Scalar::constant(if from + k == index { 1.0 } else { 0.0 }))
            };
            for (index, (argument, value)) in arguments.as_mut().iter_mut().zip(y.as_ref()).enumerate() {
                *argument = Dual { value: *value, slopes: unit(index) };
            }
            let time = Dual { value: t, slopes: unit(n) };
            Ode::<Dualled>::derivative(&self.dynamics, &self.in_duals, time, &arguments, &mut slopes);
            for (row, (slopes, dfdt)) in
                dfdy.as_mut().chunks_exact_mut(n.max(1)).zip(slopes.as_ref().iter().zip(dfdt.as_mut()))
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
