//! Verdicts on runs whose truth is known: a rotor under a torque that is a narrow pulse, and oscillators that are
//! looked at as often as they come back.

use super::*;
use crate::spinner::Spinner;
use crate::{
    Between, Difference, Grade, JointSample, Judgement, Measure, closely, companions, differences, judge,
};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

const T_END: f64 = 1.0;

fn followed(start: &Start, plan: (&Settings, &Approach)) -> Result<(Vec<Sample>, Summary), Failure> {
    let (mut samples, mut spinner) = (Vec::new(), Spinner::default());
    let summary = run_by(&mut spinner, &motion::Any, plan, start, |event| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    })?;
    Ok((samples, summary))
}

/// As the command line judges.
fn judged(start: &Start, plan: (&Settings, &Approach), run: &(Vec<Sample>, Summary)) -> Judgement {
    let measure = Measure { tolerance: plan.1.tolerance, size: 1.0, is_balanced: false };
    let mut all = companions(plan.0, plan.1).into_iter();
    let found = all
        .find_map(|(settings, approach)| followed(start, (&closely(&settings, &approach), &approach)).ok());
    let (others, other) = found.unwrap();
    judge((&run.0, &run.1), (&others, &other), &measure)
}

/// Angle and rate of a unit inertia under a table, at a time: by the rows' own quadrature.
fn truth(rows: &[[f64; 2]], between: Between, rate: f64, t: f64) -> [f64; 2] {
    let mut x = [0.0, rate];
    for pair in rows.windows(2) {
        let ([t0, u0], [t1, u1]) = (pair[0], pair[1]);
        let h = t1.min(t) - t0;
        if h <= 0.0 {
            break;
        }
        let slope = if between == Between::Held { 0.0 } else { (u1 - u0) / (t1 - t0) };
        x = [x[0] + h * (x[1] + h * (u0 / 2.0 + slope * h / 6.0)), x[1] + h * (u0 + slope * h / 2.0)];
    }
    x
}

#[test]
fn no_run_is_good_that_has_stepped_over_a_pulse() {
    let mut random = ChaCha8Rng::seed_from_u64(40);
    let (mut good, mut worse) = (0, 0);
    for case in 0..200 {
        let step = 10f64.powf(random.random_range(-3.0..-1.5));
        let width = step * 10f64.powf(random.random_range(-2.0..1.0));
        let from = random.random_range(0.0..0.9);
        let height = 10f64.powf(random.random_range(-5.0..0.5)) / width;
        let (edge, end) = (width / 8.0, from + width);
        let between = if random.random_bool(0.5) { Between::Held } else { Between::Linear };
        let small = random.random_range(0.0..1.0);
        let rows = vec![
            [0.0, small],
            [from, small],
            [from + edge, small + height],
            [end - edge, small + height],
            [end, small],
            [2.0, small],
        ];
        let rate = random.random_range(0.5..2.0);
        let spinner = Spinner { rate, ..Spinner::default() };
        let start = Start { inputs: vec![Input::new(0, rows.clone(), between)], ..spinner.initial() };
        let correct_every = random.random_bool(0.5).then_some(step);
        let sample_every = [T_END / 7.0, 0.1, 1.0][case % 3];
        let settings = Settings { t_end: T_END, step, correct_every, sample_every };
        let correction = if correct_every.is_some() { Correction::Partition } else { Correction::None };
        let approach = Approach { correction, ..Approach::default() };
        let run = followed(&start, (&settings, &approach)).unwrap();
        let judgement = judged(&start, (&settings, &approach), &run);
        let mut error: f64 = 0.0;
        for sample in &run.0 {
            let JointSample::Angle { position, rate: found } = sample.coordinates[0] else {
                panic!("an angle")
            };
            let [angle, expected] = truth(&rows, between, rate, sample.t);
            error = error.max((position - angle).abs()).max((found - expected).abs());
        }
        let words = format!("case {case}: off by {error:e}, {:?} {settings:?} {rows:?}", judgement.grade);
        assert!(judgement.grade != Grade::Good || error < 1e-2, "{words}");
        assert!(judgement.grade != Grade::Worthless || error > 1e-7, "{words}");
        *(if judgement.grade == Grade::Good { &mut good } else { &mut worse }) += 1;
    }
    assert!(good > 10 && worse > 50, "{good} {worse}");
}

