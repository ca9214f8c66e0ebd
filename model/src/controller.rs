//! Sampled controllers: laws from outputs to inputs, at their own periods.

use crate::{JointCoordinate, Number, Rational};

/// A law that sees numbers of the mechanism at the multiples of its period and holds inputs in between.
#[derive(Clone, Debug)]
pub struct Controller {
    /// Name, an identifier.
    pub name: String,
    /// The law.
    pub law: Law,
    /// What it sees.
    pub outputs: Vec<Seen>,
    /// Indices into [`crate::Model::inputs`]: what it sets.
    pub inputs: Vec<usize>,
    /// The period: so many seconds over so many, neither zero.
    pub period: [u64; 2],
    /// From a sample to its effect, s; not more than a period.
    pub delay: Rational,
    /// What each output is to be.
    pub setpoints: Vec<Number>,
    /// The least and the largest value of each input.
    pub limits: Option<[Number; 2]>,
    /// To whole multiples of this each output is rounded before the law sees it; zero: it is not.
    pub output_steps: Vec<Number>,
    /// The same of the inputs.
    pub input_step: Number,
}

/// From the errors e, set points less outputs, to inputs.
#[derive(Clone, Debug)]
pub enum Law {
    /// `u = kp e + ki ∫e + kd ė`, of one output to one input.
    Pid {
        /// kp, ki and kd.
        gains: [Number; 3],
    },
    /// `u = K e`.
    StateFeedback {
        /// K: a row for each input.
        gains: Vec<Vec<Number>>,
    },
    /// `(b0 + b1 z⁻¹ + …) / (a0 + a1 z⁻¹ + …)`, of one output to one input.
    TransferFunction {
        /// b0, b1 and so on.
        numerator: Vec<Number>,
        /// a0, which is not zero, a1 and so on.
        denominator: Vec<Number>,
    },
}

/// A number of the mechanism that a controller can see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// A number of an output.
    Output {
        /// Index into [`crate::Model::outputs`].
        output: usize,
        /// Index into the [`crate::OutputKind::columns`] of its kind.
        number: usize,
    },
    /// A joint coordinate, rad or m.
    Coordinate(JointCoordinate),
    /// Its rate, rad/s or m/s.
    Rate(JointCoordinate),
}

impl Controller {
    /// Most outputs or inputs of a controller, and the highest order of a transfer function.
    pub const MOST: usize = 16;

    /// Every number of the law and of what is around it.
    pub fn numbers(&self) -> Vec<&Number> {
        let mut numbers: Vec<&Number> = match &self.law {
            Law::Pid { gains } => gains.iter().collect(),
            Law::StateFeedback { gains } => gains.iter().flatten().collect(),
            Law::TransferFunction { numerator, denominator } => numerator.iter().chain(denominator).collect(),
        };
        numbers.extend(self.setpoints.iter().chain(self.limits.iter().flatten()));
        numbers.extend(self.output_steps.iter().chain([&self.input_step]));
        numbers
    }
}
