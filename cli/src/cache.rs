//! `gyro cache`: where generated programs are built, how much that takes, and how to be rid of it.

use crate::args::CacheArgs;
use crate::failure::Failure;
use crate::remarks::say;
use crate::runtime::{self, Version};
use crate::words::table;
use std::fs;
use std::path::Path;

/// Shows the cache, or empties it.
pub(crate) fn cache(args: &CacheArgs) -> Result<(), Failure> {
    let folder = runtime::cache()?;
    let versions = runtime::versions(&folder);
    if args.clear {
        // Nothing else that might be in a folder of this name.
        for Version { folder, .. } in &versions {
            let failed = |e| Failure::Run(format!("{} cannot be removed: {e}", folder.display()));
            fs::remove_dir_all(folder).map_err(failed)?;
        }
        let _ = fs::remove_dir(&folder);
        return say(&format!("removed {} from {}\n", megabytes(&versions), folder.display()));
    }
    let own = runtime::version();
    let row = |version: &Version| {
        let name = version.folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let whose = if name == own { "this program's" } else { "another version's" };
        vec![name, megabytes(std::slice::from_ref(version)), whose.to_owned()]
    };
    let rows: Vec<Vec<String>> = versions.iter().map(row).collect();
    let rows = if rows.is_empty() { "nothing yet\n".to_owned() } else { table(&rows) };
    say(&format!("{}\n{rows}", folder.display()))
}

fn megabytes(versions: &[Version]) -> String {
    let bytes: u64 = versions.iter().map(|version| size(&version.folder)).sum();
    format!("{:.1} MB", bytes as f64 / 1e6)
}

/// The bytes of all files below a folder.
fn size(path: &Path) -> u64 {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let sizes = entries.map(|entry| match entry.metadata() {
        Ok(found) if found.is_dir() => size(&entry.path()),
        Ok(found) => found.len(),
        Err(_) => 0,
    });
    sizes.sum()
}
