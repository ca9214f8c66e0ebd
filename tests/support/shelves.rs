//! The pages of models with their generated mechanisms: those that are shipped and those for tests alone.

use crate::generated as own;
use gyro_codegen::Module;
use gyro_model::{Model, Tree};
use gyro_sim::generated as shipped;
use gyro_sim::{Equations, Partition, Ports, Real};
use std::path::{Path, PathBuf};

/// A folder of pages and the folder of their generated modules.
#[derive(Clone, Debug)]
pub struct Shelf {
    /// Pages.
    pub models: PathBuf,
    /// Modules.
    pub generated: PathBuf,
}

/// A mechanism that does everything there is to do.
pub trait Engine<T>: Partition<Scalar = T> + Equations + Ports + Clone {}
impl<T, M: Partition<Scalar = T> + Equations + Ports + Clone> Engine<T> for M {}

/// What a test does with a mechanism of any type.
pub trait Check<T: Real> {
    /// Checks the mechanism of a page, named without its extension.
    fn check<M: Engine<T>>(&mut self, page: &str, mechanism: &M);
}

/// Checks the generated mechanism of every page, shipped or not.
pub fn for_each_generated<T: Real>(check: &mut impl Check<T>) {
    for page in pages() {
        with_generated(&page, check);
    }
}

/// Checks the generated mechanism of one page.
///
/// # Panics
/// If the page has no generated mechanism here: every page must have one.
pub fn with_generated<T: Real>(page: &str, check: &mut impl Check<T>) {
    match page {
        "all-joints" => check.check(page, &own::all_joints::AllJoints::default()),
        "cam" => check.check(page, &own::cam::Cam::default()),
        "carried" => check.check(page, &own::carried::Carried::default()),
        "carried-block" => check.check(page, &own::carried_block::CarriedBlock::default()),
        "compound-pendulum" => check.check(page, &shipped::compound_pendulum::CompoundPendulum::default()),
        "cylindrical" => check.check(page, &own::cylindrical::Cylindrical::default()),
        "driven-four-bar" => check.check(page, &own::driven_four_bar::DrivenFourBar::default()),
        "driven-gyroscope" => check.check(page, &shipped::driven_gyroscope::DrivenGyroscope::default()),
        "four-bar" => check.check(page, &shipped::four_bar::FourBar::default()),
        "four-bar-revolute" => check.check(page, &shipped::four_bar_revolute::FourBarRevolute::default()),
        "free-body" => check.check(page, &shipped::free_body::FreeBody::default()),
        "friction" => check.check(page, &own::friction::Friction::default()),
        "gear" => check.check(page, &own::gear::Gear::default()),
        "gyroscope" => check.check(page, &shipped::gyroscope::Gyroscope::default()),
        "gyroscope-bearings" => check.check(page, &own::gyroscope_bearings::GyroscopeBearings::default()),
        "gyroscope-combined-offsets" => {
            check.check(page, &shipped::gyroscope_combined_offsets::GyroscopeCombinedOffsets::default())
        }
        "gyroscope-free-nutation" => {
            check.check(page, &shipped::gyroscope_free_nutation::GyroscopeFreeNutation::default())
        }
        "gyroscope-maximal" => check.check(page, &shipped::gyroscope_maximal::GyroscopeMaximal::default()),
        "gyroscope-parameters" => {
            check.check(page, &shipped::gyroscope_parameters::GyroscopeParameters::default())
        }
        "gyroscope-radial-imbalance" => {
            check.check(page, &shipped::gyroscope_radial_imbalance::GyroscopeRadialImbalance::default())
        }
        "gyroscope-viscous" => check.check(page, &shipped::gyroscope_viscous::GyroscopeViscous::default()),
        "heavy-top" => check.check(page, &shipped::heavy_top::HeavyTop::default()),
        "loads" => check.check(page, &own::loads::Loads::default()),
        "motor" => check.check(page, &own::motor::Motor::default()),
        "parallelogram" => check.check(page, &own::parallelogram::Parallelogram::default()),
        "pendulum" => check.check(page, &own::pendulum::Pendulum::default()),
        "pitching-bearings" => check.check(page, &own::pitching_bearings::PitchingBearings::default()),
        "pitching-gyroscope" => check.check(page, &shipped::pitching_gyroscope::PitchingGyroscope::default()),
        "planar" => check.check(page, &own::planar::Planar::default()),
        "point-on-line" => check.check(page, &own::point_on_line::PointOnLine::default()),
        "prismatic" => check.check(page, &own::prismatic::Prismatic::default()),
        "rod" => check.check(page, &own::rod::Rod::default()),
        "screw" => check.check(page, &own::screw::Screw::default()),
        "spherical" => check.check(page, &own::spherical::Spherical::default()),
        "spinning-top" => check.check(page, &shipped::spinning_top::SpinningTop::default()),
        "stops" => check.check(page, &own::stops::Stops::default()),
        "tether" => check.check(page, &own::tether::Tether::default()),
        "torsion" => check.check(page, &shipped::torsion::Torsion::default()),
        "universal" => check.check(page, &own::universal::Universal::default()),
        "weld" => check.check(page, &own::weld::Weld::default()),
        _ => panic!("{page}.toml has no line in tests/support/shelves.rs: add it"),
    }
}

/// Where pages and modules are: the shipped ones, then those for tests.
pub fn shelves() -> [Shelf; 2] {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    [("models", "gyro-sim/src/generated"), ("tests/models", "tests/support/generated")]
        .map(|(models, generated)| Shelf { models: root.join(models), generated: root.join(generated) })
}

impl Shelf {
    /// Its pages in the order of their names, without extension.
    pub fn pages(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.models).expect("the folder is part of the project");
        let mut pages: Vec<String> = entries
            .map(|entry| entry.expect("its entries can be read").path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
            .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
            .collect();
        pages.sort();
        pages
    }
}

/// All pages, those for tests last.
pub fn pages() -> Vec<String> {
    shelves().iter().flat_map(Shelf::pages).collect()
}

/// The text of a page.
pub fn page(name: &str) -> String {
    text(&path(name))
}

/// The model of a page.
pub fn model(name: &str) -> Model {
    let model = gyro_model::read_with(&file_name(name), &page(name), &mut |table| Ok(table_of(name, table)));
    model.unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// The generated module of a page.
pub fn module(name: &str) -> Module {
    let load = &mut |table: &str| Ok(table_of(name, table));
    let module = gyro_codegen::generate_with(&file_name(name), &page(name), load);
    module.unwrap_or_else(|error| panic!("{error}"))
}

/// Whether a model's joints can be given any coordinates: trees, nothing of which is driven or coupled.
pub fn is_open(model: &Model) -> bool {
    Tree::of(model).loop_joints.is_empty() && model.couplers.is_empty() && model.drivers.is_empty()
}

/// As `cargo xtask generate` names the page in its module's first line.
fn file_name(page: &str) -> String {
    format!("{page}.toml")
}

fn path(page: &str) -> PathBuf {
    let paths = shelves().map(|shelf| shelf.models.join(file_name(page)));
    let found = paths.into_iter().find(|path| path.exists());
    found.unwrap_or_else(|| panic!("there is no page {page}.toml"))
}

/// The text of a table that a page names.
fn table_of(page: &str, table: &str) -> String {
    text(&path(page).with_file_name(table))
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}
