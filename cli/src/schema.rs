//! `cargo xtask schema`: the JSON schema of model files.

use crate::args::SchemaArgs;
use crate::failure::Failure;
use crate::write::{self, Known};
use gyro_schema::SCHEMA;
use std::io::{self, Write as _};

/// Prints the schema, or writes it.
pub(crate) fn schema(args: &SchemaArgs) -> Result<(), Failure> {
    let Some(path) = &args.out else {
        // Whoever closes the pipe has read enough.
        let _ = io::stdout().write_all(SCHEMA.as_bytes());
        return Ok(());
    };
    let is_new = write::write(path, SCHEMA, Known::Record)?;
    let _ = writeln!(io::stdout(), "{} {}", if is_new { "wrote" } else { "fresh already:" }, path.display());
    Ok(())
}
