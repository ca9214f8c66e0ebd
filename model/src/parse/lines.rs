//! The inputs of motions along straight lines.

use crate::{Between, Body, BodyMotion, Driver, Lines, Parameter, Rational};
use num_traits::Zero;

/// What the inputs of [`Lines`] are called, after the name of the driver or body.
const NAMES: [&str; 4] = ["from", "place", "rate", "acceleration"];

/// Gives each motion along straight lines its inputs, whose values are those of the line that holds at time zero; what
/// they are called is unlike the names that are taken. The first of them is the one after those that there are.
pub(super) fn add_inputs(
    (bodies, drivers): (&mut [Body], &mut [Driver]),
    taken: &[&str],
    (inputs, between): (&mut Vec<Parameter>, &mut Vec<Between>),
) {
    for (owner, lines) in all(bodies, drivers) {
        let [from, place, rate] = lines.piece(0.0);
        for ((k, what), value) in NAMES.iter().enumerate().zip([from, place, rate, 0.0]) {
            let is_taken = |name: &String| {
                taken.contains(&name.as_str()) || inputs.iter().any(|input| input.name == *name)
            };
            let mut name = format!("{owner}_{what}");
            for n in 2.. {
                if !is_taken(&name) {
                    break;
                }
                name = format!("{owner}_{what}_{n}");
            }
            lines.inputs[k] = inputs.len();
            let value = Rational::from_float(value).unwrap_or_else(Rational::zero);
            inputs.push(Parameter { name, value });
            between.push(Between::Held);
        }
    }
}

/// How many inputs that will be.
pub(super) fn n_inputs((bodies, drivers): (&mut [Body], &mut [Driver])) -> usize {
    NAMES.len() * all(bodies, drivers).len()
}

/// All motions along straight lines, in the order of [`Model::lines`].
fn all<'m>(bodies: &'m mut [Body], drivers: &'m mut [Driver]) -> Vec<(&'m str, &'m mut Lines)> {
    let mut found = Vec::new();
    for Driver { name, motion, .. } in drivers {
        found.extend(motion.lines_mut().into_iter().map(|lines| (name.as_str(), lines)));
    }
    for Body { name, motion, .. } in bodies {
        for part in motion.iter_mut().flat_map(BodyMotion::parts_mut) {
            found.extend(part.lines_mut().into_iter().map(|lines| (name.as_str(), lines)));
        }
    }
    found
}
