//! What functions must satisfy that controllers of robots ask for.
//!
//! With `B = ∂v/∂u` and v̇ at given u̇, both as in [`super::joints`], `τ = Bᵀ (M v̇ − f)`: what does the work on free
//! motions that the model's forces leave to be done. Of mechanisms with loops nothing of this is claimed, so it is
//! refuted.

use super::case::{Arguments, Case};
use super::joints::{self, Motion};
use super::partition::{dot, turning};
use super::residuals::differences;
use crate::field::Field;
use crate::program::Source;
use crate::tape::Term;

/// Any numbers for u̇: as good as any others are those of a motion.
fn any_accelerations<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    case.motion.get(..layout.n_rates).map(<[Term<'a>]>::to_vec)
}

/// τ at some u̇; not what it should be of mechanisms with loops.
fn forces<'a>(case: &Case<'a>, accelerations: Vec<Term<'a>>) -> Option<Vec<Term<'a>>> {
    let motion = Motion::with(case, accelerations)?;
    let [forces, _] = motion.balance()?;
    Some(if has_loops(case) { Vec::new() } else { forces })
}

fn has_loops(case: &Case<'_>) -> bool {
    case.module.joints.as_ref().is_none_or(|layout| !layout.closure_rows.is_empty())
}

/// Some numbers and what they should be, which are as many.
fn equal<'a>(case: &Case<'a>, found: &[Term<'a>], expected: &[Term<'a>]) -> Vec<Term<'a>> {
    if found.len() != expected.len() {
        return vec![Term::one(case.point.context)];
    }
    differences(found, expected)
}

/// `Bᵀ (M v̇ − f)` at any u̇.
pub fn inverse_dynamics<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let given = any_accelerations(case)?;
    let found = case.run_with("inverse_dynamics", &case.point, &given);
    Some(equal(case, &found, &forces(case, given)?))
}

/// The same at u̇ = 0.
pub fn bias_forces<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let none = vec![Term::zero(case.point.context); case.module.joints.as_ref()?.n_rates];
    Some(equal(case, &case.run("bias_forces", &case.point), &forces(case, none)?))
}

/// B by columns; none of mechanisms with loops.
fn free_motions<'a>(case: &Case<'a>) -> Option<Vec<Vec<Term<'a>>>> {
    if has_loops(case) { Some(Vec::new()) } else { joints::free_motions(case) }
}

/// `−Bᵀ (m g, 0)`.
pub fn gravity_forces<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let columns = free_motions(case)?;
    let weights = case.textbook(&case.point)?.weights();
    let expected: Vec<_> = columns.iter().map(|column| dot(column, &weights).neg()).collect();
    Some(equal(case, &case.run("gravity_forces", &case.point), &expected))
}

/// `Bᵀ diag(M, J') B`, row by row.
fn masses<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let columns = free_motions(case)?;
    let textbook = case.textbook(&case.point)?;
    let mass = textbook.mass_matrix();
    let moved: Vec<_> = columns.iter().map(|column| textbook.product(&mass, column)).collect();
    Some(columns.iter().flat_map(|row| moved.iter().map(move |column| dot(row, column))).collect())
}

/// All of it.
pub fn mass_matrix<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    Some(equal(case, &case.run("mass_matrix", &case.point), &masses(case)?))
}

/// `Σ_k l_ki d_k l_kj` with ones for l_kk; and nothing where L has no place in its order.
pub fn mass_factor<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let (factor, order) = (case.run("mass_factor", &case.point), &case.module.mass_order);
    let (n, context) = (order.len(), case.point.context);
    let entry =
        |row: usize, column: usize| if row == column { Term::one(context) } else { factor[n * row + column] };
    let mut product = vec![Term::zero(context); n * n];
    let mut residuals = Vec::new();
    for (place, &k) in order.iter().enumerate() {
        let (carrying, others) = order.split_at(place + 1);
        residuals.extend(others.iter().map(|&j| factor[n * k + j]));
        for &i in carrying {
            let scaled = entry(k, i).mul(&factor[n * k + k]);
            for &j in carrying {
                product[n * i + j] = product[n * i + j].add(&scaled.mul(&entry(k, j)));
            }
        }
    }
    residuals.extend(equal(case, &product, &masses(case)?));
    Some(residuals)
}

