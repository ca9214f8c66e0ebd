//! Decimal numbers read to the last bit a double-double holds.

use core::fmt;
use core::str::FromStr;

use crate::DoubleDouble;

/// Text that is not a decimal number such as `-1.25e-4`, or one outside the supported range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParseDecimalError;

impl fmt::Display for ParseDecimalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("expected a decimal number such as -1.25e-4, of magnitude 1e-200 to 1e200")
    }
}

impl core::error::Error for ParseDecimalError {}

impl FromStr for DoubleDouble {
    type Err = ParseDecimalError;

    /// The decimal number `text` stands for, to about 1e-31 relative: `"0.1"` is one tenth, unlike the `f64` 0.1.
    ///
    /// # Errors
    /// [`ParseDecimalError`] unless `text` is digits with an optional sign, decimal point and exponent.
    fn from_str(text: &str) -> Result<Self, ParseDecimalError> {
        let (negative, magnitude) = match text.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, text),
        };
        let (mantissa, exponent) = magnitude.split_once(['e', 'E']).unwrap_or((magnitude, "0"));
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let exponent: i32 = exponent.parse().map_err(|_| ParseDecimalError)?;
        let digits = digits_value(whole, fraction)?;
        let places = i32::try_from(fraction.len()).map_err(|_| ParseDecimalError)?;
        let value = scaled(digits, exponent.saturating_sub(places))?;
        Ok(if negative { -value } else { value })
    }
}

/// The integer that the digits of `whole` and `fraction` spell; exact up to 31 digits.
fn digits_value(whole: &str, fraction: &str) -> Result<DoubleDouble, ParseDecimalError> {
    if whole.is_empty() && fraction.is_empty() {
        return Err(ParseDecimalError);
    }
    let digits = whole.chars().chain(fraction.chars());
    digits.map(|c| c.to_digit(10).ok_or(ParseDecimalError)).try_fold(DoubleDouble::ZERO, |value, digit| {
        Ok(value * DoubleDouble::new(10.0) + DoubleDouble::new(f64::from(digit?)))
    })
}

/// `value` times ten to the `exponent`.
fn scaled(value: DoubleDouble, exponent: i32) -> Result<DoubleDouble, ParseDecimalError> {
    // Beyond this the halves of a double-double leave the range of `f64`.
    const LARGEST: u32 = 230;
    let size = exponent.unsigned_abs();
    if size > LARGEST {
        return Err(ParseDecimalError);
    }
    // Powers of ten up to 45 are exact in 106 bits (5^45 has 105).
    let power = (0..size).fold(DoubleDouble::new(1.0), |power, _| power * DoubleDouble::new(10.0));
    Ok(if exponent < 0 { value / power } else { value * power })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> DoubleDouble {
        text.parse().unwrap()
    }

    #[test]
    fn decimals_are_exact_where_f64_is_not() {
        let tenth = parsed("0.1");
        assert_eq!(tenth.to_f64(), 0.1);
        assert_ne!(tenth.remainder(), 0.0);
        assert_eq!(tenth * DoubleDouble::new(10.0), DoubleDouble::new(1.0));
    }

    #[test]
    fn every_spelling_of_a_number_is_the_same_number() {
        for text in ["0.000125", "1.25e-4", "125E-6", ".125e-3", "0.00000125e+2"] {
            assert_eq!(parsed(text), parsed("1") / parsed("8000"), "{text}");
        }
        assert_eq!(parsed("-20e-7"), -parsed("0.000002"));
    }

    #[test]
    fn what_is_no_decimal_is_refused() {
        for text in ["", "-", ".", "1e", "1.2.3", "--1", "0x10", "inf", "NaN", "1 ", "1e999", "1e99999999999"]
        {
            assert_eq!(text.parse::<DoubleDouble>(), Err(ParseDecimalError), "{text:?}");
        }
    }
}
