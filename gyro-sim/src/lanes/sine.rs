//! Sine and cosine of all lanes at once, bit for bit those of a single number: of `f32` as everywhere
//! ([`sine`](crate::sine)), of `f64` libm's.
//!
//! libm's method is FDLIBM's (Sun Microsystems 1993: `k_sin.c`, `k_cos.c`, `e_rem_pio2.c`): from the argument a
//! multiple of π/2 is subtracted, and a polynomial serves on [−π/4, π/4]. FDLIBM branches on the argument; here every
//! lane goes the way of most arguments, with the same operations in the same order, and libm does again the few lanes
//! whose argument is *hard*: large, close to a multiple of π/2 other than zero, where libm subtracts in more parts, or
//! close to an odd multiple of π/4, where it tells the quadrant by other means. So errors are libm's: below one unit in
//! the last place.
//!
//! All of it is inlined, so that the compiler reduces an argument once where a kernel takes its sine and its cosine.

use super::{Lanes, MAX_LANES};
use crate::{Real, sine};
use core::f64::consts::FRAC_2_PI;

/// 1.5 · 2⁵²: a number of moderate size that is added to it is rounded to an integer.
const ROUNDING: f64 = 6_755_399_441_055_744.0;

/// Reduced arguments beyond this are close to ±π/4 = ±0.785398...
const EDGE: f64 = 0.78538;

/// What is left of an argument when n π/2 is subtracted.
struct Reduced<V: Lanes> {
    /// n, less a multiple of four: from −2 to 2.
    quadrant: V,
    is_hard: V::Mask,
}

/// n, and n less a multiple of four.
#[inline(always)]
fn quadrant<V: Lanes>(x: V) -> (V, V) {
    let rounded = |x: V| (x + V::constant(ROUNDING)) - V::constant(ROUNDING);
    let n = rounded(x * V::constant(FRAC_2_PI));
    (n, n - rounded(n * V::constant(0.25)) * V::constant(4.0))
}

impl<V: Lanes> Reduced<V> {
    /// The one for odd n, the other for even n.
    #[inline(always)]
    fn by_parity(&self, odd: V, even: V) -> V {
        let size = self.quadrant.absolute();
        V::select(size.greater(V::constant(0.5)) & V::constant(1.5).greater(size), odd, even)
    }

    /// Sine, given the sine and the cosine of what is left.
    #[inline(always)]
    fn sine(&self, sine: V, cosine: V) -> V {
        let value = self.by_parity(cosine, sine);
        let q = self.quadrant;
        V::select(q.greater(V::constant(1.5)) | V::constant(-0.5).greater(q), -value, value)
    }

    /// Cosine, given the sine and the cosine of what is left.
    #[inline(always)]
    fn cosine(&self, sine: V, cosine: V) -> V {
        let value = self.by_parity(sine, cosine);
        let q = self.quadrant;
        V::select(q.greater(V::constant(0.5)) | V::constant(-1.5).greater(q), -value, value)
    }
}

/// `found`, but for the hard lanes.
#[inline(always)]
fn unless_hard<V: Lanes>(is_hard: u32, x: V, found: V, function: impl Fn(V::Lane) -> V::Lane) -> V {
    if is_hard == 0 {
        return found;
    }
    // Through arrays: were the address of a pack taken here, it would live in memory on the way without hard lanes,
    // too.
    let again = again(is_hard, core::array::from_fn(|lane| x.lane(lane.min(V::COUNT - 1))), function);
    V::select(V::mask(is_hard), V::from_lanes(|lane| again[lane]), found)
}

/// The function in these lanes.
#[cold]
#[inline(never)]
fn again<T: Real>(lanes: u32, mut x: [T; MAX_LANES], function: impl Fn(T) -> T) -> [T; MAX_LANES] {
    let hard = x.iter_mut().enumerate().filter(|(lane, _)| lanes >> lane & 1 == 1);
    hard.for_each(|(_, x)| *x = function(*x));
    x
}

/// Below 2⁻²⁶ the sine is its argument, −0 too.
const TINY: f64 = 1.490_116_119_384_765_6e-8;

/// Sine.
#[inline(always)]
pub(super) fn sin<V: Lanes<Lane = f64>>(x: V) -> V {
    if is_small(x) {
        return V::select(V::constant(TINY).greater(x.absolute()), x, sine_of_double(x));
    }
    let (reduced, sine, cosine) = doubles(x);
    let found = V::select(V::constant(TINY).greater(x.absolute()), x, reduced.sine(sine, cosine));
    unless_hard(V::bits(reduced.is_hard), x, found, libm::sin)
}

