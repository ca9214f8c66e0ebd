//! Any mechanism behind one type: a mechanism is compiled once for each precision, and what runs and compares mechanisms once
//! for all of them.

use gyro_sim::{
    Energy, Equations, Error, JointInfo, Mechanism, Ode, OutputInfo, Partition, Ports, Projection, Real,
    RowInfo, Storage,
};
use std::any::Any;
use std::fmt::Debug;

/// A mechanism that does everything there is to do, generated or not.
#[derive(Debug)]
pub struct Engine<T = f64>(Box<dyn Erased<T>>);

/// A choice of independent coordinates of any mechanism.
#[derive(Debug)]
pub struct Choice(Box<dyn ErasedChoice>);

impl<T: Real + 'static> Engine<T> {
    /// The same mechanism, its type forgotten.
    pub fn new<M>(mechanism: M) -> Self
    where
        M: Partition<Scalar = T, Independent: 'static> + Projection + Ports + Clone + Debug + 'static,
    {
        Self(Box::new(mechanism))
    }
}

impl<T> Clone for Engine<T> {
    fn clone(&self) -> Self {
        self.0.cloned()
    }
}

impl Clone for Choice {
    fn clone(&self) -> Self {
        Self(self.0.cloned())
    }
}

impl PartialEq for Choice {
    fn eq(&self, other: &Self) -> bool {
        self.0.is(&*other.0)
    }
}

/// What a mechanism writes for a time and a state.
#[derive(Clone, Copy, Debug)]
enum Term {
    Derivative,
    Phi,
    VelocityResidual,
    Readings,
    PhiQ,
    PhiPi,
    Nu,
    Gamma,
    AppliedForce,
    Accelerations,
    Outputs,
}

/// The traits of a mechanism with all buffers as slices.
trait Erased<T>: Debug {
    fn cloned(&self) -> Engine<T>;
    /// The start for [`Term::Derivative`], else zeros.
    fn buffer(&self, term: Term) -> Vec<T>;
    fn write(&self, term: Term, t: T, y: &[T], out: &mut [T]);
    fn multipliers(&self, t: T, y: &[T], accelerations: &[T], lambda: &mut [T]);
    fn project(&self, t: T, y: &[T], rows: &[T], motion: &mut [T]);
    fn energy(&self, t: T, y: &[T]) -> Energy<T>;
    fn work(&self, y: &[T]) -> T;
    fn independent(&self, t: T, y: &[T]) -> Choice;
    fn follow(&self, t: T, y: &[T], choice: &mut Choice) -> u32;
    fn newton_step(&self, t: T, choice: &Choice, y: &mut [T]) -> Result<(), Error>;
    fn solve_velocities(&self, t: T, choice: &Choice, y: &mut [T]) -> Result<(), Error>;
    fn phi_q_pattern(&self) -> &[(u16, u16)];
    fn phi_pi_pattern(&self) -> &[(u16, u16)];
    fn n_bodies(&self) -> usize;
    fn n_joints(&self) -> usize;
    fn body_name(&self, body: usize) -> &str;
    fn joint(&self, joint: usize) -> JointInfo<'_>;
    fn coupler_name(&self, coupler: usize) -> &str;
    fn driver_name(&self, driver: usize) -> &str;
    fn row(&self, row: usize) -> RowInfo;
    fn size(&self) -> T;
    fn n_outputs(&self) -> usize;
    fn output(&self, index: usize) -> OutputInfo<'_>;
    fn n_inputs(&self) -> usize;
    fn input_name(&self, index: usize) -> &str;
    fn set_input(&mut self, index: usize, value: T) -> bool;
}

trait ErasedChoice: Any + Debug {
    fn cloned(&self) -> Box<dyn ErasedChoice>;
    fn is(&self, other: &dyn ErasedChoice) -> bool;
}

