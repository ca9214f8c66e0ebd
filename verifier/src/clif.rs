//! Whether the functions that Cranelift is given compute what a module computes: the same operations on the same
//! numbers, in the same order.
//!
//! They are read back from Cranelift's own text of them, by a reader that knows nothing of how they were made, and run
//! symbolically: loops over tables of constants round by round, addresses as places of arrays. What each function
//! stores must then be, operation for operation, what the module's function of this name gives. So what is proved of
//! the module holds of the machine code, as far as Cranelift translates it faithfully, and both round alike.

mod reader;

use crate::module::{Module, PARAMETER_SETUP};
use crate::nodes::Nodes;
use crate::program::{Id, Node, Program, Source};
use crate::refusal::Refusal;
use gyro_model::Model;
use gyro_program::{Given, Kernel, Signature, Space, State};
use reader::{Arrays, run};
use std::collections::HashMap;

/// A function that Cranelift compiles.
#[derive(Clone, Copy, Debug)]
pub struct Clif<'a> {
    /// Its name, that of the module's function.
    pub name: &'a str,
    /// Cranelift's text of it.
    pub text: &'a str,
    /// The constants of its loops: the numbers that its fourth address is that of.
    pub tables: &'a [f64],
}

/// The functions of a module, to compare others with.
///
/// A function that Cranelift compiles has the time and six addresses as arguments: of the state (maximal or joint), of
/// what is given with it (accelerations, changes of rows, charts), of the mechanism's own numbers (parameters, what
/// depends on them alone, inputs), of the constants of loops, of work space (curves of tables, three numbers each, then
/// whatever it keeps there itself) and of its results. It calls elementary functions by their places among all,
/// `u0:0` and so on, sine with cosine as the one after them, and then value and three derivatives of each table's
/// curve.
#[derive(Debug)]
pub struct Written {
    module: Module,
    n_bodies: usize,
    n_parameters: usize,
    n_inputs: usize,
}

/// Compares all functions that Cranelift is given with the text of the module of the same kernels. Returns their
/// number: that of the module's functions that compute anything.
///
/// # Errors
/// The first difference, or what in a text is not of the subset that is written, with its line.
pub fn same_in_clif(
    model: &Model,
    (module, constants): (&str, &str),
    functions: &[Clif<'_>],
) -> Result<usize, Refusal> {
    Written::read(model, module, constants)?.same(functions)
}

impl Written {
    /// Reads a module.
    ///
    /// # Errors
    /// What in its text is not as it must be.
    pub fn read(model: &Model, module: &str, constants: &str) -> Result<Self, Refusal> {
        let module = Module::read(model, module, constants)?;
        let n_bodies = model.coordinate_bodies().len();
        Ok(Self { module, n_bodies, n_parameters: model.parameters.len(), n_inputs: model.inputs.len() })
    }

    /// Compares all functions.
    ///
    /// # Errors
    /// As [`same_in_clif`].
    pub fn same(&self, functions: &[Clif<'_>]) -> Result<usize, Refusal> {
        for (name, program) in self.module.written.iter().filter(|(_, program)| !program.results.is_empty()) {
            let mut nodes = Nodes::default();
            let expected = nodes.of_program(program, &self.module);
            let is_there = functions.iter().any(|function| function.key() == *name);
            let stored = HashMap::new();
            if !is_there && self.compare(name, &nodes, (program, &expected), &stored).is_err() {
                return Err(Refusal::new(1, format!("there is no function `{name}`")));
            }
        }
        functions.iter().try_for_each(|function| self.same_function(function))?;
        Ok(functions.len())
    }

    /// Compares one function.
    ///
    /// # Errors
    /// As [`same_in_clif`].
    pub fn same_function(&self, function: &Clif<'_>) -> Result<(), Refusal> {
        let (name, written) = (&function.key()[..], &self.module.written);
        let unknown = || Refusal::new(1, format!("the module has no function `{name}`"));
        let program = written.get(name).ok_or_else(unknown)?;
        let signature = Kernel::named(name).ok_or_else(unknown)?.signature();
        let mut nodes = Nodes::default();
        let expected = nodes.of_program(program, &self.module);
        let arrays = Arrays {
            parameters: self.n_parameters,
            derived: written.get(PARAMETER_SETUP).map_or(0, |setup| setup.results.len()),
            inputs: self.n_inputs,
            curves: self.module.tables.len(),
            tables: function.tables,
            state: if signature.state == State::Joint { Source::Joint } else { Source::State },
            given: given(signature),
            before: before(signature),
        };
        let stored = run(&mut nodes, &arrays, function.text)
            .map_err(|refusal| Refusal { message: format!("`{name}`: {}", refusal.message), ..refusal })?;
        self.compare(name, &nodes, (program, &expected), &stored)
    }

    /// What is stored at the end must be what the module gives, each in its place; what is not stored must be what the
    /// caller hands on.
    fn compare(
        &self,
        name: &str,
        nodes: &Nodes,
        (program, expected): (&Program, &[Id]),
        stored: &HashMap<usize, (Id, usize)>,
    ) -> Result<(), Refusal> {
        let place = |n: usize| program.places.get(n).copied().unwrap_or(n);
        for (n, &expected) in expected.iter().enumerate() {
            let at = place(n);
            match stored.get(&at) {
                Some(&(value, _)) if value == expected => {}
                Some(&(_, line)) => {
                    return Err(Refusal::new(
                        line,
                        format!("`{name}`: number {at} is not what the module gives"),
                    ));
                }
                None if self
                    .handed_on(name, at)
                    .is_some_and(|of| nodes.nodes[expected] == Node::Read(of)) => {}
                None => return Err(Refusal::new(1, format!("`{name}` does not store number {at}"))),
            }
        }
        let n_stored = (0..expected.len()).filter(|&n| stored.contains_key(&place(n))).count();
        if n_stored < stored.len() {
            return Err(Refusal::new(1, format!("`{name}` stores more numbers than the module gives")));
        }
        Ok(())
    }

    /// What stands in a place of the results without the function's doing: accelerations, and the work.
    fn handed_on(&self, name: &str, place: usize) -> Option<Source> {
        let joints = self.module.joints.as_ref();
        let (n_motion, n_rates) = joints.map_or((0, 0), |joints| (joints.n_motion(), joints.n_rates));
        let of = |first: usize, n: usize| {
            (first..first + n).contains(&place).then(|| Source::Acceleration(place - first))
        };
        match name {
            "derivative" | "corrected_derivative" => of(7 * self.n_bodies, 6 * self.n_bodies),
            "joint_derivative" => of(n_motion - n_rates, n_rates),
            "to_maximal" => (place == 13 * self.n_bodies).then_some(Source::Joint(n_motion)),
            "to_joints" => (place == n_motion).then_some(Source::State(13 * self.n_bodies)),
            _ => None,
        }
    }
}

impl Clif<'_> {
    /// The module's name of it.
    fn key(&self) -> String {
        self.name.replace(' ', "_")
    }
}

/// What an element of what is given beside the state is.
fn given(signature: &Signature) -> fn(usize) -> Source {
    match signature.given {
        Given::Told(_, Space::Rows) => Source::Change,
        Given::Charts => |place| Source::Chart(place / 4, place % 4),
        _ => Source::Acceleration,
    }
}

/// What a function finds where it stores its results, if it may read that.
fn before(signature: &Signature) -> Option<fn(usize) -> Source> {
    match signature.overwritten()? {
        Space::State => Some(Source::State),
        _ => Some(Source::Joint),
    }
}
