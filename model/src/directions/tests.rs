use super::*;
use crate::parse_decimal;

fn numbers<const N: usize>(written: [&str; N]) -> [Number; N] {
    written.map(|text| Number::Exact(parse_decimal(text).expect("a decimal")))
}

fn settled(written: [&str; 3]) -> [Number; 3] {
    let mut direction = numbers(written);
    round(&mut direction);
    direction
}

#[test]
fn directions_have_a_bounded_number_of_digits() {
    assert_eq!(settled(["1", "0", "1e-76"]), numbers(["1", "0", "0"]));
    assert_eq!(settled(["1e90", "0", "1e60"]), numbers(["1e90", "0", "1e60"]));
    let long = format!("0.{}", "3".repeat(100));
    assert_eq!(settled([&long, "1", "0"]), numbers([&long[..34], "1", "0"]));
    // What an f64 prints stays, whatever its size: a cosine of a right angle too.
    for written in
        [["1", "6.123233995736766e-17", "0"], ["-3e-9", "2e-9", "1.0000000000000002e-9"], ["0", "0", "0"]]
    {
        assert_eq!(settled(written), numbers(written));
    }
}

#[test]
fn what_is_nearly_exact_is_offered_exactly() {
    let offered = |written: [&str; 3], free| direction(&numbers(written), free);
    assert_eq!(offered(["1", "-3.67e-6", "2"], None), Some(numbers(["1", "0", "2"])));
    assert_eq!(offered(["0", "-0.9999999999662689", "8.2e-6"], None), Some(numbers(["0", "-1", "0"])));
    assert_eq!(offered(["1", "-3.67e-6", "0"], Some(1)), None, "along the axis");
    assert_eq!(offered(["1", "0.0001", "0"], None), None, "so small an angle is meant");
    let turned = |written: [&str; 4]| orientation(&numbers(written));
    assert_eq!(turned(["0.7071068", "-0.7071067", "0", "0"]), Some(numbers(["1", "-1", "0", "0"])));
    assert_eq!(turned(["0.5", "0.5", "0.5", "0.5"]), None, "exact");
    assert_eq!(turned(["1", "0.001", "0", "0"]), None);
    let right = |text: &str| nearly_right(&numbers([text])[0]);
    assert_eq!(
        [right("1.5708"), right("-3.1416"), right("1.57"), right("0.0001")],
        [Some(1), Some(-2), Some(1), None]
    );
    assert_eq!(right("1.5707963267948966"), None, "all digits that there are");
}