impl<C: Clone + Debug + PartialEq + 'static> ErasedChoice for C {
    fn cloned(&self) -> Box<dyn ErasedChoice> {
        Box::new(self.clone())
    }
    fn is(&self, other: &dyn ErasedChoice) -> bool {
        (other as &dyn Any).downcast_ref() == Some(self)
    }
}

impl Choice {
    fn of<C: 'static>(&self) -> &C {
        (&*self.0 as &dyn Any).downcast_ref().expect("a choice is used with the mechanism that made it")
    }
    fn of_mut<C: 'static>(&mut self) -> &mut C {
        let choice = &mut *self.0 as &mut dyn Any;
        choice.downcast_mut().expect("a choice is used with the mechanism that made it")
    }
}

fn filled<T: Copy, B: Storage<T>>(mut buffer: B, values: &[T]) -> B {
    buffer.as_mut().copy_from_slice(values);
    buffer
}

/// Has a buffer written to and copies it out.
fn through<T: Copy, B: Storage<T>>(mut buffer: B, out: &mut [T], write: impl FnOnce(&mut B)) {
    write(&mut buffer);
    out.copy_from_slice(buffer.as_ref());
}

fn listed<T: Copy>(buffer: impl AsRef<[T]>) -> Vec<T> {
    buffer.as_ref().to_vec()
}

