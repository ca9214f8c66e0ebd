//! What acts along the coordinates of joints, for arrows.

use crate::columns;
use gyro_model::{ForceKind, Joint, JointCoordinate, Model, Number, StopSide};
use gyro_show::{Amount, Effort};

/// Each force along a coordinate, and the joints' own friction, but that of ball joints.
pub(super) fn efforts(model: &Model) -> Vec<Effort> {
    let has_own = |of: &Joint| !of.damping.is_zero() && !of.kind.coordinates().is_empty();
    let own = model.joints.iter().enumerate().filter(|(_, of)| has_own(of)).map(|(joint, of)| {
        let on = JointCoordinate { joint, coordinate: 0 };
        effort(model, on, "damper", &[("damping", &of.damping)])
    });
    own.chain(model.forces.iter().filter_map(|force| along(model, &force.kind))).collect()
}

fn along(model: &Model, kind: &ForceKind) -> Option<Effort> {
    let parts = kind.parts();
    let law = match kind {
        ForceKind::Stop { side: StopSide::Lower, .. } => "lower",
        ForceKind::Stop { side: StopSide::Upper, .. } => "upper",
        _ => parts.word,
    };
    let numbers: Vec<_> = parts.numbers.iter().map(|(name, numbers)| (*name, &numbers[0])).collect();
    // The page knows no formulas.
    if numbers.iter().any(|(_, number)| number.formula().is_some()) {
        return None;
    }
    parts.on.map(|(on, _)| effort(model, on, law, &numbers))
}

fn effort(
    model: &Model,
    on: JointCoordinate,
    law: &'static str,
    numbers: &[(&'static str, &Number)],
) -> Effort {
    let kind = model.coordinate_kind(on);
    let shown = columns::coordinates(model).into_iter();
    let title = shown.filter(|shown| shown.joint == on.joint).find(|shown| shown.kind == Some(kind));
    Effort {
        joint: on.joint,
        coordinate: kind.name(),
        title: title.map_or_else(String::new, |shown| shown.name),
        law,
        numbers: numbers.iter().map(|(name, number)| (*name, amount(model, number))).collect(),
    }
}

fn amount(model: &Model, number: &Number) -> Amount {
    match number {
        Number::Input { index, negated } => {
            Amount::Input { input: *index, sign: if *negated { -1 } else { 1 } }
        }
        other => Amount::Value(model.value(other)),
    }
}
