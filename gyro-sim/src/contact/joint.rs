//! Contacts of mechanisms in joint coordinates.

use super::Forced;
use crate::{Clearance, CloseLoops, Correction, Error, Joint, JointSpace, Ode, Real};
use core::ops::Range;

/// The equations of motion in joint coordinates, with an input for each contact: a force of the model along the
/// contact's coordinate, of one newton, or newton metre, for a value of one.
#[derive(Clone, Copy, Debug)]
pub struct JointInputs<const N: usize> {
    /// The index of each contact's input among the model's.
    pub inputs: [usize; N],
}

impl<M: JointSpace, const N: usize> Ode<M> for JointInputs<N> {
    type Scalar = M::Scalar;
    type State = M::Joints;

    fn derivative(&self, model: &M, t: M::Scalar, y: &M::Joints, dy: &mut M::Joints) {
        Joint.derivative(model, t, y, dy);
    }
    fn normalise(&self, model: &M, y: &mut M::Joints) {
        Joint.normalise(model, y);
    }
}

impl<M: JointSpace + Clone, const N: usize> Forced<M> for JointInputs<N> {
    fn rates(&self, model: &M) -> Range<usize> {
        let layout = model.joint_layout();
        let n = layout.n_coordinates();
        n..n + layout.n_rates()
    }

    /// Behind the rates, where the model counts it.
    fn work(&self, model: &M) -> Option<usize> {
        Some(Forced::<M>::rates(self, model).end)
    }

    fn forced(&self, model: &M, t: M::Scalar, y: &M::Joints, forces: &[M::Scalar], dy: &mut M::Joints) {
        pushed(model, &self.inputs, forces).joint_derivative(t, y, dy);
    }

    fn accelerations(
        &self,
        model: &M,
        t: M::Scalar,
        y: &M::Joints,
        forces: &[M::Scalar],
        dy: &mut M::Joints,
    ) {
        joint_accelerations(&pushed(model, &self.inputs, forces), t, y, dy);
    }
}

/// The same, and friction may grow with reactions: with the force of an output of kind `reaction`, of the contact's
/// joint or of any other.
#[derive(Clone, Copy, Debug)]
pub struct LoadedJointInputs<const N: usize> {
    /// The index of each contact's input among the model's.
    pub inputs: [usize; N],
    /// Where the reaction of each contact begins among the numbers of the outputs, where it has one.
    pub reactions: [Option<usize>; N],
}

impl<M: JointSpace, const N: usize> Ode<M> for LoadedJointInputs<N> {
    type Scalar = M::Scalar;
    type State = M::Joints;

    fn derivative(&self, model: &M, t: M::Scalar, y: &M::Joints, dy: &mut M::Joints) {
        Joint.derivative(model, t, y, dy);
    }
    fn normalise(&self, model: &M, y: &mut M::Joints) {
        Joint.normalise(model, y);
    }
}

impl<M: JointSpace + Clone, const N: usize> Forced<M> for LoadedJointInputs<N> {
    const HAS_REACTIONS: bool = true;

    fn rates(&self, model: &M) -> Range<usize> {
        JointInputs { inputs: self.inputs }.rates(model)
    }

    fn work(&self, model: &M) -> Option<usize> {
        JointInputs { inputs: self.inputs }.work(model)
    }

    fn forced(&self, model: &M, t: M::Scalar, y: &M::Joints, forces: &[M::Scalar], dy: &mut M::Joints) {
        JointInputs { inputs: self.inputs }.forced(model, t, y, forces, dy);
    }

    fn accelerations(
        &self,
        model: &M,
        t: M::Scalar,
        y: &M::Joints,
        forces: &[M::Scalar],
        dy: &mut M::Joints,
    ) {
        JointInputs { inputs: self.inputs }.accelerations(model, t, y, forces, dy);
    }

    fn reactions(
        &self,
        model: &M,
        t: M::Scalar,
        y: &M::Joints,
        forces: &[M::Scalar],
        out: &mut [[M::Scalar; 3]],
    ) {
        let model = pushed(model, &self.inputs, forces);
        let (mut state, mut outputs) = (model.start(), model.buffers().outputs);
        model.to_maximal(t, y, &mut state);
        model.outputs(t, &state, &mut outputs);
        for (out, place) in out.iter_mut().zip(self.reactions) {
            if let Some(force) = place.and_then(|place| outputs.as_ref().get(place..place + 3)) {
                out.copy_from_slice(force);
            }
        }
    }
}

/// Writes u̇ where the derivative of the joint state has it, and leaves all else as it is.
pub fn joint_accelerations<M: JointSpace>(model: &M, t: M::Scalar, x: &M::Joints, dx: &mut M::Joints) {
    let mut rates = model.joint_buffers().rates;
    model.joint_accelerations(t, x, &mut rates);
    let places = dx.as_mut().iter_mut().skip(model.joint_layout().n_coordinates());
    places.zip(rates.as_ref()).for_each(|(place, rate)| *place = *rate);
}

/// The mechanism under these forces.
fn pushed<M: JointSpace + Clone>(model: &M, inputs: &[usize], forces: &[M::Scalar]) -> M {
    let mut model = model.clone();
    for (input, force) in inputs.iter().zip(forces) {
        model.set_input(*input, *force);
    }
    model
}

/// Loops are closed as without contacts.
impl<M: JointSpace<Scalar: Real>, const N: usize> Correction<JointInputs<N>, M> for CloseLoops<M> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, x: &mut M::Joints) -> Result<(), Error> {
        Correction::<Joint, M>::correct(self, mechanism, t, x)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> M::Scalar {
        Correction::<Joint, M>::violation(self, mechanism, t, x)
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> Option<Clearance<M::Scalar>> {
        Correction::<Joint, M>::clearance(self, mechanism, t, x)
    }
}

/// Likewise.
impl<M: JointSpace<Scalar: Real>, const N: usize> Correction<LoadedJointInputs<N>, M> for CloseLoops<M> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, x: &mut M::Joints) -> Result<(), Error> {
        Correction::<Joint, M>::correct(self, mechanism, t, x)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> M::Scalar {
        Correction::<Joint, M>::violation(self, mechanism, t, x)
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, x: &M::Joints) -> Option<Clearance<M::Scalar>> {
        Correction::<Joint, M>::clearance(self, mechanism, t, x)
    }
}
