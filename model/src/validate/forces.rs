//! The coefficients of forces.

use num_traits::Signed;

use super::{Place, Problem, shown};
use crate::{Force, ForceKind, Model, Number};

/// What must hold of a coefficient.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    Positive,
    NotNegative,
}

/// Coefficients of one force that are out of range.
pub(super) fn problems(model: &Model, index: usize, force: &Force) -> Vec<Problem> {
    let wrong = conditions(&force.kind).into_iter().filter(|(_, number, sign, _)| {
        let value = model.exact(number);
        value.is_negative() || (*sign == Sign::Positive && !value.is_positive())
    });
    let problem = |(key, number, sign, why): Condition<'_>| Problem {
        place: Place::force(index, key),
        also: None,
        message: format!("the {} of force `{}` is {}", key.replace('_', " "), force.name, broken(sign)),
        label: format!("{}: {why}", shown(&model.exact(number))),
        help: match sign {
            Sign::Positive => "write a number greater than 0".to_owned(),
            Sign::NotNegative => "write a number of 0 or more".to_owned(),
        },
    };
    wrong.map(problem).collect()
}

/// A coefficient with its key, what must hold of it and why.
pub(super) type Condition<'m> = (&'static str, &'m Number, Sign, &'static str);

pub(super) fn conditions(kind: &ForceKind) -> Vec<Condition<'_>> {
    use Sign::{NotNegative, Positive};
    const DRIVES: &str = "it would drive the motion";
    match kind {
        ForceKind::Damper { damping, .. } => vec![("damping", damping, NotNegative, DRIVES)],
        ForceKind::Coulomb { level, rate, .. } => vec![
            ("level", level, NotNegative, DRIVES),
            ("rate", rate, Positive, "friction would jump where the velocity changes sign"),
        ],
        ForceKind::Stop { stiffness, damping, softness, .. } => vec![
            ("stiffness", stiffness, Positive, "the stop would exert no force"),
            ("damping", damping, NotNegative, DRIVES),
            ("softness", softness, Positive, "the force of the stop would jump"),
        ],
        ForceKind::Link { damping, free_length, .. } => vec![
            ("damping", damping, NotNegative, DRIVES),
            ("free_length", free_length, NotNegative, "lengths cannot be negative"),
        ],
        ForceKind::Spring { .. } | ForceKind::Motor { .. } | ForceKind::Load { .. } => Vec::new(),
    }
}

fn broken(sign: Sign) -> &'static str {
    match sign {
        Sign::Positive => "not positive",
        Sign::NotNegative => "negative",
    }
}
