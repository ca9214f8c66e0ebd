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

/// Vertices, and triangles of these.
pub(crate) type Surface = (Vec<[f32; 3]>, Vec<[u32; 3]>);

/// All of a file.
pub(crate) fn surface(path: &Path) -> io::Result<Surface> {
    let scene = parsed(whole(files::bytes(path, LARGEST)?, path)?, path)?;
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for part in &scene.meshes {
        let first = u32::try_from(vertices.len()).unwrap_or(u32::MAX);
        vertices.extend_from_slice(&part.vertices);
        triangles.extend(part.faces.iter().map(|face| face.map(|k| k.saturating_add(first))));
    }
    Ok((vertices, triangles))
}

/// The deepest nesting of elements in a file: the parser calls itself for each.
const DEEPEST: usize = 200;

/// Bytes that the parser can be given: it believes the number of triangles that a file claims, and any depth.
fn whole(bytes: Vec<u8>, path: &Path) -> io::Result<Vec<u8>> {
    let refused = |words: String| io::Error::new(io::ErrorKind::InvalidData, words);
    let is = |extension: &str| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension));
    if is("dae")
        && let Some(words) = unreadable(&bytes)
    {
        return Err(refused(words));
    }
    let bytes = told_apart(bytes);
    let is_text = !is("stl") || bytes.starts_with(WORD);
    let claimed = bytes.get(COUNT).and_then(|count| Some(u32::from_le_bytes(count.try_into().ok()?)));
    let there = bytes.len().saturating_sub(COUNT.end) as u64 / TRIANGLE;
    match claimed.filter(|claimed| !is_text && u64::from(*claimed) > there) {
        Some(claimed) => Err(refused(format!("it claims {claimed} triangles and has {there}"))),
        None => Ok(bytes),
    }
}

/// Why the parser cannot be given a text of COLLADA: it calls itself for each element within another, makes room for as
/// many numbers as are claimed, and never ends with arrays of names.
fn unreadable(text: &[u8]) -> Option<String> {
    if depth(text) > DEEPEST {
        return Some(format!("its elements are nested deeper than {DEEPEST}"));
    }
    let text = String::from_utf8_lossy(text);
    let digits = |rest: &str| {
        rest.trim_start_matches(['"', '\'', ' '])
            .split(|c: char| !c.is_ascii_digit())
            .next()
            .map(str::to_owned)
    };
    let is_there =
        |count: &String| !count.is_empty() && count.parse().is_ok_and(|n: u64| n <= text.len() as u64);
    for key in ["count", "offset", "stride"] {
        let key_is = format!("{key}=");
        let mut claims = text.split(&key_is).skip(1).filter_map(digits);
        if let Some(claimed) = claims.find(|count| !is_there(count)) {
            return Some(format!("it claims a {key} of {claimed}, more than it has characters"));
        }
    }
    let names = ["<Name_array", "<IDREF_array"].into_iter().find(|names| text.contains(names));
    names.map(|names| format!("{names}> is not read: skeletons are no surfaces"))
}

/// How deep the elements of an XML text are nested at most: an element opens where a name follows `<`, unless it ends
/// with `/>`. What comments and quoted texts hold may be counted, too.
fn depth(text: &[u8]) -> usize {
    let (mut depth, mut deepest) = (0usize, 0);
    for tag in text.split(|c| *c == b'<').skip(1) {
        let end = tag.iter().position(|c| *c == b'>').unwrap_or(tag.len());
        match tag.first() {
            Some(b'/') => depth = depth.saturating_sub(1),
            Some(c) if c.is_ascii_alphabetic() && !tag[..end].ends_with(b"/") => depth += 1,
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    deepest
}

/// The word by which the parser knows an STL file of text; where a binary one counts its triangles, and their size.
const WORD: &[u8] = b"solid";
const COUNT: std::ops::Range<usize> = 80..84;
const TRIANGLE: u64 = 50;

/// Binary STL files may begin with the word by which the parser knows text, as their first 80 bytes are anything. They
/// are known by their length, 50 bytes for each of the triangles that they count, and get other first bytes.
fn told_apart(mut bytes: Vec<u8>) -> Vec<u8> {
    let count = bytes.get(COUNT).and_then(|count| Some(u32::from_le_bytes(count.try_into().ok()?)));
    let is_binary = |count| COUNT.end as u64 + TRIANGLE * u64::from(count) == bytes.len() as u64;
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

#[cfg(test)]
mod tests;
