//! Ranges of numbers, as the table of keys has them.

use std::slice::from_ref;

use num_traits::{Signed, Zero};

use super::inertia::is_left_out;
use super::{Owner, ParameterRule, Place, Problem, shown};
use crate::keys::{
    ATTRACTION, BODY, CONTACT, CONTROLLER, COUPLER, ELEMENT, FORCE, JOINT, Key, ROLLING, Range,
};
use crate::{
    Attraction, Body, Contact, Controller, Coupler, Element, Force, Joint, JointKind, Model, Number, Rational,
};

/// The message for a number that is out of its key's range.
pub(crate) fn out_of_range(key: &Key, title: &str, value: &Rational) -> Option<[String; 3]> {
    let (holds, is, than, why) = match key.range {
        Range::Any => return None,
        Range::Positive(why) => (value.is_positive(), "not positive", "greater than 0", why),
        Range::NotNegative(why) => (!value.is_negative(), "negative", "of 0 or more", why),
        Range::NotZero(why) => (!value.is_zero(), "0", "other than 0", why),
    };
    let name = if key.name.contains('_') { format!("`{}`", key.name) } else { key.name.to_owned() };
    // A key of two units is of either kind of coordinate.
    let unit = key.unit().filter(|unit| !unit.contains(" or "));
    let after =
        |before: &str, unit: Option<&str>| unit.map_or_else(String::new, |unit| format!("{before}{unit}"));
    let why = if why.is_empty() { String::new() } else { format!(": {why}") };
    (!holds).then(|| {
        [
            format!("the {name} of {title} is {is}"),
            format!("{}{}{why}", shown(value), after(" ", unit)),
            format!("write a number {than}{}", after(", in ", unit)),
        ]
    })
}

/// Numbers of one thing that have ranges.
pub(super) struct Ranged<'m> {
    owner: Owner,
    title: String,
    numbers: Vec<(&'static Key, &'m Number)>,
}

impl<'m> Ranged<'m> {
    fn new(
        (owner, title): (Owner, String),
        keys: impl IntoIterator<Item = &'static Key> + Clone,
        numbers: impl IntoIterator<Item = (&'static str, &'m Number)>,
    ) -> Self {
        let key = |name| keys.clone().into_iter().find(|key| key.name == name && key.range != Range::Any);
        // Of formulas it is not known before they move.
        let numbers = numbers.into_iter().filter(|(_, number)| number.formula().is_none());
        let numbers = numbers.filter_map(|(name, number)| Some((key(name)?, number)));
        Self { owner, title, numbers: numbers.collect() }
    }

    pub(super) fn of_attraction(attraction: &'m Attraction) -> Self {
        Self::new((Owner::Page, "gravity".to_owned()), ATTRACTION.keys, [("mu", &attraction.mu)])
    }

    pub(super) fn of_body(index: usize, body: &'m Body) -> Self {
        let mass = Some(("mass", &body.mass)).filter(|(_, mass)| !is_left_out(body, from_ref(*mass)));
        Self::new((Owner::Body(index), format!("body `{}`", body.name)), BODY.keys, mass)
    }

    pub(super) fn of_joint(index: usize, joint: &'m Joint) -> Self {
        let keys = JOINT.kind(joint.kind.name()).map_or(&[][..], |kind| kind.keys);
        let Joint { damping, armature, lead, length, .. } = joint;
        let numbers = [("damping", damping), ("armature", armature), ("lead", lead), ("length", length)];
        let title = match joint.kind {
            JointKind::Screw | JointKind::Rod => format!("{} `{}`", joint.kind.name(), joint.name),
            _ => format!("joint `{}`", joint.name),
        };
        Self::new((Owner::Joint(index), title), keys, numbers)
    }

    pub(super) fn of_coupler(index: usize, coupler: &'m Coupler) -> Self {
        let title = format!("{} `{}`", coupler.word(), coupler.name);
        let ratio = coupler.linear().map(|(_, ratio, _)| ("ratio", ratio));
        Self::new((Owner::Coupler(index), title), COUPLER.keys, ratio)
    }

    pub(super) fn of_force(index: usize, force: &'m Force) -> Self {
        let parts = force.kind.parts();
        let keys = FORCE.kind(parts.word).map_or(&[][..], |kind| kind.keys);
        let numbers = parts.numbers.into_iter();
        let numbers = numbers.flat_map(|(name, numbers)| numbers.iter().map(move |number| (name, number)));
        Self::new((Owner::Force(index), format!("force `{}`", force.name)), keys, numbers)
    }

    pub(super) fn of_element(index: usize, element: &'m Element) -> Self {
        let tables = [&ELEMENT, &ROLLING, &CONTACT];
        let table = tables.into_iter().find(|table| table.name == element.table).unwrap_or(&ELEMENT);
        let keys = table.kind(element.kind).map_or(table.keys, |kind| kind.keys);
        let numbers = element.numbers.iter().map(|(name, number)| (*name, number));
        Self::new((Owner::Element(index), format!("{} `{}`", table.name, element.name)), keys, numbers)
    }

    pub(super) fn of_controller(index: usize, controller: &'m Controller) -> Self {
        let steps = controller.output_steps.iter().map(|step| ("output_step", step));
        let steps = steps.chain([("input_step", &controller.input_step)]);
        let title = format!("controller `{}`", controller.name);
        Self::new((Owner::Controller(index), title), CONTROLLER.keys, steps)
    }

    pub(super) fn of_contact(index: usize, contact: &'m Contact) -> Self {
        let [friction, coefficient] = [&contact.levels[0], &contact.coefficients[0]];
        let numbers = [("friction", friction), ("friction_coefficient", coefficient)];
        let numbers = numbers.into_iter().chain(contact.radius.iter().map(|radius| ("radius", radius)));
        Self::new((Owner::Contact(index), format!("contact `{}`", contact.name)), CONTACT.keys, numbers)
    }

    /// Those that are out of range.
    pub(super) fn problems(self, model: &Model) -> Vec<Problem> {
        let wrong = self.numbers.iter().filter_map(|(key, number)| {
            let [message, label, help] = out_of_range(key, &self.title, &model.exact(number))?;
            Some(Problem::new(Place { owner: self.owner, key: key.name }, message, label, help))
        });
        wrong.collect()
    }

    /// What must hold of them.
    pub(super) fn rules(self) -> impl Iterator<Item = ParameterRule<'m>> {
        self.numbers.into_iter().filter_map(|(key, number)| match key.range {
            Range::Any => None,
            Range::Positive(_) => Some(ParameterRule::Positive(number)),
            Range::NotNegative(_) => Some(ParameterRule::NotNegative(number)),
            Range::NotZero(_) => Some(ParameterRule::NotZero(from_ref(number))),
        })
    }
}
