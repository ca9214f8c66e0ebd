//! The model file as a whole: format, name, gravity and simulation.

use num_traits::One;
use toml::de::DeTable;

use super::lines;
use super::names;
use super::numbers::plain_number;
use super::reader::Reader;
use super::section::{Section, keyword};
use super::{
    bodies, contacts, controllers, couplings, events, forces, joints, outputs, parameters, point_masses,
    simulation,
};
use crate::validate::{Owner, Place};
use crate::{Between, Model};

const KEYS: [&str; 17] = [
    "format",
    "name",
    "gravity",
    "count_work",
    "simulation",
    "generate",
    "parameters",
    "inputs",
    "body",
    "joint",
    "coupler",
    "driver",
    "force",
    "output",
    "controller",
    "event",
    "contact",
];

/// Reads everything. Where something is wrong the reader knows, and a default stands in the model.
pub(super) fn read(reader: &mut Reader<'_>, table: &DeTable<'_>) -> Model {
    reader.mark(Place { owner: Owner::Page, key: "" }, 0..0);
    let page = Section::open(reader, Owner::Page, "the model file", table, &KEYS);
    format(reader, &page);
    let name = name(reader, &page);
    let parameters::Tables { parameters, derived, mut inputs, mut between } = parameters::read(reader, &page);
    let gravity = page.vector_or(reader, "gravity", [0; 3]);
    let counts_work = page.get("count_work").and_then(|item| item.flag(reader)).unwrap_or(true);
    let functions = functions(reader, &page);
    let simulation = simulation::read(reader, &page);
    let (mut bodies, point_masses): (Vec<_>, Vec<_>) = bodies::read(reader, &page).into_iter().unzip();
    let joints = joints::read(reader, &page);
    let couplers = couplings::couplers(reader, &page);
    let mut drivers = couplings::drivers(reader, &page);
    let mut forces = forces::read(reader, &page);
    let n_inputs = inputs.len() + lines::n_inputs((&mut bodies, &mut drivers));
    let mut contacts = contacts::read(reader, &page, n_inputs);
    let taken = contacts.iter().map(|contact| &contact.name).chain(parameters.iter().map(|p| &p.name));
    let taken: Vec<&str> = taken.map(String::as_str).chain(parameters::OWN_FIELDS).collect();
    lines::add_inputs((&mut bodies, &mut drivers), &taken, (&mut inputs, &mut between));
    for contact in &contacts {
        inputs.push(contact.own_input());
        between.push(Between::default());
        forces.push(contact.own_force());
    }
    let mut outputs = outputs::read(reader, &page, &forces);
    contacts::loads(reader, &mut contacts, &joints, &mut outputs);
    let controllers = controllers::read(reader, &page, &outputs);
    let events = events::read(reader, &page, &outputs);
    let redundant = Vec::new();
    let mut model = Model {
        name,
        gravity,
        parameters,
        derived_parameters: derived,
        inputs,
        between,
        bodies,
        joints,
        couplers,
        drivers,
        forces,
        outputs,
        controllers,
        events,
        contacts,
        redundant,
        counts_work,
        functions,
        remarks: std::mem::take(&mut reader.remarks),
        simulation,
    };
    point_masses::add(&mut model, &point_masses);
    model
}

fn format(reader: &mut Reader<'_>, page: &Section<'_>) {
    let Some(item) = page.require(reader, "format", "the model file", "format = 1 at the top") else {
        return;
    };
    let version = plain_number(reader, item);
    if version.is_some_and(|version| !version.is_one()) {
        let words = ["unknown format", "only format 1 is supported", "write format = 1"];
        item.wrong(reader, words.map(str::to_owned));
    }
}

fn name(reader: &mut Reader<'_>, page: &Section<'_>) -> String {
    let example = "name = \"some_name\", the name of the generated module";
    let Some(item) = page.require(reader, "name", "the model file", example) else { return String::new() };
    let name = item.name(reader).unwrap_or_default();
    if names::is_keyword(name) {
        item.wrong(reader, keyword(name));
    }
    name.to_owned()
}

/// The names of the functions to be generated: which there are is the generator's to know.
fn functions(reader: &mut Reader<'_>, page: &Section<'_>) -> Option<Vec<String>> {
    let example = "[generate] on a line of its own, then functions = [\"joint\"]";
    let table = page.get("generate")?.table(reader, example)?;
    let section = Section::open(reader, Owner::Page, "[generate]", table, &["functions"]);
    let item = section.get("functions")?;
    let names = item.value.get_ref().as_array().map(|array| {
        array.iter().map(|name| name.get_ref().as_str().map(str::to_owned)).collect::<Option<Vec<_>>>()
    });
    let names = names.flatten();
    if names.is_none() {
        item.wrong_type(reader, "an array of names", "functions = [\"joint\", \"jacobian\"]");
    }
    names
}
