//! How one frame lies and moves, seen from another: see [`gyro_model::Relative`].

use super::Evaluation;
use super::jet::Jet;
use super::linear::{Matrix, Vector};
use super::pose::Pose;
use crate::field::Field;
use gyro_model::BodyFrame;
use std::array::from_fn;

impl<F: Field> Evaluation<'_, F> {
    /// The numbers of [`gyro_model::Relative`], of bodies on their way: `ẋ` is the derivative of x, and with
    /// `R = A_1ᵀ A_2` the angular velocity that of `ω̃ = Ṙ Rᵀ`.
    pub(super) fn relative(&self, frames: [&BodyFrame; 2], poses: [&Pose<F>; 2]) -> Option<Vec<Jet<F>>> {
        let zero = &self.scope.zero.value;
        let derivative = |numbers: &[Jet<F>; 3]| numbers.each_ref().map(|number| number.derivative(zero));
        let place = self.place_between(frames, poses)?;
        let turned = self.matrix_between(frames, poses)?;
        let turning = Matrix(turned.0.each_ref().map(derivative));
        let spin = turning.product(&turned.transposed()).axial();
        let moved = derivative(&place.0);
        Some(place.0.into_iter().chain(turned.0.concat()).chain(moved).chain(spin.0).collect())
    }

    /// The same of the bodies as they are and move.
    pub(super) fn relative_now(&self, frames: [&BodyFrame; 2]) -> Option<Vec<F>> {
        let poses = frames.map(|frame| {
            let moving = &self.moving[frame.body];
            self.moved(&moving.pose, &moving.s, &moving.w)
        });
        Some(self.relative(frames, poses.each_ref())?.into_iter().map(|number| number.value).collect())
    }

    /// From the origin of the first frame to that of the second, by the axes of the first.
    pub(super) fn place_between(
        &self,
        [first, second]: [&BodyFrame; 2],
        poses: [&Pose<F>; 2],
    ) -> Option<Vector<F>> {
        let (i, j) = poses.into();
        let line = j.point(&self.scope.vector(&second.point)) - &i.r;
        self.by_axes(first, &(i.a.transposed().apply(&line) - self.scope.vector(&first.point)))
    }

    /// The matrix of the second frame's axes, by those of the first.
    pub(super) fn matrix_between(
        &self,
        [first, second]: [&BodyFrame; 2],
        poses: [&Pose<F>; 2],
    ) -> Option<Matrix<F>> {
        let toward_first = poses[0].a.transposed();
        let axes = match &second.orientation {
            Some(own) => poses[1].a.product(&self.scope.rotation(&self.scope.unit(own)?)),
            None => poses[1].a.clone(),
        };
        let [x, y, z] = from_fn(|column| {
            let axis = Vector(from_fn(|row| axes.0[row][column].clone()));
            self.by_axes(first, &toward_first.apply(&axis))
        });
        Some(Matrix([x?.0, y?.0, z?.0]).transposed())
    }
}
