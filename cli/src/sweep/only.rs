//! `gyro sweep --only`: one scenario by itself.

use super::loaded::Loaded;
use super::starts;
use crate::failure::Failure;
use crate::scene::start;
use crate::simulate::simulate_scene;
use crate::words::number;
use gyro_runner::Start;
use gyro_sweep::Source;
use std::path::Path;

/// Runs scenario k as `simulate` would, and writes its table and plots.
pub(super) fn only(loaded: &Loaded, k: u64, folder: &Path) -> Result<(), Failure> {
    let plan = &loaded.study.plan;
    if k >= plan.scenarios() {
        let last = plan.scenarios() - 1;
        return Err(Failure::Usage(format!("--only {k}: scenarios are numbered from 0 to {last}")));
    }
    let mut values = vec![0.0; plan.targets.len()];
    Source::new(plan).write(k, &mut values);
    let shown = loaded.study.targets.iter().zip(&values);
    let shown: Vec<String> =
        shown.map(|((name, _), value)| format!("{name} = {}", number(*value, 6))).collect();
    crate::remarks::say(&format!("scenario {k}: {}\n", shown.join(", ")))?;
    let wrong = |words: String| Failure::Run(format!("scenario {k}: {words}"));
    let mut scene = loaded.scene.clone();
    let (model, assembled) = starts::assembled(&scene.page, &plan.targets, &values).map_err(wrong)?;
    scene.start = Start { inputs: plan.inputs(&values), watches: Vec::new(), ..start(&model, &assembled) };
    (scene.model, scene.moved) = (model, assembled.moved);
    simulate_scene(scene, &folder.join(format!("scenario-{k}")))
}
