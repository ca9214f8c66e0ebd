//! The elementary functions themselves, and all that is known of them: how they change, where their values are, what a
//! sign does to them.

use super::Atoms;
use crate::field::{Field, Real};
use crate::program::Function;
use crate::range::Range;
use astro_float_num::BigFloat;
use gyro_model::Spline;
use std::cmp::Ordering;

/// Why [`Function::Curve`] is no atom by itself.
pub(super) const CURVES: &str = "curves are with their tables, in `Node::Curve`";

/// Atoms of floating-point numbers.
#[derive(Clone, Copy, Debug)]
pub struct Elementary;

/// What becomes of a function when the sign of its first operand changes: its sign changes, nothing, or all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Symmetry {
    Odd,
    Even,
    Neither,
}

pub(super) fn symmetry(function: Function) -> Symmetry {
    match function {
        Function::Sin | Function::Tanh | Function::Atan2 => Symmetry::Odd,
        Function::Cos | Function::Abs => Symmetry::Even,
        Function::Sqrt
        | Function::Exp
        | Function::Ln
        | Function::Floor
        | Function::When
        | Function::Unless
        | Function::Curve { .. } => Symmetry::Neither,
    }
}

/// Below this an exponential is rounded to zero, or nearly.
const LEAST_EXPONENT: f64 = -700.0;

/// What a function may be of operands that may be anything in these ranges.
pub(crate) fn range_of_call(function: Function, [x, y]: [Range; 2]) -> Range {
    match function {
        Function::Sin | Function::Cos | Function::Tanh => Range::UNIT,
        Function::Sqrt => Range { low: x.low.max(0.0).sqrt(), high: x.high.max(0.0).sqrt(), ..x },
        Function::Atan2 | Function::Curve { .. } => Range::ANY,
        Function::Exp => {
            Range { low: libm::exp(x.low), high: libm::exp(x.high), is_nonzero: x.low > LEAST_EXPONENT }
        }
        Function::Ln => {
            Range { low: libm::log(x.low.max(0.0)), high: libm::log(x.high.max(0.0)), is_nonzero: false }
        }
        Function::Abs => Range { low: x.low.max(-x.high).max(0.0), high: x.high.max(-x.low), ..x },
        Function::Floor => {
            let is_nonzero = x.low >= 1.0 || x.high < 0.0;
            Range { low: libm::floor(x.low), high: libm::floor(x.high), is_nonzero }
        }
        Function::When | Function::Unless => {
            Range { low: y.low.min(0.0), high: y.high.max(0.0), is_nonzero: false }
        }
    }
}

/// The derivative of a function, its operands, its value and their derivatives being given, as `rates` has them.
pub(crate) fn rate_of_call<F: Field>(
    function: Function,
    ([x, y], value): ([&F; 2], &F),
    [dx, dy]: [Option<&F>; 2],
    atoms: &dyn Atoms<F>,
) -> Option<Option<F>> {
    let times = |rate: Option<&F>, factor: &F| rate.map(|rate| rate.mul(factor));
    Some(match function {
        Function::Sqrt => quotient(dx.cloned(), &value.add(value))?,
        Function::Sin => times(dx, &atoms.cos(x)),
        Function::Cos => times(dx, &atoms.sin(x).neg()),
        Function::Tanh => sum(dx.cloned(), times(dx, &value.mul(value)).map(|x| x.neg())),
        Function::Atan2 => {
            let turned = sum(times(dx, y), times(dy, x).map(|x| x.neg()));
            quotient(turned, &y.mul(y).add(&x.mul(x)))?
        }
        Function::Exp => times(dx, value),
        Function::Ln => quotient(dx.cloned(), x)?,
        // Positive numbers change as they do, negative ones the other way.
        Function::Abs => dx.map(|dx| atoms.when(x, dx).sub(&atoms.when(&x.neg(), dx))),
        Function::Floor => None,
        Function::Curve { .. } => unreachable!("{CURVES}"),
        // What is not taken may change infinitely fast: zero is no factor of it.
        Function::When | Function::Unless => dy.map(|dy| atoms.call(function, [x, dy])),
    })
}

/// A number, or zero, by a condition that is compared with zero; nothing is chosen by what is no number.
fn chosen<T: PartialOrd + Default>(function: Function, condition: T, x: T) -> T {
    match (function, condition.partial_cmp(&T::default())) {
        (_, None) => condition,
        (Function::When, Some(Ordering::Greater)) => x,
        (Function::Unless, Some(Ordering::Less | Ordering::Equal)) => x,
        _ => T::default(),
    }
}

