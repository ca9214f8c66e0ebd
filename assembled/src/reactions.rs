//! λ by a balance of forces from the leaves to the root: `Φ_qᵀ λ = f − M a` of each body and its descendants.

use crate::articulated::{Node, attitude};
use crate::careful::{Hinge, Hold, Link, Side};
use crate::freedom::dual_directions;
use crate::lowered::{Joint, Lowered, Place};
use crate::number::{Number, number};
use crate::spatial::Spatial;
use nalgebra::Vector3;

/// Writes λ; the nodes hold the solved accelerations, and their applied forces are used up.
pub(crate) fn multipliers<T: Number>(
    lowered: &Lowered<T>,
    links: &[Link],
    y: &[T],
    nodes: &mut [Node<T>],
    lambda: &mut [T],
) {
    for (node, body) in nodes.iter_mut().zip(&lowered.bodies) {
        let (a, acceleration) = (node.attitude.a, node.acceleration);
        node.applied.linear -= acceleration.linear * body.mass;
        node.applied.angular -= a * (body.inertia * a.tr_mul(&acceleration.angular));
    }
    for link in links.iter().rev() {
        let unbalanced = nodes[link.slot].applied;
        match &link.hold {
            Hold::Free => {}
            Hold::Constrained(index) => {
                let body = &lowered.constrained[*index];
                let torque = nodes[link.slot].attitude.a.tr_mul(&unbalanced.angular);
                let orientation = orientation_multipliers(&lowered.relative_orientation(y, body), &torque);
                lambda[body.first_row..body.first_row + 3].copy_from_slice(unbalanced.linear.as_slice());
                lambda[body.first_row + 3..body.first_row + 6].copy_from_slice(orientation.as_slice());
            }
            Hold::Joint(hinge) => {
                let joint = &lowered.joints[hinge.joint];
                let on_parent = joint_multipliers(joint, hinge, &unbalanced, link.slot, nodes, lambda);
                if let Place::Slot(parent) = hinge.ends(joint).0.place {
                    nodes[parent].applied += on_parent;
                }
            }
        }
    }
}

/// Writes the joint's λ; returns the load on its parent, about the parent's mass centre.
fn joint_multipliers<T: Number>(
    joint: &Joint<T>,
    hinge: &Hinge,
    unbalanced: &Spatial<T>,
    child: usize,
    nodes: &[Node<T>],
    lambda: &mut [T],
) -> Spatial<T> {
    let sign = match hinge.child {
        Side::First => -T::one(),
        Side::Second => T::one(),
    };
    let (parent_end, child_end) = hinge.ends(joint);
    let at_joint = unbalanced.about(&(nodes[child].attitude.a * child_end.point));
    let dual = dual_directions(
        joint,
        &attitude(&joint.first.place, nodes).a,
        &attitude(&joint.second.place, nodes).a,
    );
    let lambda = &mut lambda[joint.first_row..];
    lambda[..3].copy_from_slice((at_joint.linear * sign).as_slice());
    for (k, dual) in dual[..joint.dots.len()].iter().enumerate() {
        lambda[3 + k] = at_joint.angular.dot(dual) * sign;
    }
    at_joint.about(&-(attitude(&parent_end.place, nodes).a * parent_end.point))
}

/// Solves `½ (q₀ I + q̃)ᵀ λ = n'` for a unit `(q₀, q)`.
fn orientation_multipliers<T: Number>((q0, q): &(T, Vector3<T>), torque: &Vector3<T>) -> Vector3<T> {
    (torque * *q0 + q.cross(torque) + q * (q.dot(torque) / *q0)) * number::<T>(2.0)
}
