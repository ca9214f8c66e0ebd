//! What a joint is: its rows of Φ and its coordinates, written once over any scalar.

use super::exact::{cross, exact};
use super::geometry::{Pose, angle, dot};
use crate::scalar::Scalar;
use crate::{CoordinateKind, JointEnd, JointKind, Model, PointAxes, Quaternion, Vector, unit_vector};

/// A joint in `f64`.
#[derive(Clone, Debug)]
pub(crate) struct JointGeometry {
    pub(crate) kind: JointKind,
    pub(crate) first: EndGeometry,
    pub(crate) second: EndGeometry,
    /// Along which the points are compared, if they coincide.
    pub(crate) axes: PointAxes,
    /// Screw: advance, m/rad.
    pub(crate) lead: f64,
    /// Rod: length, m.
    pub(crate) length: f64,
}

/// A joint's end in `f64`, all in the body's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EndGeometry {
    pub(crate) body: usize,
    pub(crate) point: Vector,
    /// Unit zero direction.
    pub(crate) f: Vector,
    /// `h × f`.
    pub(crate) g: Vector,
    /// Unit axis.
    pub(crate) h: Vector,
}

impl EndGeometry {
    /// The zero direction loses its part along the axis exactly: `h × zero` and `(h × zero) × h` are formed in
    /// rationals. Where the model file's directions make no frame, which validation refuses, it is that of the body.
    fn of(model: &Model, end: &JointEnd) -> Self {
        let (axis, zero) = (exact(model, &end.axis), exact(model, &end.zero));
        let side = cross(&axis, &zero);
        let frame = [unit_vector(&cross(&side, &axis)), unit_vector(&side), unit_vector(&axis)];
        let [f, g, h] = match frame {
            [Some(f), Some(g), Some(h)] => [f, g, h],
            _ => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vector::from),
        };
        Self { body: end.body, point: Vector::from(model.values(&end.point)), f, g, h }
    }

    /// Orientation of the joint frame in the body's frame.
    pub(crate) fn frame(&self) -> Quaternion {
        Quaternion::from_frame(self.f, self.g, self.h)
    }
}

impl JointGeometry {
    pub(crate) fn of(model: &Model, index: usize) -> Self {
        let joint = &model.joints[index];
        Self {
            kind: joint.kind,
            first: EndGeometry::of(model, &joint.first),
            second: EndGeometry::of(model, &joint.second),
            axes: model.point_axes(index),
            lead: model.value(&joint.lead),
            length: model.value(&joint.length),
        }
    }

    /// The joint between two poses.
    pub(crate) fn between<'a, D: Scalar>(&'a self, i: &Pose<D>, j: &Pose<D>) -> Posed<'a, D> {
        let (near, far) = (i.point(self.first.point), j.point(self.second.point));
        Posed {
            joint: self,
            d: std::array::from_fn(|k| far[k] - near[k]),
            first: [self.first.f, self.first.g, self.first.h].map(|v| i.direction(v)),
            second: [self.second.f, self.second.g, self.second.h].map(|v| j.direction(v)),
        }
    }
}

/// A joint with its two bodies somewhere; all vectors are global.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Posed<'a, D> {
    joint: &'a JointGeometry,
    /// From the first body's joint point to the second's.
    pub(crate) d: [D; 3],
    /// The first body's joint frame (f, g, h).
    pub(crate) first: [[D; 3]; 3],
    /// The second body's.
    pub(crate) second: [[D; 3]; 3],
}

impl<D: Scalar> Posed<'_, D> {
    /// The joint's rows, as [`Model::rows`] describes them. `near` is a value that a screw's angle is near to.
    pub(crate) fn rows(&self, near: f64) -> Vec<D> {
        let ([fi, gi, hi], [_, gj, hj]) = (self.first, self.second);
        let d = self.d;
        let coincident = match self.joint.axes {
            PointAxes::Global => d.to_vec(),
            PointAxes::FirstBody => self.first.map(|axis| dot(axis, d)).to_vec(),
        };
        let parallel = [dot(fi, hj), dot(gi, hj)];
        let on_axis = [dot(fi, d), dot(gi, d)];
        match self.joint.kind {
            JointKind::Revolute => [&coincident[..], &parallel].concat(),
            JointKind::Spherical => coincident,
            JointKind::Fixed => [&coincident[..], &parallel, &[dot(fi, gj)]].concat(),
            JointKind::Universal => [&coincident[..], &[dot(hi, hj)]].concat(),
            JointKind::Cylindrical => [on_axis, parallel].concat(),
            JointKind::Prismatic => [&on_axis[..], &parallel, &[dot(fi, gj)]].concat(),
            JointKind::Planar => [&[dot(hi, d)][..], &parallel].concat(),
            JointKind::Screw => {
                let advance = dot(hi, d) - self.coordinate(CoordinateKind::Angle, near) * self.joint.lead;
                [&on_axis[..], &[advance], &parallel].concat()
            }
            JointKind::PointOnLine => on_axis.to_vec(),
            JointKind::Rod => vec![(dot(d, d) / self.joint.length - self.joint.length) * 0.5],
        }
    }

    /// One of the joint's coordinates; an angle is the one of its values that is nearest to `near`.
    pub(crate) fn coordinate(&self, kind: CoordinateKind, near: f64) -> D {
        let ([fi, gi, hi], [fj, gj, hj]) = (self.first, self.second);
        match kind {
            CoordinateKind::Angle => angle(dot(gi, fj), dot(fi, fj), near),
            CoordinateKind::FirstAngle => angle(dot(gi, hj), dot(fi, hj), near),
            CoordinateKind::SecondAngle => angle(-dot(hi, gj), dot(hi, fj), near),
            CoordinateKind::Displacement => dot(hi, self.d),
            CoordinateKind::X => dot(fi, self.d),
            CoordinateKind::Y => dot(gi, self.d),
        }
    }
}
