//! The pose must be the one that is meant: not flipped, not far from its guess.

use super::error::AssemblyError;
use super::projection::{Configuration, rotation_vector};
use crate::kinematics::{Kinematics, Pose, dot};
use crate::{JointKind, Model, Quaternion};

/// Rotation of a body from its guess, rad, beyond which another branch may have been meant.
const QUARTER_TURN: f64 = std::f64::consts::FRAC_PI_2;

/// Refuses axes and zero directions that point opposite ways, which the dot-1 rows cannot see, and bodies that are
/// turned by more than a quarter turn.
pub(super) fn check(
    model: &Model,
    kinematics: &Kinematics,
    guess: &Configuration,
    closed: &Configuration,
) -> Result<(), AssemblyError> {
    if let Some((joint, direction)) = flipped(kinematics, closed) {
        let name = model.joints[joint].name.clone();
        return Err(AssemblyError::Flipped { joint, name, direction });
    }
    match most_turned(model, guess, closed) {
        (turned, body) if turned > QUARTER_TURN => Err(AssemblyError::Jump {
            body,
            name: model.bodies[body].name.clone(),
            turned,
            coordinates: coordinates_of(model, body, closed),
        }),
        _ => Ok(()),
    }
}

/// What is to be said of a pose that is on another branch than the guess.
pub(super) fn other(model: &Model, guess: &Configuration, closed: &Configuration) -> AssemblyError {
    let (turned, body) = most_turned(model, guess, closed);
    let name = model.bodies[body].name.clone();
    AssemblyError::OtherBranch { body, name, turned, coordinates: coordinates_of(model, body, closed) }
}

/// The body that is turned most from its guess, and by how much.
fn most_turned(model: &Model, guess: &Configuration, closed: &Configuration) -> (f64, usize) {
    let turned = |moving_body: usize| {
        let p = |at: &Configuration| {
            let q = &at.q[7 * moving_body + 3..7 * moving_body + 7];
            Quaternion([q[0], q[1], q[2], q[3]])
        };
        rotation_vector(p(guess).conjugate() * p(closed)).iter().map(|x| x * x).sum::<f64>().sqrt()
    };
    let bodies = model.coordinate_bodies().into_iter().enumerate();
    let each = bodies.map(|(moving_body, body)| (turned(moving_body), body));
    each.max_by(|a, b| a.0.total_cmp(&b.0)).expect("a loop has a body with coordinates")
}

/// The first joint that is closed the wrong way round.
pub(crate) fn flipped(kinematics: &Kinematics, at: &Configuration) -> Option<(usize, &'static str)> {
    let poses: Vec<Pose<f64>> = kinematics.poses(&at.q).iter().map(crate::kinematics::value_of).collect();
    let of = |joint: usize| {
        let posed = kinematics.posed(joint, &poses);
        let ([f, _, h], [zero, _, axis]) = (posed.first, posed.second);
        match kinematics.joints()[joint].kind {
            JointKind::Universal | JointKind::Spherical | JointKind::PointOnLine | JointKind::Rod => None,
            _ if dot(h, axis) < 0.0 => Some("axis"),
            JointKind::Fixed | JointKind::Prismatic if dot(f, zero) < 0.0 => Some("zero"),
            _ => None,
        }
    };
    (0..kinematics.joints().len()).find_map(|joint| of(joint).map(|direction| (joint, direction)))
}

/// Where the joints of a body are, as the end of a sentence.
fn coordinates_of(model: &Model, body: usize, at: &Configuration) -> String {
    let own = model.joints.iter().zip(&at.near).filter(|(joint, position)| {
        (joint.first.body == body || joint.second.body == body) && !position.is_empty()
    });
    let each = own.map(|(joint, position)| {
        let kinds = joint.kind.coordinates().iter().zip(position);
        let values: Vec<String> =
            kinds.map(|(kind, value)| format!("{} = {value:.6}", kind.name())).collect();
        format!("joint `{}` at {}", joint.name, values.join(", "))
    });
    let each: Vec<String> = each.collect();
    if each.is_empty() { String::new() } else { format!(" ({})", each.join("; ")) }
}
