//! Radau IIA collocation in double-double arithmetic, for motions of which a part dies away fast.
//!
//! Hairer and Wanner, *Solving Ordinary Differential Equations II* (2nd ed. 1996), sections IV.5 and IV.8. The
//! polynomial is told by its values at the nodes, and its slopes there by those (barycentric differentiation: Berrut
//! and Trefethen, SIAM Review 46, 2004), so that no table of coefficients is needed.

use core::array::from_fn;

use crate::DoubleDouble;
use crate::extrapolation::State;

/// Order 17 of smooth motions, and at least 9 of stiff ones.
const STAGES: usize = 9;

/// Newton's iteration ends when it changes nothing by more than this, over one and the value.
const CONVERGED: f64 = 1e-24;

/// From the first step, each is longer by a part of the time until then, up to the largest: the fast part has died away
/// by then.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps {
    /// s.
    pub(crate) first: f64,
    pub(crate) growth: f64,
    /// s.
    pub(crate) largest: f64,
}

/// Slopes at the nodes, of which the last is the end of the step, by values at its start and at the nodes; time in
/// units of the step.
struct Differentiation([[DoubleDouble; STAGES + 1]; STAGES]);

/// The state at `to`, from `state` at `from`, s since the fast part began.
///
/// # Panics
/// If Newton's iteration does not converge.
pub(crate) fn advance<const N: usize>(
    rhs: impl Fn(&State<N>) -> State<N>,
    steps: Steps,
    mut state: State<N>,
    from: DoubleDouble,
    to: DoubleDouble,
) -> State<N> {
    let slopes = Differentiation::new();
    let mut now = from;
    while now < to {
        let wanted = (steps.first + steps.growth * now.to_f64()).min(steps.largest);
        let left = to - now;
        let step = left.divided_by((left.to_f64() / wanted).ceil().max(1.0));
        state = slopes.step(&rhs, &state, step);
        now = if (left - step).to_f64() < 1e-25 { to } else { now + step };
    }
    state
}

impl Differentiation {
    fn new() -> Self {
        let nodes = nodes();
        let at = |k: usize| if k == 0 { DoubleDouble::ZERO } else { nodes[k - 1] };
        let one = DoubleDouble::new(1.0);
        let weight = |j: usize| {
            let factors = (0..=STAGES).filter(|k| *k != j).map(|k| at(j) - at(k));
            one / factors.fold(one, |product, factor| product * factor)
        };
        let weights: [DoubleDouble; STAGES + 1] = from_fn(weight);
        Self(from_fn(|row| {
            let i = row + 1;
            let mut slopes =
                from_fn(
                    |j| if i == j { DoubleDouble::ZERO } else { weights[j] / weights[i] / (at(i) - at(j)) },
                );
            // A constant has no slope.
            slopes[i] = slopes.iter().fold(DoubleDouble::ZERO, |sum, slope| sum - *slope);
            slopes
        }))
    }

    /// The values at the nodes whose slopes are `rhs` there, by Newton's iteration with the Jacobian at the start.
    fn step<const N: usize>(
        &self,
        rhs: &impl Fn(&State<N>) -> State<N>,
        start: &State<N>,
        step: DoubleDouble,
    ) -> State<N> {
        const ITERATIONS: usize = 60;
        let matrix = self.matrix(&jacobian(rhs, start), step.to_f64());
        let mut values = [*start; STAGES];
        for _ in 0..ITERATIONS {
            let slopes = values.each_ref().map(rhs);
            let residual = (0..STAGES * N).map(|place| {
                let (i, k) = (place / N, place % N);
                let own =
                    (0..STAGES).fold(self.0[i][0] * start[k], |sum, j| sum + self.0[i][j + 1] * values[j][k]);
                (own - step * slopes[i][k]).to_f64()
            });
            let changes = eliminated(matrix.clone(), residual.collect());
            let mut largest: f64 = 0.0;
            for (place, change) in changes.into_iter().enumerate() {
                let value = &mut values[place / N][place % N];
                *value = *value - DoubleDouble::new(change);
                largest = largest.max(change.abs() / (1.0 + value.to_f64().abs()));
            }
            if largest < CONVERGED {
                return values[STAGES - 1];
            }
        }
        panic!("no convergence of a step of {:e} s from {start:?}", step.to_f64());
    }

    /// What the residual changes by with each value: good to sixteen digits, as corrections are.
    fn matrix<const N: usize>(&self, jacobian: &[[f64; N]; N], step: f64) -> Vec<Vec<f64>> {
        let entry = |row: usize, column: usize| {
            let ((i, k), (j, l)) = ((row / N, row % N), (column / N, column % N));
            let of_slope = if k == l { self.0[i][j + 1].to_f64() } else { 0.0 };
            of_slope - if i == j { step * jacobian[k][l] } else { 0.0 }
        };
        (0..STAGES * N).map(|row| (0..STAGES * N).map(|column| entry(row, column)).collect()).collect()
    }
}

