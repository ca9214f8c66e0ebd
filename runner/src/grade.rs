//! How good a run is: what it is worth beside a companion, and what its own balance says.
//!
//! An error is held against the size of the motion. For a grade of *good* every coordinate is held against its own
//! motion, however small that is beside the others', and an angle against a radian at most; for *worthless* it has to
//! be lost beyond doubt. What is between is usable as far as its errors say.

use crate::companion::{Difference, departure, distance, gap, rate, size};
use crate::{BodySample, JointSample, Sample, Summary};
use gyro_sim::Passage;

/// What a run is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Grade {
    /// As accurate as it was asked to be, and to a thousandth of the motion at least.
    Good,
    /// The motion is there, with the errors that are told.
    Usable,
    /// The motion is another one.
    Worthless,
}

/// Why a run is not better than it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The error of a coordinate, in terms of its motion.
    Error(f64),
    /// The errors in units of the tolerance.
    Tolerance(f64),
    /// Energy that no work accounts for, in terms of the energy that moves.
    Energy(f64),
    /// The same where a companion whose balance closes has found the same motion: the work is wrong, the motion is not.
    Work(f64),
    /// The joints are apart by this part of the mechanism's size.
    Violation(f64),
    /// The smallest pivot of the constraints: near a singular pose a mechanism may go on in another way.
    Pivot(f64),
    /// Steps of fixed length have passed a singular pose; this is the first.
    Passage(Passage),
    /// The run and its companion end at these times, s.
    End([f64; 2]),
}

/// What a judgement depends on besides the runs.
#[derive(Clone, Copy, Debug)]
pub struct Measure {
    /// The tolerance of the run, if it has one.
    pub tolerance: Option<f64>,
    /// Length of the mechanism, m: by it lengths are compared with angles.
    pub size: f64,
    /// Whether all work is accounted for, so that the energy's balance has to close.
    pub is_balanced: bool,
}

/// What is known of a run.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// What it is worth.
    pub grade: Grade,
    /// What keeps it from being better, the gravest first.
    pub reasons: Vec<Reason>,
    /// Estimated errors of each joint coordinate, then of position and orientation of each observed body.
    pub errors: Vec<Difference>,
    /// The largest error in terms of the motion.
    pub relative: f64,
    /// The largest error in units of the tolerance.
    pub in_tolerances: f64,
    /// Up to when no coordinate is lost, s.
    pub until: f64,
    /// When the run ends, s.
    pub t_end: f64,
}

/// Errors up to this part of the motion are good.
const GOOD: f64 = 1e-3;
/// Beyond this part of it there is nothing left.
const LOST: f64 = 0.3;
/// Errors of steps add up to so many tolerances.
const TOLERANCES: f64 = 10.0;
/// An angle's error is held against no more than this, rad.
const RADIAN: f64 = 1.0;
/// A motion smaller than this is rest, and what is held against it rounding, rad or parts of the size, and per second.
pub(crate) const STILL: f64 = 1e-10;
/// A motion smaller than this part of the largest one is held against that for a grade of good.
const SMALL: f64 = 1e-6;
/// The same for a grade of worthless, at least and, under a coarse tolerance, at most.
const NEGLIGIBLE: [f64; 2] = [1e-3, 1e-2];
/// A smaller pivot is near a singular pose.
const SMALL_PIVOT: f64 = 1e-3;
/// Joints that are apart by this part of the mechanism's size make it another mechanism.
const APART: f64 = 0.1;

impl Grade {
    /// In one word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Usable => "usable",
            Self::Worthless => "worthless",
        }
    }
}

