//! Every extreme scene, integrator, correction and tolerance: the right answer, or an error that says what, where and
//! when.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use crate::estimate::{Deviation, deviations, estimate, expected};
use gyro_jit::Native;
use gyro_reference::JointRow;
use gyro_runner::motion::{Begun, Linear, MotionBuilder, OperatingPoint};
use gyro_runner::{
    Approach, Coordinates, Correction, Difference, Failure, Integrator, Offers, Sample, Settings, Start,
    Summary, Touch, differences, time_by,
};
use gyro_sim::{JointLayout, Real};
use gyro_sim_suite::{Duals, Engine, duals, generated_in, generated_with_joints, model, moved, start_of};
use std::collections::{BTreeMap, HashMap};
use std::time::Duration;

/// Samples of a run.
const SAMPLES: f64 = 10.0;

/// A model file, how far to follow it and in which steps, s, where they are fixed.
struct Scene {
    page: &'static str,
    t_end: f64,
    step: f64,
}

/// A few periods of the fastest motion; 500 to 4000 steps.
const SCENES: [Scene; 15] = [
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
    Scene { page: "four-bar-bushing", t_end: 2e-3, step: 1e-6 },
    Scene { page: "four-bar-in-line", t_end: 0.5, step: 1e-3 },
    Scene { page: "slider-crank", t_end: 0.2, step: 2e-4 },
];

/// A scene's mechanism, plain and in dual numbers; of some loops with their joint coordinates.
fn engines<T: Native + Real>(page: &str) -> (Engine<T>, Duals<T>) {
    let with_joints = ["four-bar-bushing", "four-bar-in-line", "slider-crank"].contains(&page);
    let engine = if with_joints { generated_with_joints(page) } else { generated_in(page) };
    (engine, duals(page))
}

/// How far off a result may be in units of the tolerance.
const TIMES: f64 = 10.0;

/// Errors of single steps add up to no more than so many times what is allowed, but for a tolerance of one and where a
/// mechanism may go on in two ways.
const ADDED_UP: f64 = 30.0;

/// Of all runs that begin at least so many end right.
const RIGHT: f64 = 0.75;

/// Errors smaller than a hundred units in the last place are rounding.
const ULPS: f64 = 100.0 * f64::EPSILON;

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
    builder: Box<dyn MotionBuilder<Engine<T>>>,
    start: Start,
}

impl<T: Native + Real> Stand<T> {
    fn new(page: &str, start: &Start) -> Self {
        let (engine, duals) = engines::<T>(page);
        let builder = Box::new(LoopsNotLinearised(engine.builder(duals)));
        Self { engine, builder, start: start.clone() }
    }

    fn run(&self, settings: &Settings, approach: &Approach) -> (Vec<Sample>, Result<Summary, Failure>) {
        moved(&self.engine, &*self.builder, (settings, approach), &self.start)
    }
}

/// What begins a motion, but says nothing of how fast the fastest part of a loop is: engines do not linearise loops.
struct LoopsNotLinearised<T: 'static>(Box<dyn MotionBuilder<Engine<T>>>);

impl<T: Real + 'static> MotionBuilder<Engine<T>> for LoopsNotLinearised<T> {
    fn begin(
        &self,
        mechanism: &Engine<T>,
        approach: &Approach,
        y: &Vec<T>,
        contacts: &[Touch],
    ) -> Begun<Engine<T>> {
        self.0.begin(mechanism, approach, y, contacts)
    }
    fn offers(&self) -> Offers {
        self.0.offers()
    }
    fn smallest_pivot(&self, mechanism: &Engine<T>, t: f64, y: &Vec<T>) -> Option<f64> {
        self.0.smallest_pivot(mechanism, t, y)
    }
    fn joint_layout<'a>(&self, mechanism: &'a Engine<T>) -> Option<&'a JointLayout<'a>> {
        self.0.joint_layout(mechanism)
    }
    fn linearise(&self, mechanism: &Engine<T>, at: &OperatingPoint<'_, Vec<T>>) -> Option<Linear> {
        let has_loops = self.joint_layout(mechanism).is_some_and(|layout| !layout.closure_rows.is_empty());
        (!has_loops).then(|| self.0.linearise(mechanism, at)).flatten()
    }
}

