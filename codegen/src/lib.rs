//! From the description of a mechanism to unrolled Rust.
//!
//! [`generate`] is a pure function: the text of a model file in, the text of a module out, byte for byte the same each
//! time. It does no I/O, so a `build.rs` can call it as well as `cargo xtask generate`:
//!
//! ```
//! let page = r#"
//! format = 1
//! name = "pendulum"
//! gravity = [0, -9.81, 0]
//!
//! [[body]]
//! name = "wall"
//! fixed = true
//!
//! [[body]]
//! name = "rod"
//! mass = 1
//! inertia = [1e-4, 0.08, 0.08]
//!
//! [[joint]]
//! name = "hinge"
//! kind = "revolute"
//! axis = [0, 0, 1]
//! zero = [1, 0, 0]
//! first = { body = "wall" }
//! second = { body = "rod", point = [-0.5, 0, 0] }
//! "#;
//! let module = gyro_codegen::generate("pendulum.toml", page)?;
//! assert_eq!(module.type_name, "Pendulum");
//! assert!(module.code.contains("pub struct Pendulum<T>"));
//! # Ok::<(), gyro_codegen::Error>(())
//! ```
//!
//! The stages, a folder each, none of which knows of a later one: `expr` has the graph of expressions, `simplify`
//! passes that shorten any of them, `derive` the textbook from the model to Φ, its derivatives, masses and forces,
//! `solve` the solves of eq. (17) and of the coordinate partition, `joint_space` the same in joint coordinates;
//! `equations` brings them together, `kernels` names what a module computes, `emit` writes it.
#![deny(missing_docs)]

mod derive;
mod effort;
mod emit;
mod equations;
mod expr;
mod groups;
mod joint_space;
mod kernels;
mod repeat;
mod scheduled;
mod selection;
mod simplify;
mod solve;
pub mod tape;

pub use effort::Effort;
pub use emit::data_sheet::{DataSheet, Function, large, shown_name};
pub use equations::Argument;
pub use equations::PartitionForm;
pub use expr::rounding::LIKE as ROUNDING;
pub use expr::schedule::{Operations, Passes};
pub use groups::Functions;
pub use gyro_program::{Group, Kernel};
pub use repeat::Repetition;
pub use scheduled::{
    Index, JointForm, JointPlace, Origin, Scheduled, ScheduledKernel, Store, Stored, Variable,
};
pub use selection::UnknownFunction;
pub use simplify::cheapest::Form;
pub use simplify::normal_form::Reduction;

use derive::system::System;
use derive::{Observed, Textbook};
use emit::module;
use equations::{Equations, Parts, Rotations};
use groups::Facts;
use joint_space::{Candidates, Coordinates, JointSpace};
use scheduled::Computed;
use solve::Solution;
use solve::dependence::Yielding;
use solve::forward_dynamics::ForwardDynamics;
use solve::partition::Partition;

use gyro_model::{AssemblyError, Diagnostics, Model, Output, OutputKind, Start};
use std::fmt;

/// A generated module.
#[derive(Clone, Debug)]
pub struct Module {
    /// Name of the module: the model's, in `snake_case`.
    pub name: String,
    /// Name of the mechanism's type, in `PascalCase`.
    pub type_name: String,
    /// The text of the module's file.
    pub code: String,
    /// The exact constants behind the literals of the code, one literal a line: `0.7071067811865476 = 1/2*sqrt(2)`.
    /// Where several round to one literal, they are listed with what its occurrences stand for, in the order of the
    /// text: ` as 1*3 2`.
    pub constants: String,
    /// What was generated, as data: the head of the file shows it.
    pub data_sheet: DataSheet,
    /// The same mechanism as data, operation for operation: what is written in other languages is written from this.
    pub scheduled: Scheduled,
}

impl Module {
    /// Whether the mechanism implements a trait of the run time.
    pub fn implements(&self, name: &str) -> bool {
        self.scheduled.groups.iter().any(|group| group.trait_name() == name)
    }

