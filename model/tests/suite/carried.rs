//! Planar loops on carriers that turn in space: which rows are redundant does not depend on how they have turned.

use chacha20::ChaCha8Rng;
use gyro_model::{JointKind, Kinematics, Model, PointAxes, Quaternion, RowOwner, Start, Vector, read};
use rand::{RngExt as _, SeedableRng as _};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Of each kind of carrier.
const LOOPS: u64 = 12;

/// Smallest singular value of the kept rows in parts of that at the start, where only the carrier has turned.
const KEPT: f64 = 0.05;

/// How the carrier of a loop is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carrier {
    Free,
    Hinged,
    OnBall,
    Driven,
    Fixed,
}

/// Orthonormal axes of the loop's plane in the carrier, and as a model file writes axis and zero direction.
struct Plane {
    axes: [Vector; 3],
    text: String,
}

fn plane(random: &mut ChaCha8Rng) -> Plane {
    loop {
        let [axis, zero] = [(); 2].map(|()| [(); 3].map(|()| f64::from(random.random_range(-4..=4_i32))));
        let (h, side) = (Vector::from(axis), Vector::from(axis).cross(&Vector::from(zero)));
        if side.norm() > 0.0 {
            let (h, g) = (h.normalize(), side.normalize());
            let text = format!("axis = {axis:?}, zero = {zero:?}");
            return Plane { axes: [g.cross(&h), g, h], text };
        }
    }
}

/// Corners of a polygon around its middle, in their order.
fn corners(random: &mut ChaCha8Rng) -> Vec<[f64; 2]> {
    let count = random.random_range(4..7);
    let corner = |k: usize| {
        let angle = TAU * (k as f64 + random.random_range(-0.3..0.3)) / count as f64;
        let radius = random.random_range(0.4..1.0);
        [radius * angle.cos(), radius * angle.sin()]
    };
    (0..count).map(corner).collect()
}

/// The carrier's section, and the joint that holds it where it has one, turned by `turn`.
fn carrier(kind: Carrier, turn: f64, random: &mut ChaCha8Rng) -> (String, String) {
    let body = "[[body]]\nname = \"carrier\"\n";
    let mass = "mass = 3\ninertia = [0.5, 0.6, 0.7]\n";
    let skew: [f64; 3] = [(); 3].map(|()| f64::from(random.random_range(1..5_i32)));
    let joint =
        "[[joint]]\nname = \"held\"\nfirst = { body = \"ground\" }\nsecond = { body = \"carrier\" }\n";
    match kind {
        Carrier::Free => {
            (format!("{body}free = true\n{mass}orientation = [1, {turn}, 0.3, -0.2]\n"), String::new())
        }
        Carrier::Fixed => {
            (format!("{body}fixed = true\norientation = [1, {turn}, 0.3, -0.2]\n"), String::new())
        }
        Carrier::Hinged => {
            let axes = format!("kind = \"revolute\"\naxis = {skew:?}\nzero = [1, -1, 7]\nangle = {turn}\n");
            (format!("{body}{mass}"), format!("{joint}{axes}"))
        }
        Carrier::OnBall => {
            let start = format!("kind = \"spherical\"\norientation = [1, {turn}, 0.3, -0.2]\n");
            (format!("{body}{mass}"), format!("{joint}{start}"))
        }
        Carrier::Driven => {
            let angle =
                format!("{{ sinusoid = {{ amplitude = 1, angular_frequency = 2, phase = {turn} }} }}");
            let turning = format!("[body.driven]\nrotations = [{{ axis = {skew:?}, angle = {angle} }}]\n");
            (format!("{body}{turning}"), String::new())
        }
    }
}

/// Bars along the sides of a polygon but one, which is the carrier's; the last joint closes the loop.
fn page(kind: Carrier, turn: f64, seed: u64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (held, joint) = carrier(kind, turn, &mut random);
    let (plane, corners) = (plane(&mut random), corners(&mut random));
    let base = Vector::from([(); 3].map(|()| random.random_range(-0.5..0.5)));
    let mut text =
        "format = 1\nname = \"carried\"\n[[body]]\nname = \"ground\"\nfixed = true\n".to_owned() + &held;
    let mut joints = joint;
    let side = |k: usize| {
        let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
        let (x, y) = (to[0] - from[0], to[1] - from[1]);
        (x.hypot(y), y.atan2(x))
    };
    let on_carrier = |[x, y]: [f64; 2]| {
        let [f, g, _] = plane.axes;
        <[f64; 3]>::from(base + f * x + g * y)
    };
    let n_bars = corners.len() - 1;
    // The bars lie beside each other.
    let heights: Vec<f64> = (0..n_bars).map(|_| random.random_range(-0.2..0.2)).collect();
    let end = |body: usize, point: [f64; 3], frame: &str| {
        format!("{{ body = \"bar{body}\", point = {point:?}, {frame} }}")
    };
    let flat = "axis = [0, 0, 1], zero = [1, 0, 0]";
    let mut before = 0.0;
    for bar in 0..n_bars {
        let (_, angle) = side(bar);
        let _ = writeln!(text, "[[body]]\nname = \"bar{bar}\"\nmass = 1\ninertia = [0.01, 0.02, 0.02]");
        let first = match bar.checked_sub(1) {
            None => format!("{{ body = \"carrier\", point = {:?}, {} }}", on_carrier(corners[0]), plane.text),
            Some(last) => end(last, [side(last).0, 0.0, heights[last]], flat),
        };
        let own = if bar == 0 { 0.0 } else { heights[bar - 1] };
        let _ = writeln!(
            joints,
            "[[joint]]\nname = \"j{bar}\"\nkind = \"revolute\"\nfirst = {first}\nsecond = {}\nangle = {}\nrough = true",
            end(bar, [0.0, 0.0, own], flat),
            angle - before
        );
        before = angle;
    }
    let last = end(n_bars - 1, [side(n_bars - 1).0, 0.0, 0.0], "");
    let is_ball = random.random_range(0..3) == 0;
    let frames = if is_ball { ["", ""] } else { [plane.text.as_str(), flat] };
    let kind = if is_ball { "spherical" } else { "revolute" };
    let last = last.replace(", ,", ",").replace(",  }", &format!(", {} }}", frames[1])).replace(",  }", " }");
    let first = format!("{{ body = \"carrier\", point = {:?}, {} }}", on_carrier(corners[n_bars]), frames[0]);
    let _ = writeln!(
        joints,
        "[[joint]]\nname = \"closing\"\nkind = \"{kind}\"\nfirst = {}\nsecond = {last}",
        first.replace(",  }", " }")
    );
    text + &joints
}

