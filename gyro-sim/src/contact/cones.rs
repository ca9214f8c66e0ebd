//! Forces, or impulses, that surfaces and stops exert on each other at one time: pushes that only push, and friction
//! within its cone.
//!
//! With `r = b + W f`, the accelerations under forces f or the rates after impulses f, each push has `f ≥ 0`, `r ≥ 0`,
//! one of both zero; and of all friction in the tangent plane with `|f| ≤ μ f_push` that is taken which opposes r most:
//! either r = 0, or `|f| = μ f_push` and `f = −s r` with s > 0. One contact after the other is solved exactly (the
//! method of Gauss and Seidel), and then all together by Newton's method for the projections that say the same.

use super::Contact;
use super::small::{at, larger, plus_product};
use crate::Real;

/// What a contact's force may be.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bound<T> {
    /// As it is.
    Given,
    /// Between these, the rate being zero between them.
    Between([T; 2]),
    /// Friction with this coefficient, together with that of the next contact.
    Plane(T),
    /// This times the push of the contact's gap.
    Pulled(T),
}

/// So many rounds at first, in which forces cost a little: of many ways to divide them that is found which has no large
/// ones.
const EVEN: u32 = 100;
const COST: f64 = 1e-3;
/// Then Newton's method, of so many steps, after so many rounds, so often at most.
const STEPS: u32 = 12;
const BETWEEN: u32 = 20;
const ROUNDS: u32 = 12;
/// What is left then, in roundings; and what makes forces unique.
const LEFT: f64 = 16.0;
const LITTLE: f64 = 1e-9;

/// The complementarity problem of some contacts.
pub(super) struct Cones<'a, T, const N: usize> {
    pub(super) contacts: &'a [Contact<T>; N],
    pub(super) compliance: &'a [[T; N]; N],
    pub(super) bounds: [Bound<T>; N],
}

