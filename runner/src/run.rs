//! The loop.

mod advance;
mod control;
mod halt;
mod kinks;
mod sides;
mod start;
mod state;
mod watch;

use halt::Halt;
use kinks::Laws;
pub use start::Start;
pub(crate) use state::state;

use crate::advice::Plan;
use crate::control::{Controller, Controllers};
use crate::failure::behind;
use crate::forecast::{self, Forecast};
use crate::grade::STILL;
use crate::input::{any_varies, set};
use crate::motion::{self, Course, Linear, Motion, MotionBuilder, OperatingPoint};
use crate::offers::Offers;
use crate::path::Paths;
use crate::sample::{Observer, work_scale};
use crate::spectrum::fastest_rate;
use crate::watch::Watches;
use crate::{
    Approach, Coordinates, Correction, Failure, Input, Occurrence, Sample, Schedule, Settings, Summary,
    Tracker, describe_in,
};
use gyro_sim::{
    Control, CorrectedDynamics, Dynamics, Error, JointCoordinate, JointLayout, Partition, Real, Scalar,
    Turns, contact,
};
use sides::Sides;
use std::io;
use std::time::{Duration, Instant};

/// What a run has to tell.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// The mechanism at a sample time.
    Sample(&'a Sample),
    /// Something that has happened. They come in order of time, before the samples of the step in which they were.
    Occurred(&'a Occurrence),
    /// The last state, `(q, v)` and what follows them, and its time, s, before a solver fails.
    Stopped(f64, &'a [f64]),
    /// The linearisation at the end, if it is asked for and there is one.
    Linear(&'a Linear),
    /// The run fails at this time, s, as the scene is stiff for its method ([`Approach::leaves_stiff`]).
    Stiff(f64),
    /// How long the run will take. Comes before a long one of fixed steps.
    Forecast(Forecast),
    /// The run has reached this time, s. Comes every now and then, for a progress bar.
    Progress(f64),
}

/// Between two readings of the turns at most so many steps pass: the mean rate has to predict an angle to within half a
/// turn, and no integrator does well where a rate changes by half a turn within eight steps.
const STEPS_BETWEEN_READINGS: u64 = 8;

/// Time between two [`Event::Progress`].
const PROGRESS_EVERY: Duration = Duration::from_millis(100);

/// Runs a mechanism to a schedule by the paper's method, RK4 and coordinate partitioning, and hands what happens to
/// `tell`.
///
/// The first sample is the start as given, uncorrected. Where an input varies it is set anew before every step of fixed
/// length. An error of `tell` ends the run.
///
/// # Errors
/// [`Failure::Run`] if a solver fails or the start does not fit the mechanism; [`Failure::Output`] from `tell`.
pub fn run<M>(
    mechanism: &mut M,
    settings: &Settings,
    start: &Start,
    tell: impl FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, Failure>
where
    M: Partition<Scalar: Real> + Dynamics + CorrectedDynamics + Clone + 'static,
{
    run_by(mechanism, &motion::Any, (settings, &Approach::default()), start, tell)
}

/// The same by any approach for which there is a builder.
///
/// Under error control samples are interpolated, and steps end where an input is not smooth.
///
/// # Errors
/// As [`run`]; [`Failure::Run`] also if the approach does not suit the mechanism.
pub fn run_by<M: Partition<Scalar: Real> + Clone + 'static>(
    mechanism: &mut M,
    builder: &dyn MotionBuilder<M>,
    (settings, approach): (&Settings, &Approach),
    start: &Start,
    tell: impl FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, Failure> {
    let settings = scheduled(settings, approach);
    let offers = Offers {
        epsilon: <M::Scalar as Real>::EPSILON.to_f64(),
        inputs_vary: any_varies(&start.inputs) || !start.controllers.is_empty(),
        touches: !start.contacts.is_empty(),
        period: start.controllers.iter().map(Controller::period_s).reduce(f64::min),
        ..builder.offers()
    };
    if let Some(words) = offers.refusal(&settings, approach) {
        return Err(Failure::Refused(words));
    }
    let paths = Paths::new(&start.paths, approach.tolerance.is_none().then_some(settings.step));
    paths.set(mechanism);
    let y = state(mechanism, start)?;
    state::refuse_singular(mechanism, &y)?;
    set(mechanism, &start.inputs, 0.0);
    let mut told = Told { tell, last: Instant::now() };
    foretell(mechanism, builder, (&settings, approach), &y, &mut told)?;
    let motion = begin(builder, mechanism, approach, (&y, start))?;
    let mut run = Run::new(mechanism, motion, (y, start), approach, paths);
    let outcome = run.follow(builder, (&settings, approach), &mut told);
    run.finish();
    match outcome {
        Ok(()) => Ok(run.summary),
        Err(Halt::Output(error)) => Err(Failure::Output(error)),
        Err(Halt::Law(words)) => Err(Failure::run(words)),
        Err(Halt::Motion(error)) => {
            run.tell_state(&mut told).map_err(Failure::Output)?;
            let solver = match error {
                contact::Error::Solver(error) => Some(error),
                contact::Error::Jammed { .. } => None,
            };
            let is_singular = matches!(solver, Some(Error::Singular { .. }));
            let passed = run.summary.statistics.first_passage.filter(|_| !is_singular);
            let words = describe_in(run.mechanism, layout(run.mechanism, builder, approach), error)
                + &passed.map_or(String::new(), |passage| behind(run.mechanism, &passage));
            let plan = Plan { settings: &settings, approach, offers: &offers };
            if let (Some(Error::Stiff { t, .. }), true) = (solver, approach.leaves_stiff) {
                (told.tell)(Event::Stiff(t))?;
                return Err(Failure::run(words));
            }
            // The steps' length is asked about only where stability may limit it.
            let asks = matches!(solver, Some(Error::Stiff { .. } | Error::TooManySteps { .. }));
            if asks && builder.leaves_to_explain() {
                return Err(Failure::Unexplained(words));
            }
            let fastest =
                asks.then(|| run.linearised(builder, run.read_at)).flatten().as_ref().map(fastest_rate);
            let advice = solver.map(|error| plan.after(&error, &run.summary.statistics, fastest));
            Err(Failure::Run { words, advice: advice.unwrap_or_default() })
        }
    }
}

/// A motion from a maximal state at time zero, with the inputs as they are then.
pub(crate) fn begin<M: Partition<Scalar: Real> + Clone>(
    builder: &dyn MotionBuilder<M>,
    mechanism: &M,
    approach: &Approach,
    (y, start): (&M::State, &Start),
) -> Result<Box<dyn Motion<M>>, Failure> {
    let mut motion = builder.begin(mechanism, approach, y, &start.contacts).map_err(Failure::Refused)?;
    for input in &start.inputs {
        motion.set_input(input.index, input.at(0.0));
    }
    if approach.tolerance.is_some() {
        let copy = any_varies(&start.inputs).then(|| mechanism.clone());
        let paths = Paths::new(&start.paths, None);
        let knots: Vec<f64> = start.knots.iter().chain(paths.kinks()).copied().collect();
        motion.follow(copy, Course::new(&start.inputs, &knots));
    }
    Ok(motion)
}

/// Where the numbers of the integrated state stand, if it is a joint state.
pub(crate) fn layout<'a, M: Partition<Scalar: Real>>(
    mechanism: &'a M,
    builder: &dyn MotionBuilder<M>,
    approach: &Approach,
) -> Option<&'a JointLayout<'a>> {
    (approach.coordinates == Coordinates::Joint).then(|| builder.joint_layout(mechanism)).flatten()
}

/// Whoever is told, and when that was last about progress.
struct Told<F> {
    tell: F,
    last: Instant,
}

impl<F: FnMut(Event<'_>) -> io::Result<()>> Told<F> {
    fn progress(&mut self, t: f64) -> io::Result<()> {
        if self.last.elapsed() < PROGRESS_EVERY {
            return Ok(());
        }
        self.last = Instant::now();
        (self.tell)(Event::Progress(t))
    }
}

/// Says how long many fixed steps will take; refuses them where that is longer than anyone wants to wait.
fn foretell<M: Partition<Scalar: Real> + 'static, F: FnMut(Event<'_>) -> io::Result<()>>(
    mechanism: &M,
    builder: &dyn MotionBuilder<M>,
    (settings, approach): (&Settings, &Approach),
    y: &M::State,
    told: &mut Told<F>,
) -> Result<(), Failure> {
    #[expect(clippy::cast_precision_loss, reason = "a number of steps to be told")]
    let budget = approach.budget.map_or(f64::INFINITY, |budget| budget as f64);
    let steps = Schedule::steps(settings).min(budget);
    if approach.tolerance.is_some() || !forecast::is_long(steps) {
        return Ok(());
    }
    let motion = builder.begin(mechanism, approach, y, &[]).map_err(Failure::Refused)?;
    let Some(forecast) = forecast::forecast(mechanism, motion, (steps, settings.step)) else { return Ok(()) };
    (told.tell)(Event::Forecast(forecast))?;
    match approach.patience {
        Some(patience) if forecast.seconds > patience && approach.budget.is_none() => {
            Err(Failure::Refused(format!(
                "the run would take {:.3e} steps of {:e} s, {}: choose a longer --step; or, to make it all the same, give \
                 --budget {:.0}",
                forecast.steps,
                settings.step,
                forecast::duration_words(forecast.seconds),
                forecast.steps
            )))
        }
        _ => Ok(()),
    }
}

/// The schedule of an approach: its own corrections, or none to be scheduled, do not divide the run, nor do steps under
/// error control.
pub fn scheduled(settings: &Settings, approach: &Approach) -> Settings {
    let has_moments = approach.coordinates == Coordinates::Maximal
        && !matches!(approach.correction, Correction::None | Correction::Baumgarte(_))
        && approach.when.is_none()
        && approach.tolerance.is_none();
    // Under error control only samples divide it.
    let is_divided = approach.tolerance.is_none() || settings.t_end == 0.0;
    let step = if is_divided { settings.step } else { settings.t_end };
    Settings { correct_every: settings.correct_every.filter(|_| has_moments), step, ..*settings }
}

/// The state under way, with its solvers.
struct Run<'a, M: Partition<Scalar: Real>> {
    mechanism: &'a mut M,
    motion: Box<dyn Motion<M>>,
    inputs: &'a [Input],
    /// Times at which the mechanism's own motions are not smooth, s.
    own_knots: &'a [f64],
    /// The part of a step of fixed length at which inputs are taken.
    taken_at: f64,
    controllers: Controllers<M::Scalar>,
    watches: Watches<M::Scalar>,
    laws: Laws,
    paths: Paths,
    steps_at_once: u64,
    /// Fixed steps that may yet be taken; under error control the solver counts them.
    budget: u64,
    /// What it counts to.
    most_steps: u64,
    /// The maximal state when it was last looked at.
    y: M::State,
    sides: Sides,
    turns: Turns<M>,
    /// When the turns were last read, s.
    read_at: f64,
    observer: Observer<'a, M>,
    summary: Summary,
}

impl<'a, M: Partition<Scalar: Real> + Clone> Run<'a, M> {
    fn new(
        mechanism: &'a mut M,
        mut motion: Box<dyn Motion<M>>,
        (y, start): (M::State, &'a Start),
        approach: &Approach,
        paths: Paths,
    ) -> Self {
        let angles: Vec<M::Scalar> = start.angles.iter().map(|&a| Scalar::constant(a)).collect();
        Self {
            sides: Sides::of(mechanism, &mut *motion, &y),
            motion,
            inputs: &start.inputs,
            own_knots: &start.knots,
            taken_at: if approach.meets_knots { 0.5 } else { 0.0 },
            controllers: Controllers::new(&start.controllers),
            watches: Watches::new(&start.watches),
            laws: Laws::new(&start.kinks),
            steps_at_once: if any_varies(&start.inputs)
                || !start.watches.is_empty()
                || !start.kinks.is_empty()
                || !start.contacts.is_empty()
                || !paths.is_empty()
            {
                1
            } else {
                STEPS_BETWEEN_READINGS
            },
            paths,
            budget: approach.budget.unwrap_or(u64::MAX),
            most_steps: approach.budget.unwrap_or(Control::default().budget),
            turns: Turns::new(mechanism, Scalar::constant(0.0), &y, &angles),
            read_at: 0.0,
            observer: Observer::new(mechanism, &start.observed_bodies),
            mechanism,
            y,
            summary: Summary::default(),
        }
    }

    /// From the start, which is the first sample, to the end.
    fn follow<F: FnMut(Event<'_>) -> io::Result<()>>(
        &mut self,
        builder: &dyn MotionBuilder<M>,
        (settings, approach): (&Settings, &Approach),
        told: &mut Told<F>,
    ) -> Result<(), Halt> {
        let mut tracker = Tracker::default();
        self.record(0.0, (builder, approach), &mut tracker, told)?;
        self.count_kinks(0.0);
        let knots = if approach.meets_knots { self.knots() } else { Vec::new() };
        for segment in Schedule::new(settings).ending_at(knots) {
            match approach.tolerance {
                None => self.advance(&segment, told)?,
                Some(_) => self.advance_beyond(segment.to, (settings, approach), told)?,
            }
            if let Some(end) = self.watches.end.filter(|end| *end <= segment.to) {
                self.record(end, (builder, approach), &mut tracker, told)?;
                break;
            }
            if segment.samples {
                self.record(segment.to, (builder, approach), &mut tracker, told)?;
            }
            told.progress(segment.to)?;
        }
        if approach.tolerance.is_some() && self.motion.time() <= settings.t_end {
            self.count_kinks(self.read_at);
        }
        if let Some(linear) = approach.examine.then(|| self.linearised(builder, settings.t_end)).flatten() {
            (told.tell)(Event::Linear(&linear))?;
        }
        tracker.finish(&mut self.summary, approach.tolerance.unwrap_or(0.0).max(STILL));
        Ok(())
    }

    /// Takes a sample, follows what it says and hands it on.
    fn record<F: FnMut(Event<'_>) -> io::Result<()>>(
        &mut self,
        t: f64,
        (builder, approach): (&dyn MotionBuilder<M>, &Approach),
        tracker: &mut Tracker,
        told: &mut Told<F>,
    ) -> Result<(), Halt> {
        // Of a motion that is beyond this time what happened has been resolved.
        if self.motion.time() <= t {
            self.resolve(told)?;
        }
        let sample = self.sample(t)?;
        if t > 0.0 {
            self.look_at_pivots(builder, approach, t);
        }
        let scale = work_scale(self.mechanism, t, &self.y).max(sample.potential.abs());
        tracker.add(&sample, scale * <M::Scalar as Real>::EPSILON.to_f64());
        Ok((told.tell)(Event::Sample(&sample))?)
    }

    /// The joint form at the last state.
    fn linearised(&self, builder: &dyn MotionBuilder<M>, t: f64) -> Option<Linear> {
        let (angles, mut inputs) = (self.angles(), self.inputs.to_vec());
        let held = self.controllers.held().chain(self.paths.inputs());
        inputs.extend(held.map(|(index, value)| Input::constant(index, value)));
        builder.linearise(self.mechanism, &OperatingPoint { t, y: &self.y, angles: &angles, inputs: &inputs })
    }

    /// All times at which something is not smooth.
    fn knots(&self) -> Vec<f64> {
        let of_inputs = self.inputs.iter().flat_map(Input::knots);
        of_inputs.chain(self.own_knots.iter().chain(self.paths.kinks()).copied()).collect()
    }

    /// As inputs are in a step of this length.
    fn set_inputs(&mut self, h: f64) {
        let t = self.motion.time() + self.taken_at * h;
        set(self.mechanism, self.inputs, t);
        if any_varies(self.inputs) {
            for input in self.inputs {
                self.motion.set_input(input.index, input.at(t));
            }
        }
    }

    /// Between two readings the mean rate predicts each angle to within half a turn.
    fn read_turns(&mut self, t: f64) -> Result<(), Error> {
        self.look_at(t)?;
        let dt = t - self.read_at;
        self.turns.update(self.mechanism, Scalar::constant(t), Scalar::constant(dt), &self.y);
        self.read_at = t;
        Ok(())
    }

    /// Has the state and the inputs that the motion sets by itself as they are at a time within the last step.
    fn look_at(&mut self, t: f64) -> Result<(), Error> {
        self.motion.at(self.mechanism, t, &mut self.y)?;
        self.sides.set(self.y.as_mut());
        self.set_by_itself(t)?;
        Ok(())
    }

    /// The inputs that the motion sets by itself: outputs depend on them.
    fn set_by_itself(&mut self, t: f64) -> Result<Vec<(usize, M::Scalar)>, Error> {
        let mut found = Vec::new();
        self.motion.set_by_itself(self.mechanism, t, &mut |index, value| found.push((index, value)))?;
        for (index, value) in &found {
            self.mechanism.set_input(*index, *value);
        }
        Ok(found)
    }

    /// The state may have been corrected since the turns were read: they are read again.
    fn sample(&mut self, t: f64) -> Result<Sample, Error> {
        set(self.mechanism, self.inputs, t);
        if t > 0.0 {
            self.read_turns(t)?;
        }
        // Of a motion that is beyond this time controllers have acted.
        if self.motion.time() <= t {
            self.control()?;
        }
        let forces = self.set_by_itself(t)?;
        let sample =
            self.observer.sample(self.mechanism, t, &self.y, &self.turns, self.motion.chart_switches());
        let work = sample.work - self.motion.lost();
        let held = self.controllers.held().map(|(_, value)| value);
        let controlled = held.chain(forces.into_iter().map(|(_, force)| force.to_f64())).collect();
        Ok(Sample { work, controlled, ..sample })
    }

    /// The continuous angle of each coordinate at the last reading; zero for what is not an angle.
    fn angles(&self) -> Vec<f64> {
        let joints = 0..self.mechanism.description().joints.len();
        let all = joints.flat_map(|joint| {
            (0..self.mechanism.description().joints[joint].coordinates.len()).map(move |k| (joint, k))
        });
        let angle = |(joint, k)| match self.turns.coordinate(self.mechanism, joint, k) {
            Some(JointCoordinate::Angle { position, .. }) => position.to_f64(),
            _ => 0.0,
        };
        all.map(angle).collect()
    }

    fn look_at_pivots(&mut self, builder: &dyn MotionBuilder<M>, approach: &Approach, t: f64) {
        if let Some(pivot) =
            approach.examine.then(|| builder.smallest_pivot(self.mechanism, t, &self.y)).flatten()
        {
            let smallest = &mut self.summary.smallest_pivot;
            *smallest = Some(smallest.map_or(pivot, |before| before.min(pivot)));
        }
    }

    /// Hands on the state that the solver has kept, if it has one to show.
    fn tell_state<F: FnMut(Event<'_>) -> io::Result<()>>(&mut self, told: &mut Told<F>) -> io::Result<()> {
        let t = self.motion.time();
        if self.motion.at(self.mechanism, t, &mut self.y).is_err() {
            return Ok(());
        }
        self.sides.set(self.y.as_mut());
        let state: Vec<f64> = self.y.as_ref().iter().map(|x| x.to_f64()).collect();
        (told.tell)(Event::Stopped(t, &state))
    }

    fn finish(&mut self) {
        let statistics = self.motion.statistics();
        self.summary.steps = statistics.accepted;
        self.summary.chart_switches = self.motion.chart_switches();
        self.summary.statistics = statistics;
    }
}

#[cfg(test)]
mod tests;
