//! Lanes against their scalars, bit for bit.

use super::{Lanes, f32x8, f64x4, f64x8};
use crate::Scalar;

/// Steps of a walk through all exponents, chosen odd so that mantissas are irregular.
const WALK: u64 = 0x0000_7fff_1234_567b;

/// Holds a function of a pack against that of its scalar at these arguments.
fn check<T: Lanes<Lane: PartialEq>>(
    arguments: impl Iterator<Item = f64>,
    (pack, scalar): (impl Fn(T) -> T, impl Fn(T::Lane) -> T::Lane),
) {
    let mut lanes = [T::Lane::constant(0.0); 8];
    for (count, x) in arguments.enumerate() {
        lanes[count % T::COUNT] = T::Lane::constant(x);
        if count % T::COUNT == T::COUNT - 1 {
            let found = pack(T::from_lanes(|lane| lanes[lane]));
            for (lane, &x) in lanes[..T::COUNT].iter().enumerate() {
                same(found.lane(lane), scalar(x), x);
            }
        }
    }
}

/// The same bits; any NaN is like any other.
fn same<T: crate::Real>(found: T, expected: T, x: T) {
    let (a, b) = (found.to_f64(), expected.to_f64());
    assert!(a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()), "at {x:?}: {a:e} {b:e}");
}

/// Numbers of every size and sign, the neighbours of multiples of π/4, and what is special.
fn arguments() -> impl Iterator<Item = f64> {
    let everywhere = (0..200_000u64).map(|k| f64::from_bits(k.wrapping_mul(WALK)));
    let usual = (0..200_000).map(|k| (f64::from(k) - 1e5) * 1.234_567e-3);
    let multiples = (-40..40).flat_map(|n| {
        let middle = f64::from(n) * core::f64::consts::FRAC_PI_4;
        (-300..300).map(move |k| middle * (1.0 + f64::from(k * k * k) * 1e-13))
    });
    let close = (-40..40).flat_map(|n| {
        let middle = (f64::from(n) * core::f64::consts::FRAC_PI_4).to_bits();
        (0..9).map(move |k| f64::from_bits(middle.wrapping_add(k).wrapping_sub(4)))
    });
    let edges = [2f64.powi(20), 2f64.powi(28)].map(|n| n * core::f64::consts::FRAC_PI_2);
    let edges = edges.into_iter().flat_map(|x| (-50..50).map(move |k| x * (1.0 + f64::from(k) * 1e-7)));
    let special =
        [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MIN_POSITIVE, -5e-324, f64::MAX];
    everywhere.chain(usual).chain(multiples).chain(close).chain(edges).chain(special)
}

#[test]
fn sines_and_cosines_are_those_of_libm() {
    check::<f64x8>(arguments(), (Scalar::sin, libm::sin));
    check::<f64x8>(arguments(), (Scalar::cos, libm::cos));
    check::<f64x4>(arguments(), (Scalar::sin, libm::sin));
    check::<f64x4>(arguments(), (Scalar::cos, libm::cos));
    check::<f32x8>(arguments(), (Scalar::sin, libm::sinf));
    check::<f32x8>(arguments(), (Scalar::cos, libm::cosf));
}

#[test]
fn other_functions_are_those_of_libm() {
    check::<f64x8>(arguments(), (Scalar::sqrt, libm::sqrt));
    check::<f64x8>(arguments(), (Scalar::tanh, libm::tanh));
    check::<f32x8>(arguments(), (Scalar::sqrt, libm::sqrtf));
    check::<f64x4>(arguments(), (|y| Scalar::atan2(y, f64x4::splat(-0.3)), |y| libm::atan2(y, -0.3)));
    let table = ([0.0, 1.0, 2.0], [[0.0, 1.5, 0.0, -0.5], [1.0, 0.0, -1.5, 0.5]]);
    let value = |[value, slope, bend]: [f64x8; 3]| value + slope + bend;
    let scalar = |[value, slope, bend]: [f64; 3]| value + slope + bend;
    check(
        arguments(),
        (|t: f64x8| value(t.spline(&table.0, &table.1)), |t: f64| scalar(t.spline(&table.0, &table.1))),
    );
}

#[test]
fn masks_are_bits() {
    for bits in 0..256 {
        let mask = f64x8::mask(bits);
        assert_eq!(f64x8::bits(mask), bits);
        let chosen = Lanes::select(mask, f64x8::splat(1.0), f64x8::splat(2.0));
        assert!((0..8).all(|lane| (chosen.lane(lane) == 1.0) == (bits >> lane & 1 == 1)));
    }
}
