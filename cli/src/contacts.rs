//! Rigid stops and friction that sticks, of a model as a run has them.

use crate::failure::Failure;
use crate::remarks;
use crate::words::number;
use gyro_model::{Contact, Model, RedundantRow, RowOwner, Touching, to_f64};
use gyro_runner::{Stop, Surfaces, Touch};
use std::fmt::Write as _;

/// The contacts of a model with its parameters as they are.
pub(crate) fn contacts(model: &Model) -> Vec<Touch> {
    let place =
        |output: usize| model.outputs[..output].iter().map(|output| output.kind.columns().len()).sum();
    let one = |contact: &Contact| {
        let end = |k: usize, none: f64| contact.ends[k].as_ref().map_or(none, |end| model.value(end));
        Touch::Stop(Stop {
            on: (contact.on.joint, contact.on.coordinate),
            input: contact.input,
            ends: [end(0, f64::NEG_INFINITY), end(1, f64::INFINITY)],
            // What the reader takes for one, or for the same, in spite of rounding.
            restitution: to_f64(&model.exact(&contact.restitution)).min(1.0),
            levels: in_order(contact.levels.each_ref().map(|level| model.value(level))),
            coefficients: in_order(contact.coefficients.each_ref().map(|coefficient| {
                contact.radius.as_ref().map_or(1.0, |radius| model.value(radius)) * model.value(coefficient)
            })),
            reaction: contact.reaction.map(place),
            seen: contact.seen.map(place),
        })
    };
    let surfaces = |touching: &Touching| {
        Touch::Surfaces(Surfaces {
            inputs: touching.inputs,
            outputs: touching.outputs.map(place),
            // What the reader takes for one in spite of rounding.
            restitution: to_f64(&model.exact(&touching.restitution)).min(1.0),
            is_of_impulses: touching.is_of_impulses,
            coefficients: in_order(touching.coefficients.each_ref().map(|number| model.value(number))),
        })
    };
    model.contacts.iter().map(one).chain(model.touching.iter().map(surfaces)).collect()
}

/// The name of one of them.
pub(crate) fn name(model: &Model, contact: usize) -> &str {
    let names = model.contacts.iter().map(|contact| &contact.name);
    names.chain(model.touching.iter().map(|one| &one.name)).nth(contact).map_or("", String::as_str)
}

/// A kinetic number, and a static one that is not below it.
fn in_order([kinetic, at_rest]: [f64; 2]) -> [f64; 2] {
    [kinetic, at_rest.max(kinetic)]
}

/// The contact of which an input is a force.
pub(crate) fn acting(model: &Model, input: usize) -> Option<&str> {
    let of = |contact: &Touch| contact.inputs().contains(&input);
    contacts(model).iter().position(of).map(|contact| name(model, contact))
}

/// Refuses a model with contacts.
pub(crate) fn refuse(model: &Model, what: &str) -> Result<(), Failure> {
    match Some(name(model, 0)).filter(|_| model.has_rigid_contacts()) {
        None => Ok(()),
        Some(first) => Err(Failure::Usage(format!(
            "{what} cannot have rigid stops or friction that sticks yet, and `{}` has the contact `{}`: write it as [[force]] \
             of kind \"stop\" or \"coulomb\", which are smooth",
            model.name, first
        ))),
    }
}

/// Refuses friction that depends on reactions which are not unique.
pub(crate) fn refuse_shared_reactions(model: &Model) -> Result<(), Failure> {
    for contact in &model.contacts {
        if contact.reaction.is_none() {
            continue;
        }
        let owner = RowOwner::Joint(contact.on.joint);
        let is_shared =
            |dropped: &&RedundantRow| dropped.row.owner == owner || dropped.shared_with.contains(&owner);
        let is_not_unique = remarks::not_unique(model, contact.on.joint).contains(&true);
        if is_not_unique && let Some(dropped) = model.redundant.iter().find(is_shared) {
            return Err(Failure::Usage(format!(
                "the friction of contact `{}` depends on the reaction of {}, which is not unique: {}; choose kinds of joints \
                 that leave free what others hold, or give friction a constant level",
                contact.name,
                remarks::owner(model, owner),
                remarks::describe(model, dropped)
            )));
        }
    }
    Ok(())
}

/// A line for each.
pub(crate) fn text(model: &Model) -> String {
    let mut text = String::new();
    for contact in contacts(model).iter().zip(&model.contacts) {
        let (Touch::Stop(touch), Contact { name, on, .. }) = contact else { continue };
        let _ = write!(text, "contact {name}: on joint {}", model.joints[on.joint].name);
        if touch.ends.iter().any(|end| end.is_finite()) {
            let [lower, upper] = touch.ends.map(|end| number(end, 6));
            let _ = write!(text, ", from {lower} to {upper}, restitution {}", number(touch.restitution, 6));
        }
        if touch.levels[1] > 0.0 {
            let [kinetic, at_rest] = touch.levels.map(|level| number(level, 6));
            let _ = write!(text, ", friction {kinetic}, static {at_rest}");
        }
        if touch.coefficients[1] > 0.0 {
            let [kinetic, at_rest] =
                contact.1.coefficients.each_ref().map(|number| self::number(model.value(number), 6));
            let _ = write!(text, ", coefficients of friction {kinetic}, static {at_rest}");
        }
        text.push('\n');
    }
    for one in &model.touching {
        let law = if one.is_of_impulses { " of impulses" } else { "" };
        let share = number(model.value(&one.restitution), 6);
        let [kinetic, at_rest] = one.coefficients.each_ref().map(|of| number(model.value(of), 6));
        let _ = writeln!(
            text,
            "contact {}: rigid, restitution {share}{law}, coefficients of friction {kinetic}, static {at_rest}",
            one.name
        );
    }
    text
}
