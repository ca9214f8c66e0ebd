//! A mechanism compiled in the process against the same one compiled by rustc: every function of the contract has the
//! same bits, at states on the constraints and off them, and so have short runs.

use chacha20::ChaCha8Rng;
use gyro_codegen::{Effort, Functions};
use gyro_jit::Compiled;
use gyro_model::Model;
use gyro_sim::{
    Corrected, CorrectedDynamics, CorrectedSolution, Dynamics, Joint, JointSpace, Kinematics, Kutta4,
    Mechanism, Ode, Partition, Projection, Solver,
};
use rand::{RngExt, SeedableRng};

/// What is not a number is alike.
fn bits(numbers: &[f64]) -> Vec<u64> {
    numbers.iter().map(|x| if x.is_nan() { f64::NAN.to_bits() } else { x.to_bits() }).collect()
}

/// Steps of a short run, and their length, s.
const STEPS: usize = 8;
const STEP: f64 = 1e-3;

/// A mechanism by rustc and the same one compiled in the process.
struct Pair<'n, M> {
    name: &'n str,
    rustc: M,
    ours: Compiled<f64>,
    t: f64,
}

macro_rules! compare {
    ($pair:ident: $what:ident($($argument:expr),*) into $theirs:expr, $ours:expr) => {{
        let (mut theirs, mut ours) = ($theirs, $ours);
        $pair.rustc.$what($pair.t, $(&$argument.0,)* &mut theirs);
        $pair.ours.$what($pair.t, $(&$argument.1,)* &mut ours);
        assert_eq!(bits(theirs.as_ref()), bits(&ours), "{}: {}", $pair.name, stringify!($what));
        (theirs, ours)
    }};
}

impl<M> Pair<'_, M>
where
    M: Mechanism<Scalar = f64> + Kinematics + Dynamics + CorrectedDynamics + Projection + Partition,
{
    /// The start, each number changed by up to this much.
    fn state(&self, dice: &mut ChaCha8Rng, noise: f64) -> (M::State, Vec<f64>) {
        let mut theirs = self.rustc.start();
        for x in theirs.as_mut() {
            *x += noise * dice.random_range(-1.0..1.0);
        }
        let ours = theirs.as_ref().to_vec();
        (theirs, ours)
    }

    fn check_maximal(&self, y: &(M::State, Vec<f64>)) {
        let (rustc, ours) = (self.rustc.buffers(), self.ours.buffers());
        let (terms, our_terms) = (self.rustc.terms(), self.ours.terms());
        compare!(self: phi(y) into rustc.constraints.clone(), ours.constraints);
        compare!(self: velocity_residual(y) into rustc.rows.clone(), ours.rows.clone());
        compare!(self: applied_force(y) into rustc.velocities.clone(), ours.velocities.clone());
        compare!(self: read_joints(y) into rustc.readings, ours.readings);
        compare!(self: outputs(y) into rustc.outputs, ours.outputs);
        compare!(self: phi_q(y) into terms.phi_q, our_terms.phi_q);
        compare!(self: phi_pi(y) into terms.phi_pi, our_terms.phi_pi);
        compare!(self: nu(y) into rustc.rows.clone(), ours.rows.clone());
        let rows = compare!(self: gamma(y) into rustc.rows.clone(), ours.rows.clone());
        let solved = compare!(self: accelerations(y) into self.rustc.acceleration_buffer(), self.ours.acceleration_buffer());
        compare!(self: multipliers(y, solved) into rustc.rows, ours.rows);
        compare!(self: derivative(y) into y.0.clone(), y.1.clone());
        compare!(self: corrected_accelerations(y) into rustc.velocities.clone(), ours.velocities.clone());
        compare!(self: corrected_derivative(y) into y.0.clone(), y.1.clone());
        compare!(self: project(y, rows) into rustc.velocities, ours.velocities);
        let (theirs, ours) = (self.rustc.energy(self.t, &y.0), self.ours.energy(self.t, &y.1));
        assert_eq!(
            bits(&[theirs.kinetic, theirs.potential]),
            bits(&[ours.kinetic, ours.potential]),
            "{}",
            self.name
        );
        assert_eq!(self.rustc.phi_q_pattern(), self.ours.phi_q_pattern(), "{}", self.name);
        assert_eq!(self.rustc.phi_pi_pattern(), self.ours.phi_pi_pattern(), "{}", self.name);
    }

    /// The coordinate partition: the choice shows in what it does.
    fn check_partition(&self, y: &(M::State, Vec<f64>), other: &(M::State, Vec<f64>)) {
        let mut theirs = self.rustc.independent(self.t, &y.0);
        let mut ours = self.ours.independent(self.t, &y.1);
        let followed = self.rustc.follow(self.t, &other.0, &mut theirs);
        assert_eq!(followed, self.ours.follow(self.t, &other.1, &mut ours), "{}", self.name);
        let (mut their_y, mut our_y) = other.clone();
        let words = |outcome: Result<(), gyro_sim::Error>| format!("{outcome:?}");
        for _ in 0..2 {
            let step = self.rustc.newton_step(self.t, &theirs, &mut their_y);
            assert_eq!(words(step), words(self.ours.newton_step(self.t, &ours, &mut our_y)), "{}", self.name);
            let solved = self.rustc.solve_velocities(self.t, &theirs, &mut their_y);
            assert_eq!(
                words(solved),
                words(self.ours.solve_velocities(self.t, &ours, &mut our_y)),
                "{}",
                self.name
            );
            assert_eq!(bits(their_y.as_ref()), bits(&our_y), "{}: partition", self.name);
        }
        let clearance = |clearance: Option<gyro_sim::Clearance<f64>>| format!("{clearance:?}");
        let (theirs, ours) = (self.rustc.clearance(self.t, &y.0), self.ours.clearance(self.t, &y.1));
        assert_eq!(clearance(theirs), clearance(ours), "{}", self.name);
    }
}

