//! The file of a sweep's blocks: a line that says of what they are, then one record after the other, in their order.
//!
//! Nothing in it is ever changed. What is not whole at its end, after a program was killed or a disk was full, is cut
//! off before the sweep goes on: so it ends with the bytes that it would have had.

use crate::args::Shard;
use crate::failure::Failure;
use crate::write::unwritable;
use gyro_sweep::record::{self, Block};
use serde::{Deserialize, Serialize};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, BufWriter, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Its name.
pub(super) const NAME: &str = "scenarios.blocks";

/// The file beside it that says where the study is: no result, for that differs from machine to machine.
pub(super) const PLACE: &str = ".study";

/// Of what the blocks are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Head {
    /// Of this file.
    pub(super) format: u32,
    /// Name of the study.
    pub(super) name: String,
    /// The study's text.
    pub(super) study: String,
    /// Path of the study file, seen from the workspace.
    pub(super) path: String,
    /// Digest of the program that ran the scenarios, and so of the model.
    pub(super) program: String,
    /// Digest of where they start and what is asked of the program.
    pub(super) job: String,
    /// Commit of the tool.
    pub(super) commit: String,
    pub(super) seed: u64,
    pub(super) scenarios: u64,
    /// Scenarios in a block.
    pub(super) block: u32,
    /// Numbers of a scenario.
    pub(super) width: usize,
    /// Which blocks: the first of them, and every how many.
    pub(super) shard: [u64; 2],
}

impl Head {
    /// How many blocks the part has.
    pub(super) fn blocks(&self) -> u64 {
        let all = self.scenarios.div_ceil(u64::from(self.block));
        let [first, every] = self.shard;
        (all + every - 1 - first.min(all + every - 1)) / every
    }

    /// The number of its n-th block.
    pub(super) fn block(&self, n: u64) -> u64 {
        self.shard[0] + n * self.shard[1]
    }

    pub(super) fn with(self, shard: Shard) -> Self {
        Self { shard: [shard.number - 1, shard.of], ..self }
    }

    /// By what two differ that must not; the commit may, as the program is the same.
    pub(super) fn difference(&self, other: &Self) -> Option<&'static str> {
        let differs = [
            ("of another format", self.format != other.format),
            ("of another study", self.study != other.study || self.name != other.name),
            ("of another model, or of another version of the generator", self.program != other.program),
            ("of another job", self.job != other.job || self.width != other.width),
            ("of another part", self.shard != other.shard),
        ];
        differs.iter().find(|(_, differs)| *differs).map(|(what, _)| *what)
    }

    fn line(&self) -> String {
        serde_json::to_string(self).expect("strings and numbers are JSON") + "\n"
    }
}

/// A file to which blocks are appended.
#[derive(Debug)]
pub(super) struct Store {
    path: PathBuf,
    file: BufWriter<File>,
    /// How many blocks it has.
    pub(super) written: u64,
    synced: Instant,
}

/// At most so much work is lost where the power fails.
const SYNC_EVERY: Duration = Duration::from_secs(2);

impl Store {
    /// A new file.
    ///
    /// # Errors
    /// If there is one already.
    pub(super) fn create(folder: &Path, head: &Head) -> Result<Self, Failure> {
        let path = folder.join(NAME);
        let failed = |error: io::Error| match error.kind() {
            io::ErrorKind::AlreadyExists => Failure::Usage(format!(
                "{} is there already: --resume goes on with it; or choose another folder with --out",
                path.display()
            )),
            _ => unwritable(&path, "written", &error),
        };
        let mut file = OpenOptions::new().write(true).create_new(true).open(&path).map_err(failed)?;
        hold(&file, &path)?;
        file.write_all(head.line().as_bytes()).map_err(failed)?;
        Ok(Self { file: BufWriter::new(file), written: 0, synced: Instant::now(), path })
    }

