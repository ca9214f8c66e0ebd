//! `cargo xtask release`: what must hold of the crates before they are published.

use crate::args::ReleaseArgs;
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::programs::{cargo, output};
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use std::{env, fs};

/// The library of the run time, packed, B at most: who takes it for a microcontroller gets it by cargo, too.
const LARGEST_LIBRARY: u64 = 150_000;

/// What a crate says of itself where it is published.
const FIELDS: [&str; 6] = ["description", "license", "documentation", "readme", "keywords", "categories"];

/// Checks the tree, the manifests and the changelog; packs and builds all crates that are published, as `cargo publish`
/// would; and says what is left to do.
pub(crate) fn release(args: &ReleaseArgs) -> Result<(), Failure> {
    if !args.allow_dirty {
        let changed = output(git().args(["status", "--porcelain"]))?;
        holds(changed.is_empty(), || format!("files differ from the commit:\n{changed}"))?;
    }
    let packages = published()?;
    for package in &packages {
        described(package)?;
    }
    let version = env!("CARGO_PKG_VERSION");
    if !args.allow_dirty {
        let changes = fs::read_to_string(files::root().join("CHANGELOG.md")).unwrap_or_default();
        let heading = format!("## {version}");
        holds(changes.contains(&heading), || format!("CHANGELOG.md has no heading `{heading}`"))?;
    }
    let dirty = args.allow_dirty.then_some("--allow-dirty");
    let unbuilt = args.no_build.then_some("--no-verify");
    let publish = ["publish", "--dry-run", "--workspace", "--locked"];
    run(publish.into_iter().chain(dirty).chain(unbuilt), "cargo would not publish")?;
    // What `publish` packs it does not keep.
    let package = ["package", "--quiet", "--package", "gyro-sim", "--no-verify", "--locked"];
    run(package.into_iter().chain(dirty), "gyro-sim cannot be packed")?;
    let target = env::var_os("CARGO_TARGET_DIR").unwrap_or_else(|| "target".into());
    let packed = files::root().join(target).join("package").join(format!("gyro-sim-{version}.crate"));
    let bytes = size(&packed)?;
    holds(bytes < LARGEST_LIBRARY, || {
        format!("gyro-sim takes {bytes} bytes packed, over {LARGEST_LIBRARY}")
    })?;
    let names: Vec<&str> = packages.iter().filter_map(|package| package["name"].as_str()).collect();
    eprintln!(
        "{} crates can be published ({}); gyro-sim takes {bytes} bytes packed\n\
         to do so: git tag v{version} && git push --tags && cargo publish --workspace --locked",
        names.len(),
        names.join(", ")
    );
    Ok(())
}

fn holds(is_well: bool, words: impl FnOnce() -> String) -> Result<(), Failure> {
    if is_well { Ok(()) } else { Err(Failure::Run(words())) }
}

/// Runs cargo in the folder of the project.
fn run<'a>(arguments: impl Iterator<Item = &'a str>, otherwise: &str) -> Result<(), Failure> {
    let status = Command::new(cargo()).args(arguments).current_dir(files::root()).status();
    let status = status.map_err(|e| Failure::Run(format!("cargo cannot be started: {e}")))?;
    holds(status.success(), || otherwise.to_owned())
}

fn git() -> Command {
    let mut git = Command::new("git");
    git.current_dir(files::root());
    git
}

/// The members of the workspace that are published, as cargo describes them.
fn published() -> Result<Vec<Value>, Failure> {
    let mut metadata = Command::new(cargo());
    metadata.args(["metadata", "--format-version=1", "--no-deps", "--locked"]).current_dir(files::root());
    let mut all: Value = serde_json::from_str(&output(&mut metadata)?)
        .map_err(|e| Failure::Run(format!("cargo metadata cannot be read: {e}")))?;
    let Value::Array(packages) = all["packages"].take() else { return Ok(Vec::new()) };
    // `publish = false` is an empty list of registries.
    Ok(packages.into_iter().filter(|package| package["publish"].is_null()).collect())
}

/// Whether a package says all that it should.
fn described(package: &Value) -> Result<(), Failure> {
    let is_empty = |field: &&str| match &package[*field] {
        Value::Null => true,
        Value::Array(items) => items.is_empty(),
        Value::String(text) => text.is_empty(),
        _ => false,
    };
    let missing: Vec<&str> = FIELDS.into_iter().filter(is_empty).collect();
    let name = package["name"].as_str().unwrap_or_default();
    holds(missing.is_empty(), || format!("the manifest of {name} lacks {}", missing.join(", ")))
}

fn size(path: &Path) -> Result<u64, Failure> {
    match fs::metadata(path) {
        Ok(found) => Ok(found.len()),
        Err(error) => Err(Failure::Run(format!("{} cannot be read: {error}", path.display()))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_published_crate_describes_itself() {
        let packages = published().unwrap();
        assert!(packages.len() >= 14, "{packages:?}");
        for package in &packages {
            described(package).unwrap();
            let mut without = package.clone();
            without["keywords"] = Value::Array(Vec::new());
            assert!(matches!(described(&without), Err(Failure::Run(words)) if words.ends_with("keywords")));
        }
    }
}
