//! The partition of the paper's section 5 by dense full pivoting of the whole constraint Jacobian.
//!
//! Lengths are measured in units of the mechanism's size, in rows and columns alike, so that pivots compare.

use crate::assembled::Refusal;
use crate::model::lowered::Lowered;
use crate::model::place::Moment;
use crate::model::textbook::angular_velocity;
use crate::number::{Number, abs, ln, number, resolvable, sqrt};
use nalgebra::{DMatrix, DVector, Dyn, LU, RowDVector, Vector4};

/// The coordinates are chosen anew once the volume |det Φ_u| has fallen below this fraction of the best choice's.
///
/// The ratio of two such volumes is the ratio of the volumes that the two sets of independent coordinates span on the
/// tangent space, whatever the basis. A new choice starts at ratio one and every exchange doubles the volume, so
/// choosing anew cannot flicker.
const POOR_VOLUME: f64 = 0.5;

/// The best choice that full pivoting finds.
pub(crate) struct Choice<T> {
    /// Columns, ascending.
    pub(crate) independent: Vec<usize>,
    log_volume: T,
}

/// Full pivoting takes as many pivots as there are constraints; the columns left over are independent. Where there are
/// too many constraints none is.
pub(crate) fn best<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>) -> Choice<T> {
    let lu = Equations::of(lowered, at).jacobian.full_piv_lu();
    let mut columns = RowDVector::from_iterator(lowered.scene.n_q(), 0..lowered.scene.n_q());
    lu.q().permute_columns(&mut columns);
    let n_dependent = (n_constraints(lowered) - lowered.n_dependent).min(lowered.scene.n_q());
    let mut independent = columns.as_slice()[n_dependent..].to_vec();
    independent.sort_unstable();
    Choice { independent, log_volume: log_volume(lu.lu_internal()) }
}

/// Replaces a choice whose volume is poor; returns how many coordinates were exchanged.
pub(crate) fn follow<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>, choice: &mut Vec<usize>) -> u32 {
    let best = best(lowered, at);
    let present = factorise(&Equations::of(lowered, at).jacobian, choice);
    let threshold = best.log_volume + number::<T>(POOR_VOLUME.ln());
    // Of a state that is not finite nothing can be told: the choice is kept.
    let poor = log_volume(present.lu_internal()) < threshold;
    if !poor {
        return 0;
    }
    let kept = best.independent.iter().filter(|column| choice.contains(column)).count();
    let exchanged = best.independent.len() - kept;
    *choice = best.independent;
    u32::try_from(exchanged).unwrap_or(u32::MAX)
}

/// One over the norm of the pseudoinverse of Φ_q, and of the joints' rows the one that is nearest to the span of the
/// others. With the transposed Jacobian `Q R` the norm is that of R⁻¹, and a row's distance is one over the length of
/// its row of R⁻¹.
pub(crate) fn clearance<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>) -> (T, usize) {
    let equations = Equations::of(lowered, at);
    let triangle = equations.jacobian.transpose().qr().r();
    let n = triangle.ncols();
    let is_joint = |row: &usize| *row < lowered.n_rows();
    if lowered.n_dependent > 0 {
        // Perpendicular combinations of rows, of lengths that are the singular values.
        let lengths: Vec<T> = equations.jacobian.row_iter().map(|row| row.norm()).collect();
        let least = (0..n).fold(0, |least, k| if lengths[k] < lengths[least] { k } else { least });
        let row = equations.combinations.map_or(0, |all| all.column(least).rows(0, lowered.n_rows()).iamax());
        let squares = lengths.iter().fold(T::zero(), |sum, length| sum + T::one() / (*length * *length));
        return (T::one() / sqrt(squares), row);
    }
    let Some(inverse) = triangle.solve_upper_triangular(&DMatrix::identity(n, n)) else {
        let dependent = (0..n).find(|&row| triangle[(row, row)] == T::zero());
        return (T::zero(), dependent.filter(is_joint).unwrap_or(0));
    };
    let lengths = (0..lowered.n_rows()).map(|row| (inverse.row(row).norm(), row));
    let longest =
        lengths.fold((T::zero(), 0), |longest, next| if next.0 > longest.0 { next } else { longest });
    (T::one() / inverse.norm(), longest.1)
}

