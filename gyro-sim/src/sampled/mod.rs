//! Sampled controllers: laws that see a mechanism's outputs at their own times and hold its inputs in between.
//!
//! A [`Controller`] computes; a [`Sampled`] one has a clock beside it, which says when something is to be done. Between
//! these times the motion is smooth, so any method may be used, under error control, too:
//! ```
//! use gyro_sim::sampled::{Period, Pid, Sampled};
//! use gyro_sim::{Dop853, Ode, Solver};
//!
//! /// A mass of 1 kg on a spring of 4 N/m, under a force.
//! struct Mass;
//!
//! impl Ode<f64> for Mass {
//!     type Scalar = f64;
//!     type State = [f64; 2];
//!
//!     fn derivative(&self, force: &f64, _t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
//!         *dy = [y[1], force - 4.0 * y[0]];
//!     }
//! }
//!
//! # fn main() -> Result<(), gyro_sim::Error> {
//! let period = Period::hertz(100).unwrap();
//! let law = Pid::new([20.0, 40.0, 8.0], period.seconds()).with_setpoint(1.0);
//! let (mut control, mut force) = (Sampled::<_, f64, 1>::new(law, period), [0.0]);
//! let start = [0.0, 0.0];
//! let mut solver = Solver::new(Mass, Dop853::new(&start), 0.0, &start);
//! while solver.time() < 5.0 {
//!     if control.act(solver.time(), &solver.state()[..1], &mut force) {
//!         solver.system_has_changed();
//!     }
//!     solver.advance_to(&force[0], control.next().min(5.0))?;
//! }
//! assert!((solver.state()[0] - 1.0).abs() < 1e-3);
//! # Ok(())
//! # }
//! ```

mod laws;

pub use laws::{Limited, Pid, Quantised, StateFeedback, TransferFunction};

use crate::Real;

/// A law of control.
pub trait Controller<T> {
    /// Computes the inputs from the outputs at a time at which it samples.
    fn sample(&mut self, t: T, outputs: &[T], inputs: &mut [T]);
}

/// An interval, a fraction of whole numbers of seconds: its multiples are rounded once, and do not accumulate.
/// Multiples of several periods that are the same number are the same to the last bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Period {
    numerator: u64,
    denominator: u64,
}

impl Period {
    /// So many seconds over so many; `None` if one of them is zero.
    pub const fn new(numerator: u64, denominator: u64) -> Option<Self> {
        if numerator == 0 || denominator == 0 { None } else { Some(Self { numerator, denominator }) }
    }

    /// The period of a frequency, Hz; `None` for zero.
    pub const fn hertz(frequency: u64) -> Option<Self> {
        Self::new(1, frequency)
    }

    /// Its length, s.
    pub fn seconds(self) -> f64 {
        self.times(1)
    }

    /// k periods, s. Rounded once while numerator and denominator stay below 2⁵³.
    #[expect(clippy::cast_precision_loss, reason = "whole numbers below 2⁵³ are exact, larger ones rounded")]
    pub fn times(self, k: u64) -> f64 {
        (u128::from(k) * u128::from(self.numerator)) as f64 / self.denominator as f64
    }
}

/// Times nearer to each other than this part of a period are one: those of steps of fixed length are rounded.
const COINCIDENT: f64 = 1e-9;

/// A controller of `N` inputs with its clock. It samples at 0, T, 2T and so on; what it has computed takes effect after
/// a delay and is held until the next does.
#[derive(Clone, Debug)]
pub struct Sampled<C, T, const N: usize> {
    controller: C,
    period: Period,
    /// Seconds, not more than a period.
    delay: f64,
    /// The number of the next sample.
    number: u64,
    /// What has been computed, and when it takes effect.
    computed: [T; N],
    effect: Option<f64>,
}

impl<C: Controller<T>, T: Real, const N: usize> Sampled<C, T, N> {
    /// A controller that samples at this period, with no delay.
    pub fn new(controller: C, period: Period) -> Self {
        let computed = [T::constant(0.0); N];
        Self { controller, period, delay: 0.0, number: 0, computed, effect: None }
    }

    /// The same with a delay from sampling to effect, s; `None` if it is negative or longer than the period.
    #[must_use]
    pub fn with_delay(self, delay: f64) -> Option<Self> {
        (0.0..=self.period.seconds()).contains(&delay).then_some(Self { delay, ..self })
    }

    /// The controller, for its set points.
    pub fn controller_mut(&mut self) -> &mut C {
        &mut self.controller
    }

    /// The next time at which there is something to do, s: a step has to end there.
    pub fn next(&self) -> f64 {
        let sample = self.period.times(self.number);
        self.effect.map_or(sample, |effect| effect.min(sample))
    }

    /// Whether there is something to do at a time.
    pub fn is_due(&self, t: T) -> bool {
        self.has_come(t, self.next())
    }

    /// Does what is due: inputs that were computed take effect, and then a sample is taken. Returns whether the inputs
    /// have been set; the solver has to know ([`Solver::system_has_changed`](crate::Solver::system_has_changed)).
    /// Samples that a caller has let pass are not made up for.
    pub fn act(&mut self, t: T, outputs: &[T], inputs: &mut [T; N]) -> bool {
        let mut is_set = self.take_effect(t, inputs);
        if self.has_come(t, self.period.times(self.number)) {
            self.controller.sample(t, outputs, &mut self.computed);
            // Not from t, which may be a little off.
            self.effect = Some(self.period.times(self.number) + self.delay);
            while self.has_come(t, self.period.times(self.number)) {
                self.number += 1;
            }
            is_set |= self.take_effect(t, inputs);
        }
        is_set
    }

    fn take_effect(&mut self, t: T, inputs: &mut [T; N]) -> bool {
        let is_due = self.effect.is_some_and(|effect| self.has_come(t, effect));
        if is_due {
            *inputs = self.computed;
            self.effect = None;
        }
        is_due
    }

    fn has_come(&self, t: T, at: f64) -> bool {
        let t = t.to_f64();
        let rounding = 4.0 * T::EPSILON.to_f64() * libm::fabs(t);
        at - t <= (COINCIDENT * self.period.seconds()).max(rounding)
    }
}

#[cfg(test)]
mod tests;
