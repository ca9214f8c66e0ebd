//! Generated mechanisms without a compiler: their kernels are compiled in this process, by Cranelift, or interpreted.
//!
//! [`gyro_codegen::schedule`] gives the kernels of a model as data, the very operations that it writes as Rust. Here
//! they become machine code (`MachineCode`, the feature `machine-code`) in a moment, or are interpreted in any number
//! type ([`Interpreter`]).
//! Either way the results have the bits of the module that rustc compiles, because the operations, their constants and
//! the elementary functions are the same.
//!
//! ```
//! # let page = r#"
//! # format = 1
//! # name = "pendulum"
//! # gravity = [0, -9.81, 0]
//! # [[body]]
//! # name = "wall"
//! # fixed = true
//! # [[body]]
//! # name = "rod"
//! # mass = 1
//! # inertia = [1e-4, 0.08, 0.08]
//! # [[joint]]
//! # name = "hinge"
//! # kind = "revolute"
//! # axis = [0, 0, 1]
//! # zero = [1, 0, 0]
//! # first = { body = "wall" }
//! # second = { body = "rod", point = [-0.5, 0, 0] }
//! # "#;
//! use gyro_codegen::{Effort, Functions};
//! use gyro_sim::JointSpace;
//!
//! let model = gyro_model::read("pendulum.toml", page)?;
//! let pendulum = gyro_jit::compile::<f64>(&model, &Functions::usual(), Effort::Full)?;
//! let (x, mut rates) = (pendulum.joint_start(), pendulum.joint_buffers().rates);
//! pendulum.joint_accelerations(0.0, &x, &mut rates);
//! assert!((rates[0] + 1.0 * 9.81 * 0.5 / (0.08 + 0.25)).abs() < 1e-12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![deny(missing_docs)]

mod admissible;
#[cfg(feature = "machine-code")]
mod calls;
#[cfg(feature = "machine-code")]
mod clif;
mod contract;
mod description;
mod engine;
mod interpret;
#[cfg(feature = "machine-code")]
mod line;
#[cfg(feature = "machine-code")]
mod machine_code;
mod mechanism;
mod native;
mod run;

pub use admissible::check;
#[cfg(feature = "machine-code")]
pub use calls::{Library, NotLoaded, Sizes};
pub use contract::Independent;
pub use engine::{Arguments, Engine, Input, NotCompiled};
pub use interpret::Interpreter;
#[cfg(feature = "machine-code")]
pub use machine_code::MachineCode;
pub use mechanism::InProcess;
pub use native::Native;
pub use run::{Runs, answer, simulate};

use gyro_codegen::{Effort, Functions, Scheduled};
use gyro_model::Model;
use gyro_sim::{Real, Scalar};
use mechanism::Shared;
use std::error::Error;

/// What computes kernels fastest in this process.
#[cfg(feature = "machine-code")]
pub type Fastest<T> = MachineCode<T>;

/// What computes kernels fastest in this process.
#[cfg(not(feature = "machine-code"))]
pub type Fastest<T> = Interpreter<T>;

/// A mechanism of compiled kernels; without the feature `machine-code`, of interpreted ones.
pub type Compiled<T> = InProcess<T, Fastest<T>>;

/// A mechanism of interpreted kernels.
pub type Interpreted<T> = InProcess<T, Interpreter<T>>;

/// Derives the kernels of a model and compiles them.
///
/// # Errors
/// Why no consistent start exists, or why this machine is none for which code can be compiled.
pub fn compile<T: Native>(
    model: &Model,
    functions: &Functions,
    effort: Effort,
) -> Result<Compiled<T>, Box<dyn Error>> {
    Ok(compile_scheduled(model, gyro_codegen::schedule(model, functions, effort)?, None)?)
}

/// Compiles kernels that were derived before; `told` hears of each what Cranelift is given.
///
/// # Errors
/// Why this machine is none for which code can be compiled.
pub fn compile_scheduled<T: Native>(
    model: &Model,
    scheduled: Scheduled,
    told: Option<&mut dyn FnMut(Input<'_>)>,
) -> Result<Compiled<T>, NotCompiled> {
    let shared = Shared::new(model, scheduled);
    let code = Fastest::compile(&shared.scheduled, shared.layout, told)?;
    Ok(InProcess::with(shared, code))
}

impl<T: Native + Real> Compiled<T> {
    /// The same mechanism compiled for other numbers, such as packs of lanes, with the same parameters and the model
    /// file's inputs.
    ///
    /// # Errors
    /// As [`compile_scheduled`].
    pub fn compiled<U: Native>(&self) -> Result<Compiled<U>, NotCompiled> {
        let code = Fastest::compile(&self.shared.scheduled, self.shared.layout, None)?;
        let mut other = InProcess::with(self.shared.clone(), code);
        for (index, value) in self.parameters().iter().enumerate() {
            other.set_parameter(index, U::constant(value.to_f64()));
        }
        Ok(other)
    }
}

impl<T: Real, E: Engine<T>> InProcess<T, E> {
    /// The same mechanism in other numbers, interpreted, with the same parameters and the model file's inputs.
    pub fn interpreted<U: Scalar>(&self) -> Interpreted<U> {
        let engine = Interpreter::new(&self.shared.scheduled, self.shared.layout);
        let mut other = InProcess::with(self.shared.clone(), engine);
        for (index, value) in self.parameters().iter().enumerate() {
            other.set_parameter(index, U::constant(value.to_f64()));
        }
        other
    }
}
