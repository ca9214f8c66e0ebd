//! The model files of models, those that are shipped and those for tests alone, with their generated mechanisms:
//! derived and compiled in this process, each when it is first asked for. Their functions have the bits that rustc
//! gives those of modules (`jit/tests`).

use crate::{Duals, Engine};
use gyro_assembled::{Careful, Dense};
use gyro_codegen::{Effort, Functions, Module};
use gyro_jit::{Compiled, Interpreted, Native};
use gyro_model::{Model, Tree};
use gyro_sim::{JointSpace, Real, Scalar};
use std::any::Any;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

/// A folder of model files.
#[derive(Clone, Debug)]
pub struct FixtureFolder(PathBuf);

/// Does something with the generated mechanism of every model file, shipped or not.
pub fn for_each_generated(mut check: impl FnMut(&str, &Engine)) {
    for page in pages() {
        check(&page, &generated(&page));
    }
}

/// A mechanism that is compiled once, by whoever asks first.
type Once = Arc<Mutex<Option<Compiled<f64>>>>;

/// What has been compiled, by model files: a lock for each, so that tests wait only for what they need.
static COMPILED: LazyLock<Mutex<HashMap<String, Once>>> = LazyLock::new(Mutex::default);

/// The generated mechanism of a model file, with the functions that it names, else those that solvers call.
///
/// # Panics
/// If there is no such model file, or this machine is none for which code can be compiled.
pub fn compiled<T: Native + Real>(page: &str) -> Compiled<T> {
    let all =
        COMPILED.lock().unwrap_or_else(PoisonError::into_inner).entry(page.to_owned()).or_default().clone();
    let mut known = all.lock().unwrap_or_else(PoisonError::into_inner);
    let double = known.get_or_insert_with(|| {
        let model = model(page);
        let named = model.functions.as_ref().map(|names| Functions::named(names.iter().map(String::as_str)));
        let functions = named.transpose().expect("a model file names functions that there are");
        let compiled =
            gyro_jit::compile(&model, &functions.unwrap_or_else(Functions::of_solvers), Effort::Full);
        compiled.unwrap_or_else(|error| panic!("{page}: {error}"))
    });
    if let Some(same) = (double as &dyn Any).downcast_ref::<Compiled<T>>() {
        return same.clone();
    }
    double.compiled().unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// The same in other numbers, interpreted.
pub fn interpreted<T: Scalar>(page: &str) -> Interpreted<T> {
    compiled::<f64>(page).interpreted()
}

/// The generated mechanism of a model file; of a tree with its joint coordinates.
pub fn generated(page: &str) -> Engine {
    generated_in(page)
}

/// The same in any precision.
pub fn generated_in<T: Native + Real>(page: &str) -> Engine<T> {
    let compiled = compiled::<T>(page);
    let is_tree = compiled.scheduled().joint.is_some() && compiled.joint_layout().closure_rows.is_empty();
    if is_tree { Engine::of_tree(compiled) } else { Engine::new(compiled) }
}

/// The same, of loops too with joint coordinates.
pub fn generated_with_joints<T: Native + Real>(page: &str) -> Engine<T> {
    Engine::of_tree(compiled(page))
}

/// The same in dual numbers.
pub fn duals<T: Native + Real>(page: &str) -> Duals<T> {
    Duals::new(interpreted(page))
}

/// Generated mechanisms in single precision: each kind of joint, force, motion and partition is in one of them.
pub fn in_single_precision() -> Vec<(&'static str, Engine<f32>)> {
    SINGLE.iter().map(|page| (*page, Engine::new(compiled(page)))).collect()
}

const SINGLE: [&str; 23] = [
    "cam",
    "curves",
    "cylindrical",
    "driven-gyroscope",
    "electric",
    "four-bar-revolute",
    "free-body",
    "friction",
    "gear",
    "gyroscope-maximal",
    "gyroscope-parameters",
    "loads",
    "motor",
    "pendulum",
    "planar",
    "point-on-line",
    "rod",
    "screw",
    "stabilised-gimbal",
    "stops",
    "tether",
    "universal",
    "weld",
];

/// Extreme scenes, and the plain ones that they are variants of.
pub const EXTREME: [&str; 13] = [
    "gyroscope",
    "gyroscope-fast",
    "gyroscope-at-rest",
    "gyroscope-light-rings",
    "gyroscope-heavy-rotor",
    "gyroscope-gimbal-lock",
    "gyroscope-stiff",
    "gyroscope-overdamped",
    "gyroscope-coulomb",
    "gyroscope-rolling-base",
    "gyroscope-long",
    "four-bar",
    "four-bar-in-line",
];

/// The careful runtime-assembled model of a model.
///
/// # Panics
/// If it does not support the model.
pub fn careful(model: &Model) -> Engine {
    Engine::new(Careful::<f64>::new(model).unwrap_or_else(|error| panic!("{}: {error}", model.name)))
}

/// The dense runtime-assembled model of a model.
///
/// # Panics
/// If the model cannot be assembled.
pub fn dense(model: &Model) -> Engine {
    Engine::new(Dense::<f64>::new(model).unwrap_or_else(|error| panic!("{}: {error}", model.name)))
}

/// Where model files are: the shipped ones, then those for tests.
pub fn fixture_folders() -> [FixtureFolder; 2] {
    ["models", "tests/models"].map(|folder| FixtureFolder(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)))
}

impl FixtureFolder {
    /// Its model files in the order of their names, without extension.
    pub fn pages(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("the folder is part of the project");
        let mut pages: Vec<String> = entries
            .map(|entry| entry.expect("its entries can be read").path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
            .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
            .collect();
        pages.sort();
        pages
    }
}

/// All model files, those for tests last.
pub fn pages() -> Vec<String> {
    fixture_folders().iter().flat_map(FixtureFolder::pages).collect()
}

/// The text of a model file.
pub fn page(name: &str) -> String {
    text(&path(name))
}

/// The model of a model file.
pub fn model(name: &str) -> Model {
    let model = gyro_model::read_with(&file_name(name), &page(name), &mut |table| Ok(table_of(name, table)));
    model.unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// The generated module of a model file, with the functions that solvers call.
pub fn module(name: &str) -> Module {
    let module = gyro_codegen::generate_functions(&file_name(name), &model(name), &Functions::of_solvers());
    module.unwrap_or_else(|error| panic!("{error}"))
}

/// Whether a model's joints can be given any coordinates: trees, nothing of which is driven or coupled.
pub fn is_open(model: &Model) -> bool {
    Tree::of(model).loop_joints.is_empty() && model.couplers.is_empty() && model.drivers.is_empty()
}

/// As `cargo xtask generate` names the model file in its module's first line.
fn file_name(page: &str) -> String {
    format!("{page}.toml")
}

fn path(page: &str) -> PathBuf {
    let paths = fixture_folders().map(|folder| folder.0.join(file_name(page)));
    let found = paths.into_iter().find(|path| path.exists());
    found.unwrap_or_else(|| panic!("there is no model file {page}.toml"))
}

/// The text of a table that a model file names.
fn table_of(page: &str, table: &str) -> String {
    text(&path(page).with_file_name(table))
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
