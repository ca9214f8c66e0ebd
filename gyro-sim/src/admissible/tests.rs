use super::*;

#[test]
fn inertias_are_decided_on_the_boundary() {
    let cases: [([f64; 6], bool); 9] = [
        ([1.0, 1.0, 1.0, 0.0, 0.0, 0.0], true),
        ([1.0, 1.0, 2.0, 0.0, 0.0, 0.0], true),
        ([0.1, 0.2, 0.3, 0.0, 0.0, 0.0], true),
        ([1e6, 1e6, 2_000_001.0, 0.0, 0.0, 0.0], false),
        ([0.0, 1.0, 1.0, 0.0, 0.0, 0.0], false),
        ([2.0, 2.0, 2.0, 2.0, 0.0, 0.0], false),
        ([2.0, 2.0, 4.0, 1.0, 0.0, 0.0], true),
        ([2.0, 2.0, 4.1, 1.0, 0.0, 0.0], false),
        ([1e-90, 1e-90, 1e-90, 0.0, 0.0, 0.0], true),
    ];
    for (elements, is_allowed) in cases {
        let is_inertia = check(&elements, |elements| [(0, Rule::Inertia(elements))]).is_ok();
        assert_eq!(is_inertia, is_allowed, "{elements:?}");
    }
}

/// `m L² / 12 − 1` of m = 3 and L = 2 is zero.
#[test]
fn computed_numbers_are_judged_by_their_values() {
    let number = |p: [f64; 2]| p[0] * power(p[1], 2) / 12.0 - 1.0;
    let positive = |p| [(0, Rule::Positive(number(p)))];
    let not_negative = |p| [(0, Rule::NotNegative(number(p)))];
    assert!(check(&[3.0, 2.0], not_negative).is_ok());
    assert_eq!(check(&[2.9, 2.0], not_negative), Err(Inadmissible { parameter: 0 }));
    assert!(check(&[3.0, 2.0], positive).is_err());
    assert!(check(&[3.0, -2.1], positive).is_ok());
}

#[test]
fn what_is_no_number_of_a_page_breaks_any_rule() {
    for value in [f64::NAN, f64::INFINITY, 1e-101, -1e101] {
        assert_eq!(check(&[1.0, value], |_| []), Err(Inadmissible { parameter: 1 }), "{value}");
    }
    assert!(check(&[1.0, 0.0, -5.0], |_| []).is_ok());
    type Kind = fn(f64) -> Rule;
    let kinds: [(Kind, f64, f64); 3] = [
        (|p| Rule::Positive(-p), -1.0, 0.0),
        (|p| Rule::NotNegative(-p), 0.0, 1.0),
        (|p| Rule::NotZero([0.0, p, 0.0, 0.0]), -1.0, 0.0),
    ];
    for (rule, good, bad) in kinds {
        let rules = |p: [f64; 1]| [(0, rule(p[0]))];
        assert!(check(&[good], rules).is_ok() && check(&[bad], rules).is_err(), "{:?}", rule(good));
    }
    let rules = |p: [f64; 2]| [(0, Rule::NotParallel([1.0, 2.0, 0.0], [p[0], p[1], 0.0]))];
    assert!(check(&[2.0, 1.0], rules).is_ok() && check(&[-3.0, -6.0], rules).is_err());
    assert_eq!(check(&[2.0, 0.0], |p| [(1, Rule::Positive(p[1]))]), Err(Inadmissible { parameter: 1 }));
}