/// A run of an oscillator, off by so much.
fn oscillating(omega: f64, phase: f64, off: f64, [t_end, every]: [f64; 2]) -> Vec<Sample> {
    let at = |t: f64| {
        let (sin, cos) = (omega * t + phase).sin_cos();
        let angle = JointSample::Angle { position: sin / omega + off * (7.0 * t).sin(), rate: cos + off };
        Sample { t, coordinates: vec![angle], kinetic: 1.0, ..Sample::default() }
    };
    let n = (t_end / every).round() as u32;
    (0..=n).map(|k| at(f64::from(k) * every)).collect()
}

#[test]
fn what_comes_back_at_each_sample_is_not_worthless() {
    let mut random = ChaCha8Rng::seed_from_u64(41);
    let fine = Summary::default();
    for case in 0..500 {
        let every = 10f64.powf(random.random_range(-2.0..1.0));
        let t_end = every * f64::from(random.random_range(1..400));
        // As often as there are samples, half as often, twice and so on, or anyhow.
        let times = if case % 3 == 0 {
            random.random_range(0.1..20.0)
        } else {
            f64::from(random.random_range(1..=12)) / f64::from(random.random_range(1..=4))
        };
        let omega = std::f64::consts::TAU * times / every;
        let phase = std::f64::consts::FRAC_PI_2 * f64::from(random.random_range(0..4));
        let off = 1e-8 / omega.max(1.0);
        let run = oscillating(omega, phase, off, [t_end, every]);
        let settings = Settings { t_end, step: every / 1000.0, correct_every: None, sample_every: every };
        for tolerance in [None, Some(1e-9)] {
            let approach = Approach { tolerance, ..Approach::default() };
            let close = closely(&settings, &approach);
            let other = oscillating(omega, phase, 0.0, [t_end, close.sample_every]);
            let measure = Measure { tolerance: None, size: 1.0, is_balanced: false };
            let judgement = judge((&run, &fine), (&other, &fine), &measure);
            let words = format!("case {case}: {times} periods a sample, {} samples", run.len());
            assert_eq!(judgement.grade, Grade::Good, "{words}: {judgement:?}");
            // All samples of the run are among those of the companion.
            let seen: Vec<Difference> = differences(&run, &oscillating(omega, phase, 0.0, [t_end, every]));
            assert!((judgement.errors[0].position - seen[0].position).abs() < 1e-10, "{words}");
        }
    }
}

#[test]
fn ends_by_an_event_are_compared_on_either_side_of_a_sample() {
    let mut random = ChaCha8Rng::seed_from_u64(42);
    let fine = Summary::default();
    let measure = Measure { tolerance: None, size: 1.0, is_balanced: false };
    for case in 0..500 {
        let every = random.random_range(0.05..0.2);
        let near = every * f64::from(random.random_range(2..9));
        let offs = [0; 2].map(|_| [-1e-9, 0.0, 1e-9, 1e-8][random.random_range(0..4)]);
        let ended = |off: f64, every: f64| {
            let end = near + off;
            let mut run = oscillating(3.0, 0.2, 0.0, [near + every, every]);
            run.retain(|sample| sample.t < end - 1e-12);
            run.push(Sample { t: end, ..oscillating(3.0, 0.2 + 3.0 * end, 0.0, [0.0, 1.0]).swap_remove(0) });
            run
        };
        let (run, other) = (ended(offs[0], every), ended(offs[1], every / 7.0));
        let judgement = judge((&run, &fine), (&other, &fine), &measure);
        assert_eq!(judgement.grade, Grade::Good, "case {case}: {offs:?} {judgement:?}");
        // An end that is somewhere else is another run.
        let early = ended(-0.5 * near, every);
        let judgement = judge((&early, &fine), (&other, &fine), &measure);
        assert_eq!(judgement.grade, Grade::Worthless, "case {case}: {judgement:?}");
    }
}
