//! The loop.

use crate::input::{any_varies, set};
use crate::motion::{self, Kit, Linear, Motion};
use crate::sample::Observer;
use crate::{
    Approach, Coordinates, Correction, Failure, Input, Integrator, Sample, Schedule, Segment, Settings,
    Summary, Tracker, describe, describe_in,
};
use gyro_sim::{Error, JointCoordinate, Partition, Ports, Real, Scalar, Turns};
use std::io;
use std::time::{Duration, Instant};

/// Where a run starts, what is fed into it and what is watched besides joints and outputs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// `(r, p)` of each body with coordinates.
    pub positions: Vec<f64>,
    /// `(s, w')` of each body with coordinates.
    pub velocities: Vec<f64>,
    /// The mechanism's turn references: the last elements of its state.
    pub turn_references: Vec<f64>,
    /// For each coordinate, joint after joint, the angle that its continuous angle starts nearest to, rad; anything for
    /// coordinates that are no angles.
    pub angles: Vec<f64>,
    /// What the mechanism's inputs are over time; those that are not here stay as they are.
    pub inputs: Vec<Input>,
    /// Indices of the bodies whose pose and velocity are sampled.
    pub observed_bodies: Vec<usize>,
}

/// What a run has to tell.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// The mechanism at a sample time.
    Sample(&'a Sample),
    /// The linearisation at the end, if it is asked for and there is one.
    Linear(&'a Linear),
    /// The run has reached this time, s. Comes every now and then, for a progress bar.
    Progress(f64),
}

/// Between two readings of the turns at most so many steps pass: the mean rate has to predict an angle to within half a
/// turn, and no integrator does well where a rate changes by half a turn within eight steps.
const STEPS_BETWEEN_READINGS: u64 = 8;

/// Time between two [`Event::Progress`].
const PROGRESS_EVERY: Duration = Duration::from_millis(100);

/// Runs a mechanism to a schedule by the paper's method, RK4 and coordinate partitioning, and hands what happens to `tell`.
///
/// The first sample is the start as given, uncorrected. Where an input varies it is set anew before every step. An error of
/// `tell` ends the run.
///
/// # Errors
/// [`Failure::Run`] if a solver fails or the start does not fit the mechanism; [`Failure::Output`] from `tell`.
pub fn run<M: Partition + Ports + 'static>(
    mechanism: &mut M,
    settings: &Settings,
    start: &Start,
    tell: impl FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, Failure> {
    run_by(mechanism, &motion::Any, (settings, &Approach::default()), start, tell)
}

/// The same by any approach for which there is a kit.
///
/// Under error control samples are interpolated, and inputs must not vary.
///
/// # Errors
/// As [`run`]; [`Failure::Run`] also if the approach does not suit the mechanism.
pub fn run_by<M: Partition + Ports + 'static>(
    mechanism: &mut M,
    kit: &dyn Kit<M>,
    (settings, approach): (&Settings, &Approach),
    start: &Start,
    mut tell: impl FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, Failure> {
    let settings = scheduled(settings, approach);
    settings.check().map_err(|e| Failure::Run(e.to_string()))?;
    check(approach, start)?;
    let y = state(mechanism, start)?;
    refuse_singular(mechanism, &y)?;
    set(mechanism, &start.inputs, 0.0);
    let motion = kit.begin(mechanism, approach, &y).map_err(Failure::Run)?;
    let mut run = Run::new(mechanism, motion, y, start);
    let mut tracker = Tracker::default();
    let mut last_told = Instant::now();
    let in_words =
        |mechanism: &M, error: Error| Failure::Run(describe_in(mechanism, approach.coordinates, &error));
    let sample = run.sample(0.0).map_err(|e| in_words(run.mechanism, e))?;
    tracker.add(&sample);
    tell(Event::Sample(&sample))?;
    for segment in Schedule::new(&settings) {
        let advanced = match approach.tolerance {
            None => run.advance(&segment),
            Some(_) => run.advance_beyond(segment.to, settings.t_end),
        };
        advanced.map_err(|e| in_words(run.mechanism, e))?;
        if segment.samples {
            let sample = run.sample(segment.to).map_err(|e| in_words(run.mechanism, e))?;
            run.look_at_pivots(kit, approach, segment.to);
            tracker.add(&sample);
            tell(Event::Sample(&sample))?;
        }
        if last_told.elapsed() >= PROGRESS_EVERY {
            tell(Event::Progress(segment.to))?;
            last_told = Instant::now();
        }
    }
    run.finish();
    if let Some(linear) = approach
        .examine
        .then(|| kit.linearise(run.mechanism, settings.t_end, &run.y, &run.angles()))
        .flatten()
    {
        let linear = if counts_work(run.mechanism, start) { linear.without_last() } else { linear };
        tell(Event::Linear(&linear))?;
    }
    tracker.finish(&mut run.summary);
    Ok(run.summary)
}

/// The schedule of an approach: its own corrections, or none to be scheduled, do not divide the run.
pub(crate) fn scheduled(settings: &Settings, approach: &Approach) -> Settings {
    let has_moments = approach.coordinates == Coordinates::Maximal
        && !matches!(approach.correction, Correction::None | Correction::Baumgarte(_))
        && approach.when.is_none()
        && approach.tolerance.is_none();
    // Under error control only samples divide it.
    let step = if approach.tolerance.is_some() { settings.t_end } else { settings.step };
    Settings { correct_every: settings.correct_every.filter(|_| has_moments), step, ..*settings }
}

fn check(approach: &Approach, start: &Start) -> Result<(), Failure> {
    if approach.tolerance.is_none() {
        return Ok(());
    }
    if approach.integrator == Integrator::Rk4 {
        let words = "rk4 has no error estimate: give it a --step instead of a --tolerance, or use tsit5, dop853 or rodas4";
        return Err(Failure::Run(words.to_owned()));
    }
    if any_varies(&start.inputs) {
        let words = "inputs that vary are held over each step, so steps have to be fixed: give a --step instead of a --tolerance";
        return Err(Failure::Run(words.to_owned()));
    }
    Ok(())
}

/// In a singular pose accelerations are not defined: better to say so than to integrate what is not finite.
fn refuse_singular<M: Partition>(mechanism: &M, start: &M::State) -> Result<(), Failure> {
    let t = Scalar::constant(0.0);
    match mechanism.newton_step(t, &mechanism.independent(t, start), &mut start.clone()) {
        Err(error @ Error::Singular { .. }) => Err(Failure::Run(describe(mechanism, &error))),
        _ => Ok(()),
    }
}

/// The state under way, with its solvers.
struct Run<'a, M: Partition + Ports> {
    mechanism: &'a mut M,
    motion: Box<dyn Motion<M>>,
    inputs: &'a [Input],
    steps_at_once: u64,
    /// The maximal state when it was last looked at.
    y: M::State,
    turns: Turns<M>,
    /// When the turns were last read, s.
    read_at: f64,
    observer: Observer<'a, M>,
    summary: Summary,
}

