//! Any mechanism behind one type: a mechanism is compiled once for each precision, and what runs and compares
//! mechanisms once for all of them.

mod erased;

pub use erased::Choice;

use erased::{Erased, ErasedTree, Term};
use gyro_jit::Interpreted;
use gyro_runner::motion::{COLUMNS, Closing, Maximal, MotionBuilder, TreeWithJacobian, WithDuals};
use gyro_sim::{
    Buffers, Clearance, CorrectedDynamics, Description, Dual, Dynamics, Energy, Error, JacobianBuffers,
    JointBuffers, JointJacobian, JointLayout, JointSpace, Kinematics, Mechanism, Partition, Projection, Real,
    Terms,
};
use std::any::Any;
use std::fmt::Debug;

/// A mechanism that does everything there is to do, generated or not.
#[derive(Debug)]
pub struct Engine<T = f64> {
    mechanism: Box<dyn Erased<T>>,
    /// The same as a tree, if it is one.
    tree: AsTree<T>,
}

type AsTree<T> = for<'a> fn(&'a dyn Erased<T>) -> Option<&'a dyn ErasedTree<T>>;

/// The same mechanism in dual numbers, where there is need of it.
#[derive(Clone, Debug)]
pub struct Duals<T = f64>(Option<Interpreted<Dual<T, COLUMNS>>>);

impl<T: Real + 'static> Engine<T> {
    /// The same mechanism, its type forgotten.
    pub fn new<M>(mechanism: M) -> Self
    where
        M: Partition<Scalar = T, Independent: 'static> + Maximal + Clone + Debug + 'static,
    {
        Self { mechanism: Box::new(mechanism), tree: |_| None }
    }

    /// A tree, with its joint coordinates.
    pub fn of_tree<M>(mechanism: M) -> Self
    where
        M: Partition<Scalar = T, Independent: 'static> + Maximal + JointJacobian + Clone + Debug + 'static,
    {
        let tree: AsTree<T> = |mechanism| {
            let mechanism = mechanism as &dyn Any;
            mechanism.downcast_ref::<M>().map(|tree| tree as &dyn ErasedTree<T>)
        };
        Self { mechanism: Box::new(mechanism), tree }
    }

    /// Whether it has joint coordinates.
    pub fn is_tree(&self) -> bool {
        (self.tree)(&*self.mechanism).is_some()
    }

    /// All that motions of it can be begun with, as a program of its own would have it.
    pub fn builder(&self, duals: Duals<T>) -> Box<dyn MotionBuilder<Self>> {
        if self.is_tree() { Box::new(TreeWithJacobian(duals)) } else { Box::new(WithDuals(duals)) }
    }

    fn tree(&self) -> &dyn ErasedTree<T> {
        (self.tree)(&*self.mechanism).expect("only trees have joint coordinates")
    }
}

impl<T: Real + 'static> Duals<T> {
    /// Those of a mechanism.
    pub fn new(mechanism: Interpreted<Dual<T, COLUMNS>>) -> Self {
        Self(Some(mechanism))
    }

    /// For what Rodas does not integrate in maximal coordinates.
    pub fn none() -> Self {
        Self(None)
    }
}

impl<T: 'static> Clone for Engine<T> {
    fn clone(&self) -> Self {
        Self { mechanism: self.mechanism.cloned(), tree: self.tree }
    }
}

/// Only what linearisation asks for.
impl<T: Real + 'static> Mechanism for Duals<T> {
    type Scalar = Dual<T, COLUMNS>;
    type State = Vec<Dual<T, COLUMNS>>;
    type Rows = Vec<Dual<T, COLUMNS>>;
    type Constraints = Vec<Dual<T, COLUMNS>>;
    type Velocities = Vec<Dual<T, COLUMNS>>;
    type Readings = Vec<Dual<T, COLUMNS>>;
    type Outputs = Vec<Dual<T, COLUMNS>>;
    fn description(&self) -> &Description<'_> {
        unreachable!("{NOT_FORWARDED}")
    }
    fn buffers(&self) -> Buffers<Self> {
        unreachable!("{NOT_FORWARDED}")
    }
    fn start(&self) -> Self::State {
        self.0.as_ref().expect(NO_DUALS).start()
    }
    fn phi(&self, _: Self::Scalar, _: &Self::State, _: &mut Self::State) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn velocity_residual(&self, _: Self::Scalar, _: &Self::State, _: &mut Self::State) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn applied_force(&self, _: Self::Scalar, _: &Self::State, _: &mut Self::State) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn energy(&self, _: Self::Scalar, _: &Self::State) -> Energy<Self::Scalar> {
        unreachable!("{NOT_FORWARDED}")
    }
    fn read_joints(&self, _: Self::Scalar, _: &Self::State, _: &mut Self::State) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn outputs(&self, _: Self::Scalar, _: &Self::State, _: &mut Self::State) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn set_input(&mut self, index: usize, value: Self::Scalar) -> bool {
        self.0.as_mut().is_some_and(|duals| duals.set_input(index, value))
    }
}

