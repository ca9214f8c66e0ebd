use super::*;

/// Rounding of a few operations on numbers of order ten.
const TOLERANCE: f64 = 1e-13;

fn through(points: &[(f64, f64)]) -> Spline {
    Spline::natural("test".to_owned(), points).expect("good points")
}

fn uneven() -> Vec<(f64, f64)> {
    (0..9).map(|k| (0.1 * f64::from(k * k) + 0.3 * f64::from(k), (1.7 * f64::from(k)).sin())).collect()
}

#[test]
fn two_points_make_a_line() {
    let line = through(&[(1.0, 2.0), (3.0, 8.0)]);
    for (t, x) in [(0.0, -1.0), (1.0, 2.0), (2.0, 5.0), (3.0, 8.0), (5.0, 14.0)] {
        assert_eq!(line.value(t), [x, 3.0, 0.0]);
    }
}

#[test]
fn it_passes_through_its_points_and_is_smooth_there() {
    let (points, spline) = (uneven(), through(&uneven()));
    for &(t, x) in &points {
        let [below, above] = [-1e-9, 1e-9].map(|d| spline.value(t + d));
        assert!((spline.value(t)[0] - x).abs() <= TOLERANCE, "{t}");
        // The third derivative is of order ten.
        assert!((0..3).all(|k| (below[k] - above[k]).abs() <= 1e-7), "{t}: {below:?} {above:?}");
    }
}

#[test]
fn its_ends_are_natural_and_go_on_straight() {
    let (points, spline) = (uneven(), through(&uneven()));
    for (t, out) in [(points[0].0, -2.0), (points[8].0, 2.0)] {
        let ([x, slope, bend], beyond) = (spline.value(t), spline.value(t + out));
        assert!(bend.abs() <= TOLERANCE);
        assert!((beyond[0] - x - out * slope).abs() <= TOLERANCE);
        assert!((beyond[1] - slope).abs() <= TOLERANCE && beyond[2] == 0.0);
    }
}

/// The natural spline of least bending, by the textbook example (0, 0), (1, 1), (2, 0): curvature −3 in the middle.
#[test]
fn three_points_have_the_known_curvature() {
    let [x, slope, bend] = through(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0)]).value(1.0);
    assert!((x - 1.0).abs() + slope.abs() + (bend + 3.0).abs() <= TOLERANCE);
}

#[test]
fn derivatives_are_those_of_the_value() {
    let (spline, h) = (through(&uneven()), 1e-4);
    for t in [-1.0, 0.2, 0.55, 3.1, 8.0, 20.0] {
        let [before, at, after] = [t - h, t, t + h].map(|t| spline.value(t));
        assert!(((after[0] - before[0]) / (2.0 * h) - at[1]).abs() <= 1e-6);
        assert!(((after[1] - before[1]) / (2.0 * h) - at[2]).abs() <= 1e-6);
    }
}

#[test]
fn bad_points_are_refused() {
    for (points, word) in [
        (&[(0.0, 0.0)][..], "too few"),
        (&[(0.0, 0.0), (0.0, 1.0)], "increase"),
        (&[(0.0, 0.0), (2.0, 1.0), (1.0, 1.0)], "row 3"),
        (&[(0.0, 0.0), (1.0, f64::NAN)], "row 2"),
        (&[(0.0, 1e300), (1e-300, -1e300)], "too close"),
    ] {
        let message = Spline::natural(String::new(), points).expect_err("a refusal");
        assert!(message.contains(word), "{message}");
    }
}
