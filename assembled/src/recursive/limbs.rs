//! The tree of bodies as the recursive form goes through it.

use crate::model::joint::{End as JointEnd, Joint};
use crate::model::lowered::Lowered;
use crate::model::motion::Motion;
use crate::model::place::{Place, resting};
use crate::number::{Number, number};
use crate::recursive::screws::{End, Screw};
use gyro_model::{Attachment, Model, RowOwner, Support, Tree};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3, Vector4};
use std::ops::Range;

/// Moving bodies with what holds them, and the bodies that do not move.
#[derive(Clone, Debug)]
pub(crate) struct Limbs<T: Number> {
    pub(crate) limbs: Vec<Limb<T>>,
    /// Of each limb its joint's screws.
    pub(crate) screws: Vec<Screw<T>>,
    /// Slots of constrained bodies, in the order of [`Lowered::constrained`], and their rows.
    pub(crate) held: Vec<(usize, Range<usize>)>,
    /// Fixed bodies where the model file puts them, in the model's order.
    pub(crate) fixed: Vec<Motion<T>>,
    /// Of each row the moving_body of the body that it holds.
    pub(crate) children: Vec<usize>,
}

/// A moving body and what holds it; parents come before children.
#[derive(Clone, Debug)]
pub(crate) struct Limb<T> {
    pub(crate) moving_body: usize,
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

impl<T: Number> Limbs<T> {
    pub(crate) fn new(model: &Model, lowered: &Lowered<T>) -> Self {
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
        let hinges = limbs
            .iter()
            .filter_map(|limb: &Limb<T>| Some((limb.moving_body, limb.hinge.as_ref()?.rows.clone())));
        for (moving_body, rows) in hinges.chain(held.iter().cloned()) {
            children[rows].fill(moving_body);
        }
        Self { limbs, screws, held, fixed, children }
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
    let moving_bodies = model.coordinate_bodies();
    let moving_body =
        moving_bodies.iter().position(|&body| body == link.body).expect("bodies of links have coordinates");
    let Attachment::Joint { joint, reversed, .. } = link.attachment else {
        return (link.attachment == Attachment::Free).then_some(Limb { moving_body, parent: 0, hinge: None });
    };
    let lead = number(model.value(&model.joints[joint].lead));
    let (of_joint, described) =
        (Screw::all(&lowered.scene.joints[joint], lead), &lowered.scene.joints[joint]);
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
    let first_held = 1 + lowered.scene.driven.len();
    let first_fixed = first_held + held.len();
    let parent = match hinge.ends(described).0.place {
        Place::Ground(_) => first_fixed + n_fixed(&model.bodies[..parent_body]),
        Place::Driven(index) => 1 + index,
        Place::Slot(parent) => match held.iter().position(|(held, _)| *held == parent) {
            Some(index) => first_held + index,
            None => {
                let of_parent = limbs.iter().position(|limb| limb.moving_body == parent);
                first_fixed + n_fixed(&model.bodies) + of_parent.expect("parents come before children")
            }
        },
    };
    Some(Limb { moving_body, parent, hinge: Some(hinge) })
}

/// Slots and rows of constrained bodies.
fn held<T: Number>(model: &Model, lowered: &Lowered<T>) -> Vec<(usize, Range<usize>)> {
    let moving_bodies = model.coordinate_bodies();
    let rows = |moving_body: usize| model.rows_of(RowOwner::Body(moving_bodies[moving_body]));
    lowered.scene.constrained.iter().map(|body| (body.moving_body, rows(body.moving_body))).collect()
}

/// Euler parameters of a joint frame.
fn frame<T: Number>(end: &JointEnd<T>) -> Vector4<T> {
    let axes = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[end.f, end.g, end.h]));
    let q = UnitQuaternion::from_rotation_matrix(&axes);
    Vector4::new(q.w, q.i, q.j, q.k)
}
