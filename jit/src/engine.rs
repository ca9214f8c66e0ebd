//! What computes the kernels of a mechanism.

use gyro_codegen::{Argument, Kernel, Scheduled, ScheduledKernel, Variable};
use gyro_model::Spline;
use gyro_program::Space;
use gyro_sim::Scalar;
use std::fmt::{self, Debug};

/// Computes kernels, whichever way, in numbers `T`.
pub trait Engine<T>: Clone + Debug {
    /// Computes a kernel; one that the mechanism does not have writes nothing.
    fn compute(&self, scheduled: &Scheduled, kernel: Kernel, arguments: Arguments<'_, T>);
}

/// What a kernel reads and where it stores.
#[derive(Debug)]
pub struct Arguments<'a, T> {
    /// The time, s.
    pub t: T,
    /// The maximal or the joint state; not read by kernels that overwrite it.
    pub state: &'a [T],
    /// Accelerations, changes of rows, or charts.
    pub given: &'a [T],
    /// Parameters, what depends on them alone, and inputs.
    pub own: &'a [T],
    /// Results; of kernels that overwrite part of a state that state.
    pub out: &'a mut [T],
}

/// A kernel on its way to machine code: what a proof is about.
#[derive(Debug)]
pub struct Input<'a> {
    /// Which one it is.
    pub kernel: Kernel,
    /// The function that Cranelift compiles, as text.
    pub clif: String,
    /// All constants of loops up to here, which functions read by their places.
    pub tables: &'a [f64],
}

/// Why there is no machine code.
#[derive(Debug)]
pub struct NotCompiled(pub(crate) String);

impl fmt::Display for NotCompiled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the functions cannot be compiled in this process: {}", self.0)
    }
}

impl std::error::Error for NotCompiled {}

/// Where numbers of a mechanism stand in memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layout {
    /// Where in a mechanism's own numbers those begin that depend on parameters alone.
    pub(crate) first_derived: usize,
    /// Where inputs begin.
    pub(crate) first_input: usize,
}

/// An array that kernels read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Array {
    State,
    Given,
    Own,
    /// Constants of loops, which machine code reads.
    #[cfg_attr(not(feature = "machine-code"), expect(dead_code, reason = "tapes hold them"))]
    Tables,
    /// Curves of tables, three numbers each, then the arrays of loops.
    Work,
    Out,
}

impl Layout {
    pub(crate) fn of(scheduled: &Scheduled, n_parameters: usize) -> Self {
        let setup = scheduled.kernels.get(&Kernel::ParameterSetup);
        let n_derived = setup.map_or(0, |kernel| kernel.tape.results.len());
        Self { first_derived: n_parameters, first_input: n_parameters + n_derived }
    }

    /// Array and place of a variable outside of loops; `None` for the time.
    pub(crate) fn place(self, shape: &Shape, variable: Variable) -> Option<(Array, usize)> {
        Some(match variable {
            Variable::Element(argument, place) => (shape.array(argument), place),
            Variable::Chart(place) => (Array::Given, place),
            Variable::Parameter(place) => (Array::Own, place),
            Variable::ParameterSetup(place) => (Array::Own, self.first_derived + place),
            Variable::Input(place) => (Array::Own, self.first_input + place),
            Variable::Curve { table, order } => (Array::Work, 3 * table + order),
            Variable::Kept { array, row, column } => (Array::Work, shape.kept(array, row, column)),
            _ => return None,
        })
    }
}

/// Where the numbers of a kernel stand.
#[derive(Clone, Debug)]
pub(crate) struct Shape {
    /// Where each array of loops begins in the work space, and how many columns it has.
    arrays: Vec<(usize, usize)>,
    /// Length of the work space.
    pub(crate) n_work: usize,
    /// The argument that the results take the place of.
    overwritten: Option<Argument>,
}

impl Shape {
    pub(crate) fn of(scheduled: &Scheduled, kernel: Kernel) -> Self {
        let mut n_work = 3 * scheduled.curves.len();
        let mut arrays = Vec::new();
        for shape in &scheduled.kernels[&kernel].tape.arrays {
            arrays.push((n_work, shape.columns));
            n_work += shape.rows * shape.columns;
        }
        let overwritten = kernel.signature().overwritten().map(|space| match space {
            Space::State => Argument::State,
            _ => Argument::Joints,
        });
        Self { arrays, n_work, overwritten }
    }

    /// Whether results take the place of what is read.
    #[cfg(feature = "machine-code")]
    pub(crate) fn is_overwritten(&self) -> bool {
        self.overwritten.is_some()
    }

    pub(crate) fn array(&self, argument: Argument) -> Array {
        match argument {
            argument if self.overwritten == Some(argument) => Array::Out,
            Argument::State | Argument::Joints => Array::State,
            Argument::Accelerations | Argument::Rows => Array::Given,
        }
    }

    /// Place of an element of an array of loops.
    pub(crate) fn kept(&self, array: usize, row: usize, column: usize) -> usize {
        let (first, columns) = self.arrays[array];
        first + row * columns + column
    }

    /// Columns of an array of loops.
    #[cfg(feature = "machine-code")]
    pub(crate) fn columns(&self, array: usize) -> usize {
        self.arrays[array].1
    }
}

/// Whether a kernel reads curves of tables.
pub(crate) fn reads_curves(scheduled: &Scheduled, kernel: Kernel) -> bool {
    let mut variables = scheduled.kernels.get(&kernel).into_iter().flat_map(ScheduledKernel::variables);
    variables.any(|variable| matches!(variable, Variable::Curve { .. }))
}

/// Whether a kernel reads accelerations or rates' rates.
pub(crate) fn reads_given(scheduled: &Scheduled, kernel: Kernel) -> bool {
    scheduled.kernels.get(&kernel).is_some_and(|kernel| kernel.reads(Argument::Accelerations))
}

/// Writes the curves of all tables at a time: value and two derivatives each.
pub(crate) fn write_curves<T: Scalar>(scheduled: &Scheduled, t: T, out: &mut [T]) {
    for (curve, out) in scheduled.curves.iter().zip(out.as_chunks_mut::<3>().0) {
        *out = t.spline(&curve.knots, &curve.pieces);
    }
}

/// A derivative of a curve by its order: the value is of order zero, and derivatives after the third one are zero.
pub(crate) fn curve<T: Scalar>(curve: &Spline, order: usize, x: T) -> T {
    match x.spline(&curve.knots, &curve.pieces).get(order) {
        Some(&derivative) => derivative,
        None if order == 3 => x.spline_third(&curve.knots, &curve.pieces),
        None => T::constant(0.0),
    }
}
