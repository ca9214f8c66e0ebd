//! The coordinate partition of any mechanism, closed loops included, by full pivoting of its constraint Jacobian.
//!
//! Where neither charts nor [joint coordinates](crate::joint_partition) serve, the whole of Φ_q (joint rows and
//! normalisations, `NC` × `NQ`) is factorised at run time in arrays of fixed size: its pivots' columns are the
//! *dependent* coordinates, the others the independent ones. A generated mechanism calls these functions from its
//! [`Partition`](crate::Partition), one line each.
//!
//! Lengths are measured in units of the mechanism's [`size`](crate::Mechanism::size), in rows and columns alike, so
//! that pivots are pure numbers and compare.
//!
//! # The choice of coordinates
//! Full pivoting (Golub and Van Loan, *Matrix Computations*, section 3.4.8) makes the first choice. A small change of
//! an independent coordinate k changes the dependent coordinate j by `W_jk = −(Φ_u⁻¹ Φ_v)_jk`, and exchanging the two
//! multiplies `|det Φ_u|` by `|W_jk|`. [`follow`] exchanges the largest until none exceeds [`POOR`] (Goreinov et al.
//! 2010, *How to find a good submatrix*), so that errors of the independent coordinates never reach the dependent ones
//! enlarged by more.
//!
//! # Singular poses and branches
//! Where a linkage can be put together in two ways and both ways meet (a parallelogram with all bars in line), the last
//! pivot vanishes. Newton's iteration is safe only while its change is small beside that pivot; a larger one may lead
//! to the other way and is refused: see [`newton_step`].
//!
//! # Cost
//! One elimination, about `NC² NQ / 2` multiplications less what zeros save, for each Newton step, each solution for
//! velocities and each look at the choice; 8 `NC` (`NQ` + 1) bytes of stack in double precision.

mod elimination;
mod extent;
#[cfg(test)]
mod four_bar;
mod nearness;
mod rounding;

pub use extent::{Extent, Fixed};
pub use rounding::is_met;
pub(crate) use rounding::silence;

use crate::contract::Storage;
use crate::scalar::largest_magnitude;
use crate::violation::constraint_violation;
use crate::{Clearance, Error, Kinematics, Mechanism, Owner, Real, Scalar};
use elimination::Elimination;

/// Which `NC` of the `NQ` coordinates are dependent.
pub type Pivots<const NC: usize, const NQ: usize> = Choice<Fixed<NC, NQ>>;

/// Which coordinates are dependent: as many as there are constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice<E: Extent> {
    extent: E,
    /// The dependent coordinates, ascending, then the independent ones, ascending.
    columns: E::Columns,
}

/// An independent coordinate is exchanged once a dependent one changes this many times as fast. Every exchange
/// multiplies `|det Φ_u|` by more than this, so that exchanges end and rounding cannot undo one; any number clearly
/// above one would do. Two is also about what charts grant.
pub const POOR: f64 = 2.0;

/// A Newton step may change a dependent coordinate by this part of the smallest pivot.
///
/// By the Newton–Kantorovich theorem (Ortega and Rheinboldt, *Iterative Solution of Nonlinear Equations*, 12.6.2) the
/// iteration converges to the only solution nearby if `|Φ_u⁻¹| · K · |Δu| ≤ ½`, with K a Lipschitz constant of Φ_u.
/// Rows are products of at most two rotation matrices and lengths of at most the size, so K is about 4, and the
/// smallest pivot stands for `1 / |Φ_u⁻¹|`.
const TRUSTED: f64 = 0.125;

/// Whether near a singular pose what is left of a row's rate is no more than rounding.
///
/// Corrected positions are known to a rounding over the pivot, and the rows' rates at this speed no better. Divided by
/// the pivot once more that would be a change of velocities by noise; what was integrated is better.
pub(crate) fn is_noise<T: Real>(rate: T, pivot: T, speed: T) -> bool {
    let rounding = T::EPSILON * T::constant(ROUNDINGS);
    let is_slight = rounding < T::constant(SLIGHT) * pivot * pivot;
    is_slight && pivot < T::constant(SMALL) && rate * pivot <= rounding * speed
}

/// A pivot below this is small: singular poses are near. Elsewhere corrections are exact.
const SMALL: f64 = 0.02;

/// Noise is left alone only where it is this part of the motion at most; in single precision it is more wherever pivots
/// are small.
const SLIGHT: f64 = 1e-3;

/// Rounding errors that add up in a row.
const ROUNDINGS: f64 = 16.0;

/// A pivot below this many roundings counts as zero: entries are of order one.
const SINGULAR_EPSILONS: f64 = 16.0;

impl<E: Extent> Choice<E> {
    /// The dependent coordinates, ascending: columns of Φ_q, 7 for each body.
    pub fn dependent(&self) -> &[u16] {
        &self.columns.as_ref()[..self.n_dependent()]
    }

    /// The independent coordinates, ascending.
    pub fn independent(&self) -> &[u16] {
        &self.columns.as_ref()[self.n_dependent()..]
    }

