//! Bodies that touch: a `[[contact]]` that is between shapes of bodies, as pairs of surfaces. What a pair stands for is
//! in `prelude.toml`.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

type Table<'t> = DeTable<'t>;
type Value<'t> = Spanned<DeValue<'t>>;

/// Why a contact is between nothing: what is wrong, a label and what to do.
pub(super) type Words = [String; 3];

/// The keys of the law, which pairs have from their contact.
const LAW: [&str; 8] = [
    "restitution",
    "stiffness",
    "exponent",
    "damping",
    "friction_coefficient",
    "static_friction_coefficient",
    "stribeck_rate",
    "rate",
];

/// A shape of a body.
#[derive(Clone, Copy)]
struct Surface<'a, 't> {
    body: &'a Value<'t>,
    shape: &'a Table<'t>,
    /// The key under which its size is.
    kind: &'static str,
}

/// The kinds of shape that can touch another.
const KINDS: [&str; 8] = ["plane", "sphere", "capsule", "cylinder", "box", "ellipsoid", "torus", "vertices"];

/// What a contact comes to.
#[derive(Default)]
pub(super) struct Pairs<'t> {
    /// Pairs of shapes, as tables of the prelude's kinds.
    pub(super) touch: Vec<Table<'t>>,
    /// Kinds of shape of which nothing is known, with those that they meet.
    pub(super) pass: Vec<[&'static str; 2]>,
}

/// The pairs of a contact.
pub(super) fn pairs<'t>(file: &Table<'t>, contact: &Table<'t>) -> Result<Pairs<'t>, Words> {
    let Some(name) = contact.get("name").filter(|name| name.get_ref().is_str()) else {
        return Ok(Pairs::default());
    };
    let Some([one, other]) = sides(file, contact)? else { return Ok(Pairs::default()) };
    let (mut pairs, mut pass) = (Vec::new(), Vec::new());
    let is_rigid = contact.contains_key("restitution");
    for (one, other) in one.iter().flat_map(|one| other.iter().map(move |other| (*one, *other))) {
        match pair(one, other, is_rigid).or_else(|| pair(other, one, is_rigid)) {
            Some(pair) => pairs.push(pair),
            None => pass.push([one.kind, other.kind]),
        }
    }
    if pairs.is_empty() {
        let [one, other] = [one[0].kind, other[0].kind];
        return Err([
            format!("nothing is known of how a {one} touches a {other}"),
            "no such pair".to_owned(),
            "a plane is touched by everything else; a sphere, a capsule, a cylinder and a box by spheres; a capsule by \
             capsules"
                .to_owned(),
        ]);
    }
    let count = pairs.len();
    for (index, pair) in pairs.iter_mut().enumerate() {
        let text = name.get_ref().as_str().unwrap_or_default();
        let own = if count == 1 { text.to_owned() } else { format!("{text}_{}", index + 1) };
        put(pair, "name", Spanned::new(name.span(), DeValue::String(own.into())));
        for key in LAW {
            if let Some(value) = contact.get(key) {
                put(pair, key, value.clone());
            }
        }
        if !contact.contains_key("static_friction_coefficient")
            && let Some(value) = contact.get("friction_coefficient")
        {
            put(pair, "static_friction_coefficient", value.clone());
        }
    }
    Ok(Pairs { touch: pairs, pass })
}

/// The names of the points at which a pair may touch.
pub(super) fn touching<'t>(pair: &Table<'t>) -> impl Iterator<Item = String> + use<'t> {
    let text = |key: &str| pair.get(key).and_then(|value| value.get_ref().as_str()).unwrap_or_default();
    let (name, count) = (text("name").to_owned(), text("number").parse().unwrap_or(0));
    (1..=count).map(move |k: usize| format!("{name}_{k}"))
}

/// The names of the forces at a point: the push, and friction along two tangents.
pub(super) fn forces(point: &str) -> [String; 3] {
    ["push", "along", "across"].map(|force| format!("{point}_{force}"))
}

