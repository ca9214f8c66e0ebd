//! What generated programs are compiled against, and where: this program carries the sources of the runtime and of the
//! few crates that it needs, and unpacks them once into a folder of the user's cache. So cargo needs no network, and no
//! clone of the project has to be kept.
//!
//! ```text
//! CACHE/VERSION-HASH/            a folder for each content that was ever carried
//!     gyro-sim/ runner/ yardstick/ vendor/ Cargo.toml Cargo.lock .cargo/config.toml
//!     programs/NAME-HASH/        the package of a generated module
//!     build/                     what cargo builds of all of them
//! ```

use crate::failure::Failure;
use flate2::read::GzDecoder;
use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::fs::{self, File};
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, SystemTime};

/// Packed by the build script.
const ARCHIVE: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/runtime.json.gz"));

/// Where the cache is, if not in the folder that the system has for it.
const VARIABLE: &str = "GYRO_CACHE";

/// A file of each folder, written when the folder is used.
const MARK: &str = "used";

/// What has not been used for so long, by a version of the program that is no longer the one that runs, is removed.
const FORGOTTEN: Duration = Duration::from_hours(30 * 24);

/// The folder of all versions.
pub(crate) fn cache() -> Result<PathBuf, Failure> {
    let told = std::env::var_os(VARIABLE).filter(|path| !path.is_empty()).map(PathBuf::from);
    told.or_else(|| Some(of_user()?.join("gyro"))).ok_or_else(|| {
        Failure::Usage(format!("this user has no folder for caches: set {VARIABLE} to a folder"))
    })
}

/// The folder that the system has for a user's caches.
fn of_user() -> Option<PathBuf> {
    let told = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let at_home = |folder: &str| Some(std::env::home_dir()?.join(folder));
    if cfg!(windows) {
        told("LOCALAPPDATA")
    } else if cfg!(target_os = "macos") {
        at_home("Library/Caches")
    } else {
        told("XDG_CACHE_HOME").or_else(|| at_home(".cache"))
    }
}

/// The folder in which this program builds, with the sources in it.
pub(crate) fn folder() -> Result<&'static Path, Failure> {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    if let Some(folder) = FOLDER.get() {
        return Ok(folder);
    }
    let cache = cache()?;
    let unusable = |e: std::io::Error| {
        let words = format!("{} cannot be used: {e}; {VARIABLE} names another folder", cache.display());
        Failure::Run(words)
    };
    let folder = unpacked(&cache, ARCHIVE).map_err(unusable)?;
    Ok(FOLDER.get_or_init(|| folder))
}

/// The name of the folder of an archive.
pub(crate) fn version() -> String {
    name(ARCHIVE)
}

fn name(archive: &[u8]) -> String {
    let mut hasher = DefaultHasher::new();
    archive.hash(&mut hasher);
    format!("{}-{:016x}", env!("CARGO_PKG_VERSION"), hasher.finish())
}

/// The folder of an archive, which is unpacked if it is not there. It appears whole or not at all, whatever happens
/// meanwhile.
fn unpacked(cache: &Path, archive: &[u8]) -> std::io::Result<PathBuf> {
    // Cargo has paths of its own for what it is not told absolutely.
    fs::create_dir_all(cache)?;
    let cache = fs::canonicalize(cache)?;
    let folder = cache.join(name(archive));
    if !folder.is_dir() {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let number = NEXT.fetch_add(1, Ordering::Relaxed);
        let scratch = cache.join(format!("unpacking-{}-{number}", std::process::id()));
        let _ = fs::remove_dir_all(&scratch);
        extract(archive, &scratch).inspect_err(|_| {
            let _ = fs::remove_dir_all(&scratch);
        })?;
        if let Err(error) = fs::rename(&scratch, &folder) {
            let _ = fs::remove_dir_all(&scratch);
            // Another run may have been quicker.
            if !folder.is_dir() {
                return Err(error);
            }
        }
        forget(&cache, &folder);
    }
    File::create(folder.join(MARK))?.set_modified(SystemTime::now())?;
    Ok(folder)
}

/// Writes the files of an archive: an object of JSON with the text of each.
fn extract(archive: &[u8], folder: &Path) -> std::io::Result<()> {
    let texts: BTreeMap<PathBuf, String> = serde_json::from_reader(GzDecoder::new(archive))?;
    for (name, text) in texts {
        let path = folder.join(name);
        path.parent().map_or(Ok(()), fs::create_dir_all)?;
        fs::write(path, text)?;
    }
    Ok(())
}

/// Removes the folders of other versions that have not been used for a long time.
fn forget(cache: &Path, own: &Path) {
    for version in versions(cache).into_iter().filter(|version| version.folder != own) {
        if version.used.elapsed().is_ok_and(|since| since > FORGOTTEN) {
            let _ = fs::remove_dir_all(&version.folder);
        }
    }
}

/// What a version of the program has unpacked and built.
#[derive(Debug)]
pub(crate) struct Version {
    pub(crate) folder: PathBuf,
    pub(crate) used: SystemTime,
}

/// All of them, in the order of their names.
pub(crate) fn versions(cache: &Path) -> Vec<Version> {
    let entries = fs::read_dir(cache).into_iter().flatten().flatten();
    let mut found: Vec<Version> = entries
        .filter_map(|entry| {
            let used = fs::metadata(entry.path().join(MARK)).and_then(|mark| mark.modified()).ok()?;
            Some(Version { folder: entry.path(), used })
        })
        .collect();
    found.sort_by(|a, b| a.folder.cmp(&b.folder));
    found
}

#[cfg(test)]
mod tests;
