//! Accelerations from the leaves to the root and back, without λ.

use crate::careful::hinges::{Bearing, Hinge, Hold, Link, Side};
use crate::careful::motion_subspace::{self, Attitude, MotionSubspace};
use crate::careful::spatial::{Inertia, Spatial};
use crate::model::joint::Joint;
use crate::model::lowered::Lowered;
use crate::model::motion::Motion;
use crate::model::place::{Moment, Place};
use crate::model::textbook::direction_rotation;
use crate::number::{Number, number};
use nalgebra::{Matrix3, Vector3};

/// What one evaluation needs.
#[derive(Clone, Debug)]
pub(crate) struct Space<T> {
    /// Bodies with coordinates.
    pub(crate) nodes: Vec<Node<T>>,
    /// Bodies that move by prescription.
    pub(crate) driven: Vec<Motion<T>>,
    /// `(f, n' − w̃'J'w')`, body after body.
    pub(crate) forces: Vec<T>,
}

/// One body's quantities, all in global axes and about its mass centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node<T> {
    pub(crate) attitude: Attitude<T>,
    /// `(f, A(n' − w̃'J'w'))`.
    pub(crate) applied: Spatial<T>,
    /// The body's inertia with its descendants'.
    inertia: Inertia<T>,
    /// The force with its descendants'.
    force: Spatial<T>,
    /// How the body follows its parent.
    follower: Follower<T>,
    pub(crate) acceleration: Spatial<T>,
}

/// The acceleration of a child once its parent's is known.
#[derive(Clone, Copy, Debug)]
struct Follower<T> {
    /// From the parent's mass centre to the joint's point on the parent.
    parent_arm: Vector3<T>,
    /// From the child's mass centre to the joint's point on the child.
    child_arm: Vector3<T>,
    /// What γ adds to the acceleration that the child would have as part of its parent.
    bias: Spatial<T>,
    subspace: MotionSubspace<T>,
}

impl<T: Number> Node<T> {
    pub(crate) fn new() -> Self {
        let zero = Vector3::zeros();
        Self {
            attitude: Attitude { a: Matrix3::zeros(), omega: zero },
            applied: Spatial::zero(),
            inertia: Inertia::zero(),
            force: Spatial::zero(),
            follower: Follower {
                parent_arm: zero,
                child_arm: zero,
                bias: Spatial::zero(),
                subspace: MotionSubspace::None,
            },
            acceleration: Spatial::zero(),
        }
    }
}

/// Writes `(s̈, ẇ')` of every body to `out`.
pub(crate) fn accelerations<T: Number>(
    lowered: &Lowered<T>,
    links: &[Link],
    at: Moment<'_, T>,
    space: &mut Space<T>,
    out: &mut [T],
) {
    place_all(lowered, at, space);
    let Space { nodes, driven, .. } = space;
    for link in links.iter().rev() {
        if let Hold::Joint(hinge) = &link.hold {
            let joint = (&lowered.scene.joints[hinge.joint], lowered.armature(hinge.joint));
            fold(joint, hinge, link.moving_body, nodes, driven);
        }
    }
    for link in links {
        nodes[link.moving_body].acceleration = acceleration(lowered, at.y, link, nodes, driven);
    }
    for (node, out) in nodes.iter().zip(out.as_chunks_mut::<6>().0) {
        out[..3].copy_from_slice(node.acceleration.linear.as_slice());
        out[3..].copy_from_slice(node.attitude.a.tr_mul(&node.acceleration.angular).as_slice());
    }
}

/// Puts every body by itself into the work space.
pub(crate) fn place_all<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>, space: &mut Space<T>) {
    for (index, motion) in space.driven.iter_mut().enumerate() {
        *motion = lowered.scene.driven_motion(at.t, index);
    }
    lowered.applied_force(at, &mut space.forces);
    for (moving_body, (node, force)) in
        space.nodes.iter_mut().zip(space.forces.as_chunks::<6>().0).enumerate()
    {
        place(lowered, at.y, moving_body, force, node);
    }
}

/// A body by itself.
fn place<T: Number>(lowered: &Lowered<T>, y: &[T], moving_body: usize, force: &[T; 6], node: &mut Node<T>) {
    let body = &lowered.scene.bodies[moving_body];
    let a = direction_rotation(&lowered.scene.p(y, moving_body));
    let [fx, fy, fz, nx, ny, nz] = *force;
    node.attitude = Attitude { a, omega: a * lowered.scene.w(y, moving_body) };
    node.applied = Spatial { linear: Vector3::new(fx, fy, fz), angular: a * Vector3::new(nx, ny, nz) };
    node.force = node.applied;
    node.inertia = Inertia {
        linear: Matrix3::from_diagonal_element(body.mass),
        coupling: Matrix3::zeros(),
        angular: a * body.inertia * a.transpose(),
    };
}

