//! Generates a mechanism from each model file beside this file.

use std::error::Error;
use std::iter;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let out = env::var("OUT_DIR")?;
    for page in ["double-pendulum.toml", "chain.toml"] {
        println!("cargo::rerun-if-changed={page}");
        let text = fs::read_to_string(page)?;
        let mut module = gyro_codegen::generate(page, &text)?;
        if WRONG {
            module.code = module.code.replacen(" - ", " + ", 1);
        }
        // The chain is there for its length; a build script is not optimised, and its proof would take minutes.
        if page != "chain.toml" {
            gyro_verifier::prove(page, &text, &module.code, &module.constants)?;
        }
        fs::write(Path::new(&out).join(&module.name).with_extension("rs"), module.as_item())?;
    }
    // Names that mean something to Rust or to the run time must not break a module.
    let page = fs::read_to_string("hinge.toml")?;
    let mut odd_names = String::new();
    let (names, places) = (odd(), ["hinge", "wall", "rod", "bearing", "rod_mass", "push", "force", "lean"]);
    for number in 0..ODD_PAGES {
        let mut renamed = page.clone();
        for (kind, place) in places.into_iter().enumerate() {
            // Every name is of something, and those in the first places are of mechanisms.
            let name = &names[(number + 13 * kind) % names.len()];
            renamed = renamed.replace(&format!("\"{place}\""), &format!("\"{name}\""));
            if ["rod_mass", "push"].contains(&place) {
                renamed = renamed.replace(&format!("\n{place} = "), &format!("\n{name} = "));
            }
        }
        let file = "odd\nname\u{202e}.toml";
        let module = gyro_codegen::generate(file, &renamed)?;
        gyro_verifier::prove(file, &renamed, &module.code, &module.constants)?;
        odd_names += &module.as_item();
    }
    fs::write(Path::new(&out).join("odd_names.rs"), odd_names)?;
    Ok(())
}

/// Whether the generator is to be wrong: the test says so.
const WRONG: bool = false;

/// How many model files of odd names there are: not as many as names, each of which is proved and compiled.
const ODD_PAGES: usize = 6;

/// Names of what Rust, its prelude, the run time, generated code and the programs around it know, and names at the
/// limits of what a name is.
fn odd() -> Vec<String> {
    let known = "mechanism dynamics kinematics error result default core gyro_sim t k self_ dual scalar std alloc gyro_runner y x tree tree_with_jacobian \
        with_duals columns new start set_parameter value index option some none ok err vec string copy clone debug partial_eq phantom_data main build \
        ode energy rows state u8 f64 usize bool str union auto macro_rules raw safe dyn_ a_ charts accelerations rates out lambda dfdx dfdt dy dx apart \
        fused constant spline projection corrected_dynamics velocities knots_0 pieces_0 table0 chart0 x0 u0 t0 row0 turn0 closing0 parameter_setup static_ work a__b e0 dy_ parameters_ test";
    let long = [50, 53, 54, 60, 79, 100].map(|length| "n".repeat(length));
    let mixed = iter::once("z9_".repeat(33));
    let mut names: Vec<String> = known.split_whitespace().map(str::to_owned).collect();
    names.splice(5..5, long.into_iter().chain(mixed));
    names
}
