//! The scalar coordinates of joints: their values, rates, and what a force along one of them does.

use super::Evaluation;
use super::jet::Jet;
use super::joint::Placed;
use super::linear::Vector;
use super::load::Load;
use super::pose::{Moving, Path, Pose};
use crate::field::Field;
use gyro_model::{CoordinateKind, JointCoordinate};

impl<F: Field> Placed<F> {
    /// Sine and cosine of an angle.
    pub fn sine_and_cosine(&self, kind: CoordinateKind) -> (Jet<F>, Jet<F>) {
        match kind {
            CoordinateKind::FirstAngle => (self.g_i.dot(&self.h_j), self.f_i.dot(&self.h_j)),
            CoordinateKind::SecondAngle => (-self.h_i.dot(&self.g_j), self.h_i.dot(&self.f_j)),
            _ => (self.g_i.dot(&self.f_j), self.f_i.dot(&self.f_j)),
        }
    }

    /// The direction along which a displacement is measured.
    pub fn direction(&self, kind: CoordinateKind) -> &Vector<F> {
        match kind {
            CoordinateKind::X => &self.f_i,
            CoordinateKind::Y => &self.g_i,
            _ => &self.h_i,
        }
    }
}

impl<F: Field> Evaluation<'_, F> {
    /// A coordinate along the poses' path; of an angle the continuous value, which must have a turn reference. `None`
    /// where it is not defined.
    pub(super) fn coordinate(&self, on: JointCoordinate, poses: &[Pose<F>]) -> Option<Jet<F>> {
        let kind = self.textbook.model.coordinate_kind(on);
        let placed = self.joints[on.joint].placed(poses);
        if !kind.is_angle() {
            return Some(placed.direction(kind).dot(&placed.d));
        }
        let turn = self.textbook.turns.iter().position(|turn| *turn == on)?;
        let point = self.scope.point;
        let reference = Jet::constant(point.turn_reference(self.textbook.model, turn).clone());
        let (sin, cos) = (self.scope.sin(&reference), self.scope.cos(&reference));
        let (s, c) = placed.sine_and_cosine(kind);
        let rest = self.scope.atan2(&(&s * &cos - &c * &sin), &(&c * &cos + &s * &sin))?;
        Some(reference + rest)
    }

    /// The continuous value of an angle that has a turn reference. `None` where it is not defined.
    pub fn continuous_angle(&self, on: JointCoordinate) -> Option<F> {
        Some(self.coordinate(on, &self.still)?.value)
    }

    /// How fast the angle of `(C, S)` changes along the motion, `(C S' − S C') / (S² + C²)`: off the constraints not
    /// the rate of the coordinate.
    pub fn angle_rate(&self, on: JointCoordinate) -> Option<F> {
        let (frames, mut poses) = (&self.joints[on.joint], self.still.clone());
        for body in [frames.first.body, frames.second.body] {
            poses[body] = self.pose(body, Path::Motion);
        }
        Some(self.change(on, &poses)?.value)
    }

    /// How fast a coordinate changes along the poses' path, with how fast that changes.
    pub(super) fn change(&self, on: JointCoordinate, poses: &[Pose<F>]) -> Option<Jet<F>> {
        let (kind, zero) = (self.textbook.model.coordinate_kind(on), &self.scope.zero.value);
        let placed = self.joints[on.joint].placed(poses);
        if !kind.is_angle() {
            return Some(placed.direction(kind).dot(&placed.d).derivative(zero));
        }
        let (s, c) = placed.sine_and_cosine(kind);
        let turned = &c * s.derivative(zero) - &s * c.derivative(zero);
        Some(turned * (&s * &s + &c * &c).reciprocal()?)
    }

    /// The rate of a coordinate: of an angle from the bodies' own axes, of a displacement along u
    /// `u·(v_Pj − v_Pi) + (ω_i × u)·d`.
    pub(super) fn coordinate_rate(&self, on: JointCoordinate) -> Jet<F> {
        let joint = &self.joints[on.joint];
        let (i, j) = (&self.moving[joint.first.body], &self.moving[joint.second.body]);
        let placed = joint.placed(&self.still);
        let kind = self.textbook.model.coordinate_kind(on);
        match kind {
            CoordinateKind::Angle => joint.second.h.dot(&j.w) - joint.first.h.dot(&i.w),
            CoordinateKind::FirstAngle => placed.h_i.dot(&(j.omega() - i.omega())),
            CoordinateKind::SecondAngle => placed.h_j.dot(&(j.omega() - i.omega())),
            CoordinateKind::Displacement | CoordinateKind::X | CoordinateKind::Y => {
                let u = placed.direction(kind);
                let speed = j.velocity(&joint.second.point) - i.velocity(&joint.first.point);
                u.dot(&speed) + i.omega().cross(u).dot(&placed.d)
            }
        }
    }

    /// What a force along a coordinate does to the joint's first and second body.
    pub(super) fn loads_along(&self, on: JointCoordinate, force: &Jet<F>) -> [Load<F>; 2] {
        let joint = &self.joints[on.joint];
        let (i, j) = (&self.moving[joint.first.body], &self.moving[joint.second.body]);
        let placed = joint.placed(&self.still);
        let kind = self.textbook.model.coordinate_kind(on);
        let torque = |body: &Moving<F>, axis: &Vector<F>, torque: Jet<F>| {
            Load::torque(body, &self.scope, &axis.times(&torque))
        };
        let (push, back) = (force.clone(), -force.clone());
        match kind {
            CoordinateKind::Angle => [torque(i, &placed.h_i, back), torque(j, &placed.h_j, push)],
            CoordinateKind::FirstAngle => [torque(i, &placed.h_i, back), torque(j, &placed.h_i, push)],
            CoordinateKind::SecondAngle => [torque(i, &placed.h_j, back), torque(j, &placed.h_j, push)],
            CoordinateKind::Displacement | CoordinateKind::X | CoordinateKind::Y => {
                let (u, place) = (placed.direction(kind), j.pose.point(&joint.second.point));
                [Load::at(i, &u.times(&back), &place), Load::at(j, &u.times(&push), &place)]
            }
        }
    }
}
