//! The model file as a whole: format, name, gravity and simulation.

use num_traits::One;
use toml::de::DeTable;

use super::lines;
use super::names;
use super::reader::Reader;
use super::section::{Section, keyword};
use super::{
    bodies, contacts, controllers, couplings, curves, elements, events, forces, joints, named_formulas,
    outputs, parameters, point_masses, seen, simulation, states,
};
use crate::keys::{ATTRACTION, FILE, GENERATE};
use crate::validate::{Owner, Place};
use crate::{Attraction, Between, Contact, Model, Number};

/// Reads everything. Where something is wrong the reader knows, and a default stands in the model.
pub(super) fn read(reader: &mut Reader<'_>, table: &DeTable<'_>) -> Model {
    reader.mark(Place { owner: Owner::Page, key: "" }, 0..0);
    let page = Section::open(reader, Owner::Page, "the model file", table, &FILE);
    format(reader, &page);
    let name = name(reader, &page);
    let parameters::Tables { parameters, derived, mut inputs, mut between } = parameters::read(reader, &page);
    let (gravity, attraction) = gravity(reader, &page);
    let counts_work = page.flag(reader, "count_work");
    let functions = functions(reader, &page);
    let simulation = simulation::read(reader, &page);
    curves::read(reader, &page);
    let (mut bodies, point_masses): (Vec<_>, Vec<_>) = bodies::read(reader, &page).into_iter().unzip();
    let joints = joints::read(reader, &page);
    let couplings = couplings::open(reader, &page);
    let mut drivers = couplings::drivers(reader, &page);
    let sections = forces::open(reader, &page);
    let taken = parameters.iter().map(|p| p.name.as_str()).chain(parameters::OWN_FIELDS);
    let taken: Vec<&str> = taken.chain(derived.iter().map(|p| p.name.as_str())).collect();
    lines::follow_inputs(reader, (&mut bodies, &mut drivers), &taken, (&mut inputs, &mut between));
    let n_inputs = inputs.len() + lines::n_inputs((&mut bodies, &mut drivers));
    let (mut contacts, surfaces, mut touching) = contacts::read(reader, &page, n_inputs);
    let taken = contacts.iter().map(|contact| &contact.name).chain(parameters.iter().map(|p| &p.name));
    let taken: Vec<&str> = taken.map(String::as_str).chain(parameters::OWN_FIELDS).collect();
    lines::add_inputs((&mut bodies, &mut drivers), &taken, (&mut inputs, &mut between));
    for contact in &contacts {
        inputs.push(contact.own_input());
        between.push(Between::default());
    }
    let named = contacts.iter().map(|contact| Some(contact.name.clone()));
    reader.names.entry("force").or_default().extend(named);
    let (mut outputs, pending) = outputs::read(reader, &page);
    contacts::observe(&mut touching, &outputs);
    contacts::loads(reader, &mut contacts, &joints, &mut outputs);
    let states = states::open(reader, &page, &mut outputs);
    reader.visible = seen::known(reader, &outputs);
    reader.outputs = outputs.iter().map(|output| output.kind.clone()).collect();
    named_formulas::read(reader, &page);
    let couplers = couplings::couplers(reader, couplings);
    let elements = elements::read(reader, &page, surfaces);
    outputs::read_formulas(reader, pending, &mut outputs);
    let mut forces = forces::read(reader, sections);
    forces.extend(contacts.iter().map(Contact::own_force));
    let states = states::read(reader, states);
    let controllers = controllers::read(reader, &page, &outputs);
    let events = events::read(reader, &page, &outputs);
    let redundant = Vec::new();
    let mut model = Model {
        name,
        gravity,
        attraction,
        parameters,
        derived_parameters: derived,
        inputs,
        between,
        bodies,
        joints,
        couplers,
        drivers,
        forces,
        elements,
        curves: std::mem::take(&mut reader.curves),
        formulas: std::mem::take(&mut reader.formulas),
        states,
        outputs,
        controllers,
        events,
        contacts,
        touching,
        redundant,
        counts_work,
        functions,
        remarks: std::mem::take(&mut reader.remarks),
        simulation,
    };
    point_masses::add(&mut model, &point_masses);
    states::remark_unread(&mut model);
    model
}

fn format(reader: &mut Reader<'_>, page: &Section<'_>) {
    let version = page.plain(reader, "format");
    let item = page.get("format").filter(|_| version.is_some_and(|version| !version.is_one()));
    if let Some(item) = item {
        let words = ["unknown format", "only format 1 is supported", "write format = 1"];
        item.wrong(reader, words.map(str::to_owned));
    }
}

fn name(reader: &mut Reader<'_>, page: &Section<'_>) -> String {
    let Some(item) = page.find(reader, "name") else { return String::new() };
    let name = item.name(reader).unwrap_or_default();
    if names::is_keyword(name) {
        item.wrong(reader, keyword(name));
    }
    name.to_owned()
}

/// Gravity that is the same everywhere, or what attracts in its place.
fn gravity(reader: &mut Reader<'_>, page: &Section<'_>) -> ([Number; 3], Option<Attraction>) {
    let table = page.get("gravity").filter(|item| item.value.get_ref().is_table());
    let Some(item) = table else { return (page.vector(reader, "gravity"), None) };
    let attraction = Section::within(reader, item, "gravity", &ATTRACTION).map(|section| Attraction {
        mu: section.number(reader, "mu"),
        centre: section.vector(reader, "centre"),
    });
    (std::array::from_fn(|_| Number::integer(0)), attraction)
}

/// The names of the functions to be generated: which there are is the generator's to know.
fn functions(reader: &mut Reader<'_>, page: &Section<'_>) -> Option<Vec<String>> {
    let table = page.get("generate")?.table(reader)?;
    let section = Section::open(reader, Owner::Page, "[generate]", table, &GENERATE);
    let names = section.get("functions")?.texts(reader, "an array of names")?;
    Some(names.into_iter().map(|(_, name)| name.to_owned()).collect())
}
