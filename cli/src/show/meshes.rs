//! Files of triangles that shapes name.

use crate::failure::Failure;
use crate::{files, xml};
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

/// The triangles of a file.
pub(crate) fn mesh(path: &Path) -> io::Result<Mesh> {
    let scene = parsed(checked(files::bytes(path, LARGEST)?, path).map_err(invalid)?, path)?;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for part in &scene.meshes {
        let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
        vertices.extend_from_slice(&part.vertices);
        triangles.extend(part.faces.iter().map(|face| face.map(|k| k.saturating_add(first))));
    }
    Mesh::new(&vertices, &triangles).ok_or_else(|| invalid("it has no triangles".to_owned()))
}

fn invalid(words: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, words)
}

/// The file, if the parser can be trusted with it: it believes counts, and follows nesting on its stack.
fn checked(bytes: Vec<u8>, path: &Path) -> Result<Vec<u8>, String> {
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    if extension == "dae" {
        return xml::check(&bytes).map(|()| bytes);
    }
    if extension == "stl" { told_apart(bytes) } else { Ok(bytes) }
}

/// Binary STL files may begin with the word by which the parser knows text, as their first 80 bytes are anything. Those
/// with a byte that no text has are binary, must have the triangles that they count, 50 bytes each, and get other first
/// bytes.
fn told_apart(mut bytes: Vec<u8>) -> Result<Vec<u8>, String> {
    const WORD: &[u8] = b"solid";
    const COUNT: std::ops::Range<usize> = 80..84;
    if bytes.trim_ascii_start().starts_with(WORD) && !bytes.contains(&0) {
        return Ok(bytes);
    }
    let count = bytes.get(COUNT).and_then(|count| Some(u32::from_le_bytes(count.try_into().ok()?)));
    let count = count.ok_or("it is not a whole STL file")?;
    let has = (bytes.len() - COUNT.end) / 50;
    if u64::from(count) != has as u64 {
        return Err(format!("it is not a whole STL file: it counts {count} triangles and has {has}"));
    }
    bytes[..COUNT.start].fill(b' ');
    Ok(bytes)
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

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(name: &str, bytes: Vec<u8>) -> String {
        checked(bytes, Path::new(name)).expect_err(name)
    }

    #[test]
    fn what_a_file_announces_it_must_hold() {
        let stl = |count: u32, triangles: usize| {
            [&[b'x'; 80][..], &count.to_le_bytes(), &vec![0; 50 * triangles]].concat()
        };
        assert!(checked(stl(1, 1), Path::new("a.STL")).is_ok());
        let words = refusal("a.stl", stl(u32::MAX, 1));
        assert!(words.contains("it counts 4294967295 triangles and has 1"), "{words}");
        refusal("a.stl", stl(2, 2)[..134].to_vec());
        let nested = |depth: usize| ["<a>".repeat(depth), "</a>".repeat(depth)].concat().into_bytes();
        assert!(checked(nested(256), Path::new("a.dae")).is_ok());
        assert!(refusal("a.dae", nested(200_000)).contains("nested deeper than 256"));
        assert!(refusal("a.dae", b"<p count=\"4294967295\"/>".to_vec()).contains("more than the file holds"));
        assert!(refusal("a.dae", b"<Name_array>a b</Name_array>".to_vec()).contains("has names"));
    }
}
