//! A mechanism as data: its kernels as tapes, and what solvers have to know of them. The text of a module is written
//! from this, and whoever compiles or interprets kernels by other means works from the same operations.

mod functions;
mod indices;

pub use functions::{Origin, Store, Stored};
pub use indices::Index;

use functions::{groups, origin, stores};
use indices::indices;

use crate::equations::{Argument, Equations, PartitionForm};
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Node};
use crate::expr::schedule::Operations;
use crate::expr::symbol::Symbol;
use crate::groups::Functions;
use crate::joint_space::JointSpace;
use crate::kernels::Kernels;
use crate::repeat::{self, Local, Repetition};
use crate::tape;
use gyro_model::{Attachment, JointCoordinate, Model, Spline, Start};
use gyro_program::{Counts, Given, Group, Kernel, Space};
use std::collections::BTreeMap;

/// A number that a kernel reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Variable {
    /// t.
    Time,
    /// An element of an argument.
    Element(Argument, usize),
    /// Of the charts' unit four-vectors one number, by its place among all of them.
    Chart(usize),
    /// A parameter.
    Parameter(usize),
    /// A number that [`Kernel::ParameterSetup`] gives.
    ParameterSetup(usize),
    /// An input.
    Input(usize),
    /// Value (order 0) or a derivative of a table's curve at t.
    Curve {
        /// Which table.
        table: usize,
        /// Which derivative.
        order: usize,
    },
    /// An element of an array that a loop fills: outside of loops, or of what the part before has left.
    Kept {
        /// Which array.
        array: usize,
        /// Its row.
        row: usize,
        /// Its column.
        column: usize,
    },
    /// In a loop: an entry of its table, in the row of the part.
    Factor(usize),
    /// In a loop: an element of an array, so many rows after that of the part's number.
    Row {
        /// Which array.
        array: usize,
        /// So many rows after.
        offset: usize,
        /// Its column.
        column: usize,
    },
    /// In a loop: an element of an argument, so many apart from part to part.
    Strided {
        /// Which argument.
        argument: Argument,
        /// The element of part zero.
        first: usize,
        /// How far apart they are.
        stride: usize,
    },
    /// In a loop: a number that is the same for all parts, as [`tape::Loop::fixed`] numbers them.
    Fixed(usize),
}

/// A kernel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScheduledKernel {
    /// What it computes. Constants are rounded.
    pub tape: tape::Kernel<Variable, f64>,
    /// Where each result stands in what the function of this name writes, whose other elements it keeps or computes by
    /// other means; empty where results stand one after the other.
    pub places: Vec<usize>,
    /// Operations that it does.
    pub operations: Operations,
}

/// A kernel as a module's text has it: with exact constants.
#[derive(Debug, Default)]
pub struct ExactKernel {
    pub tape: tape::Kernel<Symbol, Constant>,
    /// As those of [`ScheduledKernel`].
    pub places: Vec<usize>,
    pub operations: Operations,
    /// How it is written if it has loops.
    pub repetition: Option<Repetition>,
}

/// What a module computes.
#[derive(Debug)]
pub struct Computed<'m> {
    pub equations: Equations<'m>,
    /// Its kernels as expressions, in final form.
    pub kernels: Kernels,
    /// The same as tapes.
    pub exact: BTreeMap<Kernel, ExactKernel>,
}

/// What a place of a joint state is, in indices of the model and of the bodies that have coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs, reason = "gyro-sim documents its type of this name")]
pub enum JointPlace {
    Scalar { joint: usize, coordinate: usize },
    Orientation { joint: usize },
    Body { body: usize },
    Turn { joint: usize, coordinate: usize },
    State { state: usize },
}

/// What there is in joint coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct JointForm {
    /// Length of x.
    pub n_coordinates: usize,
    /// Length of u.
    pub n_rates: usize,
    /// What stands in x and u.
    pub places: Vec<JointPlace>,
    /// The rows of joints that close loops.
    pub closure_rows: Vec<usize>,
    /// The joint state at the start.
    pub start: Vec<f64>,
}

