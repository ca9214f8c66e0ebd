//! The recursive form: eq. (17) in joint coordinates, in three sweeps over the tree.

use crate::assembled::{Assembled, Refusal, Solver};
use crate::balance;
use crate::error::Unsupported;
use crate::joint::{End as JointEnd, Joint};
use crate::lowered::{Lowered, Moment, Place, resting};
use crate::motion::Motion;
use crate::number::{Number, number};
use crate::rebuild;
use crate::screws::{End, Screw, Six};
use crate::sweeps::{self, Node};
use gyro_model::{Attachment, Model, RowOwner, Support, Tree};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3, Vector4};
use std::cell::RefCell;
use std::ops::Range;

/// Featherstone's articulated-body recursion (*Rigid Body Dynamics Algorithms*, chapter 7): work linear in the number of bodies,
/// no matrix larger than six by six, no allocation.
///
/// All six-vectors are in global axes about one point, the mass centre of the first moving body: so inertias and forces of a
/// body and its descendants simply add up. A joint with several freedoms is eliminated screw by screw. The velocities that the
/// state has make each body's acceleration at constant joint rates; what is solved for is the rest. Unlike the
/// [careful form](crate::Elimination) it takes the constraints for granted: it is right where positions and velocities meet them
/// (after a correction, and between two of them as nearly as the drift is small), elsewhere it means something else.
///
/// It does trees of every kind of joint: see [`Assembled::supports`].
///
/// The partition is in closed form, from the root to the leaves: joint coordinates are read off the uncorrected body against its
/// corrected parent, and the body is put where they say. So there is nothing to choose, and no iteration.
#[derive(Clone, Debug)]
pub struct Recursion<T: Number> {
    pub(crate) limbs: Vec<Limb<T>>,
    /// Of each limb its joint's screws.
    pub(crate) screws: Vec<Screw<T>>,
    /// Slots of constrained bodies, in the order of [`Lowered::constrained`], and their rows.
    pub(crate) held: Vec<(usize, Range<usize>)>,
    /// Fixed bodies where the page puts them, in the model's order.
    pub(crate) fixed: Vec<Motion<T>>,
    /// Of each row the slot of the body that it holds.
    pub(crate) children: Vec<usize>,
    /// Work space. A mechanism is constant to its callers, so it is borrowed inside each call and never across.
    space: RefCell<Space<T>>,
}

/// What one evaluation needs.
#[derive(Clone, Debug)]
pub(crate) struct Space<T> {
    /// The global frame, driven bodies, constrained and fixed bodies; then the limbs.
    pub(crate) nodes: Vec<Node<T>>,
    /// What [`sweeps`] knows of each screw.
    pub(crate) turning: Vec<sweeps::Free<T>>,
    /// What the page's forces exert, body after body: `(f, n')`.
    pub(crate) forces: Vec<T>,
    /// Of each row its derivative with respect to the child's and to the parent's `(r, π')`.
    pub(crate) gradients: Vec<[Six<T>; 2]>,
}

/// A moving body and what holds it; parents come before children.
#[derive(Clone, Debug)]
pub(crate) struct Limb<T> {
    pub(crate) slot: usize,
    /// Index of its parent's node: the ground for a free body.
    pub(crate) parent: usize,
    /// None of a free body.
    pub(crate) hinge: Option<Hinge<T>>,
}

/// A joint with its direction in the tree.
#[derive(Clone, Debug)]
pub(crate) struct Hinge<T> {
    pub(crate) joint: usize,
    pub(crate) rows: Range<usize>,
    pub(crate) child: End,
    /// Of the second body, in its frame.
    pub(crate) point: Vector3<T>,
    /// Euler parameters of the joint frames in their bodies' frames.
    pub(crate) frames: [Vector4<T>; 2],
    pub(crate) screws: Range<usize>,
    /// Whether some of the joint's freedoms are fixed in the first body and others in the second.
    pub(crate) is_mixed: bool,
}

impl<T> Hinge<T> {
    /// The parent's end of the joint and the child's.
    pub(crate) fn ends<'a>(&self, joint: &'a Joint<T>) -> (&'a JointEnd<T>, &'a JointEnd<T>) {
        match self.child {
            End::First => (&joint.second, &joint.first),
            End::Second => (&joint.first, &joint.second),
        }
    }
}

impl<T: Number> Assembled<T, Recursion<T>> {
    /// Whether the recursion can do a model: a tree of joints that hangs on fixed, constrained, free or driven bodies, with any
    /// forces and outputs, but without drivers and couplers of joint coordinates.
    ///
    /// # Errors
    /// The first thing in the model that it cannot do.
    pub fn supports(model: &Model) -> Result<(), Unsupported> {
        let tree = Tree::of(model);
        let first = |name: Option<&String>, what: fn(String) -> Unsupported| {
            name.map_or(Ok(()), |name| Err(what(name.clone())))
        };
        let looped = tree.loop_joints.first().map(|&joint| &model.joints[joint]);
        let unreached = tree.unreached.first().map(|&body| &model.bodies[body]);
        first(looped.map(|joint| &joint.name), Unsupported::Loop)?;
        first(unreached.map(|body| &body.name), Unsupported::Unconnected)?;
        first(model.couplers.first().map(|coupler| &coupler.name), Unsupported::Coupler)?;
        first(model.drivers.first().map(|driver| &driver.name), Unsupported::Driver)?;
        if model.redundant.is_empty() { Ok(()) } else { Err(Unsupported::RedundantRows) }
    }
}

impl<T: Number> Solver<T> for Recursion<T> {
    /// Joint coordinates: there is no choice.
    type Independent = ();

