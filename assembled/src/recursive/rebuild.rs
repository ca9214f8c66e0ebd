//! The partition of the recursive form: each body put where its joint's coordinates say, from the root to the leaves.

use crate::careful::charts::{restore, set_p};
use crate::model::lowered::Lowered;
use crate::model::measure::Coordinate;
use crate::model::motion::Motion;
use crate::model::place::Moment;
use crate::model::textbook::{conjugate, product, rotation};
use crate::number::{Number, number, resolvable, sqrt};
use crate::recursive::limbs::{Hinge, Limbs};
use crate::recursive::screws::{End, Screw};
use gyro_model::JointKind;
use nalgebra::{Vector3, Vector4};

/// Moves every body to the nearest place that its joint allows.
///
/// # Errors
/// The length that vanished, where a joint's coordinates cannot be told.
pub(crate) fn positions<T: Number>(
    tree: &Limbs<T>,
    lowered: &Lowered<T>,
    t: T,
    y: &mut [T],
) -> Result<(), T> {
    lowered.scene.constrained.iter().for_each(|body| restore(body, y));
    for limb in &tree.limbs {
        let p = match &limb.hinge {
            None => normalised(lowered.scene.p(y, limb.moving_body))?,
            Some(hinge) => {
                let (r, p) = position(tree, lowered, hinge, Moment { t, y })?;
                y[7 * limb.moving_body..7 * limb.moving_body + 3].copy_from_slice(r.as_slice());
                p
            }
        };
        set_p(y, limb.moving_body, &p);
    }
    Ok(())
}

/// r and p of the child.
fn position<T: Number>(
    tree: &Limbs<T>,
    lowered: &Lowered<T>,
    hinge: &Hinge<T>,
    at: Moment<'_, T>,
) -> Result<(Vector3<T>, Vector4<T>), T> {
    let joint = &lowered.scene.joints[hinge.joint];
    let [i, j] = &mut lowered.scene.motions(at, joint);
    let (first, second) = (product(&i.p, &hinge.frames[0]), product(&j.p, &hinge.frames[1]));
    let between = allowed(joint.kind, product(&conjugate(&first), &second))?;
    let p = match hinge.child {
        End::First => product(&product(&second, &conjugate(&between)), &conjugate(&hinge.frames[0])),
        End::Second => product(&product(&first, &between), &conjugate(&hinge.frames[1])),
    };
    let p = normalised(p)?;
    let child = if hinge.child == End::First { &mut *i } else { &mut *j };
    (child.p, child.a) = (p, rotation(&p));
    let screws = &tree.screws[hinge.screws.clone()];
    let d = if joint.kind == JointKind::Screw {
        let angle = Coordinate::of(joint, 0).measure.jet(joint, &[*i, *j], at.y)[0];
        j.a * screws[0].axis * (screws[0].slide * angle)
    } else {
        let apart = j.tip(&joint.second.point) - i.tip(&joint.first.point);
        along(screws.iter().filter(|screw| screw.turn == number(0.0)), [i, j], &apart)
    };
    let r = match hinge.child {
        End::First => j.tip(&joint.second.point) - d - i.a * joint.first.point,
        End::Second => i.tip(&joint.first.point) + d - j.a * joint.second.point,
    };
    Ok((r, p))
}

/// The part of a vector along the axes of some screws, which are orthogonal.
fn along<'a, T: Number>(
    screws: impl Iterator<Item = &'a Screw<T>>,
    [i, j]: [&Motion<T>; 2],
    v: &Vector3<T>,
) -> Vector3<T> {
    screws.fold(Vector3::zeros(), |sum, screw| {
        let axis = if screw.of == End::First { i.a * screw.axis } else { j.a * screw.axis };
        sum + axis * axis.dot(v)
    })
}

/// The nearest Euler parameters of the second joint frame in the first that a kind of joint allows.
fn allowed<T: Number>(kind: JointKind, q: Vector4<T>) -> Result<Vector4<T>, T> {
    let zero = number(0.0);
    match kind {
        JointKind::Revolute | JointKind::Cylindrical | JointKind::Screw | JointKind::Planar => {
            normalised(Vector4::new(q[0], zero, zero, q[3]))
        }
        JointKind::Fixed | JointKind::Prismatic => normalised(Vector4::new(q[0], zero, zero, zero)),
        JointKind::Spherical | JointKind::PointOnLine | JointKind::Rod => normalised(q),
        // h_i·h_j = q₀² + q₃² − q₁² − q₂² = 0.
        JointKind::Universal => {
            let about = normalised(Vector4::new(q[0], zero, zero, q[3]))?;
            let across = normalised(Vector4::new(zero, q[1], q[2], zero))?;
            Ok((about + across) * sqrt(number::<T>(0.5)))
        }
    }
}

fn normalised<T: Number>(p: Vector4<T>) -> Result<Vector4<T>, T> {
    let norm = p.norm();
    resolvable(std::iter::once(norm)).map(|_| p / norm)
}

/// Gives every body the velocity that its parent's and the rates of its joint make; the rates are the state's.
pub(crate) fn velocities<T: Number>(tree: &Limbs<T>, lowered: &Lowered<T>, t: T, y: &mut [T]) {
    let velocities = lowered.scene.n_q();
    for (moving_body, _) in &tree.held {
        y[velocities + 6 * moving_body..velocities + 6 * moving_body + 6].fill(number(0.0));
    }
    for limb in &tree.limbs {
        let Some(hinge) = &limb.hinge else { continue };
        let (s, w) = velocity(tree, lowered, hinge, Moment { t, y });
        let at = velocities + 6 * limb.moving_body;
        y[at..at + 3].copy_from_slice(s.as_slice());
        y[at + 3..at + 6].copy_from_slice(w.as_slice());
    }
}

/// s and w' of the child.
fn velocity<T: Number>(
    tree: &Limbs<T>,
    lowered: &Lowered<T>,
    hinge: &Hinge<T>,
    at: Moment<'_, T>,
) -> (Vector3<T>, Vector3<T>) {
    let joint = &lowered.scene.joints[hinge.joint];
    let [i, j] = lowered.scene.motions(at, joint);
    let arms = [j.tip(&joint.second.point) - i.r, j.a * joint.second.point];
    let at_point = [i.s + i.omega().cross(&arms[0]), j.s + j.omega().cross(&arms[1])];
    let (turning, sliding) = (j.omega() - i.omega(), at_point[1] - at_point[0]);
    let (mut omega, mut v) = (Vector3::zeros(), Vector3::zeros());
    for screw in &tree.screws[hinge.screws.clone()] {
        let axis = if screw.of == End::First { i.a * screw.axis } else { j.a * screw.axis };
        let rate = if screw.turn == number(0.0) { axis.dot(&sliding) } else { axis.dot(&turning) };
        omega += axis * (screw.turn * rate);
        v += axis * (screw.slide * rate);
    }
    let (omega, at_point, arm, a) = match hinge.child {
        End::First => (j.omega() - omega, at_point[1] - v, arms[0], i.a),
        End::Second => (i.omega() + omega, at_point[0] + v, arms[1], j.a),
    };
    (at_point - omega.cross(&arm), a.tr_mul(&omega))
}
