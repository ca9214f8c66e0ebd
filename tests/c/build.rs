//! Generates the mechanisms that are compared.

use std::error::Error;
use std::path::PathBuf;

const PAGES: [&str; 8] = [
    "models/gyroscope.toml",
    "models/driven-gyroscope.toml",
    "models/four-bar.toml",
    "models/gyroscope-parameters.toml",
    "models/gyroscope-stiff.toml",
    "tests/models/cam.toml",
    "examples/arm/arm.toml",
    "examples/cart-pendulum/cart-pendulum.toml",
];

fn main() -> Result<(), Box<dyn Error>> {
    let pages: Vec<PathBuf> = PAGES.iter().map(|page| PathBuf::from("../..").join(page)).collect();
    gyro_build::generate(&pages)
}
