//! What is read off a joint state.

use super::{JointSpace, Storage};

/// Outputs of a joint state, without a maximal state on the way.
///
/// Implemented where it is asked for: `functions = ["joint", "joint_outputs"]` in the model file, or `--functions`.
pub trait JointOutputs: JointSpace {
    /// Writes all outputs, with the present values of the inputs, as [`Mechanism::outputs`](crate::Mechanism::outputs)
    /// has them at the maximal state of `x`. What needs accelerations or reactions calls
    /// [`JointSpace::joint_accelerations`] first.
    fn joint_outputs(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::Outputs);
}

/// How named frames move with the rates: kinematics for control and for inverse kinematics.
///
/// A frame is what an `[[output]]` of kind `velocity` names, a point of a body. Its velocity has six numbers, of the
/// point in the global frame, m/s, and of the body in its own frame, rad/s:
/// ```text
/// (ṡ, w') = J(t, x) u + what prescribed motions contribute,     (s̈, ẇ') = J u̇ + b(t, x, u)
/// ```
/// u̇ are the rates' rates of the joint state: of a mechanism with loops any that keep them closed.
///
/// Implemented where it is asked for (`functions = ["joint", "frames"]` in the model file, or `--functions`) and the
/// model file has such an output. Poses and velocities themselves are [`JointOutputs`].
pub trait Frames: JointSpace {
    /// 6 × n for n rates, row by row, frame after frame.
    type FrameJacobians: Storage<Self::Scalar>;
    /// Six numbers of each frame.
    type FrameBiases: Storage<Self::Scalar>;

    /// The names of the outputs that are the frames, in order.
    fn frame_names(&self) -> &[&str];
    /// Buffers, zeroed.
    fn frame_buffers(&self) -> FrameBuffers<Self>;
    /// Writes J of each frame.
    fn frame_jacobians(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::FrameJacobians);
    /// Writes b of each frame, `J̇ u` where nothing is prescribed.
    fn frame_biases(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::FrameBiases);
}

/// What the functions of [`Frames`] write to.
#[derive(Clone, Debug)]
pub struct FrameBuffers<M: Frames + ?Sized> {
    /// For [`Frames::frame_jacobians`].
    pub jacobians: M::FrameJacobians,
    /// For [`Frames::frame_biases`].
    pub biases: M::FrameBiases,
}
