//! Outputs of a joint state, and what controllers of robots ask for.

use crate::engine::Engine;
use crate::mechanism::InProcess;
use gyro_codegen::Kernel;
use gyro_sim::{
    DynamicsDerivatives, FrameBuffers, Frames, InverseDynamics, JointOutputs, MassMatrix, OutputDerivatives,
    OutputSlopes, Regressor, Scalar,
};

impl<T: Scalar, E: Engine<T>> JointOutputs for InProcess<T, E> {
    fn joint_outputs(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        if !self.shared.reads_given[Kernel::JointOutputs as usize] {
            return self.fill(Kernel::JointOutputs, t, x, out);
        }
        self.with_given(self.shared.joint.n_rates, |rates| {
            self.fill(Kernel::JointAccelerations, t, x, rates);
            self.compute(Kernel::JointOutputs, t, (x, rates), out);
        });
    }
}

impl<T: Scalar, E: Engine<T>> OutputDerivatives for InProcess<T, E> {
    type ByState = Vec<T>;
    type ByAccelerations = Vec<T>;
    type ByInputs = Vec<T>;
    type ByParameters = Vec<T>;

    fn output_slopes(&self) -> OutputSlopes<Self> {
        let zeros = |kernel| self.zeros(self.n_results(kernel));
        OutputSlopes {
            by_state: zeros(Kernel::OutputsByState),
            by_accelerations: zeros(Kernel::OutputsByAccelerations),
            by_inputs: zeros(Kernel::OutputsByInputs),
            by_parameters: zeros(Kernel::OutputsByParameters),
        }
    }

    fn outputs_by_state(&self, t: T, x: &Vec<T>, accelerations: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::OutputsByState, t, (x, accelerations), out);
    }

    fn outputs_by_accelerations(&self, t: T, x: &Vec<T>, accelerations: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::OutputsByAccelerations, t, (x, accelerations), out);
    }

    fn outputs_by_inputs(&self, t: T, x: &Vec<T>, accelerations: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::OutputsByInputs, t, (x, accelerations), out);
    }

    fn outputs_by_parameters(&self, t: T, x: &Vec<T>, accelerations: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::OutputsByParameters, t, (x, accelerations), out);
    }
}

impl<T: Scalar, E: Engine<T>> Frames for InProcess<T, E> {
    type FrameJacobians = Vec<T>;
    type FrameBiases = Vec<T>;

    fn frame_names(&self) -> &[&str] {
        self.shared.description.frame_names()
    }

    fn frame_buffers(&self) -> FrameBuffers<Self> {
        let zeros = |kernel| self.zeros(self.n_results(kernel));
        FrameBuffers { jacobians: zeros(Kernel::FrameJacobians), biases: zeros(Kernel::FrameBiases) }
    }

    fn frame_jacobians(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::FrameJacobians, t, x, out);
    }

    fn frame_biases(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::FrameBiases, t, x, out);
    }
}

impl<T: Scalar, E: Engine<T>> InverseDynamics for InProcess<T, E> {
    fn inverse_dynamics(&self, t: T, x: &Vec<T>, accelerations: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::InverseDynamics, t, (x, accelerations), out);
    }

    fn bias_forces(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::BiasForces, t, x, out);
    }

    fn gravity_forces(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::GravityForces, t, x, out);
    }
}

impl<T: Scalar, E: Engine<T>> MassMatrix for InProcess<T, E> {
    type MassMatrix = Vec<T>;

    fn mass_buffer(&self) -> Vec<T> {
        self.zeros(self.n_results(Kernel::MassMatrix))
    }

    fn mass_order(&self) -> &[u16] {
        &self.shared.mass_order
    }

    fn mass_matrix(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::MassMatrix, t, x, out);
    }

    fn mass_factor(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::MassFactor, t, x, out);
    }
}

impl<T: Scalar, E: Engine<T>> DynamicsDerivatives for InProcess<T, E> {
    type InverseDerivatives = Vec<T>;
    type ForwardDerivatives = Vec<T>;

    fn inverse_buffer(&self) -> Vec<T> {
        self.zeros(self.n_results(Kernel::InverseDerivatives))
    }

    fn forward_buffer(&self) -> Vec<T> {
        self.zeros(self.n_results(Kernel::ForwardDerivatives))
    }

    fn inverse_derivatives(&self, t: T, x: &Vec<T>, accelerations: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::InverseDerivatives, t, (x, accelerations), out);
    }

    fn forward_derivatives(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::ForwardDerivatives, t, x, out);
    }
}

impl<T: Scalar, E: Engine<T>> Regressor for InProcess<T, E> {
    type Regressor = Vec<T>;

    fn regressor_buffer(&self) -> Vec<T> {
        self.zeros(self.n_results(Kernel::Regressor))
    }

    fn regressor(&self, t: T, x: &Vec<T>, accelerations: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::Regressor, t, (x, accelerations), out);
    }
}
