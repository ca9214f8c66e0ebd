//! Roots and least values of a function of one number.

use crate::Real;

/// More than this many evaluations mean that a function has no sign.
const MAX_EVALUATIONS: u32 = 128;

/// A root between two places where a function has different signs, to rounding: of the last two places that bracket it,
/// the one where the function is smaller. By inverse quadratic interpolation where that is safe, else by halving: T. R.
/// Chandrupatla (1997).
///
/// # Errors
/// Those of the function.
pub fn root<T: Real, E>(
    mut f: impl FnMut(T) -> Result<T, E>,
    (a, fa): (T, T),
    (b, fb): (T, T),
) -> Result<T, E> {
    let [zero, half, one] = [0.0, 0.5, 1.0].map(T::constant);
    // The newest place, the last one on the other side, and the one that was given up.
    let ((mut x, mut fx), (mut other, mut f_other)) = ((b, fb), (a, fa));
    let (mut before, mut f_before);
    let mut part = half;
    for _ in 0..MAX_EVALUATIONS {
        let (best, least) = if fx.abs() < f_other.abs() { (x, fx) } else { (other, f_other) };
        let way = (other - x).abs();
        let resolution = T::EPSILON * best.abs();
        if least == zero || way <= resolution {
            return Ok(best);
        }
        let margin = half * resolution / way;
        let margin = if margin < half { margin } else { half };
        let part_kept = if part < margin { margin } else { part };
        let part_kept = if part_kept > one - margin { one - margin } else { part_kept };
        let next = x + part_kept * (other - x);
        if next == x || next == other {
            return Ok(best);
        }
        let value = f(next)?;
        if (value > zero) == (fx > zero) {
            (before, f_before) = (x, fx);
        } else {
            (before, f_before) = (other, f_other);
            (other, f_other) = (x, fx);
        }
        (x, fx) = (next, value);
        let xi = (x - other) / (before - other);
        let phi = (fx - f_other) / (f_before - f_other);
        let is_safe = phi * phi < xi && (one - phi) * (one - phi) < one - xi;
        part = if is_safe {
            let inner = fx / (f_other - fx) * (f_before / (f_other - f_before));
            let outer =
                (before - x) / (other - x) * (fx / (f_before - fx)) * (f_other / (f_before - f_other));
            inner + outer
        } else {
            half
        };
    }
    Ok(if fx.abs() < f_other.abs() { x } else { other })
}

/// Golden section: so many parts of the interval are tried.
const SECTIONS: u32 = 40;

/// A place between two where a function that falls from the one and rises to the other is not positive, or `None` if
/// there is none to be found: of a function with one least value its place, to half the digits.
pub(crate) fn dip<T: Real, E>(
    mut f: impl FnMut(T) -> Result<T, E>,
    [mut a, mut b]: [T; 2],
) -> Result<Option<(T, T)>, E> {
    let golden = T::constant(0.618_033_988_749_894_9);
    let zero = T::constant(0.0);
    let [mut left, mut right] = [b - golden * (b - a), a + golden * (b - a)];
    let [mut f_left, mut f_right] = [f(left)?, f(right)?];
    for _ in 0..SECTIONS {
        for (place, value) in [(left, f_left), (right, f_right)] {
            if value <= zero {
                return Ok(Some((place, value)));
            }
        }
        if f_left < f_right {
            (b, right, f_right) = (right, left, f_left);
            left = b - golden * (b - a);
            f_left = f(left)?;
        } else {
            (a, left, f_left) = (left, right, f_right);
            right = a + golden * (b - a);
            f_right = f(right)?;
        }
    }
    Ok(None)
}
