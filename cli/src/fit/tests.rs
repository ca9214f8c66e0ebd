use super::*;

fn samples(n: usize, interval: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..n).map(|k| f(k as f64 * interval)).collect()
}

/// Normal equations of well-scaled columns: some rounding errors of one.
const RELATIVE: f64 = 1e-10;

#[test]
fn planted_line_and_harmonic_are_found() {
    for (slope, omega, amplitude) in [(0.1, 144.311, 7e-4), (-3.0, 14.0, 0.5), (0.0, 2900.0, 1e-3)] {
        let values = samples(1001, 1e-3, |t| 0.25 + slope * t + amplitude * (omega * t + 0.7).cos());
        let fit = fit(1e-3, &values).unwrap();
        let harmonic = fit.harmonic.unwrap();
        assert!((fit.slope - slope).abs() <= RELATIVE * amplitude, "{fit:?}");
        assert!((fit.mean - (0.25 + 0.5 * slope)).abs() <= RELATIVE * amplitude.max(1.0), "{fit:?}");
        assert!((harmonic.omega / omega - 1.0).abs() <= RELATIVE, "{fit:?}");
        assert!((harmonic.amplitude / amplitude - 1.0).abs() <= RELATIVE, "{fit:?}");
    }
}

#[test]
fn a_spin_with_a_tiny_ripple_is_a_line() {
    let values = samples(1001, 1e-3, |t| 100.0 * t + 1e-6 * (144.0 * t).sin());
    let fit = fit(1e-3, &values).unwrap();
    assert!(fit.harmonic.is_none() && (fit.slope - 100.0).abs() < 1e-6, "{fit:?}");
}

#[test]
fn what_cannot_be_explained_is_not_fitted() {
    let fitted = |f: fn(f64) -> f64| fit(1e-3, &samples(1001, 1e-3, f));
    assert_eq!(fitted(|_| 0.3), Err(NoFit::Still));
    assert_eq!(fitted(|t| (5.0 * t).sin()), Err(NoFit::TooShort));
    assert!(matches!(fitted(|t| (20.0 * t).sin() + (50.0 * t).sin()), Err(NoFit::Unexplained(_))));
    assert!(matches!(fitted(|t| t * t * t + (99.0 * t * t).sin()), Err(NoFit::Unexplained(_))));
    assert_eq!(fit(1e-3, &[0.0, 1.0, 0.0]), Err(NoFit::TooShort));
}

#[test]
fn many_samples_are_thinned() {
    let values = samples(600_000, 1e-4, |t| 0.1 * t + 7e-4 * (144.311 * t).sin());
    let harmonic = fit(1e-4, &values).unwrap().harmonic.unwrap();
    assert!((harmonic.omega / 144.311 - 1.0).abs() < RELATIVE);
}