impl<T: Real + 'static, M> Erased<T> for M
where
    M: Partition<Scalar = T, Independent: 'static> + Projection + Ports + Clone + Debug + 'static,
{
    fn cloned(&self) -> Engine<T> {
        Engine::new(self.clone())
    }
    fn buffer(&self, term: Term) -> Vec<T> {
        match term {
            Term::Derivative => listed(self.start()),
            Term::Phi => listed(self.constraints()),
            Term::VelocityResidual | Term::Nu | Term::Gamma => listed(self.rows()),
            Term::Readings => listed(self.readings()),
            Term::PhiQ => listed(self.phi_q_values()),
            Term::PhiPi => listed(self.phi_pi_values()),
            Term::AppliedForce => listed(self.velocities()),
            Term::Accelerations => listed(self.accelerations_buffer()),
            Term::Outputs => listed(self.outputs_buffer()),
        }
    }
    fn write(&self, term: Term, t: T, y: &[T], out: &mut [T]) {
        let y = &filled(self.start(), y);
        match term {
            Term::Derivative => through(self.start(), out, |dy| self.derivative(t, y, dy)),
            Term::Phi => through(self.constraints(), out, |phi| self.phi(t, y, phi)),
            Term::VelocityResidual => through(self.rows(), out, |rows| self.velocity_residual(t, y, rows)),
            Term::Readings => through(self.readings(), out, |readings| self.read_joints(t, y, readings)),
            Term::PhiQ => through(self.phi_q_values(), out, |values| self.phi_q(t, y, values)),
            Term::PhiPi => through(self.phi_pi_values(), out, |values| self.phi_pi(t, y, values)),
            Term::Nu => through(self.rows(), out, |nu| self.nu(t, y, nu)),
            Term::Gamma => through(self.rows(), out, |gamma| self.gamma(t, y, gamma)),
            Term::AppliedForce => through(self.velocities(), out, |force| self.applied_force(t, y, force)),
            Term::Accelerations => through(self.accelerations_buffer(), out, |a| self.accelerations(t, y, a)),
            Term::Outputs => through(self.outputs_buffer(), out, |outputs| self.outputs(t, y, outputs)),
        }
    }
    fn multipliers(&self, t: T, y: &[T], accelerations: &[T], lambda: &mut [T]) {
        let y = &filled(self.start(), y);
        let accelerations = &filled(self.accelerations_buffer(), accelerations);
        through(self.rows(), lambda, |lambda| Equations::multipliers(self, t, y, accelerations, lambda));
    }
    fn project(&self, t: T, y: &[T], rows: &[T], motion: &mut [T]) {
        let (y, rows) = (&filled(self.start(), y), &filled(self.rows(), rows));
        through(self.velocities(), motion, |motion| Projection::project(self, t, y, rows, motion));
    }
    fn energy(&self, t: T, y: &[T]) -> Energy<T> {
        Mechanism::energy(self, t, &filled(self.start(), y))
    }
    fn work(&self, y: &[T]) -> T {
        Mechanism::work(self, &filled(self.start(), y))
    }
    fn independent(&self, t: T, y: &[T]) -> Choice {
        Choice(Box::new(Partition::independent(self, t, &filled(self.start(), y))))
    }
    fn follow(&self, t: T, y: &[T], choice: &mut Choice) -> u32 {
        Partition::follow(self, t, &filled(self.start(), y), choice.of_mut())
    }
    fn newton_step(&self, t: T, choice: &Choice, y: &mut [T]) -> Result<(), Error> {
        let mut stepped = filled(self.start(), y);
        let outcome = Partition::newton_step(self, t, choice.of(), &mut stepped);
        y.copy_from_slice(stepped.as_ref());
        outcome
    }
    fn solve_velocities(&self, t: T, choice: &Choice, y: &mut [T]) -> Result<(), Error> {
        let mut solved = filled(self.start(), y);
        let outcome = Partition::solve_velocities(self, t, choice.of(), &mut solved);
        y.copy_from_slice(solved.as_ref());
        outcome
    }
    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        Equations::phi_q_pattern(self)
    }
    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        Equations::phi_pi_pattern(self)
    }
    fn n_bodies(&self) -> usize {
        Mechanism::n_bodies(self)
    }
    fn n_joints(&self) -> usize {
        Mechanism::n_joints(self)
    }
    fn body_name(&self, body: usize) -> &str {
        Mechanism::body_name(self, body)
    }
    fn joint(&self, joint: usize) -> JointInfo<'_> {
        Mechanism::joint(self, joint)
    }
    fn coupler_name(&self, coupler: usize) -> &str {
        Mechanism::coupler_name(self, coupler)
    }
    fn driver_name(&self, driver: usize) -> &str {
        Mechanism::driver_name(self, driver)
    }
    fn row(&self, row: usize) -> RowInfo {
        Mechanism::row(self, row)
    }
    fn size(&self) -> T {
        Mechanism::size(self)
    }
    fn n_outputs(&self) -> usize {
        Ports::n_outputs(self)
    }
    fn output(&self, index: usize) -> OutputInfo<'_> {
        Ports::output(self, index)
    }
    fn n_inputs(&self) -> usize {
        Ports::n_inputs(self)
    }
    fn input_name(&self, index: usize) -> &str {
        Ports::input_name(self, index)
    }
    fn set_input(&mut self, index: usize, value: T) -> bool {
        Ports::set_input(self, index, value)
    }
}

impl<T: Real> Ode for Engine<T> {
    type Scalar = T;
    type State = Vec<T>;
    fn start(&self) -> Vec<T> {
        self.0.buffer(Term::Derivative)
    }
    fn derivative(&self, t: T, y: &Vec<T>, dy: &mut Vec<T>) {
        self.0.write(Term::Derivative, t, y, dy);
    }
}

impl<T: Real> Mechanism for Engine<T> {
    type Rows = Vec<T>;
    type Constraints = Vec<T>;
    type Readings = Vec<T>;
    fn rows(&self) -> Vec<T> {
        self.0.buffer(Term::Nu)
    }
    fn constraints(&self) -> Vec<T> {
        self.0.buffer(Term::Phi)
    }
    fn readings(&self) -> Vec<T> {
        self.0.buffer(Term::Readings)
    }
    fn phi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::Phi, t, y, out);
    }
    fn velocity_residual(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::VelocityResidual, t, y, out);
    }
    fn energy(&self, t: T, y: &Vec<T>) -> Energy<T> {
        self.0.energy(t, y)
    }
    fn read_joints(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::Readings, t, y, out);
    }
    fn n_bodies(&self) -> usize {
        self.0.n_bodies()
    }
    fn n_joints(&self) -> usize {
        self.0.n_joints()
    }
    fn body_name(&self, body: usize) -> &str {
        self.0.body_name(body)
    }
    fn joint(&self, joint: usize) -> JointInfo<'_> {
        self.0.joint(joint)
    }
    fn coupler_name(&self, coupler: usize) -> &str {
        self.0.coupler_name(coupler)
    }
    fn driver_name(&self, driver: usize) -> &str {
        self.0.driver_name(driver)
    }
    fn row(&self, row: usize) -> RowInfo {
        self.0.row(row)
    }
    fn size(&self) -> T {
        self.0.size()
    }
    fn work(&self, y: &Vec<T>) -> T {
        self.0.work(y)
    }
}

