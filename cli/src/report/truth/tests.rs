use super::*;

#[test]
fn small_angles_between_rotations_are_angles() {
    let turned = |angle: f64| rotation([(0.5 * angle).cos(), 0.0, (0.5 * angle).sin(), 0.0]);
    let found = between(&turned(0.3), &turned(0.3 + 1e-6));
    assert!((found - 1e-6).abs() < 1e-14, "{found}");
}

#[test]
fn the_rotor_is_not_judged_and_its_error_is_there_nevertheless() {
    let path = crate::files::root().join("models/gyroscope.toml");
    let model = gyro_model::read("gyroscope.toml", &std::fs::read_to_string(path).unwrap()).unwrap();
    let reference = gyro_reference::scene("gyroscope").unwrap();
    let truth = Truth::of_reference(&model, &reference, 1.0);
    assert_eq!((truth.is_judged.clone(), truth.scale), (vec![true, true, false], 1.0));
    let sample = |t: f64, angles: [f64; 3]| Sample {
        t,
        coordinates: angles.map(|position| JointSample::Angle { position, rate: 0.0 }).to_vec(),
        outputs: vec![],
        controlled: vec![],
        bodies: vec![],
        kinetic: 0.0,
        potential: 0.0,
        work: 0.0,
        position_violation: 0.0,
        velocity_violation: 0.0,
        norm_violation: 0.0,
        chart_switches: 0,
    };
    let expected = reference.solve(&[0.5])[0].positions.clone();
    let found = [expected[0] + 1e-9, expected[1] - 3e-9, expected[2] + 1e-6];
    let errors = truth.errors(&[sample(0.5, found)], 1.0);
    assert!((truth.judge(&errors) - 3e-9).abs() < 1e-15 && (errors[2] - 1e-6).abs() < 1e-13, "{errors:?}");
    // A time off by one interval would be noticed.
    assert!(truth.judge(&truth.errors(&[sample(0.49, found)], 1.0)) > 1e-6);
    assert!(truth.judge(&truth.errors(&[sample(0.5, [f64::NAN, 0.0, 0.0])], 1.0)).is_infinite());
}
