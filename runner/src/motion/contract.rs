//! What a motion is, and what there is to begin one with.

use super::attempt::Look;
use super::course::Course;
use crate::approach::Approach;
use crate::input::Input;
use crate::offers::Offers;
use crate::touch::Touch;
use crate::watch::What;
use gyro_sim::{
    CorrectedDynamics, Dynamics, Error, JointLayout, JointPlace, Kinematics, Mechanism, Partition,
    Projection, Real, Statistics, contact,
};
use nanoserde::{DeBin, SerBin};
use std::fmt::Debug;

/// Why there is no motion with contacts.
pub(super) const NOT_TOUCHING: &str =
    "this program was compiled for runs without rigid contacts, or its engine has none";

/// Refuses contacts.
pub(super) fn not_touching(contacts: &[Touch]) -> Result<(), String> {
    if contacts.is_empty() { Ok(()) } else { Err(NOT_TOUCHING.to_owned()) }
}

/// A motion of a mechanism. The mechanism is handed in at each call, so that its inputs can be set in between.
pub trait Motion<M: Mechanism> {
    /// One step of this length.
    ///
    /// # Errors
    /// [`contact::Error`], where nothing touches of the solver.
    fn step(&mut self, mechanism: &M, h: f64) -> Result<(), contact::Error>;
    /// One step under error control, not beyond `t_end`; `look` has a say in each attempt.
    ///
    /// # Errors
    /// [`contact::Error`], where nothing touches of the solver.
    fn step_towards(
        &mut self,
        mechanism: &M,
        t_end: f64,
        look: &mut Look<'_, M>,
    ) -> Result<(), contact::Error>;
    /// Corrects the state.
    ///
    /// # Errors
    /// [`Error`] of the correction.
    fn correct(&mut self, mechanism: &M) -> Result<(), Error>;
    /// The time, s.
    fn time(&self) -> f64;
    /// Writes the maximal state at a time within the last step.
    ///
    /// # Errors
    /// [`Error`] of the correction.
    fn at(&mut self, mechanism: &M, t: f64, y: &mut M::State) -> Result<(), Error>;
    /// Tells of the inputs that the motion sets by itself, which they are and their values at a time within the last
    /// step: forces of contacts.
    ///
    /// # Errors
    /// [`Error`] of the correction.
    fn set_by_itself(
        &mut self,
        _mechanism: &M,
        _t: f64,
        _tell: &mut dyn FnMut(usize, M::Scalar),
    ) -> Result<(), Error> {
        Ok(())
    }
    /// An input of the mechanism has changed.
    fn set_input(&mut self, index: usize, value: f64);
    /// From time zero on steps under error control end at the knots of a course; equations see its inputs at every
    /// time, set in this copy of the mechanism.
    fn follow(&mut self, inputs: Option<M>, course: Course)
    where
        M: Sized;
    /// The velocities of what is driven jump at once: the mechanism as it is before and as it is after, each also with
    /// large accelerations of what is driven, as `Paths::pushed` has them.
    fn strike(&mut self, before: [&M; 2], after: [&M; 2]);
    /// Decides what happens at the end of the last step, or at once, where anything touches; `tell` hears of it.
    fn resolve(&mut self, _mechanism: &M, _tell: &mut dyn FnMut(What)) {}
    /// What impacts have taken of the energy so far, J.
    fn lost(&self) -> f64 {
        0.0
    }
    /// What the steps have cost and met.
    fn statistics(&self) -> Statistics;
    /// How often independent coordinates have been chosen anew.
    fn chart_switches(&self) -> u64;
}

/// A motion that has begun, or the reason why there is none.
pub type Begun<M> = Result<Box<dyn Motion<M>>, String>;

/// What there is to begin motions of a mechanism with: more for some than for others.
pub trait MotionBuilder<M: Partition<Scalar: Real>> {
    /// A motion from a maximal state at time zero, or the reason why there is none: not all have contacts.
    ///
    /// # Errors
    /// What the mechanism lacks for this approach.
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M>;
    /// What can be asked for; the precision and the inputs are the run's.
    fn offers(&self) -> Offers {
        Offers { joint_space: false, derivatives: false, projection: false, ..Offers::ALL }
    }
    /// The smallest pivot of the constraint Jacobian by full pivoting, lengths in units of the mechanism's size; `None`
    /// where the Jacobian is not at hand. It vanishes in singular poses.
    fn smallest_pivot(&self, _mechanism: &M, _t: f64, _y: &M::State) -> Option<f64> {
        None
    }
    /// Where the numbers of the mechanism's joint states stand; `None` for what has no joint form.
    fn joint_layout<'a>(&self, _mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        None
    }
    /// Whether a builder that linearises can tell more of runs that fail: this one cannot, though the mechanism could
    /// be.
    fn leaves_to_explain(&self) -> bool {
        false
    }
    /// The linearisation of the joint form; `None` for what has no joint form, and where its loops cannot be closed.
    fn linearise(&self, _mechanism: &M, _at: &OperatingPoint<'_, M::State>) -> Option<Linear> {
        None
    }
}

