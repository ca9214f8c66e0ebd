//! A functional mock-up unit: sources, library and description in one archive.

use super::{Scratch, run, say};
use crate::args::FmuArgs;
use crate::columns;
use crate::failure::Failure;
use crate::folder;
use crate::generate::modules;
use crate::left_out;
use crate::paths;
use crate::progress::Spinner;
use crate::scene;
use crate::write::{self, Known};
use flate2::Compression;
use flate2::write::DeflateEncoder;
use gyro_export::fmu::{Fmu, OPTIONS, Settings, fmu as written};
use gyro_model::Model;
use rawzip::time::UtcDateTime;
use rawzip::{CompressionMethod, ZipArchiveWriter};
use std::ffi::{OsStr, OsString};
use std::io::{self, Write as _};
use std::path::Path;
use std::{env, fs};

/// Writes the archive.
pub(super) fn fmu(args: &FmuArgs) -> Result<(), Failure> {
    let mut model = scene::read(&args.model)?;
    asked(&mut model, args);
    let out = &folder::file(&args.out, &format!("{}.fmu", model.name));
    write::check(out, Known::Record)?;
    left_out::tell(&model, "the exported unit");
    paths::refuse(&model, "an exported unit")?;
    let asked = |_: &Path, model: &mut Model| asked(model, args);
    let made = modules(std::slice::from_ref(&args.model), &asked, args.strict).pop();
    let module = made.expect("one model file gives one module")?;
    let method = args.integrator.name();
    let inputs = (0..model.inputs.len()).map(|input| columns::input_unit(&model, input).to_owned());
    let outputs = columns::outputs(&model).into_iter().map(|(name, unit)| (name, unit.to_owned()));
    let settings = Settings {
        token: format!(
            "{{{}}}",
            write::digest(format!("{}{method}{:?}", module.code, args.tolerance).as_bytes())
        ),
        method,
        tolerance: args.tolerance,
        input_units: inputs.collect(),
        outputs: outputs.collect(),
    };
    let unit = written(&model, &module.scheduled, &settings)
        .map_err(|e| Failure::Usage(format!("{}: no FMU can be made: {e}", args.model.display())))?;
    let library = if args.sources_only { None } else { Some(library(&unit)?) };
    let archive =
        archive(&unit, library.as_deref()).map_err(|e| Failure::Run(format!("{}: {e}", out.display())))?;
    let is_new = write::write(out, archive, Known::Record)?;
    say(&format!("{} {}", if is_new { "wrote" } else { "fresh already:" }, out.display()));
    Ok(())
}

/// What is asked for of the module.
fn asked(model: &mut Model, args: &FmuArgs) {
    let of_outputs =
        ["joint_outputs", "output_derivatives"].into_iter().filter(|_| !model.outputs.is_empty());
    model.functions = Some(["solvers"].into_iter().chain(of_outputs).map(str::to_owned).collect());
    model.counts_work &= args.count_work;
}

/// The platform's name in FMI, and what its libraries end with.
fn platform() -> (String, &'static str) {
    let system = match env::consts::OS {
        "macos" => "darwin",
        other => other,
    };
    (format!("{}-{system}", env::consts::ARCH), env::consts::DLL_SUFFIX)
}

/// The bytes of the library for this platform.
fn library(unit: &Fmu) -> Result<Vec<u8>, Failure> {
    let spinner = Spinner::new(format!("compiling {}", unit.identifier));
    let folder = Scratch::new()?;
    let failed = |path: &Path, e: &io::Error| Failure::Run(format!("{}: {e}", path.display()));
    for (path, text) in &unit.files {
        let path = folder.0.join(path);
        let made = path.parent().map_or(Ok(()), fs::create_dir_all);
        made.and_then(|()| fs::write(&path, text)).map_err(|e| failed(&path, &e))?;
    }
    let library = folder.0.join("library");
    let sources: Vec<OsString> =
        unit.sources.iter().map(|source| folder.0.join(source).into_os_string()).collect();
    let mut arguments: Vec<&OsStr> = OPTIONS.iter().map(OsStr::new).collect();
    arguments.extend(["-fPIC", "-shared", "-fvisibility=hidden", "-o"].map(OsStr::new));
    arguments.push(library.as_os_str());
    arguments.extend(sources.iter().map(OsString::as_os_str));
    arguments.push(OsStr::new("-lm"));
    let cc = env::var_os("CC").unwrap_or_else(|| "cc".into());
    run(&cc, &arguments, "CC", "give --sources-only")?;
    drop(spinner);
    fs::read(&library).map_err(|e| failed(&library, &e))
}

/// 1980-01-01, the first day that such an archive knows, s.
const FIRST_DAY: i64 = 315_532_800;

/// All of it in one file, the same bytes each time.
fn archive(unit: &Fmu, library: Option<&[u8]>) -> Result<Vec<u8>, rawzip::Error> {
    let mut archive = ZipArchiveWriter::new(Vec::new());
    let mut add = |path: &str, content: &[u8], permissions: u32| {
        let entry = archive.new_file(path).compression_method(CompressionMethod::DEFLATE);
        let entry = entry.last_modified(UtcDateTime::from_unix(FIRST_DAY)).unix_permissions(permissions);
        let (mut entry, config) = entry.start()?;
        let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::default()));
        writer.write_all(content)?;
        let (encoder, end) = writer.finish()?;
        encoder.finish()?;
        entry.finish(end)
    };
    for (path, text) in &unit.files {
        add(path, text.as_bytes(), 0o644)?;
    }
    if let Some(library) = library {
        let (platform, suffix) = platform();
        add(&format!("binaries/{platform}/{}{suffix}", unit.identifier), library, 0o755)?;
    }
    archive.finish()
}
