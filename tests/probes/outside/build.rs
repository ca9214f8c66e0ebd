//! Generates a mechanism from each page beside this file.

use std::error::Error;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let out = env::var("OUT_DIR")?;
    for page in ["double-pendulum.toml", "chain.toml"] {
        println!("cargo::rerun-if-changed={page}");
        let module = gyro_codegen::generate(page, &fs::read_to_string(page)?)?;
        fs::write(Path::new(&out).join(&module.name).with_extension("rs"), module.as_item())?;
    }
    Ok(())
}
