//! What links look like: boxes, cylinders, spheres and meshes of `<visual>`.

use super::document::{Document, Node};
use super::element::Findings;
use nalgebra::IsometryMatrix3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A solid or a surface of a link.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// In the link's frame.
    pub(super) pose: IsometryMatrix3<f64>,
    pub(super) kind: Kind,
    /// As model files write it.
    pub(super) color: Option<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// Its edges.
    Box([f64; 3]),
    /// Radius and length; its axis is z in both formats.
    Cylinder([f64; 2]),
    /// Its radius.
    Sphere(f64),
    /// An existing file, and what its coordinates are multiplied by.
    Mesh(PathBuf, [f64; 3]),
}

/// The shapes of a link under such tags; one of another kind, or with a mesh that is not found, is left out.
pub(super) fn read(findings: &mut Findings<'_>, link: Node<'_>, tag: &str) -> Vec<Shape> {
    let tagged = link.children().filter(|node| node.is(tag));
    tagged.filter_map(|node| shape(findings, node)).collect()
}

fn shape(findings: &mut Findings<'_>, visual: Node<'_>) -> Option<Shape> {
    let geometry = visual.child("geometry")?;
    let kind = if let Some(node) = geometry.child("box") {
        Kind::Box(findings.vector_or(node, "size", [0.0; 3])?.into())
    } else if let Some(node) = geometry.child("cylinder") {
        Kind::Cylinder([findings.number(node, "radius")?, findings.number(node, "length")?])
    } else if let Some(node) = geometry.child("mesh") {
        let file = found(findings.file.as_ref(), findings.text(node, "filename")?)?;
        Kind::Mesh(file, findings.vector_or(node, "scale", [1.0; 3])?.into())
    } else {
        Kind::Sphere(findings.number(geometry.child("sphere")?, "radius")?)
    };
    // Some robots have empty shapes: nothing is lost with them.
    let is_seen = match &kind {
        Kind::Box(edges) => edges.iter().all(|edge| *edge > 0.0),
        Kind::Cylinder(sizes) => sizes.iter().all(|size| *size > 0.0),
        Kind::Sphere(radius) => *radius > 0.0,
        Kind::Mesh(_, scale) => scale.iter().all(|scale| *scale != 0.0),
    };
    let pose = findings.origin(visual)?;
    let material = visual.child("material");
    let named = |material: Node<'_>| findings.colors.get(material.attribute("name")?).cloned();
    let color = material.and_then(|material| color(material).or_else(|| named(material)));
    is_seen.then_some(Shape { pose, kind, color })
}

/// The colour of a material that has one.
pub(super) fn color(material: Node<'_>) -> Option<String> {
    let color = material.child("color").filter(|_| material.is("material"))?;
    let parts: Vec<f64> =
        color.attribute("rgba")?.split_whitespace().filter_map(|x| x.parse().ok()).collect();
    let [red, green, blue, ..] = parts[..] else { return None };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 255")]
    let [red, green, blue] = [red, green, blue].map(|part| (255.0 * part.clamp(0.0, 1.0)).round() as u8);
    Some(format!("#{red:02x}{green:02x}{blue:02x}"))
}

/// The colours of all materials with names.
pub(super) fn materials(document: &Document) -> BTreeMap<String, String> {
    let named = |node: Node<'_>| Some((node.attribute("name")?.to_owned(), color(node)?));
    document.all().filter_map(named).collect()
}

impl Kind {
    /// As a model file in this folder writes it.
    pub(super) fn text(&self, folder: &Path) -> String {
        match self {
            Self::Box([x, y, z]) => format!("box = [{x:?}, {y:?}, {z:?}]"),
            Self::Cylinder([radius, length]) => format!("cylinder = [{radius:?}, {length:?}]"),
            Self::Sphere(radius) => format!("sphere = {radius:?}"),
            Self::Mesh(file, scale) => {
                // Strings of JSON are strings of TOML.
                let path = serde_json::Value::from(relative(file, folder));
                let [x, y, z] = scale;
                let scale = if *scale == [1.0; 3] {
                    String::new()
                } else {
                    format!("\nscale = [{x:?}, {y:?}, {z:?}]")
                };
                format!("mesh = {path}{scale}")
            }
        }
    }
}

/// Extensions of meshes that can be drawn.
const MESHES: [&str; 3] = ["stl", "obj", "dae"];

/// The file that a robot names, if it is there and can be drawn. `package://NAME/…` is looked for in the folders above
/// the robot and, as ROS does, in those of `ROS_PACKAGE_PATH`, where a package is a folder of its name; any other path
/// is relative to the robot.
fn found(robot: &Path, name: &str) -> Option<PathBuf> {
    let beside = robot.parent().unwrap_or(Path::new(""));
    let candidates: Vec<PathBuf> = match name.split_once("://") {
        Some(("package", path)) => {
            let above = std::fs::canonicalize(beside).unwrap_or_default();
            let listed = std::env::var_os("ROS_PACKAGE_PATH").unwrap_or_default();
            let inside = path.split_once('/').map_or(path, |(_, inside)| inside);
            // The robot's own package may be unpacked under another name.
            let own = above.ancestors().filter(|folder| folder.join("package.xml").is_file());
            let own = own.map(|folder| folder.join(inside));
            let named = above.ancestors().map(|folder| folder.join(path));
            named.chain(std::env::split_paths(&listed).map(|folder| folder.join(path))).chain(own).collect()
        }
        Some(("file", path)) => vec![PathBuf::from(path)],
        Some(_) => Vec::new(),
        None => vec![beside.join(name)],
    };
    let is_drawn = |path: &PathBuf| {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        MESHES.iter().any(|known| extension == *known) && path.is_file()
    };
    candidates.into_iter().find(is_drawn)
}

/// A path from a folder, or a whole one where the file is not inside of it.
fn relative(file: &Path, folder: &Path) -> String {
    let whole = |path: &Path| std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let file = whole(file);
    let shown = file.strip_prefix(whole(folder)).unwrap_or(&file);
    shown.to_string_lossy().replace('\\', "/")
}
