//! Motions along straight lines, whose velocities jump.

use gyro_sim::{Mechanism, Real, Scalar};
use nanoserde::{DeBin, SerBin};

/// Something driven that moves along straight lines through the rows of a table, on beyond the first and the last one.
///
/// Where the slope changes the velocity of the motion jumps: an impact on the mechanism. The mechanism has the motion
/// as `x + v (t − t0) + ½ a (t − t0)²` of four inputs, which the run sets at each kink.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Path {
    /// Indices of t0, x, v and a among the mechanism's inputs.
    pub inputs: [usize; 4],
    /// Time, s, and value; times ascend. At least two.
    pub rows: Vec<[f64; 2]>,
}

/// So large an acceleration that nothing else counts beside it. A power of two.
pub(crate) const LARGE: f64 = 1_099_511_627_776.0;

/// Slopes that differ by so many roundings are one.
const ROUNDINGS: f64 = 16.0;

/// A line: where it begins, s, its value there and its slope.
type Line = [f64; 3];

impl Path {
    fn line(&self, before: usize) -> Line {
        let [[t0, x0], [t1, x1]] = [self.rows[before], self.rows[before + 1]];
        [t0, x0, (x1 - x0) / (t1 - t0)]
    }

    /// The line that holds from a time on.
    fn at(&self, t: f64) -> Line {
        let after = self.rows.partition_point(|[time, _]| *time <= t);
        self.line(after.clamp(1, self.rows.len() - 1) - 1)
    }

    /// The inputs that hold from a time on: which they are, and their values.
    pub fn inputs_at(&self, t: f64) -> [(usize, f64); 4] {
        self.set_to(&self.at(t))
    }

    fn set_to(&self, [from, place, rate]: &Line) -> [(usize, f64); 4] {
        let [t0, x, v, a] = self.inputs;
        [(t0, *from), (x, *place), (v, *rate), (a, 0.0)]
    }

    fn kinks(&self) -> impl Iterator<Item = f64> {
        (1..self.rows.len() - 1).filter_map(|row| {
            let [before, after] = [self.line(row - 1), self.line(row)];
            let [t, x] = self.rows[row];
            let shortest = (t - before[0]).min(self.rows[row + 1][0] - t);
            let scale = before[2].abs() + after[2].abs() + x.abs() / shortest;
            ((after[2] - before[2]).abs() > ROUNDINGS * f64::EPSILON * scale).then_some(t)
        })
    }
}

/// The paths of a run, and the lines on which they are.
#[derive(Clone, Debug, Default)]
pub(crate) struct Paths {
    paths: Vec<Path>,
    lines: Vec<Line>,
    /// Times, s, ascending and after zero.
    kinks: Vec<f64>,
    passed: usize,
    /// A kink counts as reached so much before its time, s.
    slack: f64,
}

impl Paths {
    /// On the lines that hold at time zero; of steps of fixed length a thousand-millionth counts as nothing.
    pub(crate) fn new(paths: &[Path], step: Option<f64>) -> Self {
        let mut kinks: Vec<f64> = paths.iter().flat_map(Path::kinks).filter(|t| *t > 0.0).collect();
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        let lines = paths.iter().map(|path| path.at(0.0)).collect();
        Self { paths: paths.to_vec(), lines, kinks, passed: 0, slack: 1e-9 * step.unwrap_or(0.0) }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.paths.is_empty()
    }

    pub(crate) fn kinks(&self) -> &[f64] {
        &self.kinks
    }

    /// Whether the next kink has been reached.
    pub(crate) fn is_due<T: Real>(&self, t: f64) -> bool {
        let reached = t + self.slack + 4.0 * T::EPSILON.to_f64() * t.abs();
        self.kinks.get(self.passed).is_some_and(|kink| T::constant(*kink).to_f64() <= reached)
    }

    /// Goes on to the lines that hold from a time on, if there is a kink up to it; the slopes before and after, path
    /// by path.
    pub(crate) fn pass<T: Real>(&mut self, t: f64) -> Option<Vec<[f64; 2]>> {
        if !self.is_due::<T>(t) {
            return None;
        }
        while self.is_due::<T>(t) {
            self.passed += 1;
        }
        let kink = self.kinks[self.passed - 1];
        let turn = |(path, line): (&Path, &mut Line)| {
            let slope = line[2];
            let next = path.at(kink);
            // A row that is no kink is on the line as it is.
            if path.kinks().any(|own| own > line[0] && own <= kink) {
                *line = next;
            }
            [slope, line[2]]
        };
        Some(self.paths.iter().zip(&mut self.lines).map(turn).collect())
    }

    /// What the inputs are now.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = (usize, f64)> {
        self.paths.iter().zip(&self.lines).flat_map(|(path, line)| path.set_to(line))
    }

    /// Sets them.
    pub(crate) fn set<M: Mechanism>(&self, mechanism: &mut M) {
        for (index, value) in self.inputs() {
            mechanism.set_input(index, M::Scalar::constant(value));
        }
    }

    /// A mechanism on lines that begin at this time, at which accelerations change neither places nor rates; and the
    /// same driven by accelerations that are so large a multiple of how much each slope changes.
    pub(crate) fn pushed<M: Mechanism + Clone>(&self, mechanism: &M, t: f64, slopes: &[[f64; 2]]) -> [M; 2] {
        let mut still = mechanism.clone();
        for (path, [from, place, rate]) in self.paths.iter().zip(&self.lines) {
            for (index, value) in path.set_to(&[t, place + rate * (t - from), *rate]) {
                still.set_input(index, M::Scalar::constant(value));
            }
        }
        let mut pushed = still.clone();
        for (path, [before, after]) in self.paths.iter().zip(slopes) {
            pushed.set_input(path.inputs[3], M::Scalar::constant(LARGE * (after - before)));
        }
        [still, pushed]
    }
}