    /// The module as one item, `pub mod name { ... }`, for `include!` (which admits no inner documentation outside a
    /// module).
    pub fn as_item(&self) -> String {
        format!("/// Generated from a model file.\npub mod {} {{\n{}}}\n", self.name, self.code)
    }
}

/// Why a model file gives no module.
#[derive(Clone)]
pub enum Error {
    /// Mistakes in the model file.
    ModelFile(Diagnostics),
    /// No consistent start exists.
    Start(AssemblyError),
    /// The model file asks for a function that there is not.
    Functions(UnknownFunction),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ModelFile(diagnostics) => diagnostics.fmt(f),
            Self::Start(error) => error.fmt(f),
            Self::Functions(unknown) => unknown.fmt(f),
        }
    }
}

/// The same text as [`fmt::Display`]: a `main` or `build.rs` that returns the error shows it in this form.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{self}")
    }
}

impl std::error::Error for Error {}

/// Writes the module of a model file. `file_name` is the model file's name in messages and in the module's first line.
///
/// # Errors
/// All mistakes in the model file at once, or why no consistent start exists.
pub fn generate(file_name: &str, text: &str) -> Result<Module, Error> {
    let model = gyro_model::read(file_name, text).map_err(Error::ModelFile)?;
    generate_model(file_name, &model)
}

/// The same for a model file whose motions name tables: `load` gives the text of the file that the model file calls by
/// this name.
///
/// # Errors
/// All mistakes in the model file at once, or why no consistent start exists.
pub fn generate_with(
    file_name: &str,
    text: &str,
    load: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Module, Error> {
    let model = gyro_model::read_with(file_name, text, load).map_err(Error::ModelFile)?;
    generate_model(file_name, &model)
}

/// How eq. (17) is solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Elimination {
    /// Through the null space of the joints: the fewest operations and the smallest errors. What [`generate`] takes.
    NullSpace,
    /// By a factorisation of the whole saddle matrix, for comparison.
    Saddle,
}

/// Writes the module of a model that was read already, with the functions that the model file asks for, or with the
/// [usual](Functions::usual) ones.
///
/// # Errors
/// Why no consistent start exists, or which function is not known.
pub fn generate_model(file_name: &str, model: &Model) -> Result<Module, Error> {
    generate_by(Elimination::NullSpace, file_name, model)
}

/// The same with a given way of solving eq. (17).
///
/// # Errors
/// As [`generate_model`].
pub fn generate_by(elimination: Elimination, file_name: &str, model: &Model) -> Result<Module, Error> {
    let functions = match &model.functions {
        Some(names) => Functions::named(names.iter().map(String::as_str)).map_err(Error::Functions)?,
        None => Functions::usual(),
    };
    write(file_name, model, (elimination, &functions, Effort::Full))
}

/// The same with given functions, whatever the model file asks for.
///
/// # Errors
/// Why no consistent start exists.
pub fn generate_functions(file_name: &str, model: &Model, functions: &Functions) -> Result<Module, Error> {
    generate_by_effort(file_name, model, functions, Effort::Full)
}

/// The same with a given effort.
///
/// # Errors
/// Why no consistent start exists.
pub fn generate_by_effort(
    file_name: &str,
    model: &Model,
    functions: &Functions,
    effort: Effort,
) -> Result<Module, Error> {
    write(file_name, model, (Elimination::NullSpace, functions, effort))
}

fn write(file_name: &str, model: &Model, asked: (Elimination, &Functions, Effort)) -> Result<Module, Error> {
    let start = model.assemble().map_err(Error::Start)?;
    let computed = Computed::of(equations(model, asked, &start));
    let scheduled = Scheduled::of(&computed, &start);
    let type_name = module::type_name(&model.name);
    let module::Text { code, constants, data_sheet } =
        module::write(file_name, &type_name, &computed, &scheduled);
    Ok(Module { name: model.name.clone(), type_name, code, constants, data_sheet, scheduled })
}

