//! Maximal coordinates.

use crate::engine::Engine;
use crate::mechanism::InProcess;
use gyro_codegen::Kernel;
use gyro_sim::{
    Buffers, CorrectedDynamics, CorrectedSolution, Description, Dynamics, Energy, Kinematics, Mechanism,
    Projection, Scalar, Terms,
};

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
        let scheduled = self.scheduled();
        Buffers {
            rows: self.zeros(scheduled.n_rows),
            constraints: self.zeros(scheduled.n_rows + scheduled.n_bodies),
            velocities: self.zeros(self.n_velocities()),
            readings: self.zeros(scheduled.n_readings),
            outputs: self.zeros(scheduled.n_outputs),
        }
    }

    fn start(&self) -> Vec<T> {
        start(&self.scheduled().start)
    }

    fn phi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::Phi, t, y, out);
    }

    fn velocity_residual(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::VelocityResidual, t, y, out);
    }

    fn applied_force(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::AppliedForce, t, y, out);
    }

    fn energy(&self, t: T, y: &Vec<T>) -> Energy<T> {
        let mut energy = [T::constant(0.0); 2];
        self.fill(Kernel::Energy, t, y, &mut energy);
        let [kinetic, potential] = energy;
        Energy { kinetic, potential }
    }

    fn read_joints(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::ReadJoints, t, y, out);
    }

    fn outputs(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        if !self.shared.reads_given[Kernel::Outputs as usize] {
            return self.fill(Kernel::Outputs, t, y, out);
        }
        self.with_given(self.scheduled().n_accelerations, |accelerations| {
            self.fill(Kernel::Accelerations, t, y, accelerations);
            self.compute(Kernel::Outputs, t, (y, accelerations), out);
        });
    }

    fn set_input(&mut self, index: usize, value: T) -> bool {
        self.set_own_input(index, value)
    }
}

impl<T: Scalar, E: Engine<T>> Kinematics for InProcess<T, E> {
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;

    fn terms(&self) -> Terms<Self> {
        Terms {
            phi_q: self.zeros(self.shared.phi_q_pattern.len()),
            phi_pi: self.zeros(self.shared.phi_pi_pattern.len()),
        }
    }

    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        &self.shared.phi_q_pattern
    }

    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        &self.shared.phi_pi_pattern
    }

    fn phi_q(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::PhiQ, t, y, out);
    }

    fn phi_pi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::PhiPi, t, y, out);
    }

    fn nu(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::Nu, t, y, out);
    }

    fn gamma(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::Gamma, t, y, out);
    }
}

impl<T: Scalar, E: Engine<T>> InProcess<T, E> {
    /// ẏ from accelerations, of which the first are (s̈, ẇ') of all bodies.
    fn write_rates(&self, kernel: Kernel, t: T, (y, accelerations): (&[T], &[T]), dy: &mut [T]) {
        self.compute(kernel, t, (y, accelerations), dy);
        let (first, n) = (7 * self.scheduled().n_bodies, self.n_velocities());
        dy[first..first + n].copy_from_slice(&accelerations[..n]);
    }
}

impl<T: Scalar, E: Engine<T>> Dynamics for InProcess<T, E> {
    type Accelerations = Vec<T>;

    fn acceleration_buffer(&self) -> Vec<T> {
        self.zeros(self.scheduled().n_accelerations)
    }

    fn accelerations(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::Accelerations, t, y, out);
    }

    fn multipliers(&self, t: T, y: &Vec<T>, accelerations: &Vec<T>, lambda: &mut Vec<T>) {
        self.compute(Kernel::Multipliers, t, (y, accelerations), lambda);
    }

    fn derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        self.with_given(self.scheduled().n_accelerations, |accelerations| {
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
        let mut solved = self.zeros(self.scheduled().n_accelerations);
        self.fill(Kernel::Accelerations, t, y, &mut solved);
        out.copy_from_slice(&solved[..self.n_velocities()]);
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
        self.with_given(self.n_velocities(), |accelerations| {
            self.write_corrected_accelerations(t, y, accelerations);
            self.write_rates(Kernel::CorrectedDerivative, t, (y, accelerations), dy);
        });
    }
}

impl<T: Scalar, E: Engine<T>> CorrectedSolution for InProcess<T, E> {
    type Solution = Vec<T>;

    fn solution_buffer(&self) -> Vec<T> {
        self.zeros(self.n_velocities() + self.scheduled().n_rows)
    }

    fn joint_accelerations_at(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::JointAccelerationsAt, t, y, out);
    }

    fn corrected_multipliers(&self, t: T, y: &Vec<T>, accelerations: &Vec<T>, lambda: &mut Vec<T>) {
        self.compute(Kernel::CorrectedMultipliers, t, (y, accelerations), lambda);
    }

    fn corrected_solution(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.fill(Kernel::CorrectedSolution, t, y, out);
    }
}

impl<T: Scalar, E: Engine<T>> Projection for InProcess<T, E> {
    fn project(&self, t: T, y: &Vec<T>, rows: &Vec<T>, out: &mut Vec<T>) {
        self.compute(Kernel::Project, t, (y, rows), out);
    }
}
