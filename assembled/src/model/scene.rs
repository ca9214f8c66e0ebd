//! Bodies and joints in numbers, and how they move at a moment.

use crate::model::course::DrivenBody;
use crate::model::joint::Joint;
use crate::model::motion::Motion;
use crate::model::place::{Moment, Place, Places, resting, vector};
use crate::number::{Number, number};
use gyro_model::{JointCoordinate, Model, Support};
use nalgebra::{Matrix3, Vector3, Vector4};

/// Bodies, joints and inputs: what rows, forces and outputs are made of.
#[derive(Clone, Debug)]
pub struct Scene<T: Number> {
    /// Of a uniform gravity.
    pub(crate) gravity: Vector3<T>,
    /// μ of a central body, and where it is.
    attraction: Option<(T, Vector3<T>)>,
    /// Bodies with coordinates, by moving_body.
    pub(crate) bodies: Vec<Body<T>>,
    pub(crate) constrained: Vec<Constrained<T>>,
    /// Bodies whose whole motion is prescribed.
    pub(crate) driven: Vec<DrivenBody>,
    pub(crate) joints: Vec<Joint<T>>,
    /// The frames that rows, and rates of formulas, see besides those of joints.
    pairs: Vec<Joint<T>>,
    /// Names and values.
    pub(crate) inputs: Vec<(String, T)>,
}

/// A body with coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Body<T> {
    pub(crate) mass: T,
    /// J', body frame.
    pub(crate) inertia: Matrix3<T>,
}

/// A body that its own six rows hold in place, paper, eqs. (5) and (6).
#[derive(Clone, Debug)]
pub(crate) struct Constrained<T> {
    pub(crate) moving_body: usize,
    pub(crate) r0: Vector3<T>,
    pub(crate) p0: Vector4<T>,
}

impl<T: Number> Scene<T> {
    /// `reference` tells where the state has the turn reference of an angle.
    pub(crate) fn new(
        model: &Model,
        places: &Places<T>,
        reference: impl Fn(JointCoordinate) -> Option<usize> + Copy,
        pairs: &[usize],
    ) -> Self {
        let moving_bodies = model.coordinate_bodies();
        let joints: Vec<_> =
            (0..model.joints.len()).map(|joint| Joint::new(model, places, joint, reference)).collect();
        let constrained = |(moving_body, &body): (usize, &usize)| {
            let held = model.bodies[body].support == Support::Constrained;
            held.then(|| constrained(model, body, moving_body))
        };
        let is_driven = |&body: &usize| model.bodies[body].support == Support::Driven;
        let driven = (0..model.bodies.len()).filter(is_driven);
        Self {
            gravity: vector(model.values(&model.gravity)),
            attraction: model.attraction.as_ref().map(|attraction| {
                (number(model.value(&attraction.mu)), vector(model.values(&attraction.centre)))
            }),
            bodies: moving_bodies.iter().map(|&body| lower_body(model, body)).collect(),
            constrained: moving_bodies.iter().enumerate().filter_map(constrained).collect(),
            driven: driven.map(|body| DrivenBody::new(model, body)).collect(),
            pairs: pairs.iter().map(|output| Joint::of_frames(model, places, *output)).collect(),
            joints,
            inputs: model
                .inputs
                .iter()
                .map(|p| (p.name.clone(), number(gyro_model::to_f64(&p.value))))
                .collect(),
        }
    }

    /// A joint, or two frames that a row sees.
    pub(crate) fn joint(&self, index: usize) -> &Joint<T> {
        self.joints.get(index).unwrap_or_else(|| &self.pairs[index - self.joints.len()])
    }

    /// The acceleration of what falls freely at a point.
    pub(crate) fn gravity_at(&self, point: &Vector3<T>) -> Vector3<T> {
        let Some((mu, centre)) = &self.attraction else { return self.gravity };
        let d = centre - point;
        let distance = d.norm();
        d * (*mu / (distance * distance * distance))
    }

    /// The energy of a unit mass in the field of a central body.
    pub(crate) fn potential_at(&self, point: &Vector3<T>) -> T {
        self.attraction.as_ref().map_or(T::zero(), |(mu, centre)| -(*mu / (point - centre).norm()))
    }

    pub(crate) fn n_bodies(&self) -> usize {
        self.bodies.len()
    }

    /// Number of positions.
    pub(crate) fn n_q(&self) -> usize {
        7 * self.bodies.len()
    }

    /// Number of velocities.
    pub(crate) fn n_v(&self) -> usize {
        6 * self.bodies.len()
    }

    /// r of a moving_body.
    pub(crate) fn r(&self, y: &[T], moving_body: usize) -> Vector3<T> {
        Vector3::from_column_slice(&y[7 * moving_body..7 * moving_body + 3])
    }

    /// p of a moving_body.
    pub(crate) fn p(&self, y: &[T], moving_body: usize) -> Vector4<T> {
        Vector4::from_column_slice(&y[7 * moving_body + 3..7 * moving_body + 7])
    }

    /// s of a moving_body.
    pub(crate) fn s(&self, y: &[T], moving_body: usize) -> Vector3<T> {
        let at = self.n_q() + 6 * moving_body;
        Vector3::from_column_slice(&y[at..at + 3])
    }

    /// w' of a moving_body.
    pub(crate) fn w(&self, y: &[T], moving_body: usize) -> Vector3<T> {
        let at = self.n_q() + 6 * moving_body + 3;
        Vector3::from_column_slice(&y[at..at + 3])
    }

    /// Position and velocity of a body.
    #[inline]
    pub(crate) fn motion(&self, at: Moment<'_, T>, place: &Place<T>) -> Motion<T> {
        match place {
            Place::Slot(moving_body) => {
                let y = at.y;
                Motion::new(
                    self.r(y, *moving_body),
                    self.p(y, *moving_body),
                    self.s(y, *moving_body),
                    self.w(y, *moving_body),
                )
            }
            Place::Ground(motion) => *motion,
            Place::Driven(index) => self.driven_motion(at.t, *index),
        }
    }

    /// Position, velocity and acceleration of a body that moves by prescription.
    pub(crate) fn driven_motion(&self, t: T, index: usize) -> Motion<T> {
        self.driven[index].motion(gyro_sim::Real::to_f64(t)).rounded()
    }

    /// Position and velocity of a joint's bodies.
    #[inline]
    pub(crate) fn motions(&self, at: Moment<'_, T>, joint: &Joint<T>) -> [Motion<T>; 2] {
        [self.motion(at, &joint.first.place), self.motion(at, &joint.second.place)]
    }
}

fn lower_body<T: Number>(model: &Model, body: usize) -> Body<T> {
    let body = &model.bodies[body];
    let [xx, yy, zz, xy, xz, yz] = model.values(&body.inertia).map(number::<T>);
    let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
    Body { mass: number(model.value(&body.mass)), inertia }
}

fn constrained<T: Number>(model: &Model, body: usize, moving_body: usize) -> Constrained<T> {
    let Motion { r, p, .. } = resting(model, body);
    Constrained { moving_body, r0: r, p0: p }
}
