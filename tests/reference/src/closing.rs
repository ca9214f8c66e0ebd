//! Closing a loop by hand: the angle at which a circle meets a sphere.

use crate::time_jet::Jet;
use crate::{DoubleDouble, Real};

/// Which of the two angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Where `a cos x + b sin x` falls with x.
    Falling,
    /// Where it rises.
    Rising,
}

/// Sine and cosine of the x with `a cos x + b sin x = c`.
pub(crate) fn sine_and_cosine([a, b, c]: [Jet; 3], side: Side) -> (Jet, Jet) {
    let square = a * a + b * b;
    let root = (square - c * c).sqrt();
    let root = if side == Side::Falling { root } else { -root };
    ((b * c + a * root) / square, (a * c - b * root) / square)
}

/// A decimal as a number that stays.
pub(crate) fn fixed(value: f64) -> Jet {
    Jet::constant(crate::trajectory::decimal(value))
}

/// A vector of decimals.
pub(crate) fn point(values: [f64; 3]) -> [Jet; 3] {
    values.map(fixed)
}

/// The unit vector along a direction of decimals.
pub(crate) fn direction(values: [f64; 3]) -> [DoubleDouble; 3] {
    crate::time_jet::unit(point(values)).map(|x| x.value)
}

/// `sin` and `cos` of an angle, as a plane's unit vector.
pub(crate) fn along(angle: Jet) -> [Jet; 2] {
    let (sin, cos) = angle.sin_cos();
    [cos, sin]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_angles_satisfy_the_equation_and_differ_in_their_slope() {
        let [a, b, c] = [0.3, -0.7, 0.2].map(Jet::from);
        for (side, sign) in [(Side::Falling, -1.0), (Side::Rising, 1.0)] {
            let (sin, cos) = sine_and_cosine([a, b, c], side);
            assert!((a * cos + b * sin - c).value.to_f64().abs() < 1e-30);
            assert!((sin * sin + cos * cos).value.to_f64() - 1.0 < 1e-30);
            assert!((b * cos - a * sin).value.to_f64() * sign > 0.0);
        }
    }
}
