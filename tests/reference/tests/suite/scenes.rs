//! Every scene against values computed elsewhere, and against itself at another order and step.

use gyro_reference::{DoubleDouble, Gyroscope, Sample, Scene, Scheme, SolveError, tabulated};

/// What results rounded to `f64` are held to, relative; they are in fact good to the last bit.
const F64_RELATIVE: f64 = 1e-13;

/// What the full results are held to, relative: the tables give 22 digits, of which 20 or more hold.
const PRECISE_RELATIVE: f64 = 1e-20;

/// Below this size (rad, rad/s, J) a value counts as zero, and its error is taken relative to this instead. The
/// smallest tabulated value is 1e-5; what is smaller is exactly zero.
const ZERO: f64 = 1e-9;

/// How far two schemes may differ over a second, relative to 1 + |value|. Their rounding is worth 1e-27.
const SCHEMES_AGREE: f64 = 1e-24;

/// How far the energy may drift over a second, relative; rounding again.
const ENERGY_DRIFT: f64 = 1e-25;

const NAMES: [&str; 8] = ["t", "alpha", "beta", "phi", "alpha rate", "beta rate", "phi rate", "energy"];

fn times(scene: &Scene) -> Vec<f64> {
    scene.samples.iter().map(|sample| sample.t.to_f64()).collect()
}

fn solved(gyroscope: &Gyroscope, times: &[f64]) -> Vec<Sample<DoubleDouble>> {
    gyroscope.solve_precisely(times, &Scheme::default()).expect("the scenes are smooth")
}

fn relative_error(found: DoubleDouble, expected: DoubleDouble) -> f64 {
    (found - expected).to_f64().abs() / expected.to_f64().abs().max(ZERO)
}

/// The first value that is off by more than `tolerance`, in words.
fn mismatch(
    found: &[Sample<DoubleDouble>],
    expected: &[Sample<DoubleDouble>],
    tolerance: f64,
) -> Option<String> {
    assert_eq!(found.len(), expected.len());
    found.iter().zip(expected).find_map(|(found, expected)| {
        let errors = found.values().into_iter().zip(expected.values()).map(|(f, e)| relative_error(f, e));
        let (name, error) =
            NAMES.iter().zip(errors).find(|(_, error)| error.is_nan() || *error > tolerance)?;
        Some(format!("{name} at t = {} is off by {error:e}", expected.t.to_f64()))
    })
}

fn scene(name: &str) -> Scene {
    tabulated().into_iter().find(|scene| scene.name == name).expect("the table has this scene")
}

#[test]
fn constructors_are_the_tabulated_scenes() {
    let constructed = [
        ("paper", Gyroscope::paper()),
        ("radial-imbalance", Gyroscope::radial_imbalance()),
        ("free-nutation", Gyroscope::free_nutation()),
        ("viscous-bearings", Gyroscope::viscous_bearings()),
        ("combined-offsets", Gyroscope::combined_offsets()),
    ];
    assert_eq!(tabulated().len(), constructed.len());
    for (name, gyroscope) in constructed {
        assert_eq!(scene(name).gyroscope, gyroscope, "{name}");
    }
}

#[test]
fn full_results_meet_the_tables() {
    for scene in tabulated() {
        let found = solved(&scene.gyroscope, &times(&scene));
        assert_eq!(mismatch(&found, &scene.samples, PRECISE_RELATIVE), None, "{}", scene.name);
    }
}

#[test]
fn rounded_results_meet_the_tables() {
    for scene in tabulated() {
        for (found, expected) in scene.gyroscope.solve(&times(&scene)).iter().zip(&scene.samples) {
            for ((found, expected), name) in found.values().into_iter().zip(expected.values()).zip(NAMES) {
                let error = relative_error(DoubleDouble::new(found), expected);
                assert!(error <= F64_RELATIVE, "{}: {name} at {:?} off by {error:e}", scene.name, expected);
            }
        }
    }
}

