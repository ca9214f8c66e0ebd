use super::*;

fn segments(t_end: f64, step: f64, correct_every: Option<f64>, sample_every: f64) -> Vec<Segment> {
    Schedule::new(&Settings { t_end, step, correct_every, sample_every }).collect()
}

#[test]
fn the_paper_takes_five_steps_and_corrects_for_hours() {
    let settings = Settings { t_end: 7200.0, step: 1e-4, correct_every: Some(5e-4), sample_every: 1e-3 };
    let mut count = 0_u64;
    for segment in Schedule::new(&settings) {
        assert!(segment.n_steps == 5 && segment.corrects, "{segment:?}");
        count += 1;
        assert_eq!(segment.samples, count.is_multiple_of(2), "{segment:?}");
    }
    assert_eq!(count, 14_400_000);
}

#[test]
fn a_step_is_a_maximum_and_the_end_is_always_sampled() {
    let segments = segments(1.0, 0.4, Some(0.5), 0.3);
    let shown: Vec<_> = segments.iter().map(|s| (s.to, s.n_steps, s.corrects, s.samples)).collect();
    let thrice = 3.0 * 0.3;
    assert_eq!(
        shown,
        [
            (0.3, 1, false, true),
            (0.5, 1, true, false),
            (0.6, 1, false, true),
            (thrice, 1, false, true),
            (1.0, 1, true, true)
        ]
    );
}

#[test]
fn the_end_is_corrected_only_if_its_turn_has_come() {
    let last = *segments(1.0, 0.1, Some(0.4), 10.0).last().unwrap();
    assert!(last.samples && !last.corrects && last.to == 1.0 && last.n_steps == 2, "{last:?}");
}

#[test]
fn steps_are_counted() {
    for (step, sample_every, steps) in [(0.4, 0.3, 5.0), (1e-3, 0.1, 1000.0), (1e-9, 1e-7, 1e9 + 1e7 + 5.0)] {
        let settings = Settings { t_end: 1.0, step, correct_every: None, sample_every };
        let found = Schedule::steps(&settings);
        assert!(found >= steps - 5.0 && found <= steps + 5.0, "{found} for {steps}");
    }
}

#[test]
fn direct_integration_has_no_corrections() {
    let segments = segments(1.0, 0.1, None, 1.0);
    assert_eq!(segments, [Segment { from: 0.0, to: 1.0, n_steps: 10, corrects: false, samples: true }]);
}

#[test]
fn steps_longer_than_the_intervals_are_shortened() {
    let segments = segments(1.0, 5.0, Some(0.25), 0.5);
    assert!(segments.iter().all(|s| s.n_steps == 1 && s.corrects), "{segments:?}");
    assert_eq!(segments.len(), 4);
}

#[test]
fn segments_join_up_for_any_settings() {
    for (t_end, step, correct, sample) in
        [(0.7, 1e-3, 0.007, 0.03), (3.1, 0.017, 0.1, 0.3), (1e-3, 1e-4, 1e-9, 1e-4), (0.1, 1.0, 1.0, 1.0)]
    {
        let mut now = 0.0;
        for segment in segments(t_end, step, Some(correct), sample) {
            assert!(segment.from == now && segment.to > now, "{segment:?}");
            assert!((segment.to - segment.from) / segment.n_steps as f64 <= step * (1.0 + 2e-9));
            now = segment.to;
        }
        assert_eq!(now, t_end);
    }
}

#[test]
fn impossible_settings_are_named() {
    let good = Settings { t_end: 1.0, step: 1e-4, correct_every: Some(5e-4), sample_every: 1e-3 };
    assert_eq!(good.check(), Ok(()));
    for (settings, message) in [
        (Settings { step: -1.0, ..good }, "step is -1.0: a positive number of seconds was expected"),
        (Settings { t_end: f64::NAN, ..good }, "t_end is NaN: a positive number of seconds was expected"),
        (Settings { correct_every: Some(0.0), ..good }, "correct_every is 0.0: a positive number"),
        (
            Settings { correct_every: Some(1e50), ..good },
            "correct_every is 1e50: a positive number of seconds was expected, at most 1e15",
        ),
        (Settings { sample_every: 1e-9, ..good }, "the run would have 1.000e9 samples"),
        (Settings { step: 1e-300, ..good }, "the run would have 1.000e300 steps"),
    ] {
        let found = settings.check().unwrap_err().to_string();
        assert!(found.starts_with(message), "{found}");
    }
}
