//! Maximal coordinates.

use super::plain::{buffer, functions};
use crate::engine::Engine;
use crate::mechanism::InProcess;
use gyro_program::{Kernel, Space};
use gyro_sim::{Buffers, CorrectedDynamics, Description, Dynamics, Energy, Mechanism, Scalar};

/// Zeros have no sign, as in modules.
pub(crate) fn start<T: Scalar>(numbers: &[f64]) -> Vec<T> {
    numbers.iter().map(|&x| T::constant(if x == 0.0 { 0.0 } else { x })).collect()
}

impl<T: Scalar, E: Engine<T>> Mechanism for InProcess<T, E> {
    type Scalar = T;
    type State = Vec<T>;
    type Rows = Vec<T>;
    type Constraints = Vec<T>;
    type Velocities = Vec<T>;
    type Readings = Vec<T>;
    type Outputs = Vec<T>;

    fn description(&self) -> &Description<'_> {
        self.shared.description.get()
    }

    fn buffers(&self) -> Buffers<Self> {
        Buffers {
            rows: self.buffer(Space::Rows),
            constraints: self.buffer(Space::Constraints),
            velocities: self.buffer(Space::Velocities),
            readings: self.buffer(Space::Readings),
            outputs: self.buffer(Space::Outputs),
        }
    }

    fn start(&self) -> Vec<T> {
        start(&self.scheduled().start)
    }

    functions! {
        phi: Phi, y;
        velocity_residual: VelocityResidual, y;
        applied_force: AppliedForce, y;
        read_joints: ReadJoints, y;
    }

    fn energy(&self, t: T, y: &Vec<T>) -> Energy<T> {
        let mut energy = [T::constant(0.0); 2];
        self.fill(Kernel::Energy, t, y, &mut energy);
        let [kinetic, potential] = energy;
        Energy { kinetic, potential }
    }

    fn outputs(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        if !self.shared.reads_given[Kernel::Outputs as usize] {
            return self.fill(Kernel::Outputs, t, y, out);
        }
        self.with_given(self.len(Space::Accelerations), |accelerations| {
            self.fill(Kernel::Accelerations, t, y, accelerations);
            self.compute(Kernel::Outputs, t, (y, accelerations), out);
        });
    }

    fn set_input(&mut self, index: usize, value: T) -> bool {
        self.set_own_input(index, value)
    }
}

impl<T: Scalar, E: Engine<T>> InProcess<T, E> {
    /// ẏ from accelerations, of which the first are (s̈, ẇ') of all bodies.
    fn write_rates(&self, kernel: Kernel, t: T, (y, accelerations): (&[T], &[T]), dy: &mut [T]) {
        self.compute(kernel, t, (y, accelerations), dy);
        let (first, n) = (7 * self.scheduled().counts.bodies, self.len(Space::Velocities));
        dy[first..first + n].copy_from_slice(&accelerations[..n]);
    }
}

impl<T: Scalar, E: Engine<T>> Dynamics for InProcess<T, E> {
    type Accelerations = Vec<T>;

    buffer! { acceleration_buffer: Accelerations }

    functions! { accelerations: Accelerations, y; }

    fn multipliers(&self, t: T, y: &Vec<T>, accelerations: &Vec<T>, lambda: &mut Vec<T>) {
        self.compute(Kernel::Multipliers, t, (y, accelerations), lambda);
    }

    fn derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        self.with_given(self.len(Space::Accelerations), |accelerations| {
            self.fill(Kernel::Accelerations, t, y, accelerations);
            self.write_rates(Kernel::Derivative, t, (y, accelerations), dy);
        });
    }
}

impl<T: Scalar, E: Engine<T>> InProcess<T, E> {
    fn write_corrected_accelerations(&self, t: T, y: &[T], out: &mut [T]) {
        if self.scheduled().joint.is_some() {
            return self.fill(Kernel::CorrectedAccelerations, t, y, out);
        }
        let mut solved = self.zeros(self.len(Space::Accelerations));
        self.fill(Kernel::Accelerations, t, y, &mut solved);
        out.copy_from_slice(&solved[..self.len(Space::Velocities)]);
    }
}

impl<T: Scalar, E: Engine<T>> CorrectedDynamics for InProcess<T, E> {
    fn corrected_accelerations(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.write_corrected_accelerations(t, y, out);
    }

    fn corrected_derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        if !self.has(Kernel::CorrectedDerivative) {
            return self.derivative(t, y, dy);
        }
        self.with_given(self.len(Space::Velocities), |accelerations| {
            self.write_corrected_accelerations(t, y, accelerations);
            self.write_rates(Kernel::CorrectedDerivative, t, (y, accelerations), dy);
        });
    }
}
