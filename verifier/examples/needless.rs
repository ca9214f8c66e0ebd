//! Lists what a module computes although it is zero or known before: `cargo run -p gyro-verifier --example needless --
//! models/gyroscope.toml`.

#![allow(clippy::print_stdout, reason = "printing is what it is for")]

use gyro_verifier::module::Module;
use gyro_verifier::proof::{Decider, prime};
use std::error::Error;

/// Seed of the point.
const SEED: u64 = 1;

fn main() -> Result<(), Box<dyn Error>> {
    for path in std::env::args().skip(1) {
        let model = gyro_model::read(&path, &std::fs::read_to_string(&path)?).map_err(|e| e.to_string())?;
        let emitted = gyro_codegen::generate_functions(&path, &model, &gyro_codegen::Functions::all())?;
        let module = Module::read(&model, &emitted.code, &emitted.constants)?;
        let prime = prime::<18>(&model, &module, SEED).map_err(|bits| format!("roots take {bits} bits"))?;
        let decider = Decider::new(&model, prime);
        for function in module.programs.keys() {
            for needless in decider.needless(&module, function, SEED).unwrap_or_default() {
                let line = emitted.code.lines().nth(needless.line - 1).unwrap_or_default().trim();
                let value = needless.same_as.map_or("zero".to_owned(), |same| format!("as in line {same}"));
                println!("{path}: {function}: line {}: {value}: {line}", needless.line);
            }
        }
    }
    Ok(())
}
