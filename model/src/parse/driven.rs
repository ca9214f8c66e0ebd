//! A body's whole motion, prescribed in time.

use super::reader::Reader;
use super::section::{Item, Section};
use super::{motion, section};
use crate::keys::{DRIVEN, ROTATION};
use crate::validate::Owner;
use crate::{BodyMotion, Motion, Number};

/// Reads the `driven` table of a body; where it is wrong the body rests.
pub(super) fn read(reader: &mut Reader<'_>, body: usize, title: &str, item: Item<'_>) -> BodyMotion {
    let rest = BodyMotion { translation: std::array::from_fn(|_| motion::rest()), rotations: Vec::new() };
    let Some(table) = item.table(reader) else { return rest };
    let section = Section::open(reader, Owner::Driven(body), format!("`driven` of {title}"), table, &DRIVEN);
    if table.is_empty() {
        let words = [
            format!("the motion of {title} is empty"),
            "needs `translation` or `rotations`".to_owned(),
            format!(
                "write translation = [motion, motion, motion], in m, or {}",
                section::cure(section.key("rotations"))
            ),
        ];
        item.wrong(reader, words);
    }
    let translation = section.get("translation").and_then(|item| motion::several(reader, item, 3));
    let rotations = section.get("rotations").map(|item| item.tables(reader)).unwrap_or_default();
    let rotations = rotations.into_iter().filter_map(|(item, _)| rotation(reader, item, title));
    BodyMotion {
        translation: translation.and_then(|motions| motions.try_into().ok()).unwrap_or(rest.translation),
        rotations: rotations.collect(),
    }
}

fn rotation(reader: &mut Reader<'_>, item: Item<'_>, title: &str) -> Option<([Number; 3], Motion)> {
    let section = Section::within(reader, item, format!("a rotation of {title}"), &ROTATION)?;
    let axis = section.given_vector(reader, "axis");
    let angle = section.find(reader, "angle").and_then(|item| motion::read(reader, item));
    axis.zip(angle)
}
