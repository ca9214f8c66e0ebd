//! Rigid stops: a mechanism starts between them.

use super::{AssemblyError, Start};
use crate::Model;

/// A start beyond a stop by no more than this, rad or parts of the mechanism's size, is on it: assembling rounds, and
/// so does an angle in degrees.
const ON_STOP: f64 = 1e-9;

/// Refuses a start in which a joint is beyond a stop of a contact.
pub(super) fn check(model: &Model, start: &Start) -> Result<(), AssemblyError> {
    for (index, contact) in model.contacts.iter().enumerate() {
        let on = contact.on;
        let value = start.joints[on.joint].position[on.coordinate];
        let is_angle = model.coordinate_kind(on).is_angle();
        let slack = ON_STOP * if is_angle { 1.0 } else { model.size() };
        for (key, outward, end) in [("lower", 1.0, &contact.ends[0]), ("upper", -1.0, &contact.ends[1])] {
            let Some(stop) = end.as_ref().map(|end| model.value(end)) else { continue };
            if outward * (value - stop) < -slack {
                return Err(AssemblyError::BeyondStop {
                    contact: index,
                    name: contact.name.clone(),
                    joint: model.joints[on.joint].name.clone(),
                    key,
                    value,
                    stop,
                    unit: if is_angle { "rad" } else { "m" },
                });
            }
        }
    }
    Ok(())
}