/// A mechanism as data.
#[derive(Clone, Debug)]
pub struct Scheduled {
    /// What was asked for, and what this needs.
    pub functions: Functions,
    /// Its kernels. What computes nothing is not there.
    pub kernels: BTreeMap<Kernel, ScheduledKernel>,
    /// The groups of functions that it has, in the order of a module's text.
    pub groups: Vec<Group>,
    /// How each of their functions comes about; what serves every mechanism is not there.
    pub origins: BTreeMap<Kernel, Origin>,
    /// Where numbers stand, by name.
    pub indices: Vec<Index>,
    /// How many things of each kind the mechanism has.
    pub counts: Counts,
    /// How the partition goes, where it is asked for.
    pub partition: PartitionForm,
    /// Row and column of each number of Φ_q.
    pub phi_q_pattern: Vec<(usize, usize)>,
    /// Row and column of each number of (Φ_r, Φ_π').
    pub phi_pi_pattern: Vec<(usize, usize)>,
    /// The maximal state at the start.
    pub start: Vec<f64>,
    /// Joint coordinates, if they are asked for and describe the mechanism.
    pub joint: Option<JointForm>,
    /// The rates in the order of which the factor of the mass matrix is triangular, if it is asked for.
    pub mass_order: Vec<usize>,
    /// Tables of motions.
    pub curves: Vec<Spline>,
}

impl Scheduled {
    pub(crate) fn of(computed: &Computed, start: &Start) -> Self {
        let Computed { equations: e, kernels, exact } = computed;
        let pattern = |sparse: &crate::equations::Sparse| {
            sparse.0.iter().map(|&(row, column, _)| (row, column)).collect()
        };
        let groups = groups(e, kernels);
        let functions = groups.iter().flat_map(|&group| Kernel::of(group));
        Self {
            functions: e.functions.clone(),
            kernels: exact.iter().map(|(&kernel, exact)| (kernel, exact.rounded(e))).collect(),
            origins: functions.filter_map(|kernel| Some((kernel, origin(e, kernels, kernel)?))).collect(),
            groups,
            indices: indices(e),
            counts: e.counts(),
            partition: e.partition_form(),
            phi_q_pattern: pattern(&e.phi_q),
            phi_pi_pattern: pattern(&e.phi_pi),
            start: self::start(e.model, start),
            joint: e.joint_space.as_ref().map(|space| JointForm::of(e, space)),
            mass_order: e
                .joint_space
                .as_ref()
                .map_or(Vec::new(), |space| space.on_request.mass_order.clone()),
            curves: e.tables.iter().map(|&table| table.clone()).collect(),
        }
    }

    /// How many numbers an array holds: none where the mechanism does not have its group.
    pub fn len(&self, space: Space) -> usize {
        if self.groups.contains(&space.group()) { space.len(&self.counts) } else { 0 }
    }

    /// How many results a kernel has.
    pub fn n_results(&self, kernel: Kernel) -> usize {
        self.kernels.get(&kernel).map_or(0, |kernel| kernel.tape.results.len())
    }

    /// What a function with a kernel of its own stores.
    pub fn stores(&self, kernel: Kernel) -> Vec<Store> {
        let places = self.kernels.get(&kernel).map_or(&[][..], |kernel| &kernel.places);
        stores(kernel.signature(), &self.counts, places, self.n_results(kernel))
    }

    /// The function that is called before a kernel is computed, and what the array is called that it fills.
    pub fn called_first(&self, kernel: Kernel) -> Option<(&'static str, Kernel)> {
        let reads = || self.kernels.get(&kernel).is_some_and(|kernel| kernel.reads(Argument::Accelerations));
        match kernel.signature().given {
            Given::HandedOn(buffer, first) => Some((buffer, first)),
            Given::First(buffer, first) if reads() => Some((buffer, first)),
            _ => None,
        }
    }
}

