use super::*;
use gyro_model::parse_decimal;

#[test]
fn angles_are_in_their_quadrants() {
    let precision = Precision::new();
    for (y, x) in
        [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0), (2.0, 3.0), (3.0, -2.0), (-3.0, -2.0), (-1.0, 5.0)]
    {
        let angle = Real::new(&precision, y).atan2(&Real::new(&precision, x)).to_f64();
        assert!((angle - f64::atan2(y, x)).abs() <= 1e-15, "{y} {x} {angle}");
    }
}

#[test]
fn rationals_and_doubles_go_in_and_out() {
    let precision = Precision::new();
    for text in ["0.1", "-123456789012345678901234567890.5", "1e-300", "0"] {
        let exact = parse_decimal(text).expect("a decimal");
        let real = Real::from_rational(&precision, &exact);
        let expected: f64 = text.parse().expect("a decimal");
        assert!((real.to_f64() - expected).abs() <= expected.abs() * f64::EPSILON, "{text}");
    }
    assert_eq!(Real::new(&precision, -1.5e-7).to_f64(), -1.5e-7);
}
