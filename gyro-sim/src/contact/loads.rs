//! Friction in proportion to reactions.

use crate::Real;
use core::array::from_fn;

/// Reactions as they follow the forces of contacts: of contact k it is `bias[k] + Σ_j slope[k][j] F_j`.
pub(super) struct Loads<T, const N: usize> {
    pub(super) bias: [[T; 3]; N],
    pub(super) slope: [[[T; 3]; N]; N],
}

/// The forces of contacts in their phases.
pub(super) struct Acting<T, const N: usize> {
    pub(super) forces: [T; N],
    /// The static levels of friction under these forces.
    pub(super) levels: [T; N],
    /// Set where the forces are not determined.
    pub(super) jam: Option<Jam>,
}

/// Friction that may jam.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jam {
    /// Of which contact.
    pub(super) contact: usize,
    /// How much friction a unit of friction adds by way of the reactions, at most.
    pub(super) gain: f64,
}

/// Newton's method, or the contraction where that is faster, has converged after so many iterations, or has not.
const ITERATIONS: u32 = 200;
/// What is left then, in roundings of what stands in the equation.
const LEFT: f64 = 8.0;

pub(super) fn size<T: Real>([x, y, z]: &[T; 3]) -> T {
    (*x * *x + *y * *y + *z * *z).sqrt()
}

fn sum<T: Real, const N: usize>(slopes: &[[T; 3]; N], factors: &[T; N], start: [T; 3]) -> [T; 3] {
    slopes.iter().zip(factors).fold(start, |sum, (slope, factor)| from_fn(|i| sum[i] + slope[i] * *factor))
}

impl<T: Real, const N: usize> Loads<T, N> {
    /// The reactions under these forces.
    pub(super) fn at(&self, forces: &[T; N]) -> [[T; 3]; N] {
        from_fn(|k| self.at_one(k, forces))
    }

    /// That of contact k.
    pub(super) fn at_one(&self, k: usize, forces: &[T; N]) -> [T; 3] {
        sum(&self.slope[k], forces, self.bias[k])
    }

    /// What the reaction of contact k grows by under further forces.
    pub(super) fn along(&self, k: usize, forces: &[T; N]) -> [T; 3] {
        sum(&self.slope[k], forces, [T::constant(0.0); 3])
    }

    /// The size of each reaction without forces of contacts.
    pub(super) fn sizes(&self) -> [T; N] {
        self.bias.each_ref().map(size)
    }
}

/// Friction g that is in proportion to the reactions to which it adds: `g_k = c_k |r_k + Σ_j a_kj g_j|`.
pub(super) struct Growth<T, const N: usize> {
    pub(super) coefficients: [T; N],
    pub(super) loads: [[T; 3]; N],
    pub(super) slopes: [[[T; 3]; N]; N],
}

impl<T: Real, const N: usize> Growth<T, N> {
    /// Its solution. `L_kj = c_k |a_kj|` bounds how much of a change comes back: where the spectral radius of L is less
    /// than one there is one solution, and otherwise there may be none, or several.
    pub(super) fn magnitudes(&self) -> Result<[T; N], Jam> {
        let one = T::constant(1.0);
        let gains: [[T; N]; N] = from_fn(|k| from_fn(|j| self.coefficients[k] * size(&self.slopes[k][j])));
        // I − L is an M-matrix: weights by which L contracts are positive, and pivots in order.
        let matrix = from_fn(|k| from_fn(|j| if k == j { one - gains[k][j] } else { -gains[k][j] }));
        let Some(weights) = eliminated(matrix, [one; N]) else { return Err(jam(&gains)) };
        let heaviest = weights.iter().fold(one, |most, weight| if *weight > most { *weight } else { most });
        let contraction = one - one / heaviest;
        let mut magnitudes = from_fn(|k| self.coefficients[k] * size(&self.loads[k]));
        let mut state = self.residual(&magnitudes, &weights);
        for _ in 0..ITERATIONS {
            if state.is_met {
                return Ok(magnitudes);
            }
            let newton = self.newton(&magnitudes, &state);
            let next = newton.map(|newton| (newton, self.residual(&newton, &weights)));
            (magnitudes, state) = match next {
                Some((newton, next)) if next.norm <= contraction * state.norm || next.is_met => {
                    (newton, next)
                }
                _ => {
                    let next = from_fn(|k| magnitudes[k] - state.residual[k]);
                    (next, self.residual(&next, &weights))
                }
            };
        }
        Err(jam(&gains))
    }

