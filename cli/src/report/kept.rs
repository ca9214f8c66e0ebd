//! What is kept of a whole report in the repository: the index, and the pages of a few scenes with their figures.

use super::index;
use super::write::own;
use crate::failure::Failure;
use crate::programs::io_failure;
use std::fs;
use std::path::Path;

/// The paper's scene, three extreme ones, and four loops.
const KEPT: [&str; 8] = [
    "gyroscope",
    "gyroscope-gimbal-lock",
    "gyroscope-light-rings",
    "gyroscope-stiff",
    "double-wishbone",
    "four-bar",
    "gyroscope-four-bar",
    "slider-crank",
];

/// Brings the folder of what is kept up to date with a report; pages that were not written anew stay as they are.
pub(crate) fn keep(report: &Path, kept: &Path, machine: &str) -> Result<(), Failure> {
    let copy = |file: &str| {
        let from = report.join(file);
        let text = fs::read_to_string(&from).map_err(|e| io_failure(&from, &e))?;
        own(&kept.join(file), &text)?;
        Ok(text)
    };
    for name in KEPT.into_iter().filter(|name| report.join(format!("{name}.md")).exists()) {
        let page: String = copy(&format!("{name}.md"))?;
        for file in figures(&page) {
            copy(file)?;
        }
    }
    own(&kept.join("index.md"), &index::kept(report, machine, &KEPT))?;
    Ok(())
}

/// The figures that a page shows.
fn figures(page: &str) -> impl Iterator<Item = &str> {
    page.split("](").skip(1).filter_map(|rest| rest.split(')').next()).filter(|file| file.ends_with(".svg"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::tests::Folder;

    #[test]
    fn pages_are_kept_with_their_figures_and_no_others() {
        let (report, kept) = (Folder::new(), Folder::new());
        for folder in [&report, &kept] {
            fs::create_dir_all(folder.0.join("images")).unwrap();
        }
        for name in KEPT.iter().chain(&["torsion"]) {
            let page = format!("# {name}\n\n![Drift](images/{name}-drift.svg)\n\n[the index](index.md)\n");
            fs::write(report.0.join(format!("{name}.md")), page).unwrap();
            fs::write(report.0.join(format!("images/{name}-drift.svg")), "<svg/>").unwrap();
            fs::write(report.0.join(format!("{name}.csv")), "1\n").unwrap();
        }
        keep(&report.0, &kept.0, "a machine").unwrap();
        for name in KEPT {
            assert!(kept.0.join(format!("{name}.md")).exists());
            assert!(kept.0.join(format!("images/{name}-drift.svg")).exists());
        }
        let n_files = |folder: &Path, extension: &str| {
            let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
            paths.filter(|path| path.extension().is_some_and(|found| found == extension)).count()
        };
        let images = kept.0.join("images");
        assert_eq!((n_files(&kept.0, "md"), n_files(&images, "svg")), (KEPT.len() + 1, KEPT.len()));
        assert_eq!((n_files(&kept.0, "csv"), n_files(&kept.0, "html")), (0, 0));
    }
}
