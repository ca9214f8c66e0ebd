//! Loops closed by every kind of joint on random frames: the pose is planted, the guess is rough.

use std::fmt::Write as _;

use chacha20::ChaCha8Rng;
use gyro_model::{Kinematics, Model, Number, Quaternion, Rational, Start, Vector, read};
use rand::{RngExt, SeedableRng};

/// Kinds that carry the bodies of the chain, with their keys for coordinates.
const CARRIERS: [(&str, &[&str]); 7] = [
    ("revolute", &["angle"]),
    ("universal", &["first_angle", "second_angle"]),
    ("cylindrical", &["angle", "displacement"]),
    ("prismatic", &["displacement"]),
    ("planar", &["x", "y", "angle"]),
    ("screw", &["angle"]),
    ("spherical", &["orientation"]),
];

const CLOSERS: [&str; 10] = [
    "revolute",
    "spherical",
    "fixed",
    "universal",
    "cylindrical",
    "prismatic",
    "planar",
    "screw",
    "point_on_line",
    "rod",
];

/// Chains for each kind of closing joint.
const CHAINS: u64 = 25;

/// How far the guess is from the planted pose, rad or m.
const ROUGH: f64 = 0.1;

/// Rounding of some dozens of operations on numbers of order one.
const TOLERANCE: f64 = 1e-13;

fn vector(rng: &mut ChaCha8Rng) -> [f64; 3] {
    std::array::from_fn(|_| (rng.random_range(-1.0..1.0_f64) * 1000.0).round() / 1000.0)
}

/// A chain of bodies from the ground with coordinates shifted by so much from the planted ones, the closing joint last.
fn page(seed: u64, shift: f64, closing: &str) -> String {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut noise = ChaCha8Rng::seed_from_u64(seed + 1000);
    let mut page = "format = 1\nname = \"chain\"\n[[body]]\nname = \"b0\"\nfixed = true\n".to_owned();
    let mut joints = String::new();
    for body in 1..=4 {
        let _ = writeln!(page, "[[body]]\nname = \"b{body}\"\nmass = 1\ninertia = [1, 1, 1]");
        let (kind, keys) = CARRIERS[rng.random_range(0..CARRIERS.len())];
        let _ = writeln!(joints, "[[joint]]\nname = \"j{body}\"\nkind = \"{kind}\"");
        for (key, body) in [("first", body - 1), ("second", body)] {
            let frame = match kind {
                "spherical" => String::new(),
                _ => format!(", axis = {:?}, zero = {:?}", vector(&mut rng), vector(&mut rng)),
            };
            let point = vector(&mut rng);
            let _ = writeln!(joints, "{key} = {{ body = \"b{body}\", point = {point:?}{frame} }}");
        }
        for key in keys {
            let mut shifted = || rng.random_range(-1.0..1.0) + shift * noise.random_range(-1.0..1.0);
            let _ = match *key {
                "orientation" => {
                    writeln!(joints, "orientation = {:?}", [2.0, shifted(), shifted(), shifted()])
                }
                _ => writeln!(joints, "{key} = {:?}", shifted()),
            };
        }
        let lead = if kind == "screw" { "lead = 0.05\n" } else { "" };
        let _ = writeln!(joints, "{lead}rough = true");
    }
    page + &joints + closing
}

