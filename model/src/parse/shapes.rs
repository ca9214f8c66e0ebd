//! Shapes of bodies: `[[body.shape]]`.

use super::numbers::{number, vector};
use super::reader::Reader;
use super::section::{Item, Section, all, cure};
use crate::keys::SHAPE;
use crate::validate::{Owner, out_of_range};
use crate::{Number, Rational, Shape, ShapeKind};
use num_traits::{One, Zero};

const KINDS: [&str; 9] =
    ["box", "cylinder", "sphere", "capsule", "ellipsoid", "torus", "plane", "vertices", "mesh"];

/// The extensions of the files that can be drawn, in lower case.
const MESHES: [&str; 3] = ["stl", "obj", "dae"];

/// The names that CSS has for colours (CSS Color Module Level 4), each with its red, green and blue. No name is made of
/// the digits of a number.
const COLORS: &str = "\
    aliceblue f0f8ff antiquewhite faebd7 aqua 00ffff aquamarine 7fffd4 azure f0ffff beige f5f5dc bisque ffe4c4 \
    black 000000 blanchedalmond ffebcd blue 0000ff blueviolet 8a2be2 brown a52a2a burlywood deb887 cadetblue \
    5f9ea0 chartreuse 7fff00 chocolate d2691e coral ff7f50 cornflowerblue 6495ed cornsilk fff8dc crimson dc143c \
    cyan 00ffff darkblue 00008b darkcyan 008b8b darkgoldenrod b8860b darkgray a9a9a9 darkgreen 006400 darkgrey \
    a9a9a9 darkkhaki bdb76b darkmagenta 8b008b darkolivegreen 556b2f darkorange ff8c00 darkorchid 9932cc darkred \
    8b0000 darksalmon e9967a darkseagreen 8fbc8f darkslateblue 483d8b darkslategray 2f4f4f darkslategrey 2f4f4f \
    darkturquoise 00ced1 darkviolet 9400d3 deeppink ff1493 deepskyblue 00bfff dimgray 696969 dimgrey 696969 \
    dodgerblue 1e90ff firebrick b22222 floralwhite fffaf0 forestgreen 228b22 fuchsia ff00ff gainsboro dcdcdc \
    ghostwhite f8f8ff gold ffd700 goldenrod daa520 gray 808080 green 008000 greenyellow adff2f grey 808080 \
    honeydew f0fff0 hotpink ff69b4 indianred cd5c5c indigo 4b0082 ivory fffff0 khaki f0e68c lavender e6e6fa \
    lavenderblush fff0f5 lawngreen 7cfc00 lemonchiffon fffacd lightblue add8e6 lightcoral f08080 lightcyan \
    e0ffff lightgoldenrodyellow fafad2 lightgray d3d3d3 lightgreen 90ee90 lightgrey d3d3d3 lightpink ffb6c1 \
    lightsalmon ffa07a lightseagreen 20b2aa lightskyblue 87cefa lightslategray 778899 lightslategrey 778899 \
    lightsteelblue b0c4de lightyellow ffffe0 lime 00ff00 limegreen 32cd32 linen faf0e6 magenta ff00ff maroon \
    800000 mediumaquamarine 66cdaa mediumblue 0000cd mediumorchid ba55d3 mediumpurple 9370db mediumseagreen \
    3cb371 mediumslateblue 7b68ee mediumspringgreen 00fa9a mediumturquoise 48d1cc mediumvioletred c71585 \
    midnightblue 191970 mintcream f5fffa mistyrose ffe4e1 moccasin ffe4b5 navajowhite ffdead navy 000080 oldlace \
    fdf5e6 olive 808000 olivedrab 6b8e23 orange ffa500 orangered ff4500 orchid da70d6 palegoldenrod eee8aa \
    palegreen 98fb98 paleturquoise afeeee palevioletred db7093 papayawhip ffefd5 peachpuff ffdab9 peru cd853f \
    pink ffc0cb plum dda0dd powderblue b0e0e6 purple 800080 rebeccapurple 663399 red ff0000 rosybrown bc8f8f \
    royalblue 4169e1 saddlebrown 8b4513 salmon fa8072 sandybrown f4a460 seagreen 2e8b57 seashell fff5ee sienna \
    a0522d silver c0c0c0 skyblue 87ceeb slateblue 6a5acd slategray 708090 slategrey 708090 snow fffafa \
    springgreen 00ff7f steelblue 4682b4 tan d2b48c teal 008080 thistle d8bfd8 tomato ff6347 turquoise 40e0d0 \
    violet ee82ee wheat f5deb3 white ffffff whitesmoke f5f5f5 yellow ffff00 yellowgreen 9acd32";

