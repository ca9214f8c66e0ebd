//! The contract of `gyro-sim` that tells the equations term by term.

use crate::assembled::{Assembled, Solver, zeros};
use crate::model::place::Moment;
use crate::number::Number;
use crate::projection;
use gyro_sim::{Equations, Terms};

impl<T: Number, S: Solver<T>> Equations for Assembled<T, S> {
    type Velocities = Vec<T>;
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;
    type Accelerations = Vec<T>;

    fn terms(&self) -> Terms<Self> {
        Terms {
            velocities: zeros(self.lowered.scene.n_v()),
            phi_q: zeros(self.phi_q_pattern.len()),
            phi_pi: zeros(self.phi_pi_pattern.len()),
            accelerations: zeros(self.solver.accelerations_len(&self.lowered)),
        }
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

    fn applied_force(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.applied_force(Moment { t, y }, out);
    }

    fn accelerations(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.solver.accelerations(&self.lowered, t, y, out);
    }

    fn multipliers(&self, t: T, y: &Vec<T>, accelerations: &Vec<T>, lambda: &mut Vec<T>) {
        self.solver.multipliers(&self.lowered, t, y, accelerations, lambda);
    }

    fn project(&self, t: T, y: &Vec<T>, rows: &Vec<T>, out: &mut Vec<T>) {
        projection::project(&self.lowered, Moment { t, y }, rows, &mut self.work(), out);
    }
}
