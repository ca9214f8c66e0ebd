//! Which values the varied quantities have in scenario k.

use crate::draw::Draw;
use crate::sobol::Sobol;
use chacha20::ChaCha8Rng;
use chacha20::rand_core::{Rng, SeedableRng};
use gyro_runner::Input;
use nanoserde::{DeBin, SerBin};

/// What a study varies, and how: scenario k is a function of this and of k.
///
/// Axes make a grid, the last of them the fastest. What is drawn is drawn anew for each scenario.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Plan {
    /// Seed of what is drawn.
    pub seed: u64,
    /// Which uniform numbers stand behind what is drawn.
    pub sampling: Sampling,
    /// What is varied.
    pub targets: Vec<Target>,
    /// Grids and lists.
    pub axes: Vec<Axis>,
    /// What is drawn at random.
    pub draws: Vec<Draw>,
    /// How many times the whole grid is run, each time with other draws.
    pub repeats: u64,
}

/// Uniform numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, SerBin, DeBin)]
pub enum Sampling {
    /// Those of ChaCha with eight rounds, a stream for each scenario.
    #[default]
    Random,
    /// Sobol's points with a random digital shift.
    Sobol,
    /// The same in Saltelli's scheme for indices of sensitivity: of two points a and b scenarios come in groups of
    /// d + 2: a, b, and for each of the d draws a with b's values of that draw.
    Saltelli,
}

/// A quantity that varies.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Target {
    /// A parameter, by its index.
    Parameter(usize),
    /// An input, by its index.
    Input(usize),
    /// An input that follows one of these tables: the value is the table's number.
    Table(Vec<Input>),
    /// Where a joint's coordinate starts, rad or m: joint and coordinate.
    Start(usize, usize),
    /// The rate at which it starts.
    StartRate(usize, usize),
}

/// Some targets that take given values together.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Axis {
    /// Indices of the targets.
    pub targets: Vec<usize>,
    /// One value for each target in each row.
    pub rows: Vec<Vec<f64>>,
}

impl Plan {
    /// Points of the grid; one without axes.
    pub fn grid(&self) -> u64 {
        self.axes.iter().fold(1, |points: u64, axis| points.saturating_mul(axis.rows.len() as u64))
    }

    /// How many scenarios there are.
    pub fn scenarios(&self) -> u64 {
        let group = if self.sampling == Sampling::Saltelli { self.draws.len() as u64 + 2 } else { 1 };
        self.grid().saturating_mul(self.repeats).saturating_mul(group)
    }

    /// How large a target's values are, its unit otherwise: what its derivatives are multiplied by to be of the size of
    /// what they are of.
    pub fn scale(&self, target: usize) -> f64 {
        let of_rows = self.axes.iter().flat_map(|axis| {
            let column = axis.targets.iter().position(|other| *other == target);
            axis.rows.iter().filter_map(move |row| Some(row[column?].abs()))
        });
        let [means, covariance] = self.moments();
        let drawn = means[target].abs() + libm::sqrt(covariance[target * (self.targets.len() + 1)]);
        let scale = of_rows.fold(drawn, f64::max);
        if scale > 0.0 { scale } else { 1.0 }
    }

    /// Means and covariances of what is drawn, row by row; zero of other targets.
    pub fn moments(&self) -> [Vec<f64>; 2] {
        let n = self.targets.len();
        let (mut means, mut covariance) = (vec![0.0; n], vec![0.0; n * n]);
        for draw in &self.draws {
            match draw {
                Draw::Alone { target, distribution } => {
                    [means[*target], covariance[target * (n + 1)]] = distribution.moments();
                }
                Draw::Together { targets, mean, factor } => {
                    let m = targets.len();
                    for (i, row) in targets.iter().enumerate() {
                        means[*row] = mean[i];
                        for (j, column) in targets.iter().enumerate() {
                            let products = (0..m).map(|k| factor[m * i + k] * factor[m * j + k]);
                            covariance[n * row + column] = products.sum();
                        }
                    }
                }
            }
        }
        [means, covariance]
    }