/// How runs have ended.
#[derive(Default)]
struct Tally {
    right: u32,
    known_huge: u32,
    known: Vec<String>,
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

/// What an error may say after its time, and whether a joint, a body or the work has to be named.
const REASONS: [(&str, bool); 8] = [
    ("is no longer finite", true),
    ("would need steps as short as", true),
    ("cannot be met: ", true),
    ("can be met only by a change", true),
    ("cannot be solved for", false),
    ("the budget of", false),
    ("allows this method steps of", false),
    (REFUSED, false),
];

const REFUSED: &str = "a tolerance of";

/// The reason of an error that says what, where and when.
fn reason(words: &str, t_end: f64) -> Option<&'static str> {
    let (reason, is_somewhere) = REASONS.into_iter().find(|(reason, _)| words.contains(reason))?;
    if words.starts_with(REFUSED) {
        return Some(reason);
    }
    let t: f64 = words.strip_prefix("at t = ")?.split(' ').next()?.parse().ok()?;
    let is_named =
        [" joint `", " body `", "joint's turns", " s the work done "].iter().any(|name| words.contains(name));
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
        Self::by(scene, scene.page, tally)
    }

    /// By the reference of another model file.
    fn by(scene: &'a Scene, page: &str, tally: &'a mut Tally) -> Self {
        let start = start_of(&model(scene.page));
        let rows = expected(page, &scene.settings(1.0));
        Self { scene, rows, double: Stand::new(scene.page, &start), companions: HashMap::new(), tally }
    }

    fn estimate(
        &mut self,
        samples: &[Sample],
        settings: &Settings,
        approach: &Approach,
    ) -> Option<Vec<Difference>> {
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
        let summary = match outcome {
            Ok(summary) => summary,
            Err(failure) => return self.note(&what, &failure, settings),
        };
        let deviations = deviations(&samples, &self.rows);
        let ratio = worst(&deviations, &allowed);
        if ratio <= 1.0 && samples.len() == self.rows.len() {
            self.tally.right += 1;
            return;
        }
        let words = format!("{what}: {ratio:.2e} times what is allowed");
        // Runs of fixed steps say themselves where they may have gone another way.
        let is_told = summary.statistics.passages > 0 || approach.tolerance == Some(1.0);
        if ratio > ADDED_UP && !is_told {
            self.tally.wrong.push(words);
            return;
        }
        match self.known(&samples, &deviations, settings, approach) {
            Ok(words_of_estimate) => self.tally.known.push(format!("{words}, {words_of_estimate}")),
            Err(words_of_estimate) => self.tally.wrong.push(format!("{words}, {words_of_estimate}")),
        }
    }

    /// Whether the estimate tells: that the errors are more than ten times the tolerance; of fixed steps, how large
    /// they are.
    fn known(
        &mut self,
        samples: &[Sample],
        deviations: &[Vec<Deviation>; 2],
        settings: &Settings,
        approach: &Approach,
    ) -> Result<String, String> {
        let Some(estimates) = self.estimate(samples, settings, approach) else {
            return Err("no companion has come to its end".to_owned());
        };
        let of = |k: usize, estimate: fn(&Difference) -> f64| {
            let pairs = deviations[k].iter().zip(&estimates);
            pairs.map(move |(d, e)| (d.error, ULPS * (1.0 + d.size) + TIMES * estimate(e)))
        };
        let (is_known, words) = match approach.tolerance {
            Some(tolerance) => {
                let times = estimates.iter().map(|e| e.in_tolerances(tolerance)).fold(0.0, f64::max);
                (times > TIMES, format!("the estimate is {times:.3} tolerances"))
            }
            None => {
                let is_known =
                    of(0, |e| e.position).chain(of(1, |e| e.rate)).all(|(error, most)| error <= most);
                let largest = estimates.iter().map(|e| e.position.max(e.rate)).fold(0.0, f64::max);
                (is_known, format!("the largest estimate is {largest:.1e}"))
            }
        };
        let errors = deviations.concat().iter().map(|d| format!("{:.1e}", d.error)).collect::<Vec<_>>();
        let words = format!("{words}; errors {}", errors.join(" "));
        if is_known { Ok(words) } else { Err(words) }
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
            Err(failure) => self.note(&what, &failure, settings),
            Ok(_) => {
                let deviations = deviations(&samples, &self.rows);
                match self.known(&samples, &deviations, settings, approach) {
                    Ok(_) => self.tally.known_huge += 1,
                    Err(words) => self.tally.wrong.push(format!("{what}: {words}")),
                }
            }
        }
    }

    fn note(&mut self, what: &str, failure: &Failure, settings: &Settings) {
        let words = failure.to_string();
        match reason(&words, settings.t_end) {
            Some(reason) => *self.tally.errors.entry(reason).or_default() += 1,
            None => self.tally.wrong.push(format!("{what}: {words}")),
        }
    }

    fn sweep<T: Native + Real>(&mut self, what: &str, tolerances: &[f64]) {
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
                if matches!((integrator, correction), (Integrator::Rodas4, Correction::Baumgarte(_))) {
                    continue; // Not offered.
                }
                let outcome = stand.run(&settings, &approach);
                self.judge(what, (&settings, &approach), outcome, |_, _, size| {
                    TIMES * tolerance * (1.0 + size)
                });
            }
        }
    }

    /// A tolerance that no number of this precision can meet is refused before the first step.
    fn refused<T: Native + Real>(&mut self, tolerance: f64) {
        let stand = Stand::<T>::new(self.scene.page, &self.double.start);
        let settings = self.scene.settings(1.0);
        for (integrator, (coordinates, correction)) in
            CONTROLLED.iter().flat_map(|i| keepings(stand.engine.is_tree()).into_iter().map(move |k| (*i, k)))
        {
            let approach = Approach { integrator, coordinates, correction, ..Approach::default() };
            let approach = Approach { tolerance: Some(tolerance), ..approach };
            let (samples, outcome) = stand.run(&settings, &approach);
            let words = outcome.err().map_or(String::new(), |failure| failure.to_string());
            if samples.is_empty() && words.starts_with(&format!("a tolerance of {tolerance:e} cannot be met"))
            {
                *self.tally.errors.entry(REFUSED).or_default() += 1;
            } else {
                self.tally.wrong.push(format!("{}, {approach}: {words}", self.scene.page));
            }
        }
    }

    /// Twice the step has sixteen times the error: that much is allowed, ten times, besides a rounding a step.
    fn fixed<T: Native + Real>(&mut self, what: &str, stand: &Stand<T>, approach: &Approach) {
        let [fine, coarse, huge] = [1.0, 2.0, 100.0].map(|times| self.scene.settings(times));
        let (outcome, (twice, _)) = (stand.run(&fine, approach), stand.run(&coarse, approach));
        let gaps = differences(&outcome.0, &twice);
        let rounding = T::EPSILON.to_f64() * self.scene.t_end / self.scene.step;
        self.judge(what, (&fine, approach), outcome, |kind, k, size| {
            let gap = gaps.get(k).map_or(0.0, |gap| if kind == 0 { gap.position } else { gap.rate });
            TIMES * gap / 15.0 + rounding * (1.0 + size)
        });
        let outcome = stand.run(&huge, approach);
        self.judge_huge(what, (&huge, approach), outcome);
    }
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn every_extreme_scene_ends_right_or_in_a_reason() {
    let mut tally = Tally::default();
    for scene in &SCENES {
        let mut judge = Judge::new(scene, &mut tally);
        judge.sweep::<f64>("", &[1.0, 1e-4, 1e-7, 1e-10]);
        judge.sweep::<f32>("f32, ", &[1e-4]);
        judge.refused::<f64>(0.0);
        judge.refused::<f32>(1e-7);
    }
    let Tally { right, known_huge, known, errors, wrong } = &tally;
    println!(
        "{right} right; known by the estimate {}, with huge steps {known_huge}; errors {errors:?}",
        known.len()
    );
    known.iter().for_each(|words| println!("{words}"));
    let ended: u32 = errors.iter().filter(|(reason, _)| **reason != REFUSED).map(|(_, n)| n).sum();
    let begun = f64::from(*right) + known.len() as f64 + f64::from(ended);
    assert!(f64::from(*right) >= RIGHT * begun, "{right} of {begun} are right");
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn another_answer_is_not_right() {
    // The check must be able to fail: the verdict knows nothing of what the reference says.
    let mut tally = Tally::default();
    Judge::by(&SCENES[0], "gyroscope-light-rings", &mut tally).sweep::<f64>("", &[1e-7]);
    assert!(tally.right == 0 && !tally.wrong.is_empty(), "{} right", tally.right);
    assert_eq!(reason("at t = 0.5 s the orientation is no longer finite", 1.0), None);
    assert_eq!(reason("at t = 2 s the budget of 3 steps is used up", 1.0), None);
}

/// The end of a run may be no number of single precision: 0.01 is rounded down, and a clock that waits for it would
/// wait for ever.
#[test]
fn a_run_in_single_precision_is_timed_to_its_end() {
    let scene = Scene { page: "gyroscope", t_end: 0.01, step: 1e-4 };
    let stand = Stand::<f32>::new(scene.page, &start_of(&model(scene.page)));
    assert!(f64::from(0.01_f32) < scene.t_end, "rounded down");
    let approach = Approach { integrator: Integrator::Tsit5, tolerance: Some(1e-4), ..Approach::default() };
    let plan = (&scene.settings(1.0), &approach);
    let timing = time_by(&stand.engine, &*stand.builder, plan, &stand.start, Duration::ZERO).unwrap();
    assert!(timing.statistics.accepted > 0 && timing.measured.runs == 1, "{timing:?}");
}
