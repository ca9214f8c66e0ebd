//! `cargo xtask embedded`: generates its mechanisms, builds the firmware, runs it under QEMU, compares it with the
//! host, and writes the tables of docs/embedded.md.

mod budget;
mod elf;
mod firmware;
mod foreign;
mod host;
mod output;
mod process;
mod proof;
mod scenes;
mod stack;
mod tables;
mod tools;

use crate::args::EmbeddedArgs;
use crate::performance::replaced;
use firmware::{Chip, Program};
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::progress::Spinner;
use output::Output;
use std::io::Write as _;
use std::path::PathBuf;
use tools::Tools;

/// Builds, runs, compares and writes the page.
pub(crate) fn embedded(args: &EmbeddedArgs) -> Result<(), Failure> {
    let tools = Tools::find()?;
    scenes::generate()?;
    let host = host::run()?;
    let mut boards = Vec::new();
    for chip in Chip::ALL {
        let board = Board::new(&tools, chip)?;
        let n_runs = host.compare(&board.outputs()).map_err(|words| failed(chip, &words))?;
        say(&format!("{}: all {n_runs} runs have the bits of the host", chip.name()));
        proof::no_panic(&board)?;
        boards.push(board);
    }
    proof::faults_are_caught(&tools)?;
    check_clocks(&boards)?;
    let header = foreign::header()?;
    if args.print {
        foreign::check_header(&header)?;
    } else {
        files::write(&foreign::header_path(), &header)?;
    }
    let foreign = foreign::check(&tools, &host)?;
    let limits = budget::lines(&tools, &boards)?;
    let tables = [
        ("tools", tools.versions()?),
        ("counts", tables::counts(&boards)),
        ("sizes", tables::sizes(&boards, &foreign)?),
        ("precision", tables::precision(&boards)),
        ("budget", budget::table(&limits)),
    ];
    if args.print {
        tables.iter().for_each(|(_, table)| say(&format!("\n{table}")));
    } else {
        write(args, &tables)?;
    }
    budget::check(&limits)
}

/// A thousand instructions that are known to be a thousand must be counted as such.
fn check_clocks(boards: &[Board]) -> Result<(), Failure> {
    for board in boards {
        for ran in board.programs.iter().filter(|ran| !ran.output.counts.is_empty()) {
            if ran.output.thousand != Some(1000) {
                return Err(failed(
                    board.chip,
                    &format!("a thousand instructions count {:?}", ran.output.thousand),
                ));
            }
        }
    }
    Ok(())
}

fn write(args: &EmbeddedArgs, tables: &[(&str, String)]) -> Result<(), Failure> {
    let path = args.out.clone().unwrap_or_else(|| files::root().join("docs").join("embedded.md"));
    let mut page = files::read_template(&path)?;
    for (name, table) in tables {
        page = replaced(&page, name, table)?;
    }
    let is_new = files::write(&path, &page)?;
    eprintln!("{} {}", if is_new { "wrote" } else { "nothing new in" }, path.display());
    Ok(())
}

/// A chip and what it made of all programs.
struct Board {
    chip: Chip,
    programs: Vec<Ran>,
}

/// A program, what it printed, and what it may take of stack.
struct Ran {
    program: Program,
    output: Output,
    /// Of programs as on a device only: the others have tables of functions, which no bound can follow.
    stack: Option<stack::Bound>,
}

impl Board {
    fn new(tools: &Tools, chip: Chip) -> Result<Self, Failure> {
        let mut programs = Vec::new();
        for program in firmware::build(tools, chip)? {
            let _spinner = Spinner::new(format!("running {} on {}", program.name, chip.name()));
            let output = Output::parse(&firmware::run(tools, chip, &program)?)
                .map_err(|words| failed(chip, &format!("{}: {words}", program.name)))?;
            let is_device = ["balancer", "control", "quadruped", "stabilised"]
                .iter()
                .any(|name| program.name.starts_with(name));
            let stack = is_device.then(|| stack::bound(tools, &program)).transpose()?;
            programs.push(Ran { program, output, stack });
        }
        Ok(Self { chip, programs })
    }

    fn outputs(&self) -> Vec<&Output> {
        self.programs.iter().map(|ran| &ran.output).collect()
    }

    fn ran(&self, name: &str) -> Option<&Ran> {
        self.programs.iter().find(|ran| ran.program.name == name)
    }
}

fn say(words: &str) {
    // Nobody is left to be told if standard output is closed.
    let _ = writeln!(std::io::stdout(), "{words}");
}

fn failed(chip: Chip, words: &str) -> Failure {
    Failure::Run(format!("{}: {words}", chip.name()))
}

/// The workspace of the firmware.
fn folder() -> PathBuf {
    files::root().join("embedded")
}

/// Where everything is built, beside the tools.
fn target() -> PathBuf {
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| "target".into(), PathBuf::from);
    files::root().join(target).join("embedded")
}
