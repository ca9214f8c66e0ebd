//! Bodies: how they are held, mass and inertia, and the start of those that stand for themselves.

use toml::de::{DeTable, DeValue};

use super::numbers::{number, plain_number, vector};
use super::point_masses::{self, PointMass};
use super::reader::Reader;
use super::section::{Item, Section};
use super::tensor::tensor;
use super::{driven, shapes, tables};
use crate::validate::Owner;
use crate::{Body, Number, Support};

const KEYS: [&str; 14] = [
    "name",
    "fixed",
    "free",
    "driven",
    "mass",
    "inertia",
    "as_written",
    "point_mass",
    "position",
    "orientation",
    "velocity",
    "angular_velocity",
    "assembly_weight",
    "shape",
];

/// Reads all bodies, each with its point masses. Their names are with the reader before any joint refers to them.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<(Body, Vec<PointMass>)> {
    page.require(
        reader,
        "body",
        "the model file",
        "[[body]] on a line of its own, then the keys of the body",
    );
    let tables = tables::tables(reader, page, "body");
    if let Some((first, _)) = tables.first() {
        reader.mark(page.place("body"), first.clone());
    }
    reader.bodies = tables::names(reader, &tables, Owner::Body, "body");
    let names = reader.bodies.clone();
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            body(reader, index, table, name.unwrap_or_else(|| format!("body {}", index + 1)))
        })
        .collect()
}

fn body(reader: &mut Reader<'_>, index: usize, table: &DeTable<'_>, name: String) -> (Body, Vec<PointMass>) {
    let title = format!("body `{name}`");
    let section = Section::open(reader, Owner::Body(index), &title, table, &KEYS);
    let support = support(reader, &section);
    if let Some(support) = support {
        refuse_misplaced(reader, &section, &name, support);
    }
    let motion = section.get("driven").map(|item| driven::read(reader, index, &title, item));
    // Of a body that is held in an unknown way nothing is asked.
    let support = support.unwrap_or(Support::Fixed);
    let point_masses = point_masses::read(reader, &section, index, &title);
    let (mass, inertia) = inertial(reader, &section, &title, support);
    let shapes = section.get("shape").map(|item| shapes::read(reader, index, &title, item));
    let as_written = section.get("as_written").and_then(|item| item.flag(reader)).unwrap_or(false);
    let weight = section.get("assembly_weight").and_then(|item| plain_number(reader, item));
    let body = Body {
        name,
        support,
        mass,
        inertia,
        as_written,
        frame: [0; 3].map(Number::integer),
        position: section.vector_or(reader, "position", [0; 3]),
        orientation: section.vector_or(reader, "orientation", [1, 0, 0, 0]),
        velocity: section.vector_or(reader, "velocity", [0; 3]),
        angular_velocity: section.get("angular_velocity").and_then(|item| vector(reader, item)),
        motion: motion.filter(|_| support == Support::Driven),
        assembly_weight: weight.map_or_else(|| Number::integer(1), Number::Exact),
        shapes: shapes.unwrap_or_default(),
    };
    (body, point_masses)
}

/// How the body is held: `fixed`, `free` and `driven` exclude each other.
fn support(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<Support> {
    let fixed = section.get("fixed").map_or(Some(Support::Moving), |item| fixed(reader, item));
    let free = section.get("free").map_or(Some(false), |item| item.flag(reader));
    let fixed = ("fixed", fixed?);
    let free = ("free", if free? { Support::Free } else { Support::Moving });
    let driven = ("driven", if section.has("driven") { Support::Driven } else { Support::Moving });
    let mut held = [fixed, free, driven].into_iter().filter(|(_, support)| *support != Support::Moving);
    let first = held.next();
    if let (Some((first, _)), Some((second, _))) = (first, held.next()) {
        let message = format!("a body cannot be both {first} and {second}");
        section.refuse(reader, second, &message, &format!("remove `{first}` or `{second}`"));
        return None;
    }
    Some(first.map_or(Support::Moving, |(_, support)| support))
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

/// A start belongs to bodies that move; of those that are placed by joints, see [`super::start`].
fn refuse_misplaced(reader: &mut Reader<'_>, section: &Section<'_>, name: &str, support: Support) {
    let (is, help) = match support {
        Support::Free | Support::Moving => return,
        Support::Fixed | Support::Constrained => ("fixed", "remove the line, or the line with `fixed`"),
        Support::Driven => ("driven", "remove the line: its motion is prescribed by `driven`"),
    };
    for key in ["velocity", "angular_velocity", "assembly_weight", "point_mass"] {
        let message = format!("body `{name}` is {is} and takes no {}", key.replace('_', " "));
        section.refuse(reader, key, &message, help);
    }
}

/// Mass and inertia; zeros where the body may leave them out.
fn inertial(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    title: &str,
    support: Support,
) -> (Number, [Number; 6]) {
    // The point masses may be all that there is of a body.
    let may_lack = matches!(support, Support::Fixed | Support::Driven) || section.has("point_mass");
    let mass = if may_lack {
        section.get("mass")
    } else {
        section.require(reader, "mass", title, "mass = ..., in kg")
    };
    let inertia = if may_lack {
        section.get("inertia")
    } else {
        let example = "inertia = [xx, yy, zz], in kg.m2, about the mass centre";
        section.require(reader, "inertia", title, example)
    };
    let mass = mass.and_then(|item| number(reader, item)).unwrap_or_else(|| Number::integer(0));
    let inertia = inertia.and_then(|item| tensor(reader, item));
    (mass, inertia.unwrap_or_else(|| std::array::from_fn(|_| Number::integer(0))))
}
