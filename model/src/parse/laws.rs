//! Strengths of forces: formulas of coordinates, rates, time, inputs and of outputs of position and velocity.

use std::sync::Arc;

use super::computed::Fault;
use super::formulas::{Inputs, Named};
use super::lookup::{named, wrong_within};
use super::reader::Reader;
use super::section::Item;
use super::seen::Known;
use super::{names, seen};
use crate::{Number, Operation, OutputKind, Seen};

/// The strength that a text denotes.
pub(super) fn strength(reader: &mut Reader<'_>, item: Item<'_>, text: &str) -> Option<Number> {
    let known = known(reader, item);
    let kinds = reader.outputs.clone();
    let is_energy = item.key.name == "energy";
    let refuse = |name: &str, seen: Seen| match (item.key.name, seen) {
        ("energy", Seen::Coordinate(_)) | ("power", Seen::Coordinate(_) | Seen::Rate(_) | Seen::Time) => None,
        // What is sampled is known by then.
        ("setpoint", _) => None,
        ("energy", _) => Some(beside_coordinates(name)),
        ("power", _) => Some(beside_rates(name)),
        (key, _) => {
            refused(&kinds, if key == "rate" { "the rate of a state" } else { "a force" }, (name, seen))
        }
    };
    let inputs = if is_energy { Inputs::Unknown } else { Inputs::Known };
    match with_names(reader, &known, inputs, &refuse, |named| named.formula(text)) {
        Ok(formula) => Some(match formula.operations.as_slice() {
            [Operation::Number(number)] => number.clone(),
            _ => Number::Formula(Arc::new(formula)),
        }),
        Err(_) if is_name(text) => {
            seen::named(reader, item, text, &known);
            None
        }
        Err(fault) => {
            wrong_within(reader, item, text, fault);
            None
        }
    }
}

fn beside_coordinates(name: &str) -> [String; 3] {
    [
        format!("an energy cannot depend on `{name}`"),
        "not a joint coordinate".to_owned(),
        "write a formula of joint coordinates and parameters: what depends on rates, time or inputs stores no energy"
            .to_owned(),
    ]
}

fn beside_rates(name: &str) -> [String; 3] {
    [
        format!("a lost power cannot depend on `{name}`"),
        "neither a joint coordinate nor its rate".to_owned(),
        "write a formula of rates, joint coordinates, time, parameters and inputs".to_owned(),
    ]
}

/// Whether a name in place of a strength is one of what moves, or that of a formula.
pub(super) fn is_meant(reader: &Reader<'_>, item: Item<'_>, name: &str) -> bool {
    let known = known(reader, item);
    name == "t"
        || reader.formulas.iter().any(|(formula, _)| formula == name)
        || reader.has_joint(name)
        || names::column(name, known.iter().map(|(known, _)| known.as_str())).is_some()
}

/// What a formula under a key may name.
fn known(reader: &Reader<'_>, item: Item<'_>) -> Known {
    let own = item.key.own.iter().map(|(name, seen)| ((*name).to_owned(), *seen));
    own.chain(reader.visible.iter().cloned()).collect()
}

/// Forces are known before accelerations are: outputs of these are nothing that a force may depend on.
fn refused(kinds: &[OutputKind], what: &str, (name, seen): (&str, Seen)) -> Option<[String; 3]> {
    let Seen::Output { output, number } = seen else { return None };
    let is_early = match kinds.get(output)? {
        OutputKind::Pose(_)
        | OutputKind::Velocity(_)
        | OutputKind::Relative(_)
        | OutputKind::State { .. } => true,
        OutputKind::Inertial(_) => number >= 3,
        OutputKind::Link { .. } => number >= 1,
        OutputKind::Bushing { .. } => number < 6,
        _ => false,
    };
    (!is_early).then(|| {
        [
            format!("{what} cannot depend on `{name}`"),
            "known only once all forces are".to_owned(),
            "name a joint coordinate, its rate, a state, or a number of an output of position or velocity; an \
             [[output]] tells accelerations and reactions"
                .to_owned(),
        ]
    })
}

/// Whether a text is a single name, with blanks and dots as columns have them.
pub(super) fn is_name(text: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || "_.- ".contains(c);
    text.chars().all(is_part) && !text.starts_with(|c: char| c.is_ascii_digit()) && !text.contains(" - ")
}

/// What reads a formula, with the names that the model file gives to numbers.
pub(super) fn with_names<T>(
    reader: &Reader<'_>,
    columns: &Known,
    inputs: Inputs,
    refuse: &dyn Fn(&str, Seen) -> Option<[String; 3]>,
    read: impl FnOnce(&Named<'_>) -> Result<T, Fault>,
) -> Result<T, Fault> {
    let (known, refused): (&[String], &[String]) = match inputs {
        Inputs::Known => (&reader.inputs, &[]),
        Inputs::Unknown => (&[], &reader.inputs),
    };
    let input = |name: &str| {
        let index = known.iter().position(|input| input == name);
        index.map(|index| Number::Input { index, negated: false })
    };
    let number = |name: &str| named(reader, name).or_else(|| input(name));
    let derived = reader.derived.iter().map(|(name, _)| name);
    let numbers: Vec<&str> =
        reader.parameters.iter().chain(derived).chain(known).map(String::as_str).collect();
    read(&Named {
        columns,
        number: &number,
        numbers: &numbers,
        inputs,
        refused_inputs: refused,
        formulas: &reader.formulas,
        curves: &reader.curves,
        refuse,
    })
}