/// A sum of which terms may be zero by structure.
pub(crate) fn sum<F: Field>(a: Option<F>, b: Option<F>) -> Option<F> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.add(&b)),
        (a, b) => a.or(b),
    }
}

/// Zero by structure over anything is zero by structure; nothing by zero.
pub(crate) fn quotient<F: Field>(a: Option<F>, b: &F) -> Option<Option<F>> {
    match a {
        Some(a) => a.div(b).map(Some),
        None => Some(None),
    }
}

impl Atoms<f64> for Elementary {
    fn call(&self, function: Function, [x, y]: [&f64; 2]) -> f64 {
        match function {
            Function::Sqrt => libm::sqrt(*x),
            Function::Sin => libm::sin(*x),
            Function::Cos => libm::cos(*x),
            Function::Tanh => libm::tanh(*x),
            Function::Atan2 => libm::atan2(*x, *y),
            Function::Exp => libm::exp(*x),
            Function::Ln => libm::log(*x),
            Function::Abs => libm::fabs(*x),
            Function::Floor => libm::floor(*x),
            Function::Curve { .. } => unreachable!("{CURVES}"),
            Function::When | Function::Unless => chosen(function, *x, *y),
        }
    }

    fn spline(&self, table: &Spline, t: &f64) -> [f64; 4] {
        table.jet(*t)
    }
}

