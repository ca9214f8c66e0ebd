//! The folder that a run writes to: found out before the run whether it can be used, and left as it was if nothing is
//! written.

use crate::failure::Failure;
use std::fs;
use std::path::{Path, PathBuf};

/// A folder that is there. Dropped, it takes those away that were made for it and hold nothing.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    /// The outermost first.
    made: Vec<PathBuf>,
}

impl Folder {
    /// Makes the folder, and those around it, unless it is there.
    pub(crate) fn open(path: &Path) -> Result<Self, Failure> {
        let is_missing = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
        let mut made: Vec<PathBuf> = path.ancestors().take_while(is_missing).map(Path::to_path_buf).collect();
        made.reverse();
        let folder = Self { path: path.to_path_buf(), made };
        fs::create_dir_all(path)
            .map_err(|e| Failure::Usage(format!("--out: {} cannot be made: {e}", path.display())))?;
        Ok(folder)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}

/// Where a file goes that `--out` names, or the folder for it.
pub(crate) fn file(out: &Path, name: &str) -> PathBuf {
    if out.is_dir() { out.join(name) } else { out.to_path_buf() }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Only what is empty goes.
        let _ = self.made.iter().rev().try_for_each(fs::remove_dir);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_holds_nothing_goes_and_the_rest_stays() {
        let root = std::env::temp_dir().join(format!("xtask-folder-{}", std::process::id()));
        fs::create_dir_all(&root).unwrap();
        let deep = root.join("a/b");
        drop(Folder::open(&deep).unwrap());
        assert!(root.exists() && !root.join("a").exists());
        let folder = Folder::open(&deep).unwrap();
        fs::write(folder.path().join("x.csv"), "").unwrap();
        drop(folder);
        assert!(deep.join("x.csv").exists());
        assert!(matches!(Folder::open(&deep.join("x.csv/c")), Err(Failure::Usage(_))));
        fs::remove_dir_all(&root).unwrap();
    }
}
