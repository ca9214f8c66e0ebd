//! The functions that fill arrays from time, state and what is given with it, and the buffers for them, by trait. Their
//! names and arguments are those of the contract; what else there is to know, the tables of `gyro_program` know.

use crate::engine::Engine;
use crate::mechanism::InProcess;
use gyro_program::{Kernel, Space};
use gyro_sim::{
    CorrectedSolution, DynamicsDerivatives, FrameBuffers, Frames, InverseDynamics, Kinematics, MassMatrix,
    OutputDerivatives, OutputSlopes, ParameterJacobian, Projection, Regressor, Scalar, Terms,
};

/// Functions, an arm each: `name: kernel, arguments`.
macro_rules! functions {
    ($($name:ident: $kernel:ident, $state:ident $(+ $given:ident)?;)*) => {$(
        fn $name(&self, t: T, $state: &Vec<T>, $($given: &Vec<T>,)? out: &mut Vec<T>) {
            self.compute(Kernel::$kernel, t, ($state, functions!(@ $($given)?)), out);
        }
    )*};
    (@) => { &[] };
    (@ $given:ident) => { $given };
}
pub(super) use functions;

/// A function that gives one buffer.
macro_rules! buffer {
    ($name:ident: $space:ident) => {
        fn $name(&self) -> Vec<T> {
            self.buffer(Space::$space)
        }
    };
}
pub(super) use buffer;

impl<T: Scalar, E: Engine<T>> Kinematics for InProcess<T, E> {
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;

    fn terms(&self) -> Terms<Self> {
        Terms { phi_q: self.buffer(Space::PhiQ), phi_pi: self.buffer(Space::PhiPi) }
    }

    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        &self.shared.phi_q_pattern
    }

    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        &self.shared.phi_pi_pattern
    }

    functions! { phi_q: PhiQ, y; phi_pi: PhiPi, y; nu: Nu, y; gamma: Gamma, y; }
}

impl<T: Scalar, E: Engine<T>> CorrectedSolution for InProcess<T, E> {
    type Solution = Vec<T>;

    buffer! { solution_buffer: Solution }

    functions! {
        joint_accelerations_at: JointAccelerationsAt, y;
        corrected_multipliers: CorrectedMultipliers, y + accelerations;
        corrected_solution: CorrectedSolution, y;
    }
}

impl<T: Scalar, E: Engine<T>> Projection for InProcess<T, E> {
    functions! { project: Project, y + rows; }
}

impl<T: Scalar, E: Engine<T>> ParameterJacobian for InProcess<T, E> {
    type ParameterJacobian = Vec<T>;

    buffer! { parameter_buffer: ParameterJacobian }

    functions! { joint_parameter_jacobian: JointParameterJacobian, x; }
}

impl<T: Scalar, E: Engine<T>> OutputDerivatives for InProcess<T, E> {
    type ByState = Vec<T>;
    type ByAccelerations = Vec<T>;
    type ByInputs = Vec<T>;
    type ByParameters = Vec<T>;

    fn output_slopes(&self) -> OutputSlopes<Self> {
        OutputSlopes {
            by_state: self.buffer(Space::ByState),
            by_accelerations: self.buffer(Space::ByAccelerations),
            by_inputs: self.buffer(Space::ByInputs),
            by_parameters: self.buffer(Space::ByParameters),
        }
    }

    functions! {
        outputs_by_state: OutputsByState, x + accelerations;
        outputs_by_accelerations: OutputsByAccelerations, x + accelerations;
        outputs_by_inputs: OutputsByInputs, x + accelerations;
        outputs_by_parameters: OutputsByParameters, x + accelerations;
    }
}

impl<T: Scalar, E: Engine<T>> Frames for InProcess<T, E> {
    type FrameJacobians = Vec<T>;
    type FrameBiases = Vec<T>;

    fn frame_names(&self) -> &[&str] {
        self.shared.description.frame_names()
    }

    fn frame_buffers(&self) -> FrameBuffers<Self> {
        FrameBuffers {
            jacobians: self.buffer(Space::FrameJacobians),
            biases: self.buffer(Space::FrameBiases),
        }
    }

    functions! { frame_jacobians: FrameJacobians, x; frame_biases: FrameBiases, x; }
}

impl<T: Scalar, E: Engine<T>> InverseDynamics for InProcess<T, E> {
    functions! {
        inverse_dynamics: InverseDynamics, x + accelerations;
        bias_forces: BiasForces, x;
        gravity_forces: GravityForces, x;
    }
}

impl<T: Scalar, E: Engine<T>> MassMatrix for InProcess<T, E> {
    type MassMatrix = Vec<T>;

    buffer! { mass_buffer: MassMatrix }

    fn mass_order(&self) -> &[u16] {
        &self.shared.mass_order
    }

    functions! { mass_matrix: MassMatrix, x; mass_factor: MassFactor, x; }
}

impl<T: Scalar, E: Engine<T>> DynamicsDerivatives for InProcess<T, E> {
    type InverseDerivatives = Vec<T>;
    type ForwardDerivatives = Vec<T>;

    buffer! { inverse_buffer: InverseDerivatives }
    buffer! { forward_buffer: ForwardDerivatives }

    functions! {
        inverse_derivatives: InverseDerivatives, x + accelerations;
        forward_derivatives: ForwardDerivatives, x;
    }
}

impl<T: Scalar, E: Engine<T>> Regressor for InProcess<T, E> {
    type Regressor = Vec<T>;

    buffer! { regressor_buffer: Regressor }

    functions! { regressor: Regressor, x + accelerations; }
}
