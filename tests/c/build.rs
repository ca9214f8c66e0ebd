//! Generates the mechanisms that are compared.
#![allow(clippy::print_stdout, reason = "it is how a build script tells cargo what it depends on")]

use std::error::Error;
use std::path::{Path, PathBuf};
use std::{env, fs};

const PAGES: [&str; 9] = [
    "models/gyroscope.toml",
    "models/driven-gyroscope.toml",
    "models/four-bar.toml",
    "models/gyroscope-parameters.toml",
    "models/gyroscope-stiff.toml",
    "tests/models/cam.toml",
    "tests/models/curves.toml",
    "tests/models/electric.toml",
    "examples/arm/arm.toml",
];
/// Templates of `gyro new`: a cart with motor and spring, a robot arm with motors; and how they are called here.
const TEMPLATES: [(&str, &str); 2] = [("cart", "cart"), ("arm", "robot_arm")];

fn main() -> Result<(), Box<dyn Error>> {
    let root = Path::new("../..");
    let mut pages: Vec<PathBuf> = PAGES.iter().map(|page| root.join(page)).collect();
    let folder = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo names a folder")?);
    for (template, name) in TEMPLATES {
        let template = root.join(format!("cli/templates/{template}.toml"));
        println!("cargo::rerun-if-changed={}", template.display());
        let page = folder.join(format!("{name}.toml"));
        let text = fs::read_to_string(&template)?.replace("\"NAME\"", &format!("\"{name}\""));
        // A file that is newer than the last build would have this run each time.
        if !fs::read_to_string(&page).is_ok_and(|found| found == text) {
            fs::write(&page, text)?;
        }
        pages.push(page);
    }
    gyro_build::generate(&pages)
}
