//! What is kept of a scenario.

use gyro_runner::{Sample, Schedule, Settings};
use gyro_sim::JointCoordinate;
use nanoserde::{DeBin, SerBin};

/// A number of every sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, SerBin, DeBin)]
pub enum Quantity {
    /// A scalar coordinate, by its index among [`Sample::coordinates`].
    Position(usize),
    /// Its rate.
    Rate(usize),
    /// An Euler parameter of an orientation.
    Orientation(usize, usize),
    /// A component of its angular velocity.
    OrientationRate(usize, usize),
    /// A number of the outputs.
    Output(usize),
    /// A number of an observed body's `(r, p)`.
    Pose(usize, usize),
    /// A number of its `(s, w')`.
    Velocity(usize, usize),
    /// Kinetic energy.
    Kinetic,
    /// Potential energy.
    Potential,
    /// Their sum.
    Energy,
    /// Work of non-conservative forces and drivers.
    Work,
    /// The worst violation of a constraint.
    Violation,
}

impl Quantity {
    /// Its value in a sample.
    pub fn of(self, sample: &Sample) -> f64 {
        use JointCoordinate::{Angle, Length, Orientation};
        match self {
            Self::Position(index) => match &sample.coordinates[index] {
                Angle { position, .. } | Length { position, .. } => *position,
                Orientation { .. } => f64::NAN,
            },
            Self::Rate(index) => match &sample.coordinates[index] {
                Angle { rate, .. } | Length { rate, .. } => *rate,
                Orientation { .. } => f64::NAN,
            },
            Self::Orientation(index, component) => match &sample.coordinates[index] {
                Orientation { position, .. } => position[component],
                Angle { .. } | Length { .. } => f64::NAN,
            },
            Self::OrientationRate(index, component) => match &sample.coordinates[index] {
                Orientation { rate, .. } => rate[component],
                Angle { .. } | Length { .. } => f64::NAN,
            },
            Self::Output(index) => sample.outputs[index],
            Self::Pose(body, component) => sample.bodies[body].pose[component],
            Self::Velocity(body, component) => sample.bodies[body].velocity[component],
            Self::Kinetic => sample.kinetic,
            Self::Potential => sample.potential,
            Self::Energy => sample.energy(),
            Self::Work => sample.work,
            Self::Violation => sample.position_violation,
        }
    }
}

/// The first time that a quantity passes a level.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub struct Passage {
    /// Index of the quantity among [`Keep::columns`].
    pub column: usize,
    /// The level.
    pub level: f64,
    /// Whether it is passed upwards.
    pub rises: bool,
}

/// What is kept of each scenario: all that it says is said of samples, and of lines between them.
#[derive(Clone, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Keep {
    /// The quantities that are looked at.
    pub columns: Vec<Quantity>,
    /// Those of which the last value is kept; indices of columns, as below.
    pub finals: Vec<usize>,
    /// Those of which the smallest and the largest are.
    pub extremes: Vec<usize>,
    /// First passages, s; NaN where there is none.
    pub passages: Vec<Passage>,
    /// Whether the estimated error is a number of each scenario, in parts of the motion.
    pub estimate: bool,
    /// Joints and their coordinates of which it is kept how far the assembly of the start has moved them.
    pub moved: Vec<(usize, usize)>,
    /// Those of which all samples are kept.
    pub series: Vec<usize>,
    /// Targets of the plan by which last values, extremes, passages and the series in `sloped` are differentiated.
    pub by: Vec<usize>,
    /// The columns of series that are differentiated, too.
    pub sloped: Vec<usize>,
}

impl Keep {
    /// How many numbers are kept of a scenario besides series.
    pub fn numbers(&self) -> usize {
        self.sloped_numbers() + usize::from(self.estimate) + self.moved.len()
    }

    /// How many of them are differentiated where any are: they come first.
    pub fn sloped_numbers(&self) -> usize {
        self.finals.len() + 2 * self.extremes.len() + self.passages.len()
    }

    /// Whether of samples before the last one nothing is kept.
    pub fn reads_the_end_alone(&self) -> bool {
        self.extremes.is_empty() && self.passages.is_empty() && self.series.is_empty() && !self.estimate
    }

    /// How many derivatives are kept of a scenario besides those of series.
    pub fn slopes(&self) -> usize {
        self.sloped_numbers() * self.by.len()
    }

    /// How many derivatives of series are kept of a sample.
    pub fn series_slopes(&self) -> usize {
        self.sloped.len() * self.by.len()
    }

    /// How many numbers are kept of a scenario with so many samples.
    pub fn width(&self, samples: usize) -> usize {
        self.numbers() + self.slopes() + (self.series_slopes() + self.series.len()) * samples
    }

