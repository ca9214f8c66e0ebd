//! Rigid stops and friction that sticks.

use num_traits::{One, Signed, Zero};

use super::reader::Reader;
use super::references::{self, NO_COORDINATE};
use super::section::{Item, Section, keyword};
use super::{names, parameters, tables};
use crate::diagnostics::Related;
use crate::keys::{CONTACT, CONTACT_SIDE};
use crate::validate::{Owner, Place};
use crate::{
    Contact, Coupler, Element, Force, ForceKind, Formula, Joint, Model, Number, Output, OutputKind,
    Parameter, Rational, Seen, Touching, Tree,
};

/// Reads all contacts: those on joint coordinates, whose inputs come after so many others, and those between bodies,
/// which are elements.
pub(super) fn read(
    reader: &mut Reader<'_>,
    page: &Section<'_>,
    n_inputs: usize,
) -> (Vec<Contact>, Vec<Element>, Vec<Touching>) {
    let written = page.get("contact").into_iter().flat_map(Item::elements);
    let mut counts = [0; 2];
    let owners = written.map(|item| {
        let is_between = item.value.get_ref().as_table().is_some_and(|table| table.contains_key("between"));
        let count = &mut counts[usize::from(is_between)];
        *count += 1;
        if is_between { Owner::Element(*count - 1) } else { Owner::Contact(*count - 1) }
    });
    let owners: Vec<Owner> = owners.collect();
    let owner = |index: usize| owners.get(index).copied().unwrap_or(Owner::Contact(index));
    let (mut contacts, mut between, mut touching): (Vec<Contact>, _, _) =
        (Vec::new(), Vec::new(), Vec::new());
    for (section, name) in tables::each(reader, page, "contact", owner) {
        if section.has("between") {
            let (element, points) = surfaces(reader, &section, page, name);
            between.push(element);
            touching.extend(points);
        } else {
            contacts.push(contact(reader, &section, name, n_inputs + contacts.len()));
        }
    }
    for (index, contact) in contacts.iter().enumerate() {
        unlike_inputs(reader, index, contact);
        shared(reader, &contacts[..index], index, contact);
    }
    (contacts, between, touching)
}

/// The keys of contacts on joint coordinates alone.
const ON_JOINTS: [&str; 7] =
    ["joint", "coordinate", "lower", "upper", "friction", "static_friction", "radius"];

/// The keys of contacts between bodies that yield.
const YIELDING: [&str; 5] = ["stiffness", "exponent", "damping", "stribeck_rate", "rate"];

/// What acts between bodies; the model has it as outputs, formulas and forces.
fn surfaces(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    page: &Section<'_>,
    name: String,
) -> (Element, Vec<Touching>) {
    let mut touching = Vec::new();
    let message = format!("{} is between bodies", section.title);
    for key in ON_JOINTS {
        section.refuse(reader, key, &message, "remove it: it is for contacts on a joint coordinate");
    }
    let mut numbers = Vec::new();
    let is_rigid = section.has("restitution");
    if is_rigid {
        let message = format!("{} is rigid: it has a restitution", section.title);
        for key in YIELDING {
            section.refuse(reader, key, &message, "remove it, or `restitution`: surfaces yield or are rigid");
        }
    } else {
        section.require(reader, "stiffness");
        let message = format!("{} is not rigid: it has no restitution", section.title);
        section.refuse(reader, "impact_law", &message, "remove it: nothing hits where surfaces yield");
    }
    if ["static_friction_coefficient", "stribeck_rate", "rate"].iter().any(|key| section.has(key)) {
        section.require(reader, "friction_coefficient");
    }
    const OF_BOTH: [&str; 3] = ["friction_coefficient", "static_friction_coefficient", "restitution"];
    for key in OF_BOTH.into_iter().chain(YIELDING) {
        if section.has(key) {
            numbers.push((key, section.number(reader, key)));
        }
    }
    if let [("friction_coefficient", Number::Exact(kinetic)), (_, Number::Exact(at_rest)), ..] = &numbers[..]
        && at_rest < kinetic
        && let Some(item) = section.get("static_friction_coefficient")
    {
        let message = format!("the static coefficient of {} is below the kinetic one", section.title);
        item.wrong(reader, [message, "is less".to_owned(), "write one that is not less".to_owned()]);
    }
    let restitution = numbers.iter().find(|(key, _)| *key == "restitution");
    if let (Some((_, Number::Exact(share))), Some(item)) = (restitution, section.get("restitution"))
        && (share.is_negative() || *share > Rational::one())
    {
        let message = format!("the restitution of {} is not between 0 and 1", section.title);
        let help = "write the part with which what hits rebounds: 0 for none, 1 for all";
        item.wrong(reader, [message, "not such a part".to_owned(), help.to_owned()]);
    }
    if let Some(item) = section.get("between")
        && item.tables(reader).len() == item.elements().count()
    {
        for (item, _) in item.tables(reader) {
            if let Some(side) = Section::within(reader, item, "a side of a contact", &CONTACT_SIDE) {
                references::index(reader, &side, "body");
                side.get("shape").and_then(|item| item.text(reader));
            }
        }
        match super::surfaces::pairs(page.table(), section.table()) {
            Ok(pairs) => {
                let words = |[one, other]: &[&str; 2]| {
                    format!(
                        "contact `{name}`: nothing is known of how a {one} touches a {other}: they pass through each other"
                    )
                };
                reader.remarks.extend(pairs.pass.iter().map(words));
                if is_rigid {
                    let one = |name| rigid(reader, section, name);
                    touching.extend(pairs.touch.iter().flat_map(super::surfaces::touching).map(one));
                }
            }
            Err(words) => item.wrong(reader, words),
        }
    }
    (Element { name, kind: "", table: CONTACT.name, numbers }, touching)
}

