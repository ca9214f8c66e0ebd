//! The contract of `gyro-sim`, kept by the lowered model for the formulas and by a [`Solver`] for the linear algebra.

use crate::lowered::Lowered;
use crate::number::{Number, number};
use crate::textbook::p_dot;
use gyro_model::{AssemblyError, Model};
use gyro_sim::{Energy, Equations, Error, JointInfo, Mechanism, Ode, Partition, RowInfo};
use nalgebra::Vector4;
use std::fmt::Debug;

/// A mechanism assembled at run time, with the linear algebra of `S`.
#[derive(Clone, Debug)]
pub struct Assembled<T: Number, S> {
    lowered: Lowered<T>,
    solver: S,
    phi_q_pattern: Vec<(u16, u16)>,
    phi_pi_pattern: Vec<(u16, u16)>,
}

/// How eq. (17) is solved and how the coordinates are partitioned.
pub trait Solver<T: Number>: Clone + Debug {
    /// Which coordinates are independent.
    type Independent: Clone + Debug + PartialEq;

    /// A solver for this model.
    fn new(model: &Model, lowered: &Lowered<T>) -> Self;
    /// Writes the accelerations `(s̈, ẇ')` that solve eq. (17).
    fn accelerations(&self, lowered: &Lowered<T>, y: &[T], out: &mut [T]);
    /// Writes the accelerations and the multipliers λ.
    fn accelerations_and_multipliers(&self, lowered: &Lowered<T>, y: &[T], out: &mut [T], lambda: &mut [T]);
    /// The best choice of independent coordinates.
    fn independent(&self, lowered: &Lowered<T>, y: &[T]) -> Self::Independent;
    /// Replaces a choice that has become poor; returns how many independent coordinates were exchanged.
    fn follow(&self, lowered: &Lowered<T>, y: &[T], choice: &mut Self::Independent) -> u32;
    /// One Newton step of the dependent positions.
    ///
    /// # Errors
    /// The pivot that vanished.
    fn newton_step(&self, lowered: &Lowered<T>, choice: &Self::Independent, y: &mut [T]) -> Result<(), T>;
    /// Solves eq. (19).
    ///
    /// # Errors
    /// The pivot that vanished.
    fn solve_velocities(
        &self,
        lowered: &Lowered<T>,
        choice: &Self::Independent,
        y: &mut [T],
    ) -> Result<(), T>;
}

impl<T: Number, S: Solver<T>> Assembled<T, S> {
    /// The mechanism of a model, at the model's parameters and start.
    ///
    /// # Errors
    /// [`AssemblyError`] if the model has no consistent start.
    pub fn new(model: &Model) -> Result<Self, AssemblyError> {
        let lowered = Lowered::new(model)?;
        let solver = S::new(model, &lowered);
        let (mut phi_q_pattern, mut phi_pi_pattern) = (Vec::new(), Vec::new());
        lowered.phi_q(&lowered.start, |row, column, _| phi_q_pattern.push(entry(row, column)));
        lowered.phi_pi(&lowered.start, |row, column, _| phi_pi_pattern.push(entry(row, column)));
        Ok(Self { lowered, solver, phi_q_pattern, phi_pi_pattern })
    }
}

impl<T: Number, S: Solver<T>> Ode for Assembled<T, S> {
    type Scalar = T;
    type State = Vec<T>;

    fn start(&self) -> Vec<T> {
        self.lowered.start.clone()
    }

    fn derivative(&self, _: T, y: &Vec<T>, dy: &mut Vec<T>) {
        let lowered = &self.lowered;
        for (slot, dq) in dy.as_chunks_mut::<7>().0[..lowered.n_bodies()].iter_mut().enumerate() {
            dq[..3].copy_from_slice(lowered.s(y, slot).as_slice()); // eq. (16)
            let p_dot: Vector4<T> = p_dot(&lowered.p(y, slot), &lowered.w(y, slot));
            dq[3..].copy_from_slice(p_dot.as_slice());
        }
        let velocities = lowered.n_q()..lowered.n_q() + lowered.n_v();
        self.solver.accelerations(lowered, y, &mut dy[velocities]);
        if let Some(work) = lowered.work {
            dy[work] = lowered.power(y);
        }
    }
}

impl<T: Number, S: Solver<T>> Mechanism for Assembled<T, S> {
    type Rows = Vec<T>;
    type Constraints = Vec<T>;
    type Readings = Vec<T>;

