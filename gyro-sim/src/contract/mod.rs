//! What a mechanism offers to the solvers, and what the solvers ask of it.
//!
//! The mechanism is constant during a call. Every buffer belongs to the caller, and its size is part of its type:
//! generated mechanisms use arrays, runtime-assembled ones heap-backed vectors.

mod description;
mod dynamics;
mod error;
mod joint_space;
mod kinematics;
mod mechanism;
mod observed;
mod ode;
mod partition;
mod robot;

pub use description::{Coordinate, Description, JointInfo, OutputInfo, Owner, RowInfo};
pub use dynamics::{CorrectedDynamics, CorrectedSolution, Dynamics, Projection};
pub use error::Error;
pub use joint_space::{
    JacobianBuffers, JointBuffers, JointJacobian, JointLayout, JointPlace, JointSpace, ParameterJacobian,
};
pub use kinematics::{Kinematics, Terms};
pub use mechanism::{Buffers, Energy, Mechanism, set_turn_references};
pub use observed::{FrameBuffers, Frames, JointOutputs, OutputDerivatives, OutputSlopes};
pub use ode::{Corrected, Exact, Jacobian, Joint, Ode, System};
pub use partition::{Clearance, Partition};
pub use robot::{DynamicsDerivatives, InverseDynamics, MassMatrix, Regressor};

use core::fmt::Debug;

/// A buffer of a fixed number of scalars: an array, a vector or a boxed slice.
///
/// An abbreviation of its bounds; nothing else implements or names it.
pub trait Storage<T>: Clone + Debug + AsRef<[T]> + AsMut<[T]> {}
impl<T, B: Clone + Debug + AsRef<[T]> + AsMut<[T]>> Storage<T> for B {}