impl Reason {
    /// What the run is worth for this reason.
    pub fn grade(self) -> Grade {
        let (good, lost, value) = match self {
            Self::Error(_) => return Grade::Worthless,
            Self::Tolerance(times) => return if times <= TOLERANCES { Grade::Good } else { Grade::Usable },
            Self::Work(_) | Self::Passage(_) => return Grade::Usable,
            Self::Pivot(pivot) => return if pivot >= SMALL_PIVOT { Grade::Good } else { Grade::Usable },
            Self::Energy(drift) => (GOOD, LOST, drift),
            Self::Violation(violation) => (GOOD, APART, violation),
            Self::End([run, other]) => (GOOD, LOST, (run - other).abs() / other),
        };
        // What is not a number is worse than any.
        if value <= good {
            Grade::Good
        } else if value <= lost {
            Grade::Usable
        } else {
            Grade::Worthless
        }
    }
}

/// What a run says of itself, the gravest first: the energy's balance, where work is accounted for, and the joints.
pub fn balance(summary: &Summary, is_balanced: bool) -> Vec<Reason> {
    let energy = is_balanced.then_some(Reason::Energy(summary.energy_drift));
    let all = energy.into_iter().chain([Reason::Violation(summary.position_violation)]);
    sorted(all.filter(|reason| reason.grade() > Grade::Good).collect())
}

fn sorted(mut reasons: Vec<Reason>) -> Vec<Reason> {
    reasons.sort_by_key(|reason| std::cmp::Reverse(reason.grade()));
    reasons
}

/// Holds a run against a companion that has its samples, and more of them perhaps.
pub fn judge(
    (samples, summary): (&[Sample], &Summary),
    (others, other): (&[Sample], &Summary),
    measure: &Measure,
) -> Judgement {
    let (pairs, end) = paired(samples, others);
    let tracks = tracks(samples, others, &pairs);
    let scale = Scale::of(&tracks, measure);
    let relative = worst(tracks.iter().map(|track| scale.strict(track)));
    let lost = worst(tracks.iter().map(|track| scale.lenient(track)));
    let errors: Vec<Difference> = tracks.iter().map(Track::difference).collect();
    let tolerance = measure.tolerance.unwrap_or(1.0);
    let in_tolerances = worst(errors.iter().map(|error| error.in_tolerances(tolerance)));
    let is_lost = lost > LOST;
    let is_near = relative <= GOOD;
    // Work may be lost where the motion is not, as a companion shows whose own balance closes.
    let closes = balance(other, measure.is_balanced).is_empty();
    let excused = |reason| match reason {
        Reason::Energy(drift) if is_near && !is_lost && closes => Reason::Work(drift),
        other => other,
    };
    let mut reasons: Vec<Reason> = balance(summary, measure.is_balanced).into_iter().map(excused).collect();
    reasons.extend(measure.tolerance.map(|_| Reason::Tolerance(in_tolerances)));
    reasons.extend(summary.smallest_pivot.map(Reason::Pivot));
    reasons.extend(summary.statistics.first_passage.map(Reason::Passage));
    reasons.extend(end.map(Reason::End));
    reasons.retain(|reason| reason.grade() > Grade::Good);
    let of_errors = if is_lost {
        Grade::Worthless
    } else if is_near {
        Grade::Good
    } else {
        Grade::Usable
    };
    let grade = reasons.iter().map(|reason| reason.grade()).fold(of_errors, Grade::max);
    if is_lost {
        reasons.insert(0, Reason::Error(lost));
    }
    let times: Vec<f64> = pairs.iter().map(|(k, _)| samples[*k].t).collect();
    let until = scale.until(&tracks, &times);
    let t_end = samples.last().map_or(0.0, |sample| sample.t);
    Judgement { t_end, grade, reasons: sorted(reasons), errors, relative, in_tolerances, until }
}

/// What is not a number is worse than any.
fn worst(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |worst: f64, x| if x <= worst || worst.is_nan() { worst } else { x })
}

/// Times nearer than this part of the run are one.
const SAME: f64 = 1e-12;