    fn new(extent: E, columns: E::Columns) -> Self {
        let mut choice = Self { extent, columns };
        let n_dependent = choice.n_dependent();
        let (dependent, independent) = choice.columns.as_mut().split_at_mut(n_dependent);
        dependent.sort_unstable();
        independent.sort_unstable();
        choice
    }

    fn n_dependent(&self) -> usize {
        self.extent.n_constraints().min(self.extent.n_coordinates())
    }
}

/// The choice that full pivoting finds at a state.
pub fn independent<M, E: Extent>(mechanism: &M, t: M::Scalar, y: &M::State) -> Choice<E>
where
    M: Kinematics<Scalar: Real>,
{
    let extent = extent_of::<M, E>(mechanism);
    let mut elimination = Elimination::of(mechanism, t, y, extent, extent.columns());
    elimination.reduce(extent.n_coordinates());
    Choice::new(extent, elimination.columns)
}

fn extent_of<M: Mechanism, E: Extent>(mechanism: &M) -> E {
    let description = mechanism.description();
    let n_bodies = description.bodies.len();
    E::new(description.rows.len() + n_bodies, 7 * n_bodies)
}

/// How clear a state is of singular poses: one over the norm of the Jacobian's pseudoinverse, which near a pose is the
/// smallest singular value; and whose row is nearest to depending on the others.
///
/// It follows the state smoothly, as the smallest pivot of an elimination does not; along a motion through a singular
/// pose it falls to zero and rises again in proportion to the distance.
pub fn clearance<M, const NC: usize, const NQ: usize>(
    mechanism: &M,
    t: M::Scalar,
    y: &M::State,
) -> Clearance<M::Scalar>
where
    M: Kinematics<Scalar: Real>,
{
    clearance_in::<M, Fixed<NC, NQ>>(mechanism, t, y)
}

/// The same with numbers of constraints and coordinates that the mechanism tells.
pub fn clearance_in<M, E: Extent>(mechanism: &M, t: M::Scalar, y: &M::State) -> Clearance<M::Scalar>
where
    M: Kinematics<Scalar: Real>,
{
    let extent = extent_of::<M, E>(mechanism);
    let nearest = Elimination::of(mechanism, t, y, extent, extent.columns()).nearness();
    Clearance { pivot: nearest.value, owner: Some(owner(mechanism, nearest.row)) }
}

/// Exchanges coordinates until no dependent one changes more than [`POOR`] times as fast as an independent one; returns
/// the number of exchanges.
///
/// A choice that cannot be solved for at all is replaced by that of [`independent`]. If the
/// state is not finite, the choice is kept.
pub fn follow<M, E: Extent>(mechanism: &M, t: M::Scalar, y: &M::State, choice: &mut Choice<E>) -> u32
where
    M: Kinematics<Scalar: Real>,
{
    let (before, extent) = (choice.clone(), choice.extent);
    for _ in 0..extent.n_coordinates() {
        let mut elimination = Elimination::of(mechanism, t, y, extent, choice.columns.clone());
        let least = elimination.reduce(extent.n_constraints());
        if !is_resolvable(least.value) {
            *choice = independent(mechanism, t, y);
            break;
        }
        let Some((dependent, independent)) = elimination.steepest(M::Scalar::constant(POOR)) else { break };
        elimination.columns.as_mut().swap(dependent, independent);
        *choice = Choice::new(extent, elimination.columns);
    }
    let is_new = |column: &&u16| before.independent().binary_search(column).is_err();
    choice.independent().iter().filter(is_new).map(|_| 1).sum()
}

/// One Newton step of the dependent positions: `Φ_u Δu = −Φ`.
///
/// # Errors
/// [`Error::Singular`] if a pivot vanishes, [`Error::Jump`] if the change is too large beside the smallest pivot for
/// the solution to be the one nearby: the state is then as it was.
pub fn newton_step<M, E: Extent>(
    mechanism: &M,
    t: M::Scalar,
    choice: &Choice<E>,
    y: &mut M::State,
) -> Result<(), Error>
where
    M: Kinematics<Scalar: Real>,
{
    let extent = choice.extent;
    let mut elimination = Elimination::of(mechanism, t, y, extent, choice.columns.clone());
    let mut phi = mechanism.buffers().constraints;
    mechanism.phi(t, y, &mut phi);
    silence(mechanism, t, y, &mut phi);
    elimination.set_right(mechanism, phi.as_ref());
    let least = elimination.reduce(extent.n_constraints());
    refuse_singular(mechanism, t, least)?;
    let change = elimination.solution();
    let change = change.as_ref().iter().copied();
    let largest = largest_magnitude(change.clone());
    let limit = least.value * M::Scalar::constant(TRUSTED);
    if largest > limit {
        let owner = constraint_violation(mechanism, phi.as_ref(), |x| x).owner.unwrap_or(Owner::Body(0));
        return Err(Error::Jump { t: t.to_f64(), change: largest.to_f64(), limit: limit.to_f64(), owner });
    }
    let (size, y) = (mechanism.size(), y.as_mut());
    for (column, change) in elimination.dependent().zip(change) {
        let unit = if column % 7 < 3 { size } else { M::Scalar::constant(1.0) };
        y[column] = y[column] - change * unit;
    }
    Ok(())
}