/// The kernels of a model as data, with given functions and effort: what [`generate_by_effort`] gives beside the text,
/// without that.
///
/// # Errors
/// Why no consistent start exists.
pub fn schedule(model: &Model, functions: &Functions, effort: Effort) -> Result<Scheduled, Error> {
    let start = model.assemble().map_err(Error::Start)?;
    let asked = (Elimination::NullSpace, functions, effort);
    Ok(Scheduled::of(&Computed::of(equations(model, asked, &start)), &start))
}

/// From the model to what its module computes: derives, solves and chooses.
fn equations<'m>(
    model: &'m Model,
    (elimination, functions, effort): (Elimination, &Functions, Effort),
    start: &Start,
) -> Equations<'m> {
    let mut system = System::with_effort(model, effort);
    system.graph.domains.set_states(&start.states);
    let textbook = Textbook::derive(&mut system);
    let functions = &functions.clone().of_mechanism(facts(&system));
    // Accelerations at any state are a form of those at corrected states, too.
    let is_solved = functions.has(Group::Maximal) || functions.has(Group::Corrected);
    let mut yielding = Yielding::new();
    if !model.dependent_rows().is_empty() {
        yielding = Coordinates::derive(&mut system, &textbook).yielding(&mut system);
    }
    let forward_dynamics = ForwardDynamics::of(&mut system, &textbook.kinematics, yielding);
    let solution = Solution::of(&mut system, &textbook, &forward_dynamics, (elimination, is_solved));
    let observed = Observed::derive(&mut system, &textbook, &solution.lambda);
    let has_charts = functions.has(Group::Partition);
    let partition = has_charts.then(|| Partition::of(&mut system, &textbook.kinematics)).flatten();
    let definitions = system.definitions.clone();
    let mut rotations = Rotations::of(&mut system, &definitions);
    let solved = rotations.cheapest(&mut system.graph, &solution.solved);
    let joint_space = functions.has(Group::Joint).then(|| {
        let coordinates = Coordinates::derive(&mut system, &textbook);
        coordinates.set_domains(&mut system, start);
        let candidates = Candidates::solve(&mut system, &coordinates);
        let (derived, asked) = ((&textbook, &observed), (functions, start));
        JointSpace::choose(&mut system, derived, coordinates, candidates, &solved.roots, asked)
    });
    let projects = functions.has(Group::Projection);
    let projection = projects.then(|| forward_dynamics.projection(&mut system, &textbook.kinematics));
    let parts = Parts { textbook, solution, observed, projection, partition };
    Equations::choose(system, rotations, &parts, solved, (functions, joint_space))
}

/// What the mechanism makes of groups of functions.
fn facts(system: &System) -> Facts {
    let model = system.model;
    let is_driven = model.is_driven();
    let tells_motion = |output: &Output| match output.kind {
        OutputKind::Acceleration(_)
        | OutputKind::Inertial(_)
        | OutputKind::Reaction { .. }
        | OutputKind::Driver { .. }
        | OutputKind::Coupler { .. }
        | OutputKind::Rate(_) => true,
        OutputKind::Power => is_driven,
        OutputKind::Pose(_)
        | OutputKind::Velocity(_)
        | OutputKind::Relative(_)
        | OutputKind::Spring { .. }
        | OutputKind::Link { .. }
        | OutputKind::Bushing { .. }
        // What a formula sees is an output of its own.
        | OutputKind::Formula(_)
        | OutputKind::State { .. }
        | OutputKind::Energy => false,
    };
    let tells_multipliers = |output: &Output| {
        tells_motion(output)
            && matches!(
                output.kind,
                OutputKind::Reaction { .. }
                    | OutputKind::Driver { .. }
                    | OutputKind::Coupler { .. }
                    | OutputKind::Power
            )
    };
    Facts {
        joint_partition: !Partition::covers(system),
        outputs_of_motion: model.outputs.iter().any(tells_motion),
        outputs_of_multipliers: model.outputs.iter().any(tells_multipliers),
        work_of_loops: is_driven && model.has_work() && !system.loop_closure_rows().is_empty(),
    }
}
