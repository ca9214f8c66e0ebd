//! What the firmware may take. More is a failure.

use super::firmware::Chip;
use super::output::Count;
use super::tools::Tools;
use super::{Board, proof};
use gyro_cli::failure::Failure;
use gyro_reference::{Sample, tabulated};
use std::fmt::Write as _;

/// One thing that is limited.
pub(crate) struct Line {
    what: &'static str,
    unit: &'static str,
    limit: f64,
    value: f64,
}

/// Steps between two corrections.
const STEPS: f64 = 5.0;

/// All that is limited, as measured.
pub(crate) fn lines(tools: &Tools, boards: &[Board]) -> Result<Vec<Line>, Failure> {
    let [m7, m4] = [Chip::M7, Chip::M4].map(|chip| boards.iter().find(|board| board.chip == chip));
    let missing = || Failure::Run("a figure that is limited was not measured".to_owned());
    let (m7, m4) = (m7.ok_or_else(missing)?, m4.ok_or_else(missing)?);
    let mean = |board: &Board, precision: &str, form: &str, work: &str| {
        let figures = board.ran(&format!("figures-{precision}")).ok_or_else(missing)?;
        let count = figures.output.count(precision, "paper", form, work).ok_or_else(missing)?;
        Ok::<f64, Failure>(f64::from(count.mean))
    };
    let gimbal = m4.ran("stabilised-f32").ok_or_else(missing)?;
    let longest = gimbal.output.count("f32", "stabilised", "joint", "tick").ok_or_else(missing)?.most;
    let control = m7.ran("control-f64").ok_or_else(missing)?;
    let ram = f64::from(control.output.ram.ok_or_else(missing)?);
    let stack = control.stack.as_ref().ok_or_else(missing)?.bytes as f64;
    let straight = m4.ran("control-f32").ok_or_else(missing)?;
    let n_calls = if proof::is_straight(tools, &straight.program)? { 0.0 } else { 1.0 };
    let line = |what, unit, limit, value| Line { what, unit, limit, value };
    Ok(vec![
        line(
            "M7, f64, maximal coordinates: an RK4 step with its share of a correction every fifth",
            "instructions",
            5000.0,
            (mean(m7, "f64", "maximal", "five-steps")? + mean(m7, "f64", "maximal", "correction")?) / STEPS,
        ),
        line(
            "M7, f64, joint coordinates: an RK4 step",
            "instructions",
            1500.0,
            mean(m7, "f64", "joint", "step")?,
        ),
        line(
            "M4F, f32, maximal coordinates: the right-hand side",
            "instructions",
            800.0,
            mean(m4, "f32", "maximal", "corrected-derivative")?,
        ),
        line("M4F, f32: calls in it, to libm or elsewhere", "", 0.0, n_calls),
        line(
            "right-hand sides in maximal coordinates: most less least over a run",
            "instructions",
            0.0,
            spread(boards),
        ),
        line("f64: state and workspace", "bytes", 2048.0, ram),
        line("f64: stack beyond them, bound", "bytes", 3072.0, stack - ram),
        line("f64: text of the whole simulation", "bytes", 24_576.0, control.text()? as f64),
        line("f32: error of α and β after a second at the best step", "µrad", 5.0, 1e6 * best_error(boards)?),
        line(
            "M4F, f32, joint coordinates, stops and friction: the longest tick, ten steps",
            "instructions",
            1_000_000.0,
            f64::from(longest),
        ),
        line("ticks of the control loop that took too long", "", 0.0, overruns(boards)),
        line("sine of the largest lean of the robot on two wheels", "", 0.5, largest_lean(boards)),
    ])
}

/// Fails if anything is over its limit.
pub(crate) fn check(lines: &[Line]) -> Result<(), Failure> {
    let over = lines.iter().filter(|line| line.value > line.limit || line.value.is_nan());
    let words: Vec<String> = over
        .map(|line| format!("{}: {} {}, over {}", line.what, line.value, line.unit, line.limit))
        .collect();
    if words.is_empty() { Ok(()) } else { Err(Failure::Run(words.join("\n"))) }
}

/// The lines, in Markdown.
pub(crate) fn table(lines: &[Line]) -> String {
    let mut text = "| what | measured | limit |\n|---|---|---|\n".to_owned();
    for Line { what, unit, limit, value } in lines {
        let value = if *value == value.trunc() { format!("{value}") } else { format!("{value:.2}") };
        let _ = writeln!(text, "| {what} | {value} {unit} | {limit} {unit} |");
    }
    text
}

/// How much the evaluations in maximal coordinates differ at most, over all runs of all boards: they have no branch.
fn spread(boards: &[Board]) -> f64 {
    let is_evaluation = |count: &&Count| count.form == "maximal" && count.work.ends_with("derivative");
    let counts = boards.iter().flat_map(|board| &board.programs).flat_map(|ran| &ran.output.counts);
    // Not a number if there is none to look at.
    counts.filter(is_evaluation).map(|count| f64::from(count.most - count.least)).fold(f64::NAN, f64::max)
}

fn overruns(boards: &[Board]) -> f64 {
    let overruns = boards.iter().flat_map(|board| &board.programs).filter_map(|ran| ran.output.overruns);
    overruns.map(f64::from).fold(f64::NAN, f64::max)
}

/// That of a robot that has fallen is 1, or no number.
fn largest_lean(boards: &[Board]) -> f64 {
    let runs = boards.iter().flat_map(|board| &board.programs).flat_map(|ran| &ran.output.runs);
    let leans = runs.filter(|run| run.name.starts_with("balancer")).map(|run| run.joint(2));
    leans.reduce(|most, lean| if lean <= most { most } else { lean }).unwrap_or(f64::NAN)
}

/// The paper's α and β after a second.
pub(crate) fn reference() -> Option<(f64, f64)> {
    let scene = tabulated().into_iter().find(|scene| scene.name == "paper")?;
    let sample = scene.samples.iter().map(Sample::rounded).find(|sample| sample.t == 1.0)?;
    Some((sample.alpha, sample.beta))
}

/// The larger error of α and β at the step where it is least, in `f32` and maximal coordinates on the M4F.
fn best_error(boards: &[Board]) -> Result<f64, Failure> {
    let (alpha, beta) =
        reference().ok_or_else(|| Failure::Run("the reference has no paper's second".to_owned()))?;
    let runs =
        boards.iter().filter(|b| b.chip == Chip::M4).flat_map(|b| &b.programs).flat_map(|r| &r.output.runs);
    let error = |run: &super::output::Run| (run.joint(0) - alpha).abs().max((run.joint(1) - beta).abs());
    Ok(runs
        .filter(|run| run.name.starts_with("paper") && run.name.contains("maximal"))
        .map(error)
        .fold(f64::NAN, f64::min))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(value: f64) -> [Line; 1] {
        [Line { what: "a step", unit: "instructions", limit: 1500.0, value }]
    }

    #[test]
    fn what_is_over_its_limit_or_was_not_measured_fails() {
        assert!(check(&line(1500.0)).is_ok());
        assert!(matches!(check(&line(1500.5)), Err(Failure::Run(words)) if words.contains("over 1500")));
        assert!(check(&line(f64::NAN)).is_err());
        assert!(spread(&[]).is_nan() && overruns(&[]).is_nan());
        assert!(table(&line(550.0)).ends_with("| a step | 550 instructions | 1500 instructions |\n"));
    }

    #[test]
    fn the_reference_has_the_papers_second() {
        let (alpha, beta) = reference().unwrap();
        assert!((alpha - 0.1).abs() < 1e-3 && beta.abs() < 1e-4);
    }
}
