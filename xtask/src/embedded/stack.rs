//! A bound of the stack without running anything: the stack of each function, from the compiler, along the longest path
//! of calls, from the disassembly.

use super::elf::Elf;
use super::firmware::Program;
use super::tools::Tools;
use gyro_cli::failure::Failure;
use gyro_cli::programs::output;
use std::collections::{BTreeMap, BTreeSet};

/// What the code of a program says of its stack.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bound {
    /// Bytes of the longest path from the reset, and of one interrupt on top of it.
    pub(crate) bytes: u64,
    /// Functions that call through a pointer, which no bound can follow.
    pub(crate) indirect: Vec<String>,
}

/// What the processor itself pushes for an interrupt: 8 core and 18 floating-point registers, and a word to align.
const INTERRUPT: u64 = 4 * (8 + 18 + 1);

/// The interrupt that the firmware has.
const HANDLER: &str = "SysTick";

/// What the linker puts between functions, `d4d4`, reads as a branch `bmi.n` so far back.
const FILLER: u64 = 0x54;

/// Functions in assembly, of which the compiler says nothing, and the bytes that they keep by their disassembly.
const ASSEMBLY: [(&str, u64); 3] = [("Reset", 8), ("HardFault", 8), ("__aeabi_uldivmod", 24)];

/// The bound of a program.
pub(crate) fn bound(tools: &Tools, program: &Program) -> Result<Bound, Failure> {
    let elf = Elf::read(&program.path)?;
    let text =
        output(tools.command("arm-none-eabi-objdump").args(["-d", "--no-show-raw-insn"]).arg(&program.path))?;
    let graph = Graph::new(&text, elf.stack_sizes());
    let path =
        |from: &str| graph.longest(from).map_err(|words| Failure::Run(format!("{}: {words}", program.name)));
    let bytes = path("Reset")? + INTERRUPT + path(HANDLER)?;
    Ok(Bound { bytes, indirect: graph.indirect() })
}

/// Whether a function calls any other; none if there is no such function.
pub(crate) fn calls(
    tools: &Tools,
    program: &Program,
    is_meant: impl Fn(&str) -> bool,
) -> Result<Option<bool>, Failure> {
    let mut command = tools.command("arm-none-eabi-objdump");
    let text = output(command.args(["-d", "-C", "--no-show-raw-insn"]).arg(&program.path))?;
    let graph = Graph::new(&text, &BTreeMap::new());
    let found = graph.functions.values().find(|function| is_meant(&function.name));
    Ok(found.map(|function| !function.callees.is_empty() || function.is_indirect))
}

/// Who calls whom.
struct Graph {
    /// By their addresses.
    functions: BTreeMap<u64, Function>,
}

#[derive(Debug, Default)]
struct Function {
    name: String,
    stack: Option<u64>,
    /// Of `bl`.
    callees: BTreeSet<u64>,
    /// Of all other branches; those that leave the function are calls at its end.
    branches: BTreeSet<u64>,
    is_indirect: bool,
}

impl Graph {
    /// From a disassembly and the stack that the functions take.
    fn new(disassembly: &str, stack: &BTreeMap<u64, u64>) -> Self {
        let mut functions = BTreeMap::new();
        let mut current = None;
        for line in disassembly.lines() {
            if let Some((address, name)) = head(line) {
                let assembly = ASSEMBLY.iter().find(|(own, _)| *own == name).map(|(_, bytes)| *bytes);
                let stack = stack.get(&address).copied().or(assembly);
                functions.insert(address, Function { name: name.to_owned(), stack, ..Function::default() });
                current = Some(address);
            } else if let Some(function) = current.and_then(|address| functions.get_mut(&address)) {
                function.instruction(line);
            }
        }
        let mut graph = Self { functions };
        graph.follow_branches();
        graph
    }

    /// A branch within a function is not a call; one into another is.
    fn follow_branches(&mut self) {
        let heads: Vec<u64> = self.functions.keys().copied().collect();
        let owner = |address: &u64| heads[..heads.partition_point(|head| head <= address)].last().copied();
        for (own, function) in &mut self.functions {
            let outside = function.branches.iter().filter_map(owner).filter(|target| target != own);
            let calls = function.callees.iter().filter_map(owner);
            function.callees = calls.chain(outside).collect();
        }
    }

    /// Bytes of the longest path of calls from a function.
    fn longest(&self, from: &str) -> Result<u64, String> {
        let start = self.functions.iter().find(|(_, function)| function.name == from);
        let (address, _) = start.ok_or_else(|| format!("there is no function {from}"))?;
        self.depth(*address, &mut Vec::new(), &mut BTreeMap::new())
    }

    fn depth(
        &self,
        address: u64,
        path: &mut Vec<u64>,
        known: &mut BTreeMap<u64, u64>,
    ) -> Result<u64, String> {
        if let Some(depth) = known.get(&address) {
            return Ok(*depth);
        }
        let Some(function) = self.functions.get(&address) else {
            return Err(format!("nothing at {address:#x}"));
        };
        if path.contains(&address) {
            return Err(format!("{} is recursive", function.name));
        }
        path.push(address);
        let mut deepest = 0;
        for callee in &function.callees {
            deepest = self.depth(*callee, path, known)?.max(deepest);
        }
        path.pop();
        let own = function.stack.ok_or_else(|| format!("the stack of {} is not known", function.name))?;
        known.insert(address, own + deepest);
        Ok(own + deepest)
    }

    fn indirect(&self) -> Vec<String> {
        let indirect = self.functions.values().filter(|function| function.is_indirect);
        indirect.map(|function| function.name.clone()).collect()
    }
}

impl Function {
    /// Notes where a line of the disassembly calls or branches to.
    fn instruction(&mut self, line: &str) {
        let Some((address, instruction)) = line.split_once(":\t") else { return };
        let mut words = instruction.split_whitespace();
        let (Some(operation), Some(operand)) = (words.next(), words.last_address()) else {
            self.is_indirect |= is_call_by_pointer(instruction);
            return;
        };
        let address = u64::from_str_radix(address.trim(), 16).unwrap_or(0);
        if operation == "bmi.n" && operand.wrapping_add(FILLER) == address {
            return;
        }
        if operation == "bl" || operation == "blx" {
            self.callees.insert(operand);
        } else if operation.starts_with('b') || operation.starts_with("cb") {
            self.branches.insert(operand);
        }
    }
}

/// `00000400 <Reset>:`
fn head(line: &str) -> Option<(u64, &str)> {
    let (address, name) = line.strip_suffix(">:")?.split_once(" <")?;
    Some((u64::from_str_radix(address, 16).ok()?, name))
}

/// `blx r3`, or a branch through a register other than that of the return. (`mov pc, r6` jumps within a table of
/// branches, which are in the disassembly too.)
fn is_call_by_pointer(instruction: &str) -> bool {
    let mut words = instruction.split_whitespace();
    match (words.next(), words.next()) {
        (Some("blx"), Some(_)) => true,
        (Some("bx"), Some(register)) => register != "lr",
        _ => false,
    }
}

trait LastAddress {
    /// The address in `3fc <name+0x12>` at the end of an instruction.
    fn last_address(self) -> Option<u64>;
}

impl<'a, I: Iterator<Item = &'a str>> LastAddress for I {
    fn last_address(self) -> Option<u64> {
        let mut last = None;
        for word in self {
            if word.starts_with('<') {
                return last.and_then(|word: &str| u64::from_str_radix(word, 16).ok());
            }
            last = Some(word);
        }
        None
    }
}

#[cfg(test)]
mod tests;
