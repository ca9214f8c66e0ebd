//! Every number that must have a sign, a size or a direction, decided exactly.

use num_traits::{Signed, Zero};

use super::{Owner, Place, Problem, contacts, controllers, directions, forces, inertia, shown};
use crate::number::{SIZE_EXPONENT, in_range};
use crate::{Body, Coupler, Joint, JointKind, Model, Parameter};

/// Every unphysical number, in the order of the model file.
pub(crate) fn problems(model: &Model) -> Vec<Problem> {
    let mut found: Vec<Problem> = sizes("parameter", &model.parameters, Owner::Parameter).collect();
    found.extend(sizes("input", &model.inputs, Owner::Input));
    for (index, body) in model.bodies.iter().enumerate() {
        found.extend(inertia::mass(model, index, body));
        found.extend(inertia::inertia(model, index, body));
        found.extend(inertia::size(model, index, body));
        found.extend(directions::of_body(model, index, body));
        found.extend(directions::of_motion(model, index, body));
        found.extend(weight(model, index, body));
    }
    for (index, joint) in model.joints.iter().enumerate() {
        found.extend(damping(model, index, joint));
        found.extend(armature(model, index, joint));
        found.extend(advance(model, index, joint));
        found.extend(length(model, index, joint));
        found.extend(directions::of_start(model, index, joint));
        found.extend(directions::of_joint(model, index));
    }
    found.extend(
        model.outputs.iter().enumerate().filter_map(|(index, o)| directions::of_output(model, index, o)),
    );
    found.extend(model.couplers.iter().enumerate().filter_map(|(index, c)| ratio(model, index, c)));
    found.extend(
        model.forces.iter().enumerate().flat_map(|(index, force)| forces::problems(model, index, force)),
    );
    found.extend(
        model.controllers.iter().enumerate().flat_map(|(index, c)| controllers::problems(model, index, c)),
    );
    found
        .extend(model.contacts.iter().enumerate().flat_map(|(index, c)| contacts::problems(model, index, c)));
    found
}

/// Parameters and inputs can be set from outside; the numbers of the model file were checked as they were read.
fn sizes<'m>(
    what: &'m str,
    parameters: &'m [Parameter],
    owner: fn(usize) -> Owner,
) -> impl Iterator<Item = Problem> + 'm {
    let out_of_range = parameters.iter().enumerate().filter(|(_, p)| !in_range(&p.value));
    out_of_range.map(move |(index, p)| Problem {
        place: Place { owner: owner(index), key: "" },
        also: None,
        message: format!("{what} `{}` is too large or too small to compute with", p.name),
        label: format!("{} here", shown(&p.value)),
        help: format!("a number is 0, or its size is between 1e-{SIZE_EXPONENT} and 1e{SIZE_EXPONENT}"),
    })
}

fn weight(model: &Model, index: usize, body: &Body) -> Option<Problem> {
    let value = model.exact(&body.assembly_weight);
    (!value.is_positive()).then(|| Problem {
        place: Place::body(index, "assembly_weight"),
        also: None,
        message: format!("the assembly weight of body `{}` is not positive", body.name),
        label: format!("{} here", shown(&value)),
        help: "write a weight greater than 0; 1 is that of all other bodies, a larger one holds the body nearer to its \
               guess"
            .to_owned(),
    })
}

fn damping(model: &Model, index: usize, joint: &Joint) -> Option<Problem> {
    let value = model.exact(&joint.damping);
    let unit = match joint.kind {
        JointKind::Prismatic | JointKind::PointOnLine => "N.s/m",
        _ => "N.m.s/rad",
    };
    value.is_negative().then(|| Problem {
        place: Place::joint(index, "damping"),
        also: None,
        message: format!("the damping of joint `{}` is negative", joint.name),
        label: format!("{} {unit} would drive the joint", shown(&value)),
        help: "write a coefficient of 0 or more".to_owned(),
    })
}

fn armature(model: &Model, index: usize, joint: &Joint) -> Option<Problem> {
    let value = model.exact(&joint.armature);
    let unit = if joint.kind == JointKind::Prismatic { "kg" } else { "kg.m2" };
    value.is_negative().then(|| Problem {
        place: Place::joint(index, "armature"),
        also: None,
        message: format!("the armature of joint `{}` is negative", joint.name),
        label: format!("{} {unit} would gain energy as it is slowed down", shown(&value)),
        help: "write an inertia of 0 or more: that of the rotor times the square of the gear's ratio"
            .to_owned(),
    })
}

fn advance(model: &Model, index: usize, joint: &Joint) -> Option<Problem> {
    let stands = joint.kind == JointKind::Screw && model.exact(&joint.lead).is_zero();
    stands.then(|| Problem {
        place: Place::joint(index, "lead"),
        also: None,
        message: format!("the screw `{}` does not advance", joint.name),
        label: "0 m/rad".to_owned(),
        help: "write a lead other than 0, in m/rad, or a pitch, in m a turn; or kind = \"revolute\""
            .to_owned(),
    })
}

fn length(model: &Model, index: usize, joint: &Joint) -> Option<Problem> {
    let value = model.exact(&joint.length);
    (joint.kind == JointKind::Rod && !value.is_positive()).then(|| Problem {
        place: Place::joint(index, "length"),
        also: None,
        message: format!("the length of rod `{}` is not positive", joint.name),
        label: format!("{} m", shown(&value)),
        help: "write a length greater than 0, in m; kind = \"spherical\" makes two points coincide"
            .to_owned(),
    })
}

fn ratio(model: &Model, index: usize, coupler: &Coupler) -> Option<Problem> {
    model.exact(&coupler.ratio).is_zero().then(|| Problem {
        place: Place { owner: Owner::Coupler(index), key: "ratio" },
        also: None,
        message: format!("coupler `{}` couples nothing", coupler.name),
        label: "a ratio of 0".to_owned(),
        help: "write a ratio other than 0: second = ratio * first + offset".to_owned(),
    })
}
