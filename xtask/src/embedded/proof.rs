//! What the linker and the disassembly prove, and that these proofs can fail.

use super::elf::Elf;
use super::firmware::{self, BUILDING, Chip, Program};
use super::process::within;
use super::stack;
use super::tools::Tools;
use super::{Board, failed, say, target};
use gyro_cli::failure::Failure;
use gyro_cli::progress::Spinner;

/// Parts of names, as the compiler mangles them, that nothing may have: panics, formatting, an allocator.
const FORBIDDEN: [&str; 7] =
    ["panicking", "4core3fmt", "rust_begin_unwind", "__rust_alloc", "__rust_realloc", "__rg_", "malloc"];

/// Nothing in any program of a board can panic, format or allocate; the control loop calls nothing through pointers.
///
/// A panic would need the handler, which does not link; here the symbols are listed too.
pub(crate) fn no_panic(board: &Board) -> Result<(), Failure> {
    for ran in &board.programs {
        let name = &ran.program.name;
        let found = forbidden(&ran.program)?;
        if !found.is_empty() {
            return Err(failed(board.chip, &format!("{name} has {}", found.join(", "))));
        }
        let indirect = ran.stack.as_ref().map_or(&[][..], |stack| &stack.indirect);
        if !indirect.is_empty() {
            return Err(failed(
                board.chip,
                &format!("{name} calls through pointers: {}", indirect.join(", ")),
            ));
        }
    }
    let (chip, n_programs) = (board.chip.name(), board.programs.len());
    say(&format!("{chip}: no panic, no formatting, no allocator in {n_programs} programs"));
    Ok(())
}

/// The symbols of a program that it must not have.
pub(crate) fn forbidden(program: &Program) -> Result<Vec<String>, Failure> {
    let elf = Elf::read(&program.path)?;
    let symbols = elf.symbols();
    if symbols.is_empty() {
        return Err(Failure::Run(format!("{} has no symbols to look at", program.name)));
    }
    let is_forbidden = |name: &String| FORBIDDEN.iter().any(|part| name.contains(part));
    Ok(symbols.iter().map(|(_, name)| name.clone()).filter(is_forbidden).collect())
}

/// Whether the accelerations that `gyro_sim::Partitioned` integrates are one straight line: no call, to libm or
/// elsewhere.
pub(crate) fn is_straight(tools: &Tools, program: &Program) -> Result<bool, Failure> {
    let is_derivative = |name: &str| name.contains("::Corrected as ") && name.ends_with("::derivative");
    match stack::calls(tools, program, is_derivative)? {
        Some(calls) => Ok(!calls),
        None => Err(Failure::Run(format!("{} has no derivative of its own", program.name))),
    }
}

/// A panic that can be reached does not link, and an instruction that the processor does not have ends the program.
pub(crate) fn faults_are_caught(tools: &Tools) -> Result<(), Failure> {
    let spinner = Spinner::new("building firmware with a fault, which must fail".to_owned());
    let mut command = firmware::cargo(tools, Chip::M4);
    command.args(["--bin", "control-f32", "--features", "fault"]);
    let (is_success, words) = within(BUILDING, &mut command)?;
    drop(spinner);
    if is_success || !words.contains("a_panic_can_be_reached") {
        return Err(Failure::Run(format!("an index out of bounds was not caught by the linker\n{words}")));
    }
    say("an index that may be out of bounds does not link");
    let name = "control-f64".to_owned();
    let program = Program { path: target().join(Chip::M7.cpu()).join(&name), name };
    let (is_success, words) = firmware::attempt(tools, Chip::M4, &program)?;
    if is_success || !words.contains("hard fault") {
        return Err(Failure::Run(format!(
            "double precision on a processor without it did not fail\n{words}"
        )));
    }
    say("double precision on a processor without it ends in a hard fault");
    Ok(())
}
