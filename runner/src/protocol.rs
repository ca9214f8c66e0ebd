//! How the command line and the program that it compiles speak with each other: lines of words and numbers.
//!
//! Numbers are printed with as many digits as it takes to read the same number back. The command line writes a
//! [`Request`] to the program's standard input; the program answers with [`Reply`] lines on its standard output, and
//! waits for the next.

use crate::motion::Linear;
use crate::{Approach, BodySample, Forecast, Input, JointSample, Sample, Settings, Start, Summary, Timing};
use gyro_sim::integrate::Work;
use gyro_sim::{Owner, Passage, Statistics};
use gyro_yardstick::Measured;
use std::fmt::Write as _;
use std::str::{FromStr, SplitAsciiWhitespace};

/// A run to be made.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    /// When to step, correct and sample.
    pub settings: Settings,
    /// By which method.
    pub approach: Approach,
    /// Values of the mechanism's parameters, in their order.
    pub parameters: Vec<f64>,
    /// Where to start.
    pub start: Start,
    /// How long the run may be repeated for its time, s; `None` if nobody asks for that.
    pub measure_for: Option<f64>,
}

/// The line after a request.
pub const END: &str = "end";

/// What stands for something that is not there.
const NONE: &str = "none";

/// One line of an answer.
#[derive(Clone, Debug, PartialEq)]
pub enum Reply {
    /// The mechanism at a sample time.
    Sample(Sample),
    /// The linearisation at the end.
    Linear(Linear),
    /// The last state before the run fails, and its time, s.
    Stopped(f64, Vec<f64>),
    /// The run has reached this time, s.
    Progress(f64),
    /// How long the run will take.
    Forecast(Forecast),
    /// What the run costs when nobody looks at it.
    Timed(Timing),
    /// The run is complete.
    Done(Summary),
    /// The run has failed: why, in words.
    Failed(String),
    /// The run cannot be made as it was asked for: why, in words.
    Refused(String),
}

/// A line that does not belong to the protocol.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Garbled(pub String);

impl std::fmt::Display for Garbled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "a line makes no sense: `{}`", self.0)
    }
}

impl std::error::Error for Garbled {}

impl Request {
    /// The request as text.
    pub fn to_text(&self) -> String {
        let Settings { t_end, step, correct_every, sample_every } = self.settings;
        let mut text = format!("settings {t_end:?} {step:?} {sample_every:?}\n");
        if let Some(every) = correct_every {
            let _ = writeln!(text, "correct_every {every:?}");
        }
        let Approach { integrator, tolerance, coordinates, correction, when, budget, patience, examine } =
            self.approach;
        let _ = writeln!(text, "integrator {integrator}\ncoordinates {coordinates}\ncorrection {correction}");
        let _ = tolerance.map(|tolerance| writeln!(text, "tolerance {tolerance:?}"));
        let _ = when.map(|when| writeln!(text, "when {when}"));
        let _ = budget.map(|budget| writeln!(text, "budget {budget}"));
        let _ = patience.map(|patience| writeln!(text, "patience {patience:?}"));
        let _ = writeln!(text, "examine {examine}");
        line(&mut text, "parameters", &self.parameters);
        line(&mut text, "positions", &self.start.positions);
        line(&mut text, "velocities", &self.start.velocities);
        line(&mut text, "turn_references", &self.start.turn_references);
        line(&mut text, "angles", &self.start.angles);
        line(&mut text, "observe", &self.start.observed_bodies);
        for input in &self.start.inputs {
            let _ = write!(text, "input {}", input.index);
            input.rows.iter().for_each(|row| words(&mut text, "", row));
            text.push('\n');
        }
        let _ = self.measure_for.map(|seconds| writeln!(text, "measure_for {seconds:?}"));
        text + END + "\n"
    }