fn model(page: &str) -> Model {
    read("chain", page).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// A joint of a kind between the ground and the last body where the chain has it.
fn closing(kind: &str, start: &Start, rng: &mut ChaCha8Rng) -> String {
    let q = &start.q[start.q.len() - 7..];
    let (r, p) = (Vector::from([q[0], q[1], q[2]]), Quaternion([q[3], q[4], q[5], q[6]]));
    let (point, axis) = (Vector::from(vector(rng)), Vector::from(vector(rng)).normalize());
    let g = axis.cross(&Vector::from(vector(rng))).normalize();
    let f = g.cross(&axis);
    // Coordinates of the planted joint, as far as its kind has them.
    let angle: f64 = rng.random_range(-1.0..1.0);
    let [x, y, z] = [0.3, -0.2, 0.1];
    let lead = 0.05;
    let (turn, d) = match kind {
        "revolute" | "universal" => (angle, Vector::zeros()),
        "cylindrical" => (angle, axis * z),
        "prismatic" => (0.0, axis * z),
        "planar" => (angle, f * x + g * y),
        "screw" => (angle, axis * (lead * angle)),
        "point_on_line" => (0.0, axis * z),
        "rod" => (0.0, f * x + g * y + axis * z),
        _ => (0.0, Vector::zeros()),
    };
    let (sin, cos) = turn.sin_cos();
    // A universal joint's second axis is across the first's.
    let (far_axis, far_zero) = match kind {
        "universal" => (f * cos + g * sin, axis),
        _ => (axis, f * cos + g * sin),
    };
    let far = |v: Vector| <[f64; 3]>::from(p.rotate_back(v));
    let far_point = <[f64; 3]>::from(p.rotate_back(point + d - r));
    let mut text = format!("[[joint]]\nname = \"closing\"\nkind = \"{kind}\"\n");
    let frames = match kind {
        "spherical" | "rod" => [String::new(), String::new()],
        "point_on_line" => {
            [format!(", axis = {:?}, zero = {:?}", axis.as_slice(), f.as_slice()), String::new()]
        }
        _ => [
            format!(", axis = {:?}, zero = {:?}", axis.as_slice(), f.as_slice()),
            format!(", axis = {:?}, zero = {:?}", far(far_axis), far(far_zero)),
        ],
    };
    let [first, second] = frames;
    let _ = writeln!(text, "first = {{ body = \"b0\", point = {:?}{first} }}", point.as_slice());
    let _ = writeln!(text, "second = {{ body = \"b4\", point = {far_point:?}{second} }}");
    match kind {
        "screw" => text + &format!("lead = {lead}\n"),
        "rod" => text + &format!("length = {:?}\n", d.norm()),
        _ => text,
    }
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn every_kind_closes_a_loop_on_random_frames() {
    for kind in CLOSERS {
        for seed in 0..CHAINS {
            let planted = model(&page(seed, 0.0, "")).assemble().expect("an open chain");
            let mut rng = ChaCha8Rng::seed_from_u64(seed + 2000);
            let closing = closing(kind, &planted, &mut rng);
            let model = closed(&page(seed, ROUGH, &closing));
            match model.assemble() {
                Ok(start) => check(&model, &start, &format!("{kind}, seed {seed}")),
                Err(error) => panic!("{kind}, seed {seed}: {error}"),
            }
        }
    }
}

/// The model of a model file whose loop may be over-constrained, which reading refuses: the closing joint is read with
/// the first body of the chain free, and added.
fn closed(page: &str) -> Model {
    match read("chain", page) {
        Ok(model) => model,
        Err(_) => {
            let (chain, _) = page.rsplit_once("[[joint]]").expect("a closing joint");
            let (bodies, _) = page.split_once("[[joint]]").expect("joints");
            let (_, last) = page.rsplit_once("[[joint]]").expect("a closing joint");
            let mut chain = model(chain);
            let others = bodies.replace("mass = 1", "free = true\nmass = 1");
            let others = others.replacen("name = \"b4\"\nfree = true\n", "name = \"b4\"\n", 1);
            chain.joints.extend(model(&format!("{others}[[joint]]{last}")).joints);
            chain
        }
    }
}

fn check(model: &Model, start: &Start, title: &str) {
    let kinematics = Kinematics::at(model, 0.0);
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let phi = kinematics.phi(&start.q, &near).amax();
    assert!(phi <= TOLERANCE, "{title}: rows {phi:e}");
    let coordinates = kinematics.coordinates(&start.q, &near);
    for (joint, (found, told)) in coordinates.iter().zip(&near).enumerate() {
        for (a, b) in found.iter().zip(told) {
            assert!((a - b).abs() <= TOLERANCE, "{title}: joint {joint} at {a}, told {b}");
        }
    }
}

/// How far what is set is from where the mechanism closes by itself, rad or m.
const SET: f64 = 0.03;

/// The part of a rate that the assembly may miss of what is given.
const RATE_TOLERANCE: f64 = 1e-8;

/// Coordinates and rates of rough joints that are set from outside are those of the start, or there is none.
#[test]
fn what_is_set_is_where_the_mechanism_starts() {
    let mut kept = 0;
    for (kind, seed) in CLOSERS.iter().flat_map(|kind| (0..CHAINS / 3).map(move |seed| (kind, seed))) {
        let planted = model(&page(seed, 0.0, "")).assemble().expect("an open chain");
        let closing = closing(kind, &planted, &mut ChaCha8Rng::seed_from_u64(seed + 2000));
        let mut model = closed(&page(seed, ROUGH, &closing));
        let Ok(before) = model.assemble() else { continue };
        let mut rng = ChaCha8Rng::seed_from_u64(seed + 4000);
        let joint = rng.random_range(0..4);
        let n = model.joints[joint].kind.coordinates().len();
        if n == 0 {
            continue;
        }
        let k = rng.random_range(0..n);
        let [position, rate] = [
            before.joints[joint].position[k] + SET * rng.random_range(-1.0..1.0),
            rng.random_range(-1.0..1.0),
        ];
        let number = |x| Some(Number::Exact(Rational::from_float(x).expect("finite")));
        model.joints[joint].start.set.resize(n, [None, None]);
        model.joints[joint].start.set[k] = [number(position), number(rate)];
        let title = format!("{kind}, seed {seed}, joint {joint}");
        match model.assemble() {
            Ok(start) => {
                let found = (start.joints[joint].position[k], start.joints[joint].rate[k]);
                assert!(
                    (found.0 - position).abs() <= TOLERANCE,
                    "{title}: at {}, set to {position}",
                    found.0
                );
                assert!((found.1 - rate).abs() <= RATE_TOLERANCE, "{title}: rate {}, set to {rate}", found.1);
                check(&model, &start, &title);
                kept += 1;
            }
            // What cannot be kept is named.
            Err(error) => assert!(!error.to_string().is_empty(), "{title}"),
        }
    }
    assert!(kept >= MOST_CAN_BE_KEPT, "only {kept} starts could be kept");
}

/// Of 80 settings, less those of joints without coordinates and those that cannot be.
const MOST_CAN_BE_KEPT: usize = 20;
