//! The page of a scene.

use super::best::{TARGETS, best, reasons, smallest_error};
use super::curve::{Point, Treatment, who};
use super::data;
#[cfg(feature = "jit")]
use super::engines;
use super::figures::{self, Work};
use super::goals;
use super::order::WINDOW;
use super::page::Page;
use super::smooth::{self, Beside};
use super::study::Study;
use crate::args::Precision;
use crate::failure::Failure;
use crate::report::curve::Engine;
use crate::words::{count, number};
use crate::write::{self, Known};
use crate::{files, remarks, show};
use gyro_runner::Integrator;
use std::fs;
use std::path::Path;

/// Writes the page in both forms, its figures and its data.
pub(crate) fn study(study: &Study, machine: &str, folder: &Path) -> Result<(), Failure> {
    let name = &study.lab.name;
    let page = page(study, machine, moving(study, folder)?.as_deref());
    for (file, svg) in page.figures() {
        own(&folder.join("images").join(file), svg)?;
    }
    let t_end = study.lab.t_end;
    let knob = study.knob.label(&study.lab.model);
    for (file, text) in [
        (format!("{name}.md"), page.markdown()),
        (format!("{name}.html"), page.html(name)),
        (format!("{name}.csv"), data::runs(&study.points, &study.truth, t_end)),
        (format!("{name}-drift.csv"), data::drifts(&study.drifts)),
        (format!("{name}-stability.csv"), data::trials(&study.maps, &knob)),
    ] {
        own(&folder.join(file), &text)?;
    }
    if let Some(smooth) = &study.smooth {
        own(&folder.join(format!("{name}-smooth.csv")), &smooth::data(smooth))?;
    }
    Ok(())
}

/// Writes the page in which the mechanism moves, and returns its name; a run that fails leaves it out.
fn moving(study: &Study, folder: &Path) -> Result<Option<String>, Failure> {
    let file = format!("{}-moving.html", study.lab.name);
    match show::beside(&study.lab.path, &folder.join(&file)) {
        Ok(()) => Ok(Some(file)),
        Err(failure @ Failure::Interrupted(_)) => Err(failure),
        Err(failure) => {
            remarks::warn(&format!("{file} is left out: {}", failure.words()));
            Ok(None)
        }
    }
}

/// What the report of a scene, and the index, are written to; none may be a file that somebody else has written.
pub(crate) fn check(name: &str, folder: &Path) -> Result<(), Failure> {
    let own = [".md", ".html", ".csv", "-drift.csv", "-stability.csv", "-smooth.csv"]
        .map(|end| format!("{name}{end}"));
    let index = ["index.md", "index.html", "index.csv", "goals.csv"].map(str::to_owned);
    own.iter().chain(&index).try_for_each(|file| {
        let path = folder.join(file);
        write::check(&path, known(&path))
    })
}

/// Writes one of a report's files.
pub(crate) fn own(path: &Path, text: &str) -> Result<bool, Failure> {
    write::write(path, text, known(path))
}

/// The documentation of the workspace and what is built are the tool's own; other folders are the user's.
fn known(path: &Path) -> Known {
    let inside = |folder: &str| {
        let own = files::workspace().map(|root| fs::canonicalize(root.join(folder)));
        let found = path.parent().map(fs::canonicalize);
        matches!((own, found), (Some(Ok(own)), Some(Ok(found))) if found.starts_with(&own))
    };
    if inside("docs/report") || inside("out/report") || inside("target") {
        Known::Place
    } else {
        Known::Record
    }
}

