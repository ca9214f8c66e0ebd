use super::*;

#[test]
fn angles_are_what_was_meant() {
    let mut angles = Angles::default();
    for (written, meant) in [
        ("1.5708", PI / 2.0),
        ("-1.57079632679", -PI / 2.0),
        ("3.1415", PI),
        ("3.1416", PI),
        ("4.71239", 1.5 * PI),
        ("0.7854", PI / 4.0),
        ("2.35619449019", 0.75 * PI),
        ("0.5236", PI / 6.0),
        ("1.0472", PI / 3.0),
        ("1.5707963267948966", PI / 2.0),
        // Not these: too few digits, or another angle.
        ("1.57", 1.57),
        ("1.571", 1.571),
        ("1.5709", 1.5709),
        ("0.785", 0.785),
        ("0.7855", 0.7855),
        ("0", 0.0),
        ("1e-7", 1e-7),
        ("0.00001", 0.00001),
    ] {
        let value: f64 = written.parse().expect("a number");
        let found = angles.meant(written, value, 7);
        assert!((found - meant).abs() < 1e-15, "{written}: {found} for {meant}");
    }
    let remarks = angles.remarks().join("\n");
    assert!(
        remarks.contains("1.5708 rad is taken for 90 degrees, a change of 3.7e-6 rad: line 7"),
        "{remarks}"
    );
    assert!(remarks.contains("1.57 rad stays 8.0e-4 rad off a right angle"), "{remarks}");
    assert!(!remarks.contains("0.785 ") && !remarks.contains("1.5707963267948966"), "{remarks}");
}
