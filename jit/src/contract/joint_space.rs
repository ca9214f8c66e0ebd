//! Joint coordinates.

use super::maximal::start;
use crate::engine::Engine;
use crate::mechanism::InProcess;
use gyro_codegen::Kernel;
use gyro_sim::{
    JacobianBuffers, JointBuffers, JointJacobian, JointLayout, JointSpace, ParameterJacobian, Scalar,
};

impl<T: Scalar, E: Engine<T>> InProcess<T, E> {
    /// Where the work stands in a joint state, and where in a maximal one, if it is there.
    fn work_places(&self) -> Option<(usize, usize)> {
        let joint = &self.shared.joint;
        let at = joint.n_coordinates + joint.n_rates;
        (joint.start.len() > at).then_some((at, 13 * self.scheduled().n_bodies))
    }
}

impl<T: Scalar, E: Engine<T>> JointSpace for InProcess<T, E> {
    type Joints = Vec<T>;
    type Rates = Vec<T>;
    type Closure = Vec<T>;

    fn joint_layout(&self) -> &JointLayout<'_> {
        self.shared.layout_of_joints.get()
    }

    fn joint_buffers(&self) -> JointBuffers<Self> {
        let joint = &self.shared.joint;
        JointBuffers { rates: self.zeros(joint.n_rates), closure: self.zeros(joint.closure_rows.len()) }
    }

    fn joint_start(&self) -> Vec<T> {
        start(&self.shared.joint.start)
    }

    fn joint_accelerations(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::JointAccelerations, t, x, out);
    }

    fn joint_derivative(&self, t: T, x: &Vec<T>, dx: &mut Vec<T>) {
        let (first, n) = (self.shared.joint.n_coordinates, self.shared.joint.n_rates);
        let in_place = first..first + n;
        if !self.shared.reads_given[Kernel::JointDerivative as usize] {
            // Each writes where the other one does not.
            self.fill(Kernel::JointAccelerations, t, x, &mut dx[in_place]);
            return self.fill(Kernel::JointDerivative, t, x, dx);
        }
        self.with_given(n, |rates| {
            self.fill(Kernel::JointAccelerations, t, x, rates);
            self.compute(Kernel::JointDerivative, t, (x, rates), dx);
            dx[in_place].copy_from_slice(rates);
        });
    }

    fn to_maximal(&self, t: T, x: &Vec<T>, y: &mut Vec<T>) {
        self.fill(Kernel::ToMaximal, t, x, y);
        if let Some((in_joints, in_state)) = self.work_places() {
            y[in_state] = x[in_joints];
        }
    }

    fn to_joints(&self, t: T, y: &Vec<T>, x: &mut Vec<T>) {
        self.fill(Kernel::ToJoints, t, y, x);
        if let Some((in_joints, in_state)) = self.work_places() {
            x[in_joints] = y[in_state];
        }
    }

    fn loop_closure(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::LoopClosure, t, x, out);
    }

    fn closure_distances(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::ClosureDistances, t, x, out);
    }

    fn close_positions(&self, t: T, x: &mut Vec<T>) {
        self.fill(Kernel::ClosePositions, t, &[], x);
    }

    fn close_velocities(&self, t: T, x: &mut Vec<T>) {
        self.fill(Kernel::CloseVelocities, t, &[], x);
    }
}

impl<T: Scalar, E: Engine<T>> JointJacobian for InProcess<T, E> {
    type Jacobian = Vec<T>;
    type InputJacobian = Vec<T>;

    fn jacobian_buffers(&self) -> JacobianBuffers<Self> {
        let [by_state, by_inputs] = self.shared.joint.jacobian.unwrap_or_default();
        JacobianBuffers { jacobian: self.zeros(by_state), input_jacobian: self.zeros(by_inputs) }
    }

    fn joint_jacobian(&self, t: T, x: &Vec<T>, dfdx: &mut Vec<T>, dfdt: &mut Vec<T>) {
        self.with_given(dfdx.len() + dfdt.len(), |both| {
            self.fill(Kernel::JointJacobian, t, x, both);
            let (by_state, by_time) = both.split_at(dfdx.len());
            dfdx.copy_from_slice(by_state);
            dfdt.copy_from_slice(by_time);
        });
    }

    fn joint_input_jacobian(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::JointInputJacobian, t, x, out);
    }
}

impl<T: Scalar, E: Engine<T>> ParameterJacobian for InProcess<T, E> {
    type ParameterJacobian = Vec<T>;

    fn parameter_buffer(&self) -> Vec<T> {
        self.zeros(self.n_results(Kernel::JointParameterJacobian))
    }

    fn joint_parameter_jacobian(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::JointParameterJacobian, t, x, out);
    }
}