/// The shapes of both sides; nothing where the tables themselves are wrong, which is told elsewhere.
fn sides<'a, 't>(
    file: &'a Table<'t>,
    contact: &'a Table<'t>,
) -> Result<Option<[Vec<Surface<'a, 't>>; 2]>, Words> {
    let Some(sides) = contact.get("between").and_then(|sides| sides.get_ref().as_array()) else {
        return Ok(None);
    };
    let tables: Vec<&Table<'t>> = sides.iter().filter_map(|side| side.get_ref().as_table()).collect();
    let [one, other] = tables[..] else {
        return Err([
            "a contact is between two sides".to_owned(),
            format!("found {}", tables.len()),
            "write between = [{ body = \"...\" }, { body = \"...\" }]".to_owned(),
        ]);
    };
    let text = |side: &'a Table<'t>, key: &str| side.get(key).and_then(|value| value.get_ref().as_str());
    if text(one, "body").is_some() && text(one, "body") == text(other, "body") {
        return Err([
            "a body does not touch itself".to_owned(),
            "the same body twice".to_owned(),
            "name two bodies".to_owned(),
        ]);
    }
    let mut found = Vec::new();
    for side in [one, other] {
        let Some(body) = side.get("body") else { return Ok(None) };
        let Some(table) = body.get_ref().as_str().and_then(|body| named(file, "body", body)) else {
            return Ok(None);
        };
        let shape = text(side, "shape");
        let shapes = tables_under(table, "shape")
            .filter(|table| shape.is_none_or(|name| text(table, "name") == Some(name)));
        let of = |shape: &'a Table<'t>| {
            let kind = KINDS.into_iter().find(|kind| shape.contains_key(*kind))?;
            Some(Surface { body, shape, kind })
        };
        let surfaces: Vec<_> = shapes.filter_map(of).collect();
        if surfaces.is_empty() {
            let body = body.get_ref().as_str().unwrap_or_default();
            let lacks = match shape {
                Some(shape) => format!("body `{body}` has no shape `{shape}` that can touch another"),
                None => format!("body `{body}` has no shape that can touch another"),
            };
            return Err([
                lacks,
                "nothing to touch".to_owned(),
                format!("write [[body.shape]] below it, with one of {}", KINDS.join(", ")),
            ]);
        }
        found.push(surfaces);
    }
    Ok(found.try_into().ok())
}

/// The points of a rim that may touch a plane: its lowest one, and three, in radii from its centre, on which it lies.
const RIM: [[&str; 3]; 4] =
    [["1", "0", "0"], ["0", "0.8", "0"], ["0", "-0.48", "0.64"], ["0", "-0.48", "-0.64"]];

/// How the second touches the first.
fn pair<'t>(first: Surface<'_, 't>, second: Surface<'_, 't>, is_rigid: bool) -> Option<Table<'t>> {
    let half = |surface: &Surface<'_, 't>, k: usize, sign: &str| {
        let size = surface.size(k)?;
        Some(Spanned::new(size.span(), DeValue::String(format!("{sign}({})/2", written(&size)?).into())))
    };
    let text = |text: &'static str| Spanned::new(first.body.span(), DeValue::String(text.into()));
    let zero = || text("0");
    // Rigid rims have points on which they lie flat, too.
    let rim = |height: Value<'t>| {
        let point = |[is_lowest, x, y]: [&'static str; 3]| {
            array(vec![height.clone(), text(is_lowest), text(x), text(y)])
        };
        let n = if is_rigid { RIM.len() } else { 1 };
        RIM[..n].iter().copied().map(point).collect::<Vec<_>>()
    };
    let mut pair = Table::new();
    let (kind, features) = match (first.kind, second.kind) {
        ("plane", "sphere") => ("points", vec![array(vec![zero(), zero(), zero()])]),
        ("plane", "capsule") => {
            let end = |sign: &str| Some(array(vec![zero(), zero(), half(&second, 1, sign)?]));
            ("points", vec![end("")?, end("-")?])
        }
        ("plane", "box") => {
            let corner = |k: usize| {
                let sign = |bit: usize| if k >> bit & 1 == 0 { "" } else { "-" };
                let edges = (0..3).map(|edge| half(&second, edge, sign(edge)));
                Some(array(edges.collect::<Option<Vec<_>>>()?))
            };
            ("points", (0..8).map(corner).collect::<Option<Vec<_>>>()?)
        }
        ("plane", "vertices") => {
            let rows = second.shape.get("vertices")?.get_ref().as_array()?;
            ("points", rows.iter().cloned().collect())
        }
        ("plane", "torus") => {
            put(&mut pair, "rim", second.size(1)?);
            ("rims", rim(zero()))
        }
        ("plane", "ellipsoid") => {
            for (k, key) in ["semi_x", "semi_y", "semi_z"].into_iter().enumerate() {
                put(&mut pair, key, second.size(k)?);
            }
            ("ellipsoid", vec![zero()])
        }
        ("plane", "cylinder") => {
            put(&mut pair, "rim", zero());
            ("rims", [rim(half(&second, 1, "")?), rim(half(&second, 1, "-")?)].concat())
        }
        ("sphere" | "capsule" | "cylinder" | "box", "sphere") | ("capsule", "capsule") => {
            let halves = ["half_x", "half_y", "half_z"].into_iter().enumerate();
            match first.kind {
                "box" => halves.for_each(|(k, key)| put_some(&mut pair, key, half(&first, k, ""))),
                _ => {
                    put_some(&mut pair, "outer", first.size(0));
                    put_some(&mut pair, "half_length", half(&first, 1, ""));
                }
            }
            if second.kind == "capsule" {
                put(&mut pair, "own_half_length", half(&second, 1, "")?);
            }
            let kind = match (first.kind, second.kind) {
                (_, "capsule") => "capsules",
                ("sphere", _) => "on_sphere",
                ("capsule", _) => "on_capsule",
                ("cylinder", _) => "on_cylinder",
                _ => "on_box",
            };
            (kind, vec![zero()])
        }
        _ => return None,
    };
    let radius = match second.kind {
        "box" | "vertices" => zero(),
        _ => second.size(0)?,
    };
    put(&mut pair, "radius", radius);
    let count = DeValue::String(features.len().to_string().into());
    put(&mut pair, "number", Spanned::new(first.body.span(), count));
    put(&mut pair, "features", array(features));
    put(&mut pair, "kind", Spanned::new(first.body.span(), DeValue::String(kind.into())));
    put(&mut pair, "first", first.frame());
    put(&mut pair, "second", second.frame());
    Some(pair)
}

