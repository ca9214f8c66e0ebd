//! Joint coordinates.

use super::{Mechanism, Storage};
use crate::Scalar;
use crate::euler_parameters::normalise;
#[cfg(feature = "wire")]
use crate::wire::*;

/// A mechanism in joint coordinates, with the maps to and from maximal coordinates.
///
/// The joint state is `(x, u [, work])`: coordinates of a tree of joints that carries all bodies, and their rates, as
/// [`JointSpace::joint_layout`] lists them. x has, joint after joint in the order of the model file, each scalar
/// coordinate (an angle, rad, continuous over turns; a displacement, m), and then, of spherical joints and points on a
/// line, the Euler parameters of the second body in the first's frame; after the joints, of each free body `r` and `p`.
/// Euler parameters may have any length but zero: the rotation is that of `p / |p|`.
/// u has their rates: of Euler parameters the angular velocity relative to the first body in the second's frame, rad/s,
/// of free bodies `s` and `w'`. Coordinates that couplers, drivers or loops determine as functions of others and of
/// time are not among them. Last in x come turn references of joints that close loops, where something depends on how
/// often these have turned, and then the states of the model file (currents, temperatures); neither have rates in u.
///
/// # Loops
/// Joints that are not of the tree close loops. What is left of their rows is the closure `Φ_c(t, x) = 0`. Of the
/// closure's Jacobian J the columns are rates: `Φ̇_c = J u + ∂Φ_c/∂t`. u̇ is defined off the closure too, such that
/// `Φ̈_c = 0`; what drifts off it all the same, [`CloseLoops`](crate::CloseLoops) brings back. Trees have no closure:
/// joint coordinates satisfy all rows by construction.
pub trait JointSpace: Mechanism {
    /// `(x, u [, work])`.
    type Joints: Storage<Self::Scalar>;
    /// One scalar for each rate.
    type Rates: Storage<Self::Scalar>;
    /// One scalar for each row of the closure.
    type Closure: Storage<Self::Scalar>;

    /// Where the numbers of a joint state stand, and which rows are the closure.
    fn joint_layout(&self) -> &JointLayout<'_>;
    /// Buffers, zeroed.
    fn joint_buffers(&self) -> JointBuffers<Self>;
    /// The assembled start, with all parameters at their defaults.
    fn joint_start(&self) -> Self::Joints;
    /// Writes u̇.
    fn joint_accelerations(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::Rates);
    /// Writes the derivative of the joint state; [`Joint`](crate::Joint) integrates it.
    fn joint_derivative(&self, t: Self::Scalar, x: &Self::Joints, dx: &mut Self::Joints);
    /// Writes the maximal state of a joint state; it satisfies all constraints but the closure.
    fn to_maximal(&self, t: Self::Scalar, x: &Self::Joints, y: &mut Self::State);
    /// Writes the joint state of a maximal state; angles are those nearest to the previous contents of `x`.
    fn to_joints(&self, t: Self::Scalar, y: &Self::State, x: &mut Self::Joints);
    /// Writes Φ_c. Like the functions below, it does nothing for trees.
    fn loop_closure(&self, _t: Self::Scalar, _x: &Self::Joints, _out: &mut Self::Closure) {}
    /// Writes for each row of J the square of its distance from the span of the rows before it: the diagonal of D in
    /// `J Jᵀ = L D Lᵀ`. Where a mechanism has more freedoms than elsewhere one of them is zero.
    fn closure_distances(&self, _t: Self::Scalar, _x: &Self::Joints, _out: &mut Self::Closure) {}
    /// One Newton step of the positions towards `Φ_c = 0`: x changes by a δ with `J δ = −Φ_c` (Euler parameters, which
    /// this does not normalise, by `½ Gᵀ δ`). u is left as it is.
    fn close_positions(&self, _t: Self::Scalar, _x: &mut Self::Joints) {}
    /// Changes u by a δ with `J δ = −Φ̇_c`, such that `Φ̇_c = 0` at these positions.
    fn close_velocities(&self, _t: Self::Scalar, _x: &mut Self::Joints) {}
}

/// The derivatives of the joint form `ẋ = f(t, x)`.
///
/// Generated trees can have them, and mechanisms with loops, or with joints that are not made of turns and
/// displacements (screws, rods, points on a line), of up to eight rates; not where a third derivative of a table would
/// be needed. They are the derivatives of the emitted functions as they stand, of Euler parameters of any length and
/// along them, too, where nothing changes but their own rates.
pub trait JointJacobian: JointSpace {
    /// ∂f/∂x, n × n for a joint state of n numbers, row by row.
    type Jacobian: Storage<Self::Scalar>;
    /// ∂f/∂(inputs), n × m for m inputs, row by row.
    type InputJacobian: Storage<Self::Scalar>;

    /// Buffers, zeroed.
    fn jacobian_buffers(&self) -> JacobianBuffers<Self>;
    /// Writes ∂f/∂x, row by row, and ∂f/∂t of [`JointSpace::joint_derivative`].
    fn joint_jacobian(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        dfdx: &mut Self::Jacobian,
        dfdt: &mut Self::Joints,
    );
    /// Writes ∂f/∂(inputs), row by row.
    fn joint_input_jacobian(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::InputJacobian);
}

