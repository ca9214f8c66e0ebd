use super::*;

/// Of limits, whose growth is one in a thousand.
const NEAR: f64 = 0.01;

#[test]
fn kutta_s_method_amplifies_like_its_polynomial() {
    for z in [Complex::new(-1.3, 0.4), Complex::new(0.2, 2.5), Complex::new(-2.7, 0.0)] {
        let taylor = 1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)));
        assert!((amplification(Integrator::Rk4, z) - taylor.norm()).abs() < 1e-14, "{z}");
    }
    // L-stable: what is fast is gone.
    assert!(amplification(Integrator::Rodas4, Complex::new(-1e9, 0.0)) < 1e-6);
}

#[test]
fn limits_along_rays_are_those_of_the_literature() {
    let [real, imaginary] = [Complex::new(-1.0, 0.0), Complex::new(0.0, 1.0)];
    // Hairer and Wanner, IV.2: 2.785 on the negative axis, √8 on the imaginary one.
    for (ray, expected) in [(real, 2.785_29), (imaginary, 8.0_f64.sqrt())] {
        let found = limit_along(Integrator::Rk4, ray).unwrap();
        assert!((found / expected - 1.0).abs() < NEAR, "{found} for {expected}");
    }
    assert_eq!(limit_along(Integrator::Rodas4, real), None);
    assert_eq!(limit_along(Integrator::Rodas4, Complex::new(-1.0, 30.0)), None);
    // The methods' own figure for the solver.
    let known = [
        (Integrator::Tsit5, <Tsit5<[f64; 2]> as Method<Test>>::STABILITY),
        (Integrator::Dop853, <Dop853<[f64; 2], f64> as Method<Test>>::STABILITY),
    ];
    for (integrator, expected) in known {
        let found = limit_along(integrator, real).unwrap();
        assert!((found / expected - 1.0).abs() < 0.05, "{integrator}: {found} for {expected}");
    }
}

#[test]
fn the_fastest_eigenvalue_sets_the_limit() {
    let stiff = [Complex::new(-165_626.0, 0.0), Complex::new(-1006.0, 0.0), Complex::new(1e-9, 0.0)];
    let found = limit(Integrator::Rk4, &stiff).unwrap();
    assert!((found / 1.682e-5 - 1.0).abs() < NEAR, "{found}");
    let ringing = [Complex::new(-833.0, 12_882.0), Complex::new(-833.0, -12_882.0)];
    let found = limit(Integrator::Rk4, &ringing).unwrap();
    assert!((found / 2.267e-4 - 1.0).abs() < NEAR, "{found}");
    assert_eq!(limit(Integrator::Rodas4, &stiff), None);
}

#[test]
fn a_planted_limit_is_found_from_guesses_far_off() {
    for guess in [1e-3, 0.02, 0.3, 7.0] {
        let found = search(guess, |step| step < 0.3).limit.unwrap();
        assert!((found / 0.3 - 1.0).abs() < WIDTH + 1e-9, "{guess}: {found}");
    }
    assert_eq!(search(1.0, |_| true).limit, None);
    assert_eq!(search(1.0, |_| false).limit, None);
}

#[test]
fn the_stiff_bearing_has_the_eigenvalues_of_its_page() {
    let path = crate::files::root().join("models/gyroscope-stiff.toml");
    let model = gyro_model::read("x.toml", &std::fs::read_to_string(path).unwrap()).unwrap();
    let knob = Knob::of(&model);
    let limit_at = |damping: f64| {
        let spectrum = Spectrum::new(&model, knob, damping).unwrap();
        assert_eq!(spectrum.coordinates, Coordinates::Joint);
        limit(Integrator::Rk4, &spectrum.eigenvalues).unwrap()
    };
    for (damping, expected) in [(1e-2, 2.267e-4), (1.0, 1.682e-5)] {
        let found = limit_at(damping);
        assert!((found / expected - 1.0).abs() < NEAR, "{found} for {expected}");
    }
}
