//! `cargo xtask performance`: measures generated code, the floor and the runtime-assembled models, and writes the
//! tables of docs/performance.md.

use crate::args::PerformanceArgs;
use crate::lanes;
use crate::scaling;
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::programs::{built, folder, io_failure, output, three};
use gyro_cli::progress::Spinner;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

/// Calls of a kernel that `--count` makes: see benches/performance.rs.
const CALLS: u64 = 100;

/// Measures and writes the page.
pub(crate) fn performance(args: &PerformanceArgs) -> Result<(), Failure> {
    let path = args.out.clone().unwrap_or_else(|| files::root().join("docs").join("performance.md"));
    let page = files::read_template(&path)?;
    fs::create_dir_all(folder()).map_err(|e| io_failure(&folder(), &e))?;
    let page = match args {
        PerformanceArgs { only_lanes: true, .. } => with_lanes(&page)?,
        PerformanceArgs { only_chains: true, .. } => with_chains(&page, args)?,
        _ => with_lanes(&without_lanes(page, args)?)?,
    };
    let is_new = files::write(&path, &page)?;
    eprintln!("{} {}", if is_new { "wrote" } else { "nothing new in" }, path.display());
    Ok(())
}

/// Everything that is compiled without special flags.
fn without_lanes(mut page: String, args: &PerformanceArgs) -> Result<String, Failure> {
    let program = built("performance", |_| ())?;
    let rows = measure(&program)?;
    let counts = count(&program)?;
    let (kernels, runs): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row.what != SECOND);
    page = replaced(&page, "machine", &machine()?)?;
    page = replaced(&page, "kernels", &kernel_table(&kernels, counts.as_deref()))?;
    page = replaced(&page, "runs", &run_table(&runs))?;
    if args.bodies > 0 {
        page = with_chains(&page, args)?;
    }
    Ok(page)
}

fn with_lanes(page: &str) -> Result<String, Failure> {
    replaced(page, "lanes", &lanes::table()?)
}

fn with_chains(page: &str, args: &PerformanceArgs) -> Result<String, Failure> {
    let [times, costs] = scaling::tables(args.bodies)?;
    replaced(&replaced(page, "chains", &times)?, "scaling", &costs)
}

/// As benches/src/kernels.rs names whole runs.
const SECOND: &str = "the paper's second";

/// A line of benches/performance.rs.
struct Row {
    what: String,
    side: String,
    flops: String,
    ns: f64,
    ratio: f64,
}

fn measure(program: &Path) -> Result<Vec<Row>, Failure> {
    let _spinner = Spinner::new("measuring kernels and runs in turns".to_owned());
    rows(&output(&mut Command::new(program))?)
}

fn rows(text: &str) -> Result<Vec<Row>, Failure> {
    let row = |line: &str| {
        let [what, side, flops, ns, ratio] = line.split('\t').collect::<Vec<_>>().try_into().ok()?;
        let [ns, ratio] = [ns, ratio].map(str::parse);
        Some(Row {
            what: what.into(),
            side: side.into(),
            flops: flops.into(),
            ns: ns.ok()?,
            ratio: ratio.ok()?,
        })
    };
    let bad = |line: &str| Failure::Run(format!("the bench printed what this command does not know: {line}"));
    text.lines().map(|line| row(line).ok_or_else(|| bad(line))).collect()
}

/// Instructions of one call of each kernel, in the order of the rows; none without valgrind.
fn count(program: &Path) -> Result<Option<Vec<f64>>, Failure> {
    if Command::new("valgrind").arg("--version").stdout(Stdio::null()).status().is_err() {
        return Ok(None);
    }
    let _spinner = Spinner::new("counting instructions".to_owned());
    let dumps = folder().join("callgrind");
    // Those of an earlier run must not be taken for this one's.
    let _ = fs::remove_dir_all(&dumps);
    fs::create_dir_all(&dumps).map_err(|e| io_failure(&dumps, &e))?;
    let mut command = Command::new("valgrind");
    command
        .arg("--tool=callgrind")
        .arg("--toggle-collect=gyro_benches::round::counted")
        .arg("--dump-after=gyro_benches::round::counted");
    command.arg(format!("--callgrind-out-file={}", dumps.join("out").display())).arg(program).arg("--count");
    output(&mut command)?;
    let dump = |index: usize| fs::read_to_string(dumps.join(format!("out.{index}"))).ok();
    Ok(Some((1..).map_while(dump).filter_map(|text| total(&text)).map(|n| n as f64 / CALLS as f64).collect()))
}

