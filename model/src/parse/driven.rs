//! A body's whole motion, prescribed in time.

use super::motion;
use super::numbers::vector;
use super::reader::Reader;
use super::section::{Item, Section};
use crate::validate::Owner;
use crate::{BodyMotion, Motion, Number};

const KEYS: [&str; 2] = ["translation", "rotations"];
const ROTATION_KEYS: [&str; 2] = ["axis", "angle"];
const ROTATION: &str = "rotations = [{ axis = [1, 0, 0], angle = ... }], the angle a motion in rad";

/// Reads the `driven` table of a body; where it is wrong the body rests.
pub(super) fn read(reader: &mut Reader<'_>, body: usize, title: &str, item: Item<'_>) -> BodyMotion {
    let rest = BodyMotion { translation: std::array::from_fn(|_| motion::rest()), rotations: Vec::new() };
    let example = "driven = { translation = [...], rotations = [...] }, see docs/model-format.md";
    let Some(table) = item.table(reader, example) else { return rest };
    let owner = Owner::Driven(body);
    let section = Section::open(reader, owner, &format!("`driven` of {title}"), table, &KEYS);
    if table.is_empty() {
        let words = [
            format!("the motion of {title} is empty"),
            "needs `translation` or `rotations`".to_owned(),
            format!("write translation = [motion, motion, motion], in m, or {ROTATION}"),
        ];
        item.wrong(reader, words);
    }
    let translation = section.get("translation").and_then(|item| translation(reader, item));
    let rotations = section.get("rotations").map(|item| rotations(reader, item, title));
    BodyMotion {
        translation: translation.unwrap_or(rest.translation),
        rotations: rotations.unwrap_or_default(),
    }
}

fn translation(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Motion; 3]> {
    let elements = item.value.get_ref().as_array().filter(|elements| elements.len() == 3);
    let Some(elements) = elements else {
        item.wrong_type(reader, "an array of 3 motions", "translation = [0, 0, 0], each a motion in m");
        return None;
    };
    let motions: Vec<Option<Motion>> =
        elements.iter().map(|value| motion::read(reader, Item { value, ..item })).collect();
    let motions: Option<Vec<Motion>> = motions.into_iter().collect();
    motions.and_then(|motions| motions.try_into().ok())
}

fn rotations(reader: &mut Reader<'_>, item: Item<'_>, title: &str) -> Vec<([Number; 3], Motion)> {
    let Some(elements) = item.value.get_ref().as_array() else {
        item.wrong_type(reader, "an array of tables", ROTATION);
        return Vec::new();
    };
    elements.iter().filter_map(|value| rotation(reader, Item { value, ..item }, title)).collect()
}

fn rotation(reader: &mut Reader<'_>, item: Item<'_>, title: &str) -> Option<([Number; 3], Motion)> {
    let table = item.table(reader, ROTATION)?;
    let title = format!("a rotation of {title}");
    let section = Section::open(reader, item.place.owner, &title, table, &ROTATION_KEYS);
    let axis = section.require_within(reader, item, "axis", (&title, "axis = [1, 0, 0]"));
    let axis = axis.and_then(|item| vector(reader, item));
    let angle = section.require_within(reader, item, "angle", (&title, "angle = ..., a motion in rad"));
    let angle = angle.and_then(|item| motion::read(reader, item));
    axis.zip(angle)
}