fn page(study: &Study, machine: &str, moving: Option<&str>) -> Page {
    let mut page = Page::default();
    let name = &study.lab.name;
    page.heading(1, name.clone());
    if let Some(moving) = moving {
        page.frame(moving, format!("{name} as it moves, on a page of its own"));
    }
    lead(study, machine, &mut page);
    choices(study, &mut page);
    if !study.goals.is_empty() {
        page.heading(2, "Goals");
        page.table(&goals::HEAD, study.goals.iter().map(goals::Goal::row).collect());
    }
    work_precision(study, &mut page);
    convergence(study, &mut page);
    #[cfg(feature = "jit")]
    engines::write(&study.engines, &mut page);
    if let Some(smooth) = &study.smooth {
        let beside = Beside {
            name: &study.lab.name,
            t_end: study.lab.t_end,
            is_relative: study.is_relative(),
            points: &study.points,
        };
        smooth::write(smooth, &beside, &mut page);
    }
    drift(study, &mut page);
    stability(study, &mut page);
    failures(study, &mut page);
    page
}

fn lead(study: &Study, machine: &str, page: &mut Page) {
    let Study { lab, truth, points, took, .. } = study;
    let name = &lab.name;
    page.text(format!(
        "`{}` over {} s. Errors are counted from {}. The error of a run is {}.",
        files::shown(&lab.path),
        number(lab.t_end, 4),
        truth.source,
        truth.measure()
    ));
    let depth = if study.is_full { "" } else { " This is a quick look: few points and short runs." };
    page.text(format!(
        "{}, measured in {} s on {machine}. Times are what the processor spends on steps and corrections alone, medians of runs made in \
         turns with the hand-derived second (the paper's scene in minimal coordinates by RK4, 10 000 steps), whose median time they are \
         multiples of: a ratio of 1 is as long as that. Where coordinates are maximal and corrected, it is after every step.{depth} All runs are in `{name}.csv`, which \
         `cargo xtask report` writes; all scenes in [the index](index.md).",
        count(points.len() as u64, "run"),
        number(*took, 3)
    ));
}