/// A change of the dependent positions is trusted up to this part of the smallest pivot: a larger one may lead to
/// another way to put the mechanism together.
const TRUSTED: f64 = 0.125;

/// Changes of velocities by less than so many roundings, over a pivot below [`NEAR`] and over its square, are noise:
/// positions are known to a rounding over the pivot.
const ROUNDINGS: f64 = 16.0;
const NEAR: f64 = 0.02;
const SLIGHT: f64 = 1e-3;

/// `Φ_u Δu = −Φ`.
pub(crate) fn newton_step<T: Number>(
    lowered: &Lowered<T>,
    t: T,
    choice: &[usize],
    y: &mut [T],
) -> Result<(), Refusal<T>> {
    let mut right = DVector::zeros(n_constraints(lowered));
    lowered.phi(Moment { t, y }, right.as_mut_slice());
    lowered.silence(Moment { t, y }, right.as_mut_slice());
    right.iter_mut().enumerate().for_each(|(row, phi)| *phi = -*phi * row_scale(lowered, row));
    let equations = Equations::of(lowered, Moment { t, y });
    let (step, pivot) = solve(&equations.jacobian, choice, equations.right(right.clone()))?;
    let (change, limit) = (step.amax(), pivot * number(TRUSTED));
    if change > limit {
        return Err(Refusal::Jump(change, limit, right.iamax()));
    }
    for (column, step) in dependent(lowered, choice).zip(step.iter()) {
        y[column] += *step * column_scale(lowered, column);
    }
    Ok(())
}

/// Eq. (19), `Φ_u u̇ = ν − Φ_v v̇`, for the change of u̇ from its integrated value: `Φ_u Δu̇ = ν − Φ_q q̇` with q̇ =
/// (s, ½ Gᵀ w') at the corrected p; then Δw' = 2 G Δṗ.
pub(crate) fn solve_velocities<T: Number>(
    lowered: &Lowered<T>,
    t: T,
    choice: &[usize],
    y: &mut [T],
) -> Result<(), T> {
    // The normalisations hold as they are: pᵀ ½ Gᵀ w' = 0.
    let mut right = DVector::zeros(n_constraints(lowered));
    lowered.velocity_residual(Moment { t, y }, &mut right.as_mut_slice()[..lowered.n_rows()]);
    right.iter_mut().enumerate().for_each(|(row, rate)| *rate = -*rate * row_scale(lowered, row));
    let residual = right.amax();
    let equations = Equations::of(lowered, Moment { t, y });
    let (solution, pivot) = solve(&equations.jacobian, choice, equations.right(right))?;
    let speed = y[lowered.scene.n_q()..lowered.scene.n_q() + lowered.scene.n_v()]
        .iter()
        .fold(T::zero(), |m, v| abs(*v).max(m));
    let rounding = T::EPSILON * number(ROUNDINGS);
    let is_slight = rounding < number::<T>(SLIGHT) * pivot * pivot;
    if is_slight && pivot < number(NEAR) && residual * pivot <= rounding * speed {
        return Ok(());
    }
    let mut change = DVector::zeros(lowered.scene.n_q());
    dependent(lowered, choice).zip(solution.iter()).for_each(|(column, value)| change[column] = *value);
    for moving_body in 0..lowered.scene.n_bodies() {
        let (from, to) = (7 * moving_body, lowered.scene.n_q() + 6 * moving_body);
        (0..3).for_each(|k| y[to + k] += change[from + k] * lowered.size);
        let p_dot: Vector4<T> = change.fixed_rows::<4>(from + 3).into_owned();
        let w = angular_velocity(&lowered.scene.p(y, moving_body), &p_dot);
        (0..3).for_each(|k| y[to + 3 + k] += w[k]);
    }
    Ok(())
}

