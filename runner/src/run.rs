//! The loop.

use crate::sample::Observer;
use crate::{Failure, Sample, Schedule, Segment, Settings, Summary, Tracker, describe};
use gyro_sim::{Direct, Partition, Partitioned, Scalar, Turns};
use std::io;
use std::time::{Duration, Instant};

/// Where a run starts and what is watched besides the joints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// `(r, p)` of each body with coordinates.
    pub positions: Vec<f64>,
    /// `(s, w')` of each body with coordinates.
    pub velocities: Vec<f64>,
    /// For each joint the angle that its continuous angle starts nearest to, rad; zero for joints without angle.
    pub angles: Vec<f64>,
    /// Indices of the bodies whose pose and velocity are sampled.
    pub observed_bodies: Vec<usize>,
}

/// What a run has to tell.
#[derive(Clone, Copy, Debug)]
pub enum Event<'a> {
    /// The mechanism at a sample time.
    Sample(&'a Sample),
    /// The run has reached this time, s. Comes every now and then, for a progress bar.
    Progress(f64),
}

/// Between two readings of the turns at most so many steps pass: the mean rate has to predict an angle to within half a
/// turn, and no integrator does well where a rate changes by half a turn within eight steps.
const STEPS_BETWEEN_READINGS: u64 = 8;

/// Time between two [`Event::Progress`].
const PROGRESS_EVERY: Duration = Duration::from_millis(100);

/// Runs a mechanism to a schedule and hands what happens to `tell`.
///
/// The first sample is the start as given, uncorrected. An error of `tell` ends the run.
///
/// # Errors
/// [`Failure::Run`] if a solver fails or the start does not fit the mechanism; [`Failure::Output`] from `tell`.
pub fn run<M: Partition>(
    mechanism: &M,
    settings: &Settings,
    start: &Start,
    mut tell: impl FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, Failure> {
    settings.check().map_err(|e| Failure::Run(e.to_string()))?;
    let mut run = Run::new(mechanism, state(mechanism, start)?, start);
    let mut tracker = Tracker::default();
    let mut last_told = Instant::now();
    let sample = run.sample(0.0);
    tracker.add(&sample);
    tell(Event::Sample(&sample))?;
    for segment in Schedule::new(settings) {
        run.advance(&segment).map_err(|e| Failure::Run(describe(mechanism, &e)))?;
        if segment.samples {
            let sample = run.sample(segment.to);
            tracker.add(&sample);
            tell(Event::Sample(&sample))?;
        }
        if last_told.elapsed() >= PROGRESS_EVERY {
            tell(Event::Progress(segment.to))?;
            last_told = Instant::now();
        }
    }
    tracker.finish(&mut run.summary);
    Ok(run.summary)
}

/// The state under way, with its solvers.
struct Run<'a, M: Partition> {
    mechanism: &'a M,
    y: M::State,
    direct: Direct<M::State>,
    partitioned: Partitioned<M>,
    turns: Turns<M>,
    observer: Observer<'a, M>,
    summary: Summary,
}

impl<'a, M: Partition> Run<'a, M> {
    fn new(mechanism: &'a M, y: M::State, start: &'a Start) -> Self {
        let angles: Vec<M::Scalar> = start.angles.iter().map(|&a| Scalar::constant(a)).collect();
        Self {
            mechanism,
            direct: Direct::new(&y),
            partitioned: Partitioned::new(mechanism, &y),
            turns: Turns::new(mechanism, &y, &angles),
            observer: Observer::new(mechanism, &start.observed_bodies),
            y,
            summary: Summary::default(),
        }
    }

    fn advance(&mut self, segment: &Segment) -> Result<(), gyro_sim::Error> {
        let began = Instant::now();
        self.integrate(segment)?;
        if segment.corrects {
            self.partitioned.correct(self.mechanism, Scalar::constant(segment.to), &mut self.y)?;
        }
        self.summary.run_time_s += began.elapsed().as_secs_f64();
        self.summary.steps += segment.n_steps;
        self.summary.chart_switches = self.partitioned.switches();
        Ok(())
    }

    #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
    fn integrate(&mut self, segment: &Segment) -> Result<(), gyro_sim::Error> {
        let h = (segment.to - segment.from) / segment.n_steps as f64;
        let mut done = 0;
        while done < segment.n_steps {
            let n_steps = (segment.n_steps - done).min(STEPS_BETWEEN_READINGS) as u32;
            let t = segment.from + done as f64 * h;
            let (t, step) = (Scalar::constant(t), M::Scalar::constant(h));
            self.direct.advance(self.mechanism, t, step, n_steps, &mut self.y)?;
            self.turns.update(self.mechanism, Scalar::constant(f64::from(n_steps) * h), &self.y);
            done += u64::from(n_steps);
        }
        Ok(())
    }

    /// The state may have been corrected since the turns were read: they are read again, no time having passed.
    fn sample(&mut self, t: f64) -> Sample {
        self.turns.update(self.mechanism, Scalar::constant(0.0), &self.y);
        self.observer.sample(t, &self.y, &self.turns, self.summary.chart_switches)
    }
}

/// The state of a start: `(q, v)`, then zero work where the mechanism counts work.
fn state<M: Partition>(mechanism: &M, start: &Start) -> Result<M::State, Failure> {
    let mut state = mechanism.start();
    let n_bodies = mechanism.n_bodies();
    let expected = (7 * n_bodies, 6 * n_bodies);
    if (start.positions.len(), start.velocities.len()) != expected
        || start.observed_bodies.iter().any(|&body| body >= n_bodies)
    {
        return Err(Failure::Run(format!(
            "the start has {} positions and {} velocities, the mechanism's {n_bodies} bodies have {} and {}",
            start.positions.len(),
            start.velocities.len(),
            expected.0,
            expected.1
        )));
    }
    let values = start.positions.iter().chain(&start.velocities).chain(std::iter::repeat(&0.0));
    for (element, value) in state.as_mut().iter_mut().zip(values) {
        *element = Scalar::constant(*value);
    }
    Ok(state)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::JointSample;
    use crate::spinner::Spinner;

    fn samples(rate: f64, settings: &Settings) -> (Vec<Sample>, Summary) {
        let (spinner, mut samples) = (Spinner { rate }, Vec::new());
        let summary = run(&spinner, settings, &spinner.initial(), |event| {
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
                let JointSample::Angle { position, .. } = samples.last().unwrap().joints[0] else {
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
    fn a_run_that_blows_up_says_where() {
        let spinner = Spinner { rate: f64::MAX };
        let settings = Settings { t_end: 1.0, step: 0.1, correct_every: None, sample_every: 0.1 };
        let failure = run(&spinner, &settings, &spinner.initial(), |_| Ok(())).unwrap_err().to_string();
        assert!(failure.contains("orientation of body `rotor` is no longer finite"), "{failure}");
    }

    #[test]
    fn a_start_of_another_mechanism_is_refused() {
        let settings = Settings { t_end: 1.0, step: 0.1, correct_every: None, sample_every: 0.1 };
        let failure = run(&Spinner { rate: 1.0 }, &settings, &Start::default(), |_| Ok(())).unwrap_err();
        assert!(failure.to_string().starts_with("the start has 0 positions"), "{failure}");
    }
}
