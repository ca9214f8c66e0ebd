//! Sine and cosine of a double-double: reduction by quarter turns, then the Taylor series.

use crate::DoubleDouble;

/// Powers of r needed for |r| up to π/4: (π/4)^28 / 28! is below 4e-33.
const TERMS: usize = 28;

/// 1/n! for n up to [`TERMS`].
const INVERSE_FACTORIAL: [DoubleDouble; TERMS + 1] = inverse_factorials();

/// π/2 in three parts; the first two are the double-double nearest to it.
const QUARTER_TURN: [f64; 3] =
    [core::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17, -1.497_384_904_859_169_8e-33];

const fn inverse_factorials() -> [DoubleDouble; TERMS + 1] {
    let mut table = [DoubleDouble::new(1.0); TERMS + 1];
    let mut n = 1;
    while n <= TERMS {
        table[n] = table[n - 1].divided_by(n as f64);
        n += 1;
    }
    table
}

impl DoubleDouble {
    /// Sine and cosine of an angle in radians.
    ///
    /// Absolute error below 1e-31 for angles up to 1e5; NaN for angles that are not finite.
    #[must_use]
    pub fn sin_cos(self) -> (DoubleDouble, DoubleDouble) {
        let quarters = (self.to_f64() / QUARTER_TURN[0]).round();
        let (sin, cos) = sin_cos_series(without_quarters(self, quarters));
        match quarters.rem_euclid(4.0) {
            0.0 => (sin, cos),
            1.0 => (cos, -sin),
            2.0 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
}

/// `angle` less so many quarter turns: the first two products are exact, so nothing is lost to cancellation.
fn without_quarters(angle: DoubleDouble, quarters: f64) -> DoubleDouble {
    QUARTER_TURN.iter().fold(angle, |rest, &part| rest - DoubleDouble::exact_product(quarters, part))
}

fn sin_cos_series(r: DoubleDouble) -> (DoubleDouble, DoubleDouble) {
    let square = -(r * r);
    let horner = |last: usize| {
        let coefficients = INVERSE_FACTORIAL[..=last].iter().rev().step_by(2);
        coefficients.fold(DoubleDouble::ZERO, |sum, &coefficient| sum * square + coefficient)
    };
    (r * horner(TERMS - 1), horner(TERMS))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few units in the last place of a double-double of size one.
    const ABSOLUTE: f64 = 1e-31;

    /// (angle, sine, cosine) to 34 digits, computed with mpmath.
    const KNOWN: [(&str, &str, &str); 9] = [
        ("0.125", "0.124674733385227689957442708712108468", "0.99219766722932905314909690778825087"),
        ("0.75", "0.681638760023334166733241952779893935", "0.731688868873820886311838753000084544"),
        ("1", "0.841470984807896506652502321630299", "0.540302305868139717400936607442976604"),
        ("-2.5", "-0.598472144103956494051854702186162272", "-0.801143615546933714833502790467351664"),
        ("3.14159265358979323846", "0.00000000000000000000264338327950288419716939937510582097", "-1.0"),
        ("44.03125", "0.0489333004681850546318768005343542548", "0.998802048508757475061931667214993075"),
        ("-99.984375", "0.51977701429388516437294928297480356", "0.854301969687378338494617825569880149"),
        ("10000.5", "-0.724689458613574419182218573231707602", "-0.689075604396472890445474338053459117"),
        ("98765.4375", "0.0476384070789577052637500578318203871", "0.998864646571786277871999585224200467"),
    ];

    #[test]
    fn published_digits_are_met() {
        for (angle, sin, cos) in KNOWN {
            let (s, c) = angle.parse::<DoubleDouble>().unwrap().sin_cos();
            let error = |found: DoubleDouble, text: &str| (found - text.parse().unwrap()).to_f64().abs();
            assert!(error(s, sin) < ABSOLUTE, "sin {angle}: {s:?}");
            assert!(error(c, cos) < ABSOLUTE, "cos {angle}: {c:?}");
        }
    }

    #[test]
    fn doubling_the_angle_follows_the_addition_theorem() {
        for step in -200..200 {
            let angle = DoubleDouble::new(f64::from(step)) / DoubleDouble::new(7.0);
            let ((s, c), (s2, c2)) = (angle.sin_cos(), (angle + angle).sin_cos());
            let two = DoubleDouble::new(2.0);
            assert!((s2 - two * s * c).to_f64().abs() < 4.0 * ABSOLUTE, "{step}/7");
            assert!((c2 - (c - s) * (c + s)).to_f64().abs() < 4.0 * ABSOLUTE, "{step}/7");
        }
    }

    #[test]
    fn angles_that_are_no_numbers_have_no_sine() {
        assert!(DoubleDouble::new(f64::INFINITY).sin_cos().0.to_f64().is_nan());
    }
}
