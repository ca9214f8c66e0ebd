//! What is mutated: the pages of the workspace, and the modules that were generated from them.

use std::fs;
use std::path::{Path, PathBuf};

/// Pages and modules by their names.
pub struct Corpus {
    pub pages: Vec<(String, String)>,
    pub modules: Vec<Emitted>,
}

/// A page with its module and the exact constants of its literals.
pub struct Emitted {
    pub page: String,
    pub module: String,
    pub constants: String,
}

/// The longest module that is tampered with: the others take the verifier seconds.
const LONGEST_MODULE: usize = 150_000;

impl Corpus {
    /// Reads them from the workspace.
    pub fn read() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let shipped = texts(&root.join("models"));
        let of_tests = texts(&root.join("tests/models"));
        let mut modules = emitted(&shipped, &root.join("gyro-sim/src/generated"));
        modules.extend(emitted(&of_tests, &root.join("tests/support/generated")));
        let bad = texts(&root.join("tests/bad-models"));
        let pages = shipped.into_iter().chain(of_tests).chain(bad);
        let corpus = Self { pages: pages.map(|(path, text)| (name(&path), text)).collect(), modules };
        assert!(
            !corpus.pages.is_empty() && !corpus.modules.is_empty(),
            "the workspace has pages and modules"
        );
        corpus
    }
}

fn name(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

fn texts(folder: &Path) -> Vec<(PathBuf, String)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut pages: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    pages.sort();
    pages.into_iter().filter_map(|path| Some((path.clone(), fs::read_to_string(path).ok()?))).collect()
}

fn emitted(pages: &[(PathBuf, String)], folder: &Path) -> Vec<Emitted> {
    let of_page = |(path, text): &(PathBuf, String)| {
        let file = folder.join(name(path).replace('-', "_"));
        let module = fs::read_to_string(file.with_extension("rs")).ok()?;
        let constants = fs::read_to_string(file.with_extension("exact")).ok()?;
        let is_short = module.len() <= LONGEST_MODULE;
        is_short.then(|| Emitted { page: text.clone(), module, constants })
    };
    pages.iter().filter_map(of_page).collect()
}