impl<'t> Surface<'_, 't> {
    /// One of its sizes: the one number of a sphere, or one of a list.
    fn size(&self, k: usize) -> Option<Value<'t>> {
        let value = self.shape.get(self.kind)?;
        match value.get_ref() {
            DeValue::Array(sizes) => sizes.get(k).cloned(),
            _ => (k == 0).then(|| value.clone()),
        }
    }

    /// Its frame, as outputs and bushings have one.
    fn frame(&self) -> Value<'t> {
        let mut frame = Table::new();
        put(&mut frame, "body", self.body.clone());
        for (from, to) in [("position", "point"), ("orientation", "orientation")] {
            if let Some(value) = self.shape.get(from) {
                put(&mut frame, to, value.clone());
            }
        }
        Spanned::new(self.body.span(), DeValue::Table(frame))
    }
}

/// A number as a part of a formula.
fn written(value: &Value<'_>) -> Option<String> {
    Some(match value.get_ref() {
        DeValue::String(text) => text.to_string(),
        DeValue::Integer(number) => number.as_str().to_owned(),
        DeValue::Float(number) => number.as_str().to_owned(),
        _ => return None,
    })
}

fn array<'t>(elements: Vec<Value<'t>>) -> Value<'t> {
    let place: Range<usize> = elements.first().map_or(0..0, Spanned::span);
    let mut array = DeArray::new();
    elements.into_iter().for_each(|element| array.push(element));
    Spanned::new(place, DeValue::Array(array))
}

fn put<'t>(table: &mut Table<'t>, key: &'static str, value: Value<'t>) {
    table.insert(Spanned::new(value.span(), key.into()), value);
}

fn put_some<'t>(table: &mut Table<'t>, key: &'static str, value: Option<Value<'t>>) {
    value.into_iter().for_each(|value| put(table, key, value));
}

fn tables_under<'a, 't>(
    table: &'a Table<'t>,
    key: &str,
) -> impl Iterator<Item = &'a Table<'t>> + use<'a, 't> {
    let tables = table.get(key).and_then(|tables| tables.get_ref().as_array());
    tables.into_iter().flat_map(|tables| tables.iter()).filter_map(|table| table.get_ref().as_table())
}

fn named<'a, 't>(file: &'a Table<'t>, what: &str, name: &str) -> Option<&'a Table<'t>> {
    tables_under(file, what)
        .find(|table| table.get("name").is_some_and(|other| other.get_ref().as_str() == Some(name)))
}
