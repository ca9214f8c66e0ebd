//! Every extreme scene, integrator, correction and tolerance: the right answer, or an error that says what, where and when.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use crate::estimate::{Deviation, deviations, estimate, expected};
use gyro_reference::JointRow;
use gyro_runner::motion::Kit;
use gyro_runner::{
    Approach, Coordinates, Correction, Failure, Integrator, Sample, Settings, Start, Summary, differences,
};
use gyro_sim::Real;
use gyro_sim_suite::{Engine, duals, extreme, model, moved, start_of};
use std::collections::{BTreeMap, HashMap};

/// Samples of a run.
const SAMPLES: f64 = 10.0;

/// A page, how far to follow it and in which steps, s, where they are fixed.
struct Scene {
    page: &'static str,
    t_end: f64,
    step: f64,
}

/// A few periods of the fastest motion; 500 to 4000 steps.
const SCENES: [Scene; 13] = [
    Scene { page: "gyroscope", t_end: 0.1, step: 5e-5 },
    Scene { page: "gyroscope-fast", t_end: 2e-4, step: 1e-7 },
    Scene { page: "gyroscope-at-rest", t_end: 1.0, step: 5e-4 },
    Scene { page: "gyroscope-light-rings", t_end: 0.1, step: 5e-5 },
    Scene { page: "gyroscope-heavy-rotor", t_end: 0.1, step: 5e-5 },
    Scene { page: "gyroscope-gimbal-lock", t_end: 0.5, step: 2.5e-4 },
    Scene { page: "gyroscope-stiff", t_end: 2e-3, step: 1e-6 },
    Scene { page: "gyroscope-overdamped", t_end: 2e-4, step: 1e-7 },
    Scene { page: "gyroscope-coulomb", t_end: 0.02, step: 1e-5 },
    Scene { page: "gyroscope-rolling-base", t_end: 0.05, step: 2.5e-5 },
    Scene { page: "gyroscope-long", t_end: 0.1, step: 5e-5 },
    Scene { page: "four-bar", t_end: 0.1, step: 1e-4 },
    Scene { page: "four-bar-in-line", t_end: 0.5, step: 1e-3 },
];

/// How far off a result may be in units of the tolerance.
const TIMES: f64 = 10.0;

/// Steps after which a run is given up, of explicit methods and of Rodas.
const BUDGET: u64 = 3000;
const IMPLICIT_BUDGET: u64 = 200;

/// Of Baumgarte's stabilisation, 1/s.
const RATE: f64 = 100.0;

/// Rodas, explicit methods under error control.
const CONTROLLED: [Integrator; 3] = [Integrator::Tsit5, Integrator::Dop853, Integrator::Rodas4];

const CORRECTIONS: [Correction; 5] = [
    Correction::Partition,
    Correction::ClosedForm,
    Correction::MassWeighted,
    Correction::Baumgarte(RATE),
    Correction::None,
];

/// Coordinates and corrections that a mechanism has.
fn keepings(is_tree: bool) -> Vec<(Coordinates, Correction)> {
    let maximal = CORRECTIONS.iter().filter(|c| is_tree || **c != Correction::ClosedForm);
    let mut keepings: Vec<_> = maximal.map(|c| (Coordinates::Maximal, *c)).collect();
    keepings.extend(is_tree.then_some((Coordinates::Joint, Correction::default())));
    keepings
}

impl Scene {
    fn settings(&self, times: f64) -> Settings {
        let step = times * self.step;
        let (t_end, sample_every) = (self.t_end, self.t_end / SAMPLES);
        Settings { t_end, step, correct_every: Some(5.0 * step), sample_every }
    }
}

/// A mechanism in one precision, and the double-precision runs that it is compared with.
struct Stand<T> {
    engine: Engine<T>,
    kit: Box<dyn Kit<Engine<T>>>,
    start: Start,
}

impl<T: Real + 'static> Stand<T> {
    fn new(page: &str, start: &Start) -> Self {
        let engine = extreme::<T>(page);
        let kit = engine.kit(duals(page));
        Self { engine, kit, start: start.clone() }
    }

    fn run(&self, settings: &Settings, approach: &Approach) -> (Vec<Sample>, Result<Summary, Failure>) {
        let began = std::time::Instant::now();
        let outcome = moved(&self.engine, &*self.kit, (settings, approach), &self.start);
        let took = began.elapsed().as_secs_f64();
        if took > 0.3 {
            println!(
                "SLOW {took:.2} s {approach} {:?}",
                outcome.1.as_ref().map(|s| s.steps).map_err(|e| e.to_string())
            );
        }
        outcome
    }
}