fn n_constraints<T: Number>(lowered: &Lowered<T>) -> usize {
    lowered.n_rows() + lowered.scene.n_bodies()
}

fn dependent<T: Number>(lowered: &Lowered<T>, choice: &[usize]) -> impl Iterator<Item = usize> {
    (0..lowered.scene.n_q()).filter(|column| choice.binary_search(column).is_err())
}

/// What the row is multiplied by.
pub(crate) fn row_scale<T: Number>(lowered: &Lowered<T>, row: usize) -> T {
    let is_length = lowered.row_infos.get(row).is_some_and(|row| row.is_length);
    if is_length { T::one() / lowered.size } else { T::one() }
}

/// The unit of the column's coordinate.
fn column_scale<T: Number>(lowered: &Lowered<T>, column: usize) -> T {
    if column % 7 < 3 { lowered.size } else { T::one() }
}

/// The scaled Φ_q, or where rows depend on others, combinations of its rows that do not.
struct Equations<T: Number> {
    jacobian: DMatrix<T>,
    /// In columns, where there are such.
    combinations: Option<DMatrix<T>>,
}

impl<T: Number> Equations<T> {
    fn of(lowered: &Lowered<T>, at: Moment<'_, T>) -> Self {
        let jacobian = jacobian(lowered, at);
        let rank = jacobian.nrows() - lowered.n_dependent;
        if lowered.n_dependent == 0 || !jacobian.iter().all(|entry| entry.is_finite()) {
            return Self { jacobian: jacobian.rows(0, rank).into_owned(), combinations: None };
        }
        // Singular values come in descending order.
        let combinations = jacobian.clone().svd(true, false).u.expect("asked for");
        let combinations = combinations.columns(0, rank).into_owned();
        Self { jacobian: combinations.tr_mul(&jacobian), combinations: Some(combinations) }
    }

    /// The same combinations of a right side.
    fn right(&self, right: DVector<T>) -> DVector<T> {
        match &self.combinations {
            Some(combinations) => combinations.tr_mul(&right),
            None => right.rows(0, self.jacobian.nrows()).into_owned(),
        }
    }
}

/// The scaled Φ_q, normalisations included: 25×28 for the paper's gyroscope.
fn jacobian<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>) -> DMatrix<T> {
    let mut jacobian = DMatrix::zeros(n_constraints(lowered), lowered.scene.n_q());
    lowered.phi_q(at, |row, column, value| {
        jacobian[(row, column)] = value * row_scale(lowered, row) * column_scale(lowered, column);
    });
    jacobian
}

fn factorise<T: Number>(jacobian: &DMatrix<T>, choice: &[usize]) -> LU<T, Dyn, Dyn> {
    let columns: Vec<usize> = (0..jacobian.ncols()).filter(|c| choice.binary_search(c).is_err()).collect();
    jacobian.select_columns(&columns).lu()
}

/// Solves with Φ_u, and gives its smallest pivot; fails with it, or with zero if there are more constraints than
/// coordinates.
fn solve<T: Number>(
    jacobian: &DMatrix<T>,
    choice: &[usize],
    right: DVector<T>,
) -> Result<(DVector<T>, T), T> {
    let lu = factorise(jacobian, choice);
    if !lu.lu_internal().is_square() {
        return Err(T::zero());
    }
    let pivot = resolvable(pivots(lu.lu_internal()))?;
    lu.solve(&right).map(|solution| (solution, pivot)).ok_or(pivot)
}

/// The logarithm of the product of all pivots.
fn log_volume<T: Number>(lu: &DMatrix<T>) -> T {
    pivots(lu).fold(T::zero(), |sum, pivot| sum + ln(abs(pivot)))
}

/// The diagonal of a matrix that need not be square.
fn pivots<T: Number>(lu: &DMatrix<T>) -> impl Iterator<Item = T> {
    (0..lu.nrows().min(lu.ncols())).map(|k| lu[(k, k)])
}
