//! A mechanism in maximal coordinates.

use super::{Description, Storage};
use crate::Scalar;

/// A mechanism in maximal coordinates: what solvers and observers of every mechanism see of it. How it moves is told by
/// further traits, of which a generated module has those that were asked for.
pub trait Mechanism {
    /// The number type.
    type Scalar: Scalar;
    /// The state `(q, v [, work] [, turn references])`: see the [conventions](crate#conventions).
    type State: Storage<Self::Scalar>;
    /// One scalar for each joint row.
    type Rows: Storage<Self::Scalar>;
    /// One scalar for each joint row, then one for each body's normalisation.
    type Constraints: Storage<Self::Scalar>;
    /// One scalar for each velocity: `(s, w')` body after body.
    type Velocities: Storage<Self::Scalar>;
    /// Raw joint coordinates, joint after joint and coordinate after coordinate: see [`Coordinate`](crate::Coordinate).
    type Readings: Storage<Self::Scalar>;
    /// One scalar for each number of each output.
    type Outputs: Storage<Self::Scalar>;

    /// Names, rows and sizes.
    fn description(&self) -> &Description<'_>;
    /// Buffers, zeroed.
    fn buffers(&self) -> Buffers<Self>;
    /// The assembled start, with all parameters at their defaults.
    fn start(&self) -> Self::State;

    /// Writes Φ: joint rows, eqs. (5) to (10), then normalisations, eq. (12).
    fn phi(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Constraints);
    /// Writes `Φ_r s + Φ_π' w' − ν`, the residual of eq. (18).
    fn velocity_residual(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rows);
    /// Writes `(f, n' − w̃'J'w')`, body after body.
    fn applied_force(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Velocities);
    /// Kinetic and potential energy, J.
    fn energy(&self, t: Self::Scalar, y: &Self::State) -> Energy<Self::Scalar>;
    /// Writes the raw joint coordinates and rates.
    fn read_joints(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Readings);
    /// Writes all outputs, with the present values of the inputs.
    fn outputs(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Outputs);
    /// Sets an input, which keeps its value until it is set again; returns whether there is an input of this index.
    fn set_input(&mut self, index: usize, value: Self::Scalar) -> bool;

    /// Sets the turn references of a state to their angles: see [`refer_turns`](crate::refer_turns).
    fn refer_turns(&self, t: Self::Scalar, y: &mut Self::State) {
        let mut readings = self.buffers().readings;
        self.read_joints(t, y, &mut readings);
        set_turn_references(self.description().turn_references, readings.as_ref(), y.as_mut());
    }
    /// The typical length of the mechanism, m, as a scalar.
    fn size(&self) -> Self::Scalar {
        Self::Scalar::constant(self.description().size)
    }
    /// The work done so far by non-conservative forces and drivers, J; zero where the state does not contain it: there
    /// is none, or the model file leaves it out (`count_work = false`).
    fn work(&self, y: &Self::State) -> Self::Scalar {
        let work = self.description().work().and_then(|place| y.as_ref().get(place));
        work.copied().unwrap_or(Self::Scalar::constant(0.0))
    }
}

/// What the functions of [`Mechanism`] write to.
#[derive(Clone, Debug)]
pub struct Buffers<M: Mechanism + ?Sized> {
    /// For [`Mechanism::velocity_residual`].
    pub rows: M::Rows,
    /// For [`Mechanism::phi`].
    pub constraints: M::Constraints,
    /// For [`Mechanism::applied_force`] and [`Projection::project`](crate::Projection::project).
    pub velocities: M::Velocities,
    /// For [`Mechanism::read_joints`].
    pub readings: M::Readings,
    /// For [`Mechanism::outputs`].
    pub outputs: M::Outputs,
}

/// Energy of a state, J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy<T> {
    /// ½ Σ (sᵀ m s + w'ᵀ J' w').
    pub kinetic: T,
    /// −Σ m gᵀ r, and the energy of springs.
    pub potential: T,
}

impl<T: Scalar> Energy<T> {
    /// The sum of both.
    pub fn total(&self) -> T {
        self.kinetic + self.potential
    }
}

/// Sets the last elements of a state to the angles whose raw sines and cosines begin at these places among the
/// readings.
pub fn set_turn_references<T: Scalar>(places: &[u16], readings: &[T], state: &mut [T]) {
    for (reference, place) in state.iter_mut().rev().zip(places.iter().rev()) {
        let at = usize::from(*place);
        if let Some([sin, cos]) = readings.get(at..at + 2) {
            let (s, c) = (reference.sin(), reference.cos());
            *reference = *reference + (*sin * c - *cos * s).atan2(*cos * c + *sin * s);
        }
    }
}