/// Which samples of a run and of its companion belong together, by their times; and both ends, where they differ, as
/// they do where an event ends the runs. The last samples then belong together, wherever other samples are.
fn paired(samples: &[Sample], others: &[Sample]) -> (Vec<(usize, usize)>, Option<[f64; 2]>) {
    let slack = SAME * samples.last().map_or(0.0, |last| last.t);
    let (mut pairs, mut other) = (Vec::new(), 0);
    for (k, sample) in samples.iter().enumerate() {
        while others.get(other).is_some_and(|found| found.t < sample.t - slack) {
            other += 1;
        }
        if others.get(other).is_some_and(|found| found.t <= sample.t + slack) {
            pairs.push((k, other));
            other += 1;
        }
    }
    let (Some(last), Some(last_other)) = (samples.last(), others.last()) else { return (pairs, None) };
    let ends = [last.t, last_other.t];
    if (ends[0] - ends[1]).abs() <= slack {
        return (pairs, None);
    }
    // The earlier end may be at a sample of the other run, which is no end.
    let (k, other) = (samples.len() - 1, others.len() - 1);
    pairs.retain(|pair| pair.0 != k && pair.1 != other);
    pairs.push((k, other));
    (pairs, Some(ends))
}

/// One coordinate over the samples.
struct Track {
    is_length: bool,
    /// Errors of position and of rate at each sample of the run.
    errors: Vec<[f64; 2]>,
    /// How far the companion has gone and how fast it is, at each of its samples.
    moves: Vec<[f64; 2]>,
    /// The companion's largest position.
    size: f64,
}

/// Position and rate.
const POSITION: usize = 0;
const RATE: usize = 1;

impl Track {
    fn new(one: &[JointSample], other: &[JointSample], pairs: &[(usize, usize)]) -> Self {
        let still = [0.0; 3];
        let error = |(k, l): &(usize, usize)| {
            let (a, b) = (&one[*k], &other[*l]);
            [distance(a, b), gap(&rate(a), &rate(b))]
        };
        Self {
            is_length: matches!(other.first(), Some(JointSample::Length { .. })),
            errors: pairs.iter().map(error).collect(),
            moves: other.iter().map(|b| [departure(&other[0], b), gap(&rate(b), &still)]).collect(),
            size: worst(other.iter().map(size)),
        }
    }

    fn largest(numbers: &[[f64; 2]], which: usize) -> f64 {
        worst(numbers.iter().map(|pair| pair[which]))
    }

    #[expect(clippy::cast_precision_loss, reason = "a number of samples")]
    fn mean(numbers: &[[f64; 2]], which: usize) -> f64 {
        (numbers.iter().map(|pair| pair[which].powi(2)).sum::<f64>() / numbers.len().max(1) as f64).sqrt()
    }

    fn difference(&self) -> Difference {
        Difference {
            position: Self::largest(&self.errors, POSITION),
            rate: Self::largest(&self.errors, RATE),
            largest: [self.size, Self::largest(&self.moves, RATE)],
        }
    }
}

/// Joint coordinates, then the bodies that were observed.
fn tracks(samples: &[Sample], others: &[Sample], pairs: &[(usize, usize)]) -> Vec<Track> {
    let n = samples.first().map_or(0, |sample| sample.coordinates.len());
    let joints = (0..n).map(|k| {
        let of = |samples: &[Sample]| samples.iter().map(|s| s.coordinates[k]).collect::<Vec<_>>();
        Track::new(&of(samples), &of(others), pairs)
    });
    let n_bodies = samples.first().map_or(0, |sample| sample.bodies.len());
    let bodies = (0..n_bodies).flat_map(|k| {
        let of = |samples: &[Sample]| samples.iter().map(|s| s.bodies[k]).collect::<Vec<_>>();
        [of_body(&of(samples), &of(others), pairs), of_orientation(&of(samples), &of(others), pairs)]
    });
    joints.chain(bodies).collect()
}

fn of_body(one: &[BodySample], other: &[BodySample], pairs: &[(usize, usize)]) -> Track {
    let (r, s) = (
        |b: &BodySample| [b.pose[0], b.pose[1], b.pose[2]],
        |b: &BodySample| [b.velocity[0], b.velocity[1], b.velocity[2]],
    );
    let still = [0.0; 3];
    let error = |(k, l): &(usize, usize)| {
        let (a, b) = (&one[*k], &other[*l]);
        [gap(&r(a), &r(b)), gap(&s(a), &s(b))]
    };
    Track {
        is_length: true,
        errors: pairs.iter().map(error).collect(),
        moves: other.iter().map(|b| [gap(&r(b), &r(&other[0])), gap(&s(b), &still)]).collect(),
        size: worst(other.iter().map(|b| gap(&r(b), &still))),
    }
}

