//! A quantity with its first and second derivative by one variable: an angle that a mechanism follows, or time.
//!
//! What is written down is where bodies are; how they move follows by the rules of differentiation, in double-double
//! numbers. The rotation of a body is that of its axes a, b, c in the global frame, and since ȧ = w_z b − w_y c and so
//! on, its angular velocity in its own frame is w = (ḃ·c, ċ·a, ȧ·b).

use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::DoubleDouble;
use crate::rotation::Precise;

/// Value, first and second derivative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet(pub(crate) [DoubleDouble; 3]);

/// Three of them.
pub(crate) type Arrow = [Jet; 3];

impl Jet {
    pub(crate) fn constant(value: DoubleDouble) -> Self {
        Jet([value, DoubleDouble::ZERO, DoubleDouble::ZERO])
    }

    /// The variable itself.
    pub(crate) fn variable(value: DoubleDouble) -> Self {
        Jet([value, DoubleDouble::new(1.0), DoubleDouble::ZERO])
    }

    /// f(self) for f, f' and f'' at the value.
    fn chained(self, [f, slope, curvature]: [DoubleDouble; 3]) -> Self {
        let [_, first, second] = self.0;
        Jet([f, slope * first, slope * second + curvature * first * first])
    }

    pub(crate) fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0[0].sin_cos();
        (self.chained([sin, cos, -sin]), self.chained([cos, -sin, -cos]))
    }

    pub(crate) fn sqrt(self) -> Self {
        let root = self.0[0].sqrt();
        let slope = DoubleDouble::new(0.5) / root;
        self.chained([root, slope, -(slope / self.0[0]).times(0.5)])
    }

    pub(crate) fn scaled(self, factor: DoubleDouble) -> Self {
        Jet(self.0.map(|part| part * factor))
    }
}

impl Add for Jet {
    type Output = Jet;

    fn add(self, other: Jet) -> Jet {
        Jet(core::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for Jet {
    type Output = Jet;

    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Neg for Jet {
    type Output = Jet;

    fn neg(self) -> Jet {
        Jet(self.0.map(|part| -part))
    }
}

impl Mul for Jet {
    type Output = Jet;

    fn mul(self, other: Jet) -> Jet {
        let ([a, a1, a2], [b, b1, b2]) = (self.0, other.0);
        Jet([a * b, a1 * b + a * b1, a2 * b + (a1 * b1).times(2.0) + a * b2])
    }
}

impl Div for Jet {
    type Output = Jet;

    fn div(self, other: Jet) -> Jet {
        let inverse = DoubleDouble::new(1.0) / other.0[0];
        let square = inverse * inverse;
        self * other.chained([inverse, -square, (square * inverse).times(2.0)])
    }
}

pub(crate) fn fixed(a: Precise) -> Arrow {
    a.map(Jet::constant)
}

pub(crate) fn plus(a: Arrow, b: Arrow) -> Arrow {
    core::array::from_fn(|k| a[k] + b[k])
}

pub(crate) fn minus(a: Arrow, b: Arrow) -> Arrow {
    core::array::from_fn(|k| a[k] - b[k])
}

pub(crate) fn along(factor: Jet, a: Arrow) -> Arrow {
    a.map(|x| factor * x)
}

pub(crate) fn inner(a: Arrow, b: Arrow) -> Jet {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn outer(a: Arrow, b: Arrow) -> Arrow {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Of unit length.
pub(crate) fn unit(a: Arrow) -> Arrow {
    let length = inner(a, a).sqrt();
    a.map(|x| x / length)
}

/// A body that moves.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moving {
    /// Its mass centre.
    pub(crate) centre: Arrow,
    /// Its axes in the global frame.
    pub(crate) axes: [Arrow; 3],
}

impl Moving {
    /// The k-th derivative of the mass centre.
    pub(crate) fn centre_derivative(&self, k: usize) -> Precise {
        self.centre.map(|x| x.0[k])
    }

    /// Angular velocity in the body's own frame and its derivative.
    pub(crate) fn turning(&self) -> [Precise; 2] {
        let [a, b, c] = self.axes;
        let parts = [(b, c), (c, a), (a, b)].map(|(moved, along)| inner_of_slope(moved, along));
        [parts.map(|[w, _]| w), parts.map(|[_, slope]| slope)]
    }
}

/// ȧ·b and its derivative.
fn inner_of_slope(a: Arrow, b: Arrow) -> [DoubleDouble; 2] {
    let sum = |of: &dyn Fn(&Jet, &Jet) -> DoubleDouble| {
        a.iter().zip(&b).fold(DoubleDouble::ZERO, |sum, (a, b)| sum + of(a, b))
    };
    [sum(&|a, b| a.0[1] * b.0[0]), sum(&|a, b| a.0[2] * b.0[0] + a.0[1] * b.0[1])]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trajectory::decimal;

    /// Central differences err by the square of this; rounding is worth 1e-31 over that square.
    const STEP: f64 = 1e-8;
    const DIFFERENCE: f64 = 1e-13;

    fn of(x: Jet) -> [Jet; 4] {
        let (sin, cos) = (x * x).sin_cos();
        let three = Jet::constant(DoubleDouble::new(3.0));
        [sin / (three + cos), (three - sin).sqrt(), -(sin * cos).scaled(decimal(0.3)), cos / (sin * three)]
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        let x = decimal(0.8);
        let at = |offset: f64| of(Jet::variable(x + DoubleDouble::new(offset)));
        let (before, here, after) = (at(-STEP), at(0.0), at(STEP));
        for k in 0..4 {
            for order in 0..2 {
                let found = here[k].0[order + 1].to_f64();
                let slope = (after[k].0[order] - before[k].0[order]).divided_by(2.0 * STEP).to_f64();
                assert!((found - slope).abs() < DIFFERENCE, "{k}, derivative {order}: {found} {slope}");
            }
        }
    }

    #[test]
    fn a_body_that_turns_about_its_third_axis_has_that_angular_velocity() {
        let (sin, cos) = Jet([decimal(0.4), decimal(2.0), decimal(5.0)]).sin_cos();
        let [zero, one] = [0.0, 1.0].map(|x| Jet::constant(DoubleDouble::new(x)));
        let body =
            Moving { centre: [zero; 3], axes: [[cos, sin, zero], [-sin, cos, zero], [zero, zero, one]] };
        let turning = body.turning().map(|part| part.map(DoubleDouble::to_f64));
        for (found, expected) in turning.concat().iter().zip([0.0, 0.0, 2.0, 0.0, 0.0, 5.0]) {
            assert!((found - expected).abs() < 1e-15, "{turning:?}");
        }
    }
}
