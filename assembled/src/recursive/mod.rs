//! The recursive form: eq. (17) in joint coordinates, in three sweeps over the tree.

pub(crate) mod balance;
pub(crate) mod limbs;
pub(crate) mod rebuild;
pub(crate) mod screws;
pub(crate) mod sweeps;

use crate::assembled::{Assembled, Refusal, Solver};
use crate::error::Unsupported;
use crate::model::lowered::Lowered;
use crate::model::place::Moment;
use crate::number::{Number, number};
use crate::recursive::limbs::Limbs;
use crate::recursive::sweeps::{Node, Space};
use gyro_model::Model;
use std::cell::RefCell;

/// Featherstone's articulated-body recursion (*Rigid Body Dynamics Algorithms*, chapter 7): work linear in the number
/// of bodies, no matrix larger than six by six, no allocation.
///
/// All six-vectors are in global axes about one point, the mass centre of the first moving body: so inertias and forces
/// of a body and its descendants simply add up. A joint with several freedoms is eliminated screw by screw. The
/// velocities that the state has make each body's acceleration at constant joint rates; what is solved for is the rest.
/// Unlike the [careful form](crate::Elimination) it takes the constraints for granted: it is right where positions and
/// velocities meet them (after a correction, and between two of them as nearly as the drift is small), elsewhere it
/// means something else.
///
/// It does trees of every kind of joint: see [`Assembled::supports`].
///
/// The partition is in closed form, from the root to the leaves: joint coordinates are read off the uncorrected body
/// against its corrected parent, and the body is put where they say. So there is nothing to choose, and no iteration.
#[derive(Clone, Debug)]
pub struct Recursion<T: Number> {
    tree: Limbs<T>,
    /// Work space. A mechanism is constant to its callers, so it is borrowed inside each call and never across.
    space: RefCell<Space<T>>,
}

impl<T: Number> Assembled<T, Recursion<T>> {
    /// Whether the recursion can do a model: a tree of joints that hangs on fixed, constrained, free or driven bodies,
    /// with any forces and outputs, but without drivers and couplers of joint coordinates.
    ///
    /// # Errors
    /// The first thing in the model that it cannot do.
    pub fn supports(model: &Model) -> Result<(), Unsupported> {
        Unsupported::beyond_trees(model)
    }
}

impl<T: Number> Solver<T> for Recursion<T> {
    /// Joint coordinates: there is no choice.
    type Independent = ();

    fn new(model: &Model, lowered: &Lowered<T>) -> Result<Self, Unsupported> {
        Assembled::<T, Self>::supports(model)?;
        let tree = Limbs::new(model, lowered);
        let n_nodes = 1 + lowered.scene.driven.len() + tree.held.len() + tree.fixed.len() + tree.limbs.len();
        let space = RefCell::new(Space {
            nodes: vec![Node::new(); n_nodes],
            turning: vec![sweeps::Free::new(); tree.screws.len()],
            forces: vec![number(0.0); lowered.scene.n_v()],
            gradients: vec![[[number(0.0); 6]; 2]; lowered.n_rows()],
        });
        Ok(Self { tree, space })
    }

    fn accelerations_len(&self, lowered: &Lowered<T>) -> usize {
        lowered.scene.n_v()
    }

    fn accelerations(&self, lowered: &Lowered<T>, t: T, y: &[T], out: &mut [T]) {
        sweeps::accelerations(&self.tree, lowered, Moment { t, y }, &mut self.space.borrow_mut(), out);
    }

    fn multipliers(&self, lowered: &Lowered<T>, t: T, y: &[T], accelerations: &[T], lambda: &mut [T]) {
        let space = &mut self.space.borrow_mut();
        balance::multipliers(&self.tree, lowered, Moment { t, y }, accelerations, space, lambda);
    }

    fn independent(&self, _: &Lowered<T>, _: T, _: &[T]) {}

    fn follow(&self, _: &Lowered<T>, _: T, _: &[T], (): &mut ()) -> u32 {
        0
    }

    fn newton_step(&self, lowered: &Lowered<T>, t: T, (): &(), y: &mut [T]) -> Result<(), Refusal<T>> {
        Ok(rebuild::positions(&self.tree, lowered, t, y)?)
    }

    fn solve_velocities(&self, lowered: &Lowered<T>, t: T, (): &(), y: &mut [T]) -> Result<(), T> {
        rebuild::velocities(&self.tree, lowered, t, y);
        Ok(())
    }
}
