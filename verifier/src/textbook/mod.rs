//! The textbook side: what a mechanism's functions must be equal to.
//!
//! Typed from Gruzman and Sarzeto's paper (equation numbers are its own) and from Haug, *Computer Aided Kinematics and
//! Dynamics of Mechanical Systems* (1989), as plainly as they print it: no step is taken to save work, and nothing is
//! shared with the generator. Φ is written once; its derivatives Φ_q, Φ_π', ν and γ are taken by second-order dual
//! numbers over the field, which is exact. Everything is defined wherever |p| = 1, on the constraints and off them.
//!
//! Functions return `None` where a formula divides by zero: such a point decides nothing, another must be taken.

mod armature;
mod attitude;
mod bushing;
mod coordinate;
mod dynamics;
mod forces;
mod formula;
mod jet;
mod joint;
mod laws;
mod linear;
mod load;
mod motion;
mod observe;
mod pose;
mod relative;
mod rows;
mod scope;
mod sparse;
#[cfg(test)]
mod tests;

pub use observe::Reading;
pub use sparse::Sparse;

use crate::atoms::Atoms;
use crate::field::Field;
use crate::point::Point;
use gyro_model::{JointCoordinate, Model, RowOwner};
use joint::JointFrames;
use pose::{Moving, Path, Pose};
use scope::Scope;
use std::ops::Range;

/// A model read as the textbook does.
#[derive(Clone, Debug)]
pub struct Textbook<'m> {
    model: &'m Model,
    /// Bodies with coordinates.
    moving_bodies: Vec<usize>,
    /// Of each body its place among them.
    slot_of_body: Vec<Option<usize>>,
    /// [`Model::rows`], owner after owner.
    blocks: Vec<Block>,
    /// Of each body the blocks in whose rows it occurs.
    blocks_of_body: Vec<Vec<usize>>,
    /// [`Model::turn_references`].
    turns: Vec<JointCoordinate>,
}

/// The rows of one owner.
#[derive(Clone, Debug)]
struct Block {
    owner: RowOwner,
    /// Of all of its rows, whether each is among [`Model::rows`].
    is_kept: Vec<bool>,
    /// Places of those that are.
    rows: Range<usize>,
}

/// The textbook's formulas at one point.
///
/// Orders and sizes are those of [`Model::rows`], [`Model::coordinate_bodies`] and [`gyro_model::OutputKind::columns`].
#[derive(Clone)]
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
        let (moving_bodies, blocks) = (model.coordinate_bodies(), blocks(model));
        let mut slot_of_body = vec![None; model.bodies.len()];
        moving_bodies
            .iter()
            .enumerate()
            .for_each(|(moving_body, &body)| slot_of_body[body] = Some(moving_body));
        let mut blocks_of_body = vec![Vec::new(); model.bodies.len()];
        for (index, block) in blocks.iter().enumerate() {
            bodies_of(model, block.owner).into_iter().for_each(|body| blocks_of_body[body].push(index));
        }
        Self { model, moving_bodies, slot_of_body, blocks, blocks_of_body, turns: model.turn_references() }
    }

    fn n_rows(&self) -> usize {
        self.blocks.last().map_or(0, |block| block.rows.end)
    }

    /// The formulas at a point; `None` where an axis of a joint or body has zero length there.
    pub fn at<'a, F: Field>(
        &'a self,
        point: &'a Point<F>,
        atoms: &'a dyn Atoms<F>,
    ) -> Option<Evaluation<'a, F>> {
        let scope = Scope::new(point, atoms);
        let joints = 0..self.model.joints.len();
        let joints =
            joints.map(|joint| JointFrames::new(&scope, self.model, joint)).collect::<Option<_>>()?;
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
        let poses = bodies.map(|(index, body)| match (self.moving_body_of(index), &body.motion) {
            (Some(_), _) => Some(None),
            (None, Some(_)) => scope.driven(self.model, body, &t).map(Some),
            (None, None) => scope.given(body).map(Some),
        });
        poses.collect()
    }

    fn moving_body_of(&self, body: usize) -> Option<usize> {
        self.slot_of_body[body]
    }
}

/// The rows, owner after owner.
fn blocks(model: &Model) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let dropped: Vec<_> = model.dropped().map(|redundant| redundant.row).collect();
    for row in model.all_rows() {
        if blocks.last().is_none_or(|last| last.owner != row.owner) {
            let start = blocks.last().map_or(0, |last| last.rows.end);
            blocks.push(Block { owner: row.owner, is_kept: Vec::new(), rows: start..start });
        }
        let block = blocks.last_mut().expect("there is one now");
        let is_kept = !dropped.contains(&row);
        block.is_kept.push(is_kept);
        block.rows.end += usize::from(is_kept);
    }
    blocks
}

/// The bodies that occur in an owner's rows, each once.
fn bodies_of(model: &Model, owner: RowOwner) -> Vec<usize> {
    let of_joint =
        |joint: usize| [&model.joints[joint].first, &model.joints[joint].second].map(|end| end.body);
    let mut bodies = match owner {
        RowOwner::Body(body) => vec![body],
        RowOwner::Joint(joint) => of_joint(joint).to_vec(),
        RowOwner::Coupler(coupler) => {
            let coupler = &model.couplers[coupler];
            let frames = coupler.outputs().into_iter().flat_map(|output| model.outputs[output].kind.frames());
            let joints = coupler.coordinates().into_iter().flat_map(|on| of_joint(on.joint));
            joints.chain(frames.map(|frame| frame.body)).collect()
        }
        RowOwner::Driver(driver) => of_joint(model.drivers[driver].coordinate.joint).to_vec(),
    };
    bodies.sort_unstable();
    bodies.dedup();
    bodies
}

impl<F: Field> std::fmt::Debug for Evaluation<'_, F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut text = f.debug_struct("Evaluation");
        text.field("model", &self.textbook.model.name).field("t", &self.scope.point.t);
        text.field("state", &self.scope.point.state).finish_non_exhaustive()
    }
}