/// What runs in maximal coordinates call, whatever keeps them on the constraints.
///
/// An abbreviation of its bounds; nothing else implements it.
pub trait Maximal: Partition<Scalar: Real> + Kinematics + Dynamics + CorrectedDynamics + Projection {}
impl<M: Partition<Scalar: Real> + Kinematics + Dynamics + CorrectedDynamics + Projection> Maximal for M {}

/// Where and when a mechanism is linearised.
#[derive(Clone, Copy, Debug)]
pub struct OperatingPoint<'a, S> {
    /// Time, s.
    pub t: f64,
    /// The maximal state.
    pub y: &'a S,
    /// For each coordinate, joint after joint, the continuous angle, which the state alone does not tell.
    pub angles: &'a [f64],
    /// What the inputs are, as the mechanism has them; those that are not here have their defaults.
    pub inputs: &'a [Input],
}

/// The joint form near a state: `ẋ ≈ f + A δx + B δu` and outputs `z ≈ h + C δx + D δu`, with x the joint coordinates
/// and rates, u the inputs. Of a mechanism with loops x has the independent ones alone. The work, on which nothing
/// depends, is left out.
#[derive(Clone, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Linear {
    /// Time, s.
    pub t: f64,
    /// What each element of the state is.
    pub elements: Vec<Element>,
    /// The joint state.
    pub state: Vec<f64>,
    /// Its derivative.
    pub slope: Vec<f64>,
    /// A = ∂f/∂x, row by row.
    pub by_state: Vec<f64>,
    /// B = ∂f/∂u, row by row.
    pub by_inputs: Vec<f64>,
    /// The outputs.
    pub outputs: Vec<f64>,
    /// C = ∂h/∂x, row by row.
    pub outputs_by_state: Vec<f64>,
    /// D = ∂h/∂u, row by row.
    pub outputs_by_inputs: Vec<f64>,
}

/// An element of a joint state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, SerBin, DeBin)]
pub enum Element {
    /// A number of x.
    Position {
        /// Its place.
        place: JointPlace,
        /// Which of the place's numbers it is.
        component: usize,
    },
    /// A component of the small turn from an orientation, rad; independent Euler parameters do not exist.
    Turn {
        /// The place of the orientation.
        place: JointPlace,
        /// Which component it is, in the turning body's frame.
        component: usize,
    },
    /// A number of u.
    Rate {
        /// Its place.
        place: JointPlace,
        /// Which of the place's rates it is.
        component: usize,
    },
}

impl Linear {
    /// The same without the last element of the state.
    pub(super) fn without_last(self) -> Self {
        let n = self.state.len();
        let n_inputs = self.by_inputs.len().checked_div(n).unwrap_or(0);
        let Some(kept) = n.checked_sub(1) else { return self };
        let shortened = |rows: &[f64]| rows.chunks_exact(n).flat_map(|row| &row[..kept]).copied().collect();
        Self {
            by_state: shortened(&self.by_state[..kept * n]),
            outputs_by_state: shortened(&self.outputs_by_state),
            by_inputs: self.by_inputs[..kept * n_inputs].to_vec(),
            state: self.state[..kept].to_vec(),
            slope: self.slope[..kept].to_vec(),
            ..self
        }
    }
}

impl Element {
    /// All of a joint state.
    pub(super) fn all(layout: &JointLayout<'_>) -> Vec<Self> {
        let places = layout.places.iter();
        let positions = places.clone().flat_map(|&place| {
            (0..place.n_coordinates()).map(move |component| Self::Position { place, component })
        });
        let rates = places
            .flat_map(|&place| (0..place.n_rates()).map(move |component| Self::Rate { place, component }));
        positions.chain(rates).collect()
    }
}

pub(super) fn in_f64<T: Real>(numbers: &[T]) -> Vec<f64> {
    numbers.iter().map(|x| x.to_f64()).collect()
}

/// Row by row what is given column by column.
pub(super) fn rows(columns: &[Vec<f64>]) -> Vec<f64> {
    let n_rows = columns.first().map_or(0, Vec::len);
    (0..n_rows).flat_map(|row| columns.iter().map(move |column| column[row])).collect()
}

/// Columns of a Jacobian that are computed at a time.
pub const COLUMNS: usize = 4;
