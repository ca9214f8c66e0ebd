//! Forces by formula, as the page has them: the run tells what they give.

use gyro_model::{Bushing, Force, ForceKind, Formula, Model, Number, Output, OutputKind, Seen};
use gyro_show::Amount;

/// Has the run tell what formulas of forces along coordinates, of loads, of links and of contacts give, for arrows and
/// plots; what the model file tells itself is not told twice.
pub(super) fn with_laws(model: &mut Model) {
    for (index, force) in model.forces.clone().iter().enumerate() {
        for (formula, part) in touching(force).into_iter().flatten().zip(["fx", "fy", "fz", "mx", "my", "mz"])
        {
            if let Some(formula) = formula.formula().filter(|formula| telling(model, formula).is_none()) {
                add(model, format!("{}_{part}", force.name), OutputKind::Formula(formula.clone()));
            }
        }
        let (is_load, parts) = (matches!(force.kind, ForceKind::Load { .. }), force.kind.parts());
        for (key, numbers) in parts.numbers {
            for (formula, axis) in numbers.iter().map(Number::formula).zip(["x", "y", "z"]) {
                let Some(formula) = formula else { continue };
                match force.kind {
                    ForceKind::Link { .. } if of_link(model, index).is_none() => {
                        add(model, format!("{}_force", force.name), OutputKind::Link { force: index });
                    }
                    _ if (is_load || parts.on.is_some()) && telling(model, formula).is_none() => {
                        let part = if is_load { format!("_{axis}") } else { String::new() };
                        let name = format!("{}_{key}{part}", force.name);
                        add(model, name, OutputKind::Formula(formula.clone()));
                    }
                    _ => {}
                }
            }
        }
    }
}

/// Force and torque of a bushing that is nothing else, and whose formulas do not ask where it is: of a contact.
pub(super) fn touching(force: &Force) -> Option<[&Number; 6]> {
    let ForceKind::Bushing(bushing) = &force.kind else { return None };
    let Bushing { along, about, moment, .. } = &**bushing;
    let asks = |number: &&Number| {
        let seen = number.formula().into_iter().flat_map(Formula::sees);
        seen.into_iter().any(|seen| matches!(seen, Seen::Between(_) | Seen::BetweenRate(_)))
    };
    let [x, y, z] = along.load.each_ref();
    let [mx, my, mz] = moment.each_ref();
    let own = [x, y, z, mx, my, mz];
    let springs = [&along.stiffness, &along.damping, &about.stiffness, &about.damping, &about.load];
    let is_bare = springs.into_iter().flatten().all(Number::is_zero) && !own.iter().any(asks);
    (is_bare && own.iter().any(|number| number.formula().is_some())).then_some(own)
}

/// Adds an output, of another name if this one is taken.
fn add(model: &mut Model, mut name: String, kind: OutputKind) {
    while model.outputs.iter().any(|output| output.name == name) {
        name.push('_');
    }
    model.outputs.push(Output { name, kind });
}

/// A number of a force as the page has it.
pub(super) fn told(model: &Model, number: &Number) -> Amount {
    match number {
        Number::Input { index, negated } => {
            Amount::Input { input: *index, sign: if *negated { -1 } else { 1 } }
        }
        Number::Formula(formula) => {
            let output = telling(model, formula).expect("the run tells what formulas give");
            Amount::Output { output: output.name.clone(), part: "" }
        }
        other => Amount::Value(model.value(other)),
    }
}

/// The force of a link, where an output tells it.
pub(super) fn of_link(model: &Model, link: usize) -> Option<Amount> {
    let tells = |output: &&Output| matches!(output.kind, OutputKind::Link { force } if force == link);
    let output = model.outputs.iter().find(tells)?;
    Some(Amount::Output { output: output.name.clone(), part: "force" })
}

/// The output that tells a formula.
fn telling<'m>(model: &'m Model, formula: &Formula) -> Option<&'m Output> {
    let tells =
        |output: &&Output| matches!(&output.kind, OutputKind::Formula(known) if known.text == formula.text);
    model.outputs.iter().find(tells)
}
