//! Random studies against a loop over the runner that knows nothing of plans, blocks or lanes.

mod sensitive;

use super::{Job, Scenarios, Unit, answer, packs, whole};
use crate::record::{self, Block};
use crate::{Axis, Distribution, Draw, Keep, Keeper, Passage, Plan, Quantity, Sampling, Source, Target};
use gyro_mechanisms::gyroscope_misalignments::{GyroscopeMisalignments, Parameters};
use gyro_runner::motion::{InJoints, Only};
use gyro_runner::protocol::write;
use gyro_runner::{
    Approach, Coordinates, Correction, Event, Integrator, Sample, Settings, Start, describe_in, run_by,
};
use gyro_sim::integrate::Method;
use gyro_sim::lanes::f64x8;
use gyro_sim::{Control, Dop853, Error, Joint, JointSpace, Mechanism, Scalar, Solver, Tsit5};
use proptest::prelude::*;

const BUILDER: Only<InJoints> = Only { kind: InJoints, joint_space: true };

type Built = GyroscopeMisalignments<f64>;

fn built<T: Scalar>(values: &[T]) -> GyroscopeMisalignments<T> {
    let mut built = GyroscopeMisalignments::default();
    values.iter().enumerate().for_each(|(k, value)| assert!(built.set_parameter(k, *value)));
    built
}

fn nominal() -> Vec<f64> {
    let Parameters { offset_x, offset_y, offset_z, .. } = Parameters::<f64>::default();
    vec![offset_x, offset_y, offset_z, 0.0, 0.0, 0.0, 0.0]
}

/// The start of the mechanism itself: its rotor is where the joint is, so nothing of it depends on parameters in joint
/// coordinates; of a whole run the offset moves the rotor.
fn start(offset: [f64; 3]) -> Start {
    let state = GyroscopeMisalignments::<f64>::default().start();
    let mut positions = state[..21].to_vec();
    positions[14..17].copy_from_slice(&offset);
    let (velocities, turn_references) = (state[21..39].to_vec(), state[39..].to_vec());
    Start { positions, velocities, turn_references, angles: vec![0.0; 3], ..Start::default() }
}

/// What a program answers, block after block.
fn blocks(job: &Job, units: &[Unit], is_packed: bool) -> Vec<Block> {
    let mut input = Vec::new();
    write(&mut input, job).unwrap();
    units.iter().for_each(|unit| write(&mut input, unit).unwrap());
    let mut output = Vec::new();
    let check = |values: &[f64]| if values[0] > 0.0 { Ok(()) } else { Err("no".to_owned()) };
    let begin = |job| match is_packed {
        true => Scenarios::new(job, packs::begin(job, built::<f64>, built::<f64x8>, check)),
        false => Scenarios::new(job, whole::begin(job, whole::by(|values| (built::<f64>(values), BUILDER)))),
    };
    answer(begin, &mut &input[..], &mut output).unwrap();
    let (mut output, mut blocks) = (&output[..], Vec::new());
    let width = job.keep.width(job.times().len());
    while let Some(bytes) = record::next(&mut output).unwrap() {
        blocks.push(Block::decode(&bytes, width).unwrap());
    }
    blocks
}

/// One scenario by itself.
fn samples(job: &Job, parameters: &[f64]) -> Vec<Sample> {
    let mut samples = Vec::new();
    let tell = |event: Event<'_>| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    };
    let start = start([parameters[0], parameters[1], parameters[2]]);
    run_by(&mut built(parameters), &BUILDER, (&job.settings, &job.approach), &start, tell).unwrap();
    samples
}

/// What the study keeps of these samples, written down anew: the last α, the extremes of β, when α first rises above a
/// level, and all of α's rate.
fn kept(samples: &[Sample], level: f64) -> Vec<f64> {
    let of = |quantity: Quantity| samples.iter().map(move |sample| quantity.of(sample));
    let (alpha, beta): (Vec<f64>, Vec<f64>) =
        of(Quantity::Position(0)).zip(of(Quantity::Position(1))).unzip();
    let first = alpha.iter().position(|alpha| *alpha >= level);
    let passage = first.map_or(f64::NAN, |k| match k {
        0 => samples[0].t,
        _ => {
            let part = (level - alpha[k - 1]) / (alpha[k] - alpha[k - 1]);
            samples[k - 1].t + (samples[k].t - samples[k - 1].t) * part
        }
    });
    let smallest = beta.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = beta.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    [alpha[alpha.len() - 1], smallest, largest, passage].into_iter().chain(of(Quantity::Rate(0))).collect()
}

