//! Bodies: how they are held, mass and inertia, and the start of those that stand for themselves.

use toml::de::{DeTable, DeValue};

use super::numbers::{number, tensor, vector};
use super::page;
use super::reader::Reader;
use super::section::{Item, Section};
use crate::validate::Owner;
use crate::{Body, Number, Support};

const KEYS: [&str; 9] =
    ["name", "fixed", "free", "mass", "inertia", "position", "orientation", "velocity", "angular_velocity"];

/// Reads all bodies. Their names are with the reader before any joint refers to them.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<Body> {
    page.require(reader, "body", "the page", "[[body]] on a line of its own, then the keys of the body");
    let tables = page::tables(reader, page, "body");
    if let Some((first, _)) = tables.first() {
        reader.mark(page.place("body"), first.clone());
    }
    reader.bodies = page::names(reader, &tables, Owner::Body, "body");
    let names = reader.bodies.clone();
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            body(reader, index, table, name.unwrap_or_else(|| format!("body {}", index + 1)))
        })
        .collect()
}

fn body(reader: &mut Reader<'_>, index: usize, table: &DeTable<'_>, name: String) -> Body {
    let title = format!("body `{name}`");
    let section = Section::open(reader, Owner::Body(index), &title, table, &KEYS);
    let support = support(reader, &section);
    if let Some(support) = support {
        refuse_misplaced(reader, &section, &name, support);
    }
    // Of a body that is held in an unknown way nothing is asked.
    let support = support.unwrap_or(Support::Fixed);
    let (mass, inertia) = inertial(reader, &section, &title, support);
    Body {
        name,
        support,
        mass,
        inertia,
        position: section.vector_or(reader, "position", [0; 3]),
        orientation: section.vector_or(reader, "orientation", [1, 0, 0, 0]),
        velocity: section.vector_or(reader, "velocity", [0; 3]),
        angular_velocity: section.get("angular_velocity").and_then(|item| vector(reader, item)),
    }
}

/// How the body is held: `fixed` and `free` exclude each other.
fn support(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<Support> {
    let fixed = section.get("fixed").map_or(Some(Support::Moving), |item| fixed(reader, item));
    let free = section.get("free").map_or(Some(false), |item| flag(reader, item));
    match (fixed?, free?) {
        (support, false) => Some(support),
        (Support::Moving, true) => Some(Support::Free),
        _ => {
            section.refuse(
                reader,
                "free",
                "a body cannot be both fixed and free",
                "remove `fixed` or `free`",
            );
            None
        }
    }
}

fn fixed(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Support> {
    match item.value.get_ref() {
        DeValue::Boolean(true) => Some(Support::Fixed),
        DeValue::Boolean(false) => Some(Support::Moving),
        DeValue::String(text) if text == "constrained" => Some(Support::Constrained),
        _ => {
            let example =
                "fixed = true, or fixed = \"constrained\" for coordinates of its own and six constraint rows";
            item.wrong_type(reader, "true, false or \"constrained\"", example);
            None
        }
    }
}

fn flag(reader: &mut Reader<'_>, item: Item<'_>) -> Option<bool> {
    let flag = item.value.get_ref().as_bool();
    if flag.is_none() {
        item.wrong_type(reader, "true or false", &format!("{} = true", item.key()));
    }
    flag
}

/// A start belongs to the bodies that stand for themselves; the others are placed by their joints.
fn refuse_misplaced(reader: &mut Reader<'_>, section: &Section<'_>, name: &str, support: Support) {
    match support {
        Support::Free => {}
        Support::Moving => {
            for key in ["position", "orientation"] {
                let message = format!("the {key} of body `{name}` follows from its joints");
                let help = "start the joint instead (`angle`, `orientation`), or write free = true";
                section.refuse(reader, key, &message, help);
            }
            let message = format!("the velocity of body `{name}` follows from its joints");
            let help = "give its joint a `rate` or the body an `angular_velocity`, or write free = true";
            section.refuse(reader, "velocity", &message, help);
        }
        Support::Fixed | Support::Constrained => {
            for key in ["velocity", "angular_velocity"] {
                let message = format!("body `{name}` is fixed and has no {}", key.replace('_', " "));
                section.refuse(reader, key, &message, "remove the line, or the line with `fixed`");
            }
        }
    }
}

/// Mass and inertia; zeros where the body may leave them out.
fn inertial(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    support: Support,
) -> (Number, [Number; 6]) {
    let mass = if support == Support::Fixed {
        section.get("mass")
    } else {
        section.require(reader, "mass", title, "mass = ..., in kg")
    };
    let inertia = if support == Support::Fixed {
        section.get("inertia")
    } else {
        let example = "inertia = [xx, yy, zz], in kg.m2, about the mass centre";
        section.require(reader, "inertia", title, example)
    };
    let mass = mass.and_then(|item| number(reader, item)).unwrap_or_else(|| Number::integer(0));
    let inertia = inertia.and_then(|item| tensor(reader, item));
    (mass, inertia.unwrap_or_else(|| std::array::from_fn(|_| Number::integer(0))))
}
