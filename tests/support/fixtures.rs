//! The model files of models with their generated mechanisms: those that are shipped and those for tests alone.

use crate::generated as own;
use crate::{Duals, Engine};
use gyro_assembled::{Careful, Dense};
use gyro_codegen::{Functions, Module};
use gyro_mechanisms as shipped;
use gyro_model::{Model, Tree};
use gyro_sim::Real;
use std::path::{Path, PathBuf};

/// A folder of model files.
#[derive(Clone, Debug)]
pub struct FixtureFolder(PathBuf);

/// Does something with the generated mechanism of every model file, shipped or not.
pub fn for_each_generated(mut check: impl FnMut(&str, &Engine)) {
    for page in pages() {
        check(&page, &generated(&page));
    }
}

/// The generated mechanism of a model file.
///
/// # Panics
/// If the model file has no generated mechanism here: every model file must have one.
pub fn generated(page: &str) -> Engine {
    match page {
        "all-joints" => Engine::new(own::all_joints::AllJoints::default()),
        "cam" => Engine::new(own::cam::Cam::default()),
        "carried" => Engine::new(own::carried::Carried::default()),
        "carried-block" => Engine::new(own::carried_block::CarriedBlock::default()),
        "carried-four-bar" => Engine::new(own::carried_four_bar::CarriedFourBar::default()),
        "compound-pendulum" => Engine::of_tree(shipped::compound_pendulum::CompoundPendulum::default()),
        "cylindrical" => Engine::new(own::cylindrical::Cylindrical::default()),
        "differential" => Engine::new(own::differential::Differential::default()),
        "double-wishbone" => Engine::new(shipped::double_wishbone::DoubleWishbone::default()),
        "driven-four-bar" => Engine::new(own::driven_four_bar::DrivenFourBar::default()),
        "driven-gyroscope" => Engine::of_tree(shipped::driven_gyroscope::DrivenGyroscope::default()),
        "driven-shaft" => Engine::new(own::driven_shaft::DrivenShaft::default()),
        "driven-stewart" => Engine::new(own::driven_stewart::DrivenStewart::default()),
        "four-bar" => Engine::new(shipped::four_bar::FourBar::default()),
        "four-bar-in-line" => Engine::new(shipped::four_bar_in_line::FourBarInLine::default()),
        "four-bar-revolute" => Engine::new(shipped::four_bar_revolute::FourBarRevolute::default()),
        "free-body" => Engine::of_tree(shipped::free_body::FreeBody::default()),
        "friction-in-loops" => Engine::new(own::friction_in_loops::FrictionInLoops::default()),
        "friction" => Engine::new(own::friction::Friction::default()),
        "gear" => Engine::new(own::gear::Gear::default()),
        "gear-pair" => Engine::new(own::gear_pair::GearPair::default()),
        "gyroscope" => Engine::of_tree(shipped::gyroscope::Gyroscope::default()),
        "gyroscope-at-rest" => Engine::of_tree(shipped::gyroscope_at_rest::GyroscopeAtRest::default()),
        "gyroscope-bearings" => Engine::new(own::gyroscope_bearings::GyroscopeBearings::default()),
        "gyroscope-combined-offsets" => {
            Engine::of_tree(shipped::gyroscope_combined_offsets::GyroscopeCombinedOffsets::default())
        }
        "gyroscope-coulomb" => Engine::of_tree(shipped::gyroscope_coulomb::GyroscopeCoulomb::default()),
        "gyroscope-fast" => Engine::of_tree(shipped::gyroscope_fast::GyroscopeFast::default()),
        "gyroscope-four-bar" => Engine::new(shipped::gyroscope_four_bar::GyroscopeFourBar::default()),
        "gyroscope-free-nutation" => {
            Engine::of_tree(shipped::gyroscope_free_nutation::GyroscopeFreeNutation::default())
        }
        "gyroscope-gimbal-lock" => {
            Engine::of_tree(shipped::gyroscope_gimbal_lock::GyroscopeGimbalLock::default())
        }
        "gyroscope-heavy-rotor" => {
            Engine::of_tree(shipped::gyroscope_heavy_rotor::GyroscopeHeavyRotor::default())
        }
        "gyroscope-light-rings" => {
            Engine::of_tree(shipped::gyroscope_light_rings::GyroscopeLightRings::default())
        }
        "gyroscope-long" => Engine::of_tree(shipped::gyroscope_long::GyroscopeLong::default()),
        "gyroscope-maximal" => Engine::of_tree(shipped::gyroscope_maximal::GyroscopeMaximal::default()),
        "gyroscope-misalignments" => {
            Engine::of_tree(shipped::gyroscope_misalignments::GyroscopeMisalignments::default())
        }
        "gyroscope-overdamped" => {
            Engine::of_tree(shipped::gyroscope_overdamped::GyroscopeOverdamped::default())
        }
        "gyroscope-parameters" => {
            Engine::of_tree(shipped::gyroscope_parameters::GyroscopeParameters::default())
        }
        "gyroscope-radial-imbalance" => {
            Engine::of_tree(shipped::gyroscope_radial_imbalance::GyroscopeRadialImbalance::default())
        }
        "gyroscope-rolling-base" => {
            Engine::of_tree(shipped::gyroscope_rolling_base::GyroscopeRollingBase::default())
        }
        "gyroscope-stiff" => Engine::of_tree(shipped::gyroscope_stiff::GyroscopeStiff::default()),
        "gyroscope-viscous" => Engine::of_tree(shipped::gyroscope_viscous::GyroscopeViscous::default()),
        "heavy-top" => Engine::of_tree(shipped::heavy_top::HeavyTop::default()),
        "loads" => Engine::new(own::loads::Loads::default()),
        "manipulator" => Engine::new(own::manipulator::Manipulator::default()),
        "motor" => Engine::new(own::motor::Motor::default()),
        "parallelogram" => Engine::new(own::parallelogram::Parallelogram::default()),
        "peaucellier" => Engine::new(own::peaucellier::Peaucellier::default()),
        "pendulum" => Engine::new(own::pendulum::Pendulum::default()),
        "pitching-bearings" => Engine::new(own::pitching_bearings::PitchingBearings::default()),
        "pitching-gyroscope" => Engine::of_tree(shipped::pitching_gyroscope::PitchingGyroscope::default()),
        "planar" => Engine::new(own::planar::Planar::default()),
        "planetary" => Engine::new(own::planetary::Planetary::default()),
        "point-on-line" => Engine::new(own::point_on_line::PointOnLine::default()),
        "prismatic" => Engine::new(own::prismatic::Prismatic::default()),
        "rack-and-screw" => Engine::new(own::rack_and_screw::RackAndScrew::default()),
        "rod" => Engine::new(own::rod::Rod::default()),
        "screw" => Engine::new(own::screw::Screw::default()),
        "slider-crank" => Engine::new(shipped::slider_crank::SliderCrank::default()),
        "spatial-slider-crank" => Engine::new(own::spatial_slider_crank::SpatialSliderCrank::default()),
        "spherical" => Engine::new(own::spherical::Spherical::default()),
        "spinning-top" => Engine::of_tree(shipped::spinning_top::SpinningTop::default()),
        "stewart-platform" => Engine::new(shipped::stewart_platform::StewartPlatform::default()),
        "stops" => Engine::new(own::stops::Stops::default()),
        "tether" => Engine::new(own::tether::Tether::default()),
        "torsion" => Engine::of_tree(shipped::torsion::Torsion::default()),
        "two-four-bars" => Engine::new(own::two_four_bars::TwoFourBars::default()),
        "universal" => Engine::new(own::universal::Universal::default()),
        "weld" => Engine::new(own::weld::Weld::default()),
        _ => panic!("{page}.toml has no line in tests/support/fixtures.rs: add it"),
    }
}