    fn rows(&self) -> Vec<T> {
        zeros(self.lowered.n_rows())
    }

    fn constraints(&self) -> Vec<T> {
        zeros(self.lowered.n_rows() + self.lowered.n_bodies())
    }

    fn readings(&self) -> Vec<T> {
        zeros(self.lowered.n_readings())
    }

    fn phi(&self, _: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.phi(y, out);
    }

    fn velocity_residual(&self, _: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.velocity_residual(y, out);
    }

    fn energy(&self, y: &Vec<T>) -> Energy<T> {
        self.lowered.energy(y)
    }

    fn read_joints(&self, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.read_joints(y, out);
    }

    fn n_bodies(&self) -> usize {
        self.lowered.n_bodies()
    }

    fn n_joints(&self) -> usize {
        self.lowered.joints.len()
    }

    fn body_name(&self, body: usize) -> &str {
        &self.lowered.bodies[body].name
    }

    fn joint(&self, joint: usize) -> JointInfo<'_> {
        let joint = &self.lowered.joints[joint];
        JointInfo { name: &joint.name, coordinate: joint.coordinate() }
    }

    fn row(&self, row: usize) -> RowInfo {
        self.lowered.rows[row]
    }

    fn size(&self) -> T {
        self.lowered.size
    }

    fn work(&self, y: &Vec<T>) -> T {
        self.lowered.work.map_or(T::zero(), |work| y[work])
    }
}

impl<T: Number, S: Solver<T>> Partition for Assembled<T, S> {
    type Independent = S::Independent;

    fn independent(&self, _: T, y: &Vec<T>) -> S::Independent {
        self.solver.independent(&self.lowered, y)
    }

    fn follow(&self, _: T, y: &Vec<T>, choice: &mut S::Independent) -> u32 {
        self.solver.follow(&self.lowered, y, choice)
    }

    fn newton_step(&self, t: T, choice: &S::Independent, y: &mut Vec<T>) -> Result<(), Error> {
        self.solver.newton_step(&self.lowered, choice, y).map_err(|pivot| singular(t, pivot))
    }

    fn solve_velocities(&self, t: T, choice: &S::Independent, y: &mut Vec<T>) -> Result<(), Error> {
        self.solver.solve_velocities(&self.lowered, choice, y).map_err(|pivot| singular(t, pivot))
    }
}

impl<T: Number, S: Solver<T>> Equations for Assembled<T, S> {
    type Velocities = Vec<T>;
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;

    fn velocities(&self) -> Vec<T> {
        zeros(self.lowered.n_v())
    }

    fn phi_q_values(&self) -> Vec<T> {
        zeros(self.phi_q_pattern.len())
    }

    fn phi_pi_values(&self) -> Vec<T> {
        zeros(self.phi_pi_pattern.len())
    }

    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        &self.phi_q_pattern
    }

    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        &self.phi_pi_pattern
    }

    fn phi_q(&self, _: T, y: &Vec<T>, out: &mut Vec<T>) {
        let mut at = 0;
        self.lowered.phi_q(y, |_, _, value| {
            out[at] = value;
            at += 1;
        });
    }

    fn phi_pi(&self, _: T, y: &Vec<T>, out: &mut Vec<T>) {
        let mut at = 0;
        self.lowered.phi_pi(y, |_, _, value| {
            out[at] = value;
            at += 1;
        });
    }

    fn nu(&self, _: T, _: &Vec<T>, out: &mut Vec<T>) {
        out.fill(T::zero());
    }

    fn gamma(&self, _: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.gamma(y, out);
    }

    fn applied_force(&self, _: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.applied_force(y, out);
    }

    fn accelerations(&self, _: T, y: &Vec<T>, out: &mut Vec<T>, lambda: &mut Vec<T>) {
        self.solver.accelerations_and_multipliers(&self.lowered, y, out, lambda);
    }
}

fn zeros<T: Number>(len: usize) -> Vec<T> {
    vec![number(0.0); len]
}

fn entry(row: usize, column: usize) -> (u16, u16) {
    let narrow = |index: usize| u16::try_from(index).expect("patterns hold up to 65536 rows and columns");
    (narrow(row), narrow(column))
}

fn singular<T: Number>(t: T, pivot: T) -> Error {
    Error::Singular { t: gyro_sim::Real::to_f64(t), pivot: gyro_sim::Real::to_f64(pivot) }
}
