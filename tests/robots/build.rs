//! Generates the mechanisms of `models`.

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    gyro_build::generate(&gyro_build::pages(Path::new("models"))?)
}
