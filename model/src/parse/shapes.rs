//! Shapes of bodies: `[[body.shape]]`.

use super::numbers::{number, vector};
use super::reader::Reader;
use super::section::{Item, Section};
use crate::validate::Owner;
use crate::{Number, Rational, Shape, ShapeKind};
use num_traits::{One, Signed, Zero};

const KINDS: [&str; 4] = ["box", "cylinder", "sphere", "mesh"];
const KEYS: [&str; 7] = ["box", "cylinder", "sphere", "mesh", "scale", "position", "orientation"];
const EXAMPLE: &str = "[[body.shape]] on a line of its own, then box = [x, y, z], cylinder = [radius, length], sphere = radius or mesh = \"file.stl\"";

/// The extensions of the files that can be drawn, in lower case.
const MESHES: [&str; 3] = ["stl", "obj", "dae"];

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
                format!("a shape of {title} is neither box, cylinder, sphere nor mesh"),
                "needs one of the four".to_owned(),
                "write sphere = 0.1, or box = [0.1, 0.1, 0.1], or cylinder = [0.1, 0.2]: lengths in m, of a cylinder \
                 radius and length; or mesh = \"file.stl\""
                    .to_owned(),
            ],
            _ => [
                format!("a shape of {title} is {} at once", given.join(" and ")),
                "is one of the four".to_owned(),
                format!("remove `{}` or `{}`", given[0], given[1]),
            ],
        };
        item.wrong(reader, words);
        return None;
    }
    let size = section.get(given[0])?;
    let scale = section.get("scale");
    if let Some(scale) = scale.filter(|_| given[0] != "mesh") {
        let message = format!("a {} has no scale", given[0]);
        scale.wrong(
            reader,
            [message, "is for meshes".to_owned(), "remove `scale` and write the size in m".to_owned()],
        );
        return None;
    }
    let kind = match given[0] {
        "box" => ShapeKind::Box(sizes(reader, size)?),
        "cylinder" => ShapeKind::Cylinder(sizes(reader, size)?),
        "mesh" => mesh(reader, size, scale)?,
        _ => ShapeKind::Sphere(number(reader, size).filter(|radius| is_size(reader, size, radius))?),
    };
    let position = section.vector_or(reader, "position", [0; 3]);
    let orientation = section.vector_or(reader, "orientation", [1, 0, 0, 0]);
    Some(Shape { kind, position, orientation })
}

fn mesh(reader: &mut Reader<'_>, item: Item<'_>, scale_item: Option<Item<'_>>) -> Option<ShapeKind> {
    let file = item.text(reader, "mesh = \"file.stl\"")?;
    let extension = file.rsplit_once('.').map(|(_, extension)| extension.to_lowercase());
    if !extension.is_some_and(|extension| MESHES.contains(&extension.as_str())) {
        let message = format!("the mesh {file:?} is of no kind that can be drawn");
        let help = "write the path of an .stl, .obj or .dae file, relative to the folder of the model file"
            .to_owned();
        item.wrong(reader, [message, "unknown kind of file".to_owned(), help]);
        return None;
    }
    let one = || Number::Exact(Rational::one());
    let scale = match scale_item {
        None => [one(), one(), one()],
        Some(item) if item.value.get_ref().is_array() => vector(reader, item)?,
        Some(item) => number(reader, item).map(|scale| [scale.clone(), scale.clone(), scale])?,
    };
    if let (Some(item), true) = (scale_item, scale.iter().any(is_zero)) {
        let help = "write a number, such as 0.001 for a file in mm; a negative one mirrors".to_owned();
        item.wrong(reader, ["the scale of a mesh is 0".to_owned(), "not a scale".to_owned(), help]);
        return None;
    }
    Some(ShapeKind::Mesh { file: file.to_owned(), scale })
}

fn sizes<const N: usize>(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; N]> {
    let sizes: [Number; N] = vector(reader, item)?;
    sizes.iter().all(|size| is_size(reader, item, size)).then_some(sizes)
}

fn is_zero(number: &Number) -> bool {
    matches!(number, Number::Exact(value) if value.is_zero())
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
