use super::*;

/// The natural spline through (0, 0), (1, 1), (3, 0): moments 0, −3/2, 0 by hand.
const KNOTS: [f64; 3] = [0.0, 1.0, 3.0];
const PIECES: [[f64; 4]; 2] = [[0.0, 1.25, 0.0, -0.25], [1.0, 0.5, -0.75, 0.125]];

#[test]
fn pieces_join_smoothly_and_go_on_straight() {
    for (t, expected) in [
        (-2.0, [-2.5, 1.25, 0.0]),
        (0.0, [0.0, 1.25, 0.0]),
        (1.0, [1.0, 0.5, -1.5]),
        (2.0, [0.875, -0.625, -0.75]),
        (3.0, [0.0, -1.0, 0.0]),
        (5.0, [-2.0, -1.0, 0.0]),
    ] {
        assert_eq!(evaluate(&KNOTS, &PIECES, t), expected, "{t}");
    }
    for knot in KNOTS {
        let (before, after) = (evaluate(&KNOTS, &PIECES, knot.next_down()), evaluate(&KNOTS, &PIECES, knot));
        let worst = before.iter().zip(after).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-14, "{knot}: {worst}");
    }
}

#[test]
fn no_table_and_no_time_do_not_panic() {
    assert_eq!(evaluate(&[], &[], 1.0), [0.0; 3]);
    assert_eq!(evaluate(&[1.0], &[], 1.0), [0.0; 3]);
    assert_eq!(evaluate(&[], &PIECES, 1.0), [0.0; 3]);
    assert!(evaluate(&KNOTS, &PIECES, f64::NAN)[0].is_nan());
}
