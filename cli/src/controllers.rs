//! Controllers of a model as a run has them.

use crate::formulas::{number_in_runs, seen};
use crate::words::number;
use gyro_model::{Law, Model, Number, to_f64};
use gyro_runner::{Controller, Wiring};

/// The controllers of a model with its parameters as they are.
pub(crate) fn controllers(model: &Model) -> Vec<Controller> {
    let value = |number: &Number| model.value(number);
    let one = |controller: &gyro_model::Controller| Controller {
        law: match &controller.law {
            Law::Pid { gains } => Wiring::Pid(gains.each_ref().map(value)),
            Law::StateFeedback { gains } => {
                Wiring::StateFeedback(gains.iter().map(|row| row.iter().map(value).collect()).collect())
            }
            Law::TransferFunction { numerator, denominator } => {
                let [numerator, denominator] =
                    [numerator, denominator].map(|coefficients| coefficients.iter().map(value).collect());
                Wiring::TransferFunction(numerator, denominator)
            }
        },
        outputs: controller.outputs.iter().map(|what| seen(model, *what)).collect(),
        inputs: controller.inputs.iter().map(|&index| (index, to_f64(&model.inputs[index].value))).collect(),
        period: controller.period,
        delay: to_f64(&controller.delay),
        setpoints: controller.setpoints.iter().map(|number| number_in_runs(model, number)).collect(),
        limits: controller.limits.as_ref().map(|limits| limits.each_ref().map(value)),
        output_steps: controller.output_steps.iter().map(value).collect(),
        input_step: value(&controller.input_step),
    };
    model.controllers.iter().map(one).collect()
}

/// The controller that sets an input.
pub(crate) fn setting(model: &Model, input: usize) -> Option<&gyro_model::Controller> {
    model.controllers.iter().find(|controller| controller.inputs.contains(&input))
}

/// A line for each.
pub(crate) fn text(model: &Model) -> String {
    let line = |controller: &gyro_model::Controller| {
        let law = match controller.law {
            Law::Pid { .. } => "pid",
            Law::StateFeedback { .. } => "state_feedback",
            Law::TransferFunction { .. } => "transfer_function",
        };
        let inputs: Vec<&str> =
            controller.inputs.iter().map(|&index| model.inputs[index].name.as_str()).collect();
        #[expect(clippy::cast_precision_loss, reason = "whole numbers below 2⁵³")]
        let period = controller.period[0] as f64 / controller.period[1] as f64;
        let delay = match to_f64(&controller.delay) {
            0.0 => String::new(),
            delay => format!(", {} s later", number(delay, 6)),
        };
        let every = number(period, 6);
        format!("controller {}: {law}, every {every} s, sets {}{delay}\n", controller.name, inputs.join(", "))
    };
    model.controllers.iter().map(line).collect()
}
