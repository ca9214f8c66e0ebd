//! Runs the runtime-assembled twin in this process.

use crate::args::{Engine, Precision};
use crate::failure::Failure;
use crate::scene::Scene;
use gyro_assembled::{Careful, Dense};
use gyro_runner::{Event, Summary, run};
use gyro_sim::Partition;

/// Runs the twin; `tell` hears of samples and progress.
pub(crate) fn simulate(scene: &Scene, tell: impl FnMut(Event<'_>)) -> Result<Summary, Failure> {
    let model = &scene.model;
    match (scene.engine, scene.precision) {
        (Engine::Dense, Precision::F32) => with(Dense::<f32>::new(model), scene, tell),
        (Engine::Dense, Precision::F64) => with(Dense::<f64>::new(model), scene, tell),
        (_, Precision::F32) => with(Careful::<f32>::new(model), scene, tell),
        (_, Precision::F64) => with(Careful::<f64>::new(model), scene, tell),
    }
}

fn with<M: Partition>(
    mechanism: Result<M, impl std::fmt::Display>,
    scene: &Scene,
    mut tell: impl FnMut(Event<'_>),
) -> Result<Summary, Failure> {
    let mechanism = mechanism.map_err(|e| Failure::Usage(e.to_string()))?;
    let told = |event: Event<'_>| {
        tell(event);
        Ok(())
    };
    run(&mechanism, &scene.settings, &scene.start, told).map_err(|f| Failure::Run(f.to_string()))
}
