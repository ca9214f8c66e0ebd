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
use gyro_program::Kernel;

/// What must be zero of a function; nothing that could be zero of one that is not known here.
pub fn residuals<'a>(kernel: Kernel, case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    match kernel {
        Kernel::InverseDynamics => inverse_dynamics(case),
        Kernel::BiasForces => bias_forces(case),
        Kernel::GravityForces => gravity_forces(case),
        Kernel::MassMatrix => mass_matrix(case),
        Kernel::MassFactor => mass_factor(case),
        Kernel::InverseDerivatives => inverse_derivatives(case),
        Kernel::ForwardDerivatives => forward_derivatives(case),
        Kernel::Regressor => regressor(case),
        _ => Some(vec![Term::one(case.point.context)]),
    }
}

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
fn inverse_dynamics<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let given = any_accelerations(case)?;
    let found = case.run_with("inverse_dynamics", &case.point, &given);
    Some(equal(case, &found, &forces(case, given)?))
}

/// The same at u̇ = 0.
fn bias_forces<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let none = vec![Term::zero(case.point.context); case.module.joints.as_ref()?.n_rates];
    Some(equal(case, &case.run("bias_forces", &case.point), &forces(case, none)?))
}

/// B by columns; none of mechanisms with loops.
fn free_motions<'a>(case: &Case<'a>) -> Option<Vec<Vec<Term<'a>>>> {
    if has_loops(case) { Some(Vec::new()) } else { joints::free_motions(case) }
}

/// `−Bᵀ (m g, 0)`.
fn gravity_forces<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let columns = free_motions(case)?;
    let maximal = case.maximal(&case.joints);
    let weights = case.textbook(&maximal)?.weights()?;
    let expected: Vec<_> = columns.iter().map(|column| dot(column, &weights).neg()).collect();
    Some(equal(case, &case.run("gravity_forces", &case.point), &expected))
}

/// `Bᵀ M B`, row by row, armatures being part of M.
fn masses<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let columns = free_motions(case)?;
    let maximal = case.maximal(&case.joints);
    let textbook = case.textbook(&maximal)?;
    let mass = textbook.mass_matrix();
    let moved: Vec<_> = columns.iter().map(|column| textbook.product(&mass, column)).collect();
    Some(columns.iter().flat_map(|row| moved.iter().map(move |column| dot(row, column))).collect())
}

/// All of it.
fn mass_matrix<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    Some(equal(case, &case.run("mass_matrix", &case.point), &masses(case)?))
}

/// `Σ_k l_ki d_k l_kj` with ones for l_kk; and nothing where L has no place in its order.
fn mass_factor<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
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
fn inverse_derivatives<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let given = any_accelerations(case)?;
    let expected = slopes(case, "inverse_dynamics", &given)?.concat();
    Some(equal(case, &case.run_with("inverse_derivatives", &case.point, &given), &expected))
}

/// ∂u̇/∂(x, u), and a matrix beside it that is `M⁻¹`.
fn forward_derivatives<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
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

/// A vector.
type Three<'a> = [Term<'a>; 3];

fn cross<'a>(a: &Three<'a>, b: &Three<'a>) -> Three<'a> {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i].mul(&b[j]).sub(&a[j].mul(&b[i]))
    })
}

fn plus<'a>(a: &Three<'a>, b: &Three<'a>) -> Three<'a> {
    [0, 1, 2].map(|k| a[k].add(&b[k]))
}

/// `m v`, the columns of m being given.
fn combined<'a>(columns: &[Three<'a>; 3], v: &Three<'a>) -> Three<'a> {
    let [a, b, c] = [0, 1, 2].map(|column| columns[column].map(|entry| entry.mul(&v[column])));
    plus(&plus(&a, &b), &c)
}

/// The columns of A(p), eq. (3): `v + 2 e₀ e × v + 2 e × (e × v)` of the unit vectors v.
fn axes<'a>(one: &Term<'a>, p: &[Term<'a>]) -> [Three<'a>; 3] {
    let (zero, two, e) = (one.sub(one), one.add(one), [p[1], p[2], p[3]]);
    [0, 1, 2].map(|k| {
        let v = [0, 1, 2].map(|l| if k == l { *one } else { zero });
        let turned = cross(&e, &v);
        let (once, twice) = (turned.map(|x| x.mul(&p[0]).mul(&two)), cross(&e, &turned).map(|x| x.mul(&two)));
        plus(&v, &plus(&once, &twice))
    })
}

/// Forces on a point mass at the origin, on one at r to first order in r, and torques of moments of inertia, at the
/// accelerations of any u̇.
fn regressor<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let given = any_accelerations(case)?;
    let found = case.run_with("regressor", &case.point, &given);
    let motion = Motion::with(case, given)?;
    let columns = free_motions(case)?;
    let one = Term::one(case.point.context);
    let zero = one.sub(&one);
    let gravity = case.model.gravity.each_ref().map(|g| case.point.number(g));
    let mut expected = vec![Vec::new(); columns.len()];
    for body in 0..case.n_bodies() {
        let three = |values: &[Term<'a>], first: usize| [0, 1, 2].map(|k| values[first + k]);
        let felt = three(motion.accelerations(), 6 * body);
        let felt = [0, 1, 2].map(|k| felt[k].sub(&gravity[k]));
        let spin_rate = three(motion.accelerations(), 6 * body + 3);
        let spin = three(motion.maximal.velocity(case.model, body), 3);
        let a = axes(&one, &motion.maximal.position(body)[3..]);
        let local = a.each_ref().map(|axis| dot(axis, &felt));
        let units = [0, 1, 2].map(|k| [0, 1, 2].map(|l| if k == l { one } else { zero }));
        let mut wrenches = vec![[felt, [zero; 3]]];
        wrenches.extend(units.iter().map(|r| {
            let swept = plus(&cross(&spin_rate, r), &cross(&spin, &cross(&spin, r)));
            [combined(&a, &swept), cross(r, &local)]
        }));
        wrenches.extend([(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|(row, column)| {
            let mut inertia = [[zero; 3]; 3];
            (inertia[row][column], inertia[column][row]) = (one, one);
            let gyroscopic = cross(&spin, &combined(&inertia, &spin));
            [[zero; 3], plus(&combined(&inertia, &spin_rate), &gyroscopic)]
        }));
        for (row, column) in expected.iter_mut().zip(&columns) {
            row.extend(
                wrenches.iter().map(|wrench| dot(&column[6 * body..6 * body + 6], wrench.as_flattened())),
            );
        }
    }
    Some(equal(case, &found, &expected.concat()))
}
