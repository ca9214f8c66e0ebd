//! The partition of the careful form: from the root to the leaves, one 4×4 system in a body's Euler parameters.
//!
//! Which Euler parameter of a body is special follows the rule of [`gyro_sim::charts`]. A parent is corrected before
//! its children look at it, so the block-triangular system needs no coupling blocks, and point rows are met in closed
//! form.

use crate::careful::hinges::{Bearing, Hinge, Hold, Link, Side};
use crate::model::joint::Dot;
use crate::model::lowered::Lowered;
use crate::model::motion::Motion;
use crate::model::place::Moment;
use crate::model::scene::Constrained;
use crate::model::textbook::{p_dot, rotated_gradient, rotation};
use crate::number::{Number, number, resolvable};
use gyro_sim::charts;
use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// The best chart of each body.
pub(crate) fn best<T: Number>(lowered: &Lowered<T>, links: &[Link], y: &[T]) -> Vec<u8> {
    let chart =
        |link: &Link| deciding_vector(lowered, link, y).map_or(0, |vector| charts::best(&[vector])[0]);
    links.iter().map(chart).collect()
}

/// Switches the charts that have become poor; returns the number of switches.
pub(crate) fn follow<T: Number>(lowered: &Lowered<T>, links: &[Link], y: &[T], choice: &mut [u8]) -> u32 {
    let mut switches = 0;
    for (link, chart) in links.iter().zip(choice) {
        if let Some(vector) = deciding_vector(lowered, link, y) {
            let mut followed = [*chart];
            switches += charts::follow(&[vector], &mut followed);
            *chart = followed[0];
        }
    }
    switches
}

/// One Newton step of each body in turn.
pub(crate) fn newton_step<T: Number>(
    lowered: &Lowered<T>,
    links: &[Link],
    t: T,
    choice: &[u8],
    y: &mut [T],
) -> Result<(), T> {
    for (link, &chart) in links.iter().zip(choice) {
        match &link.hold {
            Hold::Constrained(index, _) => restore(&lowered.scene.constrained[*index], y),
            Hold::Free => {
                let step = parameter_step(lowered, link.moving_body, &[], chart, y)?;
                set_p(y, link.moving_body, &(lowered.scene.p(y, link.moving_body) + step));
            }
            Hold::Joint(hinge) => {
                let (facing, parent) = facing_dots(lowered, hinge, Moment { t, y });
                let n_dots = lowered.scene.joints[hinge.joint].dots.len();
                let step = parameter_step(lowered, link.moving_body, &facing[..n_dots], chart, y)?;
                let p = lowered.scene.p(y, link.moving_body) + step;
                set_p(y, link.moving_body, &p);
                let (parent_end, child_end) = hinge.ends(&lowered.scene.joints[hinge.joint]);
                let r = parent.r + parent.a * parent_end.point - rotation(&p) * child_end.point; // eq. (7)
                y[7 * link.moving_body..7 * link.moving_body + 3].copy_from_slice(r.as_slice());
            }
        }
    }
    Ok(())
}

/// Eq. (19) of each body in turn: what its joint leaves free of w' keeps its value, the rest follows from the parent.
pub(crate) fn solve_velocities<T: Number>(
    lowered: &Lowered<T>,
    links: &[Link],
    t: T,
    y: &mut [T],
) -> Result<(), T> {
    for link in links {
        let moving_body = link.moving_body;
        let (s, w) = match &link.hold {
            Hold::Constrained(..) => (Vector3::zeros(), Vector3::zeros()),
            Hold::Free => continue,
            Hold::Joint(hinge) => {
                let joint = &lowered.scene.joints[hinge.joint];
                let (facing, parent) = facing_dots(lowered, hinge, Moment { t, y });
                let (parent_end, child_end) = hinge.ends(joint);
                let (a, w) = (rotation(&lowered.scene.p(y, moving_body)), lowered.scene.w(y, moving_body));
                let rows = facing.map(|facing| facing.velocity_row(&a, &w));
                let w = w + angular_change(hinge.bearing, &rows, &child_end.h)?;
                (parent.tip_velocity(&parent_end.point) - a * w.cross(&child_end.point), w)
            }
        };
        let at = lowered.scene.n_q() + 6 * moving_body;
        y[at..at + 3].copy_from_slice(s.as_slice());
        y[at + 3..at + 6].copy_from_slice(w.as_slice());
    }
    Ok(())
}

/// The change of the child's w' that takes the residuals of the rotation rows away: of a revolute joint at right angles
/// to the child's own axis h', of a fixed one whatever it takes, of a spherical one none.
fn angular_change<T: Number>(
    bearing: Bearing,
    rows: &[(Vector3<T>, T); 3],
    h: &Vector3<T>,
) -> Result<Vector3<T>, T> {
    let [(a1, res1), (a2, res2), (a3, res3)] = rows;
    let (third, third_residual) = match bearing {
        Bearing::Spherical => return Ok(Vector3::zeros()),
        Bearing::Revolute => (h, &T::zero()),
        Bearing::Fixed => (a3, res3),
    };
    // Cramer's rule.
    let determinant = a1.dot(&a2.cross(third));
    resolvable(std::iter::once(determinant))?;
    let sum = a2.cross(third) * *res1 + third.cross(a1) * *res2 + a1.cross(a2) * *third_residual;
    Ok(-sum / determinant)
}

