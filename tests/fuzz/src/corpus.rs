//! What is mutated: the model files of the workspace, and the modules that are generated from them.

use gyro_model::{Model, read_with};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Model files by their names, and modules.
pub struct Corpus {
    pub pages: Vec<(String, String)>,
    pub modules: Vec<Emitted>,
}

/// A model file with its module and the exact constants of its literals, which are generated when they are first asked
/// for.
pub struct Emitted {
    pub page: String,
    module: OnceLock<[String; 2]>,
}

/// What every motion by a table follows.
pub const TABLE: &str = "t,x\n0,0\n1,0.5\n2,1\n";

/// Bodies of the largest model file whose module is tampered with: the others take generator and verifier seconds.
const BODIES: usize = 3;

impl Corpus {
    /// Reads them from the workspace.
    pub fn read() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let good: Vec<(PathBuf, String)> =
            ["models", "tests/models"].iter().flat_map(|folder| texts(&root.join(folder))).collect();
        let modules: Vec<Emitted> = good.iter().filter_map(|(_, text)| Emitted::of(text)).collect();
        let pages = good.into_iter().chain(texts(&root.join("tests/bad-models")));
        let corpus = Self { pages: pages.map(|(path, text)| (name(&path), text)).collect(), modules };
        assert!(
            !corpus.pages.is_empty() && !corpus.modules.is_empty(),
            "the workspace has model files and modules"
        );
        corpus
    }
}

impl Emitted {
    /// The module of a model file that is small enough.
    fn of(page: &str) -> Option<Self> {
        let model = model(page);
        (model.coordinate_bodies().len() <= BODIES)
            .then(|| Self { page: page.to_owned(), module: OnceLock::new() })
    }

    /// The module and its constants.
    pub fn module(&self) -> &[String; 2] {
        self.module.get_or_init(|| {
            let module = gyro_codegen::generate_functions(
                "fuzz.toml",
                &model(&self.page),
                &gyro_codegen::Functions::all(),
            );
            let module = module.expect("a model file of the workspace has a module");
            [module.code, module.constants]
        })
    }
}

/// The model of a model file of the workspace.
fn model(page: &str) -> Model {
    read_with("fuzz.toml", page, &mut |_| Ok(TABLE.to_owned()))
        .expect("a model file of the workspace is good")
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
