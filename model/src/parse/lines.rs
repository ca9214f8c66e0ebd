//! The inputs of motions: of those along straight lines, and the rates and accelerations of inputs that are followed.

use super::reader::Reader;
use crate::validate::{Owner, Place};
use crate::{Between, Body, BodyMotion, Driver, Lines, Motion, Parameter, Rational};
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
            let name = unlike(&format!("{owner}_{what}"), taken, inputs);
            lines.inputs[k] = inputs.len();
            let value = Rational::from_float(value).unwrap_or_else(Rational::zero);
            inputs.push(Parameter { name, value });
            between.push(Between::Held);
        }
    }
}

/// Gives each input that a motion follows its rate and its acceleration: the inputs `NAME_rate` and
/// `NAME_acceleration`, which are made where the model file has none. What is followed is smooth.
pub(super) fn follow_inputs(
    reader: &mut Reader<'_>,
    (bodies, drivers): (&mut [Body], &mut [Driver]),
    taken: &[&str],
    (inputs, between): (&mut Vec<Parameter>, &mut Vec<Between>),
) {
    let mut known: Vec<[usize; 3]> = Vec::new();
    for [place, rate, acceleration] in motions(bodies, drivers).flat_map(|(_, motion)| motion.inputs_mut()) {
        let of = known.iter().find(|of| of[0] == *place).copied().unwrap_or_else(|| {
            let mut own = |what: &str| {
                let name = format!("{}_{what}", inputs[*place].name);
                if let Some(place) = inputs.iter().position(|input| input.name == name) {
                    return place;
                }
                let name = unlike(&name, taken, inputs);
                inputs.push(Parameter { name, value: Rational::zero() });
                between.push(Between::Smooth);
                inputs.len() - 1
            };
            let of = [*place, own("rate"), own("acceleration")];
            refuse_corners(reader, of, inputs);
            of.iter().for_each(|&input| between[input] = Between::Smooth);
            known.push(of);
            of
        });
        [*place, *rate, *acceleration] = of;
    }
}

/// The velocity of what follows an input must not jump.
fn refuse_corners(reader: &mut Reader<'_>, of: [usize; 3], inputs: &[Parameter]) {
    for input in of {
        let Some((_, span)) = reader.corners.iter().find(|(index, _)| *index == input).cloned() else {
            continue;
        };
        let words = [
            format!("a motion follows the input `{}`, whose velocity would jump", inputs[of[0]].name),
            "not smooth".to_owned(),
            "write between = \"smooth\", or leave it out".to_owned(),
        ];
        reader.wrong(Place { owner: Owner::Input(input), key: "between" }, span, words);
    }
}

/// A name that nothing else has.
fn unlike(name: &str, taken: &[&str], inputs: &[Parameter]) -> String {
    let is_taken =
        |name: &String| taken.contains(&name.as_str()) || inputs.iter().any(|input| input.name == *name);
    let mut found = name.to_owned();
    for n in 2.. {
        if !is_taken(&found) {
            break;
        }
        found = format!("{name}_{n}");
    }
    found
}

/// How many inputs that will be.
pub(super) fn n_inputs((bodies, drivers): (&mut [Body], &mut [Driver])) -> usize {
    NAMES.len() * all(bodies, drivers).len()
}

/// All motions along straight lines, in the order of [`Model::lines`].
fn all<'m>(bodies: &'m mut [Body], drivers: &'m mut [Driver]) -> Vec<(&'m str, &'m mut Lines)> {
    let named = |(name, motion): (&'m str, &'m mut Motion)| {
        motion.lines_mut().into_iter().map(move |lines| (name, lines))
    };
    motions(bodies, drivers).flat_map(named).collect()
}

fn motions<'m>(
    bodies: &'m mut [Body],
    drivers: &'m mut [Driver],
) -> impl Iterator<Item = (&'m str, &'m mut Motion)> {
    let of_drivers = drivers.iter_mut().map(|Driver { name, motion, .. }| (name.as_str(), motion));
    let of_bodies = bodies.iter_mut().flat_map(|Body { name, motion, .. }| {
        motion.iter_mut().flat_map(BodyMotion::parts_mut).map(|motion| (name.as_str(), motion))
    });
    of_drivers.chain(of_bodies)
}
