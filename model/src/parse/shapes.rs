//! Shapes of bodies: `[[body.shape]]`.

use super::numbers::{number, vector};
use super::reader::Reader;
use super::section::{Item, Section};
use crate::validate::Owner;
use crate::{Number, Shape, ShapeKind};
use num_traits::Signed;

const KINDS: [&str; 3] = ["box", "cylinder", "sphere"];
const KEYS: [&str; 5] = ["box", "cylinder", "sphere", "position", "orientation"];
const EXAMPLE: &str = "[[body.shape]] on a line of its own, then box = [x, y, z], cylinder = [radius, length] or sphere = radius";

/// Reads the shapes of a body; `title` says which body it is.
pub(super) fn read(reader: &mut Reader<'_>, body: usize, title: &str, item: Item<'_>) -> Vec<Shape> {
    let Some(elements) = item.value.get_ref().as_array() else {
        item.wrong_type(reader, "an array of tables", EXAMPLE);
        return Vec::new();
    };
    let items = elements.iter().map(|value| Item { value, ..item }).enumerate();
    items.filter_map(|(index, item)| shape(reader, Owner::Shape(body, index), title, item)).collect()
}

fn shape(reader: &mut Reader<'_>, owner: Owner, title: &str, item: Item<'_>) -> Option<Shape> {
    let table = item.table(reader, EXAMPLE)?;
    let section = Section::open(reader, owner, &format!("a shape of {title}"), table, &KEYS);
    let given: Vec<&'static str> = KINDS.into_iter().filter(|kind| section.has(kind)).collect();
    if given.len() != 1 {
        let words = match given[..] {
            [] => [
                format!("a shape of {title} is neither box, cylinder nor sphere"),
                "needs one of the three".to_owned(),
                "write sphere = 0.1, or box = [0.1, 0.1, 0.1], or cylinder = [0.1, 0.2]: lengths in m, of a cylinder \
                 radius and length"
                    .to_owned(),
            ],
            _ => [
                format!("a shape of {title} is {} at once", given.join(" and ")),
                "is one of the three".to_owned(),
                format!("remove `{}` or `{}`", given[0], given[1]),
            ],
        };
        item.wrong(reader, words);
        return None;
    }
    let size = section.get(given[0])?;
    let kind = match given[0] {
        "box" => ShapeKind::Box(sizes(reader, size)?),
        "cylinder" => ShapeKind::Cylinder(sizes(reader, size)?),
        _ => ShapeKind::Sphere(number(reader, size).filter(|radius| is_size(reader, size, radius))?),
    };
    let position = section.vector_or(reader, "position", [0; 3]);
    let orientation = section.vector_or(reader, "orientation", [1, 0, 0, 0]);
    Some(Shape { kind, position, orientation })
}

fn sizes<const N: usize>(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; N]> {
    let sizes: [Number; N] = vector(reader, item)?;
    sizes.iter().all(|size| is_size(reader, item, size)).then_some(sizes)
}

/// Reports a size that is not positive. That of a parameter may become so; nothing is drawn then.
fn is_size(reader: &mut Reader<'_>, item: Item<'_>, size: &Number) -> bool {
    let is_good = !matches!(size, Number::Exact(value) if !value.is_positive());
    if !is_good {
        let message = format!("the size of a {} must be positive", item.key());
        let help = "write lengths greater than 0, in m".to_owned();
        item.wrong(reader, [message, "not a size".to_owned(), help]);
    }
    is_good
}
