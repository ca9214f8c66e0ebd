//! The assembled start satisfies every constraint row and its derivative, typed here by hand.

mod support;

use std::fmt::Write as _;

use gyro_model::{JointEnd, JointKind, Model, Start, Support, read};
use proptest::prelude::*;

type V3 = [f64; 3];

/// Rounding of some dozens of operations on numbers of order one.
const TOLERANCE: f64 = 1e-14;

fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: V3) -> V3 {
    a.map(|x| x / dot(a, a).sqrt())
}

/// Position, Euler parameters, velocity and w' of one body.
#[derive(Clone, Copy)]
struct State {
    r: V3,
    p: [f64; 4],
    s: V3,
    w: V3,
}

impl State {
    /// A(p) v, paper eq. (3).
    fn to_global(self, v: V3) -> V3 {
        let [e0, e1, e2, e3] = self.p;
        [
            2.0 * ((e0 * e0 + e1 * e1 - 0.5) * v[0]
                + (e1 * e2 - e0 * e3) * v[1]
                + (e1 * e3 + e0 * e2) * v[2]),
            2.0 * ((e1 * e2 + e0 * e3) * v[0]
                + (e0 * e0 + e2 * e2 - 0.5) * v[1]
                + (e2 * e3 - e0 * e1) * v[2]),
            2.0 * ((e1 * e3 - e0 * e2) * v[0]
                + (e2 * e3 + e0 * e1) * v[1]
                + (e0 * e0 + e3 * e3 - 0.5) * v[2]),
        ]
    }

    /// A body-fixed direction in the global frame, and its derivative.
    fn direction(self, v: V3) -> [V3; 2] {
        [self.to_global(v), self.to_global(cross(self.w, v))]
    }
}

/// The state of every body, folded ones included.
fn states(model: &Model, start: &Start) -> Vec<State> {
    let slots = model.coordinate_bodies();
    let of = |body: usize| match slots.iter().position(|&b| b == body) {
        Some(slot) => {
            let (q, v) = (&start.q[7 * slot..7 * slot + 7], &start.v[6 * slot..6 * slot + 6]);
            State {
                r: [q[0], q[1], q[2]],
                p: [q[3], q[4], q[5], q[6]],
                s: [v[0], v[1], v[2]],
                w: [v[3], v[4], v[5]],
            }
        }
        None => placed(model, body),
    };
    (0..model.bodies.len()).map(of).collect()
}

/// A fixed body where the page puts it.
fn placed(model: &Model, body: usize) -> State {
    let p = model.values(&model.bodies[body].orientation);
    let norm = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    State { r: model.values(&model.bodies[body].position), p: p.map(|x| x / norm), s: [0.0; 3], w: [0.0; 3] }
}

/// The unit joint frame (f, g, h) of an end.
fn frame(model: &Model, end: &JointEnd) -> [V3; 3] {
    let h = unit(model.values(&end.axis));
    let g = unit(cross(h, unit(model.values(&end.zero))));
    [cross(g, h), g, h]
}

/// All rows at position level and their derivatives.
fn residuals(model: &Model, start: &Start) -> [Vec<f64>; 2] {
    let states = states(model, start);
    let (mut phi, mut rate) = (Vec::new(), Vec::new());
    for (index, body) in model.bodies.iter().enumerate() {
        if body.support == Support::Constrained {
            let (fixed, state) = (placed(model, index), states[index]);
            let ([a, b, c, d], [w, x, y, z]) = (fixed.p, state.p);
            phi.extend((0..3).map(|k| state.r[k] - fixed.r[k]));
            phi.extend([
                a * x - b * w - c * z + d * y,
                a * y + b * z - c * w - d * x,
                a * z - b * y + c * x - d * w,
            ]);
            rate.extend(state.s.into_iter().chain(state.w));
        }
    }
    for joint in &model.joints {
        let (i, j) = (states[joint.first.body], states[joint.second.body]);
        let (si, sj) = (model.values(&joint.first.point), model.values(&joint.second.point));
        let ([ai, dai], [aj, daj]) = (i.direction(si), j.direction(sj));
        phi.extend((0..3).map(|k| j.r[k] + aj[k] - i.r[k] - ai[k]));
        rate.extend((0..3).map(|k| j.s[k] + daj[k] - i.s[k] - dai[k]));
        let ([fi, gi, _], [_, gj, hj]) = (frame(model, &joint.first), frame(model, &joint.second));
        let pairs = match joint.kind {
            JointKind::Spherical => vec![],
            JointKind::Revolute => vec![(fi, hj), (gi, hj)],
            JointKind::Fixed => vec![(fi, hj), (gi, hj), (fi, gj)],
        };
        for (a, b) in pairs {
            let ([a, da], [b, db]) = (i.direction(a), j.direction(b));
            phi.push(dot(a, b));
            rate.push(dot(da, b) + dot(a, db));
        }
    }
    [phi, rate]
}

