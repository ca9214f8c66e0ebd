//! What runs are graded, held against the truth, and what their advice is worth when it is followed: over scenes,
//! methods, steps and tolerances drawn at random, sensible ones and others.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use crate::estimate::{deviations, expected};
use gyro_assembled::{Careful, Dense, Number};
use gyro_jit::Native;
use gyro_reference::JointRow;
use gyro_runner::motion::{MotionBuilder, Projecting};
use gyro_runner::{
    Advice, Approach, Coordinates, Correction, Failure, Grade, Integrator, Judgement, Measure, Offers, Plan,
    Promise, Remark, Sample, Settings, Start, Summary, When, balance, companions, judge,
};
use gyro_sim::Real;
use gyro_sim_suite::{EXTREME, Engine, Random, duals, generated_in, model, moved, start_of};
use std::collections::{BTreeMap, HashMap};

/// Samples of a run.
const SAMPLES: f64 = 20.0;

/// Steps and step attempts of one run.
const MOST_STEPS: f64 = 4000.0;
const BUDGET: u64 = 4000;
const IMPLICIT_BUDGET: u64 = 300;

/// Runs of the seeded sample; `GYRO_VERDICTS` asks for another number. Runtime-assembled models are slow: fewer runs,
/// of fewer steps.
const RUNS: usize = 104;
const RUNS_OF_TWINS: usize = 26;
const MOST_STEPS_OF_TWINS: f64 = 400.0;
const SEED: u64 = 17;

/// A good run is off by no more than so much of the motion of each coordinate or of a radian, in the strict sense of
/// the grade, ten times what it claims.
const WRONG: f64 = 1e-2;

/// A run that is right to so much of the motion is not worthless, but for one in fifty.
const RIGHT: f64 = 1e-3;
const WORTHLESS_BUT_RIGHT: f64 = 0.02;

/// Advice is followed so often at most.
const FOLLOWED: usize = 8;

/// What runs a mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Form {
    Generated,
    /// the runtime-assembled model: careful where it can be, else dense.
    Twin,
}

/// A run as it is drawn.
#[derive(Clone, Copy, Debug)]
struct Case {
    page: &'static str,
    form: Form,
    is_single: bool,
    settings: Settings,
    approach: Approach,
}

/// A mechanism in both precisions.
struct Stand {
    double: (Engine<f64>, Box<dyn MotionBuilder<Engine<f64>>>),
    single: (Engine<f32>, Box<dyn MotionBuilder<Engine<f32>>>),
    start: Start,
    size: f64,
    form: Form,
    companions: HashMap<String, Option<(Vec<Sample>, Summary)>>,
}

type Outcome = (Vec<Sample>, Result<Summary, Failure>);

impl Stand {
    fn new(page: &str, form: Form) -> Self {
        fn with_kit<T: Native + Real + Number + 'static>(
            page: &str,
            form: Form,
        ) -> (Engine<T>, Box<dyn MotionBuilder<Engine<T>>>) {
            let model = model(page);
            match (form, Careful::<T>::new(&model)) {
                (Form::Generated, _) => {
                    let engine = generated_in::<T>(page);
                    let builder = engine.builder(duals(page));
                    (engine, builder)
                }
                (Form::Twin, Ok(careful)) => (Engine::new(careful), Box::new(Projecting)),
                (Form::Twin, Err(_)) => (Engine::new(Dense::<T>::new(&model).unwrap()), Box::new(Projecting)),
            }
        }
        let model = model(page);
        // Free bodies are what the command line observes; these scenes have none.
        let start = Start { observed_bodies: Vec::new(), ..start_of(&model) };
        let size = model.size();
        Self {
            double: with_kit(page, form),
            single: with_kit(page, form),
            start,
            size,
            form,
            companions: HashMap::new(),
        }
    }

    fn is_tree(&self) -> bool {
        self.double.0.is_tree()
    }

    fn run(&self, case: &Case) -> Outcome {
        let by = (&case.settings, &case.approach);
        if case.is_single {
            moved(&self.single.0, &*self.single.1, by, &self.start)
        } else {
            moved(&self.double.0, &*self.double.1, by, &self.start)
        }
    }

    fn offers(&self, is_single: bool) -> Offers {
        let epsilon = if is_single { f64::from(f32::EPSILON) } else { f64::EPSILON };
        let derivatives = self.form == Form::Generated;
        Offers { joint_space: self.is_tree(), derivatives, epsilon, ..Offers::ALL }
    }

    /// As the command line judges a run.
    fn judge(&mut self, case: &Case, samples: &[Sample], summary: &Summary) -> Option<Judgement> {
        let measure = Measure { tolerance: case.approach.tolerance, size: self.size, is_balanced: true };
        let mut doubtful = None;
        for (settings, approach) in companions(&case.settings, &case.approach) {
            let key = format!("{} {} {} {approach:?}", settings.t_end, settings.sample_every, settings.step);
            if !self.companions.contains_key(&key) {
                let double = Case { is_single: false, settings, approach, ..*case };
                let (samples, outcome) = self.run(&double);
                self.companions.insert(key.clone(), outcome.ok().map(|summary| (samples, summary)));
            }
            let Some((others, other)) = &self.companions[&key] else { continue };
            let judgement = judge((samples, summary), (others, other), &measure);
            if balance(other, true).is_empty() {
                return Some(judgement);
            }
            doubtful = doubtful.or(Some(judgement));
        }
        doubtful
    }
}

