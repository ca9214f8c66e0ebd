//! Derivatives against differences of runs that know nothing of dual numbers.

use super::*;
use crate::child::StartSlopes;
use crate::child::sensitive::{Sensitive, plain};
use crate::child::variational::Number;

/// What a program with sensitivities answers of one block.
fn sensitive(job: &Job, unit: &Unit, is_packed: bool) -> Block {
    let mut input = Vec::new();
    write(&mut input, job).unwrap();
    write(&mut input, unit).unwrap();
    let (mut output, one) = (Vec::new(), built::<f64>);
    let check = |values: &[f64]| if values[0] > 0.0 { Ok(()) } else { Err("no".to_owned()) };
    let mut input = &input[..];
    let duals = |values: &[Number]| built(values);
    let begin = |job| {
        if is_packed {
            let inner = packs::begin(plain(job), one, built::<f64x8>, check);
            return Scenarios::new(job, Sensitive::new(job, inner, one, duals));
        }
        let inner = whole::begin(plain(job), whole::by(|values: &[f64]| (built::<f64>(values), BUILDER)));
        Scenarios::new(job, Sensitive::new(job, inner, one, duals))
    };
    answer(begin, &mut input, &mut output).unwrap();
    let bytes = record::next(&mut &output[..]).unwrap().unwrap();
    Block::decode(&bytes, job.keep.width(job.times().len())).unwrap()
}

/// The numbers of scenarios with these values of the targets.
fn numbers(job: &Job, rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let axes = vec![Axis { targets: (0..job.plan.targets.len()).collect(), rows }];
    let plan = Plan { axes, draws: Vec::new(), sampling: Sampling::Random, repeats: 1, ..job.plan.clone() };
    let keep = Keep { by: Vec::new(), ..job.keep.clone() };
    let job = Job { plan, keep, block: 1 << 16, ..job.clone() };
    let unit = Unit { blocks: vec![0], ..Unit::default() };
    let all = blocks(&job, &[unit], true);
    all[0].rows().map(|(_, numbers, _)| numbers.to_vec()).collect()
}

/// At which samples the extremes of β are, and the first of α beyond its level: of the series of all columns.
fn samples_of(job: &Job, row: &[f64]) -> [usize; 3] {
    let series = &row[job.keep.numbers()..];
    let level = job.keep.passages[0].level;
    let column = |k: usize| series.iter().skip(k).step_by(3).copied();
    let first = |is: &dyn Fn(f64) -> bool, k| column(k).position(is).unwrap_or(usize::MAX);
    let ends = [f64::min, f64::max].map(|end| column(1).reduce(end).unwrap());
    [first(&|x| x == ends[0], 1), first(&|x| x == ends[1], 1), first(&|x| x >= level, 0)]
}

/// The distance of differences, in parts of a target's scale.
const APART: f64 = 2e-3;