fn worst(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |worst, x| if x.abs() > worst || x.is_nan() { x.abs() } else { worst })
}

/// Rows, unit lengths and joint coordinates of a start.
fn check(model: &Model, start: &Start, tolerance: f64) {
    let [phi, rate] = residuals(model, start);
    assert_eq!(phi.len(), model.rows().len());
    assert!(worst(&phi) <= tolerance, "rows {phi:?}");
    assert!(worst(&rate) <= tolerance, "velocity rows {rate:?}");
    let states = states(model, start);
    for state in &states {
        assert!((state.p.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() <= 1e-15);
    }
    for (joint, own) in model.joints.iter().zip(&start.joints) {
        let (i, j) = (states[joint.first.body], states[joint.second.body]);
        let ([fi, gi, _], [fj, _, hj]) = (frame(model, &joint.first), frame(model, &joint.second));
        let ([f, _], [g, _], [zero, _], [axis, _]) =
            (i.direction(fi), i.direction(gi), j.direction(fj), j.direction(hj));
        let relative: V3 = std::array::from_fn(|k| j.to_global(j.w)[k] - i.to_global(i.w)[k]);
        match joint.kind {
            JointKind::Revolute => {
                let excess = dot(zero, g).atan2(dot(zero, f)) - own.position[0];
                assert!((0.5 * excess).sin().abs() <= tolerance, "angle off by {excess}");
                assert!((dot(relative, axis) - own.rate[0]).abs() <= tolerance, "rate");
            }
            JointKind::Spherical => {
                let rate = j.to_global([own.rate[0], own.rate[1], own.rate[2]]);
                assert!((0..3).all(|k| (relative[k] - rate[k]).abs() <= tolerance), "rate");
                let dot: f64 = i.p.iter().zip(j.p).map(|(a, b)| a * b).sum();
                assert!((dot - own.position[0]).abs() <= tolerance, "Euler parameters");
            }
            JointKind::Fixed => assert!(own.position.is_empty() && own.rate.is_empty()),
        }
    }
}

#[test]
fn shipped_models_start_on_the_constraints() {
    for (path, text) in support::pages("models") {
        let model = read(&path.display().to_string(), &text).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        // The turning rates reach 200 rad/s, and are aligned with the axes.
        check(&model, &model.assemble().expect("a start"), TOLERANCE);
    }
}

/// One random body with the joint that holds it.
#[derive(Clone, Debug)]
struct Branch {
    parent: usize,
    kind: usize,
    reversed: bool,
    ends: [[[i32; 3]; 3]; 2],
    orientation: [i32; 4],
    angle: i32,
    rate: [i32; 3],
}

fn direction() -> impl Strategy<Value = [i32; 3]> {
    prop_oneof![
        4 => prop::array::uniform3(-99..100_i32).prop_filter("a direction", |v| *v != [0; 3]),
        1 => prop::sample::select(vec![[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
    ]
}

fn end() -> impl Strategy<Value = [[i32; 3]; 3]> {
    (prop::array::uniform3(-99..100_i32), direction(), direction()).prop_map(|(point, axis, zero)| {
        let exact = |v: [i32; 3]| v.map(f64::from);
        let parallel = cross(exact(axis), exact(zero)) == [0.0; 3];
        let off = (0..3).min_by_key(|&k: &usize| axis[k].abs()).unwrap_or(0);
        [point, axis, if parallel { std::array::from_fn(|k| i32::from(k == off)) } else { zero }]
    })
}

fn branch() -> impl Strategy<Value = Branch> {
    let orientation = prop::array::uniform4(-9..10_i32).prop_filter("a rotation", |p| *p != [0; 4]);
    let rate = prop::array::uniform3(-200..200_i32);
    let whole = (
        any::<prop::sample::Index>(),
        0..5_usize,
        any::<bool>(),
        [end(), end()],
        orientation,
        -2000..2000,
        rate,
    );
    whole.prop_map(|(parent, kind, reversed, ends, orientation, angle, rate)| {
        let parent = parent.index(1000);
        Branch { parent, kind, reversed, ends, orientation, angle, rate }
    })
}

/// A page of a random tree. Body `k` hangs on an earlier one; the last `wanted` replaces its joint's rate.
fn page(root: &str, branches: &[Branch], wanted: Option<[f64; 3]>) -> String {
    let mut page = format!("format = 1\nname = \"tree\"\n[[body]]\nname = \"b0\"\n{root}\n");
    for (index, branch) in branches.iter().enumerate() {
        let (body, last) = (index + 1, index + 1 == branches.len());
        let parent = branch.parent % body;
        let _ = writeln!(page, "[[body]]\nname = \"b{body}\"\nmass = 1.5\ninertia = [3, 4, 5]");
        if let (true, Some(wanted)) = (last, wanted) {
            let _ = writeln!(page, "angular_velocity = {wanted:?}");
        }
        let (first, second) = if branch.reversed { (body, parent) } else { (parent, body) };
        let kind = ["revolute", "revolute", "revolute", "spherical", "fixed"][branch.kind];
        let _ = writeln!(page, "[[joint]]\nname = \"j{body}\"\nkind = \"{kind}\"");
        for (key, body, [point, axis, zero]) in
            [("first", first, branch.ends[0]), ("second", second, branch.ends[1])]
        {
            let point = point.map(|x| f64::from(x) / 100.0);
            let frame = if kind == "spherical" {
                String::new()
            } else {
                format!(", axis = {axis:?}, zero = {zero:?}")
            };
            let _ = writeln!(page, "{key} = {{ body = \"b{body}\", point = {point:?}{frame} }}");
        }
        let rate = branch.rate.map(|x| f64::from(x) / 100.0);
        let rate_line = match kind {
            "revolute" => format!("rate = {:?}\n", rate[0]),
            _ => format!("rate = {rate:?}\n"),
        };
        let rate_line = if kind == "fixed" || (last && wanted.is_some()) { String::new() } else { rate_line };
        let start = match kind {
            "revolute" => format!("angle = {:?}\n", f64::from(branch.angle) / 100.0),
            "spherical" => format!("orientation = {:?}\n", branch.orientation),
            _ => String::new(),
        };
        page += &(start + &rate_line);
    }
    page
}

const ROOTS: [&str; 3] = [
    "fixed = true\nposition = [0.3, -0.2, 0.1]\norientation = [1, 2, -3, 4]",
    "fixed = \"constrained\"\nmass = 2\ninertia = [1, 1, 1]\nposition = [0.3, -0.2, 0.1]\norientation = [-1, 2, -3, 4]",
    "free = true\nmass = 2\ninertia = [1, 1, 1]\nvelocity = [1, 2, 3]\norientation = [0, -1, 2, 1]\nangular_velocity = [-1, 0.5, 2]",
];

/// Rates and lengths add up along a branch of at most seven bodies.
const TREE_TOLERANCE: f64 = 10.0 * TOLERANCE;

proptest! {
    #[test]
    fn random_trees_start_on_the_constraints(root in 0..3_usize, branches in prop::collection::vec(branch(), 1..8)) {
        let page = page(ROOTS[root], &branches, None);
        let model = read("tree.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        check(&model, &model.assemble().expect("a start"), TREE_TOLERANCE);
    }

    #[test]
    fn an_angular_velocity_gives_back_its_rate(root in 0..3_usize, branches in prop::collection::vec(branch(), 1..8)) {
        let model = read("tree.toml", &page(ROOTS[root], &branches, None)).unwrap_or_else(|e| panic!("{e}"));
        let planted = model.assemble().expect("a start");
        let w: [f64; 3] = std::array::from_fn(|k| planted.v[planted.v.len() - 3 + k]);
        let asked = read("tree.toml", &page(ROOTS[root], &branches, Some(w))).unwrap_or_else(|e| panic!("{e}"));
        let start = asked.assemble().expect("the planted rate");
        check(&asked, &start, TREE_TOLERANCE);
        let (planted, found) = (planted.joints.last().expect("joints"), start.joints.last().expect("joints"));
        for (a, b) in planted.rate.iter().zip(&found.rate) {
            prop_assert!((a - b).abs() <= TREE_TOLERANCE, "{} {}", a, b);
        }
    }
}
