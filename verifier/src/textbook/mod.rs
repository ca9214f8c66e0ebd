//! The textbook side: what a mechanism's functions must be equal to.
//!
//! Typed from Gruzman and Sarzeto's paper (equation numbers are its own) and from Haug, *Computer Aided Kinematics and Dynamics
//! of Mechanical Systems* (1989), as plainly as they print it: no step is taken to save work, and nothing is shared with the
//! generator. Φ is written once; its derivatives Φ_q, Φ_π', ν and γ are taken by second-order dual numbers over the field, which
//! is exact. Everything is defined wherever |p| = 1, on the constraints and off them.
//!
//! Functions return `None` where a formula divides by zero: such a point decides nothing, another must be taken.

mod attitude;
mod coordinate;
mod dynamics;
mod forces;
mod jet;
mod joint;
mod linear;
mod load;
mod motion;
mod observe;
mod pose;
mod rows;
mod scope;
#[cfg(test)]
mod tests;

pub use observe::Reading;

use crate::atoms::Atoms;
use crate::field::Field;
use crate::point::Point;
use gyro_model::{JointCoordinate, Model};
use joint::JointFrames;
use pose::{Moving, Path, Pose};
use scope::Scope;

/// A model read as the textbook does.
#[derive(Clone, Debug)]
pub struct Textbook<'m> {
    model: &'m Model,
    /// Bodies with coordinates.
    slots: Vec<usize>,
    /// Of [`Model::all_rows`], whether a row is among [`Model::rows`].
    is_kept: Vec<bool>,
    /// [`Model::turn_references`].
    turns: Vec<JointCoordinate>,
}

/// The textbook's formulas at one point.
///
/// Orders and sizes are those of [`Model::rows`], [`Model::coordinate_bodies`] and [`gyro_model::OutputKind::columns`].
pub struct Evaluation<'a, F: Field> {
    textbook: &'a Textbook<'a>,
    scope: Scope<'a, F>,
    joints: Vec<JointFrames<F>>,
    /// Pose of each body without coordinates as time goes on.
    prescribed: Vec<Option<Pose<F>>>,
    /// Pose and velocities of each body.
    moving: Vec<Moving<F>>,
    /// The poses alone.
    still: Vec<Pose<F>>,
}

impl<'m> Textbook<'m> {
    /// Reads a model.
    pub fn new(model: &'m Model) -> Self {
        let kept = model.rows();
        Self {
            model,
            slots: model.coordinate_bodies(),
            is_kept: model.all_rows().iter().map(|row| kept.contains(row)).collect(),
            turns: model.turn_references(),
        }
    }

    /// The formulas at a point; `None` where an axis of joint or body has no length there.
    pub fn at<'a, F: Field>(
        &'a self,
        point: &'a Point<F>,
        atoms: &'a dyn Atoms<F>,
    ) -> Option<Evaluation<'a, F>> {
        let scope = Scope::new(point, atoms);
        let joints =
            self.model.joints.iter().map(|joint| JointFrames::new(&scope, joint)).collect::<Option<_>>()?;
        let prescribed = self.prescribed(&scope)?;
        let (moving, still) = (Vec::new(), Vec::new());
        let mut evaluation = Evaluation { textbook: self, scope, joints, prescribed, moving, still };
        evaluation.moving = (0..self.model.bodies.len()).map(|body| evaluation.moving(body)).collect();
        evaluation.still = evaluation.poses(Path::Rest);
        Some(evaluation)
    }

    fn prescribed<F: Field>(&self, scope: &Scope<'_, F>) -> Option<Vec<Option<Pose<F>>>> {
        let t = jet::Jet::moving(scope.point.t.clone(), scope.one.value.clone());
        let bodies = self.model.bodies.iter().enumerate();
        let poses = bodies.map(|(index, body)| match (self.slot_of(index), &body.motion) {
            (Some(_), _) => Some(None),
            (None, Some(motion)) => scope.driven(body, motion, &t).map(Some),
            (None, None) => scope.given(body).map(Some),
        });
        poses.collect()
    }

    fn slot_of(&self, body: usize) -> Option<usize> {
        self.slots.iter().position(|&b| b == body)
    }
}

impl<F: Field> std::fmt::Debug for Evaluation<'_, F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut text = f.debug_struct("Evaluation");
        text.field("model", &self.textbook.model.name).field("t", &self.scope.point.t);
        text.field("state", &self.scope.point.state).finish_non_exhaustive()
    }
}
