//! Mechanisms of which the type is forgotten, buffers being slices.

use gyro_runner::motion::Maximal;
use gyro_sim::{
    Clearance, CorrectedDynamics, Description, Dynamics, Energy, Error, JointJacobian, JointLayout,
    JointSpace, Kinematics, Mechanism, Partition, Projection, Real,
};
use std::any::Any;
use std::fmt::Debug;

/// A choice of independent coordinates of any mechanism.
#[derive(Debug)]
pub struct Choice(Box<dyn ErasedChoice>);

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
pub(super) enum Term {
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
pub(super) trait Erased<T>: Any + Debug {
    fn cloned(&self) -> Box<dyn Erased<T>>;
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
    fn is_met(&self, t: T, y: &[T], phi: &[T]) -> bool;
    fn solve_velocities(&self, t: T, choice: &Choice, y: &mut [T]) -> Result<(), Error>;
    fn clearance(&self, t: T, y: &[T]) -> Option<Clearance<T>>;
    fn phi_q_pattern(&self) -> &[(u16, u16)];
    fn phi_pi_pattern(&self) -> &[(u16, u16)];
    fn description(&self) -> &Description<'_>;
    fn set_input(&mut self, index: usize, value: T) -> bool;
}

/// What solvers and linearisation ask of a tree.
pub(super) trait ErasedTree<T> {
    fn joint_layout(&self) -> &JointLayout<'_>;
    fn joint_start(&self) -> Vec<T>;
    fn rates(&self) -> Vec<T>;
    fn jacobian_buffer(&self) -> Vec<T>;
    fn input_jacobian_buffer(&self) -> Vec<T>;
    fn corrected_derivative(&self, t: T, y: &[T], dy: &mut [T]);
    fn joint_derivative(&self, t: T, x: &[T], dx: &mut [T]);
    fn joint_jacobian(&self, t: T, x: &[T], dfdx: &mut [T], dfdt: &mut [T]);
    fn joint_input_jacobian(&self, t: T, x: &[T], out: &mut [T]);
    fn closure_buffer(&self) -> Vec<T>;
    fn loop_closure(&self, t: T, x: &[T], out: &mut [T]);
    fn closure_distances(&self, t: T, x: &[T], out: &mut [T]);
    fn close_positions(&self, t: T, x: &mut [T]);
    fn close_velocities(&self, t: T, x: &mut [T]);
    fn to_maximal(&self, t: T, x: &[T], y: &mut [T]);
    fn to_joints(&self, t: T, y: &[T], x: &mut [T]);
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

/// A buffer of numbers.
pub trait Numbers<T>: Clone + AsRef<[T]> + AsMut<[T]> {}

impl<T, B: Clone + AsRef<[T]> + AsMut<[T]>> Numbers<T> for B {}

fn filled<T: Copy, B: Numbers<T>>(mut buffer: B, values: &[T]) -> B {
    buffer.as_mut().copy_from_slice(values);
    buffer
}

/// Has a buffer written to and copies it out.
fn through<T: Copy, B: Numbers<T>>(mut buffer: B, out: &mut [T], write: impl FnOnce(&mut B)) {
    write(&mut buffer);
    out.copy_from_slice(buffer.as_ref());
}

fn listed<T: Copy>(buffer: impl AsRef<[T]>) -> Vec<T> {
    buffer.as_ref().to_vec()
}

impl<T: Real + 'static, M> Erased<T> for M
where
    M: Partition<Scalar = T, Independent: 'static> + Maximal + Clone + Debug + 'static,
{
    fn cloned(&self) -> Box<dyn Erased<T>> {
        Box::new(self.clone())
    }
    fn buffer(&self, term: Term) -> Vec<T> {
        match term {
            Term::Derivative => listed(self.start()),
            Term::Phi => listed(self.buffers().constraints),
            Term::VelocityResidual | Term::Nu | Term::Gamma => listed(self.buffers().rows),
            Term::Readings => listed(self.buffers().readings),
            Term::PhiQ => listed(self.terms().phi_q),
            Term::PhiPi => listed(self.terms().phi_pi),
            Term::AppliedForce => listed(self.buffers().velocities),
            Term::Accelerations => listed(self.acceleration_buffer()),
            Term::Outputs => listed(self.buffers().outputs),
        }
    }
    fn write(&self, term: Term, t: T, y: &[T], out: &mut [T]) {
        let y = &filled(self.start(), y);
        match term {
            Term::Derivative => through(self.start(), out, |dy| self.derivative(t, y, dy)),
            Term::Phi => through(self.buffers().constraints, out, |phi| self.phi(t, y, phi)),
            Term::VelocityResidual => {
                through(self.buffers().rows, out, |rows| self.velocity_residual(t, y, rows))
            }
            Term::Readings => {
                through(self.buffers().readings, out, |readings| self.read_joints(t, y, readings))
            }
            Term::PhiQ => through(self.terms().phi_q, out, |values| self.phi_q(t, y, values)),
            Term::PhiPi => through(self.terms().phi_pi, out, |values| self.phi_pi(t, y, values)),
            Term::Nu => through(self.buffers().rows, out, |nu| self.nu(t, y, nu)),
            Term::Gamma => through(self.buffers().rows, out, |gamma| self.gamma(t, y, gamma)),
            Term::AppliedForce => {
                through(self.buffers().velocities, out, |force| self.applied_force(t, y, force))
            }
            Term::Accelerations => through(self.acceleration_buffer(), out, |a| self.accelerations(t, y, a)),
            Term::Outputs => through(self.buffers().outputs, out, |outputs| self.outputs(t, y, outputs)),
        }
    }
    fn multipliers(&self, t: T, y: &[T], accelerations: &[T], lambda: &mut [T]) {
        let y = &filled(self.start(), y);
        let accelerations = &filled(self.acceleration_buffer(), accelerations);
        through(self.buffers().rows, lambda, |lambda| {
            Dynamics::multipliers(self, t, y, accelerations, lambda)
        });
    }
    fn project(&self, t: T, y: &[T], rows: &[T], motion: &mut [T]) {
        let (y, rows) = (&filled(self.start(), y), &filled(self.buffers().rows, rows));
        through(self.buffers().velocities, motion, |motion| Projection::project(self, t, y, rows, motion));
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
    fn is_met(&self, t: T, y: &[T], phi: &[T]) -> bool {
        Partition::is_met(self, t, &filled(self.start(), y), &filled(self.buffers().constraints, phi))
    }
    fn solve_velocities(&self, t: T, choice: &Choice, y: &mut [T]) -> Result<(), Error> {
        let mut solved = filled(self.start(), y);
        let outcome = Partition::solve_velocities(self, t, choice.of(), &mut solved);
        y.copy_from_slice(solved.as_ref());
        outcome
    }
    fn clearance(&self, t: T, y: &[T]) -> Option<Clearance<T>> {
        Partition::clearance(self, t, &filled(self.start(), y))
    }
    fn phi_q_pattern(&self) -> &[(u16, u16)] {
        Kinematics::phi_q_pattern(self)
    }
    fn phi_pi_pattern(&self) -> &[(u16, u16)] {
        Kinematics::phi_pi_pattern(self)
    }
    fn description(&self) -> &Description<'_> {
        Mechanism::description(self)
    }
    fn set_input(&mut self, index: usize, value: T) -> bool {
        Mechanism::set_input(self, index, value)
    }
}

impl<T: Real + 'static, M> ErasedTree<T> for M
where
    M: JointJacobian<Scalar = T> + CorrectedDynamics,
{
    fn joint_start(&self) -> Vec<T> {
        listed(JointSpace::joint_start(self))
    }
    fn rates(&self) -> Vec<T> {
        listed(self.joint_buffers().rates)
    }
    fn jacobian_buffer(&self) -> Vec<T> {
        listed(self.jacobian_buffers().jacobian)
    }
    fn input_jacobian_buffer(&self) -> Vec<T> {
        listed(self.jacobian_buffers().input_jacobian)
    }
    fn corrected_derivative(&self, t: T, y: &[T], dy: &mut [T]) {
        let y = &filled(self.start(), y);
        through(self.start(), dy, |dy| CorrectedDynamics::corrected_derivative(self, t, y, dy));
    }
    fn joint_derivative(&self, t: T, x: &[T], dx: &mut [T]) {
        let buffer = JointSpace::joint_start(self);
        let x = &filled(buffer.clone(), x);
        through(buffer, dx, |dx| JointSpace::joint_derivative(self, t, x, dx));
    }
    fn joint_jacobian(&self, t: T, x: &[T], dfdx: &mut [T], dfdt: &mut [T]) {
        let (mut jacobian, buffer) = (self.jacobian_buffers().jacobian, JointSpace::joint_start(self));
        let x = &filled(buffer.clone(), x);
        through(buffer, dfdt, |dfdt| JointJacobian::joint_jacobian(self, t, x, &mut jacobian, dfdt));
        dfdx.copy_from_slice(jacobian.as_ref());
    }
    fn joint_input_jacobian(&self, t: T, x: &[T], out: &mut [T]) {
        let x = &filled(JointSpace::joint_start(self), x);
        let buffer = self.jacobian_buffers().input_jacobian;
        through(buffer, out, |out| JointJacobian::joint_input_jacobian(self, t, x, out));
    }
    fn joint_layout(&self) -> &JointLayout<'_> {
        JointSpace::joint_layout(self)
    }
    fn closure_buffer(&self) -> Vec<T> {
        listed(self.joint_buffers().closure)
    }
    fn loop_closure(&self, t: T, x: &[T], out: &mut [T]) {
        let x = &filled(JointSpace::joint_start(self), x);
        through(self.joint_buffers().closure, out, |out| JointSpace::loop_closure(self, t, x, out));
    }
    fn closure_distances(&self, t: T, x: &[T], out: &mut [T]) {
        let x = &filled(JointSpace::joint_start(self), x);
        through(self.joint_buffers().closure, out, |out| JointSpace::closure_distances(self, t, x, out));
    }
    fn close_positions(&self, t: T, x: &mut [T]) {
        through(filled(JointSpace::joint_start(self), x), x, |x| JointSpace::close_positions(self, t, x));
    }
    fn close_velocities(&self, t: T, x: &mut [T]) {
        through(filled(JointSpace::joint_start(self), x), x, |x| JointSpace::close_velocities(self, t, x));
    }
    fn to_maximal(&self, t: T, x: &[T], y: &mut [T]) {
        let x = &filled(JointSpace::joint_start(self), x);
        through(filled(self.start(), y), y, |y| JointSpace::to_maximal(self, t, x, y));
    }
    fn to_joints(&self, t: T, y: &[T], x: &mut [T]) {
        let (y, before) = (&filled(self.start(), y), filled(JointSpace::joint_start(self), x));
        through(before, x, |x| JointSpace::to_joints(self, t, y, x));
    }
}