fn keep(level: f64) -> Keep {
    Keep {
        columns: vec![Quantity::Position(0), Quantity::Position(1), Quantity::Rate(0)],
        finals: vec![0],
        extremes: vec![1],
        passages: vec![Passage { column: 0, level, rises: true }],
        series: vec![2],
        ..Keep::default()
    }
}

fn plans() -> impl Strategy<Value = Plan> {
    let distribution = prop_oneof![
        (1e-6..1e-4f64).prop_map(|size| Distribution::Uniform([2e-4 - size, 2e-4 + size])),
        (1e-5..1e-4f64).prop_map(|from| Distribution::LogUniform([from, 3e-4])),
        (1e-6..1e-4f64).prop_map(|deviation| Distribution::Truncated([1e-4, deviation], [1e-5, 3e-4])),
    ];
    let sampling = prop_oneof![Just(Sampling::Random), Just(Sampling::Sobol), Just(Sampling::Saltelli)];
    (any::<u64>(), sampling, prop::collection::vec(distribution, 1..4), 0..3usize, 1..20u64).prop_map(
        |(seed, sampling, distributions, points, repeats)| {
            let n = distributions.len();
            let draws = distributions.into_iter().enumerate();
            let draws = draws.map(|(target, distribution)| Draw::Alone { target, distribution }).collect();
            let mut targets: Vec<Target> = (0..n).map(Target::Parameter).collect();
            let mut axes = Vec::new();
            if points > 0 && sampling != Sampling::Saltelli {
                targets.push(Target::Parameter(3));
                let rows = (0..points).map(|k| vec![1e-6 * k as f64]).collect();
                axes.push(Axis { targets: vec![n], rows });
            }
            Plan { seed, sampling, targets, axes, draws, repeats }
        },
    )
}

fn jobs() -> impl Strategy<Value = Job> {
    let run = prop_oneof![
        (1e-4..5e-4f64).prop_map(|step| (step, Integrator::Rk4, None)),
        (1e-9..1e-5f64).prop_map(|tolerance| (1e-3, Integrator::Dop853, Some(tolerance))),
        (1e-7..1e-4f64).prop_map(|tolerance| (1e-3, Integrator::Tsit5, Some(tolerance))),
    ];
    (plans(), run, 1..30u32, 2e-3..0.01f64, -1e-4..1e-3f64).prop_map(|(plan, run, block, every, level)| {
        let (step, integrator, tolerance) = run;
        let approach = Approach {
            integrator,
            tolerance,
            coordinates: Coordinates::Joint,
            correction: Correction::Partition,
            ..Approach::default()
        };
        Job {
            plan,
            keep: keep(level),
            settings: Settings { t_end: 0.02, step, correct_every: Some(5e-4), sample_every: every },
            approach,
            parameters: nominal(),
            start: start([0.000_125, 0.0, 0.0]),
            block,
            measure: None,
        }
    })
}

/// What rounding makes of angles of a tenth and rates of some: they are read off joint and off maximal states.
const ROUNDING: f64 = 1e-12;

fn is_near(found: f64, expected: f64) -> bool {
    found.is_nan() && expected.is_nan() || (found - expected).abs() <= ROUNDING * (1.0 + expected.abs())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn programs_answer_what_a_loop_computes(job in jobs(), order in any::<u64>()) {
        let mut source = Source::new(&job.plan);
        let mut values = vec![0.0; job.plan.targets.len()];
        let mut drawn = Vec::new();
        for k in 0..job.plan.scenarios() {
            source.write(k, &mut values);
            let mut parameters = nominal();
            job.plan.targets.iter().zip(&values).for_each(|(target, value)| {
                let Target::Parameter(index) = target else { panic!("{target:?}") };
                parameters[*index] = *value;
            });
            drawn.push(parameters);
        }
        let level = job.keep.passages[0].level;
        let expected: Vec<Vec<f64>> = drawn.iter().map(|p| kept(&samples(&job, p), level)).collect();
        // Blocks in any order, one or several at a time.
        let n = job.blocks();
        let turned: Vec<u64> = (0..n).map(|k| (k + order) % n).collect();
        let units = |starts: &dyn Fn(u64) -> Vec<Result<Start, String>>| -> Vec<Unit> {
            let chunks = turned.chunks(1 + (order >> 32) as usize % 3);
            let unit = |blocks: &[u64]| Unit {
                blocks: blocks.to_vec(),
                starts: blocks.iter().flat_map(|block| starts(*block)).collect(),
                ..Unit::default()
            };
            chunks.map(unit).collect()
        };
        let packed = blocks(&job, &units(&|_| Vec::new()), true);
        let starts = |block: u64| {
            let (first, count) = job.range(block);
            let of = |k: u64| start(<[f64; 3]>::try_from(&drawn[k as usize][..3]).unwrap());
            (first..first + u64::from(count)).map(|k| Ok(of(k))).collect()
        };
        let mut seen = 0;
        for (block, is_whole) in packed.iter().map(|b| (b, false))
            .chain(blocks(&job, &units(&starts), false).iter().map(|b| (b, true))) {
            for (k, numbers, error) in block.rows() {
                prop_assert_eq!(error, None);
                for (found, expected) in numbers.iter().zip(&expected[k as usize]) {
                    let is_same = found.to_bits() == expected.to_bits() || found.is_nan() && expected.is_nan();
                    // A passage divides by a difference: it is looked at only where the level is passed briskly.
                    prop_assert!(if is_whole { is_same } else { is_near(*found, *expected) }, "{} {}", found, expected);
                }
                seen += 1;
            }
        }
        prop_assert_eq!(seen, 2 * job.plan.scenarios());
    }
}

