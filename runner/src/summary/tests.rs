use super::*;
use crate::JointSample;

fn sample(kinetic: f64, potential: f64, work: f64) -> Sample {
    Sample {
        t: 0.0,
        coordinates: vec![],
        outputs: vec![],
        controlled: vec![],
        bodies: vec![],
        kinetic,
        potential,
        work,
        position_violation: kinetic * 1e-3,
        velocity_violation: 0.5,
        norm_violation: 0.0,
        chart_switches: 0,
    }
}

fn track(samples: &[Sample]) -> Summary {
    let (mut tracker, mut summary) = (Tracker::default(), Summary::default());
    samples.iter().for_each(|s| tracker.add(s, 1e-16));
    tracker.finish(&mut summary, 1e-9);
    summary
}

#[test]
fn what_hardly_moves_may_rest_as_well() {
    let moved = |kinetic: f64, rate: f64| {
        let mut moved = sample(kinetic, 5.0, 0.0);
        moved.coordinates = vec![JointSample::Angle { position: 0.0, rate }];
        let (mut tracker, mut summary) = (Tracker::default(), Summary::default());
        [sample(0.0, 5.0, 0.0), moved].iter().for_each(|s| tracker.add(s, 0.0));
        tracker.finish(&mut summary, 1e-9);
        summary.energy_drift
    };
    assert!((moved(5e-23, 1e-11) - 1e-4).abs() < 1e-12);
    assert_eq!(moved(5e-17, 1e-8), 1.0);
}

#[test]
fn the_drift_is_what_work_does_not_explain_over_the_energy_that_moves() {
    let summary = track(&[sample(0.0, 5.0, 0.0), sample(2.0, 3.5, -0.25), sample(0.0, 1.0, -4.0)]);
    // Errors 0, 0.75 and 0; scales 0, 2 and 4.
    assert_eq!(summary.energy_drift, 0.75 / 4.0);
    assert_eq!((summary.position_violation, summary.velocity_violation), (2e-3, 0.5));
}

#[test]
fn rounding_of_a_body_that_cannot_move_is_no_drift_and_more_is() {
    assert_eq!(track(&[sample(0.0, 5.0, 0.0), sample(1e-34, 5.0, 0.0)]).energy_drift, 0.0);
    assert_eq!(track(&[sample(0.0, 5.0, 0.0), sample(1e-6, 5.0, 0.0)]).energy_drift, 1.0);
}

#[test]
fn a_mechanism_at_rest_does_not_drift() {
    assert_eq!(track(&[sample(0.0, 5.0, 0.0), sample(0.0, 5.0, 0.0)]).energy_drift, 0.0);
}
