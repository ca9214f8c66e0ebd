//! The paper's scene in one run of criterion: the floor, generated code, and the forms of the runtime-assembled model.
//!
//! All sides do the same work on the same state, in the same build, warmed up by criterion. Trust ratios, not
//! nanoseconds, and rather those of `cargo bench --bench performance`, which measures in turns.

use criterion::{Criterion, criterion_group, criterion_main};
use gyro_benches::{Kernel, Scene, kernels, runs};
use std::time::{Duration, Instant};

criterion_group! {
    name = benches;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(500))
        .measurement_time(Duration::from_secs(2));
    targets = single, whole
}
criterion_main!(benches);

fn single(criterion: &mut Criterion) {
    measure(criterion, kernels(&Scene::new()), 50);
}

fn whole(criterion: &mut Criterion) {
    measure(criterion, runs(&Scene::new()), 10);
}

fn measure(criterion: &mut Criterion, kernels: Vec<Kernel<'_>>, samples: usize) {
    for mut kernel in kernels {
        let mut group = criterion.benchmark_group(kernel.what);
        group.sample_size(samples);
        group.bench_function(kernel.side, |bencher| {
            bencher.iter_custom(|times| {
                let began = Instant::now();
                kernel.repeat(times);
                began.elapsed()
            });
        });
        group.finish();
    }
}
