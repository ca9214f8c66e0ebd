//! Prints the module of a model page: `cargo run -p gyro-codegen --example print_module -- models/gyroscope.toml`.

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which model page?")?;
    let module = gyro_codegen::generate(&path, &std::fs::read_to_string(&path)?)?;
    #[allow(clippy::print_stdout, reason = "printing is what it is for")]
    {
        print!("{}", module.code);
    }
    Ok(())
}