    fn residual(&self, magnitudes: &[T; N], weights: &[T; N]) -> Residual<T, N> {
        let zero = T::constant(0.0);
        let reactions: [[T; 3]; N] = from_fn(|k| sum(&self.slopes[k], magnitudes, self.loads[k]));
        let residual = from_fn(|k| magnitudes[k] - self.coefficients[k] * size(&reactions[k]));
        let (mut norm, mut is_met) = (zero, true);
        for k in 0..N {
            let parts = self.slopes[k].iter().zip(magnitudes);
            let scale = parts.fold(size(&self.loads[k]), |sum, (slope, g)| sum + size(slope) * g.abs());
            let scale = magnitudes[k].abs() + self.coefficients[k] * scale;
            let violation: T = residual[k];
            is_met &= violation.abs() <= T::constant(LEFT) * T::EPSILON * scale;
            let weighted = violation.abs() / weights[k];
            norm = if weighted > norm { weighted } else { norm };
        }
        Residual { reactions, residual, norm, is_met }
    }

    /// A step of Newton's method. Its matrix differs from the identity by less than L does.
    fn newton(&self, magnitudes: &[T; N], state: &Residual<T, N>) -> Option<[T; N]> {
        let [zero, one] = [0.0, 1.0].map(T::constant);
        let matrix = from_fn(|k| {
            let reaction = &state.reactions[k];
            let length = size(reaction);
            from_fn(|j| {
                let along = (0..3).fold(zero, |sum, i| sum + reaction[i] * self.slopes[k][j][i]);
                let gain = if length > zero { self.coefficients[k] * along / length } else { zero };
                if k == j { one - gain } else { -gain }
            })
        });
        let step = eliminated(matrix, state.residual)?;
        Some(from_fn(|k| magnitudes[k] - step[k]))
    }
}

/// How well magnitudes solve their equations.
struct Residual<T, const N: usize> {
    reactions: [[T; 3]; N],
    residual: [T; N],
    /// The largest one, weighted.
    norm: T,
    /// Whether nothing but rounding is left.
    is_met: bool,
}

/// The contact to which most comes back.
fn jam<T: Real, const N: usize>(gains: &[[T; N]; N]) -> Jam {
    let mut worst = Jam { contact: 0, gain: 0.0 };
    for (contact, row) in gains.iter().enumerate() {
        let gain = row.iter().fold(T::constant(0.0), |sum, gain| sum + *gain).to_f64();
        if gain > worst.gain {
            worst = Jam { contact, gain };
        }
    }
    worst
}

/// Solves `A x = b` by elimination in the given order; `None` if a pivot is not positive.
fn eliminated<T: Real, const N: usize>(mut matrix: [[T; N]; N], mut right: [T; N]) -> Option<[T; N]> {
    for pivot in 0..N {
        let own = matrix[pivot];
        if own[pivot] <= T::constant(0.0) || !own[pivot].is_finite() {
            return None;
        }
        for row in pivot + 1..N {
            let factor = matrix[row][pivot] / own[pivot];
            for (element, own) in matrix[row].iter_mut().zip(own).skip(pivot) {
                *element = *element - factor * own;
            }
            right[row] = right[row] - factor * right[pivot];
        }
    }
    for row in (0..N).rev() {
        let known = (row + 1..N).fold(right[row], |sum, column| sum - matrix[row][column] * right[column]);
        right[row] = known / matrix[row][row];
    }
    Some(right)
}

#[cfg(test)]
mod tests;
