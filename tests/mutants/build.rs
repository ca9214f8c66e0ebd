//! Copies the generator's text and puts the faults of `faults.rs` into it, each behind a switch: one build serves them
//! all.

use std::error::Error;
use std::fs;
use std::path::Path;

include!("faults.rs");

fn main() -> Result<(), Box<dyn Error>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../codegen/src");
    let out = std::path::PathBuf::from(std::env::var("OUT_DIR")?);
    println!("cargo::rerun-if-changed={}", source.display());
    println!("cargo::rerun-if-changed=faults.rs");
    let copy = out.join("codegen");
    if copy.exists() {
        fs::remove_dir_all(&copy)?;
    }
    copy_folder(&source, &copy)?;
    let mut stale = Vec::new();
    for (file, place, instead) in QUICKER {
        let text = fs::read_to_string(copy.join(file))?;
        fs::write(copy.join(file), text.replace(place, instead))?;
        stale.extend((text.matches(place).count() != 1).then(|| format!("{file}: {place}")));
    }
    for (index, fault) in FAULTS.iter().enumerate() {
        let path = copy.join(fault.file);
        let text = fs::read_to_string(&path).unwrap_or_default();
        match switched(&text, fault, index + 1) {
            Some(text) => fs::write(&path, text)?,
            None => stale.push(format!("{}: {}", fault.file, fault.place)),
        }
    }
    // What is included in the middle of a crate has no inner attributes.
    let root = fs::read_to_string(copy.join("lib.rs"))?;
    let lines = root.lines().filter(|line| !line.starts_with("//!") && !line.starts_with("#!["));
    fs::write(copy.join("lib.rs"), lines.map(|line| format!("{line}\n")).collect::<String>())?;
    fs::write(out.join("stale.rs"), format!("&{stale:?}"))?;
    Ok(())
}

fn copy_folder(from: &Path, to: &Path) -> std::io::Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &target)?;
        } else {
            // The generator's own tests stay behind.
            let text = fs::read_to_string(entry.path())?;
            fs::write(target, text.split("\n#[cfg(test)]\nmod tests").next().unwrap_or(&text))?;
        }
    }
    Ok(())
}

/// The text with a fault behind its switch; `None` unless its place is there exactly once.
fn switched(text: &str, fault: &Fault, number: usize) -> Option<String> {
    let (before, rest) = fault.place.split_once('«')?;
    let (right, after) = rest.split_once('»')?;
    let place = format!("{before}{right}{after}");
    let wrong = fault.wrong;
    let switch = format!("{before}(if crate::fault() == {number} {{ {wrong} }} else {{ {right} }}){after}");
    (text.matches(&place).count() == 1).then(|| text.replace(&place, &switch))
}
