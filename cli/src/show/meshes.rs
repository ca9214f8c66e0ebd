//! Files of triangles that shapes name.

use crate::failure::Failure;
use crate::files;
use gyro_model::{Model, Shape, ShapeKind};
use gyro_show::Mesh;
use mesh_loader::{Loader, Scene};
use std::path::Path;
use std::{io, panic};

/// The largest file that is read.
const LARGEST: u64 = 256 << 20;

/// The surfaces of a model, by the paths that its model file writes.
#[derive(Debug, Default)]
pub(crate) struct Meshes {
    files: Vec<String>,
    pub(super) meshes: Vec<Mesh>,
}

impl Meshes {
    /// Which of the meshes a path is.
    pub(super) fn place(&self, file: &str) -> Option<usize> {
        self.files.iter().position(|other| other == file)
    }
}

/// Reads the files of all shapes, each once; their paths are relative to the folder of the model file.
///
/// # Errors
/// Every file that cannot be drawn, with the body that it belongs to.
pub(crate) fn read(model: &Model, page: &Path) -> Result<Meshes, Failure> {
    let mut found = Meshes::default();
    let mut problems = Vec::new();
    for body in &model.bodies {
        for file in body.shapes.iter().filter_map(file) {
            if found.place(file).is_some() {
                continue;
            }
            let mesh = mesh(&page.parent().unwrap_or(Path::new("")).join(file)).map_err(|e| {
                problems.push(format!("{}: body `{}`: mesh `{file}`: {e}", page.display(), body.name));
            });
            found.files.push(file.to_owned());
            found.meshes.push(mesh.unwrap_or_default());
        }
    }
    if problems.is_empty() {
        return Ok(found);
    }
    problems.push("write paths relative to the folder of the model file, or remove these shapes".to_owned());
    Err(Failure::Usage(problems.join("\n")))
}

fn file(shape: &Shape) -> Option<&str> {
    match &shape.kind {
        ShapeKind::Mesh { file, .. } => Some(file),
        _ => None,
    }
}

/// The triangles of a file, as a picture needs them.
pub(crate) fn mesh(path: &Path) -> io::Result<Mesh> {
    let (vertices, triangles) = surface(path)?;
    let empty = || io::Error::new(io::ErrorKind::InvalidData, "it has no triangles");
    Mesh::new(&vertices, &triangles).ok_or_else(empty)
}

/// All vertices of a file, and all triangles of these.
pub(crate) fn surface(path: &Path) -> io::Result<(Vec<[f32; 3]>, Vec<[u32; 3]>)> {
    let scene = parsed(told_apart(files::bytes(path, LARGEST)?), path)?;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for part in &scene.meshes {
        let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
        vertices.extend_from_slice(&part.vertices);
        triangles.extend(part.faces.iter().map(|face| face.map(|k| k.saturating_add(first))));
    }
    Ok((vertices, triangles))
}

/// Binary STL files may begin with the word by which the parser knows text, as their first 80 bytes are anything. They
/// are known by their length, 50 bytes for each of the triangles that they count, and get other first bytes.
fn told_apart(mut bytes: Vec<u8>) -> Vec<u8> {
    const WORD: &[u8] = b"solid";
    const COUNT: std::ops::Range<usize> = 80..84;
    let count = bytes.get(COUNT).and_then(|count| Some(u32::from_le_bytes(count.try_into().ok()?)));
    let is_binary = |count| COUNT.end as u64 + 50 * u64::from(count) == bytes.len() as u64;
    if bytes.starts_with(WORD) && count.is_some_and(is_binary) {
        bytes[..WORD.len()].fill(b' ');
    }
    bytes
}

/// The parser panics at some broken files. It has no state, so that nothing is left half done by that.
fn parsed(bytes: Vec<u8>, path: &Path) -> io::Result<Scene> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    let name = Path::new("mesh").with_extension(extension);
    // Materials of OBJ files are not asked for.
    let load = || Loader::default().load_from_slice_with_reader(&bytes, &name, |_| Ok(Vec::new()));
    let told = panic::take_hook();
    panic::set_hook(Box::new(|_| {}));
    let scene = panic::catch_unwind(load);
    panic::set_hook(told);
    let kind = name.extension().unwrap_or_default().to_string_lossy().to_uppercase();
    let broken =
        |why: &str| io::Error::new(io::ErrorKind::InvalidData, format!("it is not a whole {kind} file{why}"));
    scene.map_err(|_| broken(""))?.map_err(|e| broken(&format!(": {e}")))
}
