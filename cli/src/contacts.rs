//! Rigid stops and friction that sticks, of a model as a run has them.

use crate::failure::Failure;
use crate::remarks;
use crate::words::{count, number};
use gyro_model::{Contact, Model, RedundantRow, RowOwner, to_f64};
use gyro_runner::Touch;
use std::fmt::Write as _;

/// The contacts of a model with its parameters as they are.
pub(crate) fn contacts(model: &Model) -> Vec<Touch> {
    let one = |contact: &Contact| {
        let end = |k: usize, none: f64| contact.ends[k].as_ref().map_or(none, |end| model.value(end));
        Touch {
            on: (contact.on.joint, contact.on.coordinate),
            input: contact.input,
            ends: [end(0, f64::NEG_INFINITY), end(1, f64::INFINITY)],
            // What the reader takes for one, or for the same, in spite of rounding.
            restitution: to_f64(&model.exact(&contact.restitution)).min(1.0),
            levels: in_order(contact.levels.each_ref().map(|level| model.value(level))),
            coefficients: in_order(contact.coefficients.each_ref().map(|coefficient| {
                contact.radius.as_ref().map_or(1.0, |radius| model.value(radius)) * model.value(coefficient)
            })),
            reaction: contact
                .reaction
                .map(|output| model.outputs[..output].iter().map(|output| output.kind.columns().len()).sum()),
        }
    };
    model.contacts.iter().map(one).collect()
}

/// A kinetic number, and a static one that is not below it.
fn in_order([kinetic, at_rest]: [f64; 2]) -> [f64; 2] {
    [kinetic, at_rest.max(kinetic)]
}

/// The contact whose force an input is.
pub(crate) fn acting(model: &Model, input: usize) -> Option<&Contact> {
    model.contacts.iter().find(|contact| contact.input == input)
}

/// Says that what is made of a model has none of its contacts.
pub(crate) fn say_left_out(model: &Model, what: &str) {
    if !model.contacts.is_empty() {
        remarks::warn(&format!(
            "{what} leaves out {} of the model file: the forces are inputs, the caller's to set",
            count(model.contacts.len() as u64, "contact")
        ));
    }
}

/// Refuses a model with contacts.
pub(crate) fn refuse(model: &Model, what: &str) -> Result<(), Failure> {
    match model.contacts.first() {
        None => Ok(()),
        Some(first) => Err(Failure::Usage(format!(
            "{what} cannot have rigid stops or friction that sticks yet, and `{}` has the contact `{}`: write it as [[force]] \
             of kind \"stop\" or \"coulomb\", which are smooth",
            model.name, first.name
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
        let (touch, Contact { name, on, .. }) = contact;
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
    text
}