impl<T: Real, const N: usize> Cones<'_, T, N> {
    /// The forces, from a first guess on, and by what they are off, in terms of rates; `Err` of a contact that is
    /// pushed together by its own friction (Painlevé).
    pub(super) fn solved(&self, bias: &[T; N], first: [T; N]) -> Result<([T; N], T), usize> {
        let zero = T::constant(0.0);
        let (mut active, mut n) = ([0; N], 0);
        for k in (0..N).filter(|k| !matches!(self.bounds[*k], Bound::Given)) {
            active[n] = k;
            n += 1;
        }
        let active = &active[..n];
        let mut forces = first;
        self.go_round(active, bias, &mut forces, (EVEN, T::constant(COST)))?;
        let scale =
            self.rates(bias, &forces).iter().chain(bias).fold(zero, |most, rate| larger(most, rate.abs()));
        let limit = T::constant(LEFT) * T::EPSILON * scale;
        let (mut best, mut error) = (forces, T::constant(f64::INFINITY));
        for _ in 0..ROUNDS {
            self.go_round(active, bias, &mut forces, (BETWEEN, zero))?;
            for _ in 0..STEPS {
                let (residual, matrix) = self.linearised(active, bias, &forces);
                let off = active
                    .iter()
                    .fold(zero, |most, &k| larger(most, (residual[k] * self.compliance[k][k]).abs()));
                if off < error {
                    (best, error) = (forces, off);
                }
                let Some(change) = eliminated(matrix, residual, active).filter(|_| off > limit) else {
                    break;
                };
                for &k in active {
                    forces[k] = forces[k] + change[k];
                }
            }
            if error <= limit {
                break;
            }
            forces = best;
        }
        Ok((best, error))
    }

    fn rates(&self, bias: &[T; N], forces: &[T; N]) -> [T; N] {
        plus_product(bias, self.compliance, forces)
    }

    /// One contact after the other, some times; forces cost so much.
    fn go_round(
        &self,
        active: &[usize],
        bias: &[T; N],
        forces: &mut [T; N],
        (rounds, cost): (u32, T),
    ) -> Result<(), usize> {
        let mut rates = self.rates(bias, forces);
        for _ in 0..rounds {
            for &k in active {
                // A push changes the friction that is pulled with it, and both components of friction change together.
                let touched = [k, k + 1, k + 2].map(|j| if j < N { j } else { k });
                let before = touched.map(|j| forces[j]);
                self.solve_one(k, T::constant(1.0) + cost, &rates, forces)?;
                for (place, j) in touched.into_iter().enumerate() {
                    let change = forces[j] - before[place];
                    if change != T::constant(0.0) && !touched[..place].contains(&j) {
                        for &i in active {
                            rates[i] = rates[i] + self.compliance[i][j] * change;
                        }
                    }
                }
            }
        }
        Ok(())
    }

    /// By what forces differ from what they would be after a step against the rates, projected into their bounds; and
    /// the matrix of its derivatives, but for a little that makes forces unique where rates leave them open.
    fn linearised(&self, active: &[usize], bias: &[T; N], forces: &[T; N]) -> ([T; N], [[T; N]; N]) {
        let (zero, one, little) = (T::constant(0.0), T::constant(1.0), T::constant(LITTLE));
        let rates = self.rates(bias, forces);
        let (mut residual, mut matrix) = ([zero; N], [[zero; N]; N]);
        // What a rate is short of zero, in terms of the force that changes it most.
        let rest = |k: usize, residual: &mut [T; N], matrix: &mut [[T; N]; N]| {
            let own = self.compliance[k][k];
            residual[k] = -rates[k] / own;
            matrix[k] = self.compliance[k].map(|w| w / own);
            matrix[k][k] = matrix[k][k] + little;
        };
        for &k in active {
            let own = self.compliance[k][k];
            matrix[k][k] = one;
            match (self.bounds[k], self.contacts[k].slip()) {
                _ if own <= zero => {}
                (Bound::Between([low, high]), _) => {
                    let wanted = forces[k] - rates[k] / own;
                    match (wanted <= low, wanted >= high) {
                        (true, _) => residual[k] = low - forces[k],
                        (_, true) => residual[k] = high - forces[k],
                        _ => rest(k, &mut residual, &mut matrix),
                    }
                }
                (Bound::Pulled(pull), Some((gap, _))) if gap < N => {
                    residual[k] = pull * forces[gap] - forces[k];
                    matrix[k][gap] = -pull;
                }
                (Bound::Plane(coefficient), Some((gap, is_second))) if gap + 2 < N => {
                    let pair = [gap + 1, gap + 2];
                    let step =
                        one / larger(self.compliance[pair[0]][pair[0]], self.compliance[pair[1]][pair[1]]);
                    let wanted = pair.map(|j| forces[j] - step * rates[j]);
                    let length = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
                    let radius = larger(coefficient * forces[gap], zero);
                    if length <= radius {
                        rest(k, &mut residual, &mut matrix);
                        continue;
                    }
                    let way = wanted.map(|x| x / length);
                    let (own, share) = (way[usize::from(is_second)], radius / length);
                    residual[k] = radius * own - forces[k];
                    // f - R u of the direction u of w = f - s r: du = (1 - u uᵀ) dw / |w|.
                    for &j in active {
                        let dw =
                            pair.map(|i| (if i == j { one } else { zero }) - step * self.compliance[i][j]);
                        let along = way[0] * dw[0] + way[1] * dw[1];
                        matrix[k][j] = matrix[k][j] - share * (dw[usize::from(is_second)] - own * along);
                    }
                    if radius > zero {
                        matrix[k][gap] = matrix[k][gap] - coefficient * own;
                    }
                }
                _ => {}
            }
        }
        (residual, matrix)
    }

    /// Makes one contact right, with the others as they are. A cost c of forces counts as a compliance that is c times
    /// what it is.
    fn solve_one(&self, k: usize, cost: T, rates: &[T; N], forces: &mut [T; N]) -> Result<(), usize> {
        let (zero, own) = (T::constant(0.0), self.compliance[k][k]);
        match self.bounds[k] {
            Bound::Given | Bound::Pulled(_) => {}
            Bound::Between([low, high]) => {
                // What slides on it is pulled with it.
                let pulls = [k + 1, k + 2].map(|j| match self.bounds.get(j) {
                    Some(Bound::Pulled(pull)) if self.contacts[j].slip().is_some_and(|(gap, _)| gap == k) => {
                        (j, *pull)
                    }
                    _ => (k, zero),
                });
                let with = pulls.iter().fold(own, |sum, (j, pull)| sum + self.compliance[k][*j] * *pull);
                if own <= zero {
                    return Ok(());
                }
                if with <= zero {
                    return Err(k);
                }
                let rate = rates[k] + (cost - T::constant(1.0)) * with * forces[k];
                let wanted = forces[k] - rate / (with * cost);
                let force = if wanted < low {
                    low
                } else if wanted > high {
                    high
                } else {
                    wanted
                };
                for (j, pull) in pulls {
                    forces[j] = pull * force;
                }
                forces[k] = force;
            }
            Bound::Plane(coefficient) => {
                let Some(((gap, false), other)) = self.contacts[k].slip().zip(Some(k + 1).filter(|k| *k < N))
                else {
                    return Ok(());
                };
                let bound = coefficient * at(forces, gap);
                let cross = self.compliance[k][other];
                let block = [own * cost, cross * cost, self.compliance[other][other] * cost];
                let now = [forces[k], forces[other]];
                let extra = cost - T::constant(1.0);
                let costs =
                    [own * now[0] + cross * now[1], cross * now[0] + self.compliance[other][other] * now[1]];
                let slip = [rates[k] + extra * costs[0], rates[other] + extra * costs[1]];
                let [along, across] = in_disc(block, now, slip, bound);
                (forces[k], forces[other]) = (along, across);
            }
        }
        Ok(())
    }
}