    /// The numbers of a scenario with so many samples apart: those besides series with their derivatives; derivatives
    /// of series; series. The latter are sample after sample.
    pub fn apart<'n>(&self, numbers: &'n [f64], samples: usize) -> [&'n [f64]; 3] {
        let (numbers, rest) = numbers.split_at(self.numbers() + self.slopes());
        let (slopes, series) = rest.split_at(self.series_slopes() * samples);
        [numbers, slopes, series]
    }
}

/// The times of a run's samples, s.
pub fn sample_times(settings: &Settings) -> Vec<f64> {
    let later = Schedule::new(settings).filter(|segment| segment.samples).map(|segment| segment.to);
    std::iter::once(0.0).chain(later).collect()
}

/// Follows a scenario from sample to sample.
#[derive(Clone, Debug)]
pub struct Keeper<'a> {
    keep: &'a Keep,
    samples: usize,
    /// Time and quantities of the last sample.
    t: f64,
    last: Vec<f64>,
    now: Vec<f64>,
    extremes: Vec<[f64; 2]>,
    passages: Vec<f64>,
    /// Sample after sample.
    series: Vec<f64>,
    /// The estimated error.
    pub estimate: f64,
    /// How far the assembly of the start has moved coordinates.
    pub moved: Vec<f64>,
}

impl<'a> Keeper<'a> {
    /// For scenarios with so many samples.
    pub fn new(keep: &'a Keep, samples: usize) -> Self {
        Self {
            keep,
            samples,
            t: f64::NAN,
            last: vec![f64::NAN; keep.columns.len()],
            now: vec![f64::NAN; keep.columns.len()],
            extremes: vec![[f64::INFINITY, f64::NEG_INFINITY]; keep.extremes.len()],
            passages: vec![f64::NAN; keep.passages.len()],
            series: Vec::with_capacity(keep.series.len() * samples),
            estimate: f64::NAN,
            moved: Vec::new(),
        }
    }

    /// Forgets the scenario, for the next one.
    pub fn clear(&mut self) {
        self.t = f64::NAN;
        self.last.fill(f64::NAN);
        self.extremes.fill([f64::INFINITY, f64::NEG_INFINITY]);
        self.passages.fill(f64::NAN);
        self.series.clear();
        self.estimate = f64::NAN;
    }

    /// Takes a sample.
    pub fn sample(&mut self, sample: &Sample) {
        self.take(sample.t, |quantity| quantity.of(sample));
    }

    /// Takes the quantities of a sample, each by its place among the columns.
    pub fn take(&mut self, t: f64, mut value: impl FnMut(Quantity) -> f64) {
        for (now, column) in self.now.iter_mut().zip(&self.keep.columns) {
            *now = value(*column);
        }
        self.follow(t);
    }

    /// The same by index.
    pub(crate) fn take_columns(&mut self, t: f64, value: impl Fn(usize) -> f64) {
        self.now.iter_mut().enumerate().for_each(|(column, now)| *now = value(column));
        self.follow(t);
    }

    fn follow(&mut self, t: f64) {
        let (keep, now) = (self.keep, &self.now);
        for ([low, high], column) in self.extremes.iter_mut().zip(&keep.extremes) {
            (*low, *high) = (low.min(now[*column]), high.max(now[*column]));
        }
        for (passed, passage) in self.passages.iter_mut().zip(&keep.passages) {
            if passed.is_nan() {
                *passed = passage.between((self.t, self.last[passage.column]), (t, now[passage.column]));
            }
        }
        self.series.extend(keep.series.iter().map(|column| now[*column]));
        self.t = t;
        std::mem::swap(&mut self.last, &mut self.now);
    }

    /// Appends what is kept: final values, extremes, passages, the estimate, moves, series. Of a scenario that failed
    /// there is its series up to there and nothing else.
    pub fn finish(&mut self, is_complete: bool, numbers: &mut Vec<f64>) {
        let start = numbers.len();
        if is_complete {
            numbers.extend(self.keep.finals.iter().map(|column| self.last[*column]));
            numbers.extend(self.extremes.iter().flatten());
            numbers.extend(&self.passages);
            numbers.extend(self.keep.estimate.then_some(self.estimate));
            numbers.extend(&self.moved);
        }
        numbers.resize(start + self.keep.numbers(), f64::NAN);
        numbers.extend(&self.series);
        numbers.resize(start + self.keep.width(self.samples), f64::NAN);
        self.clear();
    }
}

impl Passage {
    /// When a line from one point to another passes the level; NaN if it does not.
    pub(crate) fn between(&self, (t, before): (f64, f64), (to, now): (f64, f64)) -> f64 {
        let is_beyond = |value: f64| if self.rises { value >= self.level } else { value <= self.level };
        if !is_beyond(now) {
            return f64::NAN;
        }
        if before.is_nan() || is_beyond(before) {
            return to;
        }
        t + (to - t) * ((self.level - before) / (now - before)).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests;
