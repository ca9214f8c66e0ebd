//! A lowered model with the linear algebra of a [`Solver`]; the contract of `gyro-sim` that tells its motion.

use crate::description::OwnedDescription;
use crate::error::{BuildError, Unsupported};
use crate::model::lowered::Lowered;
use crate::model::outputs::Solution;
use crate::model::place::Moment;
use crate::model::textbook::p_dot;
use crate::number::{Number, number};
use gyro_model::Model;
use gyro_sim::{Buffers, Clearance, Description, Energy, Error, Mechanism, Owner, Partition};
use nalgebra::Vector4;
use std::cell::{RefCell, RefMut};
use std::fmt::Debug;

/// A mechanism assembled at run time, with the linear algebra of `S`.
#[derive(Clone, Debug)]
pub struct Assembled<T: Number, S> {
    pub(crate) lowered: Lowered<T>,
    pub(crate) solver: S,
    description: OwnedDescription,
    pub(crate) phi_q_pattern: Vec<(u16, u16)>,
    pub(crate) phi_pi_pattern: Vec<(u16, u16)>,
    /// Work space. A mechanism is constant to its callers, so it is borrowed inside each call and never across.
    space: RefCell<Space<T>>,
}

/// What a solution of eq. (17) needs.
#[derive(Clone, Debug)]
struct Space<T> {
    accelerations: Vec<T>,
    lambda: Vec<T>,
    nu: Vec<T>,
    readings: Vec<T>,
    /// Of [`project`](gyro_sim::Equations::project): empty until it is asked for, as it grows with the square of the
    /// mechanism.
    projection: Vec<T>,
}

/// How eq. (17) is solved and how the coordinates are partitioned.
///
/// States are given as [`Mechanism`] lays them out, times in seconds.
pub trait Solver<T: Number>: Clone + Debug {
    /// Which coordinates are independent.
    type Independent: Clone + Debug + PartialEq;

    /// A solver for this model.
    ///
    /// # Errors
    /// [`Unsupported`] names what in the model this solver cannot do.
    fn new(model: &Model, lowered: &Lowered<T>) -> Result<Self, Unsupported>;
    /// Length of the buffer of [`Solver::accelerations`].
    fn accelerations_len(&self, lowered: &Lowered<T>) -> usize;
    /// Writes the accelerations `(s̈, ẇ')` that solve eq. (17), and what [`Solver::multipliers`] needs besides.
    fn accelerations(&self, lowered: &Lowered<T>, t: T, y: &[T], out: &mut [T]);
    /// Writes the multipliers λ that go with the accelerations.
    fn multipliers(&self, lowered: &Lowered<T>, t: T, y: &[T], accelerations: &[T], lambda: &mut [T]);
    /// The best choice of independent coordinates.
    fn independent(&self, lowered: &Lowered<T>, t: T, y: &[T]) -> Self::Independent;
    /// Replaces a choice that has become poor; returns how many independent coordinates were exchanged.
    fn follow(&self, lowered: &Lowered<T>, t: T, y: &[T], choice: &mut Self::Independent) -> u32;
    /// One Newton step of the dependent positions.
    ///
    /// # Errors
    /// The pivot that vanished, or a change too large for it.
    fn newton_step(
        &self,
        lowered: &Lowered<T>,
        t: T,
        choice: &Self::Independent,
        y: &mut [T],
    ) -> Result<(), Refusal<T>>;
    /// Solves eq. (19) for the dependent velocities. Which velocities are held is the solver's: see its own
    /// documentation.
    ///
    /// # Errors
    /// The pivot that vanished.
    fn solve_velocities(
        &self,
        lowered: &Lowered<T>,
        t: T,
        choice: &Self::Independent,
        y: &mut [T],
    ) -> Result<(), T>;
    /// How clear a state is of singular poses: a pivot, and the constraint row that is left with it. `None` where there
    /// are none.
    fn clearance(&self, _lowered: &Lowered<T>, _t: T, _y: &[T]) -> Option<(T, usize)> {
        None
    }
}

/// Why a Newton step is not made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal<T> {
    /// This pivot vanishes.
    Singular(T),
    /// The change, the largest one that is safe, and the row that is violated most.
    Jump(T, T, usize),
}