/// The derivatives of the joint form by parameters: for sensitivities, identification and design.
///
/// f is [`JointSpace::joint_derivative`]: `ẋ = f(t, x)`, of which u̇ depends on parameters, and the power of the forces
/// whose work the state counts. So the sensitivities `S = ∂x/∂(parameters)` of a motion follow from `Ṡ = ∂f/∂x S +
/// ∂f/∂(parameters)`. An element has the unit of f's by that of the parameter. Parameters of the geometry change what a
/// joint state is, not the joint state: of a tree they leave it consistent; loops are to be closed anew.
///
/// Implemented where it is asked for (`functions = ["parameter_jacobian"]` in the model file, or `--functions`) and
/// where [`JointJacobian`] can be.
pub trait ParameterJacobian: JointSpace {
    /// ∂f/∂(parameters), n × k for a joint state of n numbers and k parameters, row by row.
    type ParameterJacobian: Storage<Self::Scalar>;

    /// A buffer, zeroed.
    fn parameter_buffer(&self) -> Self::ParameterJacobian;
    /// Writes ∂f/∂(parameters), row by row, parameters in the order of the type's `PARAMETERS`.
    fn joint_parameter_jacobian(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::ParameterJacobian);
}

/// What the functions of [`JointJacobian`] write to.
#[derive(Clone, Debug)]
pub struct JacobianBuffers<M: JointJacobian + ?Sized> {
    /// For [`JointJacobian::joint_jacobian`].
    pub jacobian: M::Jacobian,
    /// For [`JointJacobian::joint_input_jacobian`].
    pub input_jacobian: M::InputJacobian,
}

/// Where the numbers of a joint state stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointLayout<'a> {
    /// What stands in x and u, in order: each place follows the one before it.
    pub places: &'a [JointPlace],
    /// The rows of Φ that tree coordinates do not satisfy by themselves, by their index among the joint rows: those of
    /// [`JointSpace::loop_closure`]. Empty for trees.
    pub closure_rows: &'a [u16],
}

/// Some coordinates and their rates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
pub enum JointPlace {
    /// An angle or a displacement. One number in x, one in u.
    Scalar {
        /// Index of the joint.
        joint: u16,
        /// Which of the joint's coordinates it is.
        coordinate: u16,
    },
    /// Euler parameters of the second body in the first's frame; angular velocity relative to the first in the
    /// second's. Four numbers in x, three in u.
    Orientation {
        /// Index of the joint.
        joint: u16,
    },
    /// (r, p) and (s, w') of a body that no joint carries. Seven numbers in x, six in u.
    Body {
        /// Index of the body.
        body: u16,
    },
    /// The *turn reference* of an angle of a joint that closes a loop: a number near the angle, rad, that says how
    /// many whole turns it has made. One number in x, none in u.
    Turn {
        /// Index of the joint.
        joint: u16,
        /// Which of the joint's coordinates it is.
        coordinate: u16,
    },
    /// A state of one's own. One number in x, none in u.
    State {
        /// Index of the state.
        state: u16,
    },
}

impl JointLayout<'_> {
    /// Length of x.
    pub fn n_coordinates(&self) -> usize {
        self.places.iter().map(|place| place.n_coordinates()).sum()
    }

    /// Length of u.
    pub fn n_rates(&self) -> usize {
        self.places.iter().map(|place| place.n_rates()).sum()
    }

    /// Makes Euler parameters unit vectors. All that is computed of a joint state is the same before and after, but
    /// the rates of Euler parameters, which are in proportion to them.
    #[inline(always)]
    pub fn normalise<T: Scalar>(&self, x: &mut [T]) {
        let mut rest = x;
        for place in self.places {
            let Some((own, others)) = rest.split_at_mut_checked(place.n_coordinates()) else { return };
            if let Some(p) = place.euler().and_then(|first| own.get_mut(first..)) {
                normalise(p);
            }
            rest = others;
        }
    }
}

impl JointPlace {
    /// How many numbers it has in x.
    pub const fn n_coordinates(self) -> usize {
        match self {
            Self::Scalar { .. } | Self::Turn { .. } | Self::State { .. } => 1,
            Self::Orientation { .. } => 4,
            Self::Body { .. } => 7,
        }
    }

    /// Where among these Euler parameters start, if there are any.
    pub const fn euler(self) -> Option<usize> {
        match self {
            Self::Scalar { .. } | Self::Turn { .. } | Self::State { .. } => None,
            Self::Orientation { .. } => Some(0),
            Self::Body { .. } => Some(3),
        }
    }

    /// How many numbers it has in u.
    pub const fn n_rates(self) -> usize {
        match self {
            Self::Scalar { .. } => 1,
            Self::Orientation { .. } => 3,
            Self::Body { .. } => 6,
            Self::Turn { .. } | Self::State { .. } => 0,
        }
    }
}

/// What the functions of [`JointSpace`] write to.
#[derive(Clone, Debug)]
pub struct JointBuffers<M: JointSpace + ?Sized> {
    /// For [`JointSpace::joint_accelerations`].
    pub rates: M::Rates,
    /// For [`JointSpace::loop_closure`] and [`JointSpace::closure_distances`].
    pub closure: M::Closure,
}