/// Of the rows of ∂f/∂y, by differences.
fn jacobian<const N: usize>(rhs: &impl Fn(&State<N>) -> State<N>, at: &State<N>) -> [[f64; N]; N] {
    const STEP: f64 = 1e-16;
    let here = rhs(at);
    let columns: [[f64; N]; N] = from_fn(|column| {
        let mut moved = *at;
        moved[column] = moved[column] + DoubleDouble::new(STEP);
        let there = rhs(&moved);
        from_fn(|row| (there[row] - here[row]).divided_by(STEP).to_f64())
    });
    from_fn(|row| from_fn(|column| columns[column][row]))
}

/// `A x = b`, with pivoting by rows.
fn eliminated(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    for pivot in 0..n {
        let largest = (pivot..n).max_by(|i, j| a[*i][pivot].abs().total_cmp(&a[*j][pivot].abs()));
        let largest = largest.expect("a row is left");
        a.swap(pivot, largest);
        b.swap(pivot, largest);
        for row in pivot + 1..n {
            let (above, below) = a.split_at_mut(row);
            let factor = below[0][pivot] / above[pivot][pivot];
            let entries = below[0].iter_mut().zip(&above[pivot]).skip(pivot);
            entries.for_each(|(entry, above)| *entry -= factor * above);
            b[row] -= factor * b[pivot];
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|column| a[row][column] * b[column]).sum();
        b[row] = (b[row] - known) / a[row][row];
    }
    b
}

/// Where Pₛ(2c − 1) − Pₛ₋₁(2c − 1) vanishes, by bisection; the last one is 1.
fn nodes() -> [DoubleDouble; STAGES] {
    const GRID: u32 = 1000;
    const HALVINGS: u32 = 110;
    let difference = |c: DoubleDouble| {
        let x = c.times(2.0) - DoubleDouble::new(1.0);
        let (mut before, mut last) = (DoubleDouble::new(1.0), x);
        for n in 1..STAGES {
            let n = n as f64;
            (before, last) = (last, ((x * last).times(2.0 * n + 1.0) - before.times(n)).divided_by(n + 1.0));
        }
        last - before
    };
    let is_negative = |c: DoubleDouble| difference(c).to_f64() < 0.0;
    let mut nodes = [DoubleDouble::new(1.0); STAGES];
    let mut found = 0;
    for cell in 0..GRID - 1 {
        let edge = |k: u32| DoubleDouble::new(f64::from(k)).divided_by(f64::from(GRID));
        let (mut low, mut high) = (edge(cell), edge(cell + 1));
        let sign = is_negative(low);
        if sign != is_negative(high) {
            for _ in 0..HALVINGS {
                let middle = (low + high).times(0.5);
                if is_negative(middle) == sign { low = middle } else { high = middle }
            }
            nodes[found] = high;
            found += 1;
        }
    }
    assert_eq!(found, STAGES - 1, "all roots but the last");
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_up_to_the_number_of_stages_are_differentiated_exactly() {
        let (slopes, nodes) = (Differentiation::new(), nodes());
        let power = |x: DoubleDouble, n: usize| (0..n).fold(DoubleDouble::new(1.0), |product, _| product * x);
        for n in 1..=STAGES {
            for (row, at) in slopes.0.iter().zip(nodes) {
                let found = row[1..]
                    .iter()
                    .zip(nodes)
                    .fold(DoubleDouble::ZERO, |sum, (slope, x)| sum + *slope * power(x, n));
                let expected = power(at, n - 1).times(n as f64);
                assert!((found - expected).to_f64().abs() < 1e-27, "{n}: {found:?} {expected:?}");
            }
        }
    }

    /// Prothero and Robinson's problem, ẏ = −λ (y − cos t) − sin t beside an oscillator that gives cos t: the fast part
    /// dies away by exp(−λ t).
    #[test]
    fn a_fast_part_dies_away_and_the_slow_one_is_kept() {
        let fast = 1e6;
        let rhs = |&[y, cos, sin]: &State<3>| [(y - cos).times(-fast) - sin, -sin, cos];
        let one = DoubleDouble::new(1.0);
        let start = [one + one, one, DoubleDouble::ZERO];
        let steps = Steps { first: 1e-7, growth: 0.25, largest: 0.1 };
        let soon = DoubleDouble::new(3.0).divided_by(fast);
        let (soon, late) = (advance(rhs, steps, start, DoubleDouble::ZERO, soon), {
            advance(rhs, steps, start, DoubleDouble::ZERO, one)
        });
        let expected = (3.0 / fast).cos() + (-3.0_f64).exp();
        assert!((soon[0].to_f64() - expected).abs() < 1e-14, "{soon:?}");
        let (sin, cos) = one.sin_cos();
        let errors = [late[0] - cos, late[1] - cos, late[2] - sin].map(|x| x.to_f64().abs());
        assert!(errors.iter().all(|error| *error < 1e-22), "{errors:?}");
    }
}