impl<T: Real + 'static> Dynamics for Duals<T> {
    type Accelerations = Vec<Dual<T, COLUMNS>>;
    fn acceleration_buffer(&self) -> Self::Accelerations {
        unreachable!("{NOT_FORWARDED}")
    }
    fn accelerations(&self, _: Self::Scalar, _: &Self::State, _: &mut Self::State) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn multipliers(&self, _: Self::Scalar, _: &Self::State, _: &Self::State, _: &mut Self::State) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn derivative(&self, t: Self::Scalar, y: &Self::State, dy: &mut Self::State) {
        self.0.as_ref().expect(NO_DUALS).derivative(t, y, dy);
    }
}

/// For loops, which are linearised without an engine.
impl<T: Real + 'static> Closing for Duals<T> {
    fn close(&self, _: Self::Scalar, _: &mut [Self::Scalar]) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn outputs_of(&self, _: Self::Scalar, _: &[Self::Scalar]) -> Vec<Self::Scalar> {
        unreachable!("{NOT_FORWARDED}")
    }
}

const NO_DUALS: &str = "this model file has no dual numbers here: add it to `duals`";

impl<T: Real + 'static> Mechanism for Engine<T> {
    type Scalar = T;
    type State = Vec<T>;
    type Rows = Vec<T>;
    type Constraints = Vec<T>;
    type Velocities = Vec<T>;
    type Readings = Vec<T>;
    type Outputs = Vec<T>;
    fn description(&self) -> &Description<'_> {
        self.mechanism.description()
    }
    fn buffers(&self) -> Buffers<Self> {
        Buffers {
            rows: self.mechanism.buffer(Term::Nu),
            constraints: self.mechanism.buffer(Term::Phi),
            velocities: self.mechanism.buffer(Term::AppliedForce),
            readings: self.mechanism.buffer(Term::Readings),
            outputs: self.mechanism.buffer(Term::Outputs),
        }
    }
    fn start(&self) -> Vec<T> {
        self.mechanism.buffer(Term::Derivative)
    }
    fn phi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::Phi, t, y, out);
    }
    fn velocity_residual(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::VelocityResidual, t, y, out);
    }
    fn applied_force(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::AppliedForce, t, y, out);
    }
    fn energy(&self, t: T, y: &Vec<T>) -> Energy<T> {
        self.mechanism.energy(t, y)
    }
    fn read_joints(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::Readings, t, y, out);
    }
    fn outputs(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::Outputs, t, y, out);
    }
    fn set_input(&mut self, index: usize, value: T) -> bool {
        self.mechanism.set_input(index, value)
    }
    fn work(&self, y: &Vec<T>) -> T {
        self.mechanism.work(y)
    }
}

impl<T: Real + 'static> Partition for Engine<T> {
    type Independent = Choice;
    fn independent(&self, t: T, y: &Vec<T>) -> Choice {
        self.mechanism.independent(t, y)
    }
    fn follow(&self, t: T, y: &Vec<T>, choice: &mut Choice) -> u32 {
        self.mechanism.follow(t, y, choice)
    }
    fn newton_step(&self, t: T, choice: &Choice, y: &mut Vec<T>) -> Result<(), Error> {
        self.mechanism.newton_step(t, choice, y)
    }
    fn is_met(&self, t: T, y: &Vec<T>, phi: &Vec<T>) -> bool {
        self.mechanism.is_met(t, y, phi)
    }
    fn solve_velocities(&self, t: T, choice: &Choice, y: &mut Vec<T>) -> Result<(), Error> {
        self.mechanism.solve_velocities(t, choice, y)
    }
    fn clearance(&self, t: T, y: &Vec<T>) -> Option<Clearance<T>> {
        self.mechanism.clearance(t, y)
    }
}

