//! What acts along the coordinates of joints, for arrows.

use super::laws::told;
use crate::columns;
use gyro_model::{Force, ForceKind, Joint, JointCoordinate, Model, StopSide};
use gyro_show::{Amount, Effort};

/// Each force along a coordinate, and the joints' own friction, but that of ball joints.
pub(super) fn efforts(model: &Model) -> Vec<Effort> {
    let has_own = |of: &Joint| !of.damping.is_zero() && !of.kind.coordinates().is_empty();
    let own = model.joints.iter().enumerate().filter(|(_, of)| has_own(of)).map(|(joint, of)| {
        let on = JointCoordinate { joint, coordinate: 0 };
        effort(model, on, "damper", vec![("damping", Amount::Value(model.value(&of.damping)))])
    });
    own.chain(model.forces.iter().filter_map(|force| along(model, force))).collect()
}

fn along(model: &Model, force: &Force) -> Option<Effort> {
    let parts = force.kind.parts();
    let law = match &force.kind {
        ForceKind::Stop { side: StopSide::Lower, .. } => "lower",
        ForceKind::Stop { side: StopSide::Upper, .. } => "upper",
        _ => parts.word,
    };
    let numbers = parts.numbers.iter().map(|(key, numbers)| (*key, told(model, &numbers[0])));
    parts.on.map(|(on, _)| effort(model, on, law, numbers.collect()))
}

fn effort(
    model: &Model,
    on: JointCoordinate,
    law: &'static str,
    numbers: Vec<(&'static str, Amount)>,
) -> Effort {
    let kind = model.coordinate_kind(on);
    let shown = columns::coordinates(model).into_iter();
    let title = shown.filter(|shown| shown.joint == on.joint).find(|shown| shown.kind == Some(kind));
    Effort {
        joint: on.joint,
        coordinate: kind.name(),
        title: title.map_or_else(String::new, |shown| shown.name),
        law,
        numbers: numbers.into_iter().collect(),
    }
}
