//! The pages in `models/` are good, named after their files, and start as their sources say.

mod support;

use gyro_model::{JointStart, Model, Start, read};

fn model(stem: &str) -> Model {
    let path = support::folder("models").join(format!("{stem}.toml"));
    let text = std::fs::read_to_string(path).expect("a shipped page");
    read(stem, &text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn start(stem: &str) -> Start {
    model(stem).assemble().expect("a shipped page has a start")
}

fn rates(stem: &str) -> Vec<f64> {
    start(stem).joints.into_iter().flat_map(|joint| joint.rate).collect()
}

#[test]
fn every_page_is_named_after_its_file() {
    let pages = support::pages("models");
    assert!(pages.len() >= 10);
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
