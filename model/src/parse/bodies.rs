//! Bodies: how they are held, mass and inertia, and the start of those that stand for themselves.

use toml::de::DeValue;

use super::numbers::number;
use super::point_masses::{self, PointMass};
use super::reader::Reader;
use super::section::{Item, Section};
use super::tensor::tensor;
use super::{driven, shapes, tables};
use crate::validate::Owner;
use crate::{Body, Number, Support};

/// Reads all bodies, each with its point masses.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Vec<(Body, Vec<PointMass>)> {
    let sections = tables::each(reader, page, "body", Owner::Body).into_iter().enumerate();
    sections.map(|(index, (section, name))| body(reader, index, &section, name)).collect()
}

fn body(
    reader: &mut Reader<'_>,
    index: usize,
    section: &Section<'_>,
    name: String,
) -> (Body, Vec<PointMass>) {
    let support = support(reader, section);
    if let Some(support) = support {
        refuse_misplaced(reader, section, &name, support);
    }
    let motion = section.get("driven").map(|item| driven::read(reader, index, &section.title, item));
    // Of a body that is held in an unknown way nothing is asked.
    let support = support.unwrap_or(Support::Fixed);
    let point_masses = point_masses::read(reader, section, index);
    let (mass, inertia) = inertial(reader, section, support);
    let shapes = section.get("shape").map(|item| shapes::read(reader, index, &section.title, item));
    let body = Body {
        name,
        support,
        mass,
        inertia,
        as_written: section.flag(reader, "as_written"),
        frame: [0; 3].map(Number::integer),
        position: section.vector(reader, "position"),
        orientation: section.vector(reader, "orientation"),
        velocity: section.vector(reader, "velocity"),
        angular_velocity: section.given_vector(reader, "angular_velocity"),
        motion: motion.filter(|_| support == Support::Driven),
        assembly_weight: section.number(reader, "assembly_weight"),
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
            item.wrong_type(reader, "true, false or \"constrained\"");
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
fn inertial(reader: &mut Reader<'_>, section: &Section<'_>, support: Support) -> (Number, [Number; 6]) {
    // The point masses may be all that there is of a body.
    let may_lack = matches!(support, Support::Fixed | Support::Driven) || section.has("point_mass");
    let mut find = |key| if may_lack { section.get(key) } else { section.require(reader, key) };
    let [mass, inertia] = ["mass", "inertia"].map(&mut find);
    let mass = mass.and_then(|item| number(reader, item)).unwrap_or_else(|| Number::integer(0));
    let inertia = inertia.and_then(|item| tensor(reader, item));
    (mass, inertia.unwrap_or_else(|| std::array::from_fn(|_| Number::integer(0))))
}
