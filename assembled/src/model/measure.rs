//! What constraint rows measure: primitives, and the angles between joint frames.

use crate::model::joint::Joint;
use crate::model::kinds::{Axis, Primitive};
use crate::model::motion::Motion;
use crate::model::primitives::{Pull, Turning};
use crate::number::{Number, atan2, number, sin_cos};
use gyro_model::CoordinateKind;

/// A scalar coordinate of a joint.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coordinate {
    pub(crate) joint: usize,
    pub(crate) kind: CoordinateKind,
    pub(crate) measure: Measure,
}

impl Coordinate {
    /// One of a joint's.
    pub(crate) fn of<T>(joint: &Joint<T>, coordinate: usize) -> Self {
        let kind = joint.kind.coordinates()[coordinate];
        Self { joint: joint.index, kind, measure: Measure::of(kind, joint.references[coordinate]) }
    }
}

/// A scalar of a joint of which a row can be made.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Measure {
    Primitive(Primitive),
    Angle(Angle),
}

/// What a joint measures, times a factor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Term<T> {
    pub(crate) factor: T,
    pub(crate) joint: usize,
    pub(crate) measure: Measure,
}

/// `atan2(S, C)` with dot-1 forms S and C, continued over turns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Angle {
    sine: Primitive,
    cosine: Primitive,
    /// Where the state has the angle's turn reference; without one the angle is the principal one.
    reference: Option<usize>,
}

impl Measure {
    /// A joint coordinate as its definition says: [`CoordinateKind`].
    fn of(kind: CoordinateKind, reference: Option<usize>) -> Self {
        use Axis::{F, G, H, MinusG};
        use Primitive::{Dot1, Dot2};
        let angle = |sine, cosine| Self::Angle(Angle { sine, cosine, reference });
        match kind {
            CoordinateKind::Angle => angle(Dot1(G, F), Dot1(F, F)),
            CoordinateKind::FirstAngle => angle(Dot1(G, H), Dot1(F, H)),
            CoordinateKind::SecondAngle => angle(Dot1(H, MinusG), Dot1(H, F)),
            CoordinateKind::Displacement => Self::Primitive(Dot2(H)),
            CoordinateKind::X => Self::Primitive(Dot2(F)),
            CoordinateKind::Y => Self::Primitive(Dot2(G)),
        }
    }

    /// A number of two frames that tells where the second is: see [`gyro_model::Relative`].
    pub(crate) fn of_place(number: usize) -> Self {
        let axis = |k: usize| [Axis::F, Axis::G, Axis::H][k % 3];
        Self::Primitive(match number {
            0..3 => Primitive::Dot2(axis(number)),
            _ => Primitive::Dot1(axis(number / 3 - 1), axis(number)),
        })
    }

    /// Value, first and second time derivative, as in [`Primitive::jet`].
    pub(crate) fn jet<T: Number>(&self, joint: &Joint<T>, motions: &[Motion<T>; 2], y: &[T]) -> [T; 3] {
        match self {
            Self::Primitive(primitive) => primitive.jet(joint, motions),
            Self::Angle(angle) => angle.jet(joint, motions, y),
        }
    }

    /// The derivatives with respect to both bodies' positions.
    pub(crate) fn pulls<T: Number, const N: usize>(
        &self,
        joint: &Joint<T>,
        motions: &[Motion<T>; 2],
        turning: Turning<T, N>,
    ) -> [Pull<T, N>; 2] {
        match self {
            Self::Primitive(primitive) => primitive.pulls(joint, motions, turning),
            Self::Angle(angle) => angle.pulls(joint, motions, turning),
        }
    }
}

impl Angle {
    /// The raw sine and cosine, up to a common factor.
    pub(crate) fn raw<T: Number>(&self, joint: &Joint<T>, motions: &[Motion<T>; 2]) -> (T, T) {
        (self.sine.jet(joint, motions)[0], self.cosine.jet(joint, motions)[0])
    }

    /// `θ' = (C S' − S C') / D` with `D = S² + C²`, and `θ'' = (C S'' − S C'' − θ' D') / D`.
    fn jet<T: Number>(&self, joint: &Joint<T>, motions: &[Motion<T>; 2], y: &[T]) -> [T; 3] {
        let [s, s_rate, s_second] = self.sine.jet(joint, motions);
        let [c, c_rate, c_second] = self.cosine.jet(joint, motions);
        let square = s * s + c * c;
        let square_rate = number::<T>(2.0) * (s * s_rate + c * c_rate);
        let rate = (c * s_rate - s * c_rate) / square;
        let second = (c * s_second - s * c_second - rate * square_rate) / square;
        [self.continued(s, c, y), rate, second]
    }

    /// The angle within half a turn of its reference.
    fn continued<T: Number>(&self, s: T, c: T, y: &[T]) -> T {
        let Some(reference) = self.reference.map(|at| y[at]) else {
            return atan2(s, c);
        };
        let (sin, cos) = sin_cos(reference);
        reference + atan2(s * cos - c * sin, c * cos + s * sin)
    }

    fn pulls<T: Number, const N: usize>(
        &self,
        joint: &Joint<T>,
        motions: &[Motion<T>; 2],
        turning: Turning<T, N>,
    ) -> [Pull<T, N>; 2] {
        let (s, c) = self.raw(joint, motions);
        let square = s * s + c * c;
        let (sines, cosines) =
            (self.sine.pulls(joint, motions, turning), self.cosine.pulls(joint, motions, turning));
        [0, 1].map(|end| sines[end].combine(c / square, &cosines[end], -s / square))
    }
}
