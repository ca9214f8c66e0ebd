//! `cargo xtask generate`: data sheets and the modules that are kept, by one function with two modes, write and check.

use crate::args::GenerateArgs;
use crate::failure::Failure;
use crate::invocation::program;
use crate::places::{Place, all_model_files, listing, module_path, place_of};
use crate::side_by_side::side_by_side;
use crate::verify::proved;
use crate::words::count;
use crate::write::{self, Known};
use crate::{files, folder, progress, remarks, scene};
use gyro_codegen::Module;
use gyro_model::Model;
use gyro_verifier::constants::Constants;
use similar::TextDiff;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Duration;
use std::{fs, io};

/// Writes the data sheets of the models and the modules that are kept, or checks that they are fresh.
pub(crate) fn generate(args: &GenerateArgs) -> Result<(), Failure> {
    let outputs = outputs(args, &Place::all())?;
    if args.check { check(&outputs, &mend(args)) } else { write(&outputs) }
}

/// What the generated files should be.
#[derive(Debug, Default)]
struct Outputs {
    files: Vec<Output>,
    /// What has to be done by hand.
    to_do: Vec<String>,
    /// Model files of which no module is written.
    without_module: Vec<PathBuf>,
}

/// One generated file.
#[derive(Debug)]
struct Output {
    path: PathBuf,
    text: String,
}

/// Generates everything in memory: a mistake anywhere leaves all files as they are.
fn outputs(args: &GenerateArgs, places: &[Place]) -> Result<Outputs, Failure> {
    let pages = if args.models.is_empty() { all_model_files(places)? } else { args.models.clone() };
    if args.out.is_some() && pages.len() != 1 {
        return Err(Failure::Usage("--out takes the module of a single MODEL: give one".to_owned()));
    }
    let mut outputs = Outputs::default();
    let mut names = Vec::new();
    let mut sources: Vec<(PathBuf, &PathBuf)> = Vec::new();
    let asked = |page: &Path, model: &mut Model| asked(args, places, page, model);
    for (page, made) in pages.iter().zip(modules(&pages, &asked, args.strict)) {
        let module = made?;
        let place = place_of(places, page).filter(|_| args.out.is_none());
        let wished = args.out.as_ref().map(|out| folder::file(out, &format!("{}.rs", module.name)));
        let path = wished.or_else(|| module_path(places, page, &module.name));
        let sheet = place.map(|place| place.sheet(&module.name));
        let first = sheet
            .clone()
            .or_else(|| path.clone())
            .expect("a model file from elsewhere has its module beside it");
        if let Some((_, other)) = sources.iter().find(|(known, _)| *known == first) {
            let (this, other) = (page.display(), other.display());
            return Err(Failure::Usage(format!("{this} and {other} have the same name `{}`", module.name)));
        }
        sources.push((first, page));
        outputs.files.extend(sheet.map(|path| Output { path, text: data_sheet(&module) }));
        names.push(module.name);
        match path {
            // The module first: it is by the module beside them that the constants are known.
            Some(path) => {
                outputs.files.push(Output { path: path.clone(), text: module.code });
                outputs.files.push(Output { path: path.with_extension("exact"), text: module.constants });
            }
            None => outputs.without_module.push(page.clone()),
        }
    }
    if args.models.is_empty() {
        for place in places {
            outputs
                .to_do
                .extend(orphans(&place.sheets, "txt", |name| names.iter().any(|known| known == name))?);
            for (folder, kept) in &place.kept {
                outputs.to_do.extend(by_hand(folder, kept)?);
            }
        }
    }
    Ok(outputs)
}

/// The head of a module as a text of its own, with digests by which a change of anything else shows.
fn data_sheet(module: &Module) -> String {
    let head = module
        .code
        .lines()
        .take_while(|line| line.is_empty() || line.starts_with(MARK) || line.starts_with("//!"));
    let lines =
        head.map(|line| line.strip_prefix("//!").map_or(line, |line| line.strip_prefix(' ').unwrap_or(line)));
    let mut text = lines.collect::<Vec<_>>().join("\n").trim_end().to_owned();
    text.push('\n');
    for (what, of) in [("module", &module.code), ("exact constants", &module.constants)] {
        let (lines, digest) = (count(of.lines().count() as u64, "line"), write::digest(of.as_bytes()));
        let _ = write!(text, "\n{what}: {lines}, digest {digest}");
    }
    text + "\n"
}

