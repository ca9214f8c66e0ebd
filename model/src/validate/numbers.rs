//! Every number that must have a sign, a size or a direction, decided exactly.

use super::ranges::Ranged;
use super::{Owner, Place, Problem, contacts, controllers, directions, inertia, shown};
use crate::number::{SIZE_EXPONENT, in_range};
use crate::{Model, Parameter};

/// Every unphysical number, in the order of the model file.
pub(crate) fn problems(model: &Model) -> Vec<Problem> {
    let mut found: Vec<Problem> = sizes("parameter", &model.parameters, Owner::Parameter).collect();
    found.extend(sizes("input", &model.inputs, Owner::Input));
    if let Some(attraction) = &model.attraction {
        found.extend(Ranged::of_attraction(attraction).problems(model));
    }
    for (index, body) in model.bodies.iter().enumerate() {
        found.extend(Ranged::of_body(index, body).problems(model));
        found.extend(inertia::inertia(model, index, body));
        found.extend(inertia::size(model, index, body));
        found.extend(directions::of_body(model, index, body));
        found.extend(directions::of_motion(model, index, body));
    }
    for (index, joint) in model.joints.iter().enumerate() {
        found.extend(Ranged::of_joint(index, joint).problems(model));
        found.extend(directions::of_start(model, index, joint));
        found.extend(directions::of_joint(model, index));
    }
    found.extend(
        model.outputs.iter().enumerate().filter_map(|(index, o)| directions::of_output(model, index, o)),
    );
    for (index, coupler) in model.couplers.iter().enumerate() {
        found.extend(Ranged::of_coupler(index, coupler).problems(model));
    }
    for (index, force) in model.forces.iter().enumerate() {
        found.extend(Ranged::of_force(index, force).problems(model));
        found.extend(directions::of_force(model, index, force));
    }
    for (index, element) in model.elements.iter().enumerate() {
        found.extend(Ranged::of_element(index, element).problems(model));
    }
    for (index, controller) in model.controllers.iter().enumerate() {
        found.extend(controllers::problems(model, index, controller));
        found.extend(Ranged::of_controller(index, controller).problems(model));
    }
    for (index, contact) in model.contacts.iter().enumerate() {
        found.extend(contacts::problems(model, index, contact));
        found.extend(Ranged::of_contact(index, contact).problems(model));
    }
    found
}

/// Parameters and inputs can be set from outside; the numbers of the model file were checked as they were read.
fn sizes<'m>(
    what: &'m str,
    parameters: &'m [Parameter],
    owner: fn(usize) -> Owner,
) -> impl Iterator<Item = Problem> + 'm {
    let out_of_range = parameters.iter().enumerate().filter(|(_, p)| !in_range(&p.value));
    out_of_range.map(move |(index, p)| {
        Problem::new(
            Place { owner: owner(index), key: "" },
            format!("{what} `{}` is too large or too small to compute with", p.name),
            format!("{} here", shown(&p.value)),
            format!("a number is 0, or its size is between 1e-{SIZE_EXPONENT} and 1e{SIZE_EXPONENT}"),
        )
    })
}
