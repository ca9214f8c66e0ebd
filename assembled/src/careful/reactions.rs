//! λ by a balance of forces from the leaves to the root: `Φ_qᵀ λ = f − M a` of each body and its descendants.

use crate::careful::articulated::{Space, attitude, place_all};
use crate::careful::hinges::{Hinge, Hold, Link, Side};
use crate::careful::motion_subspace::dual_directions;
use crate::careful::spatial::Spatial;
use crate::model::joint::Joint;
use crate::model::lowered::Lowered;
use crate::model::place::{Moment, Place};
use crate::number::{Number, number};
use nalgebra::Vector3;

/// Writes λ at given accelerations `(s̈, ẇ')`.
pub(crate) fn multipliers<T: Number>(
    lowered: &Lowered<T>,
    links: &[Link],
    at: Moment<'_, T>,
    accelerations: &[T],
    space: &mut Space<T>,
    lambda: &mut [T],
) {
    place_all(lowered, at, space);
    let unbalanced = space.nodes.iter_mut().zip(&lowered.scene.bodies).zip(accelerations.as_chunks::<6>().0);
    for ((node, body), [x, y, z, u, v, w]) in unbalanced {
        node.applied.linear -= Vector3::new(*x, *y, *z) * body.mass;
        node.applied.angular -= node.attitude.a * (body.inertia * Vector3::new(*u, *v, *w));
    }
    lowered.taken_by_rotors(at, accelerations, |place, taken| {
        let (node, k) = (&mut space.nodes[place / 6], place % 6);
        if k < 3 {
            node.applied.linear[k] -= taken;
        } else {
            node.applied.angular -= node.attitude.a.column(k - 3) * taken;
        }
    });
    for link in links.iter().rev() {
        let unbalanced = space.nodes[link.moving_body].applied;
        match &link.hold {
            Hold::Free => {}
            Hold::Constrained(index, first_row) => {
                let body = &lowered.scene.constrained[*index];
                let torque = space.nodes[link.moving_body].attitude.a.tr_mul(&unbalanced.angular);
                let orientation = orientation_multipliers(&lowered.relative_orientation(at.y, body), &torque);
                lambda[*first_row..first_row + 3].copy_from_slice(unbalanced.linear.as_slice());
                lambda[first_row + 3..first_row + 6].copy_from_slice(orientation.as_slice());
            }
            Hold::Joint(hinge) => {
                let joint = &lowered.scene.joints[hinge.joint];
                let on_parent = joint_multipliers(joint, hinge, &unbalanced, link.moving_body, space, lambda);
                if let Place::Slot(parent) = hinge.ends(joint).0.place {
                    space.nodes[parent].applied += on_parent;
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
    Space { nodes, driven, .. }: &Space<T>,
    lambda: &mut [T],
) -> Spatial<T> {
    let sign = match hinge.child {
        Side::First => -T::one(),
        Side::Second => T::one(),
    };
    let (parent_end, child_end) = hinge.ends(joint);
    let at_joint = unbalanced.about(&(nodes[child].attitude.a * child_end.point));
    let [i_a, j_a] = [&joint.first, &joint.second].map(|end| attitude(&end.place, nodes, driven).a);
    let dual = dual_directions((hinge.bearing, joint), &i_a, &j_a);
    let lambda = &mut lambda[hinge.first_row..];
    lambda[..3].copy_from_slice((at_joint.linear * sign).as_slice());
    for (k, dual) in dual[..joint.dots.len()].iter().enumerate() {
        lambda[3 + k] = at_joint.angular.dot(dual) * sign;
    }
    at_joint.about(&-(attitude(&parent_end.place, nodes, driven).a * parent_end.point))
}

/// Solves `½ (q₀ I + q̃)ᵀ λ = n'` for a unit `(q₀, q)`.
fn orientation_multipliers<T: Number>((q0, q): &(T, Vector3<T>), torque: &Vector3<T>) -> Vector3<T> {
    (torque * *q0 + q.cross(torque) + q * (q.dot(torque) / *q0)) * number::<T>(2.0)
}
