//! Coordinates along which forces act, and how a unit force along each acts on the bodies at its ends.

use crate::model::joint::Joint;
use crate::model::measure::Coordinate;
use crate::model::motion::Motion;
use crate::model::place::{Moment, Place};
use crate::model::scene::Scene;
use crate::number::Number;
use gyro_model::CoordinateKind;
use nalgebra::Vector3;

/// What a force acts along.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Path<T> {
    /// A coordinate of a joint.
    Coordinate(Coordinate),
    /// The distance of two points in their bodies' frames.
    Line([(Place<T>, Vector3<T>); 2]),
}

/// A force on a body and a torque about its mass centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wrench<T> {
    /// Global frame.
    pub(crate) force: Vector3<T>,
    /// Body frame.
    pub(crate) torque: Vector3<T>,
}

/// How a path is held at both ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grip<T> {
    /// The rate of the coordinate.
    pub(crate) rate: T,
    /// What a unit force along the path exerts on the first and on the second body.
    pub(crate) wrenches: [Wrench<T>; 2],
}

impl<T: Number> Wrench<T> {
    /// A pure torque in the body's frame.
    pub(crate) fn torque(torque: Vector3<T>) -> Self {
        Self { force: Vector3::zeros(), torque }
    }

    /// A force at a global point.
    pub(crate) fn at(motion: &Motion<T>, point: &Vector3<T>, force: Vector3<T>) -> Self {
        Self { force, torque: motion.a.tr_mul(&(point - motion.r).cross(&force)) }
    }

    pub(crate) fn plus(&self, other: &Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }

    pub(crate) fn times(&self, factor: T) -> Self {
        Self { force: self.force * factor, torque: self.torque * factor }
    }

    pub(crate) fn power(&self, motion: &Motion<T>) -> T {
        self.force.dot(&motion.s) + self.torque.dot(&motion.w)
    }
}

impl<T: Number> Path<T> {
    /// The two bodies.
    pub(crate) fn places<'a>(&'a self, scene: &'a Scene<T>) -> [&'a Place<T>; 2] {
        match self {
            Self::Coordinate(coordinate) => {
                let joint = &scene.joints[coordinate.joint];
                [&joint.first.place, &joint.second.place]
            }
            Self::Line(ends) => ends.each_ref().map(|(place, _)| place),
        }
    }

    /// The coordinate.
    pub(crate) fn value(&self, scene: &Scene<T>, at: Moment<'_, T>) -> T {
        match self {
            Self::Coordinate(coordinate) => {
                let joint = &scene.joints[coordinate.joint];
                coordinate.measure.jet(joint, &scene.motions(at, joint), at.y)[0]
            }
            Self::Line(ends) => {
                let [first, second] =
                    ends.each_ref().map(|(place, point)| scene.motion(at, place).tip(point));
                (second - first).norm()
            }
        }
    }

    pub(crate) fn grip(&self, scene: &Scene<T>, motions: &[Motion<T>; 2]) -> Grip<T> {
        match self {
            Self::Coordinate(coordinate) => coordinate.grip(&scene.joints[coordinate.joint], motions),
            Self::Line([(_, first), (_, second)]) => {
                let [i, j] = motions;
                let (from, to) = (i.tip(first), j.tip(second));
                let u = (to - from).normalize();
                Grip {
                    rate: u.dot(&(j.tip_velocity(second) - i.tip_velocity(first))),
                    wrenches: [Wrench::at(i, &from, -u), Wrench::at(j, &to, u)],
                }
            }
        }
    }
}

impl Coordinate {
    /// The rate as [`gyro_model::ForceKind`] means it, and the wrenches that have it as their power per unit of force.
    pub(crate) fn grip<T: Number>(&self, joint: &Joint<T>, motions: &[Motion<T>; 2]) -> Grip<T> {
        let [i, j] = motions;
        let (first, second) = (&joint.first, &joint.second);
        match self.kind {
            CoordinateKind::Angle => Grip {
                rate: second.h.dot(&j.w) - first.h.dot(&i.w),
                wrenches: [Wrench::torque(-first.h), Wrench::torque(second.h)],
            },
            CoordinateKind::FirstAngle => about(&(i.a * first.h), motions),
            CoordinateKind::SecondAngle => about(&(j.a * second.h), motions),
            CoordinateKind::Displacement => along(&first.h, joint, motions),
            CoordinateKind::X => along(&first.f, joint, motions),
            CoordinateKind::Y => along(&first.g, joint, motions),
        }
    }
}

/// Rotation about a global direction.
pub(crate) fn about<T: Number>(u: &Vector3<T>, [i, j]: &[Motion<T>; 2]) -> Grip<T> {
    Grip {
        rate: u.dot(&(j.omega() - i.omega())),
        wrenches: [Wrench::torque(-i.a.tr_mul(u)), Wrench::torque(j.a.tr_mul(u))],
    }
}

/// Displacement along a direction u' of the first body; both forces act at the second body's point.
pub(crate) fn along<T: Number>(u: &Vector3<T>, joint: &Joint<T>, [i, j]: &[Motion<T>; 2]) -> Grip<T> {
    let (u, point) = (i.a * u, j.tip(&joint.second.point));
    let d = point - i.tip(&joint.first.point);
    let velocity = j.tip_velocity(&joint.second.point) - i.tip_velocity(&joint.first.point);
    Grip {
        rate: u.dot(&velocity) + i.omega().cross(&u).dot(&d),
        wrenches: [Wrench::at(i, &point, -u), Wrench::at(j, &point, u)],
    }
}
