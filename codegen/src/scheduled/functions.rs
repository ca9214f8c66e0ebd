//! Which functions a module has, how each comes about, and what it stores where.

use crate::equations::{Equations, PartitionForm};
use crate::kernels::Kernels;
use gyro_program::{Counts, Given, Group, Kernel, Outcome, Signature, State};

/// How a function comes about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Its kernel computes what it stores; there is none where nothing is to be computed.
    Kernel,
    /// There is nothing of what it would write.
    Idle,
    /// It is this other function, of whose results it gives the first.
    Other(Kernel),
}

/// A number that a function stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Store {
    /// The array, by the name of the argument; `out` for what is returned.
    pub array: &'static str,
    /// Its place there.
    pub place: usize,
    /// What is stored.
    pub value: Stored,
}

/// What is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stored {
    /// This one of the kernel's results.
    Result(usize),
    /// An element of what the function that is called first has filled, or of an argument.
    Element(&'static str, usize),
}

/// The groups of functions that a mechanism has, in the order of a module's text.
pub fn groups(equations: &Equations, kernels: &Kernels) -> Vec<Group> {
    Group::in_text().filter(|&group| has(equations, kernels, group)).collect()
}

/// Whether a group is asked for, and the mechanism has it.
fn has(e: &Equations, kernels: &Kernels, group: Group) -> bool {
    let Some(space) = &e.joint_space else {
        // Accelerations at corrected states are then those at any state.
        let needs_joints = group.with_needs().contains(&Group::Joint) && group != Group::Corrected;
        return e.functions.has(group) && !needs_joints;
    };
    let has_outputs = !kernels.roots(Kernel::JointOutputs).is_empty();
    match group {
        Group::Joint => true,
        Group::Jacobian => space.jacobian.is_some(),
        Group::ParameterJacobian => space.parameter_jacobian.is_some(),
        Group::JointOutputs => has_outputs,
        Group::OutputDerivatives => has_outputs && space.output_derivatives.is_some(),
        Group::Frames => space.frames.is_some(),
        group if Group::on_request().any(|other| other == group) => {
            space.on_request.forms.keys().any(|kernel| kernel.group() == group)
        }
        group => e.functions.has(group),
    }
}

/// How a function of such a group comes about; nothing where what every mechanism has serves.
pub fn origin(equations: &Equations, kernels: &Kernels, kernel: Kernel) -> Option<Origin> {
    let is_empty = kernels.roots(kernel).is_empty();
    let has_loops = equations.counts().closure > 0;
    match kernel {
        Kernel::ParameterSetup => (!is_empty).then_some(Origin::Kernel),
        Kernel::LoopClosure | Kernel::ClosureDistances | Kernel::ClosePositions | Kernel::CloseVelocities => {
            has_loops.then_some(Origin::Kernel)
        }
        Kernel::ChartVectors | Kernel::NewtonStep | Kernel::SolveVelocities => {
            (equations.partition_form() == PartitionForm::Charts).then_some(Origin::Kernel)
        }
        Kernel::CorrectedAccelerations if equations.joint_space.is_none() => {
            Some(Origin::Other(Kernel::Accelerations))
        }
        Kernel::CorrectedDerivative if is_empty => Some(Origin::Other(Kernel::Derivative)),
        Kernel::Outputs | Kernel::JointInputJacobian | Kernel::JointParameterJacobian if is_empty => {
            Some(Origin::Idle)
        }
        _ => Some(Origin::Kernel),
    }
}

/// What a function stores, array for array in the order of the places. `places` are those of its kernel's results, if
/// these are not all that it stores, and `n` is how many of them there are.
pub fn stores(signature: &Signature, counts: &Counts, places: &[usize], n: usize) -> Vec<Store> {
    let result = |array, place, n| Store { array, place, value: Stored::Result(n) };
    let in_order = |array| (0..n).map(move |n| result(array, n, n));
    match signature.result {
        Outcome::Energies | Outcome::Vectors | Outcome::Derived => in_order("out").collect(),
        Outcome::FillsTwo([(first, space), (second, _)]) => {
            let len = space.len(counts);
            (0..n).map(|n| if n < len { result(first, n, n) } else { result(second, n - len, n) }).collect()
        }
        Outcome::Overwrites => {
            let (state, _) = signature.state.argument().expect("it overwrites a state");
            places.iter().zip(0..n).map(|(&place, n)| result(state, place, n)).collect()
        }
        Outcome::Fills(array, _) if places.is_empty() => in_order(array).collect(),
        Outcome::Fills(array, space) => {
            let mut own = places.iter().zip(0..n).peekable();
            let mut handed_on = 0..;
            let mut value = |place| match own.next_if(|(own, _)| **own == place) {
                Some((_, n)) => Stored::Result(n),
                None => handed_on_to(signature, counts, handed_on.next().unwrap_or(0)),
            };
            (0..space.len(counts)).map(|place| Store { array, place, value: value(place) }).collect()
        }
        Outcome::Renews(array, _) => {
            let work = (counts.work > 0 && signature.kernel == Kernel::ToJoints).then(|| {
                let [joint, maximal] = places_of_work(counts);
                Store { array, place: joint, value: Stored::Element("y", maximal) }
            });
            in_order(array).chain(work).collect()
        }
    }
}

/// The nth of the numbers that a function does not compute: accelerations that another one has, or the work.
fn handed_on_to(signature: &Signature, counts: &Counts, n: usize) -> Stored {
    match (signature.given, signature.state) {
        (Given::HandedOn(buffer, _), _) => Stored::Element(buffer, n),
        (_, State::Joint) => Stored::Element("x", places_of_work(counts)[0]),
        _ => unreachable!("all other numbers are its own"),
    }
}

/// Where the work stands that passes from one state into the other: in the joint state, and in the maximal one.
fn places_of_work(counts: &Counts) -> [usize; 2] {
    [counts.coordinates + counts.rates, 13 * counts.bodies]
}
