//! Rolling bodies that the surface would have to hold back.

use crate::scene::Scene;
use gyro_runner::Sample;

/// Rows hold with whatever force that takes: where it becomes a pull, the body would lift.
pub(crate) fn that_lift(scene: &Scene, samples: &[Sample]) -> Vec<String> {
    let elements = scene.model.elements.iter().filter(|element| element.table == "rolling");
    let lifts = |name: &str| {
        let mut columns = scene.model.outputs.iter().flat_map(|output| {
            let n_columns = output.kind.columns().len();
            std::iter::repeat_n(output.name.as_str(), n_columns)
        });
        let normal = columns.position(|output| output.strip_prefix(name) == Some("_normal"))?;
        let sample =
            samples.iter().find(|sample| sample.outputs.get(normal).is_some_and(|push| *push < 0.0))?;
        Some(format!(
            "The surface under `{name}` pulls at t = {} s: the body would lift off there, and the motion from then on \
             is that of one that is held. The event `{name}_lifts` tells when that begins.",
            sample.t
        ))
    };
    elements.filter_map(|element| lifts(&element.name)).collect()
}
