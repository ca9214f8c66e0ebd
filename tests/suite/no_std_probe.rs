//! A generated scene links into a program without std and without an allocator, and does what it does elsewhere.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use gyro_mechanisms::gyroscope::Gyroscope;
use gyro_sim::{JointCoordinate, Mechanism, Partitioned, Turns};
use gyro_sim_suite::{cargo, say};
use std::path::{Path, PathBuf};
use std::process::Command;

fn probe() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/probes/no_std_probe")
}

fn target() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested")
}

/// What the probe computes, in this process.
fn alpha_here() -> f64 {
    let gyroscope = Gyroscope::<f64>::default();
    let mut state = gyroscope.start();
    let mut solver = Partitioned::new(&gyroscope, &state);
    let mut turns = Turns::new(&gyroscope, 0.0, &state, &[]);
    for interval in 0..2000 {
        let t = f64::from(interval) * 5e-4;
        solver.advance(&gyroscope, t, 1e-4, 5, &mut state).unwrap();
        turns.update(&gyroscope, t + 5e-4, 5e-4, &state);
    }
    match turns.coordinate(&gyroscope, 0, 0) {
        Some(JointCoordinate::Angle { position, .. }) => position,
        other => panic!("{other:?}"),
    }
}

/// One test, as both halves write the package's lock file.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn the_probe_links_without_an_allocator_and_fails_with_an_allocation() {
    let built = cargo(&probe(), &target(), "build", &["--release"]);
    assert!(built.is_success, "{}", built.stderr);
    if cfg!(unix) {
        assert_eq!(linked_and_run(), alpha_here(), "another machine, the same bits");
    }
    // The check must be able to fail, and for this reason.
    let refused = cargo(&probe(), &target(), "build", &["--release", "--features", "allocate"]);
    assert!(!refused.is_success);
    assert!(refused.stderr.contains("no global memory allocator found"), "{}", refused.stderr);
}

/// The number that a C program prints which has nothing of Rust but the probe.
fn linked_and_run() -> f64 {
    let program = target().join("no-std-probe-in-c");
    let mut compiler = Command::new("cc");
    compiler
        .arg(probe().join("main.c"))
        .arg(target().join("release/libno_std_probe.a"))
        .arg("-o")
        .arg(&program);
    let linked = say(&mut compiler);
    assert!(linked.is_success, "{}", linked.stderr);
    say(&mut Command::new(&program)).stdout.trim().parse().unwrap()
}
