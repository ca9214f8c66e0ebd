//! What a joint leaves free, as screws, and six-vectors about a point common to all bodies.
//!
//! A six-vector is `(linear, angular)`: of a motion the velocity of the body's point that is just at the common point,
//! and ω; of a force its resultant, and its moment about the common point.

use crate::model::joint::Joint;
use crate::model::kinds::Axis;
use crate::number::{Number, number};
use gyro_model::JointKind;
use nalgebra::Vector3;

/// A motion or a force.
pub(crate) type Six<T> = [T; 6];

/// A symmetric inertia: what it makes of an acceleration is a force.
pub(crate) type Inertia6<T> = [[T; 6]; 6];

/// Which of a joint's bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    First,
    Second,
}

/// A relative motion that a joint leaves free: a rotation about an axis through the second body's joint point, a
/// displacement along it, or both at a fixed ratio.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screw<T> {
    /// In which body the axis is fixed.
    pub(crate) of: End,
    /// Unit vector in that body's frame.
    pub(crate) axis: Vector3<T>,
    /// One of what turns, zero of what only slides.
    pub(crate) turn: T,
    /// Displacement for a unit of the rotation, or of itself where nothing turns.
    pub(crate) slide: T,
}

impl<T: Number> Screw<T> {
    /// All screws of a joint, each orthogonal to those that are alike. Those fixed in the first body come before those
    /// fixed in the second.
    pub(crate) fn all(joint: &Joint<T>, lead: T) -> Vec<Self> {
        use Axis::{F, G, H};
        let (zero, one) = (number(0.0), number(1.0));
        let screw = |of, axis, turn, slide| {
            let end = if of == End::First { &joint.first } else { &joint.second };
            Self { of, axis: end.axis(axis), turn, slide }
        };
        let turn = |of, axis| screw(of, axis, one, zero);
        let slide = |axis| screw(End::First, axis, zero, one);
        let ball = || [F, G, H].map(|axis| turn(End::Second, axis)).to_vec();
        match joint.kind {
            JointKind::Revolute => vec![turn(End::Second, H)],
            JointKind::Spherical => ball(),
            JointKind::Fixed => vec![],
            JointKind::Universal => vec![turn(End::First, H), turn(End::Second, H)],
            JointKind::Cylindrical => vec![slide(H), turn(End::Second, H)],
            JointKind::Prismatic => vec![slide(H)],
            JointKind::Planar => vec![slide(F), slide(G), turn(End::Second, H)],
            JointKind::Screw => vec![screw(End::Second, H, one, lead)],
            JointKind::PointOnLine => [vec![slide(H)], ball()].concat(),
            JointKind::Rod => unreachable!("a rod carries no body of a tree"),
        }
    }

    /// The motion at unit rate, for the axis and the joint point seen from the common point, both global.
    #[inline]
    pub(crate) fn motion(&self, axis: &Vector3<T>, point: &Vector3<T>) -> Six<T> {
        six(&(point.cross(axis) * self.turn + axis * self.slide), &(axis * self.turn))
    }
}

/// Both halves in one.
#[inline]
pub(crate) fn six<T: Number>(linear: &Vector3<T>, angular: &Vector3<T>) -> Six<T> {
    [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
}

/// The linear half.
#[inline]
pub(crate) fn linear<T: Number>(v: &Six<T>) -> Vector3<T> {
    Vector3::new(v[0], v[1], v[2])
}

/// The angular half.
#[inline]
pub(crate) fn angular<T: Number>(v: &Six<T>) -> Vector3<T> {
    Vector3::new(v[3], v[4], v[5])
}

/// `a · b`.
#[inline]
pub(crate) fn dot<T: Number>(a: &Six<T>, b: &Six<T>) -> T {
    (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) + (a[3] * b[3] + a[4] * b[4] + a[5] * b[5])
}

/// `a + factor b`.
#[inline]
pub(crate) fn plus<T: Number>(a: &Six<T>, factor: T, b: &Six<T>) -> Six<T> {
    std::array::from_fn(|k| a[k] + factor * b[k])
}

/// `matrix v`.
#[inline]
pub(crate) fn apply<T: Number>(matrix: &Inertia6<T>, v: &Six<T>) -> Six<T> {
    let mut out: Six<T> = matrix[0].map(|x| x * v[0]);
    for k in 1..6 {
        out = plus(&out, v[k], &matrix[k]);
    }
    out
}

/// The rate of a motion b that is fixed in a body with the motion a: Featherstone's `a ×  b`.
#[inline]
pub(crate) fn carried<T: Number>(a: &Six<T>, b: &Six<T>) -> Six<T> {
    let (turn, b_turn) = (angular(a), angular(b));
    six(&(turn.cross(&linear(b)) + linear(a).cross(&b_turn)), &turn.cross(&b_turn))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_is_applied_column_by_column() {
        let matrix: Inertia6<f64> = std::array::from_fn(|i| std::array::from_fn(|j| (i * j + i + j) as f64));
        let v: Six<f64> = [1.0, -2.0, 3.0, 0.5, -1.0, 2.0];
        let by_rows: Six<f64> = std::array::from_fn(|i| dot(&matrix[i], &v));
        assert_eq!(apply(&matrix, &v), by_rows);
    }

    /// A motion fixed in a turning body: the difference quotient of what the body carries along.
    #[test]
    fn carried_motions_are_derivatives() {
        let (a, b) = ([0.3, -0.2, 0.5, 0.7, 0.1, -0.4], [0.2, 0.6, -0.1, -0.3, 0.8, 0.5]);
        let h = 1e-6;
        let moved = |h: f64| {
            // To first order the body has turned by ω h and moved by v h, and so has the axis of b.
            let turned = |v: Vector3<f64>| v + angular(&a).cross(&v) * h;
            let (spin, shift) = (turned(angular(&b)), linear(&a) * h);
            six(&(turned(linear(&b)) + shift.cross(&spin)), &spin)
        };
        let quotient = plus(&moved(h), -1.0, &moved(-h)).map(|x| x / (2.0 * h));
        let expected = carried(&a, &b);
        assert!(
            quotient.iter().zip(&expected).all(|(x, y)| (x - y).abs() < 1e-9),
            "{quotient:?} {expected:?}"
        );
    }
}