/// Generated mechanisms in single precision: each kind of joint, force, motion and partition is in one of them, but not
/// every model file, as each costs its compilation.
pub fn in_single_precision() -> Vec<(&'static str, Engine<f32>)> {
    vec![
        ("cam", Engine::new(own::cam::Cam::default())),
        ("cylindrical", Engine::new(own::cylindrical::Cylindrical::default())),
        ("driven-gyroscope", Engine::new(shipped::driven_gyroscope::DrivenGyroscope::default())),
        ("four-bar-revolute", Engine::new(shipped::four_bar_revolute::FourBarRevolute::default())),
        ("free-body", Engine::new(shipped::free_body::FreeBody::default())),
        ("friction", Engine::new(own::friction::Friction::default())),
        ("gear", Engine::new(own::gear::Gear::default())),
        ("gyroscope-maximal", Engine::new(shipped::gyroscope_maximal::GyroscopeMaximal::default())),
        ("gyroscope-parameters", Engine::new(shipped::gyroscope_parameters::GyroscopeParameters::default())),
        ("loads", Engine::new(own::loads::Loads::default())),
        ("pendulum", Engine::new(own::pendulum::Pendulum::default())),
        ("planar", Engine::new(own::planar::Planar::default())),
        ("point-on-line", Engine::new(own::point_on_line::PointOnLine::default())),
        ("rod", Engine::new(own::rod::Rod::default())),
        ("screw", Engine::new(own::screw::Screw::default())),
        ("stops", Engine::new(own::stops::Stops::default())),
        ("tether", Engine::new(own::tether::Tether::default())),
        ("motor", Engine::new(own::motor::Motor::default())),
        ("universal", Engine::new(own::universal::Universal::default())),
        ("weld", Engine::new(own::weld::Weld::default())),
    ]
}

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

