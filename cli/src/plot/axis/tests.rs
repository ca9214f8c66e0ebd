use super::*;

fn check(values: &[f64], unit: &str, shown: &str, labels: &[&str]) {
    let axis = Axis::of(Scale::Linear, unit, values.iter());
    let found: Vec<String> = axis.ticks.iter().map(|t| axis.label(*t)).collect();
    assert_eq!((axis.unit.as_str(), found), (shown, labels.iter().map(|l| (*l).to_owned()).collect()));
}

#[test]
fn small_numbers_get_a_prefix() {
    check(&[0.0, -1.600_25e-3], "rad", "[mrad]", &["-1.5", "-1.0", "-0.5", "0"]);
    check(&[0.0, 2e-5], "", "[1e-6]", &["0", "5", "10", "15", "20"]);
    check(&[0.0, 3e-15], "J", "[fJ]", &["0", "1", "2", "3"]);
    check(&[0.0, 2e-18], "J", "[1e-18 J]", &["0", "0.5", "1.0", "1.5", "2.0"]);
    check(&[0.0, 1.0], "rad", "[rad]", &["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
}

#[test]
fn a_large_constant_is_taken_out() {
    check(&[100.0, 100.000_06], "rad/s", "− 100 [µrad/s]", &["0", "20", "40", "60"]);
    check(&[5.0, 5.0], "", "", &["4.0", "4.5", "5.0", "5.5", "6.0"]);
}

#[test]
fn decades_are_ticks_of_a_logarithmic_axis() {
    let axis = Axis::of(Scale::Log, "1/s", [0.0, 3e-16, 2e-14].iter());
    assert_eq!(axis.range, (-16.0, -13.0));
    assert_eq!(axis.label(axis.ticks[1]), "1e-15");
    let zero = Axis::of(Scale::Log, "", [0.0].iter());
    assert!(zero.range.0 < zero.range.1);
}