fn model(page: &str) -> Model {
    read("carried", page).unwrap_or_else(|mistakes| panic!("{mistakes}\n{page}"))
}

/// The smallest singular value of the rows that `rows` keeps, at a pose of another model of the same mechanism.
fn smallest(rows: &Model, at: &Model, q: &[f64], start: &Start) -> f64 {
    let kinematics = Kinematics::at(&Model { redundant: rows.redundant.clone(), ..at.clone() }, 0.0);
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let kept = rows.rows();
    let indices: Vec<usize> =
        (0..kinematics.rows().len()).filter(|&k| kept.contains(&kinematics.rows()[k])).collect();
    kinematics.jacobian(q, &near).select_rows(&indices).singular_values().min()
}

/// All bodies turned about the origin.
fn turned(q: &[f64], by: Quaternion) -> Vec<f64> {
    let of = |pose: &[f64]| {
        let r = by.rotate(Vector::from([pose[0], pose[1], pose[2]]));
        let p = by * Quaternion([pose[3], pose[4], pose[5], pose[6]]);
        [r.as_slice(), &p.0].concat()
    };
    q.chunks_exact(7).flat_map(of).collect()
}

/// Along which axes the joint that loses rows compares its points; global ones if it loses none of these.
fn axes(model: &Model) -> PointAxes {
    let RowOwner::Joint(joint) = model.redundant.first().expect("a planar loop").row.owner else {
        panic!("{:?}", model.redundant)
    };
    assert!(model.redundant.iter().all(|dropped| dropped.row.owner == RowOwner::Joint(joint)));
    let loses_points = model.redundant.iter().any(|dropped| dropped.row.index < 3);
    assert!(loses_points || model.point_axes(joint) == PointAxes::Global);
    model.point_axes(joint)
}

/// Whether a joint of the loop is a ball: then rows of directions may be redundant instead of points.
fn has_ball(model: &Model) -> bool {
    model.joints.iter().any(|joint| joint.name == "closing" && joint.kind == JointKind::Spherical)
}

#[test]
fn a_loop_on_a_free_body_keeps_its_rank_wherever_it_turns() {
    for seed in 0..LOOPS {
        let model = model(&page(Carrier::Free, 0.4, seed));
        assert!(axes(&model) == PointAxes::FirstBody || has_ball(&model), "seed {seed}");
        let start = model.assemble().expect("it was assembled when it was read");
        let before = smallest(&model, &model, &start.q, &start);
        for by in [[1.0, 1.0, 0.0, 0.0], [1.0, 0.0, 1.0, 0.0], [0.5, 0.1, -0.7, 0.5], [0.0, 0.6, 0.0, 0.8]] {
            let by = Quaternion(by).normalised();
            let after = smallest(&model, &model, &turned(&start.q, by), &start);
            assert!((after - before).abs() < 1e-9 * before, "seed {seed}: {after} and {before}");
        }
    }
}

#[test]
fn a_loop_on_any_body_that_turns_keeps_its_rank() {
    for kind in [Carrier::Hinged, Carrier::OnBall, Carrier::Driven] {
        for seed in 0..LOOPS {
            let first = model(&page(kind, 0.2, seed));
            assert!(axes(&first) == PointAxes::FirstBody || has_ball(&first), "{kind:?}, seed {seed}");
            let start = first.assemble().expect("it was assembled when it was read");
            let before = smallest(&first, &first, &start.q, &start);
            for turn in [-1.5, 1.1, 2.3] {
                let other = model(&page(kind, turn, seed));
                let start = other.assemble().expect("it was assembled when it was read");
                let after = smallest(&first, &other, &start.q, &start);
                assert!(after > KEPT * before, "{kind:?}, seed {seed}, {turn}: {after} and {before}");
            }
        }
    }
}

/// What need not follow a body costs nothing.
#[test]
fn a_loop_on_a_body_that_does_not_turn_keeps_global_rows() {
    for seed in 0..LOOPS {
        assert_eq!(axes(&model(&page(Carrier::Fixed, 0.4, seed))), PointAxes::Global, "seed {seed}");
    }
    // About the normal of the loop the carrier may turn.
    let flat = page(Carrier::Hinged, 0.4, 3);
    let (_, axis) = flat.split_once("first = { body = \"carrier\"").expect("the first bar");
    let (_, axis) = axis.split_once("axis = ").expect("an axis");
    let (axis, _) = axis.split_once(", zero").expect("a zero direction");
    let (before, held) = flat.split_once("kind = \"revolute\"\naxis = ").expect("the hinge");
    let (_, after) = held.split_once('\n').expect("a line");
    assert_eq!(
        axes(&model(&format!("{before}kind = \"revolute\"\naxis = {axis}\n{after}"))),
        PointAxes::Global
    );
}
