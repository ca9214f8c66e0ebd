//! Forces by formula, as the page has them: the run tells what they give.

use gyro_model::{Force, ForceKind, Model, Number, Output, OutputKind};
use gyro_show::Amount;

/// Has the run tell what formulas of motors, loads and links give, for arrows and plots; what the model file tells of
/// links itself is not told twice.
pub(super) fn with_laws(model: &mut Model) {
    let mut told = Vec::new();
    for (index, force) in model.forces.iter().enumerate() {
        let formulas = force.kind.parts().numbers.into_iter().flat_map(|(key, numbers)| {
            numbers.iter().enumerate().map(move |(place, number)| ((key, place), number.formula()))
        });
        let formulas: Vec<_> = formulas.filter_map(|(place, formula)| Some((place, formula?))).collect();
        match force.kind {
            ForceKind::Link { .. } if telling(model, index).is_none() && !formulas.is_empty() => {
                told.push((format!("{}_force", force.name), OutputKind::Link { force: index }));
            }
            ForceKind::Motor { .. } | ForceKind::Load { .. } => told.extend(
                formulas
                    .into_iter()
                    .map(|(place, formula)| (title(force, place), OutputKind::Formula(formula.clone()))),
            ),
            _ => {}
        }
    }
    told.retain(|(name, _)| model.outputs.iter().all(|output| output.name != *name));
    model.outputs.extend(told.into_iter().map(|(name, kind)| Output { name, kind }));
}

/// A number of a force as the page has it.
pub(super) fn told(model: &Model, force: &Force, place: (&str, usize), number: &Number) -> Amount {
    match number {
        Number::Input { index, negated } => {
            Amount::Input { input: *index, sign: if *negated { -1 } else { 1 } }
        }
        Number::Formula(_) => Amount::Output { output: title(force, place), part: "" },
        other => Amount::Value(model.value(other)),
    }
}

/// The force of a link by formula.
pub(super) fn of_link(model: &Model, link: usize) -> Option<Amount> {
    telling(model, link).map(|output| Amount::Output { output: output.name.clone(), part: "force" })
}

fn telling(model: &Model, link: usize) -> Option<&Output> {
    let tells = |kind: &OutputKind| matches!(kind, OutputKind::Link { force } if *force == link);
    model.outputs.iter().find(|output| tells(&output.kind))
}

/// The name of the output that tells a number of a force.
fn title(force: &Force, (key, place): (&str, usize)) -> String {
    match force.kind {
        ForceKind::Load { .. } => format!("{}_{key}_{}", force.name, ["x", "y", "z"][place.min(2)]),
        _ => format!("{}_{key}", force.name),
    }
}
