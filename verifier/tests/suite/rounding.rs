//! Rounding of emitted kernels.

use gyro_verifier::field::{Precision, Real};
use gyro_verifier::module::Module;
use gyro_verifier::rounding::{self, DOUBLE_DIGITS, Kind};

/// Units in the last place that a kernel of the paper's scene may lose near the start, where nothing cancels but what
/// the scene makes cancel: angles of 1e-7 between axes at right angles.
const NEAR_START: f64 = 100.0;

#[test]
fn kernels_of_the_paper_lose_little_near_the_start() {
    let page = crate::support::page("gyroscope");
    let module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
    let measured = rounding::measure(&page.model, &module, 20, 1);
    let functions = module.programs.values().filter(|program| !program.results.is_empty()).count();
    assert!(measured.iter().filter(|m| m.kind == Kind::NearStart).count() + 1 >= functions);
    for m in &measured {
        println!(
            "{:20} {:15} f64 {:9.1} {:9.1} f32 {:9.1} {:9.1}",
            m.function,
            m.kind.to_string(),
            m.double.worst,
            m.double.median,
            m.single.worst,
            m.single.median
        );
        assert!(m.double.median <= m.double.worst && m.double.worst.is_finite(), "{m:?}");
        if m.kind == Kind::NearStart && m.function == "accelerations" {
            assert!(m.double.worst <= NEAR_START, "{m:?}");
        }
    }
}

/// An error is measured in units in the last place of the largest number.
#[test]
fn errors_are_in_units_in_the_last_place() {
    let precision = Precision::new();
    let reference = [1.5, 1e-20].map(|x| Real::new(&precision, x));
    assert_eq!(rounding::error(&reference, &[1.5, 1e-20], DOUBLE_DIGITS), Some(0.0));
    assert_eq!(rounding::error(&reference, &[1.5 + 3.0 * f64::EPSILON, 0.0], DOUBLE_DIGITS), Some(3.0));
    assert_eq!(rounding::error(&reference, &[f64::NAN, 0.0], DOUBLE_DIGITS), Some(f64::INFINITY));
    let zeros = [0.0, 0.0].map(|x| Real::new(&precision, x));
    assert_eq!(rounding::error(&zeros, &[0.0, 0.0], DOUBLE_DIGITS), None);
    assert_eq!(rounding::error(&zeros, &[0.0, 1e-300], DOUBLE_DIGITS), Some(f64::INFINITY));
}
