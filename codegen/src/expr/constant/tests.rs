use super::*;
use gyro_model::{parse_decimal, to_f64};

fn root(text: &str) -> Constant {
    Constant::rational(parse_decimal(text).expect("a decimal")).sqrt().expect("not negative")
}

#[test]
fn roots_multiply_back() {
    for text in ["2", "0.5", "1.05", "3.0000000009", "1e-9", "9", "1234567"] {
        let square = root(text).mul(&root(text));
        assert_eq!(square, Constant::rational(parse_decimal(text).expect("a decimal")), "{text}");
    }
}

/// Small parts and parts beyond 128 bits; what cancels and what does not.
#[test]
fn products_sums_and_nearest_doubles_are_those_of_rationals() {
    let parts = ["1", "-6", "1e-7", "-0.15", "2.5e30", "1234567e-9", "-3e-45", "0", "30", "1e-45", "3e-320"];
    let mut numbers: Vec<_> = parts.map(|text| parse_decimal(text).expect("a decimal")).to_vec();
    numbers.extend(numbers.clone().iter().map(|x| x / Rational::from_integer(21.into())));
    for a in &numbers {
        for b in &numbers {
            let [x, y] = [a, b].map(|x| Constant::rational(x.clone()));
            for (found, expected) in [(x.mul(&y), a * b), (x.add(&y).expect("a rational"), a + b)] {
                assert_eq!(found.to_f64(), to_f64(&expected), "{a}, {b}");
                assert_eq!(found, Constant::rational(expected), "{a}, {b}");
            }
        }
    }
}

#[test]
fn equal_constants_have_one_form() {
    assert_eq!(root("8"), Constant::integer(2).mul(&root("2")));
    assert_eq!(root("0.5").recip(), Some(root("2")));
    assert_eq!(root("2").add(&root("8")), Some(Constant::integer(3).mul(&root("2"))));
    assert_eq!(root("2").add(&root("3")), None);
    // 1000003 is beyond the primes whose squares are looked for.
    let [one, other] = ["2000006", "5000015"].map(root);
    assert_eq!(one.mul(&other), Constant::integer(1_000_003).mul(&root("10")));
    let square = root("2000012000018");
    assert_eq!(square.add(&root("2")), Some(Constant::integer(1_000_004).mul(&root("2"))));
    assert_eq!(square.add(&square.neg()), Some(Constant::integer(0)));
    assert_eq!(root("2").add(&square.neg()), Some(Constant::integer(-1_000_002).mul(&root("2"))));
    assert_eq!(square.add(&root("3")), None);
}

#[test]
fn roots_round_to_the_nearest_double() {
    for text in ["2", "3", "0.1", "1e-30", "7e20", "123.456"] {
        let expected = text.parse::<f64>().expect("a decimal").sqrt();
        assert!((root(text).to_f64() - expected).abs() <= f64::EPSILON * expected, "{text}");
    }
    assert_eq!(root("2").to_f64(), std::f64::consts::SQRT_2);
}

#[test]
fn whole_numbers_are_below() {
    for (text, expected) in [("2.5", 2), ("-2.5", -3), ("-3", -3), ("0", 0), ("-1e-30", -1), ("7", 7)] {
        let constant = Constant::rational(parse_decimal(text).expect("a decimal"));
        assert_eq!(constant.floor(), Constant::integer(expected), "{text}");
    }
}