/// What a lane has to come to, by a solver of its own: numbers, and the error.
fn alone<A: Method<Joint, Built>>(job: &Job, method: A, built: &Built) -> (Vec<f64>, Option<Error>) {
    let times = job.times();
    let mut keeper = Keeper::new(&job.keep, times.len());
    let start = built.joint_start();
    let control = Control::default().with_tolerance(job.approach.tolerance.unwrap());
    let budget = job.approach.budget.unwrap_or(control.budget);
    let mut solver = Solver::new(Joint, method, 0.0, &start).with_control(Control { budget, ..control });
    let mut state = start;
    let mut take = |t: f64, x: &[f64]| {
        let mut values = [x[0], x[1], x[3]].into_iter();
        keeper.take(t, |_| values.next().unwrap());
    };
    take(0.0, &state);
    let mut run = || {
        for t in &times[1..] {
            while solver.time() < *t {
                solver.step_towards(built, job.settings.t_end)?;
            }
            solver.interpolate(built, *t, &mut state)?;
            take(*t, &state);
        }
        Ok(())
    };
    let outcome = run();
    let mut numbers = Vec::new();
    keeper.finish(outcome.is_ok(), &mut numbers);
    (numbers, outcome.err())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn lanes_have_the_bits_of_runs_alone(
        job in jobs(),
        tolerance in (-12.0..-3.0f64).prop_map(|power| 10f64.powf(power)),
        t_end in 0.0..0.04f64,
        budget in prop_oneof![Just(None), (1..60u64).prop_map(Some)],
        is_tsit5 in any::<bool>(),
    ) {
        let integrator = if is_tsit5 { Integrator::Tsit5 } else { Integrator::Dop853 };
        let approach = Approach { integrator, tolerance: Some(tolerance), budget, ..job.approach };
        let settings = Settings { t_end, sample_every: job.settings.sample_every / 3.0, ..job.settings };
        let job = Job { approach, settings, ..job };
        let units = [Unit { blocks: (0..job.blocks()).collect(), ..Unit::default() }];
        let mut source = Source::new(&job.plan);
        let mut values = vec![0.0; job.plan.targets.len()];
        let mut parameters = Vec::new();
        for (k, numbers, error) in blocks(&job, &units, true).iter().flat_map(Block::rows) {
            source.write(k, &mut values);
            job.write_parameters(&values, &mut parameters);
            let built = built::<f64>(&parameters);
            let start = built.joint_start();
            let (expected, failure) = match integrator {
                Integrator::Tsit5 => alone(&job, Tsit5::new(&start), &built),
                _ => alone(&job, Dop853::new(&start), &built),
            };
            let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            prop_assert_eq!(bits(numbers), bits(&expected), "scenario {}: {:?}", k, failure);
            let words = failure.map(|error| describe_in(&built, Some(built.joint_layout()), error));
            prop_assert_eq!(error, words.as_deref());
        }
    }
}