impl<'a, M: Partition + Ports> Run<'a, M> {
    fn new(mechanism: &'a mut M, mut motion: Box<dyn Motion<M>>, y: M::State, start: &'a Start) -> Self {
        start.inputs.iter().for_each(|input| motion.set_input(input.index, input.at(0.0)));
        let angles: Vec<M::Scalar> = start.angles.iter().map(|&a| Scalar::constant(a)).collect();
        Self {
            motion,
            inputs: &start.inputs,
            steps_at_once: if any_varies(&start.inputs) { 1 } else { STEPS_BETWEEN_READINGS },
            turns: Turns::new(mechanism, Scalar::constant(0.0), &y, &angles),
            read_at: 0.0,
            observer: Observer::new(mechanism, &start.observed_bodies),
            mechanism,
            y,
            summary: Summary::default(),
        }
    }

    /// Equal steps, and a correction where the schedule has one.
    fn advance(&mut self, segment: &Segment) -> Result<(), Error> {
        #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
        let h = (segment.to - segment.from) / segment.n_steps as f64;
        let mut done = 0;
        while done < segment.n_steps {
            let n_steps = (segment.n_steps - done).min(self.steps_at_once);
            self.set_inputs();
            let began = Instant::now();
            for _ in 0..n_steps {
                self.motion.step(self.mechanism, h)?;
            }
            self.summary.run_time_s += began.elapsed().as_secs_f64();
            done += n_steps;
            self.read_turns(self.motion.time())?;
        }
        if segment.corrects {
            let began = Instant::now();
            self.motion.correct(self.mechanism)?;
            self.summary.run_time_s += began.elapsed().as_secs_f64();
        }
        Ok(())
    }

    /// Steps under error control until a time is passed.
    fn advance_beyond(&mut self, t: f64, t_end: f64) -> Result<(), Error> {
        // As the motion counts time: in single precision the end may come before this number.
        let t = M::Scalar::constant(t).to_f64();
        while self.motion.time() < t {
            let began = Instant::now();
            self.motion.step_towards(self.mechanism, t_end)?;
            self.summary.run_time_s += began.elapsed().as_secs_f64();
            if self.motion.time() <= t {
                self.read_turns(self.motion.time())?;
            }
        }
        Ok(())
    }

    fn set_inputs(&mut self) {
        let t = self.motion.time();
        set(self.mechanism, self.inputs, t);
        if any_varies(self.inputs) {
            for input in self.inputs {
                self.motion.set_input(input.index, input.at(t));
            }
        }
    }

    /// Between two readings the mean rate predicts each angle to within half a turn.
    fn read_turns(&mut self, t: f64) -> Result<(), Error> {
        self.motion.at(self.mechanism, t, &mut self.y)?;
        let dt = t - self.read_at;
        self.turns.update(self.mechanism, Scalar::constant(t), Scalar::constant(dt), &self.y);
        self.read_at = t;
        Ok(())
    }