/// Reads the shapes of a body; `title` says which body it is.
pub(super) fn read(reader: &mut Reader<'_>, body: usize, title: &str, item: Item<'_>) -> Vec<Shape> {
    let tables = item.tables(reader).into_iter().enumerate();
    let shapes = tables.map(|(index, (item, table))| {
        let title = format!("a shape of {title}");
        let section = Section::open(reader, Owner::Shape(body, index), title, table, &SHAPE);
        shape(reader, &section, item)
    });
    shapes.collect::<Vec<_>>().into_iter().flatten().collect()
}

fn shape(reader: &mut Reader<'_>, section: &Section<'_>, item: Item<'_>) -> Option<Shape> {
    let title = &section.title;
    let given: Vec<&'static str> = KINDS.into_iter().filter(|kind| section.has(kind)).collect();
    if given.len() != 1 {
        let words = match given[..] {
            [] => [
                format!("{title} has no form"),
                format!("needs one of {}", KINDS.join(", ")),
                "write sphere = 0.1, or box = [0.1, 0.1, 0.1], or cylinder = [0.1, 0.2]: lengths in m, of a cylinder \
                 radius and length; or mesh = \"file.stl\""
                    .to_owned(),
            ],
            _ => [
                format!("{title} is {} at once", given.join(" and ")),
                "is one of them".to_owned(),
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
        "box" => ShapeKind::Box(sizes(reader, section, size)?),
        "cylinder" => ShapeKind::Cylinder(sizes(reader, section, size)?),
        "capsule" => ShapeKind::Capsule(sizes(reader, section, size)?),
        "ellipsoid" => ShapeKind::Ellipsoid(sizes(reader, section, size)?),
        "torus" => ShapeKind::Torus(sizes(reader, section, size)?),
        "plane" => ShapeKind::Plane(sizes(reader, section, size)?),
        "vertices" => vertices(reader, size)?,
        "mesh" => mesh(reader, size, scale)?,
        _ => {
            let radius = number(reader, size)?;
            ShapeKind::Sphere(is_size(reader, section, size, &radius).then_some(radius)?)
        }
    };
    let position = section.vector(reader, "position");
    let orientation = section.vector(reader, "orientation");
    let color = section.get("color").and_then(|item| color(reader, item));
    Some(Shape { kind, color, position, orientation })
}

/// A colour by its name in CSS, or as `#rrggbb`.
fn color(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[u8; 3]> {
    let text = item.text(reader)?;
    let color = named(text);
    if color.is_none() {
        let help = format!("write {}", cure(item.key));
        let words = [format!("the color {text:?} is none"), "not a colour".to_owned(), help];
        item.wrong(reader, words);
    }
    color
}

/// The colour of a name, or of the six digits after `#`.
fn named(text: &str) -> Option<[u8; 3]> {
    let digits = match text.strip_prefix('#') {
        Some(digits) => Some(digits).filter(|digits| digits.bytes().all(|byte| byte.is_ascii_hexdigit())),
        None => {
            let mut words = COLORS.split(' ');
            words.find(|word| text.eq_ignore_ascii_case(word)).and_then(|_| words.next())
        }
    };
    let byte = |k: usize| u8::from_str_radix(digits?.get(2 * k..2 * k + 2)?, 16).ok();
    Some([byte(0)?, byte(1)?, byte(2)?]).filter(|_| digits.is_some_and(|digits| digits.len() == 6))
}

fn mesh(reader: &mut Reader<'_>, item: Item<'_>, scale_item: Option<Item<'_>>) -> Option<ShapeKind> {
    let file = item.text(reader)?;
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

/// Corners, at least one.
fn vertices(reader: &mut Reader<'_>, item: Item<'_>) -> Option<ShapeKind> {
    let corners = all(item.elements().map(|row| vector(reader, row)))?;
    if corners.is_empty() {
        item.wrong_type_with(reader, "rows of three numbers", "write vertices = [[0, 0, 0]]".to_owned());
        return None;
    }
    Some(ShapeKind::Vertices(corners))
}

fn sizes<const N: usize>(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    item: Item<'_>,
) -> Option<[Number; N]> {
    let sizes: [Number; N] = vector(reader, item)?;
    sizes.iter().all(|size| is_size(reader, section, item, size)).then_some(sizes)
}

fn is_zero(number: &Number) -> bool {
    matches!(number, Number::Exact(value) if value.is_zero())
}

/// Reports a size that is not positive. That of a parameter may become so; nothing is drawn then.
fn is_size(reader: &mut Reader<'_>, section: &Section<'_>, item: Item<'_>, size: &Number) -> bool {
    let Number::Exact(size) = size else { return true };
    let words = out_of_range(item.key, &section.title, size);
    let is_size = words.is_none();
    words.into_iter().for_each(|words| item.wrong(reader, words));
    is_size
}
