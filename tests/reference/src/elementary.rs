//! Square root, hyperbolic tangent and the angle of a point, in double-double arithmetic.

use crate::DoubleDouble;

/// ln 2; the second half is what the `f64` leaves over.
const LN_2: [f64; 2] = [core::f64::consts::LN_2, 2.319_046_813_846_3e-17];

/// Beyond this tanh differs from one by less than 1e-34.
const SATURATED: f64 = 40.0;

/// Terms of the exponential series for |r| up to ln 2 / 32: the next is below 1e-37.
const TERMS: u32 = 18;

impl DoubleDouble {
    /// The square root of a number that is not negative; NaN for others. Relative error below 1e-31.
    #[must_use]
    pub fn sqrt(self) -> DoubleDouble {
        if self == DoubleDouble::ZERO {
            return self;
        }
        // Newton's step for the square root squares the relative error: 1e-16, then 1e-32.
        let guess = DoubleDouble::new(self.to_f64().sqrt());
        (guess + self / guess).times(0.5)
    }

    /// The hyperbolic tangent. Absolute error below 1e-30.
    #[must_use]
    pub fn tanh(self) -> DoubleDouble {
        let one = DoubleDouble::new(1.0);
        let size = self.abs();
        let value = if size.to_f64() > SATURATED {
            one
        } else {
            let decayed = exponential(size.times(-2.0));
            (one - decayed) / (one + decayed)
        };
        if self.to_f64() < 0.0 { -value } else { value }
    }

    /// The angle from the x axis to the point (x, `self`), rad, within half a turn. Absolute error below
    /// 1e-30.
    #[must_use]
    pub fn atan2(self, x: DoubleDouble) -> DoubleDouble {
        let guess = DoubleDouble::new(self.to_f64().atan2(x.to_f64()));
        let (sin, cos) = guess.sin_cos();
        // The sine of what is left is so small that it is the angle itself.
        guess + (self * cos - x * sin) / (x * x + self * self).sqrt()
    }
}

/// e to the `x`, for |x| up to a few hundred.
fn exponential(x: DoubleDouble) -> DoubleDouble {
    /// Halvings of the argument, undone by as many squarings.
    const HALVINGS: u32 = 4;
    let twos = (x.to_f64() / LN_2[0]).round();
    let rest = LN_2.iter().fold(x, |rest, &part| rest - DoubleDouble::exact_product(twos, part));
    let small = rest.divided_by(f64::from(1 << HALVINGS));
    let one = DoubleDouble::new(1.0);
    let series = (1..=TERMS).rev().fold(one, |sum, n| one + (sum * small).divided_by(f64::from(n)));
    (0..HALVINGS).fold(series, |power, _| power * power).times(twos.exp2())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ABSOLUTE: f64 = 1e-30;

    fn parsed(text: &str) -> DoubleDouble {
        text.parse().unwrap()
    }

    fn error(found: DoubleDouble, expected: &str) -> f64 {
        (found - parsed(expected)).to_f64().abs()
    }

    #[test]
    fn published_digits_are_met() {
        assert!(error(parsed("2").sqrt(), "1.41421356237309504880168872420969807857") < ABSOLUTE);
        assert!(error(parsed("1e-4").sqrt(), "0.01") < ABSOLUTE);
        // tanh ½ = (e − 1) / (e + 1), tanh ln 2 = 3/5.
        assert!(error(parsed("0.5").tanh(), "0.462117157260009758502318483643672549") < ABSOLUTE);
        let ln_2 = parsed("0.693147180559945309417232121458176568");
        assert!(error(ln_2.tanh(), "0.6") < ABSOLUTE);
        assert!(error((-ln_2).tanh(), "-0.6") < ABSOLUTE);
        assert!(error(parsed("1").atan2(parsed("1")), "0.785398163397448309615660845819875721") < ABSOLUTE);
        assert!(error(parsed("0").atan2(parsed("-2")), "3.14159265358979323846264338327950288") < ABSOLUTE);
    }

    #[test]
    fn the_angle_of_a_point_undoes_sine_and_cosine() {
        for step in -31..=31 {
            let angle = DoubleDouble::new(f64::from(step)) / DoubleDouble::new(10.0);
            let (sin, cos) = angle.sin_cos();
            let found = sin.times(3.0).atan2(cos.times(3.0));
            assert!((found - angle).to_f64().abs() < ABSOLUTE, "{step}/10");
        }
    }

    #[test]
    fn tanh_doubles_by_its_addition_theorem() {
        let one = DoubleDouble::new(1.0);
        for step in -90..=90 {
            let x = DoubleDouble::new(f64::from(step)) / DoubleDouble::new(4.0);
            let t = x.tanh();
            assert!(((x + x).tanh() - t.times(2.0) / (one + t * t)).to_f64().abs() < ABSOLUTE, "{step}/4");
        }
    }
}
