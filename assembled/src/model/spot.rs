//! Frames that are fixed in bodies.

use crate::model::motion::Motion;
use crate::model::place::{Place, Places, vector};
use crate::number::Number;
use gyro_model::{BodyFrame, Model};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// A frame of a body.
#[derive(Clone, Debug)]
pub(crate) struct Spot<T> {
    pub(crate) place: Place<T>,
    /// Its origin, in the body's frame.
    pub(crate) point: Vector3<T>,
    /// How it is turned in the body's frame.
    pub(crate) turn: UnitQuaternion<T>,
}

impl<T: Number> Spot<T> {
    pub(crate) fn new(model: &Model, places: &Places<T>, frame: &BodyFrame) -> Self {
        let [e0, e1, e2, e3] = frame.orientation.as_ref().map_or([1.0, 0.0, 0.0, 0.0], |p| model.values(p));
        Self {
            place: places.of(frame.body),
            point: vector(model.values(&frame.point)),
            turn: UnitQuaternion::from_quaternion(Quaternion::new(e0, e1, e2, e3)).cast(),
        }
    }

    /// Its axes, global.
    pub(crate) fn axes(&self, motion: &Motion<T>) -> Matrix3<T> {
        motion.a * self.turn.to_rotation_matrix().matrix()
    }

    /// A vector in the body's frame, by the axes of this one.
    pub(crate) fn by_axes(&self, vector: Vector3<T>) -> Vector3<T> {
        self.turn.inverse_transform_vector(&vector)
    }

    /// Its position and Euler parameters.
    pub(crate) fn pose(&self, motion: &Motion<T>) -> [T; 7] {
        let [e0, e1, e2, e3] = motion.p.into();
        let p = Quaternion::new(e0, e1, e2, e3) * self.turn.quaternion();
        let [x, y, z] = motion.tip(&self.point).into();
        [x, y, z, p.w, p.i, p.j, p.k]
    }

    /// Its velocity and angular velocity.
    pub(crate) fn velocity(&self, motion: &Motion<T>) -> [T; 6] {
        let [[x, y, z], [wx, wy, wz]] =
            [motion.tip_velocity(&self.point), self.by_axes(motion.w)].map(Into::into);
        [x, y, z, wx, wy, wz]
    }
}