impl ScheduledKernel {
    /// The variables that it reads, as often as it reads them.
    pub fn variables(&self) -> impl Iterator<Item = &Variable> {
        let bodies = self.tape.loops.iter().map(|each| &each.body);
        [&self.tape.outside].into_iter().chain(bodies).flat_map(tape::Tape::variables)
    }

    /// Whether it reads an argument.
    pub fn reads(&self, argument: Argument) -> bool {
        self.variables().any(|variable| match variable {
            Variable::Element(of, _) | Variable::Strided { argument: of, .. } => *of == argument,
            _ => false,
        })
    }
}

impl<'m> Computed<'m> {
    pub fn of(mut equations: Equations<'m>) -> Self {
        let mut kernels = Kernels::of(&equations);
        kernels.finish(&mut equations.graph, equations.passes);
        let exact = |(kernel, _)| (kernel, ExactKernel::of(&equations, &kernels, kernel));
        let exact = kernels.iter().map(exact).collect();
        Self { equations, kernels, exact }
    }
}

impl ExactKernel {
    fn of(equations: &Equations, kernels: &Kernels, kernel: Kernel) -> Self {
        let (places, roots) = written(equations, kernels, kernel);
        let (tape, repetition) = tape(equations, &roots);
        let operations = repetition
            .map_or_else(|| Operations::count(&equations.graph, &roots), |repetition| repetition.operations);
        Self { tape, places, operations, repetition }
    }

    fn rounded(&self, equations: &Equations) -> ScheduledKernel {
        let (places, operations) = (self.places.clone(), self.operations);
        ScheduledKernel { tape: rounded(equations, &self.tape), places, operations }
    }
}

impl JointForm {
    fn of(equations: &Equations, space: &JointSpace) -> Self {
        let work = equations.power.map(|_| 0.0);
        let start: Vec<f64> = space.start.iter().copied().chain(work).collect();
        Self {
            n_coordinates: space.layout.n_coordinates,
            n_rates: space.layout.n_rates,
            places: places(equations.model, space),
            closure_rows: space.closure_rows.clone(),
            start,
        }
    }
}

/// What a kernel writes, with its places in the state if these are not all of them.
fn written(equations: &Equations, kernels: &Kernels, kernel: Kernel) -> (Vec<usize>, Vec<ExprId>) {
    use Kernel::{
        ClosePositions, CloseVelocities, CorrectedDerivative, Derivative, JointDerivative, NewtonStep,
        SolveVelocities, ToMaximal,
    };
    let roots = kernels.roots(kernel);
    let without = |from: usize, n: usize| (0..from).chain(from + n..).zip(roots.iter().copied()).unzip();
    let n_bodies = equations.n_moving_bodies();
    let n_rates = equations.joint_space.as_ref().map_or(0, |space| space.layout.n_rates);
    match kernel {
        NewtonStep | SolveVelocities | ClosePositions | CloseVelocities => stored(equations, kernel, roots),
        Derivative | CorrectedDerivative => without(7 * n_bodies, 6 * n_bodies),
        JointDerivative => without(equations.n_coordinates(), n_rates),
        ToMaximal => without(13 * n_bodies, usize::from(equations.power.is_some())),
        _ => (Vec::new(), roots.to_vec()),
    }
}

/// The tape of a kernel, and how it is written if it has loops.
fn tape(equations: &Equations, roots: &[ExprId]) -> (tape::Kernel<Symbol, Constant>, Option<Repetition>) {
    let element = |symbol| equations.element(symbol);
    match repeat::rolled(&equations.graph, roots, &element, equations.effort) {
        Some(rolled) => (tape::looped(&rolled), Some(rolled.repetition())),
        None => (tape::straight(&equations.graph, roots), None),
    }
}