/// A point at which rigid surfaces touch; where its numbers are among the outputs is found out when these are read.
fn rigid(reader: &mut Reader<'_>, section: &Section<'_>, name: String) -> Touching {
    let forces = super::surfaces::forces(&name);
    let input = |name: &String| reader.inputs.iter().position(|input| input == name).unwrap_or(0);
    let inputs = forces.each_ref().map(input);
    let kinetic = section.number(reader, "friction_coefficient");
    let at_rest = section.given(reader, "static_friction_coefficient").unwrap_or_else(|| kinetic.clone());
    let is_of_impulses =
        section.get("impact_law").and_then(|item| item.text(reader)).is_some_and(|law| law == "poisson");
    let restitution = section.number(reader, "restitution");
    Touching { name, restitution, is_of_impulses, coefficients: [kinetic, at_rest], inputs, outputs: [0; 7] }
}

/// What the prelude has of each point, as [`Touching::outputs`].
const OBSERVED: [&str; 7] = [
    "clearance",
    "parting",
    "parting_rate",
    "slips_along",
    "slips_along_rate",
    "slips_across",
    "slips_across_rate",
];

/// Finds the numbers of rigid surfaces among the outputs.
pub(super) fn observe(touching: &mut [Touching], outputs: &[Output]) {
    for one in touching {
        one.outputs = OBSERVED.map(|what| {
            let name = format!("{}_{what}", one.name);
            outputs.iter().position(|output| output.name == name).unwrap_or(0)
        });
    }
}