    /// How many uniform numbers a scenario takes.
    pub fn dimensions(&self) -> usize {
        self.draws.iter().map(Draw::dimensions).sum()
    }

    /// What the inputs are in a scenario with these values.
    pub fn inputs(&self, values: &[f64]) -> Vec<Input> {
        let input = |(target, value): (&Target, &f64)| match target {
            Target::Input(index) => Some(Input::constant(*index, *value)),
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a table's number")]
            Target::Table(tables) => tables.get(*value as usize).cloned(),
            _ => None,
        };
        self.targets.iter().zip(values).filter_map(input).collect()
    }
}

/// The random numbers of a scenario.
fn stream(plan: &Plan, k: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(plan.seed);
    random.set_stream(k);
    random
}

/// Gives the values of scenarios: a plan with what does not change from one to the next.
#[derive(Clone, Debug)]
pub struct Source<'a> {
    plan: &'a Plan,
    sobol: Sobol,
    /// Exclusive or with these is the digital shift.
    shift: Vec<u64>,
    uniforms: Vec<f64>,
}

impl<'a> Source<'a> {
    /// For all scenarios of a plan.
    pub fn new(plan: &'a Plan) -> Self {
        let n = plan.dimensions();
        let dimensions = match plan.sampling {
            Sampling::Random => 0,
            Sampling::Sobol => n,
            Sampling::Saltelli => 2 * n,
        };
        let mut shifts = stream(plan, u64::MAX);
        Self {
            plan,
            sobol: Sobol::new(dimensions),
            shift: (0..dimensions).map(|_| shifts.next_u64()).collect(),
            uniforms: vec![0.0; n],
        }
    }

    /// Writes the values of scenario k, in the order of the targets.
    pub fn write(&mut self, k: u64, values: &mut [f64]) {
        let plan = self.plan;
        let (mut rest, repeat) = match plan.sampling {
            // Groups belong together: the grid changes from one to the next.
            Sampling::Saltelli => {
                let group = k / (plan.draws.len() as u64 + 2);
                (group % plan.grid(), group / plan.grid())
            }
            _ => (k % plan.grid(), k / plan.grid()),
        };
        for axis in plan.axes.iter().rev() {
            let n = axis.rows.len() as u64;
            let row = usize::try_from(rest % n).unwrap_or(0);
            rest /= n;
            axis.targets.iter().zip(&axis.rows[row]).for_each(|(target, value)| values[*target] = *value);
        }
        self.draw_uniforms(k, repeat);
        let mut at = 0;
        for draw in &plan.draws {
            let n = draw.dimensions();
            draw.write(&self.uniforms[at..at + n], values);
            at += n;
        }
    }

    fn draw_uniforms(&mut self, k: u64, repeat: u64) {
        let n = self.uniforms.len();
        match self.plan.sampling {
            Sampling::Random if n > 0 => {
                let mut random = stream(self.plan, k);
                self.uniforms.iter_mut().for_each(|u| *u = Sobol::unit(random.next_u64() >> 12));
            }
            Sampling::Random => {}
            Sampling::Sobol => (0..n).for_each(|d| self.uniforms[d] = self.point(k, d)),
            Sampling::Saltelli => {
                let which = k % (self.plan.draws.len() as u64 + 2);
                let mut d = 0;
                for (draw, index) in self.plan.draws.iter().zip(2..) {
                    // The second half of the dimensions is b.
                    let half = if which == 1 || which == index { n } else { 0 };
                    for _ in 0..draw.dimensions() {
                        self.uniforms[d] = self.point(repeat, half + d);
                        d += 1;
                    }
                }
            }
        }
    }

    fn point(&self, k: u64, dimension: usize) -> f64 {
        Sobol::unit(self.sobol.bits(k, dimension) ^ self.shift[dimension])
    }
}

#[cfg(test)]
mod tests;
