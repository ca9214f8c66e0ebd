//! The equations that are integrated, and the maximal state as seen through each of them.

use super::contract::COLUMNS;
use gyro_sim::contact::joint_accelerations;
use gyro_sim::{
    ByDuals, Dual, Dynamics, Exact, Jacobian, Joint, JointJacobian, JointPlace, JointSpace, Mechanism, Ode,
    Scalar,
};
use std::fmt::Debug;
use std::ops::Range;

/// The joint state of a maximal one, its angles nearest to given ones: one number for each coordinate, joint after
/// joint.
pub fn joints_near<M: JointSpace>(mechanism: &M, t: f64, y: &M::State, nearest: &[f64]) -> M::Joints {
    let (mut x, joints) = (mechanism.joint_start(), mechanism.description().joints);
    let mut at = 0;
    for place in mechanism.joint_layout().places {
        if let JointPlace::Scalar { joint, coordinate } = *place {
            let (joint, coordinate) = (usize::from(joint), usize::from(coordinate));
            let before: usize = joints[..joint].iter().map(|joint| joint.coordinates.len()).sum();
            if let Some(&angle) = nearest.get(before + coordinate) {
                x.as_mut()[at] = Scalar::constant(angle);
            }
        }
        at += place.n_coordinates();
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

/// An input at a time: its index, its value and its slope.
pub(super) type Moving<T> = (usize, [T; 2]);

/// Equations with a Jacobian for inputs that move.
pub(super) trait MovingInputs<M: Mechanism>: Lens<M> + Jacobian<M> {
    /// Writes ∂f/∂y, and ∂f/∂t of which the inputs, set to their values, are a part.
    fn moving_jacobian(
        &self,
        mechanism: &M,
        inputs: &[Moving<M::Scalar>],
        at: (M::Scalar, &Self::State),
        dfdy: &mut Self::Matrix,
        dfdt: &mut Self::State,
    );
}

/// Equations of a mechanism that are integrated, and how their state is shown.
pub(super) trait Lens<M: Mechanism>: Ode<M, Scalar = M::Scalar, State: 'static> + 'static {
    /// Writes the maximal state.
    fn show(&self, mechanism: &M, t: M::Scalar, from: &Self::State, to: &mut M::State);
    fn set_input(&mut self, _index: usize, _value: f64) {}
}

/// Equations that forces of contacts push.
pub(super) trait Pushed<M: Mechanism>: Lens<M> {
    /// Whether their state is the joint state.
    const IN_JOINTS: bool;

    /// Where the rates stand in the state.
    fn rates(&self, mechanism: &M) -> Range<usize>;
    /// Where the work stands in the state.
    fn work(&self, mechanism: &M) -> Option<usize>;
    /// Writes the slopes of the rates; all else may be anything.
    fn accelerate(&self, mechanism: &M, t: M::Scalar, y: &Self::State, dy: &mut Self::State);
}

fn copy<M: Mechanism>(from: &M::State, to: &mut M::State) {
    to.as_mut().copy_from_slice(from.as_ref());
}

type Derivative<M> =
    dyn Fn(&M, <M as Mechanism>::Scalar, &<M as Mechanism>::State, &mut <M as Mechanism>::State);

/// Maximal coordinates: one of the right-hand sides that a mechanism has there. Boxed, like corrections, so that
/// integrators are not compiled anew for each.
pub(super) struct Slopes<M: Mechanism>(Box<Derivative<M>>);

impl<M: Mechanism + 'static> Slopes<M> {
    pub(super) fn of(dynamics: impl Ode<M, Scalar = M::Scalar, State = M::State> + 'static) -> Self {
        Self(Box::new(move |mechanism, t, y, dy| dynamics.derivative(mechanism, t, y, dy)))
    }
}

impl<M: Mechanism> Ode<M> for Slopes<M> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn derivative(&self, mechanism: &M, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.0(mechanism, t, y, dy);
    }
}

impl<M: Mechanism<State: 'static> + 'static> Lens<M> for Slopes<M> {
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
}

impl<M: Mechanism<State: 'static> + 'static> Pushed<M> for Slopes<M> {
    const IN_JOINTS: bool = false;

    fn rates(&self, mechanism: &M) -> Range<usize> {
        let n = mechanism.description().bodies.len();
        7 * n..13 * n
    }
    fn work(&self, mechanism: &M) -> Option<usize> {
        mechanism.description().work()
    }
    fn accelerate(&self, mechanism: &M, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        self.derivative(mechanism, t, y, dy);
    }
}

/// Maximal coordinates, with a Jacobian by dual numbers.
type Duals<D, T> = ByDuals<Exact, D, <D as Mechanism>::State, Vec<T>, COLUMNS>;

