//! Where bodies touch, as the page has it.

use super::laws::{told, touching};
use gyro_model::{Force, ForceKind, Model, Number, Shape, ShapeKind};
use gyro_show::Touch;

/// Each contact.
pub(super) fn touches(model: &Model) -> Vec<Touch> {
    let one = |force: &Force| {
        let [x, y, z, mx, my, mz] = touching(force)?.map(|number| told(model, number));
        let ForceKind::Bushing(bushing) = &force.kind else { return None };
        let (first, second) = (&bushing.first, &bushing.second);
        let axes = |p: Option<&[Number; 4]>| p.map_or([1.0, 0.0, 0.0, 0.0], |p| upright(model.values(p)));
        let at: [f64; 3] = model.values(&first.point);
        let orientation = axes(first.orientation.as_ref());
        let is_it = |shape: &Shape| {
            let is_plane = matches!(shape.kind, ShapeKind::Plane(_)) && model.values(&shape.position) == at;
            is_plane && axes(Some(&shape.orientation)) == orientation
        };
        Some(Touch {
            name: force.name.clone(),
            bodies: [first.body, second.body],
            orientation,
            plane: model.bodies[first.body].shapes.iter().any(is_it).then_some(at),
            point: model.values(&second.point),
            force: [x, y, z],
            torque: [mx, my, mz],
        })
    };
    model.forces.iter().filter_map(one).collect()
}

/// Euler parameters of unit length; of none, the identity.
pub(super) fn upright(p: [f64; 4]) -> [f64; 4] {
    let length = p.iter().map(|e| e * e).sum::<f64>().sqrt();
    if length > 0.0 { p.map(|e| e / length) } else { [1.0, 0.0, 0.0, 0.0] }
}
