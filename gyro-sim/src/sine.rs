//! Sine and cosine of an `f32`, in single precision throughout: a microcontroller without double precision computes
//! them in some sixty instructions.
//!
//! From the argument a multiple of π/2 is subtracted in parts (Cody and Waite 1980), the result of which is a sum of
//! two numbers; a polynomial serves on [−π/4, π/4]. All operations are sums and products that are rounded once each, so
//! that the bits are the same on every target, and in every lane of a pack. Up to 10⁴ rad a value is at most one unit
//! in the last place from the correctly rounded one (the example `sines` goes through all arguments); beyond, where
//! whoever turns so far has lost the angle's digits, libm's function serves, which reduces in double precision.

use crate::{Lanes, Scalar};
use core::f64::consts::FRAC_2_PI;

/// The largest argument that is reduced here.
pub(crate) const LARGEST: f64 = 1e4;

/// 1.5 · 2²³: a number of moderate size that is added to it is rounded to an integer.
const ROUNDING: f64 = 12_582_912.0;

/// Parts of π/2. The first four have eleven bits, so that their products with n, of thirteen bits, are exact.
const PARTS: [f64; 5] = [
    1.570_312_5,
    4.837_512_969_970_703e-4,
    7.549_533_620_476_723e-8,
    2.563_282_919_254_561_4e-12,
    6.123_234_262_925_839e-17,
];

/// Arguments below this, a little less than π/4, are left as they are.
const SMALL: f64 = 0.785;

/// Minimax polynomials with coefficients of 24 bits: sin x = x + x³ S(x²) to 2⁻²⁷·⁹, cos x = 1 − x²/2 + x⁴ C(x²) to
/// 2⁻³³, relative.
const SINE: [f64; 3] = [-0.166_666_552_424_430_85, 0.008_332_188_241_183_758, -1.951_809_972_524_643e-4];
const COSINE: [f64; 3] = [0.041_666_645_556_688_31, -0.001_388_731_063_343_584_5, 2.443_255_289_108_492_4e-5];

/// What is left of an argument when n π/2 is subtracted: `left + rest`.
struct Reduced<V> {
    left: V,
    rest: V,
    /// n, less a multiple of four: from −2 to 2.
    quadrant: V,
}

/// Sine of any number.
#[inline]
pub(crate) fn sin_of_any(x: f32) -> f32 {
    if Scalar::abs(x) <= LARGEST as f32 { sin(x) } else { libm::sinf(x) }
}

/// Cosine of any number.
#[inline]
pub(crate) fn cos_of_any(x: f32) -> f32 {
    if Scalar::abs(x) <= LARGEST as f32 { cos(x) } else { libm::cosf(x) }
}

/// Sine, for arguments up to [`LARGEST`].
#[inline(always)]
pub(crate) fn sin<V: Lanes<Lane = f32>>(x: V) -> V {
    if is_small(x) {
        return sine(x);
    }
    let Reduced { left, rest, quadrant: q } = reduced(x);
    let value = by_parity(q, corrected_cosine(left, rest), corrected_sine(left, rest));
    V::select(q.greater(V::constant(1.5)) | V::constant(-0.5).greater(q), -value, value)
}

/// Cosine, for arguments up to [`LARGEST`].
#[inline(always)]
pub(crate) fn cos<V: Lanes<Lane = f32>>(x: V) -> V {
    if is_small(x) {
        return cosine(x);
    }
    let Reduced { left, rest, quadrant: q } = reduced(x);
    let value = by_parity(q, corrected_sine(left, rest), corrected_cosine(left, rest));
    V::select(q.greater(V::constant(0.5)) | V::constant(-1.5).greater(q), -value, value)
}

/// Whether nothing need be subtracted in any lane: so it is with the angles of a gimbal near its rest, for instance.
#[inline(always)]
fn is_small<V: Lanes>(x: V) -> bool {
    V::bits(x.absolute().greater(V::constant(SMALL))) == 0
}

/// The one for odd n, the other for even n.
#[inline(always)]
fn by_parity<V: Lanes>(quadrant: V, odd: V, even: V) -> V {
    let size = quadrant.absolute();
    V::select(size.greater(V::constant(0.5)) & V::constant(1.5).greater(size), odd, even)
}

#[inline(always)]
fn reduced<V: Lanes>(x: V) -> Reduced<V> {
    let [p1, p2, p3, p4, p5] = PARTS.map(V::constant);
    let rounded = |x: V| (x + V::constant(ROUNDING)) - V::constant(ROUNDING);
    let n = rounded(x * V::constant(FRAC_2_PI));
    // The first two differences are exact, the next two are made so.
    let (left, first) = difference((x - n * p1) - n * p2, n * p3);
    let (left, second) = difference(left, n * p4);
    let rest = (first + second) - n * p5;
    Reduced { left, rest, quadrant: n - rounded(n * V::constant(0.25)) * V::constant(4.0) }
}

/// `a − b`, and what its rounding leaves (Knuth's two-sum).
#[inline(always)]
fn difference<V: Lanes>(a: V, b: V) -> (V, V) {
    let difference = a - b;
    let taken = difference - a;
    (difference, (a - (difference - taken)) - (b + taken))
}

/// sin x for |x| ≤ π/4.
#[inline(always)]
fn sine<V: Lanes>(x: V) -> V {
    x + x * (x * x) * sine_series(x * x)
}

/// sin(x + rest) for |x| ≤ π/4 and a small rest.
#[inline(always)]
fn corrected_sine<V: Lanes>(x: V, rest: V) -> V {
    let z = x * x;
    x + (x * z * sine_series(z) + rest * (V::constant(1.0) - V::constant(0.5) * z))
}

#[inline(always)]
fn sine_series<V: Lanes>(z: V) -> V {
    let [s1, s2, s3] = SINE.map(V::constant);
    s1 + z * (s2 + z * s3)
}

/// cos x for |x| ≤ π/4.
#[inline(always)]
fn cosine<V: Lanes>(x: V) -> V {
    let (most, lost, more) = cosine_parts(x * x);
    most + (lost + more)
}

/// cos(x + rest) for |x| ≤ π/4 and a small rest.
#[inline(always)]
fn corrected_cosine<V: Lanes>(x: V, rest: V) -> V {
    let (most, lost, more) = cosine_parts(x * x);
    most + (lost + (more - x * rest))
}

/// 1 − z/2, what its rounding has lost, and the rest of the series.
#[inline(always)]
fn cosine_parts<V: Lanes>(z: V) -> (V, V, V) {
    let [c1, c2, c3] = COSINE.map(V::constant);
    let half = V::constant(0.5) * z;
    let most = V::constant(1.0) - half;
    (most, (V::constant(1.0) - most) - half, z * z * (c1 + z * (c2 + z * c3)))
}