/// How runs have ended.
#[derive(Default)]
struct Tally {
    right: u32,
    huge: u32,
    flagged: Vec<String>,
    errors: BTreeMap<&'static str, u32>,
    wrong: Vec<String>,
}

/// One scene with its reference and companions.
struct Judge<'a> {
    scene: &'a Scene,
    rows: Vec<JointRow>,
    double: Stand<f64>,
    companions: HashMap<String, Option<Vec<Sample>>>,
    tally: &'a mut Tally,
}

/// What an error may say after its time, and whether a joint or a body has to be named.
const REASONS: [(&str, bool); 8] = [
    ("is no longer finite", true),
    ("would need steps as short as", true),
    ("cannot be met: ", true),
    ("can be met only by a change", true),
    ("cannot be solved for", false),
    ("the budget of", false),
    ("is stiff for this method", false),
    ("a tolerance of", false),
];

/// The reason of an error that says what, where and when.
fn reason(words: &str, t_end: f64) -> Option<&'static str> {
    let (reason, is_somewhere) = REASONS.into_iter().find(|(reason, _)| words.contains(reason))?;
    if words.starts_with("a tolerance of") {
        return Some(reason);
    }
    let t: f64 = words.strip_prefix("at t = ")?.split(' ').next()?.parse().ok()?;
    let is_named = [" joint `", " body `", "joint's turns"].iter().any(|name| words.contains(name));
    (t >= 0.0 && t <= t_end * 1.001 && (is_named || !is_somewhere)).then_some(reason)
}

fn worst(deviations: &[Vec<Deviation>; 2], allowed: impl Fn(usize, usize, f64) -> f64) -> f64 {
    let of =
        |kind: usize| deviations[kind].iter().enumerate().map(move |(k, deviation)| (kind, k, *deviation));
    let ratios = (0..2).flat_map(of).map(|(kind, k, d)| d.error / allowed(kind, k, d.size));
    ratios.fold(0.0, |worst: f64, ratio| if ratio <= worst || worst.is_nan() { worst } else { ratio })
}

impl<'a> Judge<'a> {
    fn new(scene: &'a Scene, tally: &'a mut Tally) -> Self {
        let start = start_of(&model(scene.page));
        let rows = expected(scene.page, &scene.settings(1.0));
        Self { scene, rows, double: Stand::new(scene.page, &start), companions: HashMap::new(), tally }
    }

    fn estimate(&mut self, samples: &[Sample], settings: &Settings, approach: &Approach) -> Option<Vec<f64>> {
        let (double, companions) = (&self.double, &mut self.companions);
        estimate(samples, settings, approach, |settings, approach| {
            let known = companions.entry(format!("{settings:?} {approach:?}"));
            let run = || {
                let (samples, outcome) = double.run(settings, approach);
                outcome.is_ok().then_some(samples)
            };
            known.or_insert_with(run).clone()
        })
    }

    /// An error, or what is within what is allowed of each position and rate, or what the estimate says is not.
    fn judge(
        &mut self,
        what: &str,
        (settings, approach): (&Settings, &Approach),
        (samples, outcome): (Vec<Sample>, Result<Summary, Failure>),
        allowed: impl Fn(usize, usize, f64) -> f64,
    ) {
        let what = format!("{}, {what}{approach}", self.scene.page);
        if let Err(failure) = outcome {
            let words = failure.to_string();
            match reason(&words, settings.t_end) {
                Some(reason) => *self.tally.errors.entry(reason).or_default() += 1,
                None => self.tally.wrong.push(format!("{what}: {words}")),
            }
            return;
        }
        let deviations = deviations(&samples, &self.rows);
        let ratio = worst(&deviations, &allowed);
        if ratio <= 1.0 && samples.len() == self.rows.len() {
            self.tally.right += 1;
            return;
        }
        let estimates = self.estimate(&samples, settings, approach).unwrap_or_default();
        let said = estimates.iter().zip(&deviations[0]).enumerate();
        let said = said.map(|(k, (e, d))| e / allowed(0, k, d.size)).fold(0.0, f64::max);
        let words = format!("{what}: {ratio:.2} times what is allowed, the estimate is {said:.2} times");
        if said > 1.0 {
            self.tally.flagged.push(words)
        } else {
            self.tally.wrong.push({
                let errors =
                    deviations.concat().iter().map(|d| format!("{:.1e}", d.error)).collect::<Vec<_>>();
                let estimates = estimates.iter().map(|e| format!("{e:.1e}")).collect::<Vec<_>>();
                format!("{words}; {errors:?} {estimates:?}")
            });
        }
    }