/// What changes of a joint state if a rate displaces it by one: of Euler parameters `½ Gᵀ e`.
fn displacements<'a>(case: &Case<'a>) -> Option<Vec<Vec<Term<'a>>>> {
    let (layout, context) = (case.module.joints.as_ref()?, case.point.context);
    let (zero, one) = (Term::zero(context), Term::one(context));
    let half = one.mul(&one.add(&one).inv()?);
    let mut all = Vec::new();
    for place in &layout.places {
        let (_, rates) = place.of.sizes();
        let n_straight = if place.of.euler().is_some() { rates - 3 } else { rates };
        for k in 0..rates {
            let mut change = vec![zero; layout.n_state()];
            if k < n_straight {
                change[place.x + k] = one;
            } else {
                let start = place.x + place.of.euler()?;
                let axis = [0, 1, 2].map(|l| if l + n_straight == k { one } else { zero });
                let twice = turning(&case.joints[start..start + 4], &axis);
                twice.iter().enumerate().for_each(|(l, e)| change[start + l] = e.mul(&half));
            }
            all.push(change);
        }
    }
    Some(all)
}

/// n × 2n, row by row: how the results of a function change with positions and rates.
fn slopes<'a>(case: &Case<'a>, function: &str, accelerations: &[Term<'a>]) -> Option<Vec<Vec<Term<'a>>>> {
    let (layout, one) = (case.module.joints.as_ref()?, Term::one(case.point.context));
    let given = Arguments { accelerations, ..case.given(&case.point) };
    let mut columns = Vec::new();
    for change in displacements(case)? {
        let [_, column] = case.run_along(function, given, &|source| match source {
            Source::Joint(k) => Some(change[k]),
            _ => None,
        })?;
        columns.push(column);
    }
    for rate in 0..layout.n_rates {
        let own = Source::Joint(layout.n_coordinates + rate);
        let [_, column] = case.run_along(function, given, &|source| (source == own).then_some(one))?;
        columns.push(column);
    }
    Some((0..layout.n_rates).map(|row| columns.iter().map(|column| column[row]).collect()).collect())
}

/// ∂τ/∂(x, u) at any u̇.
pub fn inverse_derivatives<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let given = any_accelerations(case)?;
    let expected = slopes(case, "inverse_dynamics", &given)?.concat();
    Some(equal(case, &case.run_with("inverse_derivatives", &case.point, &given), &expected))
}

/// ∂u̇/∂(x, u), and a matrix beside it that is `M⁻¹`.
pub fn forward_derivatives<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let (n, masses) = (case.module.joints.as_ref()?.n_rates, masses(case)?);
    let found = case.run("forward_derivatives", &case.point);
    if masses.len() != n * n || found.len() != 3 * n * n {
        return Some(vec![Term::one(case.point.context)]);
    }
    let rows: Vec<_> = found.chunks(3 * n).map(|row| row.split_at(2 * n)).collect();
    let expected = slopes(case, "joint_accelerations", &[])?;
    let mut residuals = Vec::new();
    for ((found, _), expected) in rows.iter().zip(&expected) {
        residuals.extend(differences(found, expected));
    }
    for (row, mass) in masses.chunks(n).enumerate() {
        for column in 0..n {
            let inverse: Vec<_> = rows.iter().map(|(_, inverse)| inverse[column]).collect();
            let product = dot(mass, &inverse);
            let one = Term::one(case.point.context);
            residuals.push(if row == column { product.sub(&one) } else { product });
        }
    }
    Some(residuals)
}
