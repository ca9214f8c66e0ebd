//! Rigid stops and friction that sticks.

use num_traits::Zero;
use toml::de::DeTable;

use super::couplings::NO_COORDINATE;
use super::numbers::number;
use super::reader::Reader;
use super::section::{Section, keyword};
use super::{names, parameters, references, tables};
use crate::diagnostics::Related;
use crate::validate::{Owner, Place};
use crate::{Contact, Force, ForceKind, Number, Parameter, Rational};

const KEYS: [&str; 8] =
    ["name", "joint", "coordinate", "lower", "upper", "restitution", "friction", "static_friction"];

/// Reads all contacts; their inputs come after so many others.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>, n_inputs: usize) -> Vec<Contact> {
    let tables = tables::tables(reader, page, "contact");
    let names = tables::names(reader, &tables, Owner::Contact, "contact");
    if let Some((span, _)) = tables.get(Contact::MOST) {
        let words = [
            format!("a model has at most {} contacts", Contact::MOST),
            format!("there are {}", tables.len()),
            "leave some out, or write them as [[force]] of kind \"stop\" and \"coulomb\", which are smooth"
                .to_owned(),
        ];
        reader.wrong(Place { owner: Owner::Contact(Contact::MOST), key: "" }, span.clone(), words);
    }
    let named = tables.iter().zip(names).enumerate();
    let contacts: Vec<Contact> = named
        .map(|(index, ((_, table), name))| {
            let name = name.unwrap_or_else(|| format!("contact {}", index + 1));
            contact(reader, (index, table), name, n_inputs + index)
        })
        .collect();
    for (index, contact) in contacts.iter().enumerate() {
        unlike_inputs(reader, index, contact);
        shared(reader, &contacts[..index], index, contact);
    }
    contacts
}

fn contact(
    reader: &mut Reader<'_>,
    (index, table): (usize, &DeTable<'_>),
    name: String,
    input: usize,
) -> Contact {
    let title = format!("contact `{name}`");
    let section = Section::open(reader, Owner::Contact(index), &title, table, &KEYS);
    let on = references::coordinate(reader, &section, &title).unwrap_or(NO_COORDINATE);
    let ends = ["lower", "upper"].map(|key| section.get(key).and_then(|item| number(reader, item)));
    let has_stops = section.has("lower") || section.has("upper");
    if !has_stops && !section.has("friction") && !section.has("static_friction") {
        let example = "upper = ..., in rad or m, lower = ..., or friction = ..., in N.m or N";
        section.require(reader, "upper", &title, example);
    }
    if has_stops {
        let example = "restitution = ..., from 0 to 1: the part of its rate with which the joint rebounds";
        section.require(reader, "restitution", &title, example);
    } else {
        let help = "remove it, or add lower = ... or upper = ..., in rad or m";
        section.refuse(reader, "restitution", &format!("{title} has no stop to rebound from"), help);
    }
    let kinetic = section.number_or(reader, "friction", 0);
    let at_rest = section.get("static_friction").and_then(|item| number(reader, item));
    Contact {
        name,
        on,
        ends,
        restitution: section.number_or(reader, "restitution", 0),
        levels: [kinetic.clone(), at_rest.unwrap_or(kinetic)],
        input,
    }
}

/// Its force is an input of its name.
fn unlike_inputs(reader: &mut Reader<'_>, index: usize, contact: &Contact) {
    let place = Place { owner: Owner::Contact(index), key: "name" };
    let span = reader.span(place);
    let name = &contact.name;
    if names::is_keyword(name) {
        reader.wrong(place, span, keyword(name));
    } else if reader.parameters.contains(name)
        || reader.inputs.contains(name)
        || parameters::OWN_FIELDS.contains(&name.as_str())
    {
        let words = [
            format!("`{name}` names a contact, and a parameter, an input or another field of the module"),
            "used again".to_owned(),
            "choose another name: the force of a contact is an input of its name".to_owned(),
        ];
        reader.wrong(place, span, words);
    }
}

/// What acts along one coordinate is one contact.
fn shared(reader: &mut Reader<'_>, earlier: &[Contact], index: usize, contact: &Contact) {
    let first = earlier.iter().position(|other| other.on == contact.on && contact.on != NO_COORDINATE);
    let Some(first) = first else { return };
    let place = |index| Place { owner: Owner::Contact(index), key: "joint" };
    let related = Related { span: reader.span(place(first)), label: "acts here".to_owned() };
    let span = reader.span(place(index));
    let words = [
        format!("contacts `{}` and `{}` act along one coordinate", earlier[first].name, contact.name),
        "acts here too".to_owned(),
        "write stops and friction of a coordinate in one [[contact]]".to_owned(),
    ];
    reader.clash(place(index), span, related, words);
}

impl Contact {
    /// The input that is its force.
    pub(super) fn own_input(&self) -> Parameter {
        Parameter { name: self.name.clone(), value: Rational::zero() }
    }

    /// The motor by which it acts.
    pub(super) fn own_force(&self) -> Force {
        let value = Number::Input { index: self.input, negated: false };
        Force { name: self.name.clone(), kind: ForceKind::Motor { on: self.on, value } }
    }
}