/// A column of the table of choices.
type Choice = (&'static str, fn(&Point) -> bool);

pub(crate) const CHOICES: [Choice; 4] = [
    ("joint coordinates", |p| is_ours(p, Precision::F64) && p.curve.treatment == Treatment::Joint),
    ("maximal, corrected", |p| is_ours(p, Precision::F64) && p.curve.treatment.is_corrected()),
    ("f32", |p| is_ours(p, Precision::F32)),
    ("best assembled", |p| p.curve.engine != Engine::Generated),
];

fn is_ours(point: &Point, precision: Precision) -> bool {
    point.curve.engine == Engine::Generated && point.curve.precision == precision
}

fn choices(study: &Study, page: &mut Page) {
    page.heading(2, "What to choose");
    let cell = |target: f64, belongs: fn(&Point) -> bool| {
        let chosen = best(study.points.iter().filter(|point| belongs(point)), target);
        match chosen.and_then(|point| Some((point, point.outcome.as_ref().ok()?))) {
            None => "not reached".to_owned(),
            Some((point, outcome)) => {
                let form = match point.curve.engine {
                    Engine::Generated => String::new(),
                    engine => format!("{}, ", who(engine)),
                };
                let treatment = point.curve.treatment.name();
                let treatment = treatment.strip_prefix("maximal, ").unwrap_or(&treatment);
                format!(
                    "**{} ms** ({}): {form}{}, {treatment}, {}",
                    number(1e3 * outcome.seconds, 3),
                    number(outcome.ratio, 3),
                    point.curve.integrator,
                    point.setting.name(study.lab.t_end)
                )
            }
        }
    };
    let rows = TARGETS.iter().map(|&target| {
        let mut row = vec![format!("{target:e}")];
        row.extend(CHOICES.iter().map(|(_, belongs)| cell(target, *belongs)));
        row
    });
    let mut head = vec!["error at most"];
    head.extend(CHOICES.iter().map(|(name, _)| *name));
    page.table(&head, rows.collect());
    page.text(
        "CPU time, in brackets over the hand-derived second; then what takes it. Not reached: not by runs of up to a few times the cheapest \
         good one; longer ones are not made.",
    );
    let single = |is_joint: bool| {
        let ours = study.points.iter().filter(|p| {
            is_ours(p, Precision::F32)
                && if is_joint {
                    p.curve.treatment == Treatment::Joint
                } else {
                    p.curve.treatment.is_corrected()
                }
        });
        smallest_error(ours).map_or("nothing".to_owned(), |error| number(error, 2))
    };
    let joint = if study.lab.has_joint_coordinates() {
        format!("{} in joint coordinates and ", single(true))
    } else {
        String::new()
    };
    page.text(format!("The smallest error in `f32` is {joint}{} in corrected maximal ones.", single(false)));
}

fn figure(study: &Study, kind: &str, caption: &str, chart: &super::chart::Chart, page: &mut Page) {
    page.figure(format!("{}-{kind}.svg", study.lab.name), caption, chart.svg());
}

fn work_precision(study: &Study, page: &mut Page) {
    let (name, is_relative) = (&study.lab.name, study.is_relative());
    page.heading(2, "Error against run time");
    let overview = figures::overview(&study.points, name, is_relative);
    figure(
        study,
        "overview",
        "The best of each way of computing: further down is more accurate, further left quicker",
        &overview,
        page,
    );
    for (kind, precision, work, caption) in [
        ("time", Precision::F64, Work::Time, "Error against CPU time in f64"),
        ("evaluations", Precision::F64, Work::Evaluations, "Error against evaluations in f64"),
        ("time-f32", Precision::F32, Work::Time, "Error against CPU time in f32"),
    ] {
        let chart = figures::work_precision(&study.points, (precision, work), name, is_relative);
        figure(study, kind, caption, &chart, page);
    }
}

fn convergence(study: &Study, page: &mut Page) {
    page.heading(2, "Order of convergence");
    let chart = figures::convergence(&study.points, &study.lab.name, study.lab.t_end, study.is_relative());
    figure(study, "order", "Error against the fixed step in f64", &chart, page);
    let mut treatments: Vec<Treatment> = Vec::new();
    for (_, treatment, _) in &study.orders {
        if !treatments.contains(treatment) {
            treatments.push(*treatment);
        }
    }
    let cell = |treatment: Treatment, integrator: Integrator| {
        let order = study
            .orders
            .iter()
            .find(|(i, t, _)| *i == integrator && *t == treatment)
            .and_then(|(.., order)| *order);
        order.map_or("-".to_owned(), |order| format!("{:.2} ({})", order.order, order.n_points))
    };
    let rows = treatments.iter().map(|&treatment| {
        let mut row = vec![treatment.name()];
        row.extend(Integrator::ALL.iter().map(|&integrator| cell(treatment, integrator)));
        row
    });
    let mut head = vec![""];
    head.extend(Integrator::ALL.iter().map(|integrator| integrator.name()));
    page.table(&head, rows.collect());
    page.text(format!(
        "Fitted where the error lies between {:e} and {:e}, in brackets from how many runs; - with fewer than three.",
        WINDOW.0, WINDOW.1
    ));
}

fn drift(study: &Study, page: &mut Page) {
    let settings = &study.lab.model.simulation;
    page.heading(2, "Drift");
    page.text(format!(
        "{} s by RK4 at the model file's own step of {} s, corrected every {} s. Data: `{name}-drift.csv`.",
        number(study.long, 4),
        number(settings.step, 4),
        number(settings.correct_every, 4),
        name = study.lab.name
    ));
    let chart = figures::drift(&study.drifts, &study.lab.name);
    figure(study, "drift", "Constraints and energy over a long time", &chart, page);
    let worst = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    let mut head = vec![
        "treatment".to_owned(),
        "worst constraint".into(),
        "worst energy error".into(),
        "CPU time [s]".into(),
    ];
    let has_errors =
        study.drifts.iter().any(|d| d.outcome.as_ref().is_ok_and(|course| course.errors.is_some()));
    if has_errors {
        head.extend(study.truth.names.iter().map(|name| format!("error of {name} at the end")));
    }
    let row = |drift: &super::drift::Drift| {
        let mut row = vec![drift.treatment.name()];
        match &drift.outcome {
            Ok(course) => {
                row.extend(
                    [worst(&course.violations), worst(&course.energy), course.seconds]
                        .map(|value| number(value, 2)),
                );
                row.extend(course.errors.iter().flatten().map(|error| number(*error, 2)));
            }
            Err(words) => {
                row.push(words.clone());
                row.resize(head.len(), String::new());
            }
        }
        row
    };
    let rows = study.drifts.iter().map(row).collect();
    page.table(&head.iter().map(String::as_str).collect::<Vec<_>>(), rows);
    if !has_errors {
        page.text("Errors over so long a time are not known here.");
    }
}

fn stability(study: &Study, page: &mut Page) {
    page.heading(2, "Stable steps");
    if study.lab.touches() {
        page.text(
            "Not looked for: of motions from event to event a limit would be that of each phase between them.",
        );
        return;
    }
    let knob = study.knob.label(&study.lab.model);
    page.text(format!(
        "Fixed steps that keep a run of 4000 steps bounded, over the {knob}. The limit in theory is where |R(hλ)| = 1 at the fastest eigenvalue λ \
         about the start, R being the method's own amplification: it holds for motions near the start, and where steps are too long to follow the scene \
         something else ends a run before. Rodas4 is L-stable and has no limit. Data: \
         `{name}-stability.csv`.",
        name = study.lab.name
    ));
    let chart = figures::stability(&study.maps, &study.lab.name, &knob);
    figure(study, "stability", "Stable and unstable steps with the limit in theory", &chart, page);
    let nominal = study.knob.nominal();
    let rows = study.maps.iter().filter_map(|map| {
        let column = map.columns.iter().find(|column| (column.value / nominal - 1.0).abs() < 1e-9)?;
        let seconds = |limit: Option<f64>| limit.map_or("-".to_owned(), |limit| number(limit, 4));
        let apart = match (column.theory, column.found.limit) {
            (Some(theory), Some(found)) => format!("{:+.1} %", 100.0 * (found / theory - 1.0)),
            _ => String::new(),
        };
        Some(vec![map.integrator.to_string(), seconds(column.theory), seconds(column.found.limit), apart])
    });
    page.table(
        &["at the model file's own value", "limit in theory [s]", "limit found [s]", "apart"],
        rows.collect(),
    );
    for trouble in &study.troubles {
        page.text(format!("Not known {trouble}."));
    }
}

fn failures(study: &Study, page: &mut Page) {
    page.heading(2, "Runs that failed");
    let mut ways: Vec<_> = Vec::new();
    for curve in study.points.iter().map(|point| point.curve) {
        if !ways.iter().any(|way| curve.is_like(way)) {
            ways.push(curve);
        }
    }
    let mut rows = Vec::new();
    for way in &ways {
        let failed = || study.points.iter().filter(|p| p.curve.is_like(way) && p.outcome.is_err());
        let Some((_, words)) = reasons(failed()).into_iter().next() else { continue };
        let by = |integrator: &Integrator| {
            let n = failed().filter(|point| point.curve.integrator == *integrator).count();
            (n > 0).then(|| format!("{integrator} {n}"))
        };
        let by: Vec<String> = Integrator::ALL.iter().filter_map(by).collect();
        // What to do about it is advice for a single run.
        let words = words.split("; try").next().unwrap_or(&words);
        let words = words.split("; the mechanism is").next().unwrap_or(words).to_owned();
        let name = format!("{}, {}, {}", who(way.engine), way.precision.name(), way.treatment.name());
        rows.push(vec![name, by.join(", "), words]);
    }
    if rows.is_empty() {
        page.text("None.");
        return;
    }
    page.text(
        "Most are fixed steps too long for the scene. Every one is a row of the CSV file with its reason.",
    );
    page.table(&["way of computing", "failed runs by integrator", "the most frequent reason"], rows);
}
