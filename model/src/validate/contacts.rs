//! Numbers of rigid stops and of friction that sticks.

use num_traits::{One, Signed};

use super::{Owner, Place, Problem, rounded, shown};
use crate::{Contact, Model, Rational};

/// Numbers that make no contact.
pub(super) fn problems(model: &Model, index: usize, contact: &Contact) -> Vec<Problem> {
    let mut found = Vec::new();
    let mut wrong = |key, message: String, label: String, help: &str| {
        let place = Place { owner: Owner::Contact(index), key };
        found.push(Problem::new(place, message, label, help.to_owned()));
    };
    let name = &contact.name;
    if let [Some(lower), Some(upper)] =
        contact.ends.each_ref().map(|end| end.as_ref().map(|e| model.exact(e)))
        && lower >= upper
    {
        let label = format!("{}, not above {}", shown(&upper), shown(&lower));
        let message = format!("the stops of contact `{name}` leave nothing between them");
        wrong("upper", message, label, "write an upper stop above the lower one");
    }
    let restitution = model.exact(&contact.restitution);
    if restitution.is_negative() || restitution > Rational::one() + rounded() {
        let message = format!("the restitution of contact `{name}` is not between 0 and 1");
        let help = "write the part of its rate with which the joint rebounds: 0 for none, 1 for all";
        wrong("restitution", message, shown(&restitution), help);
    }
    for (numbers, what, [key, static_key]) in [
        (&contact.levels, "friction", ["friction", "static_friction"]),
        (
            &contact.coefficients,
            "coefficient of friction",
            ["friction_coefficient", "static_friction_coefficient"],
        ),
    ] {
        let [kinetic, at_rest] = numbers.each_ref().map(|number| model.exact(number));
        if !kinetic.is_negative() && at_rest < &kinetic * (Rational::one() - rounded()) {
            let message = format!("the static {what} of contact `{name}` is less than the kinetic one");
            let label = format!("{}, less than {}", shown(&at_rest), shown(&kinetic));
            let help =
                format!("write a number that is not below `{key}`, or leave it out: it is then the same");
            wrong(static_key, message, label, &help);
        }
    }
    found
}
