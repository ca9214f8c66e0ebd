//! The contract of `gyro-sim` that tells the equations term by term.

use crate::assembled::{Assembled, Solver, zeros};
use crate::model::place::Moment;
use crate::number::Number;
use crate::projection;
use gyro_sim::{CorrectedDynamics, Dynamics, Kinematics, Projection, Terms};

impl<T: Number, S: Solver<T>> Kinematics for Assembled<T, S> {
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;

    fn terms(&self) -> Terms<Self> {
        Terms { phi_q: zeros(self.phi_q_pattern.len()), phi_pi: zeros(self.phi_pi_pattern.len()) }
    }

    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        &self.phi_q_pattern
    }

    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        &self.phi_pi_pattern
    }

    fn phi_q(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        let mut at = 0;
        self.lowered.phi_q(Moment { t, y }, |_, _, value| {
            out[at] = value;
            at += 1;
        });
    }

    fn phi_pi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        let mut at = 0;
        self.lowered.phi_pi(Moment { t, y }, |_, _, value| {
            out[at] = value;
            at += 1;
        });
    }

    fn nu(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.nu(Moment { t, y }, out);
    }

    fn gamma(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.gamma(Moment { t, y }, out);
    }
}

impl<T: Number, S: Solver<T>> Dynamics for Assembled<T, S> {
    type Accelerations = Vec<T>;

    fn acceleration_buffer(&self) -> Vec<T> {
        zeros(self.solver.accelerations_len(&self.lowered))
    }

    fn accelerations(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.solver.accelerations(&self.lowered, t, y, out);
    }

    fn multipliers(&self, t: T, y: &Vec<T>, accelerations: &Vec<T>, lambda: &mut Vec<T>) {
        self.solver.multipliers(&self.lowered, t, y, accelerations, lambda);
    }

    fn derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        self.write_derivative(t, y, dy);
    }
}

impl<T: Number, S: Solver<T>> CorrectedDynamics for Assembled<T, S> {
    fn corrected_accelerations(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        let mut solved = self.acceleration_buffer();
        self.accelerations(t, y, &mut solved);
        out.copy_from_slice(&solved[..self.lowered.scene.n_v()]);
    }

    fn corrected_derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        self.derivative(t, y, dy);
    }
}

impl<T: Number, S: Solver<T>> Projection for Assembled<T, S> {
    fn project(&self, t: T, y: &Vec<T>, rows: &Vec<T>, out: &mut Vec<T>) {
        projection::project(&self.lowered, Moment { t, y }, rows, &mut self.work(), out);
    }
}