/// Cosine.
#[inline(always)]
pub(super) fn cos<V: Lanes<Lane = f64>>(x: V) -> V {
    if is_small(x) {
        return cosine_of_double(x, V::constant(0.0));
    }
    let (reduced, sine, cosine) = doubles(x);
    unless_hard(V::bits(reduced.is_hard), x, reduced.cosine(sine, cosine), libm::cos)
}

/// Whether nothing need be subtracted in any lane: so it is with the angles of a gimbal near its rest, for instance.
#[inline(always)]
fn is_small<V: Lanes<Lane = f64>>(x: V) -> bool {
    V::bits(x.absolute().greater(V::constant(EDGE))) == 0
}

/// Two parts of π/2, the first one of 33 bits, so that its product with n is exact.
const PART: [f64; 2] = [1.570_796_326_734_125_6, 6.077_100_506_506_192e-11];

/// Close to a multiple of π/2 other than zero: the argument is more than this many times what is left of it.
const CANCELLED: f64 = 32768.0;

/// Arguments below 2²⁰ π/2 are reduced in two parts.
const LARGE: f64 = 1.6e6;

/// The reduced arguments, their sines and cosines.
#[inline(always)]
fn doubles<V: Lanes<Lane = f64>>(x: V) -> (Reduced<V>, V, V) {
    let (n, quadrant) = quadrant(x);
    let left = x - n * V::constant(PART[0]);
    let second = n * V::constant(PART[1]);
    let y = left - second;
    let rest = (left - y) - second;
    let (size, of_y) = (x.absolute(), y.absolute());
    let is_hard = size.greater(V::constant(LARGE))
        | size.greater(of_y * V::constant(CANCELLED))
        | of_y.greater(V::constant(EDGE));
    let is_whole = V::constant(0.5).greater(n.absolute());
    let sine = V::select(is_whole, sine_of_double(y), corrected_sine(y, rest));
    (Reduced { quadrant, is_hard }, sine, cosine_of_double(y, rest))
}

/// `k_sin.c` where nothing was subtracted.
#[inline(always)]
fn sine_of_double<V: Lanes>(x: V) -> V {
    let (s1, z, r) = sine_series(x);
    x + z * x * (s1 + z * r)
}

/// `k_sin.c` with a second part of the argument.
#[inline(always)]
fn corrected_sine<V: Lanes>(x: V, rest: V) -> V {
    let (s1, z, r) = sine_series(x);
    let v = z * x;
    x - ((z * (V::constant(0.5) * rest - v * r) - rest) - v * s1)
}

/// The first coefficient, the square of the argument, and the sum of the rest of the series.
#[inline(always)]
fn sine_series<V: Lanes>(x: V) -> (V, V, V) {
    let [s1, s2, s3, s4, s5, s6] = [
        -0.166_666_666_666_666_32,
        0.008_333_333_333_322_49,
        -0.000_198_412_698_298_579_5,
        2.755_731_370_707_006_8e-6,
        -2.505_076_025_340_686_3e-8,
        1.589_690_995_211_55e-10,
    ]
    .map(V::constant);
    let z = x * x;
    let w = z * z;
    (s1, z, s2 + z * (s3 + z * s4) + z * w * (s5 + z * s6))
}

/// `k_cos.c`.
#[inline(always)]
fn cosine_of_double<V: Lanes>(x: V, rest: V) -> V {
    let [c1, c2, c3, c4, c5, c6] = [
        0.041_666_666_666_666_6,
        -0.001_388_888_888_887_411,
        2.480_158_728_947_673e-5,
        -2.755_731_435_139_066_3e-7,
        2.087_572_321_298_175e-9,
        -1.135_964_755_778_819_5e-11,
    ]
    .map(V::constant);
    let z = x * x;
    let w = z * z;
    let r = z * (c1 + z * (c2 + z * c3)) + w * w * (c4 + z * (c5 + z * c6));
    let half = V::constant(0.5) * z;
    let w = V::constant(1.0) - half;
    w + (((V::constant(1.0) - w) - half) + (z * r - x * rest))
}

/// Sine in single precision.
#[inline(always)]
pub(super) fn sin_of_singles<V: Lanes<Lane = f32>>(x: V) -> V {
    unless_hard(large_singles(x), x, sine::sin(x), libm::sinf)
}

/// Cosine in single precision.
#[inline(always)]
pub(super) fn cos_of_singles<V: Lanes<Lane = f32>>(x: V) -> V {
    unless_hard(large_singles(x), x, sine::cos(x), libm::cosf)
}

/// The lanes that are reduced elsewhere, those that are no numbers too.
#[inline(always)]
fn large_singles<V: Lanes<Lane = f32>>(x: V) -> u32 {
    V::bits(!x.absolute().at_most(V::constant(sine::LARGEST)))
}
