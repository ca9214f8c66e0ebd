//! Exports random mechanisms, reads their C back and has a compiler look at it with warnings as errors:
//! `cargo run -p gyro-c-tests --example random_mechanisms -- [COUNT [FIRST_SEED]]`
#![expect(clippy::print_stdout, reason = "it is a program")]

use gyro_export::Precision;
use std::error::Error;
use std::process::Command;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1).map(|argument| argument.parse::<u64>());
    let count = arguments.next().transpose()?.unwrap_or(20);
    let first = arguments.next().transpose()?.unwrap_or(1);
    let folder = env::temp_dir().join(format!("gyro-c-pages-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let mut n_functions = 0;
    for seed in first..first + count {
        let page = gyro_pages::page(seed);
        let model = gyro_model::read_with("page.toml", &page, &mut gyro_pages::load)
            .map_err(|e| format!("seed {seed}: {e}"))?;
        let functions = gyro_codegen::Functions::all();
        let module = gyro_codegen::generate_functions("page.toml", &model, &functions)?;
        let precision = if seed % 2 == 0 { Precision::F64 } else { Precision::F32 };
        let exported = gyro_export::c("page.toml", &model, &module.scheduled, precision);
        let texts = (module.code.as_str(), module.constants.as_str());
        n_functions += gyro_verifier::same_in_c(&model, texts, (&exported.header, &exported.source))
            .map_err(|e| format!("seed {seed}: {e}"))?;
        let [header, source] = ["h", "c"].map(|extension| folder.join(format!("{}.{extension}", model.name)));
        fs::write(&header, &exported.header)?;
        fs::write(&source, &exported.source)?;
        let flags = ["-std=c99", "-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror", "-fsyntax-only"];
        let output = Command::new("cc").args(flags).arg(&source).output()?;
        if !output.status.success() {
            return Err(format!("seed {seed}: {}", String::from_utf8_lossy(&output.stderr)).into());
        }
    }
    fs::remove_dir_all(&folder)?;
    println!(
        "{count} mechanisms from seed {first}: {n_functions} functions in C are those of Rust, no warnings"
    );
    Ok(())
}