/// Drawn at random: a scene in steps or tolerances from far too fine to far too coarse.
fn draw(random: &mut Random, (page, form): (&'static str, Form), is_tree: bool) -> Case {
    let simulation = model(page).simulation;
    let pick = |random: &mut Random, n: usize| random.below(n);
    let is_generated = form == Form::Generated;
    let integrators = [Integrator::Rk4, Integrator::Tsit5, Integrator::Dop853, Integrator::Rodas4];
    let integrator = integrators[pick(random, if is_generated { 4 } else { 3 })];
    let corrections = [
        Correction::Partition,
        Correction::MassWeighted,
        Correction::Baumgarte(10f64.powf(1.5 + 1.5 * random.signed())),
        Correction::None,
        Correction::ClosedForm,
    ];
    let correction = corrections[pick(random, if is_tree { 5 } else { 4 })];
    let steers = matches!(correction, Correction::Baumgarte(_));
    let integrator = if steers && integrator == Integrator::Rodas4 { Integrator::Dop853 } else { integrator };
    let coordinates =
        if is_tree && random.signed() > 0.4 { Coordinates::Joint } else { Coordinates::Maximal };
    let is_fixed = integrator == Integrator::Rk4 || random.signed() > 0.4;
    let step = simulation.step * 10f64.powf(1.5 + 1.5 * random.signed());
    let is_single = random.signed() > 0.6;
    let finest = if is_single { 1e-6 } else { 1e-15 };
    let tolerance = 10f64.powf(-5.5 + 5.5 * random.signed()).clamp(finest, 1.0);
    let (steps, budget) = if integrator == Integrator::Rodas4 {
        (IMPLICIT_BUDGET as f64, IMPLICIT_BUDGET)
    } else {
        (if is_generated { MOST_STEPS } else { MOST_STEPS_OF_TWINS }, BUDGET)
    };
    let t_end = if is_fixed {
        simulation.t_end.min(steps * step).min(1.0)
    } else {
        simulation.t_end.min(1000.0 * simulation.step).min(1.0)
    };
    let when =
        [None, Some(When::Steps(1)), Some(When::Steps(7)), Some(When::Violation(1e-6))][pick(random, 4)];
    Case {
        page,
        form,
        is_single,
        settings: Settings { t_end, step, correct_every: Some(step * 5.0), sample_every: t_end / SAMPLES },
        approach: Approach {
            integrator,
            coordinates,
            correction,
            when,
            tolerance: (!is_fixed).then_some(tolerance),
            budget: Some(budget),
            examine: true,
            ..Approach::default()
        },
    }
}

/// The largest error of a run in the strict sense of the grade: of a coordinate against its motion, an angle against a
/// radian at most, and what hardly moves against a millionth of that.
fn true_error(samples: &[Sample], rows: &[JointRow], size: f64) -> f64 {
    let [positions, rates] = deviations(samples, rows);
    let moved = motion(rows);
    let is_length: Vec<bool> = samples[0]
        .coordinates
        .iter()
        .map(|joint| matches!(joint, gyro_runner::JointSample::Length { .. }))
        .collect();
    let in_radians = |k: usize, x: f64| if is_length[k] { x / size } else { x };
    let all = |of: &dyn Fn(usize) -> f64| (0..moved.len()).map(|k| in_radians(k, of(k))).fold(0.0, f64::max);
    let (angle, rate) = (all(&|k| moved[k]).min(1.0), all(&|k| rates[k].size));
    let mut worst: f64 = 0.0;
    for k in 0..moved.len() {
        let unit = if is_length[k] { size } else { 1.0 };
        let reach = if is_length[k] { moved[k] } else { moved[k].min(1.0) };
        let ratios = [
            positions[k].error / reach.max(1e-6 * angle * unit),
            rates[k].error / rates[k].size.max(1e-6 * rate * unit),
        ];
        for ratio in ratios {
            worst = if ratio <= worst || (worst.is_nan()) { worst } else { ratio };
        }
    }
    worst
}

/// How far each coordinate of the reference goes from its start.
fn motion(rows: &[JointRow]) -> Vec<f64> {
    let n = rows[0].positions.len();
    let scalars = (0..n)
        .map(|k| rows.iter().map(|row| (row.positions[k] - rows[0].positions[k]).abs()).fold(0.0, f64::max));
    scalars.chain(rows[0].orientations.iter().map(|_| 1.0)).collect()
}

#[derive(Default)]
struct Tally {
    grades: BTreeMap<Grade, usize>,
    failed: usize,
    unjudged: usize,
    right: usize,
    worthless_but_right: Vec<String>,
    open_energy: usize,
    wrong: Vec<String>,
    followed: usize,
}

struct Trial {
    stands: HashMap<(&'static str, Form), Stand>,
    tally: Tally,
}

impl Trial {
    fn check(&mut self, case: &Case) {
        let stand = self.stands.get_mut(&(case.page, case.form)).unwrap();
        let (samples, outcome) = stand.run(case);
        let tally = &mut self.tally;
        let what = format!(
            "{}, {:?}{}, {}, step {:e} s, {} s",
            case.page,
            case.form,
            if case.is_single { ", f32" } else { "" },
            case.approach,
            case.settings.step,
            case.settings.t_end
        );
        let summary = match outcome {
            Ok(summary) => summary,
            Err(failure) => {
                tally.failed += 1;
                return self.follow_failure(case, &what, failure);
            }
        };
        let Some(judgement) = stand.judge(case, &samples, &summary) else {
            tally.unjudged += 1;
            return;
        };
        let rows = expected(case.page, &case.settings);
        let error = true_error(&samples, &rows, stand.size);
        *tally.grades.entry(judgement.grade).or_default() += 1;
        tally.right += usize::from(error <= RIGHT);
        let words = format!("{what}: {:?}, off by {error:.1e}, {:?}", judgement.grade, judgement.reasons);
        if judgement.grade == Grade::Good && (error.is_nan() || error > WRONG) {
            tally.wrong.push(words.clone());
        }
        if judgement.grade == Grade::Worthless && error <= RIGHT {
            tally.worthless_but_right.push(words);
        }
        tally.open_energy +=
            usize::from(balance(&summary, true).iter().any(|reason| reason.grade() == Grade::Worthless));
        let offers = stand.offers(case.is_single);
        let plan = Plan { settings: &case.settings, approach: &case.approach, offers: &offers };
        for remark in plan.remarks(&judgement, &summary, None) {
            self.follow_remark(case, &what, &judgement, &summary, &remark);
        }
    }

    /// The case with advice followed; a refusal is the tool's own fault.
    fn followed(&mut self, case: &Case, what: &str, advice: &Advice) -> Case {
        let (settings, approach) = advice.follow(&case.settings, &case.approach);
        let next =
            Case { settings, approach, is_single: case.is_single && !advice.is_of_precision(), ..*case };
        let refused =
            self.stands[&(case.page, case.form)].offers(next.is_single).refusal(&settings, &approach);
        if let Some(words) = refused {
            self.tally.wrong.push(format!("{what}: the advice {advice} is refused: {words}"));
        }
        self.tally.followed += 1;
        next
    }

    fn follow_remark(
        &mut self,
        case: &Case,
        what: &str,
        judgement: &Judgement,
        summary: &Summary,
        remark: &Remark,
    ) {
        let Some(advice) = &remark.advice else { return };
        let mut next = self.followed(case, what, advice);
        if remark.promise == Promise::None {
            return;
        }
        next.approach.budget = None;
        let stand = self.stands.get_mut(&(case.page, case.form)).unwrap();
        let (samples, outcome) = stand.run(&next);
        let result = match outcome {
            Ok(new) => {
                let same = Case { approach: case.approach, settings: case.settings, ..next };
                // As the run itself was judged, so that the same companion judges both.
                let error = stand.judge(&same, &samples, &new).map_or(f64::NAN, |new| new.relative);
                match remark.promise {
                    Promise::Error(factor) => (error * factor, judgement.relative),
                    Promise::Violation(factor) => {
                        (new.position_violation * factor, summary.position_violation)
                    }
                    Promise::Stability => (new.statistics.limited_by_stability as f64, 0.0),
                    Promise::None => (0.0, 0.0),
                }
            }
            Err(failure) => {
                let words = format!("{what}: {remark} It ends in an error: {failure}");
                return self.tally.wrong.push(words);
            }
        };
        if result.0.is_nan() || result.0 > result.1 {
            self.tally.wrong.push(format!("{what}: {remark} It did not: {:.1e} {:.1e}", result.0, result.1));
        }
    }

    /// After an error: following the advice again and again leads to the end, further on, or to an error without
    /// advice.
    fn follow_failure(&mut self, case: &Case, what: &str, failure: Failure) {
        let (mut case, mut failure) = (*case, failure);
        for _ in 0..FOLLOWED {
            let advice = match failure {
                Failure::Run { ref advice, .. } => advice.first().cloned(),
                Failure::Refused(words) => return self.tally.wrong.push(format!("{what}: refused: {words}")),
                Failure::Input(_) | Failure::Output(_) | Failure::Unexplained(_) => None,
            };
            let Some(advice) = advice else { return };
            case = self.followed(&case, what, &advice);
            if case.settings.t_end / case.settings.step > 50.0 * MOST_STEPS
                || case.approach.budget > Some(50 * BUDGET)
            {
                return;
            }
            case.approach.budget = case.approach.budget.max(Some(BUDGET));
            match self.stands[&(case.page, case.form)].run(&case).1 {
                Ok(_) => return,
                Err(next) => failure = next,
            }
        }
        self.tally.wrong.push(format!("{what}: advice leads nowhere, at last to {failure}"));
    }
}

fn trial(form: Form, n_runs: usize, seed: u64) -> Tally {
    let mut random = Random::new(seed);
    let pages = EXTREME.map(|page| (page, form));
    let mut trial = Trial {
        stands: pages.into_iter().map(|page| (page, Stand::new(page.0, form))).collect(),
        tally: Tally::default(),
    };
    for run in 0..n_runs {
        let page = pages[run % pages.len()];
        let case = draw(&mut random, page, trial.stands[&page].is_tree());
        trial.check(&case);
    }
    trial.tally
}

fn asked(name: &str) -> Option<usize> {
    std::env::var(name).ok().and_then(|n| n.parse().ok())
}

fn check(form: Form, n_runs: usize) -> Tally {
    let n_runs = asked("GYRO_VERDICTS").unwrap_or(n_runs);
    let tally = trial(form, n_runs, asked("GYRO_SEED").map_or(SEED, |seed| seed as u64));
    println!(
        "{form:?}, {n_runs} runs: {:?}, {} failed, {} unjudged; {} right, of which worthless {}; balance worthless {}; advice followed {}",
        tally.grades,
        tally.failed,
        tally.unjudged,
        tally.right,
        tally.worthless_but_right.len(),
        tally.open_energy,
        tally.followed
    );
    tally.worthless_but_right.iter().for_each(|words| println!("right: {words}"));
    assert!(tally.wrong.is_empty(), "{} wrong:\n{}", tally.wrong.len(), tally.wrong.join("\n"));
    let most = WORTHLESS_BUT_RIGHT * tally.right as f64;
    assert!(tally.worthless_but_right.len() as f64 <= most, "{:?}", tally.worthless_but_right);
    tally
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn no_wrong_run_is_good_and_advice_does_what_it_says() {
    let tally = check(Form::Generated, RUNS);
    assert!(tally.grades.len() == 3 && tally.followed > RUNS / 10, "{:?}", tally.grades);
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn no_wrong_run_of_a_twin_is_good() {
    check(Form::Twin, RUNS_OF_TWINS);
}
