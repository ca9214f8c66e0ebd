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
        self.axes.iter().map(|axis| axis.rows.len() as u64).product()
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
mod tests {
    use super::*;
    use crate::draw::Distribution;

    fn plan(sampling: Sampling) -> Plan {
        let unit = |target| Draw::Alone { target, distribution: Distribution::Uniform([0.0, 1.0]) };
        let axis = |target, values: &[f64]| Axis {
            targets: vec![target],
            rows: values.iter().map(|value| vec![*value]).collect(),
        };
        Plan {
            seed: 7,
            sampling,
            targets: (0..4).map(Target::Parameter).collect(),
            axes: vec![axis(0, &[1.0, 2.0]), axis(3, &[10.0, 20.0, 30.0])],
            draws: vec![unit(1), unit(2)],
            repeats: 5,
        }
    }

    fn values(plan: &Plan, k: u64) -> [f64; 4] {
        let mut values = [0.0; 4];
        Source::new(plan).write(k, &mut values);
        values
    }

    #[test]
    fn a_scenario_depends_on_seed_and_index_alone() {
        for sampling in [Sampling::Random, Sampling::Sobol, Sampling::Saltelli] {
            let plan = plan(sampling);
            let mut source = Source::new(&plan);
            let mut all = Vec::new();
            for k in 0..plan.scenarios() {
                let mut found = [0.0; 4];
                source.write(k, &mut found);
                assert_eq!(found, values(&plan, k));
                all.push(found);
            }
            let other = Plan { seed: 8, ..plan.clone() };
            assert!(
                (0..plan.scenarios()).all(|k| values(&other, k)[1] != all[k as usize][1]),
                "{sampling:?}"
            );
        }
    }

    #[test]
    fn no_two_scenarios_draw_the_same() {
        for sampling in [Sampling::Random, Sampling::Sobol] {
            let plan = Plan { repeats: 500, ..plan(sampling) };
            let drawn = (0..plan.scenarios()).map(|k| values(&plan, k)[1].to_bits());
            assert_eq!(drawn.collect::<std::collections::BTreeSet<_>>().len(), 3000, "{sampling:?}");
        }
    }

    #[test]
    fn the_last_axis_is_the_fastest() {
        let plan = plan(Sampling::Random);
        assert_eq!((plan.grid(), plan.scenarios()), (6, 30));
        let grid = |k| {
            let [a, _, _, b] = values(&plan, k);
            (a, b)
        };
        assert_eq!(
            [0, 1, 2, 3, 6].map(grid),
            [(1.0, 10.0), (1.0, 20.0), (1.0, 30.0), (2.0, 10.0), (1.0, 10.0)]
        );
        assert_ne!(values(&plan, 0)[1], values(&plan, 6)[1]);
    }

    #[test]
    fn a_group_of_saltelli_exchanges_one_draw_each() {
        let plan = Plan { axes: Vec::new(), ..plan(Sampling::Saltelli) };
        assert_eq!(plan.scenarios(), 20);
        let [a, b, first, second] = [8, 9, 10, 11].map(|k| values(&plan, k));
        assert_eq!([first[1], first[2]], [b[1], a[2]]);
        assert_eq!([second[1], second[2]], [a[1], b[2]]);
        assert!(a[1] != b[1] && a[2] != b[2]);
    }
}