impl<M, D> Lens<M> for Duals<D, M::Scalar>
where
    M: Dynamics<State: 'static, Scalar: 'static> + 'static,
    D: Dynamics<Scalar = Dual<M::Scalar, COLUMNS>, State: 'static> + 'static,
{
    fn show(&self, _: &M, _: M::Scalar, from: &M::State, to: &mut M::State) {
        copy::<M>(from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.in_duals_mut().set_input(index, Scalar::constant(value));
    }
}

impl<M: JointSpace<Joints: 'static> + 'static> Lens<M> for Joint {
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
}

macro_rules! pushed_in_joints {
    ($([$($of:tt)*] $lens:ty),*) => {$(
        impl<$($of)*> Pushed<M> for $lens
        where
            Self: Lens<M> + Ode<M, State = M::Joints>,
            M: JointSpace,
        {
            const IN_JOINTS: bool = true;

            fn rates(&self, mechanism: &M) -> Range<usize> {
                let n = mechanism.joint_layout().n_coordinates();
                n..n + mechanism.joint_layout().n_rates()
            }
            fn work(&self, mechanism: &M) -> Option<usize> {
                Some(Pushed::<M>::rates(self, mechanism).end)
            }
            fn accelerate(&self, mechanism: &M, t: M::Scalar, x: &M::Joints, dx: &mut M::Joints) {
                joint_accelerations(mechanism, t, x, dx);
            }
        }
    )*};
}

pushed_in_joints!([M] Joint, [M, D: JointSpace] JointDuals<D, M::Scalar>);

/// Joint coordinates, with a Jacobian by dual numbers.
type JointDuals<D, T> = ByDuals<Joint, D, <D as JointSpace>::Joints, Vec<T>, COLUMNS>;

pub(super) fn joint_duals<D: JointSpace + Clone, T>(duals: &D) -> JointDuals<D, T> {
    ByDuals::new(Joint, duals.clone(), duals.joint_start())
}

impl<M, D> Lens<M> for JointDuals<D, M::Scalar>
where
    M: JointSpace<Joints: 'static, Scalar: 'static> + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>, Joints: 'static> + 'static,
{
    fn show(&self, mechanism: &M, t: M::Scalar, from: &M::Joints, to: &mut M::State) {
        mechanism.to_maximal(t, from, to);
    }
    fn set_input(&mut self, index: usize, value: f64) {
        self.in_duals_mut().set_input(index, Scalar::constant(value));
    }
}

impl<M: JointJacobian<Joints: 'static> + 'static> MovingInputs<M> for Joint {
    fn moving_jacobian(
        &self,
        mechanism: &M,
        inputs: &[Moving<M::Scalar>],
        (t, x): (M::Scalar, &M::Joints),
        dfdx: &mut M::Jacobian,
        dfdt: &mut M::Joints,
    ) {
        self.jacobian(mechanism, t, x, dfdx, dfdt);
        let mut by_inputs = mechanism.jacobian_buffers().input_jacobian;
        mechanism.joint_input_jacobian(t, x, &mut by_inputs);
        let n_inputs = mechanism.description().inputs.len();
        for (slope, row) in dfdt.as_mut().iter_mut().zip(by_inputs.as_ref().chunks_exact(n_inputs)) {
            for (index, [_, rate]) in inputs {
                *slope = M::Scalar::fused(row[*index], *rate, *slope);
            }
        }
    }
}

/// By dual numbers: the model in them is set to the inputs, and once more with their slopes in the first column.
impl<M, E, D, S, T> MovingInputs<M> for ByDuals<E, D, S, Vec<T>, COLUMNS>
where
    M: Mechanism<Scalar = T>,
    T: Scalar,
    D: Mechanism<Scalar = Dual<T, COLUMNS>> + Clone,
    E: Clone + Ode<D, Scalar = Dual<T, COLUMNS>, State = S>,
    S: Clone + Debug + AsRef<[Dual<T, COLUMNS>]> + AsMut<[Dual<T, COLUMNS>]>,
    Self: Lens<M> + Jacobian<M, Matrix = Vec<T>>,
{
    fn moving_jacobian(
        &self,
        mechanism: &M,
        inputs: &[Moving<T>],
        (t, y): (T, &Self::State),
        dfdy: &mut Vec<T>,
        dfdt: &mut Self::State,
    ) {
        let mut own = self.clone();
        for (index, [value, _]) in inputs {
            own.in_duals_mut().set_input(*index, Dual::new(*value));
        }
        own.jacobian(mechanism, t, y, dfdy, dfdt);
        for (index, [value, rate]) in inputs {
            let mut moving = Dual::new(*value);
            moving.slopes[0] = *rate;
            own.in_duals_mut().set_input(*index, moving);
        }
        let by_inputs = own.derivative_of_model(t, y.as_ref());
        for (slope, of_inputs) in dfdt.as_mut().iter_mut().zip(by_inputs.as_ref()) {
            *slope = *slope + of_inputs.slopes[0];
        }
    }
}