#[test]
fn what_cannot_be_is_a_row_with_its_error_and_disturbs_no_other() {
    let targets = vec![Target::Parameter(0)];
    let rows = (-4..20).map(|k| vec![1e-5 * f64::from(k)]).collect();
    let axes = vec![Axis { targets: vec![0], rows }];
    let plan = Plan { seed: 1, sampling: Sampling::Random, targets, axes, draws: Vec::new(), repeats: 1 };
    let settings = Settings { t_end: 0.01, step: 1e-3, correct_every: None, sample_every: 0.01 };
    let approach = Approach { coordinates: Coordinates::Joint, ..Approach::default() };
    let (parameters, start) = (nominal(), start([0.000_125, 0.0, 0.0]));
    let job = Job { plan, keep: keep(1.0), settings, approach, parameters, start, block: 24, measure: None };
    let all = blocks(&job, &[Unit { blocks: vec![0], ..Unit::default() }], true);
    assert_eq!(all[0].errors.len(), 5);
    for (k, numbers, error) in all[0].rows() {
        assert_eq!(error, (k < 5).then_some("no"));
        assert_eq!(numbers[0].is_nan(), k < 5);
    }
}

#[test]
fn starts_belong_to_their_scenarios() {
    let targets = vec![Target::Parameter(0)];
    let axes = vec![Axis { targets: vec![0], rows: (1..18).map(|k| vec![1e-5 * f64::from(k)]).collect() }];
    let plan = Plan { seed: 1, sampling: Sampling::Random, targets, axes, draws: Vec::new(), repeats: 1 };
    let settings = Settings { t_end: 0.0, step: 1e-3, correct_every: None, sample_every: 0.01 };
    let approach = Approach { coordinates: Coordinates::Joint, ..Approach::default() };
    let (parameters, start) = (nominal(), start([0.000_125, 0.0, 0.0]));
    let job = Job { plan, keep: keep(1.0), settings, approach, parameters, start, block: 5, measure: None };
    let starts = |blocks: &[u64]| {
        let all = blocks.iter().flat_map(|block| 5 * block..(5 * block + 5).min(17));
        all.map(|k| Err(format!("scenario {k}"))).collect()
    };
    let unit = |blocks: &[u64]| Unit { blocks: blocks.to_vec(), starts: starts(blocks), ..Unit::default() };
    let found = blocks(&job, &[unit(&[3, 1]), unit(&[0]), unit(&[2])], false);
    let rows: Vec<_> =
        found.iter().flat_map(Block::rows).map(|(k, _, error)| (k, error.map(str::to_owned))).collect();
    assert_eq!(rows.len(), 17);
    assert!(rows.iter().all(|(k, error)| *error == Some(format!("scenario {k}"))), "{rows:?}");
}

/// `cargo test --release -p gyro-sweep --lib speed -- --ignored --nocapture`: what lanes make of a run at 1e-6 over
/// 0.1 s, as a quotient of times that were measured in turns.
#[test]
#[ignore = "measures"]
#[allow(clippy::print_stdout, reason = "it is read by people")]
fn speed() {
    let draws = (0..3).map(|target| {
        let middle = nominal()[target];
        Draw::Alone { target, distribution: Distribution::Uniform([middle - 2e-5, middle + 2e-5]) }
    });
    let draws = draws.collect();
    let targets = (0..3).map(Target::Parameter).collect();
    let plan = Plan { seed: 1, sampling: Sampling::Random, targets, axes: Vec::new(), draws, repeats: 1024 };
    let settings = Settings { t_end: 0.1, step: 1e-3, correct_every: None, sample_every: 0.1 };
    let approach = Approach {
        integrator: Integrator::Dop853,
        tolerance: Some(1e-6),
        coordinates: Coordinates::Joint,
        ..Approach::default()
    };
    let (parameters, start) = (nominal(), start([0.000_125, 0.0, 0.0]));
    let job =
        Job { plan, keep: keep(1.0), settings, approach, parameters, start, block: 1024, measure: None };
    let unit = [Unit { blocks: vec![0], ..Unit::default() }];
    let mut source = Source::new(&job.plan);
    let (mut values, mut parameters) = (vec![0.0; 3], Vec::new());
    let mut scalar = || {
        for k in 0..1024 {
            source.write(k, &mut values);
            job.write_parameters(&values, &mut parameters);
            let built = built::<f64>(&parameters);
            alone(&job, Dop853::new(&built.joint_start()), &built);
        }
    };
    let time = |run: &mut dyn FnMut()| {
        let began = std::time::Instant::now();
        run();
        began.elapsed().as_secs_f64() / 1024.0
    };
    let mut best = [f64::INFINITY; 2];
    for _ in 0..40 {
        best[0] = best[0].min(time(&mut scalar));
        best[1] = best[1].min(time(&mut || drop(blocks(&job, &unit, true))));
    }
    let [scalar, lanes] = best.map(|seconds| seconds * 1e6);
    println!(
        "one after the other {scalar:.2} us, in lanes {lanes:.2} us: {:.2} times as fast",
        scalar / lanes
    );
}