    /// Reads a request.
    ///
    /// # Errors
    /// The line that is not understood.
    pub fn parse(text: &str) -> Result<Self, Garbled> {
        let settings = Settings { t_end: 0.0, step: 0.0, correct_every: None, sample_every: 0.0 };
        let approach = Approach::default();
        let start = Start::default();
        let mut request = Self { settings, approach, parameters: Vec::new(), start, measure_for: None };
        for line in text.lines() {
            request.take(line).ok_or_else(|| Garbled(line.to_owned()))?;
        }
        Ok(request)
    }

    fn take(&mut self, line: &str) -> Option<()> {
        let (key, values) = line.split_once(' ').unwrap_or((line, ""));
        match key {
            "settings" => {
                let [t_end, step, sample_every] = list(values)?.try_into().ok()?;
                self.settings = Settings { t_end, step, sample_every, ..self.settings };
            }
            "correct_every" => self.settings.correct_every = Some(values.parse().ok()?),
            "integrator" => self.approach.integrator = values.parse().ok()?,
            "tolerance" => self.approach.tolerance = Some(values.parse().ok()?),
            "coordinates" => self.approach.coordinates = values.parse().ok()?,
            "correction" => self.approach.correction = values.parse().ok()?,
            "when" => self.approach.when = Some(values.parse().ok()?),
            "examine" => self.approach.examine = values.parse().ok()?,
            "patience" => self.approach.patience = Some(values.parse().ok()?),
            "budget" => self.approach.budget = Some(values.parse().ok()?),
            "parameters" => self.parameters = list(values)?,
            "positions" => self.start.positions = list(values)?,
            "velocities" => self.start.velocities = list(values)?,
            "turn_references" => self.start.turn_references = list(values)?,
            "angles" => self.start.angles = list(values)?,
            "observe" => self.start.observed_bodies = list(values)?,
            "measure_for" => self.measure_for = Some(values.parse().ok()?),
            END => (),
            "input" => self.start.inputs.push(input(values)?),
            _ => return None,
        }
        Some(())
    }
}

impl Reply {
    /// The reply as one line, without its end.
    pub fn to_line(&self) -> String {
        match self {
            Self::Sample(sample) => sample_line(sample),
            Self::Linear(linear) => {
                let mut text =
                    format!("linear {:?} {} {}", linear.t, linear.state.len(), linear.by_inputs.len());
                for values in [&linear.state, &linear.slope, &linear.by_state, &linear.by_inputs] {
                    words(&mut text, "", values);
                }
                text
            }
            Self::Stopped(t, state) => {
                let mut text = format!("stopped {t:?}");
                words(&mut text, "", state);
                text
            }
            Self::Progress(t) => format!("progress {t:?}"),
            Self::Done(s) => {
                let mut text = format!("done {} {}", s.steps, s.chart_switches);
                words(&mut text, "", &[s.position_violation, s.velocity_violation, s.norm_violation]);
                words(&mut text, "", &[s.energy_drift, s.run_time_s]);
                statistics(&mut text, &s.statistics);
                words(&mut text, "", s.smallest_pivot.as_slice());
                text
            }
            Self::Timed(Timing { measured, statistics: met }) => {
                let mut text = format!("timed {}", measured.runs);
                words(&mut text, "", &[measured.seconds, measured.ratio]);
                statistics(&mut text, met);
                text
            }
            Self::Forecast(Forecast { steps, seconds }) => format!("forecast {steps:?} {seconds:?}"),
            Self::Failed(words) => format!("failed {}", words.replace('\n', " ")),
            Self::Refused(words) => format!("refused {}", words.replace('\n', " ")),
        }
    }

    /// Reads a line.
    ///
    /// # Errors
    /// The line, if it is not a reply.
    pub fn parse(line: &str) -> Result<Self, Garbled> {
        Self::understand(line).ok_or_else(|| Garbled(line.to_owned()))
    }

