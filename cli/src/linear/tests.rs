use super::*;

fn model(file: &str) -> Model {
    let path = crate::files::root().join("models").join(file);
    gyro_model::read(file, &std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Differences of sixth order; see [`ANGLE_STEP`].
const RELATIVE: f64 = 1e-9;

#[test]
fn the_gyroscope_has_the_nutation_and_precession_of_its_closed_form() {
    let model = model("gyroscope.toml");
    let linear = Linear::about_start(&model).unwrap();
    // With m d² of the rotor in both inertias: H = 1e-3 N·m·s, weight's torque 1e-4 N·m.
    let (i_alpha, i_beta) = (8.001_25e-6_f64, 6.001_25e-6_f64);
    let omega = 1e-3 / (i_alpha * i_beta).sqrt();
    let response = linear.response(&model, 1e-3, 1001).unwrap();
    for (k, (alpha, beta)) in response.angles[0].iter().zip(&response.angles[1]).enumerate() {
        let t = k as f64 * 1e-3;
        let expected_beta = -0.1 * i_alpha / 1e-3 * (1.0 - (omega * t).cos());
        let expected_alpha = 0.1 * (t - (omega * t).sin() / omega);
        assert!((beta - expected_beta).abs() < RELATIVE * 1.6e-3, "{t}: {beta} for {expected_beta}");
        assert!((alpha - expected_alpha).abs() < RELATIVE * 0.1, "{t}: {alpha} for {expected_alpha}");
    }
}

#[test]
fn a_kicked_gyroscope_nutates_about_its_spin() {
    let model = model("gyroscope-free-nutation.toml");
    let response = Linear::about_start(&model).unwrap().response(&model, 1e-3, 1001).unwrap();
    // No offset, no weight: α̈ = −(H / I_α) β̇, β̈ = (H / I_β) α̇ from the rates 1 and 0.5 rad/s.
    let (i_alpha, i_beta) = (8e-6_f64, 6e-6_f64);
    let omega = 1e-3 / (i_alpha * i_beta).sqrt();
    let turned = [(1.0, -0.5 * (i_beta / i_alpha).sqrt()), (0.5, (i_alpha / i_beta).sqrt())];
    for (angles, (along, across)) in response.angles.iter().zip(turned) {
        for (k, angle) in angles.iter().enumerate() {
            let (sin, cos) = (omega * k as f64 * 1e-3).sin_cos();
            let expected = (along * sin + across * (1.0 - cos)) / omega;
            assert!((angle - expected).abs() < RELATIVE * 1e-2, "{k}: {angle} for {expected}");
        }
    }
}

#[test]
fn where_the_start_says_little_of_the_motion_there_is_no_theory() {
    let about = |file: &str| {
        let model = model(file);
        Linear::about_start(&model).and_then(|l| l.response(&model, 1e-3, 1001)).map(|_| ())
    };
    assert_eq!(about("free-body.toml"), Err("a body is free".to_owned()));
    assert!(about("heavy-top.toml").unwrap_err().ends_with("is spherical"));
    assert!(about("compound-pendulum.toml").unwrap_err().contains("accelerations err by up to"));
    assert_eq!(about("gyroscope-maximal.toml"), Ok(()));
}
