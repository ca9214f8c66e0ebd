//! The summary as one JSON object.

use crate::scene::Scene;
use gyro_model::Joint;
use gyro_runner::{JointSample, Sample, Summary};
use serde_json::{Map, Value, json};

/// The object: see the documentation of `simulate --json`.
pub(crate) fn object(scene: &Scene, last: &Sample, summary: &Summary) -> Value {
    json!({
        "model": scene.model.name,
        "engine": scene.engine.name(),
        "method": scene.method(),
        "step": scene.settings.step,
        "t": last.t,
        "joints": joints(&scene.model.joints, &last.joints),
        "constraint_violation": summary.position_violation,
        "velocity_violation": summary.velocity_violation,
        "energy": last.energy(),
        "energy_drift": summary.energy_drift,
        "steps": summary.steps,
        "chart_switches": summary.chart_switches,
        "run_time_s": summary.run_time_s,
    })
}

fn joints(joints: &[Joint], samples: &[JointSample]) -> Map<String, Value> {
    joints.iter().zip(samples).map(|(joint, sample)| (joint.name.clone(), coordinate(sample))).collect()
}

fn coordinate(sample: &JointSample) -> Value {
    match sample {
        JointSample::Angle { position, rate } => json!({ "position": position, "rate": rate }),
        JointSample::Orientation { position, rate } => json!({ "position": position, "rate": rate }),
        JointSample::None => json!({ "position": [], "rate": [] }),
    }
}