    fn understand(line: &str) -> Option<Self> {
        let (key, rest) = line.split_once(' ')?;
        let mut words = Words(rest.split_ascii_whitespace());
        let reply = match key {
            "sample" => Self::Sample(words.sample()?),
            "linear" => Self::Linear(words.linear()?),
            "progress" => Self::Progress(words.next()?),
            "timed" => Self::Timed(words.timing()?),
            "done" => Self::Done(words.summary()?),
            "forecast" => Self::Forecast(Forecast { steps: words.next()?, seconds: words.next()? }),
            "stopped" => return Some(Self::Stopped(words.next()?, words.rest()?)),
            "failed" => return Some(Self::Failed(rest.to_owned())),
            "refused" => return Some(Self::Refused(rest.to_owned())),
            _ => return None,
        };
        words.0.next().is_none().then_some(reply)
    }
}

/// The words of a line, read one by one.
struct Words<'a>(SplitAsciiWhitespace<'a>);

impl Words<'_> {
    fn next<T: FromStr>(&mut self) -> Option<T> {
        self.0.next()?.parse().ok()
    }

    fn array<const N: usize>(&mut self) -> Option<[f64; N]> {
        let mut array = [0.0; N];
        for value in &mut array {
            *value = self.next()?;
        }
        Some(array)
    }

    fn rest(self) -> Option<Vec<f64>> {
        self.0.map(|word| word.parse().ok()).collect()
    }

    fn list(&mut self, n: usize) -> Option<Vec<f64>> {
        (0..n).map(|_| self.next()).collect()
    }

    fn linear(&mut self) -> Option<Linear> {
        let (t, n, m): (f64, usize, usize) = (self.next()?, self.next()?, self.next()?);
        Some(Linear {
            t,
            state: self.list(n)?,
            slope: self.list(n)?,
            by_state: self.list(n * n)?,
            by_inputs: self.list(m)?,
        })
    }

    fn summary(&mut self) -> Option<Summary> {
        Some(Summary {
            steps: self.next()?,
            chart_switches: self.next()?,
            position_violation: self.next()?,
            velocity_violation: self.next()?,
            norm_violation: self.next()?,
            energy_drift: self.next()?,
            run_time_s: self.next()?,
            statistics: self.statistics()?,
            smallest_pivot: match self.0.next() {
                Some(word) => Some(word.parse().ok()?),
                None => None,
            },
        })
    }

    fn timing(&mut self) -> Option<Timing> {
        let measured = Measured { runs: self.next()?, seconds: self.next()?, ratio: self.next()? };
        Some(Timing { measured, statistics: self.statistics()? })
    }

    fn statistics(&mut self) -> Option<Statistics> {
        Some(Statistics {
            accepted: self.next()?,
            rejected: self.next()?,
            corrections: self.next()?,
            work: Work { evaluations: self.next()?, jacobians: self.next()? },
            limited_by_stability: self.next()?,
            fastest_rate: self.next()?,
            shortest_step: self.next()?,
            longest_step: self.next()?,
            leaps: self.next()?,
            passages: self.next()?,
            first_passage: self.passage()?,
        })
    }

    /// A passage, or a word that there is none.
    #[expect(clippy::option_option, reason = "a garbled line is no line without a passage")]
    fn passage(&mut self) -> Option<Option<Passage>> {
        let kind = self.0.next()?;
        if kind == NONE {
            return Some(None);
        }
        let index = self.next()?;
        let owner = match kind {
            "body" => Some(Owner::Body(index)),
            "joint" => Some(Owner::Joint(index)),
            "coupler" => Some(Owner::Coupler(index)),
            "driver" => Some(Owner::Driver(index)),
            "nobody" => None,
            _ => return None,
        };
        Some(Some(Passage { t: self.next()?, pivot: self.next()?, owner }))
    }

    fn sample(&mut self) -> Option<Sample> {
        let mut sample = Sample {
            t: self.next()?,
            kinetic: self.next()?,
            potential: self.next()?,
            work: self.next()?,
            position_violation: self.next()?,
            velocity_violation: self.next()?,
            norm_violation: self.next()?,
            chart_switches: self.next()?,
            coordinates: Vec::new(),
            outputs: Vec::new(),
            bodies: Vec::new(),
        };
        while let Some(kind) = self.0.next() {
            match kind {
                "angle" => {
                    let (position, rate) = (self.next()?, self.next()?);
                    sample.coordinates.push(JointSample::Angle { position, rate });
                }
                "length" => {
                    let (position, rate) = (self.next()?, self.next()?);
                    sample.coordinates.push(JointSample::Length { position, rate });
                }
                "orientation" => {
                    let (position, rate) = (self.array()?, self.array()?);
                    sample.coordinates.push(JointSample::Orientation { position, rate });
                }
                "output" => sample.outputs.push(self.next()?),
                "body" => sample.bodies.push(BodySample { pose: self.array()?, velocity: self.array()? }),
                _ => return None,
            }
        }
        Some(sample)
    }
}

