mod inputs;
mod judged;

use super::*;
use crate::JointSample;
use crate::spinner::Spinner;

fn samples(rate: f64, settings: &Settings) -> (Vec<Sample>, Summary) {
    let spinner = Spinner { rate, ..Spinner::default() };
    samples_of(spinner.initial(), spinner, settings)
}

fn samples_of(start: Start, mut spinner: Spinner, settings: &Settings) -> (Vec<Sample>, Summary) {
    let mut samples = Vec::new();
    let summary = run(&mut spinner, settings, &start, |event| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    });
    (samples, summary.unwrap())
}

/// RK4's error over the run is far larger than this for coarse steps; whole turns are 2π.
const WITHIN: f64 = 1e-2;

#[test]
fn turns_are_counted_between_sparse_samples() {
    for (rate, step) in [(100.0, 1e-4), (-100.0, 1e-3), (1e5, 1e-6)] {
        for correct_every in [None, Some(5.0 * step)] {
            let settings = Settings { t_end: 1000.0 * step, step, correct_every, sample_every: 1.0 };
            let (samples, summary) = samples(rate, &settings);
            let JointSample::Angle { position, .. } = samples.last().unwrap().coordinates[0] else {
                panic!("an angle was expected")
            };
            let expected = rate * settings.t_end;
            assert!((position - expected).abs() < WITHIN, "{position} for {expected}");
            assert_eq!((samples.len(), summary.steps), (2, 1000));
        }
    }
}

#[test]
fn corrections_keep_the_constraints_that_integration_loses() {
    let settings = Settings { t_end: 1.0, step: 1e-3, correct_every: None, sample_every: 0.1 };
    let (direct, _) = samples(100.0, &settings);
    let corrected = samples(100.0, &Settings { correct_every: Some(1e-2), ..settings });
    assert_eq!(direct.len(), 11);
    assert_eq!(direct.last().unwrap().t, 1.0);
    assert!(corrected.1.position_violation < 1e-15);
    assert!(corrected.1.chart_switches > 10, "{:?}", corrected.1);
}

#[test]
fn inputs_are_set_before_every_step_and_every_sample() {
    let ramp = Input::new(0, vec![[0.0, 0.0], [1.0, 2.0]], crate::Between::Linear);
    let start = Start { inputs: vec![ramp], ..Spinner::default().initial() };
    for correct_every in [None, Some(0.2)] {
        let settings = Settings { t_end: 2.0, step: 0.05, correct_every, sample_every: 1.0 };
        let (samples, _) = samples_of(start.clone(), Spinner::default(), &settings);
        let outputs: Vec<f64> = samples.iter().map(|s| s.outputs[0]).collect();
        assert_eq!(outputs, [0.0, 2.0, 2.0]);
        let rate = |sample: &Sample| sample.bodies[0].velocity[3];
        // Held over each of the ramp's 20 steps: Σ 2 k/20 · 1/20 = 19/20.
        assert!((rate(&samples[1]) - 0.95).abs() < 1e-12, "{}", rate(&samples[1]));
        assert!((rate(&samples[2]) - 2.95).abs() < 1e-12, "{}", rate(&samples[2]));
    }
}

#[test]
fn turn_references_are_the_last_elements_of_the_state() {
    let start = Start { turn_references: vec![7.0], ..Spinner::default().initial() };
    let failure = state(&Spinner::<f64>::default(), &start).unwrap_err().to_string();
    assert!(failure.contains("1 states and turn references") && failure.contains("13 elements"), "{failure}");
}

#[test]
fn a_run_that_blows_up_says_where() {
    let mut spinner = Spinner { rate: f64::MAX, ..Spinner::default() };
    let start = spinner.initial();
    let settings = Settings { t_end: 1.0, step: 0.1, correct_every: None, sample_every: 0.1 };
    let failure = run(&mut spinner, &settings, &start, |_| Ok(())).unwrap_err().to_string();
    assert!(failure.contains("orientation of body `rotor` is no longer finite"), "{failure}");
}

#[test]
fn a_start_of_another_mechanism_is_refused() {
    let settings = Settings { t_end: 1.0, step: 0.1, correct_every: None, sample_every: 0.1 };
    let failure = run(&mut Spinner::<f64>::default(), &settings, &Start::default(), |_| Ok(())).unwrap_err();
    assert!(failure.to_string().starts_with("the start has 0 positions"), "{failure}");
}
