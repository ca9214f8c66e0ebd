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

/// The type of each mechanism by its model file, `mechanism!("gear-pair", f64)`, and [`generated`].
macro_rules! mechanisms {
    ($d:tt $($page:tt $new:ident $from:ident::$module:ident::$name:ident,)*) => {
        /// The generated type of a model file in some kind of numbers: `mechanism!("gear-pair", f64)`.
        #[macro_export]
        macro_rules! mechanism {
            $(($page, $d scalar:ty) => { $crate::$from::$module::$name<$d scalar> };)*
        }

        /// The generated mechanism of a model file.
        ///
        /// # Panics
        /// If the model file has no generated mechanism here: every model file must have one.
        pub fn generated(page: &str) -> Engine {
            match page {
                $($page => Engine::$new($from::$module::$name::<f64>::default()),)*
                _ => panic!("{page}.toml has no line in tests/support/fixtures.rs: add it"),
            }
        }
    };
}

// Of trees those that have joint coordinates here.
mechanisms! {
    $
    "all-joints" new own::all_joints::AllJoints,
    "armature" new own::armature::Armature,
    "armatures-in-loop" new own::armatures_in_loop::ArmaturesInLoop,
    "cam" new own::cam::Cam,
    "carried" new own::carried::Carried,
    "carried-block" new own::carried_block::CarriedBlock,
    "carried-four-bar" new own::carried_four_bar::CarriedFourBar,
    "compound-pendulum" of_tree shipped::compound_pendulum::CompoundPendulum,
    "cylindrical" new own::cylindrical::Cylindrical,
    "differential" of_tree own::differential::Differential,
    "double-wishbone" new shipped::double_wishbone::DoubleWishbone,
    "driven-four-bar" new own::driven_four_bar::DrivenFourBar,
    "driven-gyroscope" of_tree shipped::driven_gyroscope::DrivenGyroscope,
    "driven-shaft" new own::driven_shaft::DrivenShaft,
    "driven-stewart" new own::driven_stewart::DrivenStewart,
    "four-bar" new shipped::four_bar::FourBar,
    "four-bar-bushing" new shipped::four_bar_bushing::FourBarBushing,
    "four-bar-in-line" new shipped::four_bar_in_line::FourBarInLine,
    "four-bar-revolute" new shipped::four_bar_revolute::FourBarRevolute,
    "free-body" of_tree shipped::free_body::FreeBody,
    "friction" new own::friction::Friction,
    "friction-in-loops" new own::friction_in_loops::FrictionInLoops,
    "gear" new own::gear::Gear,
    "gear-pair" of_tree own::gear_pair::GearPair,
    "geared-loop" new own::geared_loop::GearedLoop,
    "gyroscope" of_tree shipped::gyroscope::Gyroscope,
    "gyroscope-at-rest" of_tree shipped::gyroscope_at_rest::GyroscopeAtRest,
    "gyroscope-bearings" new own::gyroscope_bearings::GyroscopeBearings,
    "gyroscope-combined-offsets" of_tree shipped::gyroscope_combined_offsets::GyroscopeCombinedOffsets,
    "gyroscope-coulomb" of_tree shipped::gyroscope_coulomb::GyroscopeCoulomb,
    "gyroscope-fast" of_tree shipped::gyroscope_fast::GyroscopeFast,
    "gyroscope-four-bar" new shipped::gyroscope_four_bar::GyroscopeFourBar,
    "gyroscope-free-nutation" of_tree shipped::gyroscope_free_nutation::GyroscopeFreeNutation,
    "gyroscope-gimbal-lock" of_tree shipped::gyroscope_gimbal_lock::GyroscopeGimbalLock,
    "gyroscope-heavy-rotor" of_tree shipped::gyroscope_heavy_rotor::GyroscopeHeavyRotor,
    "gyroscope-light-rings" of_tree shipped::gyroscope_light_rings::GyroscopeLightRings,
    "gyroscope-long" of_tree shipped::gyroscope_long::GyroscopeLong,
    "gyroscope-maximal" of_tree shipped::gyroscope_maximal::GyroscopeMaximal,
    "gyroscope-misalignments" of_tree shipped::gyroscope_misalignments::GyroscopeMisalignments,
    "gyroscope-overdamped" of_tree shipped::gyroscope_overdamped::GyroscopeOverdamped,
    "gyroscope-parameters" of_tree shipped::gyroscope_parameters::GyroscopeParameters,
    "gyroscope-radial-imbalance" of_tree shipped::gyroscope_radial_imbalance::GyroscopeRadialImbalance,
    "gyroscope-rolling-base" of_tree shipped::gyroscope_rolling_base::GyroscopeRollingBase,
    "gyroscope-stiff" of_tree shipped::gyroscope_stiff::GyroscopeStiff,
    "gyroscope-viscous" of_tree shipped::gyroscope_viscous::GyroscopeViscous,
    "heavy-top" of_tree shipped::heavy_top::HeavyTop,
    "held-spatial-loop" new own::held_spatial_loop::HeldSpatialLoop,
    "loads" new own::loads::Loads,
    "manipulator" new own::manipulator::Manipulator,
    "motor" new own::motor::Motor,
    "parallelogram" new own::parallelogram::Parallelogram,
    "peaucellier" new own::peaucellier::Peaucellier,
    "pendulum" new own::pendulum::Pendulum,
    "pitching-bearings" new own::pitching_bearings::PitchingBearings,
    "pitching-gyroscope" of_tree shipped::pitching_gyroscope::PitchingGyroscope,
    "planar" new own::planar::Planar,
    "planetary" of_tree own::planetary::Planetary,
    "point-on-line" new own::point_on_line::PointOnLine,
    "prismatic" new own::prismatic::Prismatic,
    "rack-and-screw" of_tree own::rack_and_screw::RackAndScrew,
    "rod" new own::rod::Rod,
    "screw" of_tree own::screw::Screw,
    "slider-crank" new shipped::slider_crank::SliderCrank,
    "spatial-slider-crank" new own::spatial_slider_crank::SpatialSliderCrank,
    "spherical" new own::spherical::Spherical,
    "spinning-top" of_tree shipped::spinning_top::SpinningTop,
    "springs-in-loop" new own::springs_in_loop::SpringsInLoop,
    "stabilised-gimbal" of_tree shipped::stabilised_gimbal::StabilisedGimbal,
    "stewart-platform" new shipped::stewart_platform::StewartPlatform,
    "stops" new own::stops::Stops,
    "tether" new own::tether::Tether,
    "torsion" of_tree shipped::torsion::Torsion,
    "two-four-bars" new own::two_four_bars::TwoFourBars,
    "universal" new own::universal::Universal,
    "weld" new own::weld::Weld,
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
        ("stabilised-gimbal", Engine::new(shipped::stabilised_gimbal::StabilisedGimbal::default())),
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
