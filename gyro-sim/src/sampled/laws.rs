//! Common laws.

use super::Controller;
use crate::{Real, Scalar};

/// A PID law: `u = kp e + ki ∫e + kd ė` with `e = setpoint − output` of its first output, for its first input.
///
/// The integral is a sum of rectangles that has the present error, the derivative a difference to the error before
/// (zero at the first sample). Where u is at a limit, the integral does not grow beyond it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pid<T> {
    /// kp, ki (1/s) and kd (s), in units of the input over the output.
    pub gains: [T; 3],
    /// The sampling period, s.
    pub period: T,
    /// What the output is to be.
    pub setpoint: T,
    /// The least and the largest u.
    pub limits: [T; 2],
    integral: T,
    before: Option<T>,
}

impl<T: Real> Pid<T> {
    /// The law with these gains, with a set point of zero and no limits.
    pub fn new(gains: [T; 3], period: T) -> Self {
        let (zero, infinity) = (T::constant(0.0), T::constant(f64::INFINITY));
        Self { gains, period, setpoint: zero, limits: [-infinity, infinity], integral: zero, before: None }
    }

    /// The same with a set point.
    #[must_use]
    pub fn with_setpoint(self, setpoint: T) -> Self {
        Self { setpoint, ..self }
    }

    /// The same with a least and a largest input.
    #[must_use]
    pub fn with_limits(self, limits: [T; 2]) -> Self {
        Self { limits, ..self }
    }
}

impl<T: Real> Controller<T> for Pid<T> {
    fn sample(&mut self, _: T, outputs: &[T], inputs: &mut [T]) {
        let (Some(&output), Some(input)) = (outputs.first(), inputs.first_mut()) else { return };
        let [kp, ki, kd] = self.gains;
        let error = self.setpoint - output;
        let change = error - self.before.unwrap_or(error);
        let rest = kp * error + kd * change / self.period;
        let grown = self.integral + ki * self.period * error;
        let [least, largest] = self.limits;
        let u = rest + grown;
        let (clamped, winds_up) = if u > largest {
            (largest, grown > self.integral)
        } else if u < least {
            (least, grown < self.integral)
        } else {
            (u, false)
        };
        if !winds_up {
            self.integral = grown;
        }
        (self.before, *input) = (Some(error), clamped);
    }
}

/// Feedback of `M` outputs to `N` inputs: `u = K (reference − outputs)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StateFeedback<T, const M: usize, const N: usize> {
    /// K, row by row: a row for each input.
    pub gains: [[T; M]; N],
    /// What the outputs are to be.
    pub reference: [T; M],
}

impl<T: Scalar, const M: usize, const N: usize> Controller<T> for StateFeedback<T, M, N> {
    fn sample(&mut self, _: T, outputs: &[T], inputs: &mut [T]) {
        for (input, row) in inputs.iter_mut().zip(&self.gains) {
            let terms = row.iter().zip(&self.reference).zip(outputs);
            *input = terms.fold(T::constant(0.0), |sum, ((k, r), y)| sum + *k * (*r - *y));
        }
    }
}

/// A discrete transfer function of order `N` from `reference − output` of the first output to the first input:
/// `(b0 + b1 z⁻¹ + … + bN z⁻ᴺ) / (1 + a1 z⁻¹ + … + aN z⁻ᴺ)`, in the transposed direct form II.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransferFunction<T, const N: usize> {
    /// b0.
    pub direct: T,
    /// b1 to bN.
    pub numerator: [T; N],
    /// a1 to aN.
    pub denominator: [T; N],
    /// What the output is to be.
    pub reference: T,
    memory: [T; N],
}

impl<T: Scalar, const N: usize> TransferFunction<T, N> {
    /// At rest, with a reference of zero.
    pub fn new(direct: T, numerator: [T; N], denominator: [T; N]) -> Self {
        let zero = T::constant(0.0);
        Self { direct, numerator, denominator, reference: zero, memory: [zero; N] }
    }
}

impl<T: Scalar, const N: usize> Controller<T> for TransferFunction<T, N> {
    fn sample(&mut self, _: T, outputs: &[T], inputs: &mut [T]) {
        let (Some(&output), Some(input)) = (outputs.first(), inputs.first_mut()) else { return };
        let error = self.reference - output;
        let zero = T::constant(0.0);
        let u = self.direct * error + self.memory.first().copied().unwrap_or(zero);
        for k in 0..N {
            let next = self.memory.get(k + 1).copied().unwrap_or(zero);
            self.memory[k] = self.numerator[k] * error - self.denominator[k] * u + next;
        }
        *input = u;
    }
}

/// A law whose inputs are cut at a least and a largest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limited<C, T> {
    /// The law.
    pub controller: C,
    /// The least and the largest value.
    pub limits: [T; 2],
}

impl<C: Controller<T>, T: Real> Controller<T> for Limited<C, T> {
    fn sample(&mut self, t: T, outputs: &[T], inputs: &mut [T]) {
        self.controller.sample(t, outputs, inputs);
        let [least, largest] = self.limits;
        for input in inputs {
            if *input < least {
                *input = least;
            } else if *input > largest {
                *input = largest;
            }
        }
    }
}

/// A law between converters: `M` outputs and all inputs are rounded to whole multiples of their steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantised<C, T, const M: usize> {
    /// The law.
    pub controller: C,
    /// The step of each output; none where it is zero.
    pub outputs: [T; M],
    /// The step of the inputs; none where it is zero.
    pub inputs: T,
}

fn rounded<T: Real>(value: T, step: T) -> T {
    if step > T::constant(0.0) { (value / step).round() * step } else { value }
}

impl<C: Controller<T>, T: Real, const M: usize> Controller<T> for Quantised<C, T, M> {
    fn sample(&mut self, t: T, outputs: &[T], inputs: &mut [T]) {
        let mut seen = [T::constant(0.0); M];
        for ((seen, output), step) in seen.iter_mut().zip(outputs).zip(self.outputs) {
            *seen = rounded(*output, step);
        }
        self.controller.sample(t, &seen, inputs);
        inputs.iter_mut().for_each(|input| *input = rounded(*input, self.inputs));
    }
}
