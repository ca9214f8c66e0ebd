//! Packs what generated programs are compiled against into one archive, which the program carries: the sources of the
//! runtime and of the runner, and of the few crates that these need. And asks git which commit this is.

use flate2::Compression;
use flate2::write::GzEncoder;
use std::collections::BTreeMap;
use std::error::Error;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates of this project that programs are compiled against, and the folders of their manifests.
const OWN: [(&str, &str, &str); 4] = [
    ("gyro-sim", "gyro-sim", gyro_sim::MANIFEST_FOLDER),
    ("gyro-runner", "runner", gyro_runner::MANIFEST_FOLDER),
    ("gyro-sweep", "sweep", gyro_sweep::MANIFEST_FOLDER),
    ("gyro-yardstick", "yardstick", gyro_yardstick::MANIFEST_FOLDER),
];

fn main() -> Result<(), Box<dyn Error>> {
    let here = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?);
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    let mut files = own_files(&here)?;
    files.extend(vendored_files(&here, &out)?);
    write_archive(&out.join("runtime.json.gz"), files)?;
    let commit = commit(&here).unwrap_or_default();
    println!("cargo::rustc-env=GYRO_COMMIT={commit}");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src");
    Ok(())
}

/// A file of the archive: its name there, and its content.
type Carried = (String, Vec<u8>);

/// The crates of this project, with the tables of the workspace that their manifests refer to.
fn own_files(here: &Path) -> Result<Vec<Carried>, Box<dyn Error>> {
    let mut files = Vec::new();
    for (_, name, folder) in OWN {
        let folder = Path::new(folder);
        for part in ["Cargo.toml", "src"] {
            let path = folder.join(part);
            println!("cargo::rerun-if-changed={}", path.display());
            collect(&path, &format!("{name}/{part}"), &mut files)?;
        }
    }
    // Mechanisms that the runtime ships are of no use to the program of another.
    files.retain(|(name, _)| !name.starts_with("gyro-sim/src/generated/"));
    // Published, their manifests need no workspace.
    let root = here.join("../Cargo.toml");
    if let Ok(text) = fs::read_to_string(&root) {
        println!("cargo::rerun-if-changed={}", root.display());
        files.push(("Cargo.toml".to_owned(), workspace(&text)?.into_bytes()));
    }
    Ok(files)
}

/// What members inherit, and no other members.
fn workspace(text: &str) -> Result<String, Box<dyn Error>> {
    let root: toml::Table = text.parse()?;
    let mut workspace = root["workspace"].as_table().ok_or("a workspace has a table")?.clone();
    workspace.retain(|key, _| ["resolver", "package", "dependencies", "lints"].contains(&key));
    workspace.insert("members".to_owned(), OWN.map(|(_, folder, _)| folder.to_owned()).to_vec().into());
    workspace.insert("exclude".to_owned(), vec!["programs".to_owned(), "vendor".to_owned()].into());
    Ok(toml::Table::from_iter([("workspace".to_owned(), workspace.into())]).to_string())
}

/// The crates of others, as cargo vendors them for a package that needs what generated programs need.
fn vendored_files(here: &Path, out: &Path) -> Result<Vec<Carried>, Box<dyn Error>> {
    let package = out.join("vendoring");
    if package.exists() {
        fs::remove_dir_all(&package)?;
    }
    fs::create_dir_all(package.join("src"))?;
    fs::write(package.join("src/lib.rs"), "")?;
    fs::write(package.join("Cargo.toml"), manifest())?;
    let locks = [here.join("../Cargo.lock"), here.join("Cargo.lock")];
    if let Some(lock) = locks.iter().find(|lock| lock.is_file()) {
        println!("cargo::rerun-if-changed={}", lock.display());
        fs::copy(lock, package.join("Cargo.lock"))?;
    }
    // All of it has just been fetched for this very build, but for what only other processors need.
    if vendor(&package, &["--offline"])?.is_some()
        && let Some(words) = vendor(&package, &[])?
    {
        return Err(format!("cargo vendor: {words}").into());
    }
    let mut files = vec![("Cargo.lock".to_owned(), fs::read(package.join("Cargo.lock"))?)];
    files.push((".cargo/config.toml".to_owned(), SOURCES.as_bytes().to_vec()));
    for entry in sorted(&package.join("vendor"))? {
        let name = format!("vendor/{}", entry.file_name().ok_or("a folder has a name")?.display());
        for path in sorted(&entry)? {
            let part = path.file_name().ok_or("a file has a name")?.to_string_lossy().into_owned();
            if !part.starts_with('.') && !UNUSED.contains(&part.as_str()) {
                collect(&path, &format!("{name}/{part}"), &mut files)?;
            }
        }
        // Of what is left out no sums are to be checked.
        let sums: serde_json::Value = serde_json::from_slice(&fs::read(entry.join(CHECKSUMS))?)?;
        let sums = serde_json::json!({ "files": {}, "package": sums["package"] });
        files.push((format!("{name}/{CHECKSUMS}"), sums.to_string().into_bytes()));
    }
    Ok(files)
}

