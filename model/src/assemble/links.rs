//! Links act along the line between two points: where the points coincide there is none.

use super::{AssemblyError, Start};
use crate::kinematics::{Kinematics, value_of};
use crate::{ForceKind, Model, Vector};

/// Points nearer than this part of the mechanism's size, or of their distance from the origin, coincide.
const COINCIDENT: f64 = 1e-12;

/// Refuses a start in which the two ends of a link coincide.
pub(super) fn check(model: &Model, start: &Start) -> Result<(), AssemblyError> {
    let poses: Vec<_> = Kinematics::at(model, 0.0).poses(&start.q).iter().map(value_of).collect();
    for (index, force) in model.forces.iter().enumerate() {
        let ForceKind::Link { first, second, .. } = &force.kind else { continue };
        let [from, to] = [first, second].map(|(body, point)| poses[*body].point(Vector(model.values(point))));
        let reach = from.iter().chain(&to).fold(model.size(), |m: f64, x| m.max(x.abs()));
        if from.iter().zip(&to).all(|(a, b)| (a - b).abs() <= COINCIDENT * reach) {
            return Err(AssemblyError::Link { force: index, name: force.name.clone() });
        }
    }
    Ok(())
}