/// The derivative of a number, times the scale, from runs at −2, −1, 1 and 2 times h; NaN where there is no number.
/// None where the differences of the inner and the outer two differ: over a scale that is far beyond the others'
/// nothing is a line.
fn judged_slope(near: &[Vec<f64>], number: usize, h: f64, scale: f64) -> Option<f64> {
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| near[k][number]);
    let [inner, outer] = [(c - b) / (2.0 * h), (d - a) / (4.0 * h)].map(|slope| slope * scale);
    let slope = (4.0 * inner - outer) / 3.0;
    (slope.is_nan() || (inner - outer).abs() < 1e-7 + 1e-3 * slope.abs()).then_some(slope)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    #[test]
    fn derivatives_are_those_of_differences(
        job in jobs(),
        is_tsit5 in any::<bool>(),
        is_fixed in any::<bool>(),
        starts in prop_oneof![Just(vec![]), Just(vec![Target::Start(0, 0)]), Just(vec![
            Target::StartRate(0, 1), Target::Start(0, 1), Target::StartRate(0, 0)
        ])],
        parts in (0.0..0.3f64, 0.0..0.3f64, 0.0..0.3f64),
    ) {
        let integrator = match (is_fixed, is_tsit5) {
            (true, _) => Integrator::Rk4,
            (_, true) => Integrator::Tsit5,
            _ => Integrator::Dop853,
        };
        let tolerance = (!is_fixed).then_some(1e-12);
        let approach = Approach { integrator, tolerance, ..job.approach };
        let settings = Settings { step: 5e-5, t_end: 0.01, ..job.settings };
        let mut job = Job { approach, settings, ..job };
        // Two passages and extremes of other quantities than last values.
        job.keep.finals = vec![0, 2];
        job.keep.series = vec![0, 1, 2];
        job.keep.sloped = vec![2, 0];
        for (target, part) in starts.iter().zip([parts.0, parts.1, parts.2]) {
            let index = job.plan.targets.len();
            job.plan.targets.push(target.clone());
            job.plan.axes.push(Axis { targets: vec![index], rows: vec![vec![0.1 + part]] });
        }
        let n = job.plan.targets.len();
        job.keep.by = (0..n).collect();
        job.block = 3;
        let unit = Unit { blocks: vec![0], ..Unit::default() };
        let packed = sensitive(&job, &unit, true);
        let mut source = Source::new(&job.plan);
        let mut values = vec![0.0; n];
        let mut judged = 0;
        let samples = job.times().len();
        for (k, row, error) in packed.rows() {
            prop_assert_eq!(error, None);
            source.write(k, &mut values);
            let count = job.keep.numbers();
            let plain = numbers(&job, vec![values.clone()]);
            let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(&row[..count]), bits(&plain[0][..count]));
            let [_, series_slopes, series] = job.keep.apart(row, samples);
            prop_assert_eq!(bits(series), bits(&plain[0][count..]));
            for target in 0..n {
                let scale = job.plan.scale(target);
                let h = APART * scale;
                let shifted = |parts: f64| {
                    let mut values = values.clone();
                    values[target] += parts * h;
                    values
                };
                let near = numbers(&job, [-2.0, -1.0, 1.0, 2.0].map(shifted).to_vec());
                for (place, found) in series_slopes.iter().skip(target).step_by(n).enumerate() {
                    let (sample, column) = (place / 2, job.keep.sloped[place % 2]);
                    let Some(expected) = judged_slope(&near, count + 3 * sample + column, h, scale) else {
                        continue;
                    };
                    let found = found * scale;
                    prop_assert!(
                        (found - expected).abs() < 2e-7 * (1.0 + expected.abs()),
                        "scenario {}, sample {}, column {}, target {}: {} {}",
                        k, sample, column, target, found, expected
                    );
                }
                // Where an extreme or a passage moves on to another sample it has a kink.
                let is_kinked = near.iter().any(|row| samples_of(&job, row) != samples_of(&job, &plain[0]));
                for number in 0..count {
                    let Some(expected) = judged_slope(&near, number, h, scale) else { continue };
                    let found = row[count + number * n + target] * scale;
                    if is_kinked || expected.is_nan() {
                        prop_assert!(is_kinked || found.is_nan());
                        continue;
                    }
                    judged += 1;
                    prop_assert!(
                        (found - expected).abs() < 2e-7 * (1.0 + expected.abs()),
                        "scenario {}, number {}, target {}: {} {}", k, number, target, found, expected
                    );
                }
            }
        }
        prop_assert!(judged > 0 || packed.count == 1, "{} derivatives were judged", judged);
    }
}

