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
    // Names that mean something to Rust or to the run time must not break a module.
    let page = fs::read_to_string("hinge.toml")?;
    let mut odd_names = String::new();
    for name in ["mechanism", "equations", "error", "result", "default", "core", "gyro_sim", "t", "k", "self_"] {
        let renamed = page.replace("name = \"hinge\"", &format!("name = \"{name}\""));
        assert!(renamed != page, "the page has another name");
        odd_names += &gyro_codegen::generate("odd.toml", &renamed)?.as_item();
    }
    fs::write(Path::new(&out).join("odd_names.rs"), odd_names)?;
    Ok(())
}
