//! Runs that end where a formula has no value: which formula, and what it sees.

use crate::failure::Failure;
use crate::scene::Scene;
use crate::words::number;
use gyro_runner::Sample;

/// Digits of what a formula sees.
const DIGITS: usize = 12;

/// A failed run where a formula has no value, or has none soon after, says which formula that is; the last state is
/// that before it failed.
pub(crate) fn with_formula(
    scene: &Scene,
    samples: &[Sample],
    last: Option<&(f64, Vec<f64>)>,
    failure: Failure,
) -> Failure {
    let Failure::Run(words) = &failure else { return failure };
    let (t, state) = last.map_or((0.0, None), |(t, y)| (*t, Some(y.as_slice())));
    let given = scene.start.inputs.iter().map(|input| (input.index, input.at(t)));
    let held = samples.last().map_or(&[][..], |sample| &sample.controlled);
    let set =
        scene.start.controllers.iter().flat_map(|controller| controller.inputs.iter().map(|input| input.0));
    let inputs: Vec<(usize, f64)> = given.chain(set.zip(held.iter().copied())).collect();
    let Some(lapse) = gyro_assembled::lapse(&scene.model, &inputs, (t, state), scene.settings.step) else {
        return failure;
    };
    let place = lapse.place;
    let mut said =
        format!("{words}\nThe motion comes to where {place} has no value: it is \"{}\"", lapse.text);
    for (name, text) in lapse.within {
        said += &format!(", where the formula `{name}` is \"{text}\"");
    }
    let values = lapse.names.iter().map(|(name, value)| format!("{name} = {}", number(*value, DIGITS)));
    let values: Vec<String> = values.collect();
    said += &if values.is_empty() { ".".to_owned() } else { format!(", with {}.", values.join(", ")) };
    Failure::Run(said)
}

/// What there is to say of outputs whose formulas have had no value: a run goes on all the same.
pub(crate) fn of_outputs(scene: &Scene, samples: &[Sample]) -> Vec<String> {
    let mut place = 0;
    let mut said = Vec::new();
    for output in &scene.model.outputs {
        let first = || {
            let mut samples = samples.iter();
            samples.find(|sample| sample.outputs.get(place).is_some_and(|value| !value.is_finite()))
        };
        if let Some((formula, sample)) = output.kind.formula().and_then(|formula| Some((formula, first()?))) {
            said.push(format!(
                "Output `{}` has no value at t = {} s: it is \"{}\".",
                output.name, sample.t, formula.text
            ));
        }
        place += output.kind.columns().len();
    }
    said
}
