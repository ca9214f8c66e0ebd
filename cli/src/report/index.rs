//! The index: a line for each scene, and all goals. It is kept as two tables of data, so that a report on one scene
//! leaves the lines of others as they are.

use super::best::{best, smallest_error};
use super::curve::Point;
use super::data::table;
use super::goals;
use super::page::Page;
use super::study::Study;
use super::write::{CHOICES, own};
use crate::args::Precision;
use crate::failure::Failure;
use crate::report::curve::Engine;
use crate::words::number;
use std::path::{Path, PathBuf};

const HEAD: [&str; 9] = [
    "scene",
    "1e-6, joint",
    "1e-6, maximal",
    "1e-10, joint",
    "1e-10, maximal",
    "assembled over generated at 1e-6",
    "smallest error in f32",
    "runs",
    "failed",
];

/// Puts a scene into the index.
pub(crate) fn add(study: &Study, machine: &str, folder: &Path) -> Result<(), Failure> {
    let scenes = merged(&folder.join("index.csv"), &HEAD, &study.lab.name, vec![row(study)])?;
    let mut head = vec!["scene"];
    head.extend(&goals::HEAD[..4]);
    head.push("verdict");
    let with_name = |goal: &goals::Goal| {
        let mut row = vec![study.lab.name.clone()];
        row.extend(goal.row());
        row
    };
    let goals = merged(
        &folder.join("goals.csv"),
        &head,
        &study.lab.name,
        study.goals.iter().map(with_name).collect(),
    )?;
    let page = page(scenes, goals, machine, false);
    own(&folder.join("index.md"), &page.markdown())?;
    own(&folder.join("index.html"), &page.html("gyro-sim: error against run time"))?;
    Ok(())
}

/// The index of a whole report for a folder that has no pages of scenes.
pub(crate) fn kept(folder: &Path, machine: &str) -> String {
    let [scenes, goals] = ["index.csv", "goals.csv"].map(|file| rows(&folder.join(file)));
    page(scenes, goals, machine, true).markdown()
}

/// Whether the index of a folder has a line for each of these model files.
pub(crate) fn has_all(folder: &Path, models: &[PathBuf]) -> bool {
    let rows = rows(&folder.join("index.csv"));
    let stems = models.iter().filter_map(|path| path.file_stem());
    stems.into_iter().all(|stem| rows.iter().any(|row| row.first().is_some_and(|scene| *stem == **scene)))
}

/// The rows of a table; none if there is no such file.
fn rows(path: &Path) -> Vec<Vec<String>> {
    match csv::Reader::from_path(path) {
        Ok(mut reader) => {
            let rows = reader.records().filter_map(Result::ok);
            rows.map(|row| row.iter().map(str::to_owned).collect()).collect()
        }
        Err(_) => Vec::new(),
    }
}

/// The rows of a table with those of a scene replaced, in the order of names; the file is written anew.
fn merged(
    path: &Path,
    head: &[&str],
    scene: &str,
    new: Vec<Vec<String>>,
) -> Result<Vec<Vec<String>>, Failure> {
    let mut rows = rows(path);
    // What another version has written is not understood any more.
    rows.retain(|row| row.len() == head.len() && row.first().is_some_and(|name| name != scene));
    rows.extend(new);
    rows.sort_by(|a, b| a[0].cmp(&b[0]));
    let head: Vec<String> = head.iter().map(|s| (*s).to_owned()).collect();
    own(path, &table(&head, rows.iter().cloned()))?;
    Ok(rows)
}

fn row(study: &Study) -> Vec<String> {
    let ratio = |target: f64, belongs: fn(&Point) -> bool| {
        let chosen = best(study.points.iter().filter(|point| belongs(point)), target)?;
        chosen.outcome.as_ref().ok().map(|outcome| outcome.ratio)
    };
    let cell = |value: Option<f64>| value.map_or("-".to_owned(), |value| number(value, 3));
    let ours =
        |point: &Point| point.curve.engine == Engine::Generated && point.curve.precision == Precision::F64;
    let assembled = match (ratio(1e-6, CHOICES[3].1), ratio(1e-6, ours)) {
        (Some(assembled), Some(ours)) => Some(assembled / ours),
        _ => None,
    };
    let single = smallest_error(study.points.iter().filter(|point| point.curve.precision == Precision::F32));
    let failed = study.points.iter().filter(|point| point.outcome.is_err()).count();
    vec![
        study.lab.name.clone(),
        cell(ratio(1e-6, CHOICES[0].1)),
        cell(ratio(1e-6, CHOICES[1].1)),
        cell(ratio(1e-10, CHOICES[0].1)),
        cell(ratio(1e-10, CHOICES[1].1)),
        cell(assembled),
        cell(single),
        study.points.len().to_string(),
        failed.to_string(),
    ]
}

/// The page; the pages of the scenes are beside it unless it is alone.
fn page(scenes: Vec<Vec<String>>, goals: Vec<Vec<String>>, machine: &str, is_alone: bool) -> Page {
    let mut page = Page::default();
    page.heading(1, "Error against run time");
    page.text(format!(
        "One page for each scene, written by `cargo xtask report` and measured on {machine}. Costs are CPU time over that of the \
         hand-derived second (the paper's scene in minimal coordinates by RK4, 10 000 steps) in the same process; errors are counted from \
         reference solutions of their own."
    ));
    if is_alone {
        page.text(
            "`cargo xtask report` writes a page for each scene, with figures, as Markdown and as one HTML file, and the raw data \
             to `out/report`; `cargo xtask report models/torsion.toml` those of one, whose line here is then new.",
        );
    }
    let linked = |mut row: Vec<String>| {
        if !is_alone {
            row[0] = format!("[{0}]({0}.md)", row[0]);
        }
        row
    };
    page.heading(2, "Scenes");
    page.text("What the cheapest generated run costs whose error is at most 1e-6 and 1e-10; - where none has so small an error.");
    page.table(&HEAD, scenes.into_iter().map(linked).collect());
    if !goals.is_empty() {
        page.heading(2, "Goals");
        let mut head = vec!["scene"];
        head.extend(goals::HEAD);
        page.table(&head, goals.into_iter().map(linked).collect());
    }
    page
}

#[cfg(test)]
mod tests;
