//! Prints the module of a model file: `cargo run -p gyro-codegen --example print_module -- models/gyroscope.toml`.

use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which model file?")?;
    let folder = Path::new(&path).parent().unwrap_or(Path::new("."));
    let mut load =
        |table: &str| std::fs::read_to_string(folder.join(table)).map_err(|error| error.to_string());
    let module = gyro_codegen::generate_with(&path, &std::fs::read_to_string(&path)?, &mut load)?;
    #[allow(clippy::print_stdout, reason = "printing is what it is for")]
    {
        print!("{}", module.code);
    }
    Ok(())
}
