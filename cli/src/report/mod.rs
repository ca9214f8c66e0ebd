//! `cargo xtask report`: error against run time, drift and stability of scenes, as pages, figures and raw data.
//!
//! ```text
//! model file ─lab─▶ programs ─explore, drift, stability─▶ points, long runs, maps ─best, order, goals─▶ tables
//!    ─figures, chart─▶ SVG ─page─▶ NAME.md, NAME.html ─data─▶ CSV ─index─▶ index.md, index.html
//!    ─index─▶ docs/report/index.md, if all scenes were measured
//! ```

mod best;
mod chart;
mod curve;
mod data;
mod drift;
#[cfg(feature = "jit")]
mod engines;
mod explore;
mod figures;
mod goals;
mod index;
mod lab;
mod limits;
mod order;
mod page;
mod smooth;
mod stability;
mod stiff;
mod study;
mod truth;
mod write;

use crate::args::ReportArgs;
use crate::failure::Failure;
use crate::places::no_model_file;
use crate::progress::Count;
use crate::write::unwritable;
use crate::{files, nested, scene};
use goals::Goal;
use std::path::{Path, PathBuf};
use std::{fs, io};
use study::{Effort, Study};

/// Measures scenes and writes their pages and the index.
pub(crate) fn report(args: &ReportArgs) -> Result<(), Failure> {
    let pages = pages(args)?;
    // A mistake in the last of them is better known before anything is compiled.
    let names =
        pages.iter().map(|path| Ok(scene::read(path)?.name)).collect::<Result<Vec<String>, Failure>>()?;
    let root = files::workspace().unwrap_or(Path::new(""));
    // A quick look does not replace what was measured with care.
    let own = root.join(if args.quick { "target" } else { "out" }).join("report");
    let folder = args.out.clone().unwrap_or(own);
    fs::create_dir_all(folder.join("images")).map_err(|e| unusable(&folder, &e))?;
    names.iter().try_for_each(|name| write::check(name, &folder))?;
    let assembled = nested::assembled()?;
    let machine = crate::machine::machine_in("release")?;
    let effort = if args.quick { Effort::QUICK } else { Effort::FULL };
    let mut missed = Vec::new();
    for (index, path) in pages.iter().enumerate() {
        let mut progress = Count::new(format!("{} of {}", index + 1, pages.len()));
        let study = Study::new(path, &assembled, &effort, &mut progress)?;
        write::study(&study, &machine, &folder)?;
        index::add(&study, &machine, &folder)?;
        missed.extend(study.goals.into_iter().filter(|goal| !goal.is_met()));
        eprintln!("wrote {}", folder.join(format!("{}.md", study.lab.name)).display());
    }
    // The index is kept, if all scenes stand in it.
    let shipped = files::workspace().map(|root| shipped(&root.join("models"))).transpose()?;
    let is_whole = shipped.is_some_and(|shipped| index::has_all(&folder, &shipped));
    if is_whole && args.out.is_none() && !args.quick {
        let index = root.join("docs").join("report").join("index.md");
        write::own(&index, &index::kept(&folder, &machine))?;
        eprintln!("wrote {}, which is kept", index.display());
    }
    judge(&missed, args.quick)
}

/// Says which goals were missed. A quick look fails with them, but for those of time, which a busy machine can miss.
fn judge(missed: &[Goal], is_quick: bool) -> Result<(), Failure> {
    let named = |goals: &mut dyn Iterator<Item = &Goal>| {
        goals.map(|goal| format!("not met: {}", goal.row().join("; "))).collect::<Vec<_>>().join("\n")
    };
    let grave = named(&mut missed.iter().filter(|goal| is_quick && !goal.is_time));
    let all = named(&mut missed.iter());
    match (all.is_empty(), grave.is_empty()) {
        (true, _) => Ok(()),
        (false, true) => {
            eprintln!("{all}");
            Ok(())
        }
        (false, false) => Err(Failure::Run(grave)),
    }
}

/// The model files to report on: those given; of all shipped ones; in quick mode the paper's scene.
fn pages(args: &ReportArgs) -> Result<Vec<PathBuf>, Failure> {
    if !args.models.is_empty() {
        return Ok(args.models.clone());
    }
    let models = files::workspace().ok_or_else(no_model_file)?.join("models");
    match args.quick {
        true => Ok(vec![models.join("gyroscope.toml")]),
        false => shipped(&models),
    }
}

/// The shipped model files.
fn shipped(models: &Path) -> Result<Vec<PathBuf>, Failure> {
    let entries = fs::read_dir(models).map_err(|e| unusable(models, &e))?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path()));
    let mut paths = paths.collect::<Result<Vec<_>, _>>().map_err(|e| unusable(models, &e))?;
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    Ok(paths)
}

fn unusable(path: &Path, error: &io::Error) -> Failure {
    unwritable(path, "used", error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use goals::Limit;

    #[test]
    fn a_quick_look_fails_with_goals_that_no_busy_machine_can_miss() {
        let goal = |is_time| Goal {
            what: "error".to_owned(),
            limit: Limit::AtMost(1.0),
            reached: Some(2.0),
            by: String::new(),
            is_time,
        };
        assert!(judge(&[goal(false)], false).is_ok() && judge(&[goal(true)], true).is_ok());
        let Err(Failure::Run(words)) = judge(&[goal(true), goal(false)], true) else { panic!("it passes") };
        assert_eq!(words, "not met: error; ≤ 1; 2; ; not met");
    }
}
