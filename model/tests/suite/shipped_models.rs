//! The model files in `models/` are good, named after their files, and start as their sources say.

use gyro_model::{JointKind, JointStart, Model, OutputKind, RowOwner, Start, Support, read};

fn model(stem: &str) -> Model {
    model_in("models", stem)
}

fn model_in(folder: &str, stem: &str) -> Model {
    let path = crate::support::folder(folder).join(format!("{stem}.toml"));
    let text = std::fs::read_to_string(path).expect("a shipped model file");
    read(stem, &text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn start(stem: &str) -> Start {
    model(stem).assemble().expect("a shipped model file has a start")
}

fn rates(stem: &str) -> Vec<f64> {
    start(stem).joints.into_iter().flat_map(|joint| joint.rate).collect()
}

#[test]
fn every_page_is_named_after_its_file() {
    let pages = crate::support::pages("models");
    assert!(pages.len() >= 30);
    for (path, _) in pages {
        let stem = path.file_stem().and_then(|s| s.to_str()).expect("a name");
        assert_eq!(model(stem).name, stem.replace('-', "_"));
    }
}

#[test]
fn the_gyroscopes_start_as_the_paper_says() {
    let spinning = ["", "-maximal", "-viscous", "-parameters", "-radial-imbalance", "-combined-offsets"];
    for suffix in spinning {
        assert_eq!(rates(&format!("gyroscope{suffix}")), [0.0, 0.0, 100.0], "{suffix}");
    }
    assert_eq!(rates("gyroscope-free-nutation"), [1.0, 0.5, 100.0]);
    let rotor = start("gyroscope").q.split_off(14);
    assert_eq!(rotor, [0.000125, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!(start("gyroscope").v.split_off(12), [0.0, 0.0, 0.0, 100.0, 0.0, 0.0]);
}

#[test]
fn an_imbalanced_rotor_starts_with_the_velocity_of_its_mass_centre() {
    // s3 = −w3 × s3' for a joint at rest: −100 x × 0.0002 y.
    assert_eq!(start("gyroscope-radial-imbalance").v[12..15], [0.0, 0.0, -0.02]);
}

#[test]
fn sizes_are_the_papers() {
    let model = model("gyroscope-maximal");
    assert_eq!(model.coordinate_bodies().len() * 7, 28);
    assert_eq!(model.rows().len() + model.coordinate_bodies().len(), 25);
}

#[test]
fn parameters_can_be_set_within_reason() {
    let model = model("gyroscope-parameters");
    let set = |name: &str, value: &str| {
        let value = gyro_model::parse_decimal(value).expect("a decimal");
        model.with_parameters(&[(name.to_owned(), value)])
    };
    let lighter = set("rotor_mass", "0.04").expect("a lighter rotor");
    assert_eq!(lighter.value(&lighter.bodies[3].mass), 0.04);
    let refused = |name: &str, value: &str, expected: &str| {
        let message = set(name, value).expect_err(name);
        assert!(message.contains(expected), "{message}");
    };
    refused("rotor_mass", "0", "the mass of body `rotor` is not positive");
    refused("ring_axial_inertia", "1", "the inertia of body `outer_ring` breaks the triangle inequality");
    refused("gravity", "1e200", "parameter `gravity` is too large or too small");
    refused("rotor_mas", "0.04", "write `rotor_mass`");
}

#[test]
fn the_heavy_top_and_the_pendulum_lean_as_their_comments_say() {
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-15, "{a} {b}");
    let top = start("heavy-top");
    near(top.q[1], -0.024);
    near(top.q[2], 0.032);
    assert_eq!(top.v[3..6], [0.0, 1.1982587525585533, 200.0]);
    let pendulum = start("compound-pendulum");
    let expected = JointStart { position: vec![std::f64::consts::FRAC_PI_2], rate: vec![0.0] };
    assert_eq!(pendulum.joints, [expected]);
    near(pendulum.q[0], 0.5);
    near(pendulum.q[1], 0.0);
}

#[test]
fn moving_bases_carry_the_gyroscope_from_rest_in_the_base() {
    use std::f64::consts::TAU;
    for (stem, base) in [
        ("driven-gyroscope", [0.1 * 2.0 * TAU, 0.0, 0.0]),
        ("pitching-gyroscope", [0.1 * 2.0 * TAU, 0.0, 0.05 * 3.0 * TAU]),
    ] {
        assert_eq!(rates(stem), [0.0, 0.0, 100.0], "{stem}");
        assert_eq!(model(stem).bodies[0].support, Support::Driven);
        assert_eq!(model(stem).rows().len(), 15);
        // The rings turn with the base, the rotor 100 rad/s faster about its x axis.
        let v = start(stem).v;
        for (moving_body, spin) in [(0, 0.0), (1, 0.0), (2, 100.0)] {
            for (k, base) in base.into_iter().enumerate() {
                let expected = base + if k == 0 { spin } else { 0.0 };
                assert!((v[6 * moving_body + 3 + k] - expected).abs() <= 1e-13, "{stem} {v:?}");
            }
        }
    }
}

#[test]
fn the_camera_starts_at_rest_in_its_vehicle() {
    use std::f64::consts::{FRAC_PI_3, PI, TAU};
    let (model, start) = (model("stabilised-gimbal"), start("stabilised-gimbal"));
    assert_eq!((model.degrees_of_freedom(), model.controllers.len(), model.contacts.len()), (2, 2, 2));
    let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-15, "{a} {b}");
    near(start.joints[0].position[0], FRAC_PI_3);
    near(start.joints[1].position[0], PI / 18.0);
    // The yoke turns with the vehicle, whose x axis is 60 degrees away from its own.
    let (roll, yaw) = (0.15 * 0.5 * TAU, 0.05 * 1.3 * TAU);
    let expected = [roll * FRAC_PI_3.cos(), -roll * FRAC_PI_3.sin(), yaw];
    start.v[3..6].iter().zip(expected).for_each(|(a, b)| near(*a, b));
}

#[test]
fn extreme_gyroscopes_start_as_their_comments_say() {
    for (stem, expected) in [
        ("gyroscope-fast", [0.0, 0.0, 1e5]),
        ("gyroscope-at-rest", [0.0; 3]),
        ("gyroscope-light-rings", [0.0, 0.0, 100.0]),
        ("gyroscope-heavy-rotor", [0.0, 0.0, 100.0]),
        ("gyroscope-gimbal-lock", [0.0, 0.0, 10.0]),
        ("gyroscope-stiff", [0.0, 0.0, 100.0]),
        ("gyroscope-overdamped", [0.0, 0.0, 100.0]),
        ("gyroscope-coulomb", [0.0, 0.0, 100.0]),
        ("gyroscope-rolling-base", [0.0, 0.0, 100.0]),
        ("gyroscope-long", [1.0, 0.5, 100.0]),
    ] {
        assert_eq!(rates(stem), expected, "{stem}");
    }
    for stem in ["gyroscope-stiff", "gyroscope-overdamped"] {
        assert_eq!(start(stem).joints[1].position, [0.001]);
    }
    // At 20 Hz and 0.5 rad.
    assert!((start("gyroscope-rolling-base").v[3] - 62.831_853_071_795_86).abs() <= 1e-13);
}

#[test]
fn the_linkage_in_line_is_a_parallelogram_without_redundancy() {
    let model = model("four-bar-in-line");
    assert_eq!((model.rows().len(), model.redundant.len(), model.degrees_of_freedom()), (17, 0, 1));
    let start = start("four-bar-in-line");
    let third = std::f64::consts::FRAC_PI_3;
    for (joint, expected) in [(0, -third), (1, -third), (2, third)] {
        assert!((start.joints[joint].position[0] - expected).abs() <= 1e-12, "{:?}", start.joints[joint]);
    }
    assert!((start.joints[1].rate[0] - 12.0).abs() <= 1e-11, "{:?}", start.joints[1]);
}

#[test]
fn four_bars_have_one_degree_of_freedom_with_and_without_redundant_rows() {
    let (free, revolute) = (model("four-bar"), model("four-bar-revolute"));
    assert_eq!((free.rows().len(), free.redundant.len(), free.degrees_of_freedom()), (17, 0, 1));
    assert_eq!((revolute.rows().len(), revolute.redundant.len(), revolute.degrees_of_freedom()), (17, 3, 1));
    let knee = revolute.joints.iter().position(|j| j.name == "knee").expect("the joint that closes the loop");
    assert!(revolute.redundant.iter().all(|r| r.row.owner == RowOwner::Joint(knee)));
    let (free, revolute) = (start("four-bar"), start("four-bar-revolute"));
    for (a, b) in free.q.iter().zip(&revolute.q).chain(free.v.iter().zip(&revolute.v)) {
        assert!((a - b).abs() <= 1e-12, "{a} {b}");
    }
    // The joint of coupler and rocker, from the circles about the crank's end and the rocker's pivot.
    let [x, y] = [0.547_005_012_015_678_2, 0.397_228_559_956_866_7];
    let (centre, angle) = (&revolute.q[14..16], revolute.joints[1].position[0]);
    assert!((centre[0] + 0.2 * angle.cos() - x).abs() <= 1e-12);
    assert!((centre[1] + 0.2 * angle.sin() - y).abs() <= 1e-12);
}

#[test]
fn the_spring_of_the_torsion_page_is_wound_up_by_turns() {
    assert_eq!(start("torsion").joints[0].position, [6.5 * std::f64::consts::PI]);
    assert_eq!(model("torsion").turn_references().len(), 1);
    assert!(model("torsion").has_work());
}

#[test]
fn the_spinning_top_starts_as_its_source_says() {
    let top = start("spinning-top");
    assert_eq!(top.q, [0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
    assert_eq!(top.v, [4.61538, 0.0, 0.0, 0.0, 150.0, -4.61538]);
}

#[test]
fn all_joints_has_every_kind_and_starts_where_its_points_were_chosen() {
    let model = model_in("tests/models", "all-joints");
    let kinds = [
        JointKind::Revolute,
        JointKind::Spherical,
        JointKind::Fixed,
        JointKind::Universal,
        JointKind::Cylindrical,
        JointKind::Prismatic,
        JointKind::Planar,
        JointKind::Screw,
        JointKind::PointOnLine,
        JointKind::Rod,
    ];
    assert!(kinds.iter().all(|kind| model.joints.iter().any(|j| j.kind == *kind)));
    assert_eq!(
        (model.coordinate_bodies().len(), model.redundant.len(), model.degrees_of_freedom()),
        (7, 0, 2)
    );
    assert!(model.outputs.iter().any(|o| matches!(o.kind, OutputKind::Inertial { .. })));
    let start = model.assemble().expect("a start");
    let positions = [
        [0.2, 0.1, 0.4],
        [0.5, 0.2, 0.5],
        [0.8, 0.3, 0.4],
        [0.1, 0.7, 0.2],
        [0.3, 0.8, 0.4],
        [0.4, 0.8, 0.6],
        [0.9, 0.7, 0.3],
    ];
    for (moving_body, position) in positions.into_iter().enumerate() {
        let expected = position.into_iter().chain([1.0, 0.0, 0.0, 0.0]);
        for (q, expected) in start.q[7 * moving_body..7 * moving_body + 7].iter().zip(expected) {
            assert!(
                (q - expected).abs() <= 1e-14,
                "body {moving_body}: {:?}",
                &start.q[7 * moving_body..7 * moving_body + 7]
            );
        }
    }
}

#[test]
fn shipped_pages_write_exactly_what_they_mean() {
    for (path, text) in [crate::support::pages("models"), crate::support::pages("tests/models")].concat() {
        let mut table = |_: &str| Ok("t,angle\n0,0\n1,0.5\n2,1\n".to_owned());
        if let Ok(model) = gyro_model::read_with("page.toml", &text, &mut table) {
            assert!(model.remarks.is_empty(), "{path:?}: {:?}", model.remarks);
        }
    }
}

/// A model file on which everything is nearly a right angle.
const ROUGH: &str = r#"
format = 1
name = "rough"
[[body]]
name = "base"
driven = { rotations = [
    { axis = [0, 1, 0], angle = 1.5708 },
    { axis = [0, 0, 1], angle = { sinusoid = { amplitude = 0.1, frequency_hz = 1, phase = 1.571 } } },
] }
orientation = [0.7071068, 0.7071067, 0, 0]
[[body]]
name = "plate"
mass = 0.1
inertia = [1e-4, 1e-4, 2e-4]
[[joint]]
name = "pin"
kind = "revolute"
axis = [1, 0, 1e-76]
zero = [0, 1, 3e-6]
angle = 1.5708
first = { body = "base" }
second = { body = "plate", point = [0, 0.1, 0] }
"#;

#[test]
fn what_is_nearly_exact_is_remarked_upon_and_costs_nothing() {
    let rough = read("rough.toml", ROUGH).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let offered = [
        "`axis = [1, 0, 0]`",
        "`zero = [0, 1, 0]`",
        "`angle_deg = 90`",
        "`orientation = [1, 1, 0, 0]`",
        "no decimal is exact",
        "`phase_deg = 90`",
    ];
    for words in offered {
        assert!(rough.remarks.iter().any(|remark| remark.contains(words)), "{words}: {:?}", rough.remarks);
    }
    let exact = read("exact.toml", &ROUGH.replace("1e-76", "0")).unwrap_or_else(|m| panic!("{m}"));
    assert_eq!(rough.joints[0].first.axis, exact.joints[0].first.axis, "32 digits of a direction count");
}