/// Folds a child into its parent: `θ̈` is eliminated, and the rest loads the parent.
fn fold<T: Number>(
    (joint, armature): (&Joint<T>, T),
    hinge: &Hinge,
    child: usize,
    nodes: &mut [Node<T>],
    driven: &[Motion<T>],
) {
    let (parent_end, child_end) = hinge.ends(joint);
    let parent = attitude(&parent_end.place, nodes, driven);
    let node = &nodes[child];
    let (parent_arm, child_arm) = (parent.a * parent_end.point, node.attitude.a * child_end.point);
    let [i, j] = [&joint.first, &joint.second].map(|end| attitude(&end.place, nodes, driven));
    let bias = motion_subspace::rotation_bias((hinge.bearing, joint), &i, &j);
    let angular = match hinge.child {
        Side::First => -bias,
        Side::Second => bias,
    };
    let linear = parent.centripetal(&parent_arm) - node.attitude.centripetal(&child_arm);
    let bias = Spatial { linear, angular };
    let (mut inertia, mut force) = (node.inertia.about(&child_arm), node.force.about(&child_arm));
    force -= inertia.apply(&bias);
    let subspace = match hinge.bearing {
        Bearing::Fixed => MotionSubspace::None,
        Bearing::Spherical => MotionSubspace::all(&inertia, &force),
        // Both dot-1 rows have the second body's axis in their null space.
        Bearing::Revolute => {
            let axis = j.a * joint.second.h;
            // What a carrier accelerates by that has no coordinates is among the applied forces already.
            let carrier = match parent_end.place {
                Place::Driven(index) => driven[index].a * driven[index].w_dot,
                Place::Ground(_) | Place::Slot(_) => Vector3::zeros(),
            };
            let held = armature * axis.dot(&(bias.angular + carrier));
            MotionSubspace::about(axis, (&inertia, armature), (&force, held))
        }
    };
    nodes[child].follower = Follower { parent_arm, child_arm, bias, subspace };
    if let Some(parent) = hinge.loads {
        subspace.eliminate(&mut inertia, &mut force);
        nodes[parent].inertia += inertia.about(&-parent_arm);
        nodes[parent].force += force.about(&-parent_arm);
    }
}

fn acceleration<T: Number>(
    lowered: &Lowered<T>,
    y: &[T],
    link: &Link,
    nodes: &[Node<T>],
    driven: &[Motion<T>],
) -> Spatial<T> {
    let node = &nodes[link.moving_body];
    match &link.hold {
        Hold::Free => node.inertia.solve(&node.force),
        Hold::Constrained(index, _) => {
            let body = &lowered.scene.constrained[*index];
            let (q0, q) = lowered.relative_orientation(y, body);
            // ½ (q₀ I + q̃) ẇ' = ¼ |w'|² q is solved by a multiple of q.
            let angular = node.attitude.a * q * (node.attitude.omega.norm_squared() * number(0.5) / q0);
            Spatial { linear: Vector3::zeros(), angular }
        }
        Hold::Joint(hinge) => {
            let (parent_end, _) = hinge.ends(&lowered.scene.joints[hinge.joint]);
            node.follower.acceleration(&match parent_end.place {
                Place::Slot(moving_body) => nodes[moving_body].acceleration,
                Place::Ground(_) => Spatial::zero(),
                Place::Driven(index) => {
                    let Motion { a, s_dot, w_dot, .. } = driven[index];
                    Spatial { linear: s_dot, angular: a * w_dot }
                }
            })
        }
    }
}

impl<T: Number> Follower<T> {
    /// The child's acceleration.
    fn acceleration(&self, parent: &Spatial<T>) -> Spatial<T> {
        let linear = parent.linear + parent.angular.cross(&self.parent_arm);
        let carried = Spatial { linear, angular: parent.angular };
        let angular = self.subspace.angular(&carried, &self.bias);
        let linear = carried.linear + self.bias.linear;
        Spatial { linear: linear - angular.cross(&self.child_arm), angular }
    }
}

/// How a joint's body is turned.
pub(crate) fn attitude<T: Number>(place: &Place<T>, nodes: &[Node<T>], driven: &[Motion<T>]) -> Attitude<T> {
    match place {
        Place::Slot(moving_body) => nodes[*moving_body].attitude,
        Place::Ground(motion) => Attitude { a: motion.a, omega: Vector3::zeros() },
        Place::Driven(index) => Attitude { a: driven[*index].a, omega: driven[*index].omega() },
    }
}
