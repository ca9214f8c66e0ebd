//! What rows yield some of which always depend on the others, but not always the same ones: `J u̇ = γ + Q λ` with
//! `Q = (1 + 2²⁰ J Jᵀ)⁻⁸`, lengths in units of the mechanism's size. Where loops are closed Q is the projector onto
//! what is perpendicular to the columns of J, γ has nothing along it, and all rows are met. Here, where loops are
//! torn, it is what it is written to be.

use super::case::Case;
use super::elimination::Eliminated;
use super::partition::dot;
use crate::field::Field;
use crate::joints::JointLayout;
use crate::tape::Term;
use gyro_model::{Rational, RowUnit};
use num_traits::Pow;

/// Q by rows of the closure, of which J is the Jacobian; nothing if all rows are independent.
pub(super) fn yielding<'a>(
    case: &Case<'a>,
    layout: &JointLayout,
    jacobian: &[Vec<Term<'a>>],
) -> Option<Vec<Vec<Term<'a>>>> {
    let (sets, context) = (case.model.dependent_rows(), case.point.context);
    if sets.is_empty() {
        return Some(Vec::new());
    }
    let rows = case.model.rows();
    let zero = Term::zero(context);
    let mut all = vec![vec![zero; jacobian.len()]; jacobian.len()];
    for set in sets {
        let places: Vec<_> =
            (0..jacobian.len()).filter(|place| set.contains(&layout.closure_rows[*place])).collect();
        let units = places.iter().map(|&place| match rows[layout.closure_rows[place]].unit {
            RowUnit::Length => power_of_two(case, case.model.units_of_dependence()[0]),
            RowUnit::Pure => Term::one(context),
        });
        let units: Vec<_> = units.collect();
        let scaled: Option<Vec<Vec<_>>> = (places.iter().zip(&units))
            .map(|(&place, unit)| jacobian[place].iter().map(|entry| entry.div(unit)).collect())
            .collect();
        let own = projector(case, &scaled?)?;
        for (k, row) in own.iter().enumerate() {
            for (l, entry) in row.iter().enumerate() {
                all[places[k]][places[l]] = entry.mul(&units[k].mul(&units[l]));
            }
        }
    }
    Some(all)
}

/// What Q is multiplied by beside `J M⁻¹ Jᵀ`.
pub(super) fn lightness<'a>(case: &Case<'a>) -> Term<'a> {
    let [size, mass] = case.model.units_of_dependence();
    power_of_two(case, -mass - 2 * size)
}

/// The rows of J, each followed by that of Q times a factor.
pub(super) fn beside<'a>(
    jacobian: &[Vec<Term<'a>>],
    yielding: &[Vec<Term<'a>>],
    factor: &Term<'a>,
) -> Vec<Vec<Term<'a>>> {
    let row = |(row, yielding): (&Vec<Term<'a>>, &Vec<Term<'a>>)| {
        row.iter().copied().chain(yielding.iter().map(|entry| entry.mul(factor))).collect()
    };
    jacobian.iter().zip(yielding).map(row).collect()
}

fn projector<'a>(case: &Case<'a>, jacobian: &[Vec<Term<'a>>]) -> Option<Vec<Vec<Term<'a>>>> {
    let (n, context) = (jacobian.len(), case.point.context);
    let sharpness = power_of_two(case, 20);
    let integer = |k: usize, l: usize| Term::integer(context, i64::from(k == l));
    let entry = |k: usize, l: usize| dot(&jacobian[k], &jacobian[l]).mul(&sharpness).add(&integer(k, l));
    let matrix: Vec<Vec<_>> = (0..n).map(|k| (0..n).map(|l| entry(k, l)).collect()).collect();
    let eliminated = Eliminated::of(case, &matrix)?;
    let unit = |k: usize| (0..n).map(|l| integer(k, l)).collect::<Vec<_>>();
    let mut power: Vec<Vec<_>> = (0..n).map(|k| eliminated.solution(context, &unit(k))).collect();
    for _ in 0..3 {
        let product = |a: &Vec<Term<'a>>| power.iter().map(|b| dot(a, b)).collect();
        power = power.iter().map(product).collect();
    }
    Some(power)
}

fn power_of_two<'a>(case: &Case<'a>, exponent: i32) -> Term<'a> {
    let two = Rational::from_integer(2.into());
    Term::from_rational(case.point.context, &Pow::pow(two, exponent))
}
