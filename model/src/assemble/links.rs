//! Links act along the line between two points, and a central body attracts along the line to it: where the points
//! coincide there is none.

use super::{AssemblyError, Start};
use crate::kinematics::{Kinematics, turned, value_of};
use crate::{ForceKind, Model, Quaternion, Vector};

/// Points nearer than this part of the mechanism's size, or of their distance from the origin, coincide.
const COINCIDENT: f64 = 1e-12;

/// The part of a motion within which it may be taken for straight: ends that pass each other more narrowly come
/// together.
const STRAIGHT: f64 = 0.1;

/// Refuses a start in which the two ends of a link coincide, or a body is where the central body of gravity is.
pub(super) fn check(model: &Model, start: &Start) -> Result<(), AssemblyError> {
    if let Some(attraction) = &model.attraction {
        let centre = Vector::from(model.values(&attraction.centre));
        let mut bodies = model.coordinate_bodies().into_iter().zip(start.q.chunks_exact(7));
        let at_centre = |q: &[f64]| coincide(model, &[Vector::new(q[0], q[1], q[2]), centre]);
        if let Some((body, _)) = bodies.find(|(_, q)| at_centre(q)) {
            return Err(AssemblyError::Attracted { body, name: model.bodies[body].name.clone() });
        }
    }
    match ends(model, 0.0, &start.q).into_iter().find(|(_, ends)| coincide(model, ends)) {
        Some((force, _)) => Err(AssemblyError::Link { force, name: model.forces[force].name.clone() }),
        None => Ok(()),
    }
}

impl Model {
    /// The name of a link whose ends come together on the way from positions q, with velocities v, at time t through a
    /// step of length h: its force has no direction there, and a run that comes to the point cannot go on.
    ///
    /// q and v are laid out as in [`Start`].
    pub fn closing_link(&self, t: f64, h: f64, q: &[f64], v: &[f64]) -> Option<&str> {
        let (now, then) = (ends(self, t, q), ends(self, t + h, &later(q, v, h)));
        let meet = now.iter().zip(&then).find(|((_, now), (_, then))| {
            let [from, to] = [now, then].map(|[a, b]| *b - *a);
            let way = to - from;
            let part = (-from.dot(&way) / way.dot(&way)).clamp(0.0, 1.0);
            coincide(self, now) || (from + way * part).norm() <= STRAIGHT * way.norm()
        });
        meet.map(|((force, _), _)| self.forces[*force].name.as_str())
    }
}

/// The links, by their places among the forces, and where their ends are.
fn ends(model: &Model, t: f64, q: &[f64]) -> Vec<(usize, [Vector; 2])> {
    let poses: Vec<_> = Kinematics::at(model, t).poses(q).iter().map(value_of).collect();
    let links = model.forces.iter().enumerate().filter_map(|(index, force)| match &force.kind {
        ForceKind::Link { first, second, .. } => Some((index, [first, second])),
        _ => None,
    });
    let place = |(body, point): &(usize, [crate::Number; 3])| {
        Vector::from(poses[*body].point(Vector::from(model.values(point))))
    };
    links.map(|(index, ends)| (index, ends.map(place))).collect()
}

fn coincide(model: &Model, [from, to]: &[Vector; 2]) -> bool {
    let reach = from.iter().chain(to).fold(model.size(), |m: f64, x| m.max(x.abs()));
    from.iter().zip(to).all(|(a, b)| (a - b).abs() <= COINCIDENT * reach)
}

/// The positions after a time with these velocities.
fn later(q: &[f64], v: &[f64], h: f64) -> Vec<f64> {
    let bodies = q.chunks_exact(7).zip(v.chunks_exact(6));
    let moved = bodies.flat_map(|(q, v)| {
        let p = turned(Quaternion([q[3], q[4], q[5], q[6]]), [v[3] * h, v[4] * h, v[5] * h]);
        [q[0] + v[0] * h, q[1] + v[1] * h, q[2] + v[2] * h, p.0[0], p.0[1], p.0[2], p.0[3]]
    });
    moved.collect()
}
