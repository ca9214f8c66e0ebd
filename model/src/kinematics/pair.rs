//! Two frames of an output: how the second lies and moves, seen from the first.

use super::geometry::{Pose, dot};
use crate::scalar::Scalar;
use crate::{BodyFrame, Model, Number, Quaternion, Relative, Vector};
use std::array::from_fn;

/// The frames of [`Relative`] in `f64`.
#[derive(Clone, Debug)]
pub(crate) struct Pair([Frame; 2]);

#[derive(Clone, Copy, Debug)]
struct Frame {
    body: usize,
    point: Vector,
    axes: [Vector; 3],
}

impl Frame {
    fn new(model: &Model, frame: &BodyFrame) -> Self {
        let exact = |own: &[Number; 4]| Quaternion::unit(&own.each_ref().map(|number| model.exact(number)));
        let turn = frame.orientation.as_ref().and_then(exact).unwrap_or(Quaternion::IDENTITY);
        let axis = |k: usize| turn.rotate(Vector::from(from_fn(|j| f64::from(u8::from(j == k)))));
        Self { body: frame.body, point: Vector::from(model.values(&frame.point)), axes: from_fn(axis) }
    }
}

impl Pair {
    pub(crate) fn new(model: &Model, relative: &Relative) -> Self {
        Self(relative.frames.each_ref().map(|frame| Frame::new(model, frame)))
    }

    pub(crate) fn bodies(&self) -> [usize; 2] {
        self.0.map(|frame| frame.body)
    }

    /// Where the second frame is: x, then the direction cosines.
    pub(crate) fn places<D: Scalar>(&self, poses: &[Pose<D>]) -> [D; Relative::N_PLACES] {
        let [axes, others] = self.0.map(|frame| frame.axes.map(|axis| poses[frame.body].direction(axis)));
        let [from, to] = self.0.map(|frame| poses[frame.body].point(frame.point));
        let line = from_fn(|k| to[k] - from[k]);
        from_fn(|k| if k < 3 { dot(axes[k], line) } else { dot(axes[k / 3 - 1], others[k % 3]) })
    }

    /// A number of it, from the places and the derivatives that they carry.
    pub(crate) fn number<D: Scalar>(places: &[D; Relative::N_PLACES], number: usize) -> f64 {
        let row = |k: usize| &places[3 + 3 * k..6 + 3 * k];
        match number {
            0..Relative::N_PLACES => places[number].re(),
            12..15 => places[number - 12].rate(),
            // ω̃ = Ṙ Rᵀ
            _ => {
                let k = number - 15;
                let (from, to) = (row((k + 1) % 3), row((k + 2) % 3));
                from.iter().zip(to).map(|(from, to)| to.rate() * from.re()).sum()
            }
        }
    }
}
