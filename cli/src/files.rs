//! Reading files, and where the workspace is.

use crate::failure::Failure;
use crate::write::{self, Known};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::{fs, io};

/// The root of the workspace that this program was built from: for programs that cannot be anywhere else.
pub fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().unwrap_or(own).to_path_buf()
}

/// The root of the workspace that this program was built from, if it is run from there: an installed program has none,
/// whether or not that folder is still there.
pub(crate) fn workspace() -> Option<&'static Path> {
    static WORKSPACE: OnceLock<Option<PathBuf>> = OnceLock::new();
    let find = || {
        let root = fs::canonicalize(root()).ok()?;
        let is_inside = |path: PathBuf| fs::canonicalize(path).is_ok_and(|path| path.starts_with(&root));
        // Cargo says from where it runs a program, wherever it builds.
        let by_cargo = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
        let is_own = std::env::current_exe().is_ok_and(is_inside) || by_cargo.is_some_and(is_inside);
        is_own.then_some(root)
    };
    WORKSPACE.get_or_init(find).as_deref()
}

/// The largest model file, and the largest robot, that is read: a hundred times what a mechanism of five hundred bodies
/// takes.
pub const LARGEST_MODEL_FILE: u64 = 4 << 20;

/// The largest table of a motion or an input that is read: two million rows and more.
pub const LARGEST_TABLE: u64 = 64 << 20;

/// The text of a file that the run depends on, which nothing may overwrite from now on.
pub fn input(path: &Path, largest: u64) -> io::Result<String> {
    let text = text(path, largest)?;
    write::note_input(path);
    Ok(text)
}

/// The bytes of an ordinary file that is not too large: a pipe or a device might have no end.
pub fn bytes(path: &Path, largest: u64) -> io::Result<Vec<u8>> {
    // Before it is opened: opening a pipe waits for its other end.
    let found = fs::metadata(path)?;
    if !found.is_file() {
        let what = if found.is_dir() { "it is a folder" } else { "it is a pipe or a device, not a file" };
        return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    }
    let mut bytes = Vec::new();
    fs::File::open(path)?.take(largest + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest {
        let words = format!("it is larger than {} MB, the most that is read", largest >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, words));
    }
    Ok(bytes)
}

/// The same of a text.
pub fn text(path: &Path, largest: u64) -> io::Result<String> {
    String::from_utf8(bytes(path, largest)?).map_err(|e| {
        let at = e.utf8_error().valid_up_to();
        io::Error::new(
            io::ErrorKind::InvalidData,
            format!("not UTF-8 text: byte {at} belongs to no character"),
        )
    })
}

/// The text of a model file.
pub fn read_module(path: &Path) -> Result<String, Failure> {
    input(path, LARGEST_MODEL_FILE).map_err(|e| Failure::Usage(unreadable(path, &e)))
}

/// The text of a page of the documentation that is to be brought up to date.
pub fn read_template(path: &Path) -> Result<String, Failure> {
    text(path, LARGEST_MODEL_FILE).map_err(|e| Failure::Usage(unreadable(path, &e)))
}

fn unreadable(path: &Path, error: &io::Error) -> String {
    if error.kind() == io::ErrorKind::InvalidData {
        return format!("{}: {error}", path.display());
    }
    let words = format!("{} cannot be read: {error}", path.display());
    let file_name = format!("{}.toml", path.file_stem().unwrap_or_default().to_string_lossy());
    let shipped = workspace().map(|root| root.join("models").join(file_name));
    match shipped.filter(|shipped| error.kind() == io::ErrorKind::NotFound && shipped.is_file()) {
        Some(shipped) => format!("{words}; there is {}", shipped.display()),
        None => words,
    }
}

/// Writes a file in a place of the tool's own. Returns whether it was written: not if it has this text already.
pub fn write(path: &Path, text: &str) -> Result<bool, Failure> {
    write::write(path, text, Known::Place)
}

/// A path as messages and generated files show it: relative to the workspace if inside of it, with slashes.
pub fn shown(path: &Path) -> String {
    let inside = fs::canonicalize(path)
        .ok()
        .and_then(|full| full.strip_prefix(workspace()?).ok().map(Path::to_path_buf));
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
    fn pages_that_cannot_be_read_are_named() {
        let folder = Folder::new();
        let path = folder.0.join("x.toml");
        fs::write(&path, b"name = \"\xff\"").unwrap();
        let Err(Failure::Usage(words)) = read_module(&path) else { panic!("not UTF-8") };
        assert!(words.contains("x.toml: not UTF-8 text: byte 8"), "{words}");
        let Err(Failure::Usage(words)) = read_module(&folder.0.join("none.toml")) else { panic!("no file") };
        assert!(words.contains("none.toml cannot be read"), "{words}");
    }

    #[test]
    fn what_is_no_file_or_too_large_is_refused() {
        let folder = Folder::new();
        let path = folder.0.join("x.csv");
        fs::write(&path, "t,x\n").unwrap();
        assert_eq!(text(&path, 4).unwrap(), "t,x\n");
        assert!(text(&path, 3).unwrap_err().to_string().contains("larger than"));
        assert!(text(&folder.0, 4).unwrap_err().to_string().contains("folder"));
        #[cfg(unix)]
        assert!(text(Path::new("/dev/zero"), 4).unwrap_err().to_string().contains("device"));
        #[cfg(unix)]
        {
            let pipe = folder.0.join("pipe");
            assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
            assert!(text(&pipe, 4).unwrap_err().to_string().contains("pipe"));
        }
    }
}
