//! Sampled controllers.

use super::numbers::{Name, Number, Plain};
use schemars::JsonSchema;

/// A law from outputs to inputs, at its own period.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Controller {
    name: Name,
    kind: Kind,
    /// What it sees, by the names of the columns of a run's table.
    #[schemars(length(min = 1, max = 16))]
    outputs: Vec<String>,
    /// The inputs that it sets.
    #[schemars(length(min = 1, max = 16))]
    inputs: Vec<String>,
    /// How often it samples, Hz.
    frequency_hz: Option<Plain>,
    /// How often it samples, s.
    period: Option<Plain>,
    /// From a sample to its effect, s.
    delay: Option<Plain>,
    /// What the outputs are to be.
    setpoint: Option<OneOrEach>,
    /// The least and the largest value of each input.
    limits: Option<[Number; 2]>,
    /// The step to which outputs are rounded before the law sees them.
    output_step: Option<OneOrEach>,
    /// The step to which inputs are rounded.
    input_step: Option<Number>,
    /// PID: gain of the error.
    kp: Option<Number>,
    /// PID: gain of its integral, 1/s.
    ki: Option<Number>,
    /// PID: gain of its derivative, s.
    kd: Option<Number>,
    /// State feedback: a row for each input, in it a number for each output.
    gains: Option<Vec<Vec<Number>>>,
    /// Transfer function: coefficients of powers of 1/z.
    #[schemars(length(min = 1, max = 17))]
    numerator: Option<Vec<Number>>,
    /// Transfer function: coefficients of powers of 1/z, of which the first is not zero.
    #[schemars(length(min = 1, max = 17))]
    denominator: Option<Vec<Number>>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Kind {
    /// kp e + ki ∫e + kd ė.
    Pid,
    /// A matrix.
    StateFeedback,
    /// (b0 + b1/z + …) / (a0 + a1/z + …).
    TransferFunction,
}

/// A number for all outputs, or one for each.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
enum OneOrEach {
    One(Number),
    Each(Vec<Number>),
}