impl<T: Real + 'static> Kinematics for Engine<T> {
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;
    fn terms(&self) -> Terms<Self> {
        Terms { phi_q: self.mechanism.buffer(Term::PhiQ), phi_pi: self.mechanism.buffer(Term::PhiPi) }
    }
    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        self.mechanism.phi_q_pattern()
    }
    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        self.mechanism.phi_pi_pattern()
    }
    fn phi_q(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::PhiQ, t, y, out);
    }
    fn phi_pi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::PhiPi, t, y, out);
    }
    fn nu(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::Nu, t, y, out);
    }
    fn gamma(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::Gamma, t, y, out);
    }
}

impl<T: Real + 'static> Dynamics for Engine<T> {
    type Accelerations = Vec<T>;
    fn acceleration_buffer(&self) -> Vec<T> {
        self.mechanism.buffer(Term::Accelerations)
    }
    fn accelerations(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.mechanism.write(Term::Accelerations, t, y, out);
    }
    fn multipliers(&self, t: T, y: &Vec<T>, accelerations: &Vec<T>, lambda: &mut Vec<T>) {
        self.mechanism.multipliers(t, y, accelerations, lambda);
    }
    fn derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        self.mechanism.write(Term::Derivative, t, y, dy);
    }
}

impl<T: Real + 'static> CorrectedDynamics for Engine<T> {
    fn corrected_accelerations(&self, _: T, _: &Vec<T>, _: &mut Vec<T>) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn corrected_derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        match (self.tree)(&*self.mechanism) {
            Some(tree) => tree.corrected_derivative(t, y, dy),
            None => self.derivative(t, y, dy),
        }
    }
}

impl<T: Real + 'static> Projection for Engine<T> {
    fn project(&self, t: T, y: &Vec<T>, rows: &Vec<T>, motion: &mut Vec<T>) {
        self.mechanism.project(t, y, rows, motion);
    }
}

/// Only what solvers and linearisation ask for.
impl<T: Real + 'static> JointSpace for Engine<T> {
    type Joints = Vec<T>;
    type Rates = Vec<T>;
    type Closure = Vec<T>;
    fn joint_layout(&self) -> &JointLayout<'_> {
        self.tree().joint_layout()
    }
    fn joint_buffers(&self) -> JointBuffers<Self> {
        let tree = self.tree();
        JointBuffers { rates: tree.rates(), closure: tree.closure_buffer() }
    }
    fn joint_start(&self) -> Vec<T> {
        self.tree().joint_start()
    }
    fn joint_accelerations(&self, _: T, _: &Vec<T>, _: &mut Vec<T>) {
        unreachable!("{NOT_FORWARDED}")
    }
    fn joint_derivative(&self, t: T, x: &Vec<T>, dx: &mut Vec<T>) {
        self.tree().joint_derivative(t, x, dx);
    }
    fn to_maximal(&self, t: T, x: &Vec<T>, y: &mut Vec<T>) {
        self.tree().to_maximal(t, x, y);
    }
    fn to_joints(&self, t: T, y: &Vec<T>, x: &mut Vec<T>) {
        self.tree().to_joints(t, y, x);
    }
    fn loop_closure(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.tree().loop_closure(t, x, out);
    }
    fn closure_distances(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.tree().closure_distances(t, x, out);
    }
    fn close_positions(&self, t: T, x: &mut Vec<T>) {
        self.tree().close_positions(t, x);
    }
    fn close_velocities(&self, t: T, x: &mut Vec<T>) {
        self.tree().close_velocities(t, x);
    }
}

impl<T: Real + 'static> JointJacobian for Engine<T> {
    type Jacobian = Vec<T>;
    type InputJacobian = Vec<T>;
    fn jacobian_buffers(&self) -> JacobianBuffers<Self> {
        let tree = self.tree();
        JacobianBuffers { jacobian: tree.jacobian_buffer(), input_jacobian: tree.input_jacobian_buffer() }
    }
    fn joint_jacobian(&self, t: T, x: &Vec<T>, dfdx: &mut Vec<T>, dfdt: &mut Vec<T>) {
        self.tree().joint_jacobian(t, x, dfdx, dfdt);
    }
    fn joint_input_jacobian(&self, t: T, x: &Vec<T>, out: &mut Vec<T>) {
        self.tree().joint_input_jacobian(t, x, out);
    }
}

/// Each kernel of each model file costs its compilation.
const NOT_FORWARDED: &str = "ask the mechanism itself: an engine does not have it";
