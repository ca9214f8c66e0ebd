//! The tables of docs/embedded.md.

use super::foreign::Sizes;
use super::{Board, Ran, budget};
use gyro_cli::failure::Failure;
use std::fmt::Write as _;

/// Instructions, least, mean and most over a run.
pub(crate) fn counts(boards: &[Board]) -> String {
    let mut text = "| scene | coordinates | work".to_owned();
    let columns: Vec<(&Board, &'static str)> = boards
        .iter()
        .flat_map(|board| board.chip.precisions().iter().map(move |precision| (board, *precision)))
        .collect();
    for (board, precision) in &columns {
        let _ = write!(text, " | {} {precision}", board.chip.name());
    }
    text += " |\n|---|---|---";
    columns.iter().for_each(|_| text += "|---");
    text += "|\n";
    let counts = boards.iter().take(1).flat_map(|board| &board.programs).flat_map(|ran| &ran.output.counts);
    for count in counts.filter(|count| count.precision == "f32") {
        let _ = write!(text, "| {} | {} | {}", count.scene, count.form, count.work.replace('-', " "));
        for (board, precision) in &columns {
            let outputs = board.programs.iter().map(|ran| &ran.output);
            let found = outputs
                .filter_map(|output| output.count(precision, &count.scene, &count.form, &count.work))
                .next();
            let _ = match found {
                None => write!(text, " | "),
                Some(c) if c.least == c.most => write!(text, " | {}", c.mean),
                Some(c) => write!(text, " | {} ({}–{})", c.mean, c.least, c.most),
            };
        }
        text += " |\n";
    }
    text
}

/// The function of a module that has its joint dynamics, where it is one of its own: as symbols have its name.
const ACCELERATIONS: &str = "19joint_accelerations";

/// Flash, RAM and stack of the control loop.
pub(crate) fn sizes(boards: &[Board], foreign: &Sizes) -> Result<String, Failure> {
    let mut text =
        "| program | text | of it accelerations | constants | statics | state and workspace | stack used | stack, bound |\n\
                    |---|---|---|---|---|---|---|---|\n"
            .to_owned();
    for board in boards {
        for (ran, bound) in board.programs.iter().filter_map(|ran| Some((ran, ran.stack.as_ref()?))) {
            let elf = ran.elf()?;
            let [code, constants] = [".text", ".rodata"].map(|section| elf.size(section));
            let statics = elf.size(".data") + elf.size(".bss");
            let accelerations = elf.length(ACCELERATIONS).map_or_else(String::new, |bytes| bytes.to_string());
            let known = |bytes: Option<u32>| bytes.map_or_else(String::new, |bytes| bytes.to_string());
            let _ = writeln!(
                text,
                "| {}, {} | {code} | {accelerations} | {constants} | {statics} | {} | {} | {} |",
                ran.program.name,
                board.chip.name(),
                known(ran.output.ram),
                known(ran.output.stack),
                bound.bytes,
            );
        }
    }
    let Sizes { c, wasm } = foreign;
    let _ = writeln!(text, "| example in C, Cortex-M7 | {c} | | | | | | |");
    let _ = writeln!(text, "| module of WebAssembly, whole file | {wasm} | | | | | | |");
    Ok(text)
}

/// Errors of α and β after the paper's second.
pub(crate) fn precision(boards: &[Board]) -> String {
    let mut text = "| run | precision | α, µrad | β, µrad |\n|---|---|---|---|\n".to_owned();
    let Some((alpha, beta)) = budget::reference() else { return text };
    let mut seen = Vec::new();
    for run in boards.iter().flat_map(|board| &board.programs).flat_map(|ran| &ran.output.runs) {
        let key = (run.precision.clone(), run.name.clone());
        // All chips have the same bits.
        if !run.name.starts_with("paper") || seen.contains(&key) {
            continue;
        }
        let [alpha, beta] = [run.joint(0) - alpha, run.joint(1) - beta].map(|error| 1e6 * error);
        let _ = writeln!(text, "| {} | {} | {alpha:.2e} | {beta:.2e} |", run.name, run.precision);
        seen.push(key);
    }
    text
}

impl Ran {
    fn elf(&self) -> Result<super::elf::Elf, Failure> {
        super::elf::Elf::read(&self.program.path)
    }

    /// Bytes of code and constants.
    pub(crate) fn text(&self) -> Result<u64, Failure> {
        let elf = self.elf()?;
        Ok(elf.size(".text") + elf.size(".rodata"))
    }
}