impl<M> Pair<'_, M>
where
    M: Mechanism<Scalar = f64> + CorrectedSolution,
{
    fn check_joints(&self, dice: &mut ChaCha8Rng, y: &(M::State, Vec<f64>)) {
        let start = self.rustc.joint_start();
        assert_eq!(bits(start.as_ref()), bits(&self.ours.joint_start()), "{}", self.name);
        assert_eq!(self.rustc.joint_layout(), self.ours.joint_layout(), "{}", self.name);
        let mut theirs = start.clone();
        for x in theirs.as_mut() {
            *x += 0.05 * dice.random_range(-1.0..1.0);
        }
        let x = &(theirs.clone(), theirs.as_ref().to_vec());
        let (rustc, ours) = (self.rustc.joint_buffers(), self.ours.joint_buffers());
        compare!(self: joint_accelerations(x) into rustc.rates.clone(), ours.rates.clone());
        compare!(self: joint_derivative(x) into x.0.clone(), x.1.clone());
        compare!(self: to_maximal(x) into y.0.clone(), y.1.clone());
        compare!(self: to_joints(y) into x.0.clone(), x.1.clone());
        compare!(self: loop_closure(x) into rustc.closure.clone(), ours.closure.clone());
        compare!(self: closure_distances(x) into rustc.closure, ours.closure);
        compare!(self: close_positions() into x.0.clone(), x.1.clone());
        compare!(self: close_velocities() into x.0.clone(), x.1.clone());
        compare!(self: joint_accelerations_at(y) into rustc.rates, ours.rates);
        compare!(self: corrected_solution(y) into self.rustc.solution_buffer(), self.ours.solution_buffer());
    }
}

/// Takes a few steps; the end, or why there is none.
fn ends<D, M>(dynamics: D, mechanism: &M, start: &D::State) -> Result<Vec<u64>, String>
where
    D: Ode<M, Scalar = f64>,
{
    let mut solver = Solver::new(dynamics, Kutta4::new(start), 0.0, start);
    for _ in 0..STEPS {
        solver.step(mechanism, STEP).map_err(|error| format!("{error:?}"))?;
    }
    Ok(bits(solver.state().as_ref()))
}

impl<'n, M> Pair<'n, M>
where
    M: Mechanism<Scalar = f64> + Kinematics + Dynamics + CorrectedDynamics + Projection + Partition,
{
    fn new(name: &'n str, model: &Model, rustc: M) -> Self {
        let ours = gyro_jit::compile::<f64>(model, &Functions::of_solvers(), Effort::Full).unwrap();
        assert_eq!(rustc.description(), ours.description(), "{name}");
        assert_eq!(bits(rustc.start().as_ref()), bits(&ours.start()), "{name}");
        Self { name, rustc, ours, t: 0.37 }
    }

    /// At the start, close to it and off it.
    fn check(&self, dice: &mut ChaCha8Rng) -> [(M::State, Vec<f64>); 3] {
        let states = [0.0, 1e-6, 0.05].map(|noise| self.state(dice, noise));
        states.iter().for_each(|y| self.check_maximal(y));
        self.check_partition(&states[0], &states[1]);
        self.check_partition(&states[2], &states[0]);
        let y = &states[0];
        assert_eq!(
            ends(Corrected, &self.rustc, &y.0),
            ends(Corrected, &self.ours, &y.1),
            "{}: a run",
            self.name
        );
        states
    }

    fn n_kernels(&self) -> usize {
        self.ours.scheduled().kernels.len()
    }
}

/// Compares all functions that any mechanism has; returns of how many kernels they are made.
#[allow(dead_code, reason = "only random model files have no joint coordinates")]
pub fn check<M>(name: &str, model: &Model, rustc: M) -> usize
where
    M: Mechanism<Scalar = f64> + Kinematics + Dynamics + CorrectedDynamics + Projection + Partition,
{
    let pair = Pair::new(name, model, rustc);
    pair.check(&mut ChaCha8Rng::seed_from_u64(7));
    pair.n_kernels()
}

/// The same with those of joint coordinates.
pub fn check_with_joints<M>(name: &str, model: &Model, rustc: M) -> usize
where
    M: Mechanism<Scalar = f64>
        + Kinematics
        + Dynamics
        + CorrectedSolution
        + Projection
        + Partition
        + JointSpace,
{
    let (pair, mut dice) = (Pair::new(name, model, rustc), ChaCha8Rng::seed_from_u64(7));
    let states = pair.check(&mut dice);
    states.iter().for_each(|y| pair.check_joints(&mut dice, y));
    let (x, ours) = (pair.rustc.joint_start(), pair.ours.joint_start());
    assert_eq!(
        ends(Joint, &pair.rustc, &x),
        ends(Joint, &pair.ours, &ours),
        "{name}: a run in joint coordinates"
    );
    pair.n_kernels()
}