#[test]
fn another_order_and_step_give_the_same_motion() {
    let other = Scheme { step: 0.004, columns: 12, tolerance: 1e-26 };
    for scene in tabulated() {
        let end = [1.0];
        let (usual, other) =
            (solved(&scene.gyroscope, &end)[0], scene.gyroscope.solve_precisely(&end, &other).unwrap()[0]);
        for ((a, b), name) in usual.values().into_iter().zip(other.values()).zip(NAMES) {
            let difference = (a - b).to_f64().abs() / (1.0 + a.to_f64().abs());
            assert!(difference < SCHEMES_AGREE, "{}: {name} differs by {difference:e}", scene.name);
        }
    }
}

#[test]
fn energy_is_kept_where_nothing_rubs() {
    for scene in tabulated().iter().filter(|scene| scene.name != "viscous-bearings") {
        let found = solved(&scene.gyroscope, &times(scene));
        for sample in &found {
            let drift = relative_error(sample.energy, found[0].energy);
            assert!(drift < ENERGY_DRIFT, "{} at {}: {drift:e}", scene.name, sample.t.to_f64());
        }
    }
}

#[test]
fn a_symmetric_imbalance_moves_no_ring() {
    let last = Gyroscope::radial_imbalance().solve(&[1.0])[0];
    assert_eq!([last.alpha, last.beta, last.alpha_rate, last.beta_rate], [0.0; 4]);
}

#[test]
fn every_acting_parameter_shows_when_wrong() {
    type Parameter = fn(&mut Gyroscope) -> &mut DoubleDouble;
    let acting: [(&str, Parameter); 12] = [
        ("rotor mass", |g| &mut g.mass[2]),
        ("outer ring y", |g| &mut g.inertia[0][1]),
        ("inner ring x", |g| &mut g.inertia[1][0]),
        ("inner ring y", |g| &mut g.inertia[1][1]),
        ("inner ring z", |g| &mut g.inertia[1][2]),
        ("rotor x", |g| &mut g.inertia[2][0]),
        ("rotor y", |g| &mut g.inertia[2][1]),
        ("rotor z", |g| &mut g.inertia[2][2]),
        ("s2' z", |g| &mut g.ring_offset[2]),
        ("s3' x", |g| &mut g.rotor_offset[0]),
        ("gravity y", |g| &mut g.gravity[1]),
        ("spin", |g| &mut g.start.spin),
    ];
    let scene = scene("combined-offsets");
    for (name, parameter) in acting {
        let mut wrong = scene.gyroscope;
        *parameter(&mut wrong) = *parameter(&mut wrong) * "1.0001".parse().unwrap();
        let found = solved(&wrong, &times(&scene)[..4]);
        assert_ne!(mismatch(&found, &scene.samples[..4], F64_RELATIVE), None, "{name}");
    }
}

#[test]
fn ring_masses_and_idle_inertias_do_not_act() {
    let gyroscope = Gyroscope::combined_offsets();
    let mut other = gyroscope;
    let heavy = DoubleDouble::new(7.0);
    (other.mass[0], other.mass[1], other.inertia[0][0], other.inertia[0][2]) = (heavy, heavy, heavy, heavy);
    assert_eq!(gyroscope.solve(&[0.1]), other.solve(&[0.1]));
}

#[test]
fn a_time_is_the_decimal_it_prints_as() {
    let sample = solved(&Gyroscope::paper(), &[0.1])[0];
    assert_eq!(sample.t, "0.1".parse().unwrap());
    assert_ne!(sample.t, DoubleDouble::new(0.1));
}

#[test]
fn times_that_do_not_ascend_from_zero_are_refused() {
    for (times, culprit) in [(&[-0.5][..], -0.5), (&[0.2, 0.1], 0.1), (&[f64::INFINITY], f64::INFINITY)] {
        let outcome = Gyroscope::paper().solve_precisely(times, &Scheme::default());
        assert_eq!(outcome, Err(SolveError::Time(culprit)), "{times:?}");
    }
}