    /// The state may have been corrected since the turns were read: they are read again.
    fn sample(&mut self, t: f64) -> Result<Sample, Error> {
        set(self.mechanism, self.inputs, t);
        if t > 0.0 {
            self.read_turns(t)?;
        }
        Ok(self.observer.sample(self.mechanism, t, &self.y, &self.turns, self.motion.chart_switches()))
    }

    /// The continuous angle of each coordinate at the last reading; zero for what is no angle.
    fn angles(&self) -> Vec<f64> {
        let joints = 0..self.mechanism.n_joints();
        let all = joints
            .flat_map(|joint| (0..self.mechanism.joint(joint).coordinates.len()).map(move |k| (joint, k)));
        let angle = |(joint, k)| match self.turns.coordinate(self.mechanism, joint, k) {
            Some(JointCoordinate::Angle { position, .. }) => position.to_f64(),
            _ => 0.0,
        };
        all.map(angle).collect()
    }

    fn look_at_pivots(&mut self, kit: &dyn Kit<M>, approach: &Approach, t: f64) {
        if let Some(pivot) =
            approach.examine.then(|| kit.smallest_pivot(self.mechanism, t, &self.y)).flatten()
        {
            let smallest = &mut self.summary.smallest_pivot;
            *smallest = Some(smallest.map_or(pivot, |before| before.min(pivot)));
        }
    }

    fn finish(&mut self) {
        let statistics = self.motion.statistics();
        self.summary.steps = statistics.accepted;
        self.summary.chart_switches = self.motion.chart_switches();
        self.summary.statistics = statistics;
    }
}

/// The state of a start: `(q, v)`, then zero work where the mechanism counts work, then turn references.
pub(crate) fn state<M: Partition>(mechanism: &M, start: &Start) -> Result<M::State, Failure> {
    let mut state = mechanism.start();
    refuse_misfit(mechanism, state.as_ref().len(), start)?;
    let (known, rest) = state.as_mut().split_at_mut(13 * mechanism.n_bodies());
    let (work, references) = rest.split_at_mut(rest.len() - start.turn_references.len());
    work.fill(Scalar::constant(0.0));
    for (element, value) in known.iter_mut().zip(start.positions.iter().chain(&start.velocities)) {
        *element = Scalar::constant(*value);
    }
    for (element, value) in references.iter_mut().zip(&start.turn_references) {
        *element = Scalar::constant(*value);
    }
    Ok(state)
}

/// Whether the state holds more than positions, velocities and turn references.
fn counts_work<M: Partition>(mechanism: &M, start: &Start) -> bool {
    mechanism.start().as_ref().len() > 13 * mechanism.n_bodies() + start.turn_references.len()
}

/// At most the work is left of the state when positions, velocities and turn references are taken away.
fn refuse_misfit<M: Partition>(mechanism: &M, length: usize, start: &Start) -> Result<(), Failure> {
    let n_bodies = mechanism.n_bodies();
    let found = [start.positions.len(), start.velocities.len(), start.turn_references.len()];
    let left = length.checked_sub(found.iter().sum());
    let fits = found[0] == 7 * n_bodies
        && found[1] == 6 * n_bodies
        && left.is_some_and(|left| left <= 1)
        && start.observed_bodies.iter().all(|&body| body < n_bodies);
    if fits {
        return Ok(());
    }
    Err(Failure::Run(format!(
        "the start has {} positions, {} velocities and {} turn references, the mechanism has {n_bodies} bodies and {length} \
         elements of its state",
        found[0], found[1], found[2]
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::JointSample;
    use crate::spinner::Spinner;

    fn samples(rate: f64, settings: &Settings) -> (Vec<Sample>, Summary) {
        let spinner = Spinner { rate, torque: 0.0 };
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
        let ramp = Input { index: 0, rows: vec![[0.0, 0.0], [1.0, 2.0]] };
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
        let failure = state(&Spinner::default(), &start).unwrap_err().to_string();
        assert!(failure.contains("1 turn references") && failure.contains("13 elements"), "{failure}");
    }

    #[test]
    fn a_run_that_blows_up_says_where() {
        let mut spinner = Spinner { rate: f64::MAX, torque: 0.0 };
        let start = spinner.initial();
        let settings = Settings { t_end: 1.0, step: 0.1, correct_every: None, sample_every: 0.1 };
        let failure = run(&mut spinner, &settings, &start, |_| Ok(())).unwrap_err().to_string();
        assert!(failure.contains("orientation of body `rotor` is no longer finite"), "{failure}");
    }

    #[test]
    fn a_start_of_another_mechanism_is_refused() {
        let settings = Settings { t_end: 1.0, step: 0.1, correct_every: None, sample_every: 0.1 };
        let failure = run(&mut Spinner::default(), &settings, &Start::default(), |_| Ok(())).unwrap_err();
        assert!(failure.to_string().starts_with("the start has 0 positions"), "{failure}");
    }
}
