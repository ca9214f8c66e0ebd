use super::*;

/// Rounding of a few operations on numbers of order ten.
const TOLERANCE: f64 = 1e-13;

const POINTS: [(f64, f64); 6] = [(-1.0, 2.0), (0.0, 0.5), (0.5, 0.5), (2.0, 1.7), (2.5, 4.0), (4.0, 3.0)];

fn curve(joined: Joined, beyond: Beyond) -> Curve {
    Curve::through(("c".to_owned(), "test".to_owned()), &POINTS, joined, beyond).expect("good points")
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= TOLERANCE * expected.abs().max(1.0), "{found} for {expected}");
}

#[test]
fn every_kind_goes_through_its_points() {
    for (_, joined) in Joined::ALL {
        for (_, beyond) in Beyond::ALL {
            let curve = curve(joined, beyond);
            for (x, y) in POINTS {
                near(curve.spline.value(x)[0], y);
            }
            assert_eq!(curve.ends, [-1.0, 4.0]);
            assert_eq!(curve.domain().is_some(), beyond == Beyond::Error);
        }
    }
}

#[test]
fn a_smooth_one_is_the_natural_spline() {
    let natural = Spline::natural(String::new(), &POINTS).expect("good points");
    for beyond in [Beyond::Line, Beyond::Error] {
        let curve = curve(Joined::Smooth, beyond);
        assert_eq!(
            (curve.spline.knots, curve.spline.pieces),
            (natural.knots.clone(), natural.pieces.clone())
        );
    }
    let held = curve(Joined::Smooth, Beyond::Hold);
    for x in [-0.4, 0.2, 1.1, 2.3, 3.9] {
        for (found, expected) in held.spline.value(x).into_iter().zip(natural.value(x)) {
            near(found, expected);
        }
    }
    assert!(!held.is_smooth() && curve(Joined::Smooth, Beyond::Line).is_smooth());
}

#[test]
fn lines_and_steps_are_what_they_say() {
    let (linear, steps) = (curve(Joined::Linear, Beyond::Line), curve(Joined::Steps, Beyond::Line));
    for pair in POINTS.windows(2) {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        for part in [0.0, 0.3, 0.8] {
            let [value, slope, bend] = linear.spline.value(x0 + part * (x1 - x0));
            near(value, y0 + part * (y1 - y0));
            near(slope, (y1 - y0) / (x1 - x0));
            near(bend, 0.0);
            assert_eq!(steps.spline.value(x0 + part * (x1 - x0)), [y0, 0.0, 0.0]);
        }
    }
    assert!(!linear.is_smooth() && !steps.is_smooth());
}

#[test]
fn beyond_the_ends_it_goes_on_or_stays() {
    for joined in [Joined::Smooth, Joined::Monotone, Joined::Linear] {
        let (line, hold) = (curve(joined, Beyond::Line), curve(joined, Beyond::Hold));
        for (end, out) in [(-1.0, -1e-9), (4.0, 1e-9)] {
            let inner = line.spline.value(end - out);
            for away in [0.5, 3.0, 40.0, 1e6] {
                let x = end + away * out.signum();
                let [value, slope, bend] = line.spline.value(x);
                assert!((slope - inner[1]).abs() < 1e-7 && bend == 0.0, "{joined:?} {x}");
                near(value, line.spline.value(end)[0] + slope * (x - end));
                assert_eq!(hold.spline.value(x), [hold.spline.value(end)[0], 0.0, 0.0]);
            }
        }
    }
    let steps = curve(Joined::Steps, Beyond::Line);
    for x in [-50.0, -1.1, 4.0, 4.1, 77.0] {
        assert_eq!(steps.spline.value(x), [if x < 0.0 { 2.0 } else { 3.0 }, 0.0, 0.0]);
    }
}

/// The slopes at the points by hand: chords −1.5, 0, 0.8, 4.6, −2/3 over widths 1, 0.5, 1.5, 0.5, 1.5.
#[test]
fn a_monotone_one_has_the_slopes_of_fritsch_and_butland() {
    let curve = curve(Joined::Monotone, Beyond::Line);
    // At the ends of three points: ((2 h₀ + h₁) d₀ − h₀ d₁) / (h₀ + h₁), kept to the sign of d₀.
    let first = (2.5 * -1.5 - 1.0 * 0.0) / 1.5;
    // At 2: 3 (h + h') / ((2 h' + h) / d + (h' + 2 h) / d') with h = 1.5 and h' = 0.5.
    let inner = 6.0 / (2.5 / 0.8 + 3.5 / 4.6);
    // ((2 · 1.5 + 0.5) · (−2/3) − 1.5 · 4.6) / 2 is beyond three times the chord, which differs in sign from the next.
    let last = 3.0 * (-2.0 / 3.0);
    for (x, slope) in [(-1.0, first), (0.0, 0.0), (0.5, 0.0), (2.0, inner), (2.5, 0.0), (4.0, last)] {
        near(curve.spline.value(x)[1], slope);
    }
    // Between two points nothing is outside of their values, and slopes are continuous.
    for pair in POINTS.windows(2) {
        let [(x0, y0), (x1, y1)] = [pair[0], pair[1]];
        for k in 0..=100 {
            let value = curve.spline.value(x0 + f64::from(k) / 100.0 * (x1 - x0))[0];
            assert!(value >= y0.min(y1) - TOLERANCE && value <= y0.max(y1) + TOLERANCE, "{x0} {k} {value}");
        }
        let [below, above] = [-1e-9, 1e-9].map(|d| curve.spline.value(x1 + d)[1]);
        assert!((below - above).abs() < 1e-6, "{x1}: {below} {above}");
    }
}

#[test]
fn derivatives_are_those_of_the_value() {
    let h = 1e-5;
    for (_, joined) in Joined::ALL {
        let curve = curve(joined, Beyond::Hold);
        for x in [-3.0, -0.6, 0.3, 1.2, 2.2, 3.3, 9.0] {
            let [before, at, after] = [x - h, x, x + h].map(|x| curve.spline.jet(x));
            for order in 0..3 {
                let quotient = (after[order] - before[order]) / (2.0 * h);
                assert!((quotient - at[order + 1]).abs() < 1e-5, "{joined:?} {x} {order}: {quotient} {at:?}");
            }
        }
    }
}

#[test]
fn two_points_are_enough() {
    for (_, joined) in Joined::ALL {
        let points = [(1.0, 2.0), (3.0, 8.0)];
        let curve = Curve::through((String::new(), String::new()), &points, joined, Beyond::Line);
        let [value, ..] = curve.expect("two points").spline.value(2.0);
        near(value, if joined == Joined::Steps { 2.0 } else { 5.0 });
    }
}

#[test]
fn bad_points_are_refused() {
    for (points, reason) in [
        (vec![(0.0, 1.0)], "at least two"),
        (vec![(0.0, 1.0), (0.0, 2.0)], "must increase"),
        (vec![(0.0, 1.0), (1.0, f64::NAN)], "not finite"),
        (vec![(0.0, 0.0), (1e-300, 1e100)], "too close"),
    ] {
        for (_, joined) in Joined::ALL {
            let found = Curve::through((String::new(), String::new()), &points, joined, Beyond::Line);
            assert!(found.is_err_and(|error| error.contains(reason)), "{reason} {joined:?}");
        }
    }
}
