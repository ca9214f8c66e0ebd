//! When to step, to correct and to sample.

use nanoserde::{DeBin, SerBin};
use std::fmt;

/// How a run is to be made; all times in seconds.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub struct Settings {
    /// Length of the run. One of 0 has the start as its only sample.
    pub t_end: f64,
    /// Largest step of the integrator.
    pub step: f64,
    /// Interval between corrections of the coordinate partition; `None` for direct integration.
    pub correct_every: Option<f64>,
    /// Interval between samples.
    pub sample_every: f64,
}

/// Why settings cannot be followed.
#[derive(Clone, Debug, PartialEq)]
pub enum Impossible {
    /// A setting is not a positive number of seconds, or a time that nobody waits for.
    NoTime {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
    },
    /// The run would take more steps, corrections or samples than anyone can wait for or store.
    TooMany {
        /// What there are too many of.
        what: &'static str,
        /// Their number.
        number: f64,
        /// The largest that is accepted.
        most: f64,
    },
}

/// A stretch of equal steps between two events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it starts, s.
    pub from: f64,
    /// Where it ends, s.
    pub to: f64,
    /// Number of equal steps.
    pub n_steps: u64,
    /// Whether the dependent coordinates are corrected at its end.
    pub corrects: bool,
    /// Whether a sample is taken at its end, after the correction.
    pub samples: bool,
}

/// The segments of a run in their order. The sample at time zero belongs to none.
#[derive(Clone, Debug)]
pub struct Schedule {
    settings: Settings,
    now: f64,
    next_sample: u64,
    next_correction: u64,
    /// Further times at which steps end, ascending.
    knots: Vec<f64>,
}

/// The longest time that a setting may be, s: thirty million years, far from the ends of `f64`.
const LONGEST: f64 = 1e15;

/// A year of steps at a microsecond each is 3e13.
const MOST_STEPS: f64 = 1e13;

/// Samples are kept in memory: ten million take a few gigabytes.
const MOST_SAMPLES: f64 = 1e7;

/// Events of a run that are gone through to count its steps.
const MOST_COUNTED: f64 = 1e6;

/// Times closer than this part of a step are one; an interval that is longer by this part of a step than whole steps
/// takes no further step.
const COINCIDENT: f64 = 1e-9;

impl Settings {
    /// Says why the settings cannot be followed, if so.
    ///
    /// # Errors
    /// [`Impossible`], for the first setting that cannot be followed.
    pub fn check(&self) -> Result<(), Impossible> {
        if self.t_end != 0.0 {
            positive("t_end", self.t_end)?;
        }
        positive("step", self.step)?;
        positive("sample_every", self.sample_every)?;
        at_most("samples", self.t_end / self.sample_every, MOST_SAMPLES)?;
        at_most("steps", self.t_end / self.step, MOST_STEPS)?;
        let Some(correct_every) = self.correct_every else { return Ok(()) };
        positive("correct_every", correct_every)?;
        at_most("corrections", self.t_end / correct_every, MOST_STEPS)
    }
}

impl Schedule {
    /// The schedule of checked settings.
    pub fn new(settings: &Settings) -> Self {
        Self { settings: *settings, now: 0.0, next_sample: 1, next_correction: 1, knots: Vec::new() }
    }

    /// The same with steps that end at these times, too.
    pub(crate) fn ending_at(mut self, mut knots: Vec<f64>) -> Self {
        knots.sort_by(f64::total_cmp);
        self.knots = knots;
        self
    }

    /// The next of these times.
    fn knot(&self) -> f64 {
        let now = self.now + self.tolerance(self.now);
        self.knots.get(self.knots.partition_point(|knot| *knot <= now)).copied().unwrap_or(f64::INFINITY)
    }

    /// Steps of a whole run: counted where there are few events, and at most so many where there are more.
    #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
    pub fn steps(settings: &Settings) -> f64 {
        let Settings { t_end, step, correct_every, sample_every } = *settings;
        let events = t_end / sample_every + correct_every.map_or(0.0, |every| t_end / every) + 1.0;
        if events > MOST_COUNTED {
            return (t_end / step).ceil() + events.ceil();
        }
        Self::new(settings).map(|segment| segment.n_steps as f64).sum()
    }

    /// How near two times count as one: part of a step, or what rounding makes of `k · interval` late in a long run.
    fn tolerance(&self, t: f64) -> f64 {
        (COINCIDENT * self.settings.step).max(4.0 * f64::EPSILON * t)
    }

    fn n_steps(&self, to: f64) -> u64 {
        let length = to - self.now;
        let spare = (COINCIDENT * length).max(self.tolerance(to));
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a count from one to 1e13"
        )]
        let n_steps = ((length - spare) / self.settings.step).ceil().max(1.0) as u64;
        n_steps
    }
}

impl Iterator for Schedule {
    type Item = Segment;

    fn next(&mut self) -> Option<Segment> {
        let Settings { t_end, correct_every, sample_every, .. } = self.settings;
        if self.now >= t_end {
            return None;
        }
        let sample = multiple(self.next_sample, sample_every);
        let correction = correct_every.map_or(f64::INFINITY, |every| multiple(self.next_correction, every));
        let earliest = sample.min(correction).min(t_end).min(self.knot());
        let is_due = |t: f64| t - earliest <= self.tolerance(earliest);
        let (ends, samples, corrects) = (is_due(t_end), is_due(sample), is_due(correction));
        let to = match (ends, samples, corrects) {
            (true, ..) => t_end,
            (false, true, _) => sample,
            (false, false, true) => correction,
            (false, false, false) => earliest,
        };
        let segment =
            Segment { from: self.now, to, n_steps: self.n_steps(to), corrects, samples: samples || ends };
        self.next_sample += u64::from(samples);
        self.next_correction += u64::from(corrects);
        self.now = to;
        Some(segment)
    }
}

impl fmt::Display for Impossible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoTime { setting, value } => {
                write!(f, "{setting} is {value:?}: a positive number of seconds was expected")?;
                if *value > LONGEST { write!(f, ", at most {LONGEST:e}") } else { Ok(()) }
            }
            Self::TooMany { what, number, most } => {
                write!(f, "the run would have {number:.3e} {what}: at most {most:e} are accepted")
            }
        }
    }
}

impl std::error::Error for Impossible {}

/// Times are multiples, never sums, so that rounding does not accumulate.
#[expect(clippy::cast_precision_loss, reason = "indices of events stay below 2⁵³")]
fn multiple(index: u64, interval: f64) -> f64 {
    index as f64 * interval
}

fn positive(setting: &'static str, value: f64) -> Result<(), Impossible> {
    if value > 0.0 && value <= LONGEST { Ok(()) } else { Err(Impossible::NoTime { setting, value }) }
}

fn at_most(what: &'static str, number: f64, most: f64) -> Result<(), Impossible> {
    if number <= most { Ok(()) } else { Err(Impossible::TooMany { what, number, most }) }
}

#[cfg(test)]
mod tests;