/// Friction in a plane: with `r = slip + A (f − now)`, A symmetric of entries `[a, b; b, c]`, f such that r = 0 if this
/// is within the disc of that radius, and otherwise `f = −s r` on its rim.
fn in_disc<T: Real>([a, b, c]: [T; 3], now: [T; 2], slip: [T; 2], radius: T) -> [T; 2] {
    let (zero, one) = (T::constant(0.0), T::constant(1.0));
    if radius <= zero || a <= zero || c <= zero {
        return [zero; 2];
    }
    let q = [slip[0] - a * now[0] - b * now[1], slip[1] - b * now[0] - c * now[1]];
    // f = −(A + s I)⁻¹ q; |f| falls with s, and 1/|f| is nearly linear in it.
    let at = |s: T, [x, y]: [T; 2]| {
        let (a, c) = (a + s, c + s);
        let determinant = a * c - b * b;
        [(c * x - b * y) / determinant, (a * y - b * x) / determinant]
    };
    let size = |[x, y]: [T; 2]| (x * x + y * y).sqrt();
    // Where one direction does not give way at all, a little does.
    let mut s = if a * c - b * b > T::EPSILON * a * c { zero } else { T::EPSILON * (a + c) };
    let mut found = at(s, q);
    for _ in 0..60 {
        let length = size(found);
        if length <= radius {
            break;
        }
        let moved = at(s, found);
        let slope = (found[0] * moved[0] + found[1] * moved[1]) / (length * length);
        let step = (length / radius - one) / slope;
        if step <= T::EPSILON * s {
            break;
        }
        s = s + step;
        found = at(s, q);
    }
    let length = size(found);
    let scale = if length > radius { radius / length } else { one };
    found.map(|f| -f * scale)
}

/// Solves `A x = b` for the unknowns that are chosen, by elimination with the largest pivots of each column; `None`
/// where there is none.
fn eliminated<T: Real, const N: usize>(
    mut matrix: [[T; N]; N],
    mut right: [T; N],
    chosen: &[usize],
) -> Option<[T; N]> {
    let mut rows = [0; N];
    rows[..chosen.len()].copy_from_slice(chosen);
    for (step, &column) in chosen.iter().enumerate() {
        let best = (step..chosen.len()).fold(step, |best, place| {
            let larger = matrix[rows[place]][column].abs() > matrix[rows[best]][column].abs();
            if larger { place } else { best }
        });
        rows.swap(step, best);
        let (own, known) = (matrix[rows[step]], right[rows[step]]);
        if own[column] == T::constant(0.0) || !own[column].is_finite() {
            return None;
        }
        for &row in &rows[step + 1..chosen.len()] {
            let factor = matrix[row][column] / own[column];
            if factor != T::constant(0.0) {
                chosen[step..].iter().for_each(|&j| matrix[row][j] = matrix[row][j] - factor * own[j]);
                right[row] = right[row] - factor * known;
            }
        }
    }
    let mut found = [T::constant(0.0); N];
    for (step, &column) in chosen.iter().enumerate().rev() {
        let row = &matrix[rows[step]];
        let rest = chosen[step + 1..].iter().fold(right[rows[step]], |sum, &j| sum - row[j] * found[j]);
        found[column] = rest / row[column];
    }
    Some(found)
}
