//! Generates modules of which tests look at what only text has: the names of its constants. All other mechanisms are
//! compiled when tests run (`fixtures.rs`).

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    gyro_build::generate(
        &["all-joints", "spherical"].map(|page| Path::new("tests/models").join(page).with_extension("toml")),
    )
}
