//! The elementary functions themselves.

use super::Atoms;
use crate::field::{Field, Real};
use gyro_model::Spline;

/// Atoms of floating-point numbers.
#[derive(Clone, Copy, Debug)]
pub struct Elementary;

impl Atoms<f64> for Elementary {
    fn sin(&self, x: &f64) -> f64 {
        libm::sin(*x)
    }
    fn cos(&self, x: &f64) -> f64 {
        libm::cos(*x)
    }
    fn tanh(&self, x: &f64) -> f64 {
        libm::tanh(*x)
    }
    fn atan2(&self, y: &f64, x: &f64) -> f64 {
        libm::atan2(*y, *x)
    }
    fn sqrt(&self, x: &f64) -> f64 {
        libm::sqrt(*x)
    }
    fn spline(&self, table: &Spline, t: &f64) -> [f64; 3] {
        table.value(*t)
    }
}

impl Atoms<f32> for Elementary {
    fn sin(&self, x: &f32) -> f32 {
        libm::sinf(*x)
    }
    fn cos(&self, x: &f32) -> f32 {
        libm::cosf(*x)
    }
    fn tanh(&self, x: &f32) -> f32 {
        libm::tanhf(*x)
    }
    fn atan2(&self, y: &f32, x: &f32) -> f32 {
        libm::atan2f(*y, *x)
    }
    fn sqrt(&self, x: &f32) -> f32 {
        libm::sqrtf(*x)
    }
    #[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
    fn spline(&self, table: &Spline, t: &f32) -> [f32; 3] {
        table.value(f64::from(*t)).map(|x| x as f32)
    }
}

impl<'c> Atoms<Real<'c>> for Elementary {
    fn sin(&self, x: &Real<'c>) -> Real<'c> {
        x.sin()
    }
    fn cos(&self, x: &Real<'c>) -> Real<'c> {
        x.cos()
    }
    fn tanh(&self, x: &Real<'c>) -> Real<'c> {
        x.tanh()
    }
    fn atan2(&self, y: &Real<'c>, x: &Real<'c>) -> Real<'c> {
        y.atan2(x)
    }
    fn sqrt(&self, x: &Real<'c>) -> Real<'c> {
        x.sqrt()
    }

    /// The piece is found as for an `f64`; it is evaluated in many bits, straight continuation included.
    fn spline(&self, table: &Spline, t: &Real<'c>) -> [Real<'c>; 3] {
        let (knots, last) = (&table.knots, table.pieces.len());
        let past = knots.partition_point(|&knot| !t.is_less(&t.like(knot)));
        let piece = past.clamp(1, last) - 1;
        let u = t.sub(&t.like(knots[piece]));
        if past == 0 {
            let [value, slope, _] = cubic(&table.pieces[0], &t.like(0.0));
            return [value.add(&slope.mul(&u)), slope, t.like(0.0)];
        }
        let width = t.like(knots[last]).sub(&t.like(knots[piece]));
        if past > last && width.is_less(&u) {
            let [value, slope, _] = cubic(&table.pieces[piece], &width);
            return [value.add(&slope.mul(&u.sub(&width))), slope, t.like(0.0)];
        }
        cubic(&table.pieces[piece], &u)
    }
}

/// Value, first and second derivative of a cubic.
fn cubic<'c>(coefficients: &[f64; 4], u: &Real<'c>) -> [Real<'c>; 3] {
    let horner = |coefficients: &[f64]| {
        coefficients.iter().rev().fold(u.like(0.0), |sum, &c| sum.mul(u).add(&u.like(c)))
    };
    let [c0, c1, c2, c3] = *coefficients;
    let three_c3 = u.like(3.0).mul(&u.like(c3));
    let slope = horner(&[c1]).add(&u.mul(&u.like(2.0).mul(&u.like(c2)).add(&u.mul(&three_c3))));
    let bend = u.like(2.0).mul(&u.like(c2).add(&three_c3.mul(u)));
    [horner(&[c0, c1, c2, c3]), slope, bend]
}
