//! The textbook's constraint primitives. Haug (1989), sections 9.4 and 11.2.
//!
//! A primitive is a scalar made of the joint's points and frames on its two bodies. Typed by hand for each are its
//! value with two time derivatives, and its derivative with respect to the bodies' r and p or π'.

use crate::model::joint::Joint;
use crate::model::kinds::Primitive;
use crate::model::motion::{Jet, Motion};
use crate::number::{Number, number};
use nalgebra::{RowVector3, SMatrix, Vector3};
use std::ops::Range;

/// How a vector fixed in a body changes along a direction when the body turns: `∂(xᵀ A a')` with respect to p (N = 4)
/// or π' (N = 3).
pub(crate) type Turning<T, const N: usize> = fn(&Motion<T>, &Vector3<T>, &Vector3<T>) -> SMatrix<T, 1, N>;

/// The derivative of a scalar with respect to one body's r and to its p or π'.
#[derive(Clone, Debug)]
pub(crate) struct Pull<T, const N: usize> {
    /// Which components of r the scalar depends on by structure.
    pub(crate) r_columns: Range<usize>,
    pub(crate) r: RowVector3<T>,
    pub(crate) turn: SMatrix<T, 1, N>,
}

impl<T: Number, const N: usize> Pull<T, N> {
    /// `factor · self`.
    pub(crate) fn times(&self, factor: T) -> Self {
        Self { r_columns: self.r_columns.clone(), r: self.r * factor, turn: self.turn * factor }
    }

    /// Calls the sink with column and value of each entry that is not zero by structure, of a body with this
    /// moving_body.
    pub(crate) fn walk(&self, moving_body: usize, mut sink: impl FnMut(usize, T)) {
        let first_column = (3 + N) * moving_body;
        self.r_columns.clone().for_each(|k| sink(first_column + k, self.r[k]));
        (0..N).for_each(|k| sink(first_column + 3 + k, self.turn[k]));
    }

    /// `alpha · self + beta · other`.
    pub(crate) fn combine(&self, alpha: T, other: &Self, beta: T) -> Self {
        Self {
            r_columns: hull(&self.r_columns, &other.r_columns),
            r: self.r * alpha + other.r * beta,
            turn: self.turn * alpha + other.turn * beta,
        }
    }
}

/// The smallest range that covers both.
fn hull(a: &Range<usize>, b: &Range<usize>) -> Range<usize> {
    match (a.is_empty(), b.is_empty()) {
        (true, _) => b.clone(),
        (_, true) => a.clone(),
        _ => a.start.min(b.start)..a.end.max(b.end),
    }
}

impl Primitive {
    /// Value, first and second time derivative, where bodies with coordinates have no acceleration: minus the last is
    /// γ.
    pub(crate) fn jet<T: Number>(self, joint: &Joint<T>, [i, j]: &[Motion<T>; 2]) -> [T; 3] {
        let (first, second) = (&joint.first, &joint.second);
        let d = || j.point(&second.point).minus(&i.point(&first.point));
        match self {
            Self::Point(k) => {
                let Jet { value, rate, second } = d();
                [value[k], rate[k], second[k]]
            }
            Self::Dot1(a, b) => i.direction(&first.axis(a)).dot(&j.direction(&second.axis(b))),
            Self::Dot2(a) => i.direction(&first.axis(a)).dot(&d()),
            Self::Distance => {
                let d = d();
                let [square, rate, second] = d.dot(&d).map(|x| x * number(0.5) / joint.length);
                [square - joint.length * number(0.5), rate, second]
            }
        }
    }

    /// The derivatives with respect to both bodies' positions.
    pub(crate) fn pulls<T: Number, const N: usize>(
        self,
        joint: &Joint<T>,
        [i, j]: &[Motion<T>; 2],
        turning: Turning<T, N>,
    ) -> [Pull<T, N>; 2] {
        let (first, second) = (&joint.first, &joint.second);
        let along = |x: Vector3<T>, r_columns: Range<usize>| {
            let pull = |sign: T, turn| Pull { r_columns: r_columns.clone(), r: x.transpose() * sign, turn };
            [pull(-T::one(), -turning(i, &x, &first.point)), pull(T::one(), turning(j, &x, &second.point))]
        };
        match self {
            // Haug (1989), spherical constraint: −I and −∂(A_i s'_i), I and ∂(A_j s'_j).
            Self::Point(k) => along(Vector3::ith(k, T::one()), k..k + 1),
            Self::Dot1(a, b) => {
                let (a, b) = (first.axis(a), second.axis(b));
                let pull = |turn| Pull { r_columns: 0..0, r: RowVector3::zeros(), turn };
                [pull(turning(i, &(j.a * b), &a)), pull(turning(j, &(i.a * a), &b))]
            }
            Self::Dot2(a) => {
                let a = first.axis(a);
                let d = j.tip(&second.point) - i.tip(&first.point);
                let [mut on_i, on_j] = along(i.a * a, 0..3);
                on_i.turn += turning(i, &d, &a);
                [on_i, on_j]
            }
            Self::Distance => along((j.tip(&second.point) - i.tip(&first.point)) / joint.length, 0..3),
        }
    }
}