impl<T> From<T> for Refusal<T> {
    fn from(pivot: T) -> Self {
        Self::Singular(pivot)
    }
}

impl<T: Number, S: Solver<T>> Assembled<T, S> {
    /// The mechanism of a model, at the model's parameters and start.
    ///
    /// # Errors
    /// [`BuildError`] if the model has no consistent start or is beyond this solver.
    pub fn new(model: &Model) -> Result<Self, BuildError> {
        let lowered = Lowered::new(model).map_err(BuildError::Start)?;
        let solver = S::new(model, &lowered).map_err(BuildError::Unsupported)?;
        let (mut phi_q_pattern, mut phi_pi_pattern) = (Vec::new(), Vec::new());
        let start = Moment { t: T::zero(), y: &lowered.start };
        lowered.phi_q(start, |row, column, _| phi_q_pattern.push(entry(row, column)));
        lowered.phi_pi(start, |row, column, _| phi_pi_pattern.push(entry(row, column)));
        let space = Space {
            accelerations: zeros(solver.accelerations_len(&lowered)),
            lambda: zeros(lowered.n_rows()),
            nu: zeros(lowered.n_rows()),
            readings: zeros(lowered.n_readings()),
            projection: Vec::new(),
        };
        let description = OwnedDescription::new(model, &lowered);
        Ok(Self { lowered, solver, description, phi_q_pattern, phi_pi_pattern, space: RefCell::new(space) })
    }

    /// The owner of a constraint row, normalisations included.
    fn owner(&self, row: usize) -> Owner {
        let body = || u16::try_from(row - self.lowered.n_rows()).expect("as many bodies as patterns hold");
        self.lowered.row_infos.get(row).map_or_else(|| Owner::Body(body()), |row| row.owner)
    }

    /// Work space of a projection.
    pub(crate) fn work(&self) -> RefMut<'_, Vec<T>> {
        RefMut::map(self.space.borrow_mut(), |space| &mut space.projection)
    }

    /// Solves eq. (17), with multipliers, and hands the solution to `f`.
    pub(crate) fn with_solution<R>(&self, at: Moment<'_, T>, f: impl FnOnce(Solution<'_, T>) -> R) -> R {
        let Space { accelerations, lambda, nu, .. } = &mut *self.space.borrow_mut();
        self.solver.accelerations(&self.lowered, at.t, at.y, accelerations);
        self.solver.multipliers(&self.lowered, at.t, at.y, accelerations, lambda);
        self.lowered.nu(at, nu);
        let lambda_nu = lambda.iter().zip(nu.iter()).fold(T::zero(), |sum, (l, nu)| sum + *l * *nu);
        f(Solution { accelerations, lambda, lambda_nu })
    }

    /// ẏ by eqs. (14), (16) and (17).
    pub(crate) fn write_derivative(&self, t: T, y: &Vec<T>, dy: &mut [T]) {
        let (lowered, at) = (&self.lowered, Moment { t, y });
        for (moving_body, dq) in dy.as_chunks_mut::<7>().0[..lowered.scene.n_bodies()].iter_mut().enumerate()
        {
            dq[..3].copy_from_slice(lowered.scene.s(y, moving_body).as_slice()); // eq. (16)
            let p_dot: Vector4<T> = p_dot(&lowered.scene.p(y, moving_body), &lowered.scene.w(y, moving_body));
            dq[3..].copy_from_slice(p_dot.as_slice());
        }
        let velocities = lowered.scene.n_q()..lowered.scene.n_q() + lowered.scene.n_v();
        let (n_q, n_v) = (lowered.scene.n_q(), lowered.scene.n_v());
        let lambda_nu = if lowered.is_driven {
            self.with_solution(at, |solution| {
                dy[velocities].copy_from_slice(&solution.accelerations[..n_v]);
                solution.lambda_nu
            })
        } else {
            let accelerations = &mut self.space.borrow_mut().accelerations;
            self.solver.accelerations(lowered, t, y, accelerations);
            dy[velocities].copy_from_slice(&accelerations[..n_v]);
            T::zero()
        };
        if let Some(work) = lowered.work {
            let power = lowered.power(at, lambda_nu, &dy[n_q..n_q + n_v]);
            dy[work] = power.non_conservative + power.drivers;
        }
        lowered.other_rates(at, &mut dy[lowered.first_of_others()..]);
    }
}

