use super::*;

/// A four-bar linkage on the x axis; the last joint has no start.
fn four_bar(crank: &str, rocker: &str) -> Model {
    let bar = |name: &str| format!("[[body]]\nname = \"{name}\"\nmass = 1\ninertia = [0.01, 0.02, 0.02]\n");
    let hinge = |name: &str, [first, at]: [&str; 2], [second, on]: [&str; 2], start: &str| {
        format!(
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
             first = {{ body = \"{first}\", point = [{at}, 0, 0] }}\n\
             second = {{ body = \"{second}\", point = [{on}, 0, 0] }}\n{start}\n"
        )
    };
    let text = [
        "format = 1\nname = \"four_bar\"\n[parameters]\nrocker_half = 0.25\n".to_owned(),
        "[[body]]\nname = \"ground\"\nfixed = true\n".to_owned(),
        ["crank", "coupler", "rocker"].map(bar).concat(),
        hinge("a", ["ground", "0"], ["crank", "-0.1"], crank),
        hinge("b", ["crank", "0.1"], ["coupler", "-0.3"], "angle_deg = -30\nrough = true"),
        hinge("d", ["ground", "0.6"], ["rocker", "\"-rocker_half\""], rocker),
        hinge("c", ["coupler", "0.3"], ["rocker", "\"rocker_half\""], ""),
    ];
    gyro_model::read("four_bar.toml", &text.concat()).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// The angle of the rocker that closes the loop for an angle of the crank, by the cosine rule.
fn rocker(crank: f64) -> f64 {
    let (x, y) = (0.2 * crank.cos() - 0.6, 0.2 * crank.sin());
    let far = x.hypot(y);
    y.atan2(x) - ((far * far + 0.25 - 0.36) / far).acos()
}

/// The study sets where a rough joint starts: it starts there, and other rough joints move.
#[test]
fn the_start_of_a_rough_joint_is_the_one_that_is_set() {
    const ROUGH: &str = "angle_deg = 90\nrough = true";
    let page = four_bar("angle_deg = 60\nrough = true", ROUGH);
    for value in [1.56, 1.6, 1.7] {
        let (start, moved) = started(&page, (&[Target::Start(2, 0)], &[value]), &[(0, 0), (1, 0)]).unwrap();
        assert!((start.angles[2] - value).abs() < 1e-12, "{} of {value}", start.angles[2]);
        assert!((rocker(start.angles[0]) - value).abs() < 1e-9, "{} of {value}", start.angles[0]);
        assert!((moved[0] - (start.angles[0] - 60_f64.to_radians())).abs() < 1e-12);
    }
    // What the model file holds leaves no other value to the rocker.
    let page = four_bar("angle_deg = 60", ROUGH);
    let held = rocker(60_f64.to_radians());
    let refused = started(&page, (&[Target::Start(2, 0)], &[1.2]), &[]).unwrap_err();
    assert!(refused.contains("joint `d`") || refused.contains("joint `a`"), "{refused}");
    assert!(refused.contains("rad"), "{refused}");
    let (start, _) = started(&page, (&[Target::Start(2, 0)], &[held]), &[]).unwrap();
    assert!((start.angles[2] - held).abs() < 1e-12);
}

/// The start that comes with other parameters is the one that is assembled anew.
#[test]
fn a_start_known_already_has_the_bits_of_one_that_is_assembled() {
    let page = four_bar("angle_deg = 60", "angle_deg = 90\nrough = true");
    for value in [0.24, 0.25, 0.26] {
        let (model, start) = assembled(&page, &[Target::Parameter(0)], &[value]).unwrap();
        assert_eq!(start, model.assemble().unwrap());
    }
}
