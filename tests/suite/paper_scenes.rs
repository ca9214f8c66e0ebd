//! The paper's settings at every tabulated time of every scene, by both engines, in both forms.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::Model;
use gyro_reference::{DoubleDouble, Sample, Scene, tabulated};
use gyro_sim_suite::{Engine, PAPER, Run, careful, coordinate, dense, generated, model, simulate};

/// Which scene of the table each model file shows.
const PAGES: [(&str, &str); 7] = [
    ("gyroscope", "paper"),
    ("gyroscope-maximal", "paper"),
    ("gyroscope-parameters", "paper"),
    ("gyroscope-radial-imbalance", "radial-imbalance"),
    ("gyroscope-free-nutation", "free-nutation"),
    ("gyroscope-viscous", "viscous-bearings"),
    ("gyroscope-combined-offsets", "combined-offsets"),
];

/// α and β, rad: RK4's own error at the paper's step is 3e-11. The free nutation turns a thousand times faster than the
/// paper's rings do and is allowed ten times as much.
const RINGS: f64 = 1e-10;
const RINGS_IN_FREE_NUTATION: f64 = 1e-9;

/// φ, rad, of a hundred: a part in 1e11.
const ROTOR: f64 = 1e-9;

/// Rates, over the largest of the table.
const RATES: f64 = 1e-7;

/// The least scale of a rate, rad/s, for rates that are zero throughout the table: one part in 1e5 of the spin.
const LEAST_RATE: f64 = 1e-3;

/// ‖Φ‖: Newton–Raphson ends at a few roundings of one.
const VIOLATION: f64 = 1e-12;

fn scene(name: &str) -> Scene {
    tabulated().into_iter().find(|scene| scene.name == name).expect("the table has all scenes")
}

fn joints(sample: &Sample) -> [(f64, f64); 3] {
    let Sample { alpha, beta, phi, alpha_rate, beta_rate, phi_rate, .. } = *sample;
    [(alpha, alpha_rate), (beta, beta_rate), (phi, phi_rate)]
}

/// The worst error of each angle and of each rate, the latter over the largest of the table.
fn errors(scene: &Scene, run: &Run) -> [(f64, f64); 3] {
    let table: Vec<Sample> = scene.samples.iter().map(Sample::<DoubleDouble>::rounded).collect();
    std::array::from_fn(|joint| {
        let scale = table.iter().map(|s| joints(s)[joint].1.abs()).fold(LEAST_RATE, f64::max);
        let error = |sample: &Sample| {
            let ((position, rate), expected) = (coordinate(run.at(sample.t), joint), joints(sample)[joint]);
            ((position - expected.0).abs(), (rate - expected.1).abs() / scale)
        };
        let worst = |(a, b): (f64, f64), (x, y): (f64, f64)| (a.max(x), b.max(y));
        table.iter().map(error).fold((0.0, 0.0), worst)
    })
}

fn check(page: &str, run: &Run) {
    let (_, name) =
        PAGES.into_iter().find(|(known, _)| *known == page).expect("the model file shows a scene");
    let errors = errors(&scene(name), run);
    println!("{page}: {errors:?}, violation {:.1e}", run.summary.position_violation);
    let rings = if name == "free-nutation" { RINGS_IN_FREE_NUTATION } else { RINGS };
    for ((position, rate), allowed) in errors.into_iter().zip([rings, rings, ROTOR]) {
        assert!(position <= allowed, "{page}: an angle is off by {position:e} rad: {errors:?}");
        assert!(rate <= RATES, "{page}: a rate is off by {rate:e} of its largest: {errors:?}");
    }
    let violation = run.summary.position_violation;
    assert!(violation <= VIOLATION, "{page}: violation {violation:e}");
}

fn check_engine(page: &str, mechanism: &Engine) {
    check(page, &simulate(mechanism, &model(page), &PAPER));
}

#[test]
fn generated_mechanisms_follow_the_table() {
    PAGES.iter().for_each(|(page, _)| check_engine(page, &generated(page)));
}

#[test]
fn the_careful_twin_follows_the_table() {
    for (page, _) in PAGES {
        check_engine(page, &careful(&model(page)));
    }
}

#[test]
fn the_dense_twin_follows_the_table() {
    // The paper's own 45 equations are slow: the folded form shows the algorithm as well.
    check_engine("gyroscope", &dense(&model("gyroscope")));
}

#[test]
fn every_tabulated_scene_is_shipped() {
    for scene in tabulated() {
        assert!(PAGES.iter().any(|(_, name)| *name == scene.name), "no model file shows {}", scene.name);
        assert_eq!(scene.samples.last().map(|s| s.t.to_f64()), Some(PAPER.t_end), "{}", scene.name);
    }
}

#[test]
fn another_scene_does_not_pass() {
    // The check must be able to fail: the paper's run is not in another scene's table.
    let model: Model = model("gyroscope");
    let run = simulate(&careful(&model), &model, &PAPER);
    let errors = errors(&scene("viscous-bearings"), &run);
    assert!(errors.iter().all(|(position, _)| *position > 1e-4), "{errors:?}");
}
