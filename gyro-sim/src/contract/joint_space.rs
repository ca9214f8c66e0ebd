//! Joint coordinates of trees.

use super::{Equations, Storage};

/// A tree in joint coordinates: the state-space form, with the maps to and from maximal coordinates, and shorter
/// formulas for the accelerations of a maximal state that satisfies the constraints.
///
/// The joint state is `(x, u [, work])`. x has, joint after joint in the order of the model file, each scalar
/// coordinate (an angle, rad, continuous over turns; a displacement, m), and then, of spherical joints and points on a
/// line, the Euler parameters of the second body in the first's frame; after the joints, of each free body `r` and `p`.
/// u has their rates: of Euler parameters the angular velocity relative to the first body in the second's frame, rad/s,
/// of free bodies `s` and `w'`.
///
/// # The Jacobian
/// Generated trees of up to eight rates have the derivatives of the joint form `ẋ = f(t, x)`, unless a third derivative
/// of a table would be needed; for the others both Jacobians are `()`. They are the derivatives of the emitted
/// functions as they stand, in directions too in which the state cannot change (of Euler parameters, across their unit
/// sphere).
pub trait JointSpace: Equations {
    /// `(x, u [, work])`.
    type Joints: Storage<Self::Scalar>;
    /// One scalar for each rate.
    type Rates: Storage<Self::Scalar>;
    /// One scalar for each unknown of eq. (17).
    type Solution: Storage<Self::Scalar>;
    /// ∂f/∂x, n × n for a joint state of n numbers, row by row.
    type Jacobian: Clone;
    /// ∂f/∂(inputs), n × m for m inputs, row by row.
    type InputJacobian: Clone;

    /// Buffers, zeroed.
    fn joint_buffers(&self) -> JointBuffers<Self>;
    /// The assembled start, with all parameters at their defaults.
    fn joint_start(&self) -> Self::Joints;
    /// Writes u̇.
    fn joint_accelerations(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::Rates);
    /// Writes the derivative of the joint state; [`Joint`](crate::Joint) integrates it.
    fn joint_derivative(&self, t: Self::Scalar, x: &Self::Joints, dx: &mut Self::Joints);
    /// Writes the maximal state of a joint state; it satisfies the constraints.
    fn to_maximal(&self, t: Self::Scalar, x: &Self::Joints, y: &mut Self::State);
    /// Writes the joint state of a maximal state; angles are those nearest to the previous contents of `x`.
    fn to_joints(&self, t: Self::Scalar, y: &Self::State, x: &mut Self::Joints);
    /// Writes u̇ at a maximal state that satisfies the constraints.
    fn joint_accelerations_at(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rates);
    /// Writes (s̈, ẇ') at a maximal state that satisfies the constraints; elsewhere
    /// [`Equations::accelerations`] solves eq. (17).
    fn corrected_accelerations(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Velocities);
    /// Writes λ of all joint rows at such a state and these accelerations.
    fn corrected_multipliers(
        &self,
        t: Self::Scalar,
        y: &Self::State,
        accelerations: &Self::Velocities,
        lambda: &mut Self::Rows,
    );
    /// Writes both, (s̈, ẇ') and then λ; what they have in common is computed once.
    fn corrected_solution(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Solution);
    /// Writes ∂f/∂x, row by row, and ∂f/∂t of [`JointSpace::joint_derivative`]. Implemented where
    /// [`JointSpace::Jacobian`] is not `()`.
    fn joint_jacobian(
        &self,
        _t: Self::Scalar,
        _x: &Self::Joints,
        _dfdx: &mut Self::Jacobian,
        _dfdt: &mut Self::Joints,
    ) {
    }
    /// Writes ∂f/∂(inputs), row by row. Implemented where [`JointSpace::InputJacobian`] is not `()`.
    fn joint_input_jacobian(&self, _t: Self::Scalar, _x: &Self::Joints, _out: &mut Self::InputJacobian) {}
}

/// What the functions of [`JointSpace`] write to.
#[derive(Clone, Debug)]
pub struct JointBuffers<M: JointSpace + ?Sized> {
    /// For [`JointSpace::joint_accelerations`].
    pub rates: M::Rates,
    /// For [`JointSpace::corrected_solution`].
    pub solution: M::Solution,
    /// For [`JointSpace::joint_jacobian`].
    pub jacobian: M::Jacobian,
    /// For [`JointSpace::joint_input_jacobian`].
    pub input_jacobian: M::InputJacobian,
}
