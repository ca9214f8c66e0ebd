//! `gyro sweep merge`.

use super::loaded::Loaded;
use super::results;
use super::store::{Blocks, Head, PLACE, Store};
use crate::args::{MergeArgs, Shard};
use crate::failure::Failure;
use crate::files;
use crate::folder::Folder;
use std::fs;
use std::path::PathBuf;

/// Puts parts together and writes the results.
pub(super) fn merge(args: &MergeArgs) -> Result<(), Failure> {
    let mut parts = args.parts.iter().map(|part| Blocks::open(part)).collect::<Result<Vec<_>, _>>()?;
    parts.sort_by_key(|part| part.head.shard[0]);
    let head = whole(&parts)?;
    let opened = Folder::open(&args.out)?;
    let mut store = Store::create(opened.path(), &head)?;
    let every = parts.len() as u64;
    for block in 0..head.blocks() {
        let part = &mut parts[usize::try_from(block % every).unwrap_or(0)];
        let Some(bytes) = part.next()? else { return Err(incomplete(part)) };
        store.append(&bytes, 1)?;
    }
    drop(store);
    let study = study(&args.parts, &head);
    let loaded = Loaded { name: head.name.clone(), ..Loaded::of_text(&study, head.study.clone())? };
    results::write(opened.path(), &loaded)
}

/// Where the study is, or was: what it names is seen from there.
fn study(parts: &[PathBuf], head: &Head) -> PathBuf {
    let noted = parts.iter().filter_map(|part| fs::read_to_string(part.join(PLACE)).ok()).map(PathBuf::from);
    let mut known = noted.chain([files::root().join(&head.path)]);
    known.find(|path| path.is_file()).unwrap_or_else(|| PathBuf::from(&head.path))
}

/// The head of all parts together.
fn whole(parts: &[Blocks]) -> Result<Head, Failure> {
    let first = &parts[0];
    let head = first.head.clone().with(Shard::WHOLE);
    for (part, number) in parts.iter().zip(0..) {
        let path = part.path.display();
        let of_whole = part.head.clone().with(Shard::WHOLE);
        if let Some(what) = of_whole.difference(&head) {
            return Err(Failure::Usage(format!("{path} is {what} than {}", first.path.display())));
        }
        if part.head.shard != [number, parts.len() as u64] {
            let [found, of] = part.head.shard;
            return Err(Failure::Usage(format!(
                "{path} is part {}/{of}: parts 1 to {of} were expected, each once, and there are {}",
                found + 1,
                parts.len()
            )));
        }
    }
    Ok(head)
}

fn incomplete(part: &Blocks) -> Failure {
    let [number, of] = part.head.shard;
    Failure::Usage(format!(
        "{} is not complete: run `sweep {} --shard {}/{of} --resume` first",
        part.path.display(),
        part.head.path,
        number + 1
    ))
}