/// What a module of this command has: of a model file elsewhere what is asked for here. Those of this project are read,
/// tested and measured whole.
fn asked(args: &GenerateArgs, places: &[Place], page: &Path, model: &mut Model) {
    if place_of(places, page).is_some() {
        of_solvers(model);
    } else {
        model.counts_work &= args.count_work;
    }
    if let Some(names) = &args.functions {
        model.functions = Some(names.clone());
    }
}

/// Has a module have what solvers call, unless its model file says which functions it is to have.
pub(crate) fn of_solvers(model: &mut Model) {
    model.functions.get_or_insert_with(|| vec!["solvers".to_owned()]);
}

/// The modules of model files, each proved and with the proof on its data sheet. Of each model may be changed what the
/// module is to have: its functions, and whether its state carries the work.
pub fn modules(
    pages: &[PathBuf],
    asked: &(dyn Fn(&Path, &mut Model) + Sync),
    strict: bool,
) -> Vec<Result<Module, Failure>> {
    let module = |page: &PathBuf| {
        let mut model = scene::read(page)?;
        asked(page, &mut model);
        remarks::report_redundant(&model, &page.display().to_string(), strict)?;
        let spinner = progress::deriving(&model);
        let module = gyro_codegen::generate_model(&files::shown(page), &model)
            .map_err(|e| Failure::Usage(format!("{}: {e}", page.display())))?;
        drop(spinner);
        for what in module.data_sheet.unavailable() {
            remarks::warn(&format!("{}: {what}", page.display()));
        }
        proved(&model, module)
    };
    side_by_side(pages.len(), |k| module(&pages[k])).into_iter().collect()
}

/// How a generated module begins.
const MARK: &str = "// @generated";

/// Writes what has changed and says where.
fn write(outputs: &Outputs) -> Result<(), Failure> {
    // Before anything is written: nothing is lost by a mistaken name.
    outputs.files.iter().try_for_each(spare_what_is_not_generated)?;
    let mut n_fresh = 0;
    for output in &outputs.files {
        // Known by what has just been looked at.
        if files::write(&output.path, &output.text)? {
            say(&format!("wrote {}", output.path.display()));
        } else {
            n_fresh += 1;
        }
    }
    if n_fresh > 0 {
        say(&format!("{} fresh already", count(n_fresh, "file")));
    }
    if let [page] = &outputs.without_module[..] {
        say(&format!(
            "{}: its module is generated when it is compiled; --out FILE writes it",
            page.display()
        ));
    }
    if outputs.to_do.is_empty() { Ok(()) } else { Err(Failure::Run(outputs.to_do.join("\n"))) }
}

/// Refuses to replace what somebody else wrote, or what this run reads. A module is known by its first line. A file of
/// constants has no room for one: it is known by the generated module beside it and by being just such a file, line for
/// line.
fn spare_what_is_not_generated(output: &Output) -> Result<(), Failure> {
    let path = &output.path;
    if output.text.starts_with(MARK) {
        return write::check(path, Known::Mark(MARK));
    }
    write::check(path, Known::Place)?;
    let is_module = fs::read(path.with_extension("rs")).is_ok_and(|text| text.starts_with(MARK.as_bytes()));
    let is_constants = |text: &str| text.is_empty() || is_module && Constants::read(text).is_ok();
    match fs::read_to_string(path) {
        Ok(text) if !is_constants(&text) => Err(Failure::Usage(format!(
            "{} exists and is not a file that this tool has written: choose another place with --out, or move it away",
            path.display()
        ))),
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            Err(Failure::Usage(format!("{} exists and cannot be read: {error}", path.display())))
        }
        _ => Ok(()),
    }
}

/// Compares files with what they should be.
fn check(outputs: &Outputs, mend: &str) -> Result<(), Failure> {
    let stale: Vec<String> = outputs.files.iter().filter_map(difference).collect();
    if stale.is_empty() && outputs.to_do.is_empty() {
        say(&format!("{} fresh", count(outputs.files.len() as u64, "file")));
        return Ok(());
    }
    let mut words = stale.join("\n");
    for to_do in &outputs.to_do {
        let _ = writeln!(words, "{to_do}");
    }
    if !stale.is_empty() {
        let _ = write!(words, "to fix this, run: {mend}");
    }
    Err(Failure::Run(words.trim_end().to_owned()))
}

