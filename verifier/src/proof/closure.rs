//! What the functions that close the loops of a mechanism in joint coordinates must satisfy.
//!
//! Φ_c are the rows of Φ that the coordinates x do not satisfy by themselves. x moves at rates u by `ẋ = T u`: Euler
//! parameters by `½ Gᵀ u`, all else by u. Then `dΦ_c/dt = J u + ∂Φ_c/∂t` with `J = ∂Φ_c/∂x · T`, by dual numbers
//! through `to_maximal` and the textbook's rows.

use super::case::Case;
use super::dependence;
use super::elimination::Eliminated;
use super::partition::{dot, turning};
use super::residuals::differences;
use crate::field::Field;
use crate::joints::{Freedom, JointLayout, Place};
use crate::point::Point;
use crate::program::Source;
use crate::tape::Term;
use gyro_model::Rational;

/// The rows of Φ_c among all rows.
pub(super) fn of_closure<T: Clone>(layout: &JointLayout, rows: &[T]) -> Vec<T> {
    layout.closure_rows.iter().map(|&row| rows[row].clone()).collect()
}

/// `loop_closure` is Φ_c.
pub fn loop_closure<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let phi = case.textbook(&case.maximal(&case.joints))?.phi()?;
    Some(differences(&case.run("loop_closure", &case.point), &of_closure(layout, &phi)))
}

/// By Gram–Schmidt: what is left of a row of J is perpendicular to the rows before it. Of dependent rows, which
/// yield, it is that of `J Jᵀ + Q`.
pub fn closure_distances<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let mut left: Vec<(Vec<Term<'a>>, Term<'a>)> = Vec::new();
    let (context, jacobian) = (case.point.context, jacobian(case, layout)?);
    let (yielding, n) = (dependence::yielding(case, layout, &jacobian)?, layout.n_rates);
    // Behind a row of J, the combination of rows that it is.
    let product = |a: &[Term<'a>], b: &[Term<'a>]| {
        let (combination, other) = (&a[n..], &b[n..]);
        let yielded = yielding.iter().zip(combination).map(|(row, part)| part.mul(&dot(row, other)));
        yielded.fold(dot(&a[..n], &b[..n]), |sum, part| sum.add(&part))
    };
    for (k, mut row) in jacobian.into_iter().enumerate() {
        row.extend((0..yielding.len()).map(|l| Term::integer(context, i64::from(k == l))));
        for (other, square) in &left {
            let along = product(&row, other).div(square)?;
            row.iter_mut().zip(other).for_each(|(x, other)| *x = x.sub(&along.mul(other)));
        }
        let square = product(&row, &row);
        left.push((row, square));
    }
    let squares: Vec<_> = left.into_iter().map(|(_, square)| square).collect();
    Some(differences(&case.run("closure_distances", &case.point), &squares))
}

/// x changes by a `T δ` for which `J δ = −Φ_c`; nothing else does. Along p the change of Euler parameters is none, and
/// then it is `½ Gᵀ δ` for some δ.
pub fn close_positions<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let changed = case.closed("close_positions", &case.joints);
    let changes = differences(&changed, &case.joints);
    let (of_x, of_rest) = changes.split_at(layout.n_coordinates);
    let mut residuals = of_rest.to_vec();
    residuals.extend(turns_differ(case, layout, &changed)?);
    residuals.extend(layout.euler().map(|p| dot(&case.joints[p..p + 4], &of_x[p..p + 4])));
    let start = case.maximal(&case.joints);
    let phi = case.textbook(&start)?.phi()?;
    let moved = rates_of_closure(case, layout, of_x)?;
    let left: Vec<_> =
        moved.iter().zip(of_closure(layout, &phi)).map(|(moved, phi)| moved.add(&phi)).collect();
    let along = |rates: &[Term<'a>]| coordinates_along(case, layout, rates);
    residuals.extend(unless_yielded(case, layout, (of_x, along), left)?);
    Some(residuals)
}

/// What is left of the rows when they change by `J δ`; of dependent rows, which yield `Q w`, that δ is `Jᵀ w` for a
/// w. The change is that of x, or of u, and `along` says what rates change there.
fn unless_yielded<'a>(
    case: &Case<'a>,
    layout: &JointLayout,
    (change, along): (&[Term<'a>], impl Fn(&[Term<'a>]) -> Option<Vec<Term<'a>>>),
    left: Vec<Term<'a>>,
) -> Option<Vec<Term<'a>>> {
    if case.model.dependent_rows().is_empty() {
        return Some(left);
    }
    let (context, jacobian) = (case.point.context, jacobian(case, layout)?);
    let yielding = dependence::yielding(case, layout, &jacobian)?;
    let moved = jacobian.iter().map(|row| along(row)).collect::<Option<Vec<_>>>()?;
    let matrix = dependence::beside(&moved, &yielding, &Term::one(context));
    let eliminated = Eliminated::of(case, &matrix)?;
    let vector: Vec<_> = change.iter().copied().chain(left.iter().map(Field::neg)).collect();
    Some([eliminated.split(context, &vector).0, eliminated.independence(context)].concat())
}