impl Atoms<f32> for Elementary {
    fn call(&self, function: Function, [x, y]: [&f32; 2]) -> f32 {
        match function {
            Function::Sqrt => libm::sqrtf(*x),
            Function::Sin => libm::sinf(*x),
            Function::Cos => libm::cosf(*x),
            Function::Tanh => libm::tanhf(*x),
            Function::Atan2 => libm::atan2f(*x, *y),
            Function::Exp => libm::expf(*x),
            Function::Ln => libm::logf(*x),
            Function::Abs => libm::fabsf(*x),
            Function::Floor => libm::floorf(*x),
            Function::Curve { .. } => unreachable!("{CURVES}"),
            Function::When | Function::Unless => chosen(function, *x, *y),
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
    fn spline(&self, table: &Spline, t: &f32) -> [f32; 4] {
        table.jet(f64::from(*t)).map(|x| x as f32)
    }
}

impl<'c> Atoms<Real<'c>> for Elementary {
    fn call(&self, function: Function, [x, y]: [&Real<'c>; 2]) -> Real<'c> {
        match function {
            Function::Sqrt => x.sqrt(),
            Function::Sin => x.by(BigFloat::sin),
            Function::Cos => x.by(BigFloat::cos),
            Function::Tanh => x.by(BigFloat::tanh),
            Function::Atan2 => x.atan2(y),
            Function::Exp => x.by(BigFloat::exp),
            Function::Ln => x.by(BigFloat::ln),
            Function::Abs => x.abs(),
            Function::Floor => x.floor(),
            Function::Curve { .. } => unreachable!("{CURVES}"),
            Function::When => x.choose(y, &x.like(0.0)),
            Function::Unless => x.choose(&x.like(0.0), y),
        }
    }

    /// The piece is found as for an `f64`; it is evaluated in many bits, straight continuation included.
    fn spline(&self, table: &Spline, t: &Real<'c>) -> [Real<'c>; 4] {
        let (knots, last) = (&table.knots, table.pieces.len());
        let past = knots.partition_point(|&knot| !t.is_less(&t.like(knot)));
        let piece = past.clamp(1, last) - 1;
        let u = t.sub(&t.like(knots[piece]));
        if past == 0 {
            let [value, slope, ..] = cubic(&table.pieces[0], &t.like(0.0));
            return [value.add(&slope.mul(&u)), slope, t.like(0.0), t.like(0.0)];
        }
        let width = t.like(knots[last]).sub(&t.like(knots[piece]));
        if past > last && width.is_less(&u) {
            let [value, slope, ..] = cubic(&table.pieces[piece], &width);
            return [value.add(&slope.mul(&u.sub(&width))), slope, t.like(0.0), t.like(0.0)];
        }
        cubic(&table.pieces[piece], &u)
    }
}

/// Value and three derivatives of a cubic.
fn cubic<'c>(coefficients: &[f64; 4], u: &Real<'c>) -> [Real<'c>; 4] {
    let horner = |coefficients: &[f64]| {
        coefficients.iter().rev().fold(u.like(0.0), |sum, &c| sum.mul(u).add(&u.like(c)))
    };
    let [c0, c1, c2, c3] = *coefficients;
    let three_c3 = u.like(3.0).mul(&u.like(c3));
    let slope = horner(&[c1]).add(&u.mul(&u.like(2.0).mul(&u.like(c2)).add(&u.mul(&three_c3))));
    let bend = u.like(2.0).mul(&u.like(c2).add(&three_c3.mul(u)));
    let third = u.like(2.0).mul(&three_c3);
    [horner(&[c0, c1, c2, c3]), slope, bend, third]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::field::Precision;

    /// To be off by this is impossible with 384 bits and a bug with 53.
    const TOLERANCE: f64 = 1e-100;

    fn check(x: &Real, expected: &Real) {
        assert!(x.sub(expected).to_f64().abs() <= TOLERANCE, "{x:?} {expected:?}");
    }

    #[test]
    fn functions_satisfy_their_identities_to_a_hundred_digits() {
        let precision = Precision::new();
        for x in [-3.0, -0.7, 1e-3, 0.4, 2.5] {
            let x = Real::new(&precision, x);
            let (sin, cos) = (Elementary.sin(&x), Elementary.cos(&x));
            check(&sin.mul(&sin).add(&cos.mul(&cos)), &x.like(1.0));
            check(&sin.atan2(&cos), &x);
            check(&x.mul(&x).sqrt(), &if x.is_less(&x.like(0.0)) { x.neg() } else { x.clone() });
            // tanh 2x = 2 tanh x / (1 + tanh² x).
            let tanh = Elementary.tanh(&x);
            let double = tanh.add(&tanh).div(&x.like(1.0).add(&tanh.mul(&tanh))).expect("positive");
            check(&Elementary.tanh(&x.add(&x)), &double);
            // tanh x = (e²ˣ − 1) / (e²ˣ + 1).
            let (exp, one) = (Elementary.exp(&x.add(&x)), x.like(1.0));
            check(&exp.sub(&one).div(&exp.add(&one)).expect("positive"), &tanh);
            check(&Elementary.ln(&exp), &x.add(&x));
            check(&Elementary.abs(&x), &x.mul(&x).sqrt());
            check(&Elementary.floor(&x), &x.like(x.to_f64().floor()));
            check(&Elementary.when(&x, &exp).add(&Elementary.unless(&x, &exp)), &exp);
        }
    }

    #[test]
    fn what_is_not_taken_has_no_effect() {
        let precision = Precision::new();
        for (condition, is_positive) in [(0.5, true), (0.0, false), (-0.5, false), (f64::NAN, false)] {
            for x in [2.5, f64::INFINITY, f64::NAN] {
                let real = |x: f64| Real::new(&precision, x);
                for (function, is_taken) in [(Function::When, is_positive), (Function::Unless, !is_positive)]
                {
                    let expected = if condition.is_nan() || is_taken && x.is_nan() {
                        f64::NAN
                    } else if is_taken {
                        x
                    } else {
                        0.0
                    };
                    let double = Elementary.call(function, [&condition, &x]);
                    let single = Elementary.call(function, [&(condition as f32), &(x as f32)]);
                    let fine = Elementary.call(function, [&real(condition), &real(x)]);
                    let is_same = fine == real(expected) || fine.to_f64().is_nan() && !expected.is_finite();
                    assert!(is_same, "{condition} {x} {fine:?}");
                    for found in [double, f64::from(single)] {
                        assert!(
                            found == expected || found.is_nan() && expected.is_nan(),
                            "{condition} {x} {found}"
                        );
                    }
                }
            }
        }
    }

    /// Values of arguments in a range stay in the range of the values.
    #[test]
    fn ranges_hold_all_values() {
        let ends = [-2.5, -1.0, 0.0, 0.4, 1.0, 3.7];
        let range = |low: f64, high: f64| Range { low, high, is_nonzero: low > 0.0 || high < 0.0 };
        let functions =
            [Function::Exp, Function::Ln, Function::Abs, Function::Floor, Function::When, Function::Unless];
        for function in functions {
            for (n, &low) in ends.iter().enumerate() {
                for &high in &ends[n..] {
                    let (at, chosen) = (range(low, high), range(-1.5, -0.5));
                    let found = range_of_call(function, [at, chosen]);
                    for x in [low, (low + high) / 2.0, high] {
                        let value = Elementary.call(function, [&x, &-1.0]);
                        let is_within = value.is_nan() || (found.low <= value && value <= found.high);
                        assert!(
                            is_within && !(found.is_nonzero && value == 0.0),
                            "{function:?} {x}: {found:?}"
                        );
                    }
                }
            }
        }
        assert!(range_of_call(Function::Exp, [range(-1.0, 9.0), Range::ANY]).is_nonzero);
        assert!(!range_of_call(Function::Exp, [Range::ANY, Range::ANY]).is_nonzero, "it is rounded to zero");
    }
}
