use super::*;

#[test]
fn near_names_are_offered_and_far_ones_are_not() {
    let check = |written: &str, expected: Option<&str>| {
        assert_eq!(nearest(written, &["mass", "inertia", "angular_velocity"]), expected, "{written}");
    };
    check("mas", Some("mass"));
    check("Mass", Some("mass"));
    check("interia", Some("inertia"));
    check("angular-velocity", Some("angular_velocity"));
    check("colour", None);
    assert_eq!(nearest("zx", &["xx", "zz", "xz"]), Some("xz"));
    assert_eq!(nearest("q", &["m", "k"]), None);
    check("", None);
}

#[test]
fn columns_are_found_by_either_spelling() {
    let names = ["slide rate", "slide", "ball rate x", "tip.x"];
    let check = |written: &str, place: Option<usize>| {
        assert_eq!(column(written, names.iter().copied()), place, "{written}");
    };
    check("slide rate", Some(0));
    check("slide_rate", Some(0));
    check("slide", Some(1));
    check("ball_rate.x", Some(2));
    check("tip.x", Some(3));
    check("rate", None);
    // A column of that very name comes first.
    assert_eq!(column("slide_rate", ["slide rate", "slide_rate"].into_iter()), Some(1));
}

#[test]
fn suggested_names_are_names() {
    let check = |written: &str, expected: &str| {
        assert_eq!(snake_case(written), expected);
        assert!(is_snake_case(expected));
    };
    check("outer-ring", "outer_ring");
    check("OuterRing", "outer_ring");
    check("Outer Ring", "outer_ring");
    check("2nd ring", "a2nd_ring");
    check("", "a");
    check("é", "a");
}