    /// A step far too large ends in an error or is known by the estimate.
    fn judge_huge(
        &mut self,
        what: &str,
        (settings, approach): (&Settings, &Approach),
        (samples, outcome): (Vec<Sample>, Result<Summary, Failure>),
    ) {
        let what = format!("{}, {what}{approach}, step {:e} s", self.scene.page, settings.step);
        match outcome {
            Err(failure) => match reason(&failure.to_string(), settings.t_end) {
                Some(reason) => *self.tally.errors.entry(reason).or_default() += 1,
                None => self.tally.wrong.push(format!("{what}: {failure}")),
            },
            Ok(_) => {
                let [positions, _] = deviations(&samples, &self.rows);
                let estimates = self.estimate(&samples, settings, approach).unwrap_or_default();
                let is_known = |(d, e): (&Deviation, &f64)| d.error <= TIMES * e;
                if estimates.len() == positions.len() && positions.iter().zip(&estimates).all(is_known) {
                    self.tally.huge += 1;
                } else {
                    let errors: Vec<_> = positions.iter().map(|d| format!("{:.1e}", d.error)).collect();
                    self.tally.wrong.push(format!("{what}: {errors:?}, estimated {estimates:?}"));
                }
            }
        }
    }

    fn sweep<T: Real + 'static>(&mut self, what: &str, tolerances: &[f64]) {
        let stand = Stand::<T>::new(self.scene.page, &self.double.start);
        for (coordinates, correction) in keepings(stand.engine.is_tree()) {
            let approach = Approach { coordinates, correction, ..Approach::default() };
            self.fixed(what, &stand, &approach);
            for (integrator, tolerance) in
                CONTROLLED.iter().flat_map(|i| tolerances.iter().map(move |t| (*i, *t)))
            {
                let budget = if integrator == Integrator::Rodas4 { IMPLICIT_BUDGET } else { BUDGET };
                let approach =
                    Approach { integrator, tolerance: Some(tolerance), budget: Some(budget), ..approach };
                let settings = self.scene.settings(1.0);
                let outcome = stand.run(&settings, &approach);
                self.judge(what, (&settings, &approach), outcome, |_, _, size| {
                    TIMES * tolerance * (1.0 + size)
                });
            }
        }
    }

    /// Twice the step has sixteen times the error: that much is allowed, ten times, besides a rounding a step.
    fn fixed<T: Real + 'static>(&mut self, what: &str, stand: &Stand<T>, approach: &Approach) {
        let [fine, coarse, huge] = [1.0, 2.0, 100.0].map(|times| self.scene.settings(times));
        let (outcome, (twice, _)) = (stand.run(&fine, approach), stand.run(&coarse, approach));
        let gaps = gaps(&outcome.0, &twice);
        let rounding = T::EPSILON.to_f64() * self.scene.t_end / self.scene.step;
        self.judge(what, (&fine, approach), outcome, |kind, k, size| {
            TIMES * gaps[kind].get(k).map_or(0.0, |gap| gap / 15.0) + rounding * (1.0 + size)
        });
        let outcome = stand.run(&huge, approach);
        self.judge_huge(what, (&huge, approach), outcome);
    }
}

/// The largest differences of two runs in each position and each rate.
fn gaps(samples: &[Sample], others: &[Sample]) -> [Vec<f64>; 2] {
    use gyro_runner::JointSample;
    let rates = |sample: &Sample| Sample {
        coordinates: sample
            .coordinates
            .iter()
            .map(|joint| match *joint {
                JointSample::Angle { rate, .. } | JointSample::Length { rate, .. } => {
                    JointSample::Length { position: rate, rate }
                }
                JointSample::Orientation { rate: [x, y, z], .. } => {
                    JointSample::Length { position: (x * x + y * y + z * z).sqrt(), rate: 0.0 }
                }
            })
            .collect(),
        ..sample.clone()
    };
    let [a, b] = [samples, others].map(|samples| samples.iter().map(rates).collect::<Vec<_>>());
    [differences(samples, others), differences(&a, &b)]
}

#[test]
fn every_extreme_scene_ends_right_or_in_a_reason() {
    let mut tally = Tally::default();
    for scene in &SCENES {
        let began = std::time::Instant::now();
        let mut judge = Judge::new(scene, &mut tally);
        println!("{} reference {:.2} s", scene.page, began.elapsed().as_secs_f64());
        judge.sweep::<f64>("", &[1e-4, 1e-7, 1e-10]);
        println!("{} {:.2} s", scene.page, began.elapsed().as_secs_f64());
        judge.sweep::<f32>("f32, ", &[1e-4]);
        println!("{} {:.2} s", scene.page, began.elapsed().as_secs_f64());
    }
    let Tally { right, huge, flagged, errors, wrong } = &tally;
    println!("{right} right, {huge} + {} known by the estimate, errors {errors:?}", flagged.len());
    flagged.iter().for_each(|words| println!("flagged: {words}"));
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}
