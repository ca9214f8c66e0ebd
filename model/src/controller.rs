//! Sampled controllers: laws from outputs to inputs, at their own periods.

use crate::{JointCoordinate, JointKind, Model, Number, Output, Rational, Seen};

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

impl Model {
    /// All numbers that can be seen, by the names of their columns in the table of a run.
    pub fn visible(&self) -> Vec<(String, Seen)> {
        let joints = self.joints.iter().enumerate();
        visible(joints.map(|(index, joint)| (index, joint.name.as_str(), joint.kind)), &self.outputs)
    }
}

/// The same of joints by their indices, names and kinds.
pub(crate) fn visible<'a>(
    joints: impl Iterator<Item = (usize, &'a str, JointKind)>,
    outputs: &[Output],
) -> Vec<(String, Seen)> {
    let mut known = Vec::new();
    for (joint, name, kind) in joints {
        let kinds = kind.coordinates();
        for (coordinate, kind) in kinds.iter().enumerate() {
            let name = if kinds.len() == 1 { name.to_owned() } else { format!("{name}.{}", kind.name()) };
            let on = JointCoordinate { joint, coordinate };
            known.push((format!("{name} rate"), Seen::Rate(on)));
            known.push((name, Seen::Coordinate(on)));
        }
    }
    for (index, output) in outputs.iter().enumerate() {
        for (number, (suffix, _)) in output.kind.columns().iter().enumerate() {
            let dot = if suffix.is_empty() { "" } else { "." };
            known.push((format!("{}{dot}{suffix}", output.name), Seen::Output { output: index, number }));
        }
    }
    known
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
