//! Where model files, their data sheets and the modules that are kept are in the workspace.

use crate::failure::Failure;
use crate::files;
use crate::invocation::program;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// A folder of model files, and what is kept in the repository of what is made of them.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    pub(crate) models: PathBuf,
    /// The data sheet of every model file.
    pub(crate) sheets: PathBuf,
    /// Folders of modules, with the names of those that are in them. All others are generated when they are compiled.
    pub(crate) kept: Vec<(PathBuf, &'static [&'static str])>,
}

/// The modules that are kept to be read.
const GOLDEN: [&str; 2] = ["gyroscope_maximal", "heavy_top"];

impl Place {
    /// The gallery, what only tests need, and what the firmware runs; none for a program that is not in a workspace.
    pub(crate) fn all() -> Vec<Self> {
        files::workspace().map_or_else(Vec::new, |root| Self::of_workspace(root).to_vec())
    }

    fn of_workspace(root: &Path) -> [Self; 3] {
        let (gallery, tests, firmware) = (root.join("mechanisms"), root.join("tests"), root.join("embedded"));
        let kept = vec![
            (root.join("gyro-sim").join("src").join("generated"), &["gyroscope"][..]),
            (gallery.join("src").join("golden"), &GOLDEN[..]),
        ];
        [
            Self { models: root.join("models"), sheets: gallery.join("sheets"), kept },
            Self { models: tests.join("models"), sheets: tests.join("sheets"), kept: Vec::new() },
            Self { models: firmware.join("models"), sheets: firmware.join("sheets"), kept: Vec::new() },
        ]
    }

    /// Where the module of this name is kept, if it is.
    pub(crate) fn module(&self, name: &str) -> Option<PathBuf> {
        let (folder, _) = self.kept.iter().find(|(_, names)| names.contains(&name))?;
        Some(folder.join(name).with_extension("rs"))
    }

    /// Where the data sheet of this name is.
    pub(crate) fn sheet(&self, name: &str) -> PathBuf {
        self.sheets.join(name).with_extension("txt")
    }
}

/// The model files of the workspace, in the order of their names.
pub(crate) fn all_model_files(places: &[Place]) -> Result<Vec<PathBuf>, Failure> {
    if places.is_empty() {
        return Err(no_model_file());
    }
    let mut pages = Vec::new();
    for place in places {
        pages.extend(
            listing(&place.models)?.into_iter().filter(|p| p.extension().is_some_and(|e| e == "toml")),
        );
    }
    Ok(pages)
}

/// What is wrong where all model files of the workspace are meant and there is none.
pub(crate) fn no_model_file() -> Failure {
    Failure::Usage(format!("a model file is expected: {} new NAME writes one to start from", program()))
}

/// The place that a model file belongs to, unless it is from elsewhere.
pub(crate) fn place_of<'p>(places: &'p [Place], page: &Path) -> Option<&'p Place> {
    places.iter().find(|place| is_in(page, &place.models))
}

/// Where a model file's module is: beside a model file from elsewhere; nowhere if it is generated when it is compiled.
pub(crate) fn module_path(places: &[Place], page: &Path, name: &str) -> Option<PathBuf> {
    match place_of(places, page) {
        Some(place) => place.module(name),
        None => Some(page.with_file_name(format!("{name}.rs"))),
    }
}

pub fn listing(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let said = |e: io::Error| Failure::Usage(format!("{} cannot be read: {e}", folder.display()));
    let entries: io::Result<Vec<PathBuf>> =
        fs::read_dir(folder).map_err(said)?.map(|entry| Ok(entry?.path())).collect();
    let mut paths = entries.map_err(said)?;
    paths.sort();
    Ok(paths)
}

fn is_in(page: &Path, folder: &Path) -> bool {
    match (fs::canonicalize(page), fs::canonicalize(folder)) {
        (Ok(page), Ok(folder)) => page.parent() == Some(&folder),
        _ => false,
    }
}