/// A dot-1 row as the child sees it.
#[derive(Clone, Copy)]
struct Facing<T> {
    /// The parent's vector and its rate, global.
    parent: Vector3<T>,
    parent_dot: Vector3<T>,
    /// The child's vector, body frame.
    child: Vector3<T>,
}

impl<T: Number> Facing<T> {
    /// The row's derivative with respect to the child's π', and its rate.
    fn velocity_row(&self, a: &Matrix3<T>, w: &Vector3<T>) -> (Vector3<T>, T) {
        let row = self.child.cross(&a.tr_mul(&self.parent));
        (row, self.parent_dot.dot(&(a * self.child)) + row.dot(w))
    }
}

/// The vector whose largest component decides the chart; none where no rotation is free.
fn deciding_vector<T: Number>(lowered: &Lowered<T>, link: &Link, y: &[T]) -> Option<[T; 4]> {
    let p = lowered.scene.p(y, link.moving_body);
    let Hold::Joint(hinge) = &link.hold else {
        return matches!(link.hold, Hold::Free).then(|| p.into());
    };
    let joint = &lowered.scene.joints[hinge.joint];
    match hinge.bearing {
        // The tangent ½ Gᵀ h'.
        Bearing::Revolute => Some(p_dot(&p, &hinge.ends(joint).1.h).into()),
        Bearing::Spherical => Some(p.into()),
        Bearing::Fixed => None,
    }
}

/// The dot-1 rows of a joint (the first so many of the three), with the motion of the parent.
fn facing_dots<T: Number>(
    lowered: &Lowered<T>,
    hinge: &Hinge,
    at: Moment<'_, T>,
) -> ([Facing<T>; 3], Motion<T>) {
    let joint = &lowered.scene.joints[hinge.joint];
    let parent = lowered.scene.motion(at, &hinge.ends(joint).0.place);
    let facing = |dot: &Dot<T>| {
        let (own, child) = match hinge.child {
            Side::First => (dot.b, dot.a),
            Side::Second => (dot.a, dot.b),
        };
        Facing { parent: parent.a * own, parent_dot: parent.a * parent.w.cross(&own), child }
    };
    let zero = Vector3::zeros();
    let none = Facing { parent: zero, parent_dot: zero, child: zero };
    (std::array::from_fn(|k| joint.dots.get(k).map_or(none, facing)), parent)
}

/// The Newton step of a body's Euler parameters.
fn parameter_step<T: Number>(
    lowered: &Lowered<T>,
    moving_body: usize,
    facing: &[Facing<T>],
    chart: u8,
    y: &[T],
) -> Result<Vector4<T>, T> {
    let p = lowered.scene.p(y, moving_body);
    let a = rotation(&p);
    let mut right = Vector4::zeros();
    for (k, facing) in facing.iter().enumerate() {
        right[k] = -facing.parent.dot(&(a * facing.child));
    }
    right[facing.len()] = T::one() - p.norm_squared();
    solve(&matrix(&p, facing, chart), &right)
}

/// Dot-1 rows, the normalisation, and a unit row for each independent parameter.
fn matrix<T: Number>(p: &Vector4<T>, facing: &[Facing<T>], chart: u8) -> Matrix4<T> {
    let mut matrix = Matrix4::zeros();
    for (k, facing) in facing.iter().enumerate() {
        matrix.set_row(k, &(facing.parent.transpose() * rotated_gradient(p, &facing.child)));
    }
    matrix.set_row(facing.len(), &(p.transpose() * number::<T>(2.0)));
    for (row, k) in (facing.len() + 1..4).zip(independent(facing.len(), chart)) {
        matrix[(row, k)] = T::one();
    }
    matrix
}

/// The independent Euler parameters: the special one where one rotation is free, all others where all three are.
fn independent(n_dots: usize, chart: u8) -> impl Iterator<Item = usize> {
    let special = usize::from(chart & 3);
    (0..4).filter(move |&k| (k == special) == (n_dots > 0))
}

fn solve<T: Number>(matrix: &Matrix4<T>, right: &Vector4<T>) -> Result<Vector4<T>, T> {
    let lu = matrix.lu();
    let pivot = resolvable((0..4).map(|k| lu.lu_internal()[(k, k)]))?;
    lu.solve(right).ok_or(pivot)
}

/// Puts a constrained body back, with the sign of its Euler parameters as it is.
pub(crate) fn restore<T: Number>(body: &Constrained<T>, y: &mut [T]) {
    let at = 7 * body.moving_body;
    let p = Vector4::from_column_slice(&y[at + 3..at + 7]);
    let sign = if p.dot(&body.p0) < T::zero() { -T::one() } else { T::one() };
    y[at..at + 3].copy_from_slice(body.r0.as_slice());
    set_p(y, body.moving_body, &(body.p0 * sign));
}

pub(crate) fn set_p<T: Number>(y: &mut [T], moving_body: usize, p: &Vector4<T>) {
    y[7 * moving_body + 3..7 * moving_body + 7].copy_from_slice(p.as_slice());
}
