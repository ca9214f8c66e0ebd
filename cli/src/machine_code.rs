//! Machine code of a generated module: a library that has each of its functions for `f64`, and what `nm` says of it.

use crate::programs::output;
use gyro_program::{Given, Kernel, Outcome, Space};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// How a function of the library is called.
struct Call {
    /// Its name.
    function: &'static str,
    /// What it takes besides the mechanism and the time: names and types.
    takes: Vec<(&'static str, String)>,
    returns: &'static str,
}

/// An array of the module.
fn array(space: Space) -> String {
    format!("<Module as {}>::{}", space.group().trait_name(), space.name())
}

/// Of each kernel; none of what is called within `set_parameters`.
fn call(kernel: Kernel) -> Option<Call> {
    let signature = kernel.signature();
    let mut takes = Vec::new();
    if signature.given == Given::Charts {
        takes.push(("choice", "&<Module as Partition>::Independent".to_owned()));
    }
    let read = signature.state.argument().filter(|_| signature.result != Outcome::Overwrites);
    takes.extend(read.map(|(name, space)| (name, format!("&{}", array(space)))));
    if let Given::Told(name, space) = signature.given {
        takes.push((name, format!("&{}", array(space))));
    }
    takes.extend(
        signature.written().into_iter().map(|(name, space)| (name, format!("&mut {}", array(space)))),
    );
    let (function, returns) = match signature.result {
        Outcome::Derived => return None,
        Outcome::Energies => (kernel.function(), " -> Energy<f64>"),
        Outcome::Vectors => ("independent", " -> <Module as Partition>::Independent"),
        _ if signature.given == Given::Charts => (kernel.function(), " -> Result<(), Error>"),
        _ => (kernel.function(), ""),
    };
    Some(Call { function, takes, returns })
}

/// The root of a library whose module `mechanism` has this type, with the functions of these kernels: without them
/// nothing would be compiled.
pub fn library(type_name: &str, kernels: &[Kernel]) -> String {
    let mut text = format!(
        "#[allow(warnings, clippy::all)]
mod mechanism;

#[allow(unused_imports)]
use gyro_sim::*;

pub type Module = mechanism::{type_name}<f64>;
"
    );
    for Call { function, takes, returns } in kernels.iter().filter_map(|&kernel| call(kernel)) {
        let taken: String = takes.iter().map(|(name, of)| format!(", {name}: {of}")).collect();
        let passed: String = takes.iter().map(|(name, _)| format!(", {name}")).collect();
        text += &format!(
            "#[inline(never)]\npub fn {function}(module: &Module, t: f64{taken}){returns} {{ module.{function}(t{passed}) }}\n"
        );
    }
    text
}

/// Option of rustc for the library: symbols tell whose part a closure is.
pub const SYMBOLS: &str = "-Csymbol-mangling-version=v0";

/// Bytes of each function of a compiled library, with what the compiler has inlined into it and the parts that
/// are compiled apart; none without `nm`.
pub fn bytes(library: &Path) -> Option<BTreeMap<Kernel, u64>> {
    let symbols = output(Command::new("nm").args(["--print-size", "--demangle"]).arg(library)).ok()?;
    Some(sizes(&symbols))
}

fn sizes(symbols: &str) -> BTreeMap<Kernel, u64> {
    let mut sizes = BTreeMap::new();
    for (function, size) in symbols.lines().filter_map(size) {
        let is_called = |kernel: &Kernel| call(*kernel).is_some_and(|call| call.function == function);
        if let Some(kernel) = Kernel::all().find(is_called) {
            *sizes.entry(kernel).or_default() += size;
        }
    }
    sizes
}

/// The function that a symbol is the code, or a part of the code, of, and its size.
fn size(line: &str) -> Option<(&str, u64)> {
    let [_, size, kind, name] = line.splitn(4, ' ').collect::<Vec<_>>().try_into().ok()?;
    // What is compiled apart is named by its closure: `gyro_sim::apart::<.., <.. as ..>::accelerations::{closure#0}>`.
    let function = name.split("::{closure").next()?;
    let last = function.rsplit("::").next()?;
    let size = u64::from_str_radix(size, 16).ok()?;
    matches!(kind, "t" | "T" | "w" | "W").then_some((last, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_count_by_their_last_word() {
        let symbols = "0000000000000000 0000000000000010 T chain::accelerations
0000000000000000 0000000000000100 t <chain::mechanism::Chain2<T> as gyro_sim::mechanism::Dynamics>::accelerations
0000000000000000 0000000000000200 T chain::accelerations_other
0000000000000000 0000000000000001 t gyro_sim::apart::apart::<(f64, f64), <chain::mechanism::Chain2<f64> as gyro_sim::mechanism::Dynamics>::accelerations::{closure#1}>
0000000000000000 0000000000000020 T chain::independent
0000000000000000 0000000000000400 R chain::phi
                 U libm::sin
";
        assert_eq!(
            sizes(symbols),
            BTreeMap::from([(Kernel::Accelerations, 0x111), (Kernel::ChartVectors, 0x20)])
        );
    }

    #[test]
    fn only_what_is_asked_for_is_in_the_library() {
        let text = library("Top", &[Kernel::ParameterSetup, Kernel::Phi]);
        assert!(text.contains("module.phi(t, y, out)") && text.contains("mechanism::Top<f64>"), "{text}");
        assert!(!text.contains("gamma") && !text.contains("Joints"), "{text}");
    }
}
