//! Straight lines through the rows of a table: a motion whose velocity jumps.

use crate::kinematics::Scalar;
use crate::{Between, Body, BodyMotion, Driver, Model, Motion, Parameter, Rational};
use num_traits::Zero;

/// A motion along straight lines through given points, on beyond the first and the last one.
///
/// Where the slope changes, at a *kink*, the velocity of the motion jumps: an impact. Between two kinks the motion is
/// `x + v (t − t0) + ½ a (t − t0)²` with an acceleration a of zero. These four numbers are inputs of the model, which
/// a run sets at each kink; by the acceleration it asks how the mechanism answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    /// Where the table was read, for messages and documentation.
    pub source: String,
    /// Times, s, ascending, and values. At least two.
    pub rows: Vec<[f64; 2]>,
    /// Indices into [`Model::inputs`] of t0, x, v and a.
    pub inputs: [usize; 4],
}

/// What the inputs of [`Lines`] are called, after the name of the driver or body.
const NAMES: [&str; 4] = ["from", "place", "rate", "acceleration"];

impl Lines {
    /// The straight lines through these points; the inputs are not known yet.
    ///
    /// # Errors
    /// Says what is wrong with the points: a slope that cannot be computed.
    pub(crate) fn through(source: String, points: &[(f64, f64)]) -> Result<Self, String> {
        let rows: Vec<[f64; 2]> = points.iter().map(|&(t, x)| [t, x]).collect();
        let lines = Self { source, rows, inputs: [0; 4] };
        if lines.rows.windows(2).all(|pair| slope(pair).is_finite()) {
            Ok(lines)
        } else {
            Err("neighbouring rows are too close or too far apart for a line".to_owned())
        }
    }

    /// The line that holds from a time on: where it begins, s, its value there and its slope.
    pub fn piece(&self, t: f64) -> [f64; 3] {
        let after = self.rows.partition_point(|[time, _]| *time <= t).clamp(1, self.rows.len() - 1);
        let pair = &self.rows[after - 1..=after];
        [pair[0][0], pair[0][1], slope(pair)]
    }

    /// The motion over any scalar.
    pub(crate) fn at<D: Scalar>(&self, t: D) -> D {
        let [from, place, rate] = self.piece(t.re());
        (t - from) * rate + place
    }
}

fn slope(pair: &[[f64; 2]]) -> f64 {
    (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])
}

impl Motion {
    /// All straight lines that are part of it.
    fn lines(&self) -> Vec<&Lines> {
        match self {
            Self::Polynomial(_) | Self::Sinusoid { .. } | Self::Table(_) => Vec::new(),
            Self::Sum(parts) | Self::Product(parts) => parts.iter().flat_map(Self::lines).collect(),
            Self::Lines(lines) => vec![lines],
        }
    }

    fn lines_mut(&mut self) -> Vec<&mut Lines> {
        match self {
            Self::Polynomial(_) | Self::Sinusoid { .. } | Self::Table(_) => Vec::new(),
            Self::Sum(parts) | Self::Product(parts) => parts.iter_mut().flat_map(Self::lines_mut).collect(),
            Self::Lines(lines) => vec![lines],
        }
    }
}

impl BodyMotion {
    fn parts(&self) -> impl Iterator<Item = &Motion> {
        self.translation.iter().chain(self.rotations.iter().map(|(_, angle)| angle))
    }

    fn parts_mut(&mut self) -> impl Iterator<Item = &mut Motion> {
        self.translation.iter_mut().chain(self.rotations.iter_mut().map(|(_, angle)| angle))
    }
}

impl Model {
    /// All motions along straight lines, each with the name of the driver or body that moves so.
    pub fn lines(&self) -> Vec<(&str, &Lines)> {
        let of_drivers = self
            .drivers
            .iter()
            .flat_map(|driver| driver.motion.lines().into_iter().map(|lines| (driver.name.as_str(), lines)));
        let of_bodies = self.bodies.iter().flat_map(|body| {
            let parts = body.motion.iter().flat_map(BodyMotion::parts).flat_map(Motion::lines);
            parts.map(|lines| (body.name.as_str(), lines))
        });
        of_drivers.chain(of_bodies).collect()
    }
}

/// Gives each motion along straight lines its inputs, whose values are those of the line that holds at time zero; what
/// they are called is unlike the names that are taken. The first of them is the one after those that there are.
pub(crate) fn add_inputs(
    (bodies, drivers): (&mut [Body], &mut [Driver]),
    taken: &[&str],
    (inputs, between): (&mut Vec<Parameter>, &mut Vec<Between>),
) {
    for (owner, lines) in all(bodies, drivers) {
        let [from, place, rate] = lines.piece(0.0);
        for ((k, what), value) in NAMES.iter().enumerate().zip([from, place, rate, 0.0]) {
            let is_taken = |name: &String| {
                taken.contains(&name.as_str()) || inputs.iter().any(|input| input.name == *name)
            };
            let mut name = format!("{owner}_{what}");
            for n in 2.. {
                if !is_taken(&name) {
                    break;
                }
                name = format!("{owner}_{what}_{n}");
            }
            lines.inputs[k] = inputs.len();
            let value = Rational::from_float(value).unwrap_or_else(Rational::zero);
            inputs.push(Parameter { name, value });
            between.push(Between::Held);
        }
    }
}

/// How many inputs that will be.
pub(crate) fn n_inputs((bodies, drivers): (&mut [Body], &mut [Driver])) -> usize {
    NAMES.len() * all(bodies, drivers).len()
}

/// All motions along straight lines, in the order of [`Model::lines`].
fn all<'m>(bodies: &'m mut [Body], drivers: &'m mut [Driver]) -> Vec<(&'m str, &'m mut Lines)> {
    let mut found = Vec::new();
    for Driver { name, motion, .. } in drivers {
        found.extend(motion.lines_mut().into_iter().map(|lines| (name.as_str(), lines)));
    }
    for Body { name, motion, .. } in bodies {
        for part in motion.iter_mut().flat_map(BodyMotion::parts_mut) {
            found.extend(part.lines_mut().into_iter().map(|lines| (name.as_str(), lines)));
        }
    }
    found
}
