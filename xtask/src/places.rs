//! Where pages and their generated modules are in the workspace.

use crate::failure::Failure;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Where pages and their generated modules are in the workspace.
#[derive(Clone, Debug)]
pub(crate) struct Places {
    pub(crate) models: PathBuf,
    pub(crate) generated: PathBuf,
}

impl Places {
    /// What is shipped, what only tests need, and what the firmware runs.
    pub(crate) fn of_workspace(root: &Path) -> [Self; 3] {
        let (shipped, tests) = (root.join("gyro-sim").join("src"), root.join("tests"));
        let (firmware, scenes) = (root.join("embedded"), root.join("embedded").join("scenes").join("src"));
        [
            Self { models: root.join("models"), generated: shipped.join("generated") },
            Self { models: tests.join("models"), generated: tests.join("support").join("generated") },
            Self { models: firmware.join("models"), generated: scenes.join("mechanisms") },
        ]
    }
}

/// The pages of the workspace, in the order of their names.
pub(crate) fn all_pages(places: &[Places]) -> Result<Vec<PathBuf>, Failure> {
    let mut pages = Vec::new();
    for place in places {
        pages.extend(
            listing(&place.models)?.into_iter().filter(|p| p.extension().is_some_and(|e| e == "toml")),
        );
    }
    Ok(pages)
}

/// Where a page's module is: in the workspace, or beside the page.
pub(crate) fn module_path(places: &[Places], page: &Path, name: &str) -> PathBuf {
    let file = format!("{name}.rs");
    match places.iter().find(|place| is_in(page, &place.models)) {
        Some(place) => place.generated.join(file),
        None => page.with_file_name(file),
    }
}

pub(crate) fn listing(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let failure = |e: io::Error| Failure::Usage(format!("{} cannot be read: {e}", folder.display()));
    let entries: io::Result<Vec<PathBuf>> =
        fs::read_dir(folder).map_err(failure)?.map(|entry| Ok(entry?.path())).collect();
    let mut paths = entries.map_err(failure)?;
    paths.sort();
    Ok(paths)
}

pub(crate) fn is_in(page: &Path, folder: &Path) -> bool {
    match (fs::canonicalize(page), fs::canonicalize(folder)) {
        (Ok(page), Ok(folder)) => page.parent() == Some(&folder),
        _ => false,
    }
}
