//! λ by a balance of forces from the leaves to the roots, for every kind of joint: `Φ_qᵀ λ = f − M a` of each body and
//! its descendants.

use crate::model::lowered::Lowered;
use crate::model::place::Moment;
use crate::number::{Number, number};
use crate::recursive::limbs::Limbs;
use crate::recursive::screws::{Six, dot, plus};
use crate::recursive::sweeps::Space;
use nalgebra::{Matrix6, Vector6};

/// Writes λ at given accelerations `(s̈, ẇ')`.
pub(crate) fn multipliers<T: Number>(
    tree: &Limbs<T>,
    lowered: &Lowered<T>,
    at: Moment<'_, T>,
    accelerations: &[T],
    space: &mut Space<T>,
    lambda: &mut [T],
) {
    differentiate(tree, lowered, at, &mut space.gradients);
    lowered.applied_force(at, &mut space.forces);
    let unbalanced = space.forces.as_chunks_mut::<6>().0;
    for ((force, body), taken) in
        unbalanced.iter_mut().zip(&lowered.scene.bodies).zip(accelerations.as_chunks::<6>().0)
    {
        let turn = body.inertia * nalgebra::Vector3::new(taken[3], taken[4], taken[5]);
        let taken = std::array::from_fn(|k| if k < 3 { taken[k] * body.mass } else { turn[k - 3] });
        *force = plus(force, number(-1.0), &taken);
    }
    lowered.taken_by_rotors(at, accelerations, |place, taken| unbalanced[place / 6][place % 6] -= taken);
    // Torques over the mechanism's size are forces.
    let weight = T::one() / (lowered.size * lowered.size);
    for limb in tree.limbs.iter().rev() {
        let Some(hinge) = &limb.hinge else { continue };
        let rows = &space.gradients[hinge.rows.clone()];
        let lambda = &mut lambda[hinge.rows.clone()];
        solve(rows, weight, &unbalanced[limb.moving_body], lambda);
        if let Some(parent) = hinge.ends(&lowered.scene.joints[hinge.joint]).0.place.moving_body() {
            for ([_, of_parent], lambda) in rows.iter().zip(lambda) {
                unbalanced[parent] = plus(&unbalanced[parent], -*lambda, of_parent);
            }
        }
    }
    for (moving_body, rows) in &tree.held {
        solve(&space.gradients[rows.clone()], weight, &unbalanced[*moving_body], &mut lambda[rows.clone()]);
    }
}

/// The derivatives of each row with respect to the `(r, π')` of the body that it holds, and of that body's parent.
fn differentiate<T: Number>(
    tree: &Limbs<T>,
    lowered: &Lowered<T>,
    at: Moment<'_, T>,
    gradients: &mut [[Six<T>; 2]],
) {
    gradients.fill([[number(0.0); 6]; 2]);
    lowered.phi_pi(at, |row, column, value| {
        gradients[row][usize::from(tree.children[row] != column / 6)][column % 6] = value;
    });
}

/// Solves `Gᵀ λ = force` for the rows G of one body, of which there are six at most: by least squares, as the rows
/// carry whatever their joint must.
fn solve<T: Number>(rows: &[[Six<T>; 2]], weight: T, force: &Six<T>, lambda: &mut [T]) {
    let weighted =
        |v: &Six<T>| -> Six<T> { std::array::from_fn(|k| if k < 3 { v[k] } else { v[k] * weight }) };
    let (mut matrix, mut right) = (Matrix6::identity(), Vector6::zeros());
    for (k, [row, _]) in rows.iter().enumerate() {
        let row = weighted(row);
        right[k] = dot(&row, force);
        rows.iter().enumerate().for_each(|(l, [other, _])| matrix[(k, l)] = dot(&row, other));
    }
    let solution = matrix.cholesky().map(|factor| factor.solve(&right));
    for (k, lambda) in lambda.iter_mut().enumerate() {
        *lambda = solution.map_or(T::zero() / T::zero(), |solution| solution[k]);
    }
}
