//! The arrays that functions read and write: the associated types of the contract's traits, and how long they are.

use crate::groups::Group;

/// How many things of each kind a mechanism has: all that lengths of arrays depend on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Bodies with coordinates.
    pub bodies: usize,
    /// Rows of joints, couplers and drivers.
    pub rows: usize,
    /// One if the state carries the work of non-conservative forces.
    pub work: usize,
    /// States of one's own.
    pub states: usize,
    /// Angles whose turns are counted.
    pub turns: usize,
    /// Numbers that are read off joints.
    pub readings: usize,
    /// Numbers of outputs.
    pub outputs: usize,
    /// Outputs that are frames.
    pub frames: usize,
    /// Inputs.
    pub inputs: usize,
    /// Parameters.
    pub parameters: usize,
    /// Non-zeros of Φ_q.
    pub phi_q: usize,
    /// Non-zeros of (Φ_r, Φ_π').
    pub phi_pi: usize,
    /// Accelerations with the multipliers that are found with them.
    pub accelerations: usize,
    /// Joint coordinates.
    pub coordinates: usize,
    /// Their rates.
    pub rates: usize,
    /// Rows that close loops.
    pub closure: usize,
}

/// An associated type of the contract.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the traits of `gyro-sim` say what each of them is")]
pub enum Space {
    State,
    Rows,
    Constraints,
    Velocities,
    Readings,
    Outputs,
    PhiQ,
    PhiPi,
    Accelerations,
    Joints,
    Rates,
    Closure,
    Solution,
    Jacobian,
    InputJacobian,
    ParameterJacobian,
    ByState,
    ByAccelerations,
    ByInputs,
    ByParameters,
    FrameJacobians,
    FrameBiases,
    MassMatrix,
    InverseDerivatives,
    ForwardDerivatives,
    Regressor,
}

/// What is known of a type: its name, the group whose trait declares it, its length.
struct Row(Space, &'static str, Group, fn(&Counts) -> usize);

/// All types, a row for each variant of [`Space`] in the same order.
#[rustfmt::skip]
const TABLE: &[Row] = &[
    Row(Space::State, "State", Group::Mechanism, |n| 13 * n.bodies + n.work + n.states + n.turns),
    Row(Space::Rows, "Rows", Group::Mechanism, |n| n.rows),
    Row(Space::Constraints, "Constraints", Group::Mechanism, |n| n.rows + n.bodies),
    Row(Space::Velocities, "Velocities", Group::Mechanism, |n| 6 * n.bodies),
    Row(Space::Readings, "Readings", Group::Mechanism, |n| n.readings),
    Row(Space::Outputs, "Outputs", Group::Mechanism, |n| n.outputs),
    Row(Space::PhiQ, "PhiQ", Group::Kinematics, |n| n.phi_q),
    Row(Space::PhiPi, "PhiPi", Group::Kinematics, |n| n.phi_pi),
    Row(Space::Accelerations, "Accelerations", Group::Maximal, |n| n.accelerations),
    Row(Space::Joints, "Joints", Group::Joint, |n| n.coordinates + n.rates + n.work),
    Row(Space::Rates, "Rates", Group::Joint, |n| n.rates),
    Row(Space::Closure, "Closure", Group::Joint, |n| n.closure),
    Row(Space::Solution, "Solution", Group::Reactions, |n| 6 * n.bodies + n.rows),
    Row(Space::Jacobian, "Jacobian", Group::Jacobian, |n| Space::Joints.len(n) * Space::Joints.len(n)),
    Row(Space::InputJacobian, "InputJacobian", Group::Jacobian, |n| Space::Joints.len(n) * n.inputs),
    Row(Space::ParameterJacobian, "ParameterJacobian", Group::ParameterJacobian, |n| Space::Joints.len(n) * n.parameters),
    Row(Space::ByState, "ByState", Group::OutputDerivatives, |n| n.outputs * (n.coordinates + n.rates)),
    Row(Space::ByAccelerations, "ByAccelerations", Group::OutputDerivatives, |n| n.outputs * n.rates),
    Row(Space::ByInputs, "ByInputs", Group::OutputDerivatives, |n| n.outputs * n.inputs),
    Row(Space::ByParameters, "ByParameters", Group::OutputDerivatives, |n| n.outputs * n.parameters),
    Row(Space::FrameJacobians, "FrameJacobians", Group::Frames, |n| 6 * n.frames * n.rates),
    Row(Space::FrameBiases, "FrameBiases", Group::Frames, |n| 6 * n.frames),
    Row(Space::MassMatrix, "MassMatrix", Group::MassMatrix, |n| n.rates * n.rates),
    Row(Space::InverseDerivatives, "InverseDerivatives", Group::Derivatives, |n| 2 * n.rates * n.rates),
    Row(Space::ForwardDerivatives, "ForwardDerivatives", Group::Derivatives, |n| 3 * n.rates * n.rates),
    Row(Space::Regressor, "Regressor", Group::Regressor, |n| 10 * n.rates * n.bodies),
];

const _: () = {
    let mut place = 0;
    while place < TABLE.len() {
        assert!(TABLE[place].0 as usize == place, "the table has the order of the variants");
        place += 1;
    }
};

impl Space {
    /// The types that the trait of a group declares, in their order.
    pub fn of(group: Group) -> impl Iterator<Item = Self> {
        TABLE.iter().filter(move |row| row.2 == group).map(|row| row.0)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        TABLE[self as usize].1
    }

    /// The group whose trait declares it.
    pub fn group(self) -> Group {
        TABLE[self as usize].2
    }

    /// How many numbers it holds.
    pub fn len(self, counts: &Counts) -> usize {
        TABLE[self as usize].3(counts)
    }

    /// Whether an empty one is written `[]`, which most mechanisms have.
    pub fn is_bare_if_empty(self) -> bool {
        self == Self::Closure || self.group() == Group::OutputDerivatives
    }
}

/// A function that gives buffers, zeroed.
#[derive(Clone, Copy, Debug)]
pub struct Buffer {
    /// Its name.
    pub function: &'static str,
    /// The struct that it returns, whose fields these are; where there is none, it returns a single buffer.
    pub returns: Option<&'static str>,
    /// The buffers, by the names of the fields.
    pub fields: &'static [(&'static str, Space)],
}

