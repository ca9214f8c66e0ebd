//! The mechanisms of the firmware. Its compiler is another than this tool's, so that no build script of its own
//! generates them.

use super::folder;
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::generate::{self, Asked};
use gyro_cli::places::listing;
use gyro_cli::programs::io_failure;
use std::fs;

/// What it runs besides the model files in `embedded/models` and the paper's scene, which `gyro-sim` has.
const OF_THE_GALLERY: &str = "gyroscope-combined-offsets.toml";

/// Generates them, each proved, to where `embedded-scenes` includes them.
pub(crate) fn generate() -> Result<(), Failure> {
    let mut pages = listing(&folder().join("models"))?;
    pages.push(files::root().join("models").join(OF_THE_GALLERY));
    let generated = folder().join("scenes").join("generated");
    fs::create_dir_all(&generated).map_err(|e| io_failure(&generated, &e))?;
    for module in generate::modules(&pages, &|_| Asked::There, false) {
        let module = module?;
        files::write(&generated.join(&module.name).with_extension("rs"), &module.as_item())?;
    }
    Ok(())
}