    fn new(model: &Model, lowered: &Lowered<T>) -> Result<Self, Unsupported> {
        Assembled::<T, Self>::supports(model)?;
        let held = held(model, lowered);
        let is_fixed = |&body: &usize| model.bodies[body].support == Support::Fixed;
        let fixed: Vec<_> =
            (0..model.bodies.len()).filter(is_fixed).map(|body| resting(model, body)).collect();
        let (mut limbs, mut screws) = (Vec::new(), Vec::new());
        for link in Tree::of(model).links {
            if let Some(limb) = limb(model, lowered, &held, &limbs, &mut screws, &link) {
                limbs.push(limb);
            }
        }
        let mut children = vec![0; lowered.n_rows()];
        let hinges =
            limbs.iter().filter_map(|limb: &Limb<T>| Some((limb.slot, limb.hinge.as_ref()?.rows.clone())));
        for (slot, rows) in hinges.chain(held.iter().cloned()) {
            children[rows].fill(slot);
        }
        let n_nodes = 1 + lowered.driven.len() + held.len() + fixed.len() + limbs.len();
        let space = RefCell::new(Space {
            nodes: vec![Node::new(); n_nodes],
            turning: vec![sweeps::Free::new(); screws.len()],
            forces: vec![number(0.0); lowered.n_v()],
            gradients: vec![[[number(0.0); 6]; 2]; lowered.n_rows()],
        });
        Ok(Self { limbs, screws, held, fixed, children, space })
    }

    fn accelerations_len(&self, lowered: &Lowered<T>) -> usize {
        lowered.n_v()
    }

    fn accelerations(&self, lowered: &Lowered<T>, t: T, y: &[T], out: &mut [T]) {
        sweeps::accelerations(self, lowered, Moment { t, y }, &mut self.space.borrow_mut(), out);
    }

    fn multipliers(&self, lowered: &Lowered<T>, t: T, y: &[T], accelerations: &[T], lambda: &mut [T]) {
        let space = &mut self.space.borrow_mut();
        balance::multipliers(self, lowered, Moment { t, y }, accelerations, space, lambda);
    }

    fn independent(&self, _: &Lowered<T>, _: T, _: &[T]) {}

    fn follow(&self, _: &Lowered<T>, _: T, _: &[T], (): &mut ()) -> u32 {
        0
    }

    fn newton_step(&self, lowered: &Lowered<T>, t: T, (): &(), y: &mut [T]) -> Result<(), Refusal<T>> {
        Ok(rebuild::positions(self, lowered, t, y)?)
    }

    fn solve_velocities(&self, lowered: &Lowered<T>, t: T, (): &(), y: &mut [T]) -> Result<(), T> {
        rebuild::velocities(self, lowered, t, y);
        Ok(())
    }
}

/// A link of the tree as a limb; none for a constrained body, which does not move.
fn limb<T: Number>(
    model: &Model,
    lowered: &Lowered<T>,
    held: &[(usize, Range<usize>)],
    limbs: &[Limb<T>],
    screws: &mut Vec<Screw<T>>,
    link: &gyro_model::Link,
) -> Option<Limb<T>> {
    let slots = model.coordinate_bodies();
    let slot = slots.iter().position(|&body| body == link.body).expect("bodies of links have coordinates");
    let Attachment::Joint { joint, reversed, .. } = link.attachment else {
        return (link.attachment == Attachment::Free).then_some(Limb { slot, parent: 0, hinge: None });
    };
    let lead = number(model.value(&model.joints[joint].lead));
    let (of_joint, described) = (Screw::all(&lowered.joints[joint], lead), &lowered.joints[joint]);
    let first = screws.len();
    let hinge = Hinge {
        joint,
        rows: model.rows_of(RowOwner::Joint(joint)),
        child: if reversed { End::First } else { End::Second },
        point: described.second.point,
        frames: [&described.first, &described.second].map(frame),
        screws: first..first + of_joint.len(),
        is_mixed: matches!(
            described.kind,
            gyro_model::JointKind::Universal | gyro_model::JointKind::PointOnLine
        ),
    };
    screws.extend(of_joint);
    let ends = [&model.joints[joint].first, &model.joints[joint].second];
    let parent_body = ends[usize::from(reversed)].body;
    let is_fixed = |body: &gyro_model::Body| body.support == Support::Fixed;
    let n_fixed = |bodies: &[gyro_model::Body]| bodies.iter().filter(|body| is_fixed(body)).count();
    let first_held = 1 + lowered.driven.len();
    let first_fixed = first_held + held.len();
    let parent = match hinge.ends(described).0.place {
        Place::Ground(_) => first_fixed + n_fixed(&model.bodies[..parent_body]),
        Place::Driven(index) => 1 + index,
        Place::Slot(parent) => match held.iter().position(|(held, _)| *held == parent) {
            Some(index) => first_held + index,
            None => {
                let of_parent = limbs.iter().position(|limb| limb.slot == parent);
                first_fixed + n_fixed(&model.bodies) + of_parent.expect("parents come before children")
            }
        },
    };
    Some(Limb { slot, parent, hinge: Some(hinge) })
}

/// Slots and rows of constrained bodies.
fn held<T: Number>(model: &Model, lowered: &Lowered<T>) -> Vec<(usize, Range<usize>)> {
    let slots = model.coordinate_bodies();
    let rows = |slot: usize| model.rows_of(RowOwner::Body(slots[slot]));
    lowered.constrained.iter().map(|body| (body.slot, rows(body.slot))).collect()
}

/// Euler parameters of a joint frame.
fn frame<T: Number>(end: &JointEnd<T>) -> Vector4<T> {
    let axes = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[end.f, end.g, end.h]));
    let q = UnitQuaternion::from_rotation_matrix(&axes);
    Vector4::new(q.w, q.i, q.j, q.k)
}