/// Solves eq. (19) for the change of the dependent velocities, components of ṙ and of `ṗ = ½ Gᵀ w'`: `Φ_u Δu̇ = ν − Φ_q
/// q̇`. Then `Δw' = 2 G Δṗ`. Independent velocities keep their values.
///
/// # Errors
/// [`Error::Singular`] if a pivot vanishes.
pub fn solve_velocities<M, E: Extent>(
    mechanism: &M,
    t: M::Scalar,
    choice: &Choice<E>,
    y: &mut M::State,
) -> Result<(), Error>
where
    M: Kinematics<Scalar: Real>,
{
    let extent = choice.extent;
    let mut elimination = Elimination::of(mechanism, t, y, extent, choice.columns.clone());
    let mut residual = mechanism.buffers().rows;
    mechanism.velocity_residual(t, y, &mut residual);
    // The normalisations' rates 2 pᵀṗ = pᵀGᵀw' are zero for any w'.
    elimination.set_right(mechanism, residual.as_ref());
    refuse_singular(mechanism, t, elimination.reduce(extent.n_constraints()))?;
    elimination.leave_noise(fastest(mechanism, y));
    let mut q_dot = extent.line::<M::Scalar>();
    for (column, change) in elimination.dependent().zip(elimination.solution().as_ref()) {
        q_dot.as_mut()[column] = -*change;
    }
    add_velocities(q_dot.as_ref(), mechanism.size(), y);
    Ok(())
}

/// The fastest rate of a coordinate, lengths in units of the size.
pub(crate) fn fastest<M: Mechanism<Scalar: Real>>(mechanism: &M, y: &M::State) -> M::Scalar {
    let velocities = y
        .as_ref()
        .iter()
        .skip(7 * mechanism.description().bodies.len())
        .take(6 * mechanism.description().bodies.len());
    let rates = velocities.enumerate().map(|(k, v)| if k % 6 < 3 { *v / mechanism.size() } else { *v });
    largest_magnitude(rates)
}

/// Adds a change of `q̇ = (ṙ, ṗ)`, lengths in units of the size, to the velocities `(s, w')` of the state.
fn add_velocities<T: Real, S: Storage<T>>(q_dot: &[T], size: T, y: &mut S) {
    let (q, rest) = y.as_mut().split_at_mut(q_dot.len());
    let (changes, bodies) = (q_dot.as_chunks::<7>().0, q.as_chunks::<7>().0);
    let velocities = rest.as_chunks_mut::<6>().0;
    for ((velocity, change), [_, _, _, e0, e1, e2, e3]) in velocities.iter_mut().zip(changes).zip(bodies) {
        let [rx, ry, rz, d0, d1, d2, d3] = *change;
        let (e0, e1, e2, e3, two) = (*e0, *e1, *e2, *e3, T::constant(2.0));
        // Rows of G, eq. (15).
        let delta = [
            rx * size,
            ry * size,
            rz * size,
            two * (e0 * d1 - e1 * d0 + e3 * d2 - e2 * d3),
            two * (e0 * d2 - e2 * d0 + e1 * d3 - e3 * d1),
            two * (e0 * d3 - e3 * d0 + e2 * d1 - e1 * d2),
        ];
        for (value, delta) in velocity.iter_mut().zip(delta) {
            *value = *value + delta;
        }
    }
}

/// The smallest pivot of an elimination and the constraint row that was left with it.
#[derive(Clone, Copy, Debug)]
struct Pivot<T> {
    value: T,
    row: usize,
}

/// Whether a pivot is more than rounding.
pub(crate) fn is_resolvable<T: Real>(pivot: T) -> bool {
    pivot > T::EPSILON * T::constant(SINGULAR_EPSILONS)
}

fn refuse_singular<M: Mechanism<Scalar: Real>>(
    mechanism: &M,
    t: M::Scalar,
    least: Pivot<M::Scalar>,
) -> Result<(), Error> {
    if is_resolvable(least.value) {
        return Ok(());
    }
    Err(Error::Singular {
        t: t.to_f64(),
        pivot: least.value.to_f64(),
        owner: Some(owner(mechanism, least.row)),
    })
}

/// The owner of a constraint row, normalisations included.
fn owner<M: Mechanism<Scalar: Real>>(mechanism: &M, row: usize) -> Owner {
    let rows = mechanism.description().rows;
    let body = || u16::try_from(row.saturating_sub(rows.len())).unwrap_or(u16::MAX);
    rows.get(row).map_or_else(|| Owner::Body(body()), |row| row.owner)
}

#[cfg(test)]
mod tests;