/// T times some rates.
fn coordinates_along<'a>(case: &Case<'a>, layout: &JointLayout, rates: &[Term<'a>]) -> Option<Vec<Term<'a>>> {
    let mut sum = vec![Term::zero(case.point.context); layout.n_coordinates];
    for (rate, value) in rates.iter().enumerate() {
        let place = layout.places.iter().rfind(|place| place.u <= rate)?;
        let column = directions(case, layout, place, rate - place.u)?;
        sum.iter_mut().zip(column).for_each(|(sum, entry)| *sum = sum.add(&entry.mul(value)));
    }
    Some(sum)
}

/// Turn references are set to the angles that the state has before.
fn turns_differ<'a>(case: &Case<'a>, layout: &JointLayout, found: &[Term<'a>]) -> Option<Vec<Term<'a>>> {
    let maximal = case.maximal(&case.joints);
    let textbook = case.textbook(&maximal)?;
    let turns = layout.places.iter().filter_map(|place| match place.of {
        Freedom::Turn(on) => Some((place.x, on)),
        _ => None,
    });
    turns.map(|(x, on)| Some(found[x].sub(&textbook.continuous_angle(on)?))).collect()
}

/// u changes such that `dΦ_c/dt = 0`; nothing else does. Rates at which that is so already are left as they are.
pub fn close_velocities<'a>(case: &Case<'a>) -> Option<Vec<Term<'a>>> {
    let layout = case.module.joints.as_ref()?;
    let closed = case.closed("close_velocities", &case.joints);
    let (x, rest) = (0..layout.n_coordinates, layout.n_motion()..layout.n_state());
    let mut residuals = differences(&closed[x.clone()], &case.joints[x]);
    residuals.extend(differences(&closed[rest.clone()], &case.joints[rest]));
    let left = of_closure(layout, &case.textbook(&case.maximal(&closed))?.velocity_residual()?);
    let changes = differences(&closed, &case.joints);
    let change = &changes[layout.n_coordinates..layout.n_motion()];
    residuals.extend(unless_yielded(
        case,
        layout,
        (change, |rates: &[Term<'a>]| Some(rates.to_vec())),
        left,
    )?);
    if !case.model.dependent_rows().is_empty() {
        return Some(residuals);
    }
    let kept = kept_rates(case, layout)?;
    residuals.extend(differences(&case.closed("close_velocities", &kept), &kept));
    Some(residuals)
}

/// Any joint state at which `dΦ_c/dt = 0`: some rates are such that it is, the others are any.
fn kept_rates<'a>(case: &Case<'a>, layout: &JointLayout) -> Option<Vec<Term<'a>>> {
    let jacobian = Eliminated::of(case, &jacobian(case, layout)?)?;
    let residual = case.textbook(&case.maximal(&case.joints))?.velocity_residual()?;
    let changes = jacobian.solution(case.point.context, &of_closure(layout, &residual));
    let mut kept = case.joints.clone();
    for (rate, change) in kept[layout.n_coordinates..].iter_mut().zip(changes) {
        *rate = rate.sub(&change);
    }
    Some(kept)
}

/// J by rows.
pub(super) fn jacobian<'a>(case: &Case<'a>, layout: &JointLayout) -> Option<Vec<Vec<Term<'a>>>> {
    let column = |rate: usize| {
        let place = layout.places.iter().rfind(|place| place.u <= rate)?;
        rates_of_closure(case, layout, &directions(case, layout, place, rate - place.u)?)
    };
    let columns = (0..layout.n_rates).map(column).collect::<Option<Vec<_>>>()?;
    let row = |k: usize| columns.iter().map(|column| column[k]).collect();
    Some((0..layout.closure_rows.len()).map(row).collect())
}

/// A column of T.
fn directions<'a>(
    case: &Case<'a>,
    layout: &JointLayout,
    place: &Place,
    rate: usize,
) -> Option<Vec<Term<'a>>> {
    let context = case.point.context;
    let mut directions = vec![Term::zero(context); layout.n_coordinates];
    match place.of.euler() {
        // Displacements come before Euler parameters, and there are as many as rates of them.
        Some(euler) if rate >= euler => {
            let axis = [0, 1, 2].map(|k| Term::integer(context, i64::from(euler + k == rate)));
            let half = Term::from_rational(context, &Rational::new(1.into(), 2.into()));
            let p = place.x + euler;
            let turned = turning(&case.joints[p..p + 4], &axis);
            turned.iter().zip(&mut directions[p..]).for_each(|(e, direction)| *direction = e.mul(&half));
        }
        _ => directions[place.x + rate] = Term::one(context),
    }
    Some(directions)
}

/// How fast Φ_c changes if x does at these rates.
fn rates_of_closure<'a>(case: &Case<'a>, layout: &JointLayout, of_x: &[Term<'a>]) -> Option<Vec<Term<'a>>> {
    let rate = |source| match source {
        Source::Joint(k) => of_x.get(k).copied(),
        _ => None,
    };
    let [state, rates] = case.run_along("to_maximal", case.given(&case.point), &rate)?;
    let point = Point { state, ..case.point.clone() };
    let textbook = case.textbook(&point)?;
    let phi_q = textbook.phi_q()?;
    Some(of_closure(layout, &textbook.product(&phi_q, &rates[..7 * case.n_bodies()])))
}
