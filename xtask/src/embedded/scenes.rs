//! The mechanisms of the firmware. Its compiler is another than this tool's, so that no build script of its own
//! generates them.

use super::folder;
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::generate;
use gyro_cli::places::listing;
use gyro_cli::programs::io_failure;
use gyro_model::Model;
use std::fs;
use std::path::Path;

/// What it runs besides the model files in `embedded/models` and the paper's scene, which `gyro-sim` has; and the
/// functions that it calls where those are not the usual ones.
const OF_THE_GALLERY: [(&str, Option<[&str; 2]>); 2] =
    [("gyroscope-combined-offsets.toml", None), ("stabilised-gimbal.toml", Some(["joint", "joint_outputs"]))];

fn asked(page: &Path, model: &mut Model) {
    let listed = OF_THE_GALLERY.into_iter().find(|(name, _)| page.ends_with(name));
    if let Some(functions) = listed.and_then(|(_, functions)| functions) {
        model.functions = Some(functions.map(str::to_owned).to_vec());
    }
}

/// Generates them, each proved, to where `embedded-scenes` includes them.
pub(crate) fn generate() -> Result<(), Failure> {
    let mut pages = listing(&folder().join("models"))?;
    pages.extend(OF_THE_GALLERY.map(|(name, _)| files::root().join("models").join(name)));
    let generated = folder().join("scenes").join("generated");
    fs::create_dir_all(&generated).map_err(|e| io_failure(&generated, &e))?;
    for module in generate::modules(&pages, &asked, false) {
        let module = module?;
        files::write(&generated.join(&module.name).with_extension("rs"), &module.as_item())?;
    }
    Ok(())
}