    /// The file of the folder, cut where its last whole block ends; a new one if there is none.
    ///
    /// # Errors
    /// If it is of another sweep.
    pub(super) fn resume(folder: &Path, head: &Head) -> Result<Self, Failure> {
        let path = folder.join(NAME);
        let failed = |error: io::Error| unwritable(&path, "read", &error);
        let is_empty = |path: &Path| std::fs::metadata(path).is_ok_and(|data| data.len() == 0);
        if !path.exists() || is_empty(&path) {
            let _ = std::fs::remove_file(&path);
            return Self::create(folder, head);
        }
        let mut file = OpenOptions::new().read(true).write(true).open(&path).map_err(failed)?;
        hold(&file, &path)?;
        let (found, mut input) = match read_head(&path, BufReader::new(&file)) {
            Ok(found) => found,
            // Killed within its first line: nothing is lost.
            Err(_) if !has_line(&path) => {
                std::fs::remove_file(&path).map_err(failed)?;
                return Self::create(folder, head);
            }
            Err(failure) => return Err(failure),
        };
        if let Some(what) = found.difference(head) {
            return Err(Failure::Usage(format!(
                "{} is {what}: it cannot go on; choose another folder with --out",
                path.display()
            )));
        }
        let (mut written, mut end) = (0, found.line().len() as u64);
        while let Ok(Some(bytes)) = record::next(&mut input) {
            let block = Block::decode(&bytes, found.width);
            if block.map_or(u64::MAX, |block| block.first) != head.block(written) * u64::from(head.block) {
                break;
            }
            (written, end) = (written + 1, end + bytes.len() as u64);
        }
        drop(input);
        file.set_len(end).map_err(failed)?;
        file.seek(io::SeekFrom::Start(end)).map_err(failed)?;
        Ok(Self { file: BufWriter::new(file), written, synced: Instant::now(), path })
    }

    /// Appends the records of the next blocks, of which there are so many.
    ///
    /// # Errors
    /// A disk that is full, for example: what is there already is kept.
    pub(super) fn append(&mut self, bytes: &[u8], count: u64) -> Result<(), Failure> {
        let is_due = self.synced.elapsed() > SYNC_EVERY;
        let written = self.file.write_all(bytes).and_then(|()| self.file.flush());
        let synced = written.and_then(|()| if is_due { self.file.get_ref().sync_data() } else { Ok(()) });
        synced.map_err(|error| stays(Failure::Run(unwritable(&self.path, "written", &error).words())))?;
        if is_due {
            self.synced = Instant::now();
        }
        self.written += count;
        Ok(())
    }
}

/// Keeps other sweeps from the file as long as it is open, where the file system has locks.
fn hold(file: &File, path: &Path) -> Result<(), Failure> {
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(Failure::Usage(format!(
            "another sweep writes to {}: wait for its end, or choose another folder with --out",
            path.display()
        ))),
        _ => Ok(()),
    }
}

/// Says of a run that has failed how to go on.
pub(super) fn stays(failure: Failure) -> Failure {
    match failure {
        Failure::Run(words) => {
            Failure::Run(format!("{words}\nWhat there is stays; --resume goes on with it."))
        }
        other => other,
    }
}

fn has_line(path: &Path) -> bool {
    let mut line = Vec::new();
    File::open(path).is_ok_and(|file| BufReader::new(file).read_until(b'\n', &mut line).is_ok())
        && line.ends_with(b"\n")
}

fn read_head<R: BufRead>(path: &Path, mut input: R) -> Result<(Head, R), Failure> {
    let wrong = |why: &str| Failure::Usage(format!("{} is no file of a sweep: {why}", path.display()));
    let mut line = String::new();
    input.read_line(&mut line).map_err(|error| wrong(&error.to_string()))?;
    let head: Head = serde_json::from_str(&line).map_err(|error| wrong(&error.to_string()))?;
    Ok((head, input))
}

/// The blocks of a file.
#[derive(Debug)]
pub(super) struct Blocks {
    pub(super) path: PathBuf,
    pub(super) head: Head,
    input: BufReader<File>,
}

impl Blocks {
    /// Opens the file of a folder.
    ///
    /// # Errors
    /// If there is none.
    pub(super) fn open(folder: &Path) -> Result<Self, Failure> {
        let path = folder.join(NAME);
        let missing = |error| Failure::Usage(format!("{} cannot be read: {error}", path.display()));
        let input = BufReader::with_capacity(1 << 20, File::open(&path).map_err(missing)?);
        let (head, input) = read_head(&path, input)?;
        Ok(Self { path, head, input })
    }

    /// The bytes of the next block.
    ///
    /// # Errors
    /// A file that ends too early, or is damaged.
    pub(super) fn next(&mut self) -> Result<Option<Vec<u8>>, Failure> {
        record::next(&mut self.input).map_err(|error| self.damaged(&error))
    }

    /// The next block.
    ///
    /// # Errors
    /// As [`Self::next`].
    pub(super) fn block(&mut self) -> Result<Option<Block>, Failure> {
        let Some(bytes) = self.next()? else { return Ok(None) };
        Block::decode(&bytes, self.head.width).map(Some).map_err(|error| self.damaged(&error))
    }

    fn damaged(&self, error: &io::Error) -> Failure {
        Failure::Run(format!("{} is not whole: {error}; --resume mends it", self.path.display()))
    }
}

#[cfg(test)]
mod tests;
