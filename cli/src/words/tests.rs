use super::*;

#[test]
fn long_lists_are_capped() {
    let lines = |n: usize| vec!["é".repeat(1000); n];
    assert_eq!(capped(&lines(2)).chars().count(), 2 * 803 + 1);
    assert!(!capped(&lines(30)).contains("more") && capped(&lines(100)).ends_with("\nand 70 more"));
}

#[test]
fn numbers_are_short_and_keep_their_digits() {
    for (value, digits, text) in [
        (0.0, 6, "0"),
        (100.0, 10, "100"),
        (0.099_665_123_456_789, 10, "0.09966512346"),
        (-1.600_25e-3, 6, "-0.00160025"),
        (1.234_567e-14, 3, "1.23e-14"),
        (2.5e8, 6, "2.5e8"),
        (999_999.9, 3, "1e6"),
        (10_000.0, 6, "10000"),
        (12_345.678, 3, "12346"),
        (f64::INFINITY, 3, "inf"),
    ] {
        assert_eq!(number(value, digits), text);
    }
}

#[test]
fn near_names_come_first() {
    let known = ["motor", "brake"];
    assert_eq!(instead("moter", &known), "write `motor`; there are `motor`, `brake`");
    assert_eq!(instead("wind", &known), "write one of `motor`, `brake`");
}

#[test]
fn counts_are_grouped() {
    assert_eq!(count(1, "step"), "1 step");
    assert_eq!(count(1001, "sample"), "1001 samples");
    assert_eq!(count(1_000_000, "step"), "1 000 000 steps");
}
