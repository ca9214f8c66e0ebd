//! Angles that somebody rounded: 1.5708 is a right one.

use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;

/// An angle as near as this to a multiple of [`UNITS`], in rad, is the multiple.
const MEANT: f64 = 1e-6;

/// One with so many decimals at least is it as well if they are the multiple's, rounded or cut off: 1.5708 is off by
/// 3.7e-6.
const DECIMALS: usize = 4;

/// An angle as near as this to a right one, rad, that is not taken for it is remarked upon, as 1.57.
const NEAR: f64 = 1e-3;

/// What rounding to an `f64` leaves.
const ROUNDING: f64 = 1e-14;

/// Degrees whose multiples are meant.
const UNITS: [f64; 2] = [45.0, 30.0];

/// Angles that were made exact and those that could have been, by how they are written.
#[derive(Debug, Default)]
pub(super) struct Angles {
    exact: BTreeMap<String, (f64, f64, BTreeSet<u32>)>,
    near: BTreeMap<String, (f64, BTreeSet<u32>)>,
}

impl Angles {
    /// The angle that was meant by a number of radians written on a line.
    pub(super) fn meant(&mut self, written: &str, value: f64, line: u32) -> f64 {
        let Some(degrees) = nearest(value) else { return value };
        let multiple = degrees / 180.0 * PI;
        let off = (value - multiple).abs();
        if off < ROUNDING {
            return multiple;
        }
        let decimals = decimals(written);
        let cut = 10.0_f64.powi(-i32::try_from(decimals).unwrap_or(i32::MAX));
        let written = written.trim().to_owned();
        if off <= MEANT || (decimals >= DECIMALS && off < cut) {
            self.exact.entry(written).or_insert((degrees, off, BTreeSet::new())).2.insert(line);
            return multiple;
        }
        if off < NEAR && degrees % 90.0 == 0.0 {
            self.near.entry(written).or_insert((off, BTreeSet::new())).1.insert(line);
        }
        value
    }

    /// A remark for each way of writing an angle.
    pub(super) fn remarks(&self) -> Vec<String> {
        let exact = self.exact.iter().map(|(written, (degrees, off, lines))| {
            let at = at(lines.iter());
            format!("{written} rad is taken for {degrees} degrees, a change of {off:.1e} rad: {at}")
        });
        let near = self.near.iter().map(|(written, (off, lines))| {
            let at = at(lines.iter());
            format!("{written} rad stays {off:.1e} rad off a right angle; write more digits if that is meant: {at}")
        });
        exact.chain(near).collect()
    }
}

/// Lines that a remark is about, the first few of them.
pub(super) fn at<'l>(lines: impl ExactSizeIterator<Item = &'l u32>) -> String {
    const SHOWN: usize = 3;
    let number = lines.len();
    let shown: Vec<String> = lines.take(SHOWN).map(u32::to_string).collect();
    let more = if number > SHOWN { format!(" and {} more", number - SHOWN) } else { String::new() };
    format!("line{} {}{more}", if number == 1 { "" } else { "s" }, shown.join(", "))
}

/// The nearest multiple, other than none, of a unit, in degrees.
fn nearest(angle: f64) -> Option<f64> {
    let degrees = angle / PI * 180.0;
    let multiples = UNITS.map(|unit| (degrees / unit).round() * unit);
    let nearest = multiples.into_iter().min_by(|a, b| (degrees - a).abs().total_cmp(&(degrees - b).abs()));
    nearest.filter(|multiple| *multiple != 0.0 && multiple.abs() < 1e4)
}

/// Digits behind the point of a decimal number; none of one with an exponent, which no person has rounded.
fn decimals(written: &str) -> usize {
    let is_plain = !written.contains(['e', 'E']);
    written.trim().split_once('.').filter(|_| is_plain).map_or(0, |(_, digits)| digits.len())
}

#[cfg(test)]
mod tests;
