//! The shipped models, each with its generated mechanism.

use gyro_model::Model;
use gyro_sim::generated::{
    compound_pendulum::CompoundPendulum, free_body::FreeBody, gyroscope::Gyroscope,
    gyroscope_combined_offsets::GyroscopeCombinedOffsets, gyroscope_free_nutation::GyroscopeFreeNutation,
    gyroscope_maximal::GyroscopeMaximal, gyroscope_parameters::GyroscopeParameters,
    gyroscope_radial_imbalance::GyroscopeRadialImbalance, gyroscope_viscous::GyroscopeViscous,
    heavy_top::HeavyTop,
};
use gyro_sim::{Equations, Partition, Real};
use std::path::{Path, PathBuf};

/// A mechanism that does everything there is to do.
pub trait Engine<T>: Partition<Scalar = T> + Equations {}
impl<T, M: Partition<Scalar = T> + Equations> Engine<T> for M {}

/// What a test does with a mechanism of any type.
pub trait Check<T: Real> {
    /// Checks the mechanism of a page of `models/`, named without its extension.
    fn check<M: Engine<T>>(&mut self, page: &str, mechanism: &M);
}

/// Checks the generated mechanism of every shipped model.
pub fn for_each_generated<T: Real>(check: &mut impl Check<T>) {
    for page in pages() {
        with_generated(&page, check);
    }
}

/// Checks the generated mechanism of one page.
///
/// # Panics
/// If the page has no generated mechanism here: every shipped model must have one.
pub fn with_generated<T: Real>(page: &str, check: &mut impl Check<T>) {
    match page {
        "compound-pendulum" => check.check(page, &CompoundPendulum::default()),
        "free-body" => check.check(page, &FreeBody::default()),
        "gyroscope" => check.check(page, &Gyroscope::default()),
        "gyroscope-combined-offsets" => check.check(page, &GyroscopeCombinedOffsets::default()),
        "gyroscope-free-nutation" => check.check(page, &GyroscopeFreeNutation::default()),
        "gyroscope-maximal" => check.check(page, &GyroscopeMaximal::default()),
        "gyroscope-parameters" => check.check(page, &GyroscopeParameters::default()),
        "gyroscope-radial-imbalance" => check.check(page, &GyroscopeRadialImbalance::default()),
        "gyroscope-viscous" => check.check(page, &GyroscopeViscous::default()),
        "heavy-top" => check.check(page, &HeavyTop::default()),
        _ => panic!("models/{page}.toml has no line in tests/support/shipped.rs: add it"),
    }
}

/// The shipped pages in the order of their names, without extension.
pub fn pages() -> Vec<String> {
    let entries = std::fs::read_dir(models()).expect("the folder of models is part of the project");
    let mut pages: Vec<String> = entries
        .map(|entry| entry.expect("its entries can be read").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    pages.sort();
    pages
}

/// The text of a shipped page.
pub fn page(name: &str) -> String {
    let path = models().join(format!("{name}.toml"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The model of a shipped page.
pub fn model(name: &str) -> Model {
    gyro_model::read(&format!("{name}.toml"), &page(name)).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("models")
}
