//! Joints in numbers: frames normalised, and what each is made of.

use crate::model::kinds::{Axis, Primitive, primitives};
use crate::model::place::{Place, Places, vector};
use crate::model::spot::Spot;
use crate::number::{Number, number};
use gyro_model::{BodyFrame, CoordinateKind, JointCoordinate, JointEnd, JointKind, Model, OutputKind};
use nalgebra::Vector3;

/// A joint between two bodies.
#[derive(Clone, Debug)]
pub(crate) struct Joint<T> {
    pub(crate) kind: JointKind,
    pub(crate) first: End<T>,
    pub(crate) second: End<T>,
    /// Of a rod.
    pub(crate) length: T,
    /// Of each coordinate where the state has its turn reference, if it is an angle that has one.
    pub(crate) references: Vec<Option<usize>>,
    pub(crate) index: usize,
    /// What [`gyro_sim::Mechanism::joint`] says of the readings.
    pub(crate) readings: Vec<gyro_sim::Coordinate>,
    /// The vectors of its dot-1 rows.
    pub(crate) dots: Vec<Dot<T>>,
}

/// A joint as one of its bodies sees it; vectors in that body's frame.
#[derive(Clone, Debug)]
pub(crate) struct End<T> {
    pub(crate) place: Place<T>,
    /// s', the joint's point.
    pub(crate) point: Vector3<T>,
    pub(crate) f: Vector3<T>,
    pub(crate) g: Vector3<T>,
    pub(crate) h: Vector3<T>,
}

/// The vectors of a dot-1 constraint `aᵀ A_iᵀ A_j b = 0`, paper, eqs. (9) and (10).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dot<T> {
    /// Unit vector on the first body, body frame.
    pub(crate) a: Vector3<T>,
    /// Unit vector on the second body, body frame.
    pub(crate) b: Vector3<T>,
}

impl<T: Number> End<T> {
    pub(crate) fn axis(&self, axis: Axis) -> Vector3<T> {
        match axis {
            Axis::F => self.f,
            Axis::G => self.g,
            Axis::H => self.h,
            Axis::MinusG => -self.g,
        }
    }

    /// The joint frame is normalised in `f64`, whatever the scalar.
    fn new(model: &Model, places: &Places<T>, end: &JointEnd) -> Self {
        let h = Vector3::from(model.values(&end.axis)).normalize();
        let zero = Vector3::from(model.values(&end.zero));
        let f = (zero - h * h.dot(&zero)).normalize();
        let [f, g, h] = [f, h.cross(&f), h].map(|v| v.map(number::<T>));
        Self { place: places.of(end.body), point: vector(model.values(&end.point)), f, g, h }
    }

    fn of_frame(model: &Model, places: &Places<T>, frame: &BodyFrame) -> Self {
        let Spot { place, point, turn } = Spot::new(model, places, frame);
        let [f, g, h] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| turn * axis);
        Self { place, point, f, g, h }
    }
}

impl<T: Number> Joint<T> {
    /// `reference` tells where the state has the turn reference of an angle.
    pub(crate) fn new(
        model: &Model,
        places: &Places<T>,
        index: usize,
        reference: impl Fn(JointCoordinate) -> Option<usize>,
    ) -> Self {
        let joint = &model.joints[index];
        let (first, second) = (End::new(model, places, &joint.first), End::new(model, places, &joint.second));
        let dot = |primitive: &Primitive| match *primitive {
            Primitive::Dot1(a, b) => Some(Dot { a: first.axis(a), b: second.axis(b) }),
            _ => None,
        };
        let dots = primitives(joint.kind).iter().filter_map(dot).collect();
        let n_coordinates = joint.kind.coordinates().len();
        let references =
            (0..n_coordinates).map(|coordinate| reference(JointCoordinate { joint: index, coordinate }));
        Self {
            kind: joint.kind,
            first,
            second,
            length: number(model.value(&joint.length)),
            references: references.collect(),
            index,
            readings: readings(joint.kind),
            dots,
        }
    }
}

impl<T: Number> Joint<T> {
    /// Two frames that no joint ties.
    pub(crate) fn of_frames(model: &Model, places: &Places<T>, output: usize) -> Self {
        let OutputKind::Relative(relative) = &model.outputs[output].kind else {
            unreachable!("rows see outputs of two frames only")
        };
        let [first, second] = relative.frames.each_ref().map(|frame| End::of_frame(model, places, frame));
        Self {
            kind: JointKind::Spherical,
            first,
            second,
            length: T::zero(),
            references: Vec::new(),
            index: model.joints.len(),
            readings: Vec::new(),
            dots: Vec::new(),
        }
    }
}

fn readings(kind: JointKind) -> Vec<gyro_sim::Coordinate> {
    if kind == JointKind::Spherical {
        return vec![gyro_sim::Coordinate::Orientation];
    }
    let reading = |kind: &CoordinateKind| {
        if kind.is_angle() { gyro_sim::Coordinate::Angle } else { gyro_sim::Coordinate::Length }
    };
    kind.coordinates().iter().map(reading).collect()
}