/// Of whole runs the start is assembled: its derivatives come with it.
#[test]
fn whole_runs_have_the_derivatives_of_packs() {
    let targets = vec![
        Target::Parameter(0),
        Target::Parameter(4),
        Target::Parameter(2),
        Target::Parameter(6),
        Target::Parameter(1),
    ];
    let rows = vec![vec![2e-4, 1e-6, 3e-5, -1e-6, 1e-5], vec![1e-4, -1e-6, 2e-5, 1e-6, -4e-5]];
    let axes = vec![Axis { targets: (0..5).collect(), rows: rows.clone() }];
    let plan = Plan { seed: 1, sampling: Sampling::Random, targets, axes, draws: Vec::new(), repeats: 1 };
    let settings = Settings { t_end: 0.02, step: 1e-3, correct_every: None, sample_every: 5e-3 };
    let approach = Approach {
        coordinates: Coordinates::Joint,
        integrator: Integrator::Dop853,
        tolerance: Some(1e-11),
        ..Approach::default()
    };
    let keep = Keep { by: (0..5).collect(), series: Vec::new(), ..keep(1e-5) };
    let (parameters, start) = (nominal(), start([0.000_125, 0.0, 0.0]));
    let job = Job { plan, keep, settings, approach, parameters, start, block: 2, measure: None };
    let packed = sensitive(&job, &Unit { blocks: vec![0], ..Unit::default() }, true);
    let of_row = |row: &Vec<f64>| super::start([row[0], row[4], row[2]]);
    let own = {
        let Start { positions, velocities, turn_references, .. } = of_row(&rows[0]);
        positions.len() + velocities.len() + turn_references.len()
    };
    let mut slopes = vec![0.0; 5 * own];
    for (direction, place) in [(0, 14), (4, 15), (2, 16)] {
        slopes[direction * own + place] = job.plan.scale(direction);
    }
    let unit = Unit {
        blocks: vec![0],
        starts: rows.iter().map(|row| Ok(of_row(row))).collect(),
        slopes: vec![StartSlopes::Of(slopes); 2],
        ..Unit::default()
    };
    let whole = sensitive(&job, &unit, false);
    let nearby = StartSlopes::Impossible("no start\nnearby".to_owned());
    let slopes = vec![nearby, unit.slopes[1].clone()];
    let without = sensitive(&job, &Unit { slopes, ..unit.clone() }, false);
    assert!(packed.errors.is_empty() && whole.errors.is_empty(), "{packed:?} {whole:?}");
    let n = job.keep.numbers();
    for ((_, one, _), (_, other, _)) in packed.rows().zip(whole.rows()) {
        for (place, (one, other)) in one.iter().zip(other).enumerate() {
            let scale = if place < n { 1.0 } else { job.plan.scale((place - n) % 5) };
            let distance = (one - other) * scale;
            assert!(one.is_nan() && other.is_nan() || distance.abs() < 1e-9, "{place}: {one} {other}");
        }
    }
    // Without derivatives of its start a scenario keeps its numbers; the next one is as it was.
    assert_eq!(without.errors, [(0, "its sensitivities: no start nearby".to_owned())]);
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    let [(_, one, _), (_, next, _)] = without.rows().collect::<Vec<_>>()[..] else { panic!("two scenarios") };
    let (all, width) = (&whole.numbers, one.len());
    assert_eq!(bits(&one[..n]), bits(&all[..n]));
    assert!(one[n..].iter().all(|slope| slope.is_nan()));
    assert_eq!(bits(next), bits(&all[width..]));
}

/// A scenario of which only the derivatives fail is a row with an error that says so, and keeps its numbers: here those
/// of the first, which are computed in units of the largest start and so are beyond all numbers.
#[test]
fn derivatives_that_fail_are_named() {
    let axes = vec![Axis { targets: vec![0], rows: vec![vec![0.1], vec![1.7e308]] }];
    let targets = vec![Target::StartRate(0, 0)];
    let plan = Plan { seed: 1, sampling: Sampling::Random, targets, axes, draws: Vec::new(), repeats: 1 };
    let settings = Settings { t_end: 0.05, step: 1e-3, correct_every: None, sample_every: 0.05 };
    for integrator in [Integrator::Rk4, Integrator::Tsit5, Integrator::Dop853] {
        let tolerance = (integrator != Integrator::Rk4).then_some(1e-9);
        let approach =
            Approach { coordinates: Coordinates::Joint, integrator, tolerance, ..Approach::default() };
        let keep = Keep { by: vec![0], ..keep(1.0) };
        let (parameters, start) = (nominal(), start([0.000_125, 0.0, 0.0]));
        let plan = plan.clone();
        let job = Job { plan, keep, settings, approach, parameters, start, block: 2, measure: None };
        let found = sensitive(&job, &Unit { blocks: vec![0], ..Unit::default() }, true);
        let [(_, kept, error), (_, failed, other)] = found.rows().collect::<Vec<_>>()[..] else {
            panic!("{found:?}")
        };
        assert!(error.is_some_and(|words| words.starts_with("its sensitivities: at t = ")), "{error:?}");
        assert!(other.is_some_and(|words| words.starts_with("at t = ")), "{other:?}");
        let (numbers, all) = (job.keep.numbers(), job.keep.numbers() + job.keep.slopes());
        let plain = self::numbers(&job, vec![vec![0.1]]);
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&kept[..numbers]), bits(&plain[0][..numbers]));
        assert!(kept[numbers..all].iter().chain(&failed[..all]).all(|x| x.is_nan()), "{found:?}");
    }
}
