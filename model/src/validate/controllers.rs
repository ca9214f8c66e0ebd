//! Numbers of controllers, and what they may set inputs to.

use num_traits::Zero;

use super::{Owner, Place, Problem, shown};
use crate::{Controller, Law, Model, Rational};

/// Numbers that make no law.
pub(super) fn problems(model: &Model, index: usize, controller: &Controller) -> Vec<Problem> {
    let mut found = Vec::new();
    let mut wrong = |key, message: String, label: String, help: &str| {
        let place = Place { owner: Owner::Controller(index), key };
        found.push(Problem::new(place, message, label, help.to_owned()));
    };
    let name = &controller.name;
    if let Law::TransferFunction { denominator, .. } = &controller.law
        && denominator.first().is_some_and(|first| model.exact(first).is_zero())
    {
        let help = "write the coefficient of the present input first, usually 1: a law cannot look ahead";
        let message = format!("the transfer function of controller `{name}` is not causal");
        wrong("denominator", message, "its first number is 0".to_owned(), help);
    }
    if let Some([least, largest]) =
        controller.limits.as_ref().map(|limits| limits.each_ref().map(|l| model.exact(l)))
        && least >= largest
    {
        let label = format!("from {} to {}", shown(&least), shown(&largest));
        let message = format!("the limits of controller `{name}` leave nothing between them");
        wrong("limits", message, label, "write the smaller one first: limits = [-1, 1]");
    }
    found
}

/// Inputs that must not be what a controller may set them to: a damping is not negative. Asked of a good model.
pub(crate) fn settings_problems(model: &Model) -> Vec<Problem> {
    let one = || Rational::from_integer(1.into());
    let (mut found, followed) = (Vec::new(), model.followed_inputs());
    for (index, controller) in model.controllers.iter().enumerate() {
        let limits =
            controller.limits.as_ref().map(|limits| limits.each_ref().map(|limit| model.exact(limit)));
        let extremes = limits.unwrap_or_else(|| [-one(), one()]);
        for input in &controller.inputs {
            if let Some((owner, _)) = followed.iter().find(|(_, inputs)| inputs.contains(input)) {
                let place = Place { owner: Owner::Controller(index), key: "inputs" };
                let (name, input) = (&controller.name, &model.inputs[*input].name);
                found.push(Problem::new(
                    place,
                    format!("controller `{name}` cannot set the input `{input}`: the motion of `{owner}` follows it"),
                    "would make it jump",
                    "let it set the value of a motor in place of the driver",
                ));
                continue;
            }
            let refusal = extremes.iter().find_map(|value| model.check_input(*input, value).err());
            if let Some(words) = refusal {
                let place = Place { owner: Owner::Controller(index), key: "inputs" };
                let (name, input) = (&controller.name, &model.inputs[*input].name);
                found.push(Problem::new(
                    place,
                    format!("controller `{name}` may set the input `{input}` to what it must not be"),
                    words,
                    "keep it where it makes sense: limits = [least, largest]",
                ));
            }
        }
    }
    found
}