fn statistics(text: &mut String, s: &Statistics) {
    let counts = [s.accepted, s.rejected, s.corrections, s.work.evaluations, s.work.jacobians];
    words(text, "", &counts);
    words(text, "", &[s.limited_by_stability]);
    words(text, "", &[s.fastest_rate, s.shortest_step, s.longest_step]);
    words(text, "", &[s.leaps, s.passages]);
    let Some(Passage { t, pivot, owner }) = s.first_passage else {
        let _ = write!(text, " {NONE}");
        return;
    };
    let (kind, index) = match owner {
        Some(Owner::Body(index)) => ("body", index),
        Some(Owner::Joint(index)) => ("joint", index),
        Some(Owner::Coupler(index)) => ("coupler", index),
        Some(Owner::Driver(index)) => ("driver", index),
        None => ("nobody", 0),
    };
    let _ = write!(text, " {kind} {index} {t:?} {pivot:?}");
}

/// One sample as a reply line, without its end.
pub(crate) fn sample_line(sample: &Sample) -> String {
    let mut text = format!("sample {:?}", sample.t);
    words(&mut text, "", &[sample.kinetic, sample.potential, sample.work]);
    words(&mut text, "", &[sample.position_violation, sample.velocity_violation, sample.norm_violation]);
    words(&mut text, "", &[sample.chart_switches]);
    for coordinate in &sample.coordinates {
        match coordinate {
            JointSample::Angle { position, rate } => words(&mut text, " angle", &[*position, *rate]),
            JointSample::Length { position, rate } => words(&mut text, " length", &[*position, *rate]),
            JointSample::Orientation { position, rate } => {
                words(&mut text, " orientation", position);
                words(&mut text, "", rate);
            }
        }
    }
    for output in &sample.outputs {
        words(&mut text, " output", &[*output]);
    }
    for body in &sample.bodies {
        words(&mut text, " body", &body.pose);
        words(&mut text, "", &body.velocity);
    }
    text
}

fn words<T: std::fmt::Debug>(text: &mut String, key: &str, values: &[T]) {
    text.push_str(key);
    for value in values {
        let _ = write!(text, " {value:?}");
    }
}

fn line<T: std::fmt::Debug>(text: &mut String, key: &str, values: &[T]) {
    words(text, key, values);
    text.push('\n');
}

/// The index of an input and the rows of its table.
fn input(text: &str) -> Option<Input> {
    let (index, rows) = text.split_once(' ').unwrap_or((text, ""));
    let numbers: Vec<f64> = list(rows)?;
    let (rows, rest) = numbers.as_chunks::<2>();
    rest.is_empty().then_some(Input { index: index.parse().ok()?, rows: rows.to_vec() })
}

fn list<T: FromStr>(text: &str) -> Option<Vec<T>> {
    text.split_ascii_whitespace().map(|word| word.parse().ok()).collect()
}

#[cfg(test)]
mod tests;