impl<T: Real> Partition for Engine<T> {
    type Independent = Choice;
    fn independent(&self, t: T, y: &Vec<T>) -> Choice {
        self.0.independent(t, y)
    }
    fn follow(&self, t: T, y: &Vec<T>, choice: &mut Choice) -> u32 {
        self.0.follow(t, y, choice)
    }
    fn newton_step(&self, t: T, choice: &Choice, y: &mut Vec<T>) -> Result<(), Error> {
        self.0.newton_step(t, choice, y)
    }
    fn solve_velocities(&self, t: T, choice: &Choice, y: &mut Vec<T>) -> Result<(), Error> {
        self.0.solve_velocities(t, choice, y)
    }
}

impl<T: Real> Equations for Engine<T> {
    type Velocities = Vec<T>;
    type PhiQ = Vec<T>;
    type PhiPi = Vec<T>;
    type Accelerations = Vec<T>;
    fn velocities(&self) -> Vec<T> {
        self.0.buffer(Term::AppliedForce)
    }
    fn phi_q_values(&self) -> Vec<T> {
        self.0.buffer(Term::PhiQ)
    }
    fn phi_pi_values(&self) -> Vec<T> {
        self.0.buffer(Term::PhiPi)
    }
    fn accelerations_buffer(&self) -> Vec<T> {
        self.0.buffer(Term::Accelerations)
    }
    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        self.0.phi_q_pattern()
    }
    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        self.0.phi_pi_pattern()
    }
    fn phi_q(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::PhiQ, t, y, out);
    }
    fn phi_pi(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::PhiPi, t, y, out);
    }
    fn nu(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::Nu, t, y, out);
    }
    fn gamma(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::Gamma, t, y, out);
    }
    fn applied_force(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::AppliedForce, t, y, out);
    }
    fn accelerations(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::Accelerations, t, y, out);
    }
    fn multipliers(&self, t: T, y: &Vec<T>, accelerations: &Vec<T>, lambda: &mut Vec<T>) {
        self.0.multipliers(t, y, accelerations, lambda);
    }
}

impl<T: Real> Projection for Engine<T> {
    fn project(&self, t: T, y: &Vec<T>, rows: &Vec<T>, motion: &mut Vec<T>) {
        self.0.project(t, y, rows, motion);
    }
}

impl<T: Real> Ports for Engine<T> {
    type Outputs = Vec<T>;
    fn outputs_buffer(&self) -> Vec<T> {
        self.0.buffer(Term::Outputs)
    }
    fn outputs(&self, t: T, y: &Vec<T>, out: &mut Vec<T>) {
        self.0.write(Term::Outputs, t, y, out);
    }
    fn n_outputs(&self) -> usize {
        self.0.n_outputs()
    }
    fn output(&self, index: usize) -> OutputInfo<'_> {
        self.0.output(index)
    }
    fn n_inputs(&self) -> usize {
        self.0.n_inputs()
    }
    fn input_name(&self, index: usize) -> &str {
        self.0.input_name(index)
    }
    fn set_input(&mut self, index: usize, value: T) -> bool {
        self.0.set_input(index, value)
    }
}
