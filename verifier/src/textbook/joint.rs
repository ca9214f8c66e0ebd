//! Joint frames, and the rows of each kind of joint from the textbook's primitives.

use super::jet::Jet;
use super::linear::Vector;
use super::pose::Pose;
use super::scope::Scope;
use crate::field::Field;
use gyro_model::{JointEnd, JointKind, Model, PointAxes};

/// A joint on one of its bodies, in that body's frame: joint point and frame (f, g, h) with `g = h × f`.
#[derive(Clone, Debug)]
pub struct End<F> {
    pub body: usize,
    pub point: Vector<F>,
    pub f: Vector<F>,
    pub g: Vector<F>,
    pub h: Vector<F>,
}

/// A joint with its numbers.
#[derive(Clone, Debug)]
pub struct JointFrames<F> {
    pub kind: JointKind,
    pub first: End<F>,
    pub second: End<F>,
    pub axes: PointAxes,
    pub lead: Jet<F>,
    pub length: Jet<F>,
}

/// The vectors of a joint in the global frame; i is the first body, j the second.
#[derive(Clone, Debug)]
pub struct Placed<F> {
    pub f_i: Vector<F>,
    pub g_i: Vector<F>,
    pub h_i: Vector<F>,
    pub f_j: Vector<F>,
    pub g_j: Vector<F>,
    pub h_j: Vector<F>,
    /// `d = r_j + A_j s'_j − r_i − A_i s'_i`.
    pub d: Vector<F>,
}

impl<F: Field> JointFrames<F> {
    /// `None` if an axis is zero, or a zero direction along the axis.
    pub fn new(scope: &Scope<'_, F>, model: &Model, index: usize) -> Option<Self> {
        let joint = &model.joints[index];
        Some(Self {
            kind: joint.kind,
            first: End::new(scope, &joint.first)?,
            second: End::new(scope, &joint.second)?,
            axes: model.point_axes(index),
            lead: scope.number(&joint.lead),
            length: scope.number(&joint.length),
        })
    }

    /// The joint in the global frame, its bodies being where `poses` says.
    pub fn placed(&self, poses: &[Pose<F>]) -> Placed<F> {
        let (i, j) = (&poses[self.first.body], &poses[self.second.body]);
        Placed {
            f_i: i.a.apply(&self.first.f),
            g_i: i.a.apply(&self.first.g),
            h_i: i.a.apply(&self.first.h),
            f_j: j.a.apply(&self.second.f),
            g_j: j.a.apply(&self.second.g),
            h_j: j.a.apply(&self.second.h),
            d: j.point(&self.second.point) - i.point(&self.first.point),
        }
    }
}

impl<F: Field> End<F> {
    fn new(scope: &Scope<'_, F>, end: &JointEnd) -> Option<Self> {
        let (f, h) = (scope.unit_across(&end.axis, &end.zero)?, Vector(scope.unit(&end.axis)?));
        Some(Self { body: end.body, point: scope.vector(&end.point), g: h.cross(&f), f, h })
    }
}

impl<F: Field> Placed<F> {
    /// All rows of a joint in the order of [`gyro_model::Model::rows`]; a screw's angle is given for its advance.
    ///
    /// `None` if a rod has zero length.
    pub fn rows(
        &self,
        scope: &Scope<'_, F>,
        joint: &JointFrames<F>,
        angle: Option<&Jet<F>>,
    ) -> Option<Vec<Jet<F>>> {
        // Eqs. (7), (9) and (10); Haug (1989), section 9.4: dot-1, dot-2 and distance.
        let across = || vec![self.f_i.dot(&self.d), self.g_i.dot(&self.d)];
        let point = || match joint.axes {
            PointAxes::Global => self.d.0.to_vec(),
            PointAxes::FirstBody => [across(), vec![self.h_i.dot(&self.d)]].concat(),
        };
        let parallel = || vec![self.f_i.dot(&self.h_j), self.g_i.dot(&self.h_j)];
        let no_turn = || vec![self.f_i.dot(&self.g_j)];
        Some(match joint.kind {
            JointKind::Revolute => [point(), parallel()].concat(),
            JointKind::Spherical => point(),
            JointKind::Fixed => [point(), parallel(), no_turn()].concat(),
            JointKind::Universal => [point(), vec![self.h_i.dot(&self.h_j)]].concat(),
            JointKind::Cylindrical => [across(), parallel()].concat(),
            JointKind::Prismatic => [across(), parallel(), no_turn()].concat(),
            JointKind::Planar => [vec![self.h_i.dot(&self.d)], parallel()].concat(),
            JointKind::Screw => {
                let advance = &joint.lead * angle?;
                [across(), vec![self.h_i.dot(&self.d) - advance], parallel()].concat()
            }
            JointKind::PointOnLine => across(),
            JointKind::Rod => {
                let length = &joint.length;
                vec![(self.d.dot(&self.d) * length.reciprocal()? - length) * &scope.half]
            }
        })
    }
}
