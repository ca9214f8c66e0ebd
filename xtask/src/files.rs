//! Reading and writing files, whole or not at all.

use crate::failure::Failure;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The root of the workspace that this program was built from.
pub(crate) fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).to_path_buf()
}

/// The text of a model page.
pub(crate) fn read_page(path: &Path) -> Result<String, Failure> {
    let bytes = fs::read(path).map_err(|e| Failure::Usage(unreadable(path, &e)))?;
    String::from_utf8(bytes).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        Failure::Usage(format!("{}: not UTF-8 text: byte {at} belongs to no character", path.display()))
    })
}

fn unreadable(path: &Path, error: &io::Error) -> String {
    let words = format!("{} cannot be read: {error}", path.display());
    let file_name = format!("{}.toml", path.file_stem().unwrap_or_default().to_string_lossy());
    let shipped = root().join("models").join(file_name);
    if error.kind() == io::ErrorKind::NotFound && shipped.is_file() {
        format!("{words}; there is {}", shipped.display())
    } else {
        words
    }
}

/// Whether a file is there with just this text.
pub(crate) fn holds(path: &Path, text: &str) -> bool {
    fs::read(path).is_ok_and(|old| old == text.as_bytes())
}

/// Writes a file unless it has this text already, through a neighbour that is renamed, so that the file is always
/// whole. Returns whether it was written.
pub(crate) fn write_if_changed(path: &Path, text: &str) -> io::Result<bool> {
    if holds(path, text) {
        return Ok(false);
    }
    let file_name = path.file_name().unwrap_or_default().to_string_lossy();
    let neighbour = path.with_file_name(format!(".{file_name}.{}", std::process::id()));
    let written = fs::write(&neighbour, text).and_then(|()| fs::rename(&neighbour, path));
    if written.is_err() {
        // The first error is the one to tell.
        let _ = fs::remove_file(&neighbour);
    }
    written.map(|()| true)
}

/// The same, in a folder that is made if need be; an error is the command's failure.
pub(crate) fn write(path: &Path, text: &str) -> Result<bool, Failure> {
    let made = path.parent().map_or(Ok(()), fs::create_dir_all);
    made.and_then(|()| write_if_changed(path, text))
        .map_err(|e| Failure::Run(format!("{} cannot be written: {e}", path.display())))
}

/// A path as messages and generated files show it: relative to the workspace if inside of it, with slashes.
pub(crate) fn shown(path: &Path) -> String {
    let inside = fs::canonicalize(path)
        .ok()
        .and_then(|full| full.strip_prefix(fs::canonicalize(root()).ok()?).ok().map(Path::to_path_buf));
    match inside {
        Some(relative) => relative.to_string_lossy().replace('\\', "/"),
        None => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    /// An empty folder of its own, removed at the end.
    pub(crate) struct Folder(pub(crate) PathBuf);

    impl Folder {
        pub(crate) fn new() -> Self {
            static NEXT: AtomicU32 = AtomicU32::new(0);
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let path = std::env::temp_dir().join(format!("xtask-test-{}-{number}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_file_is_written_once_and_leaves_no_neighbour() {
        let folder = Folder::new();
        let path = folder.0.join("x.rs");
        assert!(write_if_changed(&path, "one").unwrap());
        assert!(!write_if_changed(&path, "one").unwrap());
        assert!(write_if_changed(&path, "two").unwrap());
        assert_eq!(fs::read_to_string(&path).unwrap(), "two");
        assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1);
    }

    #[test]
    fn pages_that_cannot_be_read_are_named() {
        let folder = Folder::new();
        let path = folder.0.join("x.toml");
        fs::write(&path, b"name = \"\xff\"").unwrap();
        let Err(Failure::Usage(words)) = read_page(&path) else { panic!("not UTF-8") };
        assert!(words.contains("x.toml: not UTF-8 text: byte 8"), "{words}");
        let Err(Failure::Usage(words)) = read_page(&folder.0.join("none.toml")) else { panic!("no file") };
        assert!(words.contains("none.toml cannot be read"), "{words}");
    }
}
