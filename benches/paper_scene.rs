//! The paper's scene in one run: generated code against both forms of the runtime-assembled twin, function by function.
//!
//! `cargo bench --bench paper_scene` measures the scene with its base folded and in the paper's own 28-coordinate form. All
//! sides do the same work on the same state, in the same build, warmed up by criterion. Trust ratios, not nanoseconds.

use criterion::{BenchmarkGroup, Criterion, criterion_group, criterion_main, measurement::WallTime};
use gyro_assembled::{Careful, Dense};
use gyro_model::Model;
use gyro_sim::generated::{gyroscope::Gyroscope, gyroscope_maximal::GyroscopeMaximal};
use gyro_sim::{Equations, Partition, Partitioned, Rk4};
use std::hint::black_box;

/// The paper's section 7.
const STEP: f64 = 1e-4;
const STEPS_PER_CORRECTION: u32 = 5;
const CORRECTIONS_PER_SECOND: u32 = 2000;

criterion_group!(benches, folded, maximal);
criterion_main!(benches);

fn folded(criterion: &mut Criterion) {
    let model = model("gyroscope.toml", include_str!("../models/gyroscope.toml"));
    let (careful, dense) = twins(&model);
    compare(criterion, "gyroscope", &Gyroscope::default(), &careful, &dense);
}

fn maximal(criterion: &mut Criterion) {
    let model = model("gyroscope-maximal.toml", include_str!("../models/gyroscope-maximal.toml"));
    let (careful, dense) = twins(&model);
    compare(criterion, "gyroscope-maximal", &GyroscopeMaximal::default(), &careful, &dense);
}

fn model(name: &str, page: &str) -> Model {
    gyro_model::read(name, page).expect("shipped models are free of mistakes")
}

fn twins(model: &Model) -> (Careful<f64>, Dense<f64>) {
    let expectation = "shipped models can be assembled";
    (Careful::new(model).expect(expectation), Dense::new(model).expect(expectation))
}

/// Everything that is measured, for one mechanism and its twins.
fn compare<G, C, D>(criterion: &mut Criterion, scene: &str, generated: &G, careful: &C, dense: &D)
where
    G: Equations + Partition<Scalar = f64>,
    C: Equations + Partition<Scalar = f64>,
    D: Equations + Partition<Scalar = f64>,
{
    let group =
        |criterion: &mut Criterion, what: &str, measure: &dyn Fn(&mut BenchmarkGroup<'_, WallTime>)| {
            let mut group = criterion.benchmark_group(format!("{scene}/{what}"));
            measure(&mut group);
            group.finish();
        };
    group(criterion, "phi", &|g| {
        phi(g, "generated", generated);
        phi(g, "careful", careful);
        phi(g, "dense", dense);
    });
    group(criterion, "phi_q", &|g| {
        phi_q(g, "generated", generated);
        phi_q(g, "careful", careful);
        phi_q(g, "dense", dense);
    });
    group(criterion, "gamma", &|g| {
        gamma(g, "generated", generated);
        gamma(g, "careful", careful);
        gamma(g, "dense", dense);
    });
    group(criterion, "accelerations", &|g| {
        accelerations(g, "generated", generated);
        accelerations(g, "careful", careful);
        accelerations(g, "dense", dense);
    });
    group(criterion, "rk4_step", &|g| {
        rk4_step(g, "generated", generated);
        rk4_step(g, "careful", careful);
        rk4_step(g, "dense", dense);
    });
    group(criterion, "corrected_second", &|g| {
        g.sample_size(10);
        corrected_second(g, "generated", generated);
        corrected_second(g, "careful", careful);
        corrected_second(g, "dense", dense);
    });
}

fn phi<M: Equations<Scalar = f64>>(group: &mut BenchmarkGroup<'_, WallTime>, side: &str, mechanism: &M) {
    let (y, mut out) = (mechanism.start(), mechanism.constraints());
    group.bench_function(side, |b| b.iter(|| mechanism.phi(0.0, black_box(&y), black_box(&mut out))));
}

fn phi_q<M: Equations<Scalar = f64>>(group: &mut BenchmarkGroup<'_, WallTime>, side: &str, mechanism: &M) {
    let (y, mut out) = (mechanism.start(), mechanism.phi_q_values());
    group.bench_function(side, |b| b.iter(|| mechanism.phi_q(0.0, black_box(&y), black_box(&mut out))));
}

fn gamma<M: Equations<Scalar = f64>>(group: &mut BenchmarkGroup<'_, WallTime>, side: &str, mechanism: &M) {
    let (y, mut out) = (mechanism.start(), mechanism.rows());
    group.bench_function(side, |b| b.iter(|| mechanism.gamma(0.0, black_box(&y), black_box(&mut out))));
}

fn accelerations<M: Equations<Scalar = f64>>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    side: &str,
    mechanism: &M,
) {
    let (y, mut out) = (mechanism.start(), mechanism.accelerations_buffer());
    group.bench_function(side, |b| {
        b.iter(|| mechanism.accelerations(0.0, black_box(&y), black_box(&mut out)));
    });
}

fn rk4_step<M: Equations<Scalar = f64>>(group: &mut BenchmarkGroup<'_, WallTime>, side: &str, mechanism: &M) {
    let start = mechanism.start();
    let (mut y, mut rk4) = (start.clone(), Rk4::new(&start));
    group.bench_function(side, |b| {
        b.iter(|| {
            y.clone_from(&start);
            rk4.step(mechanism, 0.0, STEP, black_box(&mut y));
        });
    });
}

/// One second at the paper's settings: ten thousand steps and two thousand corrections.
fn corrected_second<M: Partition<Scalar = f64>>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    side: &str,
    mechanism: &M,
) {
    group.bench_function(side, |b| {
        b.iter(|| {
            let mut y = mechanism.start();
            let mut solver = Partitioned::new(mechanism, &y);
            for interval in 0..CORRECTIONS_PER_SECOND {
                let t = f64::from(interval * STEPS_PER_CORRECTION) * STEP;
                solver
                    .advance(mechanism, t, STEP, STEPS_PER_CORRECTION, &mut y)
                    .expect("the paper's scene runs");
            }
            black_box(y)
        });
    });
}