const fn several(
    function: &'static str,
    returns: &'static str,
    fields: &'static [(&'static str, Space)],
) -> Buffer {
    Buffer { function, returns: Some(returns), fields }
}

const fn single(function: &'static str, field: &'static [(&'static str, Space); 1]) -> Buffer {
    Buffer { function, returns: None, fields: field }
}

/// All of them, by the groups whose traits have them.
#[rustfmt::skip]
const BUFFERS: &[(Group, Buffer)] = &[
    (Group::Mechanism, several("buffers", "Buffers", &[("rows", Space::Rows), ("constraints", Space::Constraints), ("velocities", Space::Velocities), ("readings", Space::Readings), ("outputs", Space::Outputs)])),
    (Group::Kinematics, several("terms", "Terms", &[("phi_q", Space::PhiQ), ("phi_pi", Space::PhiPi)])),
    (Group::Maximal, single("acceleration_buffer", &[("", Space::Accelerations)])),
    (Group::Reactions, single("solution_buffer", &[("", Space::Solution)])),
    (Group::Joint, several("joint_buffers", "JointBuffers", &[("rates", Space::Rates), ("closure", Space::Closure)])),
    (Group::Jacobian, several("jacobian_buffers", "JacobianBuffers", &[("jacobian", Space::Jacobian), ("input_jacobian", Space::InputJacobian)])),
    (Group::ParameterJacobian, single("parameter_buffer", &[("", Space::ParameterJacobian)])),
    (Group::OutputDerivatives, several("output_slopes", "OutputSlopes", &[("by_state", Space::ByState), ("by_accelerations", Space::ByAccelerations), ("by_inputs", Space::ByInputs), ("by_parameters", Space::ByParameters)])),
    (Group::Frames, several("frame_buffers", "FrameBuffers", &[("jacobians", Space::FrameJacobians), ("biases", Space::FrameBiases)])),
    (Group::MassMatrix, single("mass_buffer", &[("", Space::MassMatrix)])),
    (Group::Derivatives, single("inverse_buffer", &[("", Space::InverseDerivatives)])),
    (Group::Derivatives, single("forward_buffer", &[("", Space::ForwardDerivatives)])),
    (Group::Regressor, single("regressor_buffer", &[("", Space::Regressor)])),
];

impl Buffer {
    /// Those of a group's trait.
    pub fn of(group: Group) -> impl Iterator<Item = &'static Self> {
        BUFFERS.iter().filter(move |(of, _)| *of == group).map(|(_, buffer)| buffer)
    }
}
