//! Rows of loops some of which always depend on the others, but not always the same ones (Bennett's linkage): no
//! choice of rows, and no fixed combinations of them, keep their rank along the motion. So all of them stay, and
//! they *yield*:
//!
//! ```text
//! J u̇ = γ + Q λ,    Q = (1 + J Jᵀ / ε)⁻⁸
//! ```
//!
//! where `Nᵀ J = 0` along the motion, Q is the projector onto N but for `(ε / σ²)⁸`, which is nothing beside
//! singular values σ > 0 of J. With `Nᵀ γ = 0` it follows that `Q λ = 0`: all rows are met, by the smallest
//! multipliers. J M⁻¹ Jᵀ is singular and `J M⁻¹ Jᵀ + Q` is not, unless the whole set of rows loses rank. Nothing is
//! chosen, and off the closed loops, by as much as drift and stages of steps are, Q hardly changes. A pseudoinverse
//! would, as the rank is full there.

use crate::expr::graph::{ExprId, Graph};
use crate::solve::ldl::Elimination;
use gyro_model::{Model, RowUnit};
use std::collections::BTreeMap;

/// The lower triangle of a Q, by places of rows.
pub type Yielding = BTreeMap<(usize, usize), ExprId>;

/// `1 / ε`. Singular values are of order one, lengths being counted in units of the mechanism's size. States that a
/// method visits are off by less than 1e-3, so that what is nothing stays below; from 0.01 on σ is told from it to
/// rounding, in single precision too.
const SHARPNESS: i64 = 1 << 20;

/// The exponent of Q is two to this.
const SQUARINGS: usize = 3;

/// Q of some rows, with their places among the model's.
pub fn yielding(graph: &mut Graph, model: &Model, rows: &[(usize, &[ExprId])]) -> Yielding {
    let [size, _] = model.units_of_dependence();
    let units = model.rows();
    let units: Vec<_> = rows.iter().map(|(row, _)| units[*row].unit == RowUnit::Length).collect();
    let units: Vec<_> = units
        .into_iter()
        .map(|is_length| if is_length { power_of_two(graph, -size) } else { Graph::ONE })
        .collect();
    let sharpness = graph.integer(SHARPNESS);
    let mut matrix = Yielding::new();
    for (k, (_, row)) in rows.iter().enumerate() {
        for (l, (_, other)) in rows[..=k].iter().enumerate() {
            let product = graph.dot_slices(row, other);
            let factors = [units[k], units[l], sharpness];
            let entry = factors.into_iter().fold(product, |entry, factor| graph.mul(factor, entry));
            matrix.insert((k, l), if k == l { graph.add(entry, Graph::ONE) } else { entry });
        }
    }
    let mut q = inverse(graph, matrix, rows.len());
    for _ in 0..SQUARINGS {
        q = square(graph, &q);
    }
    let mut yielding = Yielding::new();
    for (k, row) in q.iter().enumerate() {
        for (l, &entry) in row[..=k].iter().enumerate() {
            let unit = graph.mul(units[k], units[l]);
            yielding.insert((k, l), graph.div(entry, unit));
        }
    }
    yielding
}

/// What a Q is multiplied by where rows are compared by the accelerations that forces bring about.
pub fn lightness(graph: &mut Graph, model: &Model) -> ExprId {
    let [size, mass] = model.units_of_dependence();
    power_of_two(graph, -mass - 2 * size)
}

fn power_of_two(graph: &mut Graph, exponent: i32) -> ExprId {
    let power = 1_i64 << exponent.unsigned_abs().min(62);
    if exponent < 0 { graph.fraction(1, power) } else { graph.integer(power) }
}

fn inverse(graph: &mut Graph, mut matrix: Yielding, n: usize) -> Vec<Vec<ExprId>> {
    matrix.retain(|_, entry| *entry != Graph::ZERO);
    let unit = |k: usize| (0..n).map(|l| if k == l { Graph::ONE } else { Graph::ZERO }).collect();
    let mut elimination = Elimination::of_several(matrix, (0..n).map(unit).collect());
    (0..n).for_each(|unknown| elimination.pivot(graph, unknown));
    let columns = elimination.solutions(graph);
    symmetric(n, |k, l| columns[l][k])
}

fn square(graph: &mut Graph, matrix: &[Vec<ExprId>]) -> Vec<Vec<ExprId>> {
    symmetric(matrix.len(), |k, l| graph.dot_slices(&matrix[k], &matrix[l]))
}

/// From its lower triangle.
fn symmetric(n: usize, mut entry: impl FnMut(usize, usize) -> ExprId) -> Vec<Vec<ExprId>> {
    let lower: Vec<Vec<_>> = (0..n).map(|k| (0..=k).map(|l| entry(k, l)).collect()).collect();
    (0..n).map(|k| (0..n).map(|l| lower[k.max(l)][k.min(l)]).collect()).collect()
}
