//! Motions that inputs are part of: along straight lines, whose velocities jump, and those that follow inputs.

use crate::failure::Failure;
use gyro_model::Model;
use gyro_runner::Path;

/// Those of a model.
pub(crate) fn paths(model: &Model) -> Vec<Path> {
    let lines = model.lines();
    lines.into_iter().map(|(_, lines)| Path { inputs: lines.inputs, rows: lines.rows.clone() }).collect()
}

/// The driver or body whose motion along straight lines an input is part of.
pub(crate) fn moving(model: &Model, input: usize) -> Option<&str> {
    let mut lines = model.lines().into_iter();
    lines.find_map(|(name, lines)| lines.inputs.contains(&input).then_some(name))
}

/// Value, rate and acceleration of the motion that an input is part of, if a motion follows it.
pub(crate) fn followed(model: &Model, input: usize) -> Option<[usize; 3]> {
    let mut followed = model.followed_inputs().into_iter();
    followed.find_map(|(_, inputs)| inputs.contains(&input).then_some(inputs))
}

/// Refuses a model with such a motion.
pub(crate) fn refuse(model: &Model, what: &str) -> Result<(), Failure> {
    match model.lines().first() {
        None => Ok(()),
        Some((name, lines)) => Err(Failure::Usage(format!(
            "{what} cannot follow a motion along straight lines, and `{name}` of `{}` has one, the table `{}`: leave out its \
             `between`, and a smooth curve joins the rows; or run it with `simulate`",
            model.name, lines.source
        ))),
    }
}
