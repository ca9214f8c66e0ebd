//! Where a body is found: in the state, at rest, or where it is driven to.

use crate::model::motion::Motion;
use crate::model::textbook::rotation;
use crate::number::{Number, number};
use gyro_model::{Model, Support};
use nalgebra::{Vector3, Vector4};

/// A time and a state.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment<'a, T> {
    pub(crate) t: T,
    pub(crate) y: &'a [T],
}

/// Where a body is found.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Place<T> {
    /// In the state.
    Slot(usize),
    /// Folded: fixed in the global frame.
    Ground(Motion<T>),
    /// Folded: one of [`Scene::driven`](crate::model::scene::Scene::driven).
    Driven(usize),
}

/// Where each body of the model is found.
#[derive(Debug)]
pub(crate) struct Places<T>(Vec<Place<T>>);

impl<T> Place<T> {
    pub(crate) fn moving_body(&self) -> Option<usize> {
        match self {
            Self::Slot(moving_body) => Some(*moving_body),
            Self::Ground(_) | Self::Driven(_) => None,
        }
    }
}

impl<T: Number> Places<T> {
    pub(crate) fn new(model: &Model) -> Self {
        let (mut moving_bodies, mut driven) = (0.., 0..);
        let next = |range: &mut std::ops::RangeFrom<usize>| range.next().expect("it has no end");
        let place = |body: usize| match model.bodies[body].support {
            Support::Fixed => Place::Ground(resting(model, body)),
            Support::Driven => Place::Driven(next(&mut driven)),
            Support::Moving | Support::Free | Support::Constrained => Place::Slot(next(&mut moving_bodies)),
        };
        Self((0..model.bodies.len()).map(place).collect())
    }

    /// Where a body of the model is found.
    pub(crate) fn of(&self, body: usize) -> Place<T> {
        self.0[body]
    }
}

/// Where the model file's own states begin in the state; turn references follow.
pub(crate) fn first_state(model: &Model) -> usize {
    13 * model.coordinate_bodies().len() + usize::from(model.has_work())
}

/// A body that stays where the model file puts it.
pub(crate) fn resting<T: Number>(model: &Model, body: usize) -> Motion<T> {
    let body = &model.bodies[body];
    let (p, zero) = (Vector4::from(model.values(&body.orientation)).normalize(), Vector3::zeros());
    Motion {
        r: vector(model.values(&body.position)),
        p: p.map(number),
        a: rotation(&p).map(number),
        s: zero,
        w: zero,
        s_dot: zero,
        w_dot: zero,
    }
}

pub(crate) fn vector<T: Number>(values: [f64; 3]) -> Vector3<T> {
    Vector3::from(values.map(number))
}
