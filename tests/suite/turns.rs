//! Gears, driven shafts, differentials, planetary trains, racks and screws after ten thousand turns: a row is met when
//! it is as small as the rounding of what it subtracts, and an angle of 1e5 rad is known to 1e-11.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_jit::Native;
use gyro_model::Model;
use gyro_runner::motion::MotionBuilder;
use gyro_runner::{
    Approach, Correction, Grade, Integrator, Judgement, Offers, Sample, Settings, Start, balance,
};
use gyro_sim::{Real, Scalar};
use gyro_sim_suite::{
    Duals, Engine, PAPER, compiled, coordinate, dense, interpreted, judged, moved, page, start_of,
};
use std::f64::consts::TAU;

/// Turns before the run, and during it.
const BEFORE: f64 = 10_000.0;
const DURING: f64 = 100.0;

/// Steps a turn; a correction is due every so many, at fixed steps.
const STEPS: f64 = 30.0;
const STEPS_PER_CORRECTION: f64 = 3.0;

/// Of Baumgarte's stabilisation, parts of the speed.
const RATE: f64 = 2.0;

/// What turns may change of a motion, rad, m and their rates: at 1e5 rad an angle is known to 1.5e-11, which steps and
/// corrections add up to this in a hundred turns.
const TURNED: f64 = 1e-6;

/// What the engines may differ by, which are on other independent coordinates: truncation of the steps in ten turns, at
/// steps that are so many times finer. (At the others a wheel of the differential differs by 9e-3 rad.)
const ENGINES: f64 = 1e-4;
const FINER: f64 = 6.0;

/// The same in single precision, in which an angle of 1e5 rad is known to 0.008 rad.
const TURNED_F32: f64 = 0.3;

/// Motions that are so far apart, rad, m and their rates, are not both good.
const LOST: f64 = 1e-2;

/// What steps of more than a radian may change of a rate that nothing changes, parts of it.
const COARSE: f64 = 1e-2;

/// A model file, where it says at which angle it starts, and its speed there, rad/s.
struct Train {
    page: &'static str,
    start: &'static str,
    from: f64,
    speed: f64,
}

const TRAINS: [Train; 5] = [
    Train { page: "gear-pair", start: "angle = 0.1", from: 0.1, speed: 10.0 },
    Train { page: "driven-shaft", start: "from = 0.1", from: 0.1, speed: 31.4 },
    Train { page: "differential", start: "angle = 0.1", from: 0.1, speed: 40.0 },
    Train { page: "planetary", start: "angle = 0.1", from: 0.1, speed: 20.0 },
    Train { page: "rack-and-screw", start: "angle = 0.4", from: 0.4, speed: 15.0 },
];

impl Train {
    /// The model file as it is after so many turns.
    fn after(&self, turns: f64) -> Model {
        let text = page(self.page);
        assert!(text.contains(self.start), "{}", self.page);
        let key = self.start.split('=').next().unwrap();
        let mut turned = text.replacen(self.start, &format!("{key}= {}", self.angle(turns)), 1);
        if self.page == "rack-and-screw" {
            // The screw turns back as far as the spindle turns, so that the nut does not.
            let back = 1.25 * (self.from - self.angle(turns)) - 0.5;
            turned = turned.replacen("angle = -0.5", &format!("angle = {back}"), 1);
        }
        gyro_model::read(self.page, &turned).unwrap_or_else(|problems| panic!("{}: {problems:?}", self.page))
    }

    fn angle(&self, turns: f64) -> f64 {
        self.from + turns * TAU
    }

    fn settings(&self, turns: f64) -> Settings {
        let turn = TAU / self.speed;
        let step = turn / STEPS;
        let correct_every = Some(STEPS_PER_CORRECTION * step);
        Settings { t_end: turns * turn, step, correct_every, sample_every: turns * turn / 10.0 }
    }