impl<T: Number, S: Solver<T>> Mechanism for Assembled<T, S> {
    type Scalar = T;
    type State = Vec<T>;
    type Rows = Vec<T>;
    type Constraints = Vec<T>;
    type Velocities = Vec<T>;
    type Readings = Vec<T>;
    type Outputs = Vec<T>;

    fn description(&self) -> &Description<'_> {
        self.description.get()
    }

    fn buffers(&self) -> Buffers<Self> {
        let lowered = &self.lowered;
        Buffers {
            rows: zeros(lowered.n_rows()),
            constraints: zeros(lowered.n_rows() + lowered.scene.n_bodies()),
            velocities: zeros(lowered.scene.n_v()),
            readings: zeros(lowered.n_readings()),
            outputs: zeros(lowered.n_outputs()),
        }
    }

    fn start(&self) -> Vec<T> {
        self.lowered.start.clone()
    }

    fn phi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.phi(Moment { t, y }, out);
    }

    fn velocity_residual(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.velocity_residual(Moment { t, y }, out);
    }

    fn applied_force(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.applied_force(Moment { t, y }, out);
    }

    fn energy(&self, t: T, y: &Vec<T>) -> Energy<T> {
        self.lowered.energy(Moment { t, y })
    }

    fn read_joints(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.lowered.read_joints(Moment { t, y }, out);
    }

    fn refer_turns(&self, t: T, y: &mut Vec<T>) {
        let readings = &mut self.space.borrow_mut().readings;
        self.lowered.read_joints(Moment { t, y }, readings);
        gyro_sim::set_turn_references(&self.lowered.turn_readings, readings, y);
    }

    fn size(&self) -> T {
        self.lowered.size
    }

    fn outputs(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        let at = Moment { t, y };
        self.with_solution(at, |solution| self.lowered.outputs(at, solution, out));
    }

    fn set_input(&mut self, index: usize, value: T) -> bool {
        self.lowered.set_input(index, value)
    }
}

impl<T: Number, S: Solver<T>> Partition for Assembled<T, S> {
    type Independent = S::Independent;

    fn independent(&self, t: T, y: &Vec<T>) -> S::Independent {
        self.solver.independent(&self.lowered, t, y)
    }

    fn follow(&self, t: T, y: &Vec<T>, choice: &mut S::Independent) -> u32 {
        self.solver.follow(&self.lowered, t, y, choice)
    }

    fn newton_step(&self, t: T, choice: &S::Independent, y: &mut Vec<T>) -> Result<(), Error> {
        self.solver.newton_step(&self.lowered, t, choice, y).map_err(|refusal| match refusal {
            Refusal::Singular(pivot) => singular(t, pivot),
            Refusal::Jump(change, limit, row) => {
                let [t, change, limit] = [t, change, limit].map(gyro_sim::Real::to_f64);
                Error::Jump { t, change, limit, owner: self.owner(row) }
            }
        })
    }

    fn is_met(&self, t: T, y: &Vec<T>, phi: &Vec<T>) -> bool {
        self.lowered.is_met(Moment { t, y }, phi)
    }

    fn solve_velocities(&self, t: T, choice: &S::Independent, y: &mut Vec<T>) -> Result<(), Error> {
        self.solver.solve_velocities(&self.lowered, t, choice, y).map_err(|pivot| singular(t, pivot))
    }

    fn clearance(&self, t: T, y: &Vec<T>) -> Option<Clearance<T>> {
        let (pivot, row) = self.solver.clearance(&self.lowered, t, y)?;
        Some(Clearance { pivot, owner: Some(self.owner(row)) })
    }
}

pub(crate) fn zeros<T: Number>(len: usize) -> Vec<T> {
    vec![number(0.0); len]
}

fn entry(row: usize, column: usize) -> (u16, u16) {
    let narrow = |index: usize| u16::try_from(index).expect("patterns hold up to 65536 rows and columns");
    (narrow(row), narrow(column))
}

fn singular<T: Number>(t: T, pivot: T) -> Error {
    Error::Singular { t: gyro_sim::Real::to_f64(t), pivot: gyro_sim::Real::to_f64(pivot), owner: None }
}
