//! Writing files: whole or not at all, and never over anything but what this tool has written itself.
//!
//! A file that is in the way is replaced only if it is known for the tool's own: by the place it is in, by how it
//! begins, or by the record that is kept in its folder of what was written there. No input of the run is replaced under
//! any of its names, be it a link, a relative path or other capitals.

use crate::failure::Failure;
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// How a file that is to be replaced is known for the tool's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// By its place: in the workspace, where nobody else writes, or named by the user as the model file to be brought
    /// up to date.
    Place,
    /// By how its text begins.
    Mark(&'static str),
    /// By the record in its folder: formats without comments, and names that anybody may choose.
    Record,
}

/// Where a folder keeps the record of what was written there: a line for each file, with length, digest and name.
const RECORD: &str = ".gyro-sim";

/// Files that this run has read.
static INPUTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// From now on this file is not written to.
pub fn note_input(path: &Path) {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let mut inputs = INPUTS.lock().unwrap_or_else(PoisonError::into_inner);
    if !inputs.contains(&path) {
        inputs.push(path);
    }
}

/// Whether a file may be written, asked before the work for it begins.
pub fn check(path: &Path, known: Known) -> Result<(), Failure> {
    let refused = |why: &str| {
        let path = path.display();
        Err(Failure::Usage(format!("{path} {why}: choose another place with --out, or move it away")))
    };
    let Ok(entry) = fs::symlink_metadata(path) else { return Ok(()) };
    let Ok(target) = fs::metadata(path) else { return refused("is a link that leads nowhere") };
    if !target.is_file() {
        return refused("exists and is no ordinary file");
    }
    if is_input(path) {
        return refused("is read by this run, so it is not overwritten");
    }
    if target.len() == 0 || known == Known::Place && !entry.is_symlink() || is_own(path, known) {
        return Ok(());
    }
    refused(match known {
        Known::Record => "exists and is not as this tool has written it",
        Known::Place | Known::Mark(_) => "exists and is not a file that this tool has written",
    })
}

fn is_input(path: &Path) -> bool {
    let inputs = INPUTS.lock().unwrap_or_else(PoisonError::into_inner);
    inputs.iter().any(|input| is_same(input, path).unwrap_or(false))
}

/// Whether two paths lead to one file, by links of either kind.
#[cfg(unix)]
fn is_same(one: &Path, other: &Path) -> io::Result<bool> {
    use std::os::unix::fs::MetadataExt;
    let [one, other] = [fs::metadata(one)?, fs::metadata(other)?];
    Ok((one.dev(), one.ino()) == (other.dev(), other.ino()))
}

/// Whether two paths lead to one file by symbolic links.
#[cfg(not(unix))]
fn is_same(one: &Path, other: &Path) -> io::Result<bool> {
    Ok(fs::canonicalize(one)? == fs::canonicalize(other)?)
}

fn is_own(path: &Path, known: Known) -> bool {
    match known {
        Known::Place => true,
        Known::Mark(mark) => fs::read(path).is_ok_and(|text| text.starts_with(mark.as_bytes())),
        Known::Record => fs::read(path).is_ok_and(|text| is_recorded(path, &text)),
    }
}

/// Writes a file unless it has this text already. Returns whether it was written.
///
/// The text goes to a neighbour that is then renamed: at no time is half of it to be seen. Its folder is made if need
/// be.
pub fn write(path: &Path, text: impl AsRef<[u8]>, known: Known) -> Result<bool, Failure> {
    let text = text.as_ref();
    check(path, known)?;
    if holds(path, text) {
        return Ok(false);
    }
    let failed = |e: io::Error| unwritable(path, "written", &e);
    path.parent().map_or(Ok(()), fs::create_dir_all).map_err(failed)?;
    if known == Known::Record {
        // Before the file: one that is there without its line could never be replaced.
        record(path, text).map_err(failed)?;
    }
    replace(path, text).map(|()| true).map_err(failed)
}

fn replace(path: &Path, text: &[u8]) -> io::Result<()> {
    // A link stays, and what it leads to is replaced.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let (neighbour, mut file) = neighbour(&path)?;
    let written = file.write_all(text).and_then(|()| fs::rename(&neighbour, &path));
    if written.is_err() {
        // The first error is the one to tell.
        let _ = fs::remove_file(&neighbour);
    }
    written
}

/// A new file beside another.
fn neighbour(path: &Path) -> io::Result<(PathBuf, fs::File)> {
    // A long name leaves no room for more of it.
    let name: String = path.file_name().unwrap_or_default().to_string_lossy().chars().take(40).collect();
    for attempt in 0.. {
        let neighbour = path.with_file_name(format!(".{name}.{}-{attempt}", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&neighbour) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            outcome => return Ok((neighbour, outcome?)),
        }
    }
    Err(io::Error::other("no free name for a temporary file"))
}

/// Takes away what an earlier run has written, if it is still as it was written.
pub fn remove(path: &Path) {
    if !is_input(path) && is_own(path, Known::Record) {
        // It is not there, or it stays: neither is worth more than the failure that led here.
        let _ = fs::remove_file(path);
    }
}

fn record_of(path: &Path) -> PathBuf {
    path.with_file_name(RECORD)
}

fn is_recorded(path: &Path, text: &[u8]) -> bool {
    let line = line(path, text);
    fs::read_to_string(record_of(path)).is_ok_and(|record| record.lines().any(|known| known == line))
}

/// Adds a line to the record of a folder. Lines are added whole, so that two runs at once do not spoil it.
fn record(path: &Path, text: &[u8]) -> io::Result<()> {
    if is_recorded(path, text) {
        return Ok(());
    }
    let line = line(path, text) + "\n";
    OpenOptions::new().create(true).append(true).open(record_of(path))?.write_all(line.as_bytes())
}

/// FNV-1a: enough to see that a text was changed, not proof against whoever wants to deceive.
pub(crate) fn digest(text: &[u8]) -> String {
    let hash = text.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, &byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

/// Length, digest and name of a file.
fn line(path: &Path, text: &[u8]) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    format!("{} {} {name}", text.len(), digest(text))
}

/// Whether a file is there with just this text.
pub fn holds(path: &Path, text: impl AsRef<[u8]>) -> bool {
    fs::read(path).is_ok_and(|old| old == text.as_ref())
}

/// A place that cannot be written to was asked for wrongly; a full disk was not.
pub fn unwritable(path: &Path, done: &str, error: &io::Error) -> Failure {
    use io::ErrorKind::{
        AlreadyExists, IsADirectory, NotADirectory, NotFound, PermissionDenied, ReadOnlyFilesystem,
    };
    let words = format!("{} cannot be {done}: {error}", path.display());
    match error.kind() {
        AlreadyExists | IsADirectory | NotADirectory | NotFound | PermissionDenied | ReadOnlyFilesystem => {
            Failure::Usage(words)
        }
        _ => Failure::Run(words),
    }
}

#[cfg(test)]
mod tests;
