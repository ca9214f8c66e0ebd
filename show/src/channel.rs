//! Numbers of a run, rounded and packed: a *channel* is one quantity at all times.
//!
//! A value becomes `base + step · k` with an integer k; k is replaced by its finite difference of that order, up to the
//! eighth, which leaves the least (smooth motion leaves almost nothing), folded to be without sign and written in byte
//! planes, lowest bytes first, which deflate then packs. Arithmetic wraps, so that it can be undone whatever k is.

use serde::Serialize;

/// How a channel is read back; its bytes follow those of the channel before it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Channel {
    base: f64,
    /// Zero: all values are `base`, and there are no bytes.
    step: f64,
    /// Order of the finite difference.
    order: u8,
    /// Byte planes.
    planes: u8,
    /// Whether the numbers are binary logarithms.
    log: bool,
}

/// How finely a channel is rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Rounding {
    /// Into so many steps, a power of two, between the smallest and the largest value; of what is mostly noise, into
    /// fewer.
    Bits(u8),
    /// To a part of the value: 16 steps to an octave, about 2 %.
    Octaves,
    /// To whole numbers, which stay what they are up to 2³¹.
    Whole,
}

const MOST_ORDERS: u8 = 8;

/// Steps of an octave.
const OCTAVE: f64 = 16.0;

/// The smallest number that a logarithmic plot tells from zero.
const TINY: f64 = 1e-30;

/// Bits to which noise is rounded, and bits of a number that no finite difference makes smaller.
const NOISE: (u8, u64) = (16, 10);

/// Stands for what is not a finite number.
const NONE: i32 = i32::MIN;

/// Appends the bytes of the values.
pub(crate) fn pack(values: &[f64], rounding: Rounding, bytes: &mut Vec<u8>) -> Channel {
    let log = rounding == Rounding::Octaves;
    let values: Vec<f64> = values.iter().map(|v| if log { v.abs().max(TINY).log2() } else { *v }).collect();
    let finite = || values.iter().copied().filter(|v| v.is_finite());
    let (least, most) = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    let constant = |base| Channel { base, step: 0.0, order: 0, planes: 0, log };
    if least == most && finite().count() == values.len() {
        return constant(least);
    }
    if least > most {
        return constant(f64::NAN);
    }
    // Two halves of the range, as the whole may be more than can be written.
    let middle = 0.5 * least + 0.5 * most;
    let (base, step) = match rounding {
        Rounding::Octaves => (middle, 1.0 / OCTAVE),
        Rounding::Bits(bits) => {
            let step = (0.5 * most - 0.5 * least) / 2_f64.powi(i32::from(bits) - 1);
            (middle, step.max(f64::MIN_POSITIVE))
        }
        Rounding::Whole => (0.0, 1.0),
    };
    #[expect(clippy::cast_possible_truncation, reason = "at most 2³⁰ steps")]
    let rounded = |v: &f64| if v.is_finite() { ((v - base) / step).round() as i32 } else { NONE };
    let mut numbers: Vec<i32> = values.iter().map(rounded).collect();
    let mut best = (cost(&numbers), 0, numbers.clone());
    for order in 1..=MOST_ORDERS {
        difference(&mut numbers);
        let cost = cost(&numbers);
        if cost < best.0 {
            best = (cost, order, numbers.clone());
        }
    }
    let (cost, order, numbers) = best;
    if let (Rounding::Bits(bits), (noise, many)) = (rounding, NOISE)
        && bits > noise
        && cost > many * numbers.len() as u64
    {
        return pack(&values, Rounding::Bits(noise), bytes);
    }
    let folded: Vec<u32> = numbers.iter().map(|&k| fold(k)).collect();
    let most = folded.iter().fold(0, |all, k| all | k);
    let planes = (4 - most.leading_zeros() / 8).max(1) as u8;
    for plane in 0..planes {
        bytes.extend(folded.iter().map(|k| k.to_le_bytes()[usize::from(plane)]));
    }
    Channel { base, step, order, planes, log }
}

/// Bits that the numbers take, roughly.
fn cost(numbers: &[i32]) -> u64 {
    numbers.iter().map(|&k| u64::from(32 - fold(k).leading_zeros())).sum()
}

fn difference(numbers: &mut [i32]) {
    for k in (1..numbers.len()).rev() {
        numbers[k] = numbers[k].wrapping_sub(numbers[k - 1]);
    }
}

/// Small numbers of either sign to small ones without: 0, −1, 1, −2 …
fn fold(k: i32) -> u32 {
    ((k << 1) ^ (k >> 31)).cast_unsigned()
}

#[cfg(test)]
mod tests;