fn of_orientation(one: &[BodySample], other: &[BodySample], pairs: &[(usize, usize)]) -> Track {
    let orientation = |bodies: &[BodySample]| -> Vec<JointSample> {
        let of = |b: &BodySample| JointSample::Orientation {
            position: [b.pose[3], b.pose[4], b.pose[5], b.pose[6]],
            rate: [b.velocity[3], b.velocity[4], b.velocity[5]],
        };
        bodies.iter().map(of).collect()
    };
    Track::new(&orientation(one), &orientation(other), pairs)
}

/// The largest motion of the companion: what small ones are held against.
struct Scale {
    /// rad, and rad/s at most and on average.
    angle: f64,
    rate: f64,
    mean_rate: f64,
    size: f64,
    negligible: f64,
}

impl Scale {
    fn of(tracks: &[Track], measure: &Measure) -> Self {
        let size = if measure.size > 0.0 { measure.size } else { 1.0 };
        let all = |of: &dyn Fn(&Track) -> f64| {
            worst(tracks.iter().map(|track| if track.is_length { of(track) / size } else { of(track) }))
        };
        let [least, most] = NEGLIGIBLE;
        Self {
            angle: all(&|track| Track::largest(&track.moves, POSITION)).min(RADIAN),
            rate: all(&|track| Track::largest(&track.moves, RATE)),
            mean_rate: all(&|track| Track::mean(&track.moves, RATE)),
            size,
            negligible: measure
                .tolerance
                .map_or(least, |tolerance| (TOLERANCES * tolerance).clamp(least, most)),
        }
    }

    /// In the unit of a track.
    fn in_unit(&self, track: &Track, scale: f64) -> f64 {
        if track.is_length { scale * self.size } else { scale }
    }

    fn strict(&self, track: &Track) -> f64 {
        let motion = Track::largest(&track.moves, POSITION);
        let motion = if track.is_length { motion } else { motion.min(RADIAN) };
        let rates = Track::largest(&track.moves, RATE);
        let [position, rate] = [POSITION, RATE].map(|which| Track::largest(&track.errors, which));
        ratio(position, motion.max(self.in_unit(track, STILL.max(SMALL * self.angle))))
            .max(ratio(rate, rates.max(self.in_unit(track, STILL.max(SMALL * self.rate)))))
    }

    fn lenient(&self, track: &Track) -> f64 {
        let least = self.in_unit(track, STILL.max(self.negligible * self.mean_rate));
        let rate = Track::mean(&track.moves, RATE).max(least);
        ratio(Track::largest(&track.errors, POSITION), self.reach(track))
            .max(ratio(Track::mean(&track.errors, RATE), rate))
    }

    /// The motion that an error is held against before a coordinate counts as lost.
    fn reach(&self, track: &Track) -> f64 {
        Track::largest(&track.moves, POSITION)
            .max(self.in_unit(track, STILL.max(self.negligible * self.angle)))
    }

    /// The time of the last sample before a coordinate is lost.
    fn until(&self, tracks: &[Track], times: &[f64]) -> f64 {
        let is_lost =
            |k: usize| tracks.iter().any(|track| ratio(track.errors[k][POSITION], self.reach(track)) > LOST);
        (0..times.len()).take_while(|&k| !is_lost(k)).last().map_or(0.0, |k| times[k])
    }
}

/// Zero error is zero whatever its size is compared with; an undefined ratio counts as infinite.
fn ratio(error: f64, size: f64) -> f64 {
    let ratio = if error == 0.0 { 0.0 } else { error / size };
    if ratio.is_nan() { f64::INFINITY } else { ratio }
}

#[cfg(test)]
mod tests;
