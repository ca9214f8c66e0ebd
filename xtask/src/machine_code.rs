//! Machine code of a generated module: a library that has each of its functions for `f64`, and what `nm` says of it.

use crate::programs::output;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// Each function of a data sheet: its name there and in the library, what it takes besides the mechanism and the time, and returns.
const FUNCTIONS: [[&str; 5]; 27] = [
    ["phi", "phi", "y: &State, out: &mut <Module as Mechanism>::Constraints", "y, out", ""],
    ["phi_q", "phi_q", "y: &State, out: &mut <Module as Equations>::PhiQ", "y, out", ""],
    ["phi_pi", "phi_pi", "y: &State, out: &mut <Module as Equations>::PhiPi", "y, out", ""],
    ["nu", "nu", "y: &State, out: &mut Rows", "y, out", ""],
    ["gamma", "gamma", "y: &State, out: &mut Rows", "y, out", ""],
    ["velocity_residual", "velocity_residual", "y: &State, out: &mut Rows", "y, out", ""],
    [
        "applied_force",
        "applied_force",
        "y: &State, out: &mut <Module as Equations>::Velocities",
        "y, out",
        "",
    ],
    ["accelerations", "accelerations", "y: &State, out: &mut Accelerations", "y, out", ""],
    ["multipliers", "multipliers", "y: &State, a: &Accelerations, out: &mut Rows", "y, a, out", ""],
    [
        "project",
        "project",
        "y: &State, rows: &Rows, out: &mut <Module as Equations>::Velocities",
        "y, rows, out",
        "",
    ],
    ["derivative", "derivative", "y: &State, dy: &mut State", "y, dy", ""],
    ["energy", "energy", "y: &State", "y", "Energy<f64>"],
    ["read_joints", "read_joints", "y: &State, out: &mut <Module as Mechanism>::Readings", "y, out", ""],
    ["outputs", "outputs", "y: &State, out: &mut <Module as Mechanism>::Outputs", "y, out", ""],
    ["chart vectors", "independent", "y: &State", "y", "Choice"],
    ["newton_step", "newton_step", "choice: &Choice, y: &mut State", "choice, y", "Result<(), Error>"],
    [
        "solve_velocities",
        "solve_velocities",
        "choice: &Choice, y: &mut State",
        "choice, y",
        "Result<(), Error>",
    ],
    ["joint_accelerations", "joint_accelerations", "x: &Joints, out: &mut Rates", "x, out", ""],
    ["joint_derivative", "joint_derivative", "x: &Joints, dx: &mut Joints", "x, dx", ""],
    ["to_maximal", "to_maximal", "x: &Joints, y: &mut State", "x, y", ""],
    ["to_joints", "to_joints", "y: &State, x: &mut Joints", "y, x", ""],
    ["joint_accelerations_at", "joint_accelerations_at", "y: &State, out: &mut Rates", "y, out", ""],
    [
        "corrected_accelerations",
        "corrected_accelerations",
        "y: &State, out: &mut <Module as Equations>::Velocities",
        "y, out",
        "",
    ],
    [
        "corrected_multipliers",
        "corrected_multipliers",
        "y: &State, a: &<Module as Equations>::Velocities, out: &mut Rows",
        "y, a, out",
        "",
    ],
    [
        "corrected_solution",
        "corrected_solution",
        "y: &State, out: &mut <Module as JointSpace>::Solution",
        "y, out",
        "",
    ],
    [
        "joint_jacobian",
        "joint_jacobian",
        "x: &Joints, dfdx: &mut <Module as JointSpace>::Jacobian, dfdt: &mut Joints",
        "x, dfdx, dfdt",
        "",
    ],
    [
        "joint_input_jacobian",
        "joint_input_jacobian",
        "x: &Joints, out: &mut <Module as JointSpace>::InputJacobian",
        "x, out",
        "",
    ],
];

/// The root of a library whose module `mechanism` has this type, with the functions of these names: without them nothing would be
/// compiled. What is not known by name is left out.
pub(crate) fn library(type_name: &str, names: &[&str]) -> String {
    let mut text = format!(
        "#[allow(warnings, clippy::all)]
mod mechanism;

#[allow(unused_imports)]
use gyro_sim::{{Energy, Equations, Error, JointSpace, Mechanism, Partition}};

pub type Module = mechanism::{type_name}<f64>;
type State = <Module as Mechanism>::State;
type Rows = <Module as Mechanism>::Rows;
type Accelerations = <Module as Equations>::Accelerations;
type Choice = <Module as Partition>::Independent;
"
    );
    if names.iter().any(|name| name.contains("joint_")) {
        text +=
            "type Joints = <Module as JointSpace>::Joints;\ntype Rates = <Module as JointSpace>::Rates;\n";
    }
    let wanted = FUNCTIONS.iter().filter(|[name, ..]| names.contains(name));
    for [_, function, takes, passes, returns] in wanted {
        let returns = if returns.is_empty() { String::new() } else { format!(" -> {returns}") };
        text += &format!(
            "#[inline(never)]\npub fn {function}(module: &Module, t: f64, {takes}){returns} {{ module.{function}(t, {passes}) }}\n"
        );
    }
    text
}

/// Option of rustc for the library: symbols tell whose part a closure is.
pub(crate) const SYMBOLS: &str = "-Csymbol-mangling-version=v0";

/// Bytes of each function of a compiled library, by its name on the data sheet, with what the compiler has inlined into it and the parts that
/// are compiled apart; none without `nm`.
pub(crate) fn bytes(library: &Path) -> Option<BTreeMap<&'static str, u64>> {
    let symbols = output(Command::new("nm").args(["--print-size", "--demangle"]).arg(library)).ok()?;
    Some(sizes(&symbols))
}

fn sizes(symbols: &str) -> BTreeMap<&'static str, u64> {
    let mut sizes = BTreeMap::new();
    for (function, size) in symbols.lines().filter_map(size) {
        if let Some([name, ..]) = FUNCTIONS.iter().find(|[_, known, ..]| *known == function) {
            *sizes.entry(*name).or_default() += size;
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
0000000000000000 0000000000000100 t <chain::mechanism::Chain2<T> as gyro_sim::mechanism::Equations>::accelerations
0000000000000000 0000000000000200 T chain::accelerations_other
0000000000000000 0000000000000001 t gyro_sim::apart::apart::<(f64, f64), <chain::mechanism::Chain2<f64> as gyro_sim::mechanism::Equations>::accelerations::{closure#1}>
0000000000000000 0000000000000020 T chain::independent
0000000000000000 0000000000000400 R chain::phi
                 U libm::sin
";
        assert_eq!(sizes(symbols), BTreeMap::from([("accelerations", 0x111), ("chart vectors", 0x20)]));
    }

    #[test]
    fn only_what_is_named_is_in_the_library() {
        let text = library("Top", &["phi", "no such function"]);
        assert!(text.contains("module.phi(t, y, out)") && text.contains("mechanism::Top<f64>"), "{text}");
        assert!(!text.contains("gamma") && !text.contains("type Joints"), "{text}");
    }

    /// Every function that a module may have has its place here.
    #[test]
    fn the_list_is_complete() {
        let page = crate::files::root().join("models").join("gyroscope.toml");
        let model = crate::scene::read(&page).unwrap();
        let module = gyro_codegen::generate_model("gyroscope.toml", &model).unwrap();
        for function in &module.sheet.functions {
            assert!(FUNCTIONS.iter().any(|[name, ..]| *name == function.name), "{}", function.name);
        }
    }
}
