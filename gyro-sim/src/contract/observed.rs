//! What is read off a joint state.

use super::{JointSpace, Storage};

/// Outputs of a joint state, without a maximal state on the way.
///
/// Implemented where it is asked for: `functions = ["joint_outputs"]` in the model file, or `--functions`.
pub trait JointOutputs: JointSpace {
    /// Writes all outputs, with the present values of the inputs, as [`Mechanism::outputs`](crate::Mechanism::outputs)
    /// has them at the maximal state of `x`. What needs accelerations or reactions calls
    /// [`JointSpace::joint_accelerations`] first.
    fn joint_outputs(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::Outputs);
}

/// Derivatives of the outputs, without a limit on their number.
///
/// The outputs are functions `g(t, x, u, u̇; inputs, parameters)`: what stands here are their partial derivatives at
/// any u̇, row by row, a row for each number of [`Mechanism::Outputs`](crate::Mechanism::Outputs). With u̇ as the
/// equations of motion have it, `C = ∂g/∂(x, u) + ∂g/∂u̇ · ∂u̇/∂(x, u)`, and likewise for inputs and parameters.
///
/// They are the derivatives of the emitted function as it stands; along Euler parameters, whose length means nothing,
/// they are zero.
///
/// Implemented where it is asked for: `functions = ["output_derivatives"]` in the model file, or
/// `--functions`; not where a third derivative of a table would be needed.
pub trait OutputDerivatives: JointOutputs {
    /// m × n for m numbers of outputs and n of (x, u).
    type ByState: Storage<Self::Scalar>;
    /// m × n for n rates.
    type ByAccelerations: Storage<Self::Scalar>;
    /// m × n for n inputs.
    type ByInputs: Storage<Self::Scalar>;
    /// m × n for n parameters, in the order of the type's `PARAMETERS`.
    type ByParameters: Storage<Self::Scalar>;

    /// Buffers, zeroed.
    fn output_slopes(&self) -> OutputSlopes<Self>;
    /// Writes ∂g/∂(x, u).
    fn outputs_by_state(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        accelerations: &Self::Rates,
        out: &mut Self::ByState,
    );
    /// Writes ∂g/∂u̇.
    fn outputs_by_accelerations(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        accelerations: &Self::Rates,
        out: &mut Self::ByAccelerations,
    );
    /// Writes ∂g/∂(inputs).
    fn outputs_by_inputs(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        accelerations: &Self::Rates,
        out: &mut Self::ByInputs,
    );
    /// Writes ∂g/∂(parameters).
    fn outputs_by_parameters(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        accelerations: &Self::Rates,
        out: &mut Self::ByParameters,
    );
}

/// What the functions of [`OutputDerivatives`] write to.
#[derive(Clone, Debug)]
pub struct OutputSlopes<M: OutputDerivatives + ?Sized> {
    /// For [`OutputDerivatives::outputs_by_state`].
    pub by_state: M::ByState,
    /// For [`OutputDerivatives::outputs_by_accelerations`].
    pub by_accelerations: M::ByAccelerations,
    /// For [`OutputDerivatives::outputs_by_inputs`].
    pub by_inputs: M::ByInputs,
    /// For [`OutputDerivatives::outputs_by_parameters`].
    pub by_parameters: M::ByParameters,
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
/// Implemented where it is asked for (`functions = ["frames"]` in the model file, or `--functions`) and the
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