/// The command that mends what a check finds.
fn mend(args: &GenerateArgs) -> String {
    let models = args.models.iter().map(|m| format!(" {}", m.display()));
    let out = args.out.iter().map(|o| format!(" --out {}", o.display()));
    let functions = args.functions.iter().map(|names| format!(" --functions {}", names.join(",")));
    let work = args.count_work.then(|| " --count-work".to_owned());
    format!("{} generate{}", program(), models.chain(out).chain(functions).chain(work).collect::<String>())
}

/// Lines of a difference that are shown.
const SHOWN_LINES: usize = 20;

fn difference(output: &Output) -> Option<String> {
    let path = output.path.display();
    let found = match fs::read_to_string(&output.path) {
        Ok(found) if found == output.text => return None,
        Ok(found) => found,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Some(format!("{path} is missing\n")),
        Err(error) => return Some(format!("{path} cannot be read: {error}\n")),
    };
    // Long texts of which nothing is alike would be compared for hours.
    let diff = TextDiff::configure().timeout(Duration::from_secs(2)).diff_lines(&found, &output.text);
    let unified = diff.unified_diff().context_radius(1).header("as it is", "as its model says").to_string();
    let mut words = format!("{path} differs from what its model generates:\n");
    for line in unified.lines().take(SHOWN_LINES) {
        let _ = writeln!(words, "{line}");
    }
    let n_hidden = unified.lines().count().saturating_sub(SHOWN_LINES);
    if n_hidden > 0 {
        let _ = writeln!(words, "... and {}", count(n_hidden as u64, "further line"));
    }
    Some(words)
}

/// What the hand-written door file of a folder of modules lacks, and generated files that do not belong there.
fn by_hand(folder: &Path, kept: &[&str]) -> Result<Vec<String>, Failure> {
    let door = folder.join("mod.rs");
    let text = fs::read_to_string(&door)
        .map_err(|e| Failure::Usage(format!("{} cannot be read: {e}", door.display())))?;
    let is_declared = |name: &str| text.lines().any(|line| line.trim() == format!("pub mod {name};"));
    let mut to_do: Vec<String> = kept
        .iter()
        .filter(|name| !is_declared(name))
        .map(|name| format!("add this line to {}: pub mod {name};", door.display()))
        .collect();
    for extension in ["rs", "exact"] {
        to_do.extend(orphans(folder, extension, |name| name == "mod" || kept.contains(&name))?);
    }
    Ok(to_do)
}

fn orphans(folder: &Path, extension: &str, is_known: impl Fn(&str) -> bool) -> Result<Vec<String>, Failure> {
    let is_orphan = |path: &PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        path.extension().is_some_and(|e| e == extension) && !is_known(&stem)
    };
    let orphans = listing(folder)?.into_iter().filter(is_orphan);
    Ok(orphans
        .map(|path| format!("{} belongs to no model of this workspace: delete it", path.display()))
        .collect())
}