fn contact(reader: &mut Reader<'_>, section: &Section<'_>, name: String, input: usize) -> Contact {
    const LEVELS: [&str; 2] = ["friction", "static_friction"];
    const COEFFICIENTS: [&str; 2] = ["friction_coefficient", "static_friction_coefficient"];
    section.require(reader, "joint");
    let on = references::coordinate(reader, section);
    let message = format!("{} is on a joint", section.title);
    for key in YIELDING.into_iter().chain(["impact_law"]) {
        section.refuse(reader, key, &message, "remove it: it is for contacts between bodies");
    }
    let ends = ["lower", "upper"].map(|key| section.given(reader, key));
    let has_stops = section.has("lower") || section.has("upper");
    if !has_stops && !LEVELS.iter().chain(&COEFFICIENTS).any(|key| section.has(key)) {
        section.require(reader, "upper");
    }
    if has_stops {
        section.require(reader, "restitution");
    } else {
        let help = "remove it, or add lower = ... or upper = ..., in rad or m";
        let message = format!("{} has no stop to rebound from", section.title);
        section.refuse(reader, "restitution", &message, help);
    }
    let [levels, coefficients] = [LEVELS, COEFFICIENTS].map(|[moving, resting]| {
        let kinetic = section.number(reader, moving);
        [kinetic.clone(), section.given(reader, resting).unwrap_or(kinetic)]
    });
    Contact {
        name,
        on,
        ends,
        restitution: section.number(reader, "restitution"),
        levels,
        coefficients,
        radius: section.given(reader, "radius"),
        reaction: None,
        input,
        seen: None,
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

/// Radii of bearings, which friction about an axis needs, and outputs of the reactions on which friction depends: those
/// that the model file has, or new ones of the contacts' names.
pub(super) fn loads(
    reader: &mut Reader<'_>,
    contacts: &mut [Contact],
    joints: &[Joint],
    outputs: &mut Vec<Output>,
) {
    for (index, contact) in contacts.iter_mut().enumerate() {
        let Some(joint) = joints.get(contact.on.joint) else { continue };
        let kind = joint.kind.coordinates().get(contact.on.coordinate);
        radius(reader, index, contact, kind.is_some_and(|kind| kind.is_angle()));
        if contact.coefficients.iter().all(Number::is_zero) {
            continue;
        }
        let is_own = |output: &Output| matches!(output.kind, OutputKind::Reaction { joint } if joint == contact.on.joint);
        let found = outputs.iter().position(is_own);
        if found.is_none() {
            if outputs.iter().any(|output| output.name == contact.name) {
                let place = Place { owner: Owner::Contact(index), key: "name" };
                let words = [
                    format!("`{}` names a contact, and an output", contact.name),
                    "used again".to_owned(),
                    "choose another name: the reaction on which friction depends is an output of its name"
                        .to_owned(),
                ];
                let span = reader.span(place);
                reader.wrong(place, span, words);
            }
            let kind = OutputKind::Reaction { joint: contact.on.joint };
            outputs.push(Output { name: contact.name.clone(), kind });
        }
        contact.reaction = found.or(outputs.len().checked_sub(1));
    }
}

/// Has coordinates seen, by outputs, of contacts on joints that close loops, or on what a coupler ties.
pub(super) fn watch(model: &mut Model) {
    let (cut, known) = (Tree::of_coordinates(model).loop_joints, model.visible());
    let named = |seen: Seen| {
        let name = known.iter().find(|(_, other)| *other == seen).map_or("", |(name, _)| name.as_str());
        Formula::seen(name, seen)
    };
    for index in 0..model.contacts.len() {
        let Contact { on, ref name, .. } = model.contacts[index];
        let ties = |coupler: &Coupler| coupler.second.is_some() && coupler.coordinates().contains(&on);
        if !cut.contains(&on.joint) && !model.couplers.iter().any(ties) {
            continue;
        }
        let [value, rate] = [Seen::Coordinate(on), Seen::Rate(on)].map(named);
        let watched = [
            ("is_at", OutputKind::Formula(value)),
            ("moves", OutputKind::Formula(rate.clone())),
            ("moves_rate", OutputKind::Rate(rate)),
        ];
        let first = model.outputs.len();
        for (what, kind) in watched {
            let mut name = format!("{name}_{what}");
            while model.outputs.iter().any(|output| output.name == name) {
                name.push('_');
            }
            model.outputs.push(Output { name, kind });
        }
        model.contacts[index].seen = Some(first);
    }
}

/// A bearing's radius is needed about an axis, and has no meaning along one.
fn radius(reader: &mut Reader<'_>, index: usize, contact: &Contact, is_angle: bool) {
    let is_loaded = contact.coefficients.iter().any(|coefficient| !coefficient.is_zero());
    let place = |key| Place { owner: Owner::Contact(index), key };
    let name = &contact.name;
    let (place, words) = match (&contact.radius, is_loaded, is_angle) {
        (None, true, true) => (
            place("name"),
            [
                format!("contact `{name}` has no `radius`"),
                "needs `radius`".to_owned(),
                "write radius = ..., that of the bearing in m: friction acts about an axis".to_owned(),
            ],
        ),
        (Some(_), false, _) | (Some(_), _, false) => (
            place("radius"),
            [
                format!("contact `{name}` has no use for a `radius`"),
                "not allowed here".to_owned(),
                "remove it: only friction_coefficient about an axis needs the radius of the bearing"
                    .to_owned(),
            ],
        ),
        _ => return,
    };
    let span = reader.span(place);
    reader.wrong(place, span, words);
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
