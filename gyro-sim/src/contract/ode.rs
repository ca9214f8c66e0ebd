//! First-order systems: what integrators integrate.

use super::{CorrectedDynamics, Dynamics, JointJacobian, JointSpace, Storage};
use crate::Scalar;

/// A first-order system `ẏ = f(t, y)` of a model `M`: all that an explicit integrator needs.
///
/// The implementor says *which* equations are integrated, and the model is handed in at each call. Equations that need
/// no model beside them leave out `M`, and their solver is given `&()`:
/// ```
/// use gyro_sim::{Ode, Solver, Tsit5};
///
/// /// ÿ = −y, as a first-order system.
/// struct Oscillator;
///
/// impl Ode for Oscillator {
///     type Scalar = f64;
///     type State = [f64; 2];
///
///     fn derivative(&self, _: &(), _t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
///         *dy = [y[1], -y[0]];
///     }
/// }
///
/// # fn main() -> Result<(), gyro_sim::Error> {
/// let start = [1.0, 0.0];
/// let mut solver = Solver::new(Oscillator, Tsit5::new(&start), 0.0, &start);
/// solver.advance_to(&(), 1.0)?;
/// assert!((solver.state()[0] - 1.0_f64.cos()).abs() < 1e-7);
/// # Ok(())
/// # }
/// ```
pub trait Ode<M = ()> {
    /// The number type.
    type Scalar: Scalar;
    /// The state y.
    type State: Storage<Self::Scalar>;

    /// Writes `f(t, y)`.
    fn derivative(&self, model: &M, t: Self::Scalar, y: &Self::State, dy: &mut Self::State);

    /// Replaces y by the state that stands for it where several are the same one: Euler parameters, whose length
    /// means nothing, are made unit vectors. Methods end each step with this, so that nothing drifts away.
    fn normalise(&self, _model: &M, _y: &mut Self::State) {}
}

/// A first-order system with its Jacobian: what implicit methods need besides.
pub trait Jacobian<M = ()>: Ode<M> {
    /// ∂f/∂y, n × n for a state of n numbers, row by row.
    type Matrix: Storage<Self::Scalar>;

    /// Writes ∂f/∂y, row by row, and ∂f/∂t.
    fn jacobian(
        &self,
        model: &M,
        t: Self::Scalar,
        y: &Self::State,
        dfdy: &mut Self::Matrix,
        dfdt: &mut Self::State,
    );
}

/// A mechanism's equations of motion in maximal coordinates, exact on the constraints and off them:
/// [`Dynamics::derivative`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Exact;

/// The same for states that are corrected every few steps: [`CorrectedDynamics::corrected_derivative`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Corrected;

/// The equations of motion in joint coordinates: [`JointSpace::joint_derivative`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Joint;

impl<M: Dynamics> Ode<M> for Exact {
    type Scalar = M::Scalar;
    type State = M::State;

    fn derivative(&self, mechanism: &M, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        mechanism.derivative(t, y, dy);
    }
}

impl<M: CorrectedDynamics> Ode<M> for Corrected {
    type Scalar = M::Scalar;
    type State = M::State;

    fn derivative(&self, mechanism: &M, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        mechanism.corrected_derivative(t, y, dy);
    }
}

impl<M: JointSpace> Ode<M> for Joint {
    type Scalar = M::Scalar;
    type State = M::Joints;

    fn derivative(&self, mechanism: &M, t: M::Scalar, x: &M::Joints, dx: &mut M::Joints) {
        mechanism.joint_derivative(t, x, dx);
    }
    #[inline(always)]
    fn normalise(&self, mechanism: &M, x: &mut M::Joints) {
        mechanism.joint_layout().normalise(x.as_mut());
    }
}

impl<M: JointJacobian> Jacobian<M> for Joint {
    type Matrix = M::Jacobian;

    fn jacobian(
        &self,
        mechanism: &M,
        t: M::Scalar,
        x: &M::Joints,
        dfdx: &mut M::Jacobian,
        dfdt: &mut M::Joints,
    ) {
        mechanism.joint_jacobian(t, x, dfdx, dfdt);
    }
}

/// What a method integrates during a call: the equations and the model that they are of.
#[derive(Debug)]
pub struct System<'a, D, M> {
    /// The equations.
    pub dynamics: &'a D,
    /// The model.
    pub model: &'a M,
}

impl<D, M> Clone for System<'_, D, M> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<D, M> Copy for System<'_, D, M> {}

impl<D: Ode<M>, M> System<'_, D, M> {
    /// Writes `f(t, y)`.
    #[inline(always)]
    pub fn derivative(&self, t: D::Scalar, y: &D::State, dy: &mut D::State) {
        self.dynamics.derivative(self.model, t, y, dy);
    }

    /// Replaces y by the state that stands for it: [`Ode::normalise`].
    #[inline(always)]
    pub fn normalise(&self, y: &mut D::State) {
        self.dynamics.normalise(self.model, y);
    }
}

impl<D: Jacobian<M>, M> System<'_, D, M> {
    /// Writes ∂f/∂y and ∂f/∂t.
    #[inline(always)]
    pub fn jacobian(&self, t: D::Scalar, y: &D::State, dfdy: &mut D::Matrix, dfdt: &mut D::State) {
        self.dynamics.jacobian(self.model, t, y, dfdy, dfdt);
    }
}