fn say(words: &str) {
    // What was said is only about files that are there already.
    let _ = writeln!(io::stdout(), "{words}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::tests::Folder;

    const PAGE: &str = "format = 1
name = \"plate\"
[[body]]
name = \"plate\"
free = true
mass = 0.1
inertia = [1e-4, 1e-4, 2e-4]
";

    /// A workspace with one model, its module kept and, if so, its line in the door file.
    fn workspace(door: &str) -> (Folder, [Place; 1]) {
        let folder = Folder::new();
        let generated = folder.0.join("generated");
        let (models, sheets) = (folder.0.join("models"), folder.0.join("sheets"));
        [&generated, &models, &sheets].iter().for_each(|folder| fs::create_dir_all(folder).unwrap());
        fs::write(models.join("plate.toml"), PAGE).unwrap();
        fs::write(generated.join("mod.rs"), door).unwrap();
        (folder, [Place { models, sheets, kept: vec![(generated, &["plate"])] }])
    }

    fn args(models: &[PathBuf], out: Option<PathBuf>) -> GenerateArgs {
        let [check, count_work, strict] = [false; 3];
        GenerateArgs { models: models.to_vec(), check, out, functions: None, count_work, strict }
    }

    fn words(outcome: Result<(), Failure>) -> String {
        match outcome {
            Err(Failure::Run(words)) => words,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_was_written_is_fresh_and_what_was_edited_is_not() {
        let (_folder, places) = workspace("pub mod plate;\n");
        let outputs = outputs(&args(&[], None), &places).unwrap();
        let mend = "cargo xtask generate";
        assert!(words(check(&outputs, mend)).contains("plate.rs is missing"));
        write(&outputs).unwrap();
        check(&outputs, mend).unwrap();
        for path in [places[0].module("plate").unwrap(), places[0].sheet("plate")] {
            let fresh = fs::read_to_string(&path).unwrap();
            fs::write(&path, format!("{fresh}// edited\n")).unwrap();
            let found = words(check(&outputs, mend));
            assert!(found.contains("-// edited"), "{found}");
            assert!(found.ends_with("to fix this, run: cargo xtask generate"), "{found}");
            fs::write(&path, fresh).unwrap();
        }
    }

    #[test]
    fn a_module_that_is_not_kept_has_its_sheet_all_the_same() {
        let (folder, mut places) = workspace("pub mod plate;\n");
        places[0].kept.clear();
        let sheet_of = |page: &str| {
            fs::write(places[0].models.join("plate.toml"), page).unwrap();
            let outputs = outputs(&args(&[], None), &places).unwrap();
            write(&outputs).unwrap();
            assert_eq!(outputs.files.len(), 1);
            fs::read_to_string(folder.0.join("sheets/plate.txt")).unwrap()
        };
        let sheet = sheet_of(PAGE);
        for part in
            ["from plate.toml", "\n| accelerations | ", "\n# Proof\n", "\nmodule: ", "\nexact constants: "]
        {
            assert!(sheet.contains(part), "{part} is missing: {sheet}");
        }
        // As many operations, another literal.
        assert_ne!(sheet_of(&PAGE.replace("mass = 0.1", "mass = 0.2")), sheet);
    }

    #[test]
    fn the_door_file_is_told_line_by_line() {
        let (_folder, places) = workspace("// pub mod plate;\n");
        fs::write(places[0].kept[0].0.join("old.rs"), "").unwrap();
        fs::write(places[0].sheets.join("older.txt"), "").unwrap();
        let outputs = outputs(&args(&[], None), &places).unwrap();
        let found = words(write(&outputs));
        assert!(found.contains("mod.rs: pub mod plate;"), "{found}");
        assert!(
            found.contains("old.rs belongs to no model") && found.contains("older.txt belongs to no model"),
            "{found}"
        );
    }

    #[test]
    fn pages_elsewhere_are_written_beside_or_where_asked() {
        let (folder, places) = workspace("");
        let page = folder.0.join("mine.toml");
        fs::write(&page, PAGE).unwrap();
        let path =
            |out| outputs(&args(std::slice::from_ref(&page), out), &places).unwrap().files[0].path.clone();
        assert_eq!(path(None), folder.0.join("plate.rs"));
        assert_eq!(path(Some(folder.0.join("x.rs"))), folder.0.join("x.rs"));
        let two = args(&[page.clone(), page.clone()], Some(folder.0.join("x.rs")));
        assert!(
            matches!(outputs(&two, &places), Err(Failure::Usage(words)) if words.contains("single MODEL"))
        );
        let same = args(&[page.clone(), page], None);
        assert!(matches!(outputs(&same, &places), Err(Failure::Usage(words)) if words.contains("same name")));
    }

    #[test]
    fn what_was_written_by_hand_stays() {
        let (folder, places) = workspace("");
        let page = folder.0.join("mine.toml");
        fs::write(&page, PAGE).unwrap();
        let attempt = || outputs(&args(std::slice::from_ref(&page), None), &places).and_then(|o| write(&o));
        for (name, text) in
            [("plate.exact", "my notes\n"), ("plate.exact", "1.5 = 3/2\n"), ("plate.rs", "fn main() {}\n")]
        {
            let path = folder.0.join(name);
            fs::write(&path, text).unwrap();
            assert!(matches!(attempt(), Err(Failure::Usage(words)) if words.contains(name)), "{name}");
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
            assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 5, "nothing else is written either");
            fs::remove_file(&path).unwrap();
        }
        attempt().unwrap();
        attempt().unwrap();
        fs::write(folder.0.join("plate.exact"), "my notes\n").unwrap();
        assert!(attempt().is_err());
    }

    #[test]
    fn a_mistake_in_any_page_writes_nothing() {
        let (_folder, places) = workspace("pub mod plate;\n");
        fs::write(places[0].models.join("zbad.toml"), PAGE.replace("mass = 0.1", "mass = -1")).unwrap();
        assert!(matches!(outputs(&args(&[], None), &places), Err(Failure::ModelFile(_))));
        assert!(!places[0].module("plate").unwrap().exists());
    }
}
