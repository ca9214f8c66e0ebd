//! Joint coordinates.

use super::maximal::start;
use super::plain::functions;
use crate::engine::Engine;
use crate::mechanism::InProcess;
use gyro_program::{Kernel, Space};
use gyro_sim::{JacobianBuffers, JointBuffers, JointJacobian, JointLayout, JointOutputs, JointSpace, Scalar};

impl<T: Scalar, E: Engine<T>> InProcess<T, E> {
    /// Where the work stands in a joint state, and where in a maximal one, if it is there.
    fn work_places(&self) -> Option<(usize, usize)> {
        let joint = &self.shared.joint;
        let at = joint.n_coordinates + joint.n_rates;
        (joint.start.len() > at).then_some((at, 13 * self.scheduled().counts.bodies))
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
        JointBuffers { rates: self.buffer(Space::Rates), closure: self.buffer(Space::Closure) }
    }

    fn joint_start(&self) -> Vec<T> {
        start(&self.shared.joint.start)
    }

    functions! { joint_accelerations: JointAccelerations, x; }

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

    functions! { loop_closure: LoopClosure, x; closure_distances: ClosureDistances, x; }

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
        JacobianBuffers {
            jacobian: self.buffer(Space::Jacobian),
            input_jacobian: self.buffer(Space::InputJacobian),
        }
    }

    fn joint_jacobian(&self, t: T, x: &Vec<T>, dfdx: &mut Vec<T>, dfdt: &mut Vec<T>) {
        self.with_given(dfdx.len() + dfdt.len(), |both| {
            self.fill(Kernel::JointJacobian, t, x, both);
            let (by_state, by_time) = both.split_at(dfdx.len());
            dfdx.copy_from_slice(by_state);
            dfdt.copy_from_slice(by_time);
        });
    }

    functions! { joint_input_jacobian: JointInputJacobian, x; }
}

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