/// The instructions of one of callgrind's dumps.
fn total(dump: &str) -> Option<u64> {
    let line = dump.lines().find_map(|line| line.strip_prefix("totals: "))?;
    line.split_whitespace().next()?.parse().ok()
}

fn kernel_table(rows: &[&Row], counts: Option<&[f64]>) -> String {
    let counts = counts.filter(|counts| counts.len() == rows.len());
    let mut text =
        "| kernel | | flops | instructions | ns | ÷ floor |\n|---|---|---|---|---|---|\n".to_owned();
    let mut last = "";
    for (index, row) in rows.iter().enumerate() {
        let Row { what, side, flops, ns, ratio } = row;
        let what = if what == last { "" } else { what };
        let instructions = counts.map_or(String::new(), |counts| format!("{:.0}", counts[index]));
        let _ = writeln!(
            text,
            "| {what} | {side} | {flops} | {instructions} | {} | {} |",
            three(*ns),
            three(*ratio)
        );
        last = &row.what;
    }
    if counts.is_none() {
        text += "\nInstructions are counted where valgrind is installed; here they were not.\n";
    }
    text
}

fn run_table(rows: &[&Row]) -> String {
    let mut text = "| the paper's second | ms | ÷ floor |\n|---|---|---|\n".to_owned();
    for Row { side, ns, ratio, .. } in rows {
        let _ = writeln!(text, "| {side} | {} | {} |", three(ns / 1e6), three(*ratio));
    }
    text
}

/// What the figures depend on besides the code.
fn machine() -> Result<String, Failure> {
    let flags = std::env::var("RUSTFLAGS").unwrap_or_default();
    let flags = if flags.is_empty() { "no further flags".to_owned() } else { format!("flags `{flags}`") };
    Ok(format!(
        "{}; profile `bench` (optimised, thin LTO, one codegen unit), {flags}.\n",
        gyro_cli::machine::hardware()?
    ))
}

/// The page with what stands between the marks of this name replaced.
pub(crate) fn replaced(page: &str, name: &str, text: &str) -> Result<String, Failure> {
    let (begin, end) = (format!("<!-- begin {name} -->\n"), format!("<!-- end {name} -->"));
    let missing = |mark: &str| Failure::Usage(format!("the document has no line `{}`", mark.trim()));
    let (before, rest) = page.split_once(&begin).ok_or_else(|| missing(&begin))?;
    let (_, after) = rest.split_once(&end).ok_or_else(|| missing(&end))?;
    Ok(format!("{before}{begin}{text}{end}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_between_the_marks_is_replaced() {
        let page = "a\n<!-- begin x -->\nold\n<!-- end x -->\nb\n";
        assert_eq!(replaced(page, "x", "new\n").unwrap(), "a\n<!-- begin x -->\nnew\n<!-- end x -->\nb\n");
        assert!(replaced(page, "y", "new\n").is_err());
    }

    #[test]
    fn rows_are_read_whole_or_not_at_all() {
        let read = rows("phi\tassembled, careful\t\t12.5\t2.0\n").unwrap();
        assert_eq!((read[0].what.as_str(), read[0].flops.as_str(), read[0].ns), ("phi", "", 12.5));
        assert!(rows("phi\tassembled, careful\t12.5\n").is_err());
        assert_eq!(total("events: Ir\ntotals: 4200\n"), Some(4200));
        assert_eq!(total("nothing"), None);
    }

    #[test]
    fn figures_have_three_digits() {
        assert_eq!([1.234_5, 12.345, 123.45, 12345.6].map(three), ["1.23", "12.3", "123", "12346"]);
    }
}
