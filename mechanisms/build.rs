//! Generates the mechanisms that features ask for, but those that are kept in the repository.

use std::error::Error;

#[cfg(not(feature = "generator"))]
fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=build.rs");
    Ok(())
}

#[cfg(feature = "generator")]
fn main() -> Result<(), Box<dyn Error>> {
    use std::path::Path;
    use std::{env, fs};

    println!("cargo::rerun-if-changed=src/golden");
    let manifest = fs::read_to_string("Cargo.toml")?;
    let mut wanted = Vec::new();
    for page in gyro_build::pages(Path::new("../models"))? {
        let name = page.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if !manifest.lines().any(|line| line.starts_with(&format!("{name} = "))) {
            return Err(format!("{}: add a feature `{name}` to mechanisms/Cargo.toml", page.display()).into());
        }
        let is_kept =
            name == "gyroscope" || Path::new("src/golden").join(name.replace('-', "_") + ".rs").exists();
        let feature = format!("CARGO_FEATURE_{}", name.replace('-', "_").to_uppercase());
        if !is_kept && env::var_os(feature).is_some() {
            wanted.push(page);
        }
    }
    gyro_build::generate(&wanted)
}