    /// The generated mechanism in any precision, after so many turns.
    fn generated<T: Native + Real>(&self, turns: f64) -> (Engine<T>, Duals<T>) {
        let (mut mechanism, mut in_duals) = (compiled::<T>(self.page), interpreted(self.page));
        if self.page == "driven-shaft" {
            let from = self.angle(turns);
            assert!(
                mechanism.set_parameter(0, T::constant(from))
                    && in_duals.set_parameter(0, Scalar::constant(from))
            );
        }
        (Engine::new(mechanism), Duals::new(in_duals))
    }
}

/// Every correction with every integrator that holds it at steps of this length.
fn approaches(speed: f64) -> Vec<Approach> {
    let corrections = [
        Correction::Partition,
        Correction::MassWeighted,
        Correction::Baumgarte(RATE * speed),
        Correction::None,
    ];
    let integrators = [Integrator::Rk4, Integrator::Tsit5, Integrator::Dop853, Integrator::Rodas4];
    let of_both =
        |correction| integrators.map(|integrator| Approach { integrator, correction, ..Approach::default() });
    let is_offered = |approach: &Approach| Offers::ALL.refusal(&PAPER, approach).is_none();
    corrections.into_iter().flat_map(of_both).filter(is_offered).collect()
}

/// What a run has come to, or why it has not.
fn end<T: Real + 'static>(
    (engine, builder): (&Engine<T>, &dyn MotionBuilder<Engine<T>>),
    settings: &Settings,
    approach: &Approach,
    start: &Start,
) -> Result<Sample, String> {
    let (samples, outcome) = moved(engine, builder, (settings, approach), start);
    outcome.map_err(|failure| failure.to_string())?;
    Ok(samples.last().unwrap().clone())
}

/// Whether the command line would call a run good.
fn passes_for_good(
    (engine, builder): (&Engine, &dyn MotionBuilder<Engine>),
    by: (&Settings, &Approach),
    start: &Start,
) -> bool {
    let (samples, outcome) = moved(engine, builder, by, start);
    let Ok(summary) = outcome else { return false };
    let judgement = judged(engine, builder, by, start, (&samples, &summary)).expect("a companion");
    let (warned, Judgement { grade, reasons, .. }) = (balance(&summary, true), &judgement);
    println!("  warned of without a companion: {warned:?}; with one {grade:?}, {reasons:?}");
    judgement.grade == Grade::Good
}

/// The largest difference of all that two motions have come to, less what they differed by at their starts.
fn difference(ends: [&Sample; 2], starts: [&Start; 2]) -> f64 {
    let of = |k: usize| {
        let [(x, x_rate), (y, y_rate)] = ends.map(|end| coordinate(end, k));
        let moved = (x - starts[0].angles[k]) - (y - starts[1].angles[k]);
        moved.abs().max((x_rate - y_rate).abs())
    };
    (0..ends[0].coordinates.len()).map(of).fold(0.0, f64::max)
}