/// What crates bring along and no build of theirs needs.
const UNUSED: [&str; 7] =
    ["tests", "benches", "examples", "Cargo.lock", "Cargo.toml.orig", "CHANGELOG.md", "changelog.md"];

const CHECKSUMS: &str = ".cargo-checksum.json";

/// Where cargo finds the crates of others below the folder of an archive.
const SOURCES: &str = "[source.crates-io]
replace-with = \"vendored\"

[source.vendored]
directory = \"vendor\"
";

/// A package that needs what generated programs need.
fn manifest() -> String {
    let paths =
        OWN.map(|(name, _, folder)| format!("{name} = {{ path = {folder:?}, default-features = false }}\n"));
    let paths = paths.concat();
    format!(
        "[package]\nname = \"vendoring\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
         [dependencies]\n{paths}\n[patch.crates-io]\n{paths}"
    )
}

/// What cargo says if it cannot.
fn vendor(package: &Path, options: &[&str]) -> Result<Option<String>, Box<dyn Error>> {
    let output = Command::new(std::env::var_os("CARGO").ok_or("cargo builds this")?)
        .args(["vendor", "--quiet", "--versioned-dirs"])
        .args(options)
        .current_dir(package)
        .output()?;
    Ok((!output.status.success()).then(|| String::from_utf8_lossy(&output.stderr).into_owned()))
}

/// Adds a file, or all files below a folder.
fn collect(path: &Path, name: &str, files: &mut Vec<Carried>) -> Result<(), Box<dyn Error>> {
    if path.is_dir() {
        for entry in sorted(path)? {
            let inner = format!("{name}/{}", entry.file_name().ok_or("a file has a name")?.display());
            collect(&entry, &inner, files)?;
        }
    } else {
        files.push((name.to_owned(), fs::read(path)?));
    }
    Ok(())
}

fn sorted(folder: &Path) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut entries =
        fs::read_dir(folder)?.map(|e| Ok(e?.path())).collect::<Result<Vec<_>, Box<dyn Error>>>()?;
    entries.sort();
    Ok(entries)
}

/// An object of JSON with the text of each file. The same files give the same bytes.
fn write_archive(path: &Path, files: Vec<Carried>) -> Result<(), Box<dyn Error>> {
    let texts: BTreeMap<String, String> = files
        .into_iter()
        .map(|(name, content)| Ok((name, String::from_utf8(content)?)))
        .collect::<Result<_, Box<dyn Error>>>()?;
    let mut archive = GzEncoder::new(File::create(path)?, Compression::default());
    serde_json::to_writer(&mut archive, &texts)?;
    archive.finish()?;
    Ok(())
}

/// The commit that this is built from, and a mark where files differ from it; none outside of a clone.
fn commit(here: &Path) -> Option<String> {
    let git = |args: &[&str]| {
        let output = Command::new("git").args(args).current_dir(here).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    // A package unpacked inside of somebody's repository is not of that repository.
    git(&["ls-files", "--error-unmatch", "build.rs"])?;
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={}", here.join(log).display());
    }
    let changed = git(&["status", "--porcelain", "--untracked-files=no"])?;
    let mark = if changed.is_empty() { "" } else { ", changed" };
    Some(format!("{}{mark}", git(&["rev-parse", "--short=9", "HEAD"])?))
}