/// What a kernel that overwrites part of a state stores, by its place there: what keeps its value is not stored again.
fn stored(equations: &Equations, kernel: Kernel, roots: &[ExprId]) -> (Vec<usize>, Vec<ExprId>) {
    let (argument, first) = match kernel {
        Kernel::NewtonStep => (Argument::State, 0),
        Kernel::SolveVelocities => (Argument::State, 7 * equations.n_moving_bodies()),
        Kernel::CloseVelocities => (Argument::Joints, equations.n_coordinates()),
        _ => (Argument::Joints, 0),
    };
    let keeps = |place: usize, root: ExprId| match equations.graph.node(root) {
        Node::Symbol(symbol) => equations.element(*symbol) == Some((argument, place)),
        _ => false,
    };
    (first..).zip(roots.iter().copied()).filter(|&(place, root)| !keeps(place, root)).unzip()
}

/// The maximal state at the start, without work so far.
fn start(model: &Model, start: &Start) -> Vec<f64> {
    let work = model.has_work().then_some(0.0);
    let turns = model.turn_references();
    let turns = turns.iter().map(|turn| start.joints[turn.joint].position[turn.coordinate]);
    let states = start.states.iter().copied();
    start.q.iter().chain(&start.v).copied().chain(work).chain(states).chain(turns).collect()
}

/// What stands where in a joint state.
fn places(model: &Model, space: &JointSpace) -> Vec<JointPlace> {
    let bodies = model.coordinate_bodies();
    let mut places = Vec::new();
    for link in &space.layout.links {
        for scalar in link.scalars.iter().filter(|scalar| scalar.place.x < space.layout.n_coordinates) {
            let (joint, coordinate) = (scalar.coordinate.joint, scalar.coordinate.coordinate);
            places.push((scalar.place.x, JointPlace::Scalar { joint, coordinate }));
        }
        let Some(place) = link.orientation else { continue };
        let place = match (link.link.attachment, link.position) {
            (Attachment::Joint { joint, .. }, _) => (place.x, JointPlace::Orientation { joint }),
            (_, position) => {
                let body = bodies.iter().position(|&body| body == link.link.body);
                let body = body.expect("it has coordinates");
                (position.expect("nothing else holds it").x, JointPlace::Body { body })
            }
        };
        places.push(place);
    }
    for &(JointCoordinate { joint, coordinate }, x) in &space.layout.turns {
        places.push((x, JointPlace::Turn { joint, coordinate }));
    }
    let states = space.layout.states().enumerate();
    places.extend(states.map(|(state, x)| (x, JointPlace::State { state })));
    places.sort_by_key(|(x, _)| *x);
    places.into_iter().map(|(_, place)| place).collect()
}

/// The same tape with rounded constants, its variables by their places.
fn rounded(equations: &Equations, kernel: &tape::Kernel<Symbol, Constant>) -> tape::Kernel<Variable, f64> {
    let outside = |symbol: &Symbol| variable(equations, *symbol);
    kernel.map(outside, |locals, symbol| match *symbol {
        Symbol::Local(place) => local(equations, &locals[place]),
        symbol => variable(equations, symbol),
    })
}

fn local(equations: &Equations, local: &Local) -> Variable {
    match *local {
        Local::Factor(column) => Variable::Factor(column),
        Local::Row { array, offset, column } => Variable::Row { array, offset, column },
        Local::Carried { array, column } => Variable::Kept { array, row: 0, column },
        Local::Element { first, stride } => {
            let (argument, first) = equations.element(first).expect("it is an element of an argument");
            Variable::Strided { argument, first, stride }
        }
        Local::Fixed(number) => Variable::Fixed(number),
    }
}

fn variable(equations: &Equations, symbol: Symbol) -> Variable {
    match symbol {
        Symbol::Time => Variable::Time,
        Symbol::Chart { chart, k } => Variable::Chart(4 * chart + k),
        Symbol::Parameter(parameter) => Variable::Parameter(parameter),
        Symbol::ParameterSetup(place) => Variable::ParameterSetup(place),
        Symbol::Input(input) => Variable::Input(input),
        Symbol::Table { table, order } => Variable::Curve { table, order },
        Symbol::Entry { array, row, column } => Variable::Kept { array, row, column },
        symbol => {
            let (argument, place) =
                equations.element(symbol).expect("nothing else is left of expanded kernels");
            Variable::Element(argument, place)
        }
    }
}
