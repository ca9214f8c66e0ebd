//! The systems that are integrated, and the maximal state as seen through each of them.

use super::contract::{COLUMNS, Feed};
use gyro_sim::{
    Baumgarte, ByDuals, Coordinate, Dual, JointForm, JointSpace, Maximal, Mechanism, Ode, Projection, Real,
    Scalar, Storage,
};

/// ∂f/∂u of one input. What the input is set to does not matter: it enters linearly.
pub(super) fn input_column<T: Real, D>(duals: &D, input: usize, t: T, x: &[T]) -> Vec<T>
where
    D: JointSpace<Scalar = Dual<T, COLUMNS>> + Feed + Clone,
{
    let mut duals = duals.clone();
    let (mut arguments, zero, one) = (duals.joint_start(), T::constant(0.0), T::constant(1.0));
    let slopes = core::array::from_fn(|k| if k == 0 { one } else { zero });
    duals.feed(input, Dual { value: zero, slopes });
    for (argument, value) in arguments.as_mut().iter_mut().zip(x) {
        *argument = Dual::new(*value);
    }
    let mut out = arguments.clone();
    duals.joint_derivative(Dual::new(t), &arguments, &mut out);
    out.as_ref().iter().map(|number| number.slopes[0]).collect()
}

/// The joint state of a maximal one, its angles nearest to given ones: one number for each coordinate, joint after
/// joint.
pub(super) fn joints_near<M: JointSpace>(mechanism: &M, t: f64, y: &M::State, nearest: &[f64]) -> M::Joints {
    let mut x = mechanism.joint_start();
    let coordinates = (0..mechanism.n_joints()).flat_map(|joint| mechanism.joint(joint).coordinates);
    let mut place = 0;
    for (coordinate, angle) in coordinates.zip(nearest) {
        if let (Coordinate::Angle, Some(x)) = (coordinate, x.as_mut().get_mut(place)) {
            *x = Scalar::constant(*angle);
        }
        place += if *coordinate == Coordinate::Orientation { 4 } else { 1 };
    }
    mechanism.to_joints(Scalar::constant(t), y, &mut x);
    x
}

/// The joint state of a maximal one.
pub(super) fn joints<M: JointSpace>(mechanism: &M, y: &M::State) -> M::Joints {
    let mut x = mechanism.joint_start();
    mechanism.to_joints(Scalar::constant(0.0), y, &mut x);
    x
}

/// What a system of a mechanism is, however long the mechanism is borrowed.
pub(super) trait Lens<M: Mechanism>: 'static {
    type State: Storage<M::Scalar> + 'static;
    type System<'a>: Ode<Scalar = M::Scalar, State = Self::State>
    where
        M: 'a;

    fn system<'a>(&'a self, mechanism: &'a M) -> Self::System<'a>;
    /// Writes the maximal state.
    fn show(&self, mechanism: &M, t: M::Scalar, from: &Self::State, to: &mut M::State);
    fn set_input(&mut self, _index: usize, _value: f64) {}
}

fn copy<M: Mechanism>(from: &M::State, to: &mut M::State) {
    to.as_mut().copy_from_slice(from.as_ref());
}

/// A mechanism as a system of its own.
pub(super) struct Exact<'a, M>(pub(super) &'a M);

impl<M: Ode> Ode for Exact<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn start(&self) -> M::State {
        self.0.start()
    }
    fn derivative(&self, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.0.derivative(t, y, dy);
    }
}

impl<M: Mechanism> Maximal for Exact<'_, M> {
    type Mechanism = M;

    fn mechanism(&self) -> &M {
        self.0
    }
}

pub(super) type Derivative<M> = dyn Fn(&M, <M as Ode>::Scalar, &<M as Ode>::State, &mut <M as Ode>::State);

/// Maximal coordinates: one of the right-hand sides that a mechanism has there. Boxed, like corrections, so that
/// integrators are not compiled anew for each.
pub(super) struct Slopes<M: Mechanism>(pub(super) Box<Derivative<M>>);

impl<M: Mechanism> Slopes<M> {
    /// Exact on the constraints and off them.
    pub(super) fn exact() -> Self {
        Self(Box::new(|mechanism, t, y, dy| mechanism.derivative(t, y, dy)))
    }
    /// For states that are corrected every few steps.
    pub(super) fn corrected() -> Self {
        Self(Box::new(|mechanism, t, y, dy| mechanism.corrected_derivative(t, y, dy)))
    }
}

impl<M: Projection> Slopes<M> {
    /// Baumgarte's, at this rate.
    pub(super) fn steered(rate: f64) -> Self {
        Self(Box::new(move |mechanism, t, y, dy| {
            Baumgarte { mechanism, rate: Scalar::constant(rate) }.derivative(t, y, dy);
        }))
    }
}

/// A mechanism with one of its right-hand sides.
pub(super) struct Sloped<'a, M: Mechanism>(&'a M, &'a Derivative<M>);

impl<M: Mechanism> Ode for Sloped<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn start(&self) -> M::State {
        self.0.start()
    }
    fn derivative(&self, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.1(self.0, t, y, dy);
    }
}

impl<M: Mechanism> Maximal for Sloped<'_, M> {
    type Mechanism = M;

    fn mechanism(&self) -> &M {
        self.0
    }
}

impl<M: Mechanism<Scalar: 'static, State: 'static> + 'static> Lens<M> for Slopes<M> {
    type State = M::State;
    type System<'a> = Sloped<'a, M>;

    fn system<'a>(&'a self, mechanism: &'a M) -> Sloped<'a, M> {
        Sloped(mechanism, &*self.0)
    }
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
}

/// The mechanism in dual numbers, and zeros for a Jacobian.
pub(super) struct Duals<D, T>(pub(super) D, pub(super) Vec<T>);

impl<M, D> Lens<M> for Duals<D, M::Scalar>
where
    M: Mechanism<State: 'static, Scalar: 'static> + 'static,
    D: Ode<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + 'static,
{
    type State = M::State;
    type System<'a> = ByDuals<'a, Exact<'a, M>, Exact<'a, D>, Vec<M::Scalar>, COLUMNS>;

    fn system<'a>(&'a self, mechanism: &'a M) -> Self::System<'a> {
        ByDuals::new(Exact(mechanism), Exact(&self.0), &self.1)
    }
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.0.feed(index, Scalar::constant(value));
    }
}

/// Joint coordinates.
pub(super) struct Joint;

impl<M: JointSpace<Joints: 'static> + 'static> Lens<M> for Joint {
    type State = M::Joints;
    type System<'a> = JointForm<'a, M>;

    fn system<'a>(&'a self, mechanism: &'a M) -> JointForm<'a, M> {
        JointForm(mechanism)
    }
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
}

/// Joint coordinates, with a Jacobian by dual numbers.
pub(super) struct JointDuals<D, T>(pub(super) D, pub(super) Vec<T>);

impl<M, D> Lens<M> for JointDuals<D, M::Scalar>
where
    M: JointSpace<Joints: 'static, Scalar: 'static> + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Feed + 'static,
{
    type State = M::Joints;
    type System<'a> = ByDuals<'a, JointForm<'a, M>, JointForm<'a, D>, Vec<M::Scalar>, COLUMNS>;

    fn system<'a>(&'a self, mechanism: &'a M) -> Self::System<'a> {
        ByDuals::new(JointForm(mechanism), JointForm(&self.0), &self.1)
    }
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.0.feed(index, Scalar::constant(value));
    }
}
