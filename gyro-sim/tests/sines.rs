//! Sine and cosine of `f32`, against those of `f64` rounded once.

use gyro_sim::Scalar;

/// The largest argument for which an error is promised.
const LARGEST: f32 = 1e4;

/// How many numbers apart two of the same kind are.
fn apart(a: f32, b: f32) -> u32 {
    let place = |x: f32| {
        let bits = x.to_bits() as i32;
        if bits < 0 { i32::MIN - bits } else { bits }
    };
    place(a).abs_diff(place(b))
}

#[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
fn errors(x: f32) -> [u32; 2] {
    let [sin, cos] = [libm::sin(f64::from(x)) as f32, libm::cos(f64::from(x)) as f32];
    [apart(Scalar::sin(x), sin), apart(Scalar::cos(x), cos)]
}

/// The largest error among these arguments and their negatives, and how many values are not the nearest.
fn worst(arguments: impl Iterator<Item = f32>) -> (u32, u64, u64) {
    arguments.flat_map(|x| [x, -x]).fold((0, 0, 0), |(worst, off, all), x| {
        let errors = errors(x);
        let off = off + errors.iter().filter(|error| **error > 0).count() as u64;
        (errors.into_iter().fold(worst, u32::max), off, all + 2)
    })
}

#[test]
fn sines_are_within_a_unit_in_the_last_place() {
    // Every 1009th number, and the neighbours of multiples of π/4.
    let spread = (0..=LARGEST.to_bits()).step_by(1009).map(f32::from_bits);
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
    let quarter = |n: u32| (f64::from(n) * std::f64::consts::FRAC_PI_4) as f32;
    let near = (1..12_732).map(quarter).flat_map(|x| (x.to_bits() - 2..=x.to_bits() + 2).map(f32::from_bits));
    let (error, off, all) = worst(spread.chain(near));
    assert!(error <= 1, "{error} units; {off} of {all} are not the nearest");
}

#[test]
#[ignore = "goes through all 1.2e9 arguments: a minute or two, optimised"]
fn all_sines_are_within_a_unit_in_the_last_place() {
    let (error, off, all) = worst((0..=LARGEST.to_bits()).map(f32::from_bits));
    assert!(error <= 1, "{error} units; {off} of {all} are not the nearest");
    assert_eq!(all, 4 * (u64::from(LARGEST.to_bits()) + 1));
    println!("{off} of {all} values are not the nearest, all are next to it");
}

#[test]
fn larger_arguments_and_no_numbers_are_libms() {
    for x in [1.000_1e4, 3e5, 1e10, f32::MAX, f32::NAN, f32::INFINITY] {
        for x in [x, -x] {
            assert_eq!(Scalar::sin(x).to_bits(), libm::sinf(x).to_bits(), "{x}");
            assert_eq!(Scalar::cos(x).to_bits(), libm::cosf(x).to_bits(), "{x}");
        }
    }
}
