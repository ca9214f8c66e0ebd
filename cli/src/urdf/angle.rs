//! Angles that somebody rounded: 1.5708 is a right one.

use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write as _;

/// An angle as near as this to a multiple of [`UNITS`], rad, is the multiple.
const MEANT: f64 = 1e-6;

/// One with so many decimals at least is it as well if they are the multiple's, rounded or cut off: 1.5708 is off by
/// 3.7e-6.
const DECIMALS: usize = 4;

/// An angle as near as this to a right one, rad, that is not taken for it is remarked upon, as 1.57.
const NEAR: f64 = 1e-3;

/// What rounding to an `f64` leaves.
const ROUNDING: f64 = 1e-14;

/// Parts of pi whose multiples are meant, with their names: 45, 30 and 90 degrees.
const UNITS: [(f64, &str); 2] = [(PI / 4.0, "pi/4"), (PI / 6.0, "pi/6")];

/// Angles that were made exact and those that could have been, by how they are written.
#[derive(Debug, Default)]
pub(super) struct Angles {
    exact: BTreeMap<String, (String, f64, Vec<u32>)>,
    near: BTreeMap<String, (f64, Vec<u32>)>,
}

impl Angles {
    /// The angle that was meant by a number of radians written on a line.
    pub(super) fn meant(&mut self, written: &str, value: f64, line: u32) -> f64 {
        let Some((multiple, name)) = nearest(value) else { return value };
        let off = (value - multiple).abs();
        if off < ROUNDING {
            return multiple;
        }
        let decimals = decimals(written);
        let cut = 10.0_f64.powi(-i32::try_from(decimals).unwrap_or(i32::MAX));
        if off <= MEANT || (decimals >= DECIMALS && off < cut) {
            self.exact.entry(written.trim().to_owned()).or_insert((name, off, Vec::new())).2.push(line);
            return multiple;
        }
        if off < NEAR && (multiple / (PI / 2.0)).fract() == 0.0 {
            self.near.entry(written.trim().to_owned()).or_insert((off, Vec::new())).1.push(line);
        }
        value
    }

    /// A remark for each way of writing an angle.
    pub(super) fn remarks(&self) -> Vec<String> {
        let exact = self.exact.iter().map(|(written, (name, off, lines))| {
            format!("{written} rad is taken for {name}, a change of {off:.1e} rad: {}", at(lines))
        });
        let near = self.near.iter().map(|(written, (off, lines))| {
            format!(
                "{written} rad stays {off:.1e} rad off a right angle; write more digits if that is meant: {}",
                at(lines)
            )
        });
        exact.chain(near).collect()
    }
}

/// Lines that a remark is about, the first few of them.
pub(super) fn at(lines: &[u32]) -> String {
    const SHOWN: usize = 3;
    let shown: Vec<String> = lines.iter().take(SHOWN).map(u32::to_string).collect();
    let mut text = format!("line{} {}", if lines.len() == 1 { "" } else { "s" }, shown.join(", "));
    if lines.len() > SHOWN {
        let _ = write!(text, " and {} more", lines.len() - SHOWN);
    }
    text
}

/// The nearest multiple, other than none, of a unit, with its name.
fn nearest(value: f64) -> Option<(f64, String)> {
    let of = |(unit, name): (f64, &str)| {
        let number = (value / unit).round();
        // Of the larger unit first: two of pi/4 are also three of pi/6.
        let right = (number * unit / (PI / 2.0)).round();
        let is_right = (number * unit - right * (PI / 2.0)).abs() < ROUNDING;
        let (multiple, name) = if is_right {
            (right * (PI / 2.0), format!("{right} pi/2"))
        } else {
            (number * unit, format!("{number} {name}"))
        };
        (number != 0.0 && number.abs() < 100.0).then_some((multiple, name))
    };
    UNITS.into_iter().filter_map(of).min_by(|a, b| (value - a.0).abs().total_cmp(&(value - b.0).abs()))
}

/// Digits behind the point of a decimal number; none of one with an exponent, which no person has rounded.
fn decimals(written: &str) -> usize {
    let is_plain = !written.contains(['e', 'E']);
    written.trim().split_once('.').filter(|_| is_plain).map_or(0, |(_, digits)| digits.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_what_was_meant() {
        let mut angles = Angles::default();
        for (written, meant) in [
            ("1.5708", PI / 2.0),
            ("-1.57079632679", -PI / 2.0),
            ("3.1415", PI),
            ("3.1416", PI),
            ("4.71239", 1.5 * PI),
            ("0.7854", PI / 4.0),
            ("2.35619449019", 0.75 * PI),
            ("0.5236", PI / 6.0),
            ("1.0472", PI / 3.0),
            ("1.5707963267948966", PI / 2.0),
            // Not these: too few digits, or another angle.
            ("1.57", 1.57),
            ("1.571", 1.571),
            ("1.5709", 1.5709),
            ("0.785", 0.785),
            ("0.7855", 0.7855),
            ("0", 0.0),
            ("1e-7", 1e-7),
            ("0.00001", 0.00001),
        ] {
            let value: f64 = written.parse().expect("a number");
            let found = angles.meant(written, value, 7);
            assert!((found - meant).abs() < 1e-15, "{written}: {found} for {meant}");
        }
        let remarks = angles.remarks().join("\n");
        assert!(
            remarks.contains("1.5708 rad is taken for 1 pi/2, a change of 3.7e-6 rad: line 7"),
            "{remarks}"
        );
        assert!(remarks.contains("1.57 rad stays 8.0e-4 rad off a right angle"), "{remarks}");
        assert!(!remarks.contains("0.785 ") && !remarks.contains("1.5707963267948966"), "{remarks}");
    }
}
