use super::*;

const MEASURE: Measure = Measure { tolerance: None, size: 1.0, is_balanced: true };

/// Two angles over a second: one of `amplitude`, the other a spin.
fn samples(amplitude: f64, frequency: f64, spin: f64) -> Vec<Sample> {
    let at = |k: i32| {
        let t = f64::from(k) / 50.0;
        let angle = |position, rate| JointSample::Angle { position, rate };
        let (sin, cos) = (frequency * t).sin_cos();
        Sample {
            t,
            coordinates: vec![angle(amplitude * sin, amplitude * frequency * cos), angle(spin * t, spin)],
            outputs: vec![],
            controlled: vec![],
            bodies: vec![],
            kinetic: 1.0,
            potential: 0.0,
            work: 0.0,
            position_violation: 0.0,
            velocity_violation: 0.0,
            norm_violation: 0.0,
            chart_switches: 0,
        }
    };
    (0..=50).map(at).collect()
}

fn graded(one: &[Sample], other: &[Sample], summary: &Summary) -> Judgement {
    judge((one, summary), (other, &Summary::default()), &MEASURE)
}

#[test]
fn errors_are_held_against_the_motion() {
    let truth = samples(1.6e-3, 20.0, 100.0);
    let fine = Summary::default();
    for (amplitude, frequency, spin, grade) in [
        (1.6e-3, 20.0, 100.0, Grade::Good),
        (1.6e-3 * 1.0005, 20.0, 100.0, Grade::Good),
        (1.6e-3 * 1.01, 20.0, 100.0, Grade::Usable),
        // A thousandth of a radian is the whole motion of the first angle.
        (1.6e-3, 30.0, 100.0, Grade::Worthless),
        (3484.0, 20.0, 100.0, Grade::Worthless),
        // The spin has lost its phase, and its rate is right.
        (1.6e-3, 20.0, 101.0, Grade::Usable),
        (1.6e-3, 20.0, 200.0, Grade::Worthless),
        (f64::NAN, 20.0, 100.0, Grade::Worthless),
    ] {
        let found = graded(&samples(amplitude, frequency, spin), &truth, &fine);
        assert_eq!(found.grade, grade, "{amplitude} {frequency} {spin}: {:?}", found.reasons);
    }
    let found = graded(&truth[..10], &truth, &fine);
    assert_eq!(found.grade, Grade::Worthless, "a run that is not complete");
}

#[test]
fn a_run_is_usable_until_it_is_lost() {
    let truth = samples(1.0, 5.0, 0.0);
    let mut run = truth.clone();
    for sample in &mut run[30..] {
        sample.coordinates[0] = JointSample::Angle { position: 7.0, rate: 0.0 };
    }
    let found = graded(&run, &truth, &Summary::default());
    assert_eq!((found.grade, found.until), (Grade::Worthless, truth[29].t));
}

#[test]
fn an_open_balance_and_open_joints_tell_without_a_companion() {
    let of = |energy_drift, position_violation| {
        let summary = Summary { energy_drift, position_violation, ..Summary::default() };
        balance(&summary, true).first().map(|reason| reason.grade())
    };
    assert_eq!(of(1e-6, 1e-9), None);
    assert_eq!(of(1e-2, 1e-9), Some(Grade::Usable));
    assert_eq!(of(1.0, 1e-9), Some(Grade::Worthless));
    assert_eq!(of(f64::NAN, 0.0), Some(Grade::Worthless));
    assert_eq!(of(0.0, 0.5), Some(Grade::Worthless));
    let open = Summary { energy_drift: 1.0, ..Summary::default() };
    assert!(balance(&open, false).is_empty(), "an input that changes a spring does work that nobody counts");
}

#[test]
fn free_bodies_are_judged_too() {
    let at = |x: f64, turn: f64| {
        let mut sample = samples(0.0, 0.0, 0.0).swap_remove(0);
        let (sin, cos) = (0.5 * turn).sin_cos();
        sample.coordinates.clear();
        sample.bodies = vec![BodySample { pose: [x, 0.0, 0.0, cos, sin, 0.0, 0.0], velocity: [0.0; 6] }];
        sample
    };
    let truth = [at(0.0, 0.0), at(1.0, 2.0)];
    let fine = Summary::default();
    assert_eq!(graded(&truth, &truth, &fine).grade, Grade::Good);
    assert_eq!(graded(&[at(0.0, 0.0), at(3.0, 2.0)], &truth, &fine).grade, Grade::Worthless);
    assert_eq!(graded(&[at(0.0, 0.0), at(1.0, 1.0)], &truth, &fine).grade, Grade::Worthless);
    assert_eq!(graded(&[at(0.0, 0.0), at(1.01, 2.0)], &truth, &fine).grade, Grade::Usable);
}

#[test]
fn no_small_motion_is_good_because_a_large_one_is() {
    let truth = samples(1e-5, 20.0, 100.0);
    let found = graded(&samples(2e-5, 20.0, 100.0), &truth, &Summary::default());
    assert!(found.grade > Grade::Good && found.relative > 0.5, "{found:?}");
}