/// The generated mechanism of an extreme scene in any precision.
///
/// # Panics
/// If it is none of [`EXTREME`].
pub fn extreme<T: Real + 'static>(page: &str) -> Engine<T> {
    match page {
        "gyroscope" => Engine::of_tree(shipped::gyroscope::Gyroscope::default()),
        "gyroscope-fast" => Engine::of_tree(shipped::gyroscope_fast::GyroscopeFast::default()),
        "gyroscope-at-rest" => Engine::of_tree(shipped::gyroscope_at_rest::GyroscopeAtRest::default()),
        "gyroscope-light-rings" => {
            Engine::of_tree(shipped::gyroscope_light_rings::GyroscopeLightRings::default())
        }
        "gyroscope-heavy-rotor" => {
            Engine::of_tree(shipped::gyroscope_heavy_rotor::GyroscopeHeavyRotor::default())
        }
        "gyroscope-gimbal-lock" => {
            Engine::of_tree(shipped::gyroscope_gimbal_lock::GyroscopeGimbalLock::default())
        }
        "gyroscope-stiff" => Engine::of_tree(shipped::gyroscope_stiff::GyroscopeStiff::default()),
        "gyroscope-overdamped" => {
            Engine::of_tree(shipped::gyroscope_overdamped::GyroscopeOverdamped::default())
        }
        "gyroscope-coulomb" => Engine::of_tree(shipped::gyroscope_coulomb::GyroscopeCoulomb::default()),
        "gyroscope-rolling-base" => {
            Engine::of_tree(shipped::gyroscope_rolling_base::GyroscopeRollingBase::default())
        }
        "gyroscope-long" => Engine::of_tree(shipped::gyroscope_long::GyroscopeLong::default()),
        "four-bar" => Engine::new(shipped::four_bar::FourBar::default()),
        "four-bar-in-line" => Engine::new(shipped::four_bar_in_line::FourBarInLine::default()),
        _ => panic!("{page} is no extreme scene"),
    }
}

/// The same in dual numbers.
///
/// # Panics
/// If it is none of [`EXTREME`].
pub fn duals<T: Real + 'static>(page: &str) -> Duals<T> {
    match page {
        "gyroscope" => Duals::new(shipped::gyroscope::Gyroscope::default()),
        "gyroscope-fast" => Duals::new(shipped::gyroscope_fast::GyroscopeFast::default()),
        "gyroscope-at-rest" => Duals::new(shipped::gyroscope_at_rest::GyroscopeAtRest::default()),
        "gyroscope-light-rings" => Duals::new(shipped::gyroscope_light_rings::GyroscopeLightRings::default()),
        "gyroscope-heavy-rotor" => Duals::new(shipped::gyroscope_heavy_rotor::GyroscopeHeavyRotor::default()),
        "gyroscope-gimbal-lock" => Duals::new(shipped::gyroscope_gimbal_lock::GyroscopeGimbalLock::default()),
        "gyroscope-stiff" => Duals::new(shipped::gyroscope_stiff::GyroscopeStiff::default()),
        "gyroscope-overdamped" => Duals::new(shipped::gyroscope_overdamped::GyroscopeOverdamped::default()),
        "gyroscope-coulomb" => Duals::new(shipped::gyroscope_coulomb::GyroscopeCoulomb::default()),
        "gyroscope-rolling-base" => {
            Duals::new(shipped::gyroscope_rolling_base::GyroscopeRollingBase::default())
        }
        "gyroscope-long" => Duals::new(shipped::gyroscope_long::GyroscopeLong::default()),
        "four-bar" => Duals::new(shipped::four_bar::FourBar::default()),
        "four-bar-in-line" => Duals::new(shipped::four_bar_in_line::FourBarInLine::default()),
        _ => panic!("{page} is no extreme scene"),
    }
}

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

/// The generated module of a model file, with all functions.
pub fn module(name: &str) -> Module {
    let module = gyro_codegen::generate_functions(&file_name(name), &model(name), &Functions::all());
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
