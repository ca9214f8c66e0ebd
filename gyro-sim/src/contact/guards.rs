//! Functions that are positive while phases hold.

use super::equations::{Contacts, Forced, bounds};
use super::loads::Acting;
use super::small::at;
use super::{Contact, Phase, Role};
use crate::events::root;
use crate::{Error, Real};

/// A root at the beginning of a step is told from a later one by halving so often.
const HALVINGS: u32 = 48;

/// The guards of all contacts: what is left to the lower and the upper bound, of position or of force, and the rate
/// that friction opposes.
pub(super) struct Guards<T, const N: usize>(pub(super) [[T; N]; 3]);

impl<T, const N: usize> AsRef<[T]> for Guards<T, N> {
    fn as_ref(&self) -> &[T] {
        self.0.as_flattened()
    }
}

/// All guards: positive while the phases hold.
pub(super) fn guards<M, D, T: Real, const N: usize>(
    equations: &Contacts<D, T, N>,
    model: &M,
    (t, y): (T, &D::State),
    scratch: &mut D::State,
) -> Guards<T, N>
where
    D: Forced<M, Scalar = T>,
{
    let infinite = T::constant(f64::INFINITY);
    let largest = T::constant(f64::from(f32::MAX));
    let some = |gap: T| if gap < infinite { gap } else { largest };
    let Acting { forces, levels, .. } = equations.forces(model, (t, y), scratch);
    let places = equations.places(model, (t, y));
    let mut guards = [[largest; N]; 3];
    for (k, contact) in equations.contacts.iter().enumerate() {
        let ([x, rate], phase) = (places[k], equations.phases[k]);
        if let Some((gap, is_second)) = contact.slip() {
            // Both components together, as the first.
            let pair = [gap + 1, gap + 2];
            match phase {
                _ if is_second => {}
                Phase::Sticks => {
                    let [along, across] = pair.map(|slip| at(&forces, slip));
                    guards[0][k] = levels[k] + equations.slack[k] - (along * along + across * across).sqrt();
                }
                Phase::Slides => {
                    let parts = pair.map(|slip| {
                        places.get(slip).map_or(rate, |place| place[1]) * at(&equations.ways, slip)
                    });
                    guards[2][k] = parts[0] + parts[1] + equations.slowest;
                }
                _ => {}
            }
            continue;
        }
        if equations.spent[k] && phase.is_held() {
            guards[2][k] = equations.slowest + equations.slowest - rate.abs();
            continue;
        }
        if contact.role == Role::Gap && phase.is_held() {
            guards[0][k] = forces[k] + equations.weakest;
            continue;
        }
        let (value, [low, high]) =
            if phase.is_held() { (forces[k], bounds(levels[k], phase)) } else { (x, contact.ends) };
        // What only the system sees is held to rounding, not to the bit.
        let [weakest, slowest] = match contact.role {
            Role::Seen => [equations.weakest, equations.slowest],
            _ => [T::constant(0.0); 2],
        };
        let spare = if phase.is_held() { weakest } else { T::constant(0.0) };
        (guards[0][k], guards[1][k]) = (some(value - low + spare), some(high - value + spare));
        match phase {
            Phase::Up => guards[2][k] = rate + slowest,
            Phase::Down => guards[2][k] = slowest - rate,
            _ => {}
        }
    }
    Guards(guards)
}

/// How far rounding may take a guard below zero while it does not go there; positions are of this size.
pub(super) fn noise<T: Real>(contact: &Contact<T>, size: T, kind: usize, begin: T) -> T {
    let end = match contact.role {
        Role::Gap | Role::Seen => size,
        _ => contact.ends.get(kind).map_or(T::constant(0.0), |end| end.abs()),
    };
    let rounding = if end.is_finite() { T::constant(4.0) * T::EPSILON * end } else { T::constant(0.0) };
    rounding - (begin + begin)
}

/// The largest of some numbers.
pub(super) fn size<'a, T: Real + 'a>(numbers: impl Iterator<Item = &'a T>) -> T {
    numbers.fold(T::constant(0.0), |most, x| if x.abs() > most { x.abs() } else { most })
}

/// When a guard that is zero at a step's beginning, or beyond, is passed in it.
pub(super) fn passed<T: Real>(
    mut value: impl FnMut(T) -> Result<T, Error>,
    noise: T,
) -> Result<Option<T>, Error> {
    let (zero, half) = (T::constant(0.0), T::constant(0.5));
    let limit = -noise;
    let place = |k: u8| T::constant(f64::from(k) / 8.0);
    for k in 1..=8 {
        let there = value(place(k))?;
        if there > zero {
            return Ok(None);
        }
        if there < limit {
            let mut beyond = (place(k), there);
            for _ in 0..HALVINGS {
                let nearer = beyond.0 * half;
                let there = value(nearer)?;
                if there > zero {
                    return Ok(Some(root(&mut value, (nearer, there), beyond)?));
                }
                beyond = (nearer, there);
            }
            return Ok(Some(zero));
        }
    }
    Ok(None)
}
