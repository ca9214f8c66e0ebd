//! The contract of `gyro-sim` that tells the equations term by term, and what goes in and comes out at every step.

use crate::assembled::{Assembled, Solver, zeros};
use crate::number::Number;
use crate::place::Moment;
use gyro_sim::{Equations, OutputInfo, Ports};

impl<T: Number, S: Solver<T>> Equations for Assembled<T, S> {
    type Velocities = Vec<T>;
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;
    type Accelerations = Vec<T>;

    fn velocities(&self) -> Vec<T> {
        zeros(self.lowered.scene.n_v())
    }

    fn phi_q_values(&self) -> Vec<T> {
        zeros(self.phi_q_pattern.len())
    }

    fn phi_pi_values(&self) -> Vec<T> {
        zeros(self.phi_pi_pattern.len())
    }

    fn accelerations_buffer(&self) -> Vec<T> {
        zeros(self.solver.accelerations_len(&self.lowered))
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
}

impl<T: Number, S: Solver<T>> Ports for Assembled<T, S> {
    type Outputs = Vec<T>;

    fn outputs_buffer(&self) -> Vec<T> {
        zeros(self.lowered.n_outputs())
    }

    fn outputs(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        let at = Moment { t, y };
        self.with_solution(at, |solution| self.lowered.outputs(at, solution, out));
    }

    fn n_outputs(&self) -> usize {
        self.lowered.n_outputs()
    }

    fn output(&self, index: usize) -> OutputInfo<'_> {
        let none = OutputInfo { name: "", suffix: "", unit: "" };
        self.lowered.output_infos().nth(index).unwrap_or(none)
    }

    fn n_inputs(&self) -> usize {
        self.lowered.scene.inputs.len()
    }

    fn input_name(&self, index: usize) -> &str {
        self.lowered.scene.inputs.get(index).map_or("", |(name, _)| name)
    }

    fn set_input(&mut self, index: usize, value: T) -> bool {
        let input = self.lowered.scene.inputs.get_mut(index);
        input.map(|(_, present)| *present = value).is_some()
    }
}