/// Runs a train from its first turn and after ten thousand, by each approach.
fn compare<T: Native + Real>(train: &Train, turns: f64, approaches: &[Approach], tolerance: f64) {
    let starts = [0.0, BEFORE].map(|before| start_of(&train.after(before)));
    let engines = [0.0, BEFORE].map(|before| train.generated::<T>(before));
    let kits = engines.each_ref().map(|(engine, duals)| engine.builder(duals.clone()));
    for approach in approaches {
        let said = format!("{} by {} with {}", train.page, approach.integrator, approach.correction);
        let end_of = |k: usize| {
            end((&engines[k].0, &*kits[k]), &train.settings(turns), approach, &starts[k])
                .unwrap_or_else(|failure| panic!("{said}: {failure}"))
        };
        // Where nothing is corrected errors of the steps grow: such a run must only arrive.
        let turned = end_of(1);
        let ends = [end_of(0), turned];
        let difference = difference([&ends[0], &ends[1]], [&starts[0], &starts[1]]);
        println!("{said}: {difference:e}");
        if !matches!(approach.correction, Correction::Partition | Correction::MassWeighted) {
            continue;
        }
        assert!(difference <= tolerance, "{said}: ten thousand turns make a difference of {difference:e}");
    }
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn ten_thousand_turns_make_no_difference() {
    for train in &TRAINS {
        compare::<f64>(train, DURING, &approaches(train.speed), TURNED);
    }
}

/// Steering lets a planetary train slip by 4e-2 at steps of RK4, and throws a rack on a screw about by hundreds: such
/// runs are not called good.
#[test]
fn what_steering_loses_is_told() {
    let mut n_lost = 0;
    for (train, integrator) in
        TRAINS[3..].iter().flat_map(|train| [(train, Integrator::Rk4), (train, Integrator::Tsit5)])
    {
        let correction = Correction::Baumgarte(RATE * train.speed);
        let approach = Approach { integrator, correction, ..Approach::default() };
        let settings = train.settings(DURING);
        let said = format!("{} by {integrator} with {correction}", train.page);
        let starts = [0.0, BEFORE].map(|before| start_of(&train.after(before)));
        let engines = [0.0, BEFORE].map(|before| train.generated::<f64>(before));
        let kits = engines.each_ref().map(|(engine, duals)| engine.builder(duals.clone()));
        let by = (&settings, &approach);
        let ends = [0, 1].map(|k| end((&engines[k].0, &*kits[k]), &settings, &approach, &starts[k]).unwrap());
        let difference = difference([&ends[0], &ends[1]], [&starts[0], &starts[1]]);
        let is_good = [0, 1].map(|k| passes_for_good((&engines[k].0, &*kits[k]), by, &starts[k]));
        println!("{said}: {difference:e}, called good: {is_good:?}");
        let is_lost = difference > LOST;
        n_lost += usize::from(is_lost);
        assert!(!(is_lost && is_good == [true; 2]), "{said}: {difference:e}, and both are called good");
    }
    assert!(n_lost > 0, "no run was lost");
}

/// RK4 loses 1.3e-3 rad of an angle at 1.2 rad a step, and nothing of the integral of its rate: they are half a turn
/// apart after 2400 steps.
#[test]
fn coarse_steps_lose_no_turn() {
    let train = &TRAINS[0];
    let model = train.after(0.0);
    let (start, step) = (start_of(&model), 1.2 / (1.7 * train.speed));
    let t_end = 6000.0 * step;
    let settings = Settings { t_end, step, correct_every: Some(step), sample_every: t_end };
    let (generated, duals) = train.generated::<f64>(0.0);
    let builder = generated.builder(duals);
    for correction in
        [Correction::Partition, Correction::MassWeighted, Correction::Baumgarte(RATE * train.speed)]
    {
        let approach = Approach { correction, ..Approach::default() };
        let end = end((&generated, &*builder), &settings, &approach, &start)
            .unwrap_or_else(|failure| panic!("{correction}: {failure}"));
        let off = |k: usize| (coordinate(&end, k).1 / [10.0, -17.0][k] - 1.0).abs();
        // Steering balances what such steps lose and is off by far more: it must only arrive.
        let is_steered = matches!(correction, Correction::Baumgarte(_));
        assert!(is_steered || off(0).max(off(1)) <= COARSE, "{correction}: {end:?}");
    }
}

#[test]
fn in_single_precision_they_make_as_much_as_an_angle_is_known() {
    for train in &TRAINS[..4] {
        let approaches: Vec<_> =
            approaches(train.speed).into_iter().filter(|a| a.correction == Correction::Partition).collect();
        compare::<f32>(train, 5.0, &approaches[..3], TURNED_F32);
    }
}

#[test]
fn the_twin_turns_on_too() {
    for train in &TRAINS {
        let model = train.after(BEFORE);
        let (start, approach) = (start_of(&model), Approach::default());
        let coarse = train.settings(10.0);
        let settings = Settings {
            step: coarse.step / FINER,
            correct_every: coarse.correct_every.map(|interval| interval / FINER),
            ..coarse
        };
        let engines = [dense(&model), train.generated(BEFORE).0];
        let ends = engines.map(|engine| {
            let builder = engine.builder(Duals::none());
            end((&engine, &*builder), &settings, &approach, &start).unwrap()
        });
        let difference = difference([&ends[0], &ends[1]], [&start, &start]);
        println!("{}: {difference:e}", train.page);
        assert!(difference <= ENGINES, "{}: the engines differ by {difference:e}", train.page);
    }
}
