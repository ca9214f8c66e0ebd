//! The assembled start satisfies every constraint row and its derivative, typed here by hand.

use std::fmt::Write as _;

use gyro_model::{
    CoordinateKind, Joint, JointEnd, JointKind, JointStart, Kinematics, Model, RowOwner, Start, Support, read,
};
use nalgebra::DVector;
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
        for [value, derivative] in joint_rows(model, joint, &states) {
            phi.push(value);
            rate.push(derivative);
        }
    }
    [phi, rate]
}

/// A scalar product and its derivative.
fn product([a, da]: [V3; 2], [b, db]: [V3; 2]) -> [f64; 2] {
    [dot(a, b), dot(da, b) + dot(a, db)]
}

/// A joint's two frames and the vector between its points, each with its derivative.
fn posed(model: &Model, joint: &Joint, states: &[State]) -> ([[V3; 2]; 3], [[V3; 2]; 3], [V3; 2]) {
    let (i, j) = (states[joint.first.body], states[joint.second.body]);
    let [first, second] = [(&joint.first, i), (&joint.second, j)]
        .map(|(end, state)| frame(model, end).map(|v| state.direction(v)));
    let ([ai, dai], [aj, daj]) =
        (i.direction(model.values(&joint.first.point)), j.direction(model.values(&joint.second.point)));
    let d = std::array::from_fn(|k| j.r[k] + aj[k] - i.r[k] - ai[k]);
    let rate = std::array::from_fn(|k| j.s[k] + daj[k] - i.s[k] - dai[k]);
    (first, second, [d, rate])
}

/// Rows and their derivatives, from their definition in the format's description.
fn joint_rows(model: &Model, joint: &Joint, states: &[State]) -> Vec<[f64; 2]> {
    let ([fi, gi, hi], [fj, gj, hj], d) = posed(model, joint, states);
    let point: Vec<[f64; 2]> = (0..3).map(|k| [d[0][k], d[1][k]]).collect();
    let parallel = vec![product(fi, hj), product(gi, hj)];
    let on_axis = vec![product(fi, d), product(gi, d)];
    match joint.kind {
        JointKind::Revolute => [point, parallel].concat(),
        JointKind::Spherical => point,
        JointKind::Fixed => [point, parallel, vec![product(fi, gj)]].concat(),
        JointKind::Universal => [point, vec![product(hi, hj)]].concat(),
        JointKind::Cylindrical => [on_axis, parallel].concat(),
        JointKind::Prismatic => [on_axis, parallel, vec![product(fi, gj)]].concat(),
        JointKind::Planar => [vec![product(hi, d)], parallel].concat(),
        JointKind::Screw => {
            let lead = model.value(&joint.lead);
            let ([sine, ds], [cosine, dc]) = (product(gi, fj), product(fi, fj));
            let [advance, rate] = product(hi, d);
            // Known up to a multiple of the pitch.
            let turns = (advance / lead - sine.atan2(cosine)) / std::f64::consts::TAU;
            let left = lead * (turns - turns.round()) * std::f64::consts::TAU;
            let turning = (cosine * ds - sine * dc) / (sine * sine + cosine * cosine);
            [on_axis, vec![[left, rate - lead * turning]], parallel].concat()
        }
        JointKind::PointOnLine => on_axis,
        JointKind::Rod => {
            let length = model.value(&joint.length);
            let [square, rate] = product(d, d);
            vec![[0.5 * (square / length - length), 0.5 * rate / length]]
        }
    }
}

fn worst(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |worst, x| if x.abs() > worst || x.is_nan() { x.abs() } else { worst })
}

/// Rows, unit lengths and joint coordinates of a start.
fn check(model: &Model, start: &Start, tolerance: f64) {
    let [phi, rate] = residuals(model, start);
    assert_eq!(phi.len(), model.all_rows().len());
    assert!(worst(&phi) <= tolerance, "rows {phi:?}");
    assert!(worst(&rate) <= tolerance, "velocity rows {rate:?}");
    let states = states(model, start);
    for state in &states {
        assert!((state.p.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() <= 1e-15);
    }
    for (joint, own) in model.joints.iter().zip(&start.joints) {
        check_coordinates(model, joint, own, &states, tolerance);
    }
}

/// A joint's coordinates and their rates, from their definition.
fn check_coordinates(model: &Model, joint: &Joint, own: &JointStart, states: &[State], tolerance: f64) {
    let ([fi, gi, hi], [fj, gj, hj], d) = posed(model, joint, states);
    let (i, j) = (states[joint.first.body], states[joint.second.body]);
    let relative: V3 = std::array::from_fn(|k| j.to_global(j.w)[k] - i.to_global(i.w)[k]);
    if joint.kind == JointKind::Spherical {
        let rate = j.to_global([own.rate[0], own.rate[1], own.rate[2]]);
        assert!((0..3).all(|k| (relative[k] - rate[k]).abs() <= tolerance), "rate");
        let dot: f64 = i.p.iter().zip(j.p).map(|(a, b)| a * b).sum();
        assert!((dot - own.position[0]).abs() <= tolerance, "Euler parameters");
        return;
    }
    let kinds = joint.kind.coordinates();
    assert_eq!([own.position.len(), own.rate.len()], [kinds.len(); 2], "{:?}", joint.kind);
    for (kind, (&position, &rate)) in kinds.iter().zip(own.position.iter().zip(&own.rate)) {
        let angle =
            |sine: f64, cosine: f64, turning: f64| [(0.5 * (sine.atan2(cosine) - position)).sin(), turning];
        let [excess, turning] = match kind {
            CoordinateKind::Angle => angle(dot(gi[0], fj[0]), dot(fi[0], fj[0]), dot(relative, hj[0])),
            CoordinateKind::FirstAngle => angle(dot(gi[0], hj[0]), dot(fi[0], hj[0]), dot(relative, hi[0])),
            CoordinateKind::SecondAngle => angle(-dot(hi[0], gj[0]), dot(hi[0], fj[0]), dot(relative, hj[0])),
            CoordinateKind::Displacement => [product(hi, d)[0] - position, product(hi, d)[1]],
            CoordinateKind::X => [product(fi, d)[0] - position, product(fi, d)[1]],
            CoordinateKind::Y => [product(gi, d)[0] - position, product(gi, d)[1]],
        };
        assert!(excess.abs() <= tolerance, "{kind:?} off by {excess}");
        let rounding = tolerance * rate.abs().max(1.0);
        assert!((turning - rate).abs() <= rounding, "rate of {kind:?}: {turning} {rate}");
    }
}

#[test]
fn shipped_models_start_on_the_constraints() {
    for (path, text) in crate::support::pages("models") {
        let model = read(&path.display().to_string(), &text).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        // The turning rates reach 200 rad/s, and are aligned with the axes.
        if model.is_driven() || !model.couplers.is_empty() {
            continue; // Rows that depend on time or on several joints have tests of their own.
        }
        check(&model, &model.assemble().expect("a start"), TOLERANCE);
    }
}

const KINDS: [&str; 11] = [
    "revolute",
    "revolute",
    "revolute",
    "spherical",
    "fixed",
    "universal",
    "cylindrical",
    "prismatic",
    "planar",
    "screw",
    "point_on_line",
];

/// One random body with the joint that holds it.
#[derive(Clone, Debug)]
struct Branch {
    parent: usize,
    kind: usize,
    reversed: bool,
    ends: [[[i32; 3]; 3]; 2],
    orientation: [i32; 4],
    position: [i32; 3],
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
        0..KINDS.len(),
        any::<bool>(),
        [end(), end()],
        orientation,
        prop::array::uniform3(-2000..2000_i32),
        rate,
    );
    whole.prop_map(|(parent, kind, reversed, ends, orientation, position, rate)| {
        let parent = parent.index(1000);
        Branch { parent, kind, reversed, ends, orientation, position, rate }
    })
}

/// Coordinates of a joint on its page, the angles of up to three turns, and its rates.
fn start_of(branch: &Branch, kind: &str, without_rate: bool) -> String {
    let keys: &[&str] = match kind {
        "revolute" => &["angle"],
        "screw" => &["angle"],
        "universal" => &["first_angle", "second_angle"],
        "cylindrical" => &["angle", "displacement"],
        "prismatic" | "point_on_line" => &["displacement"],
        "planar" => &["x", "y", "angle"],
        "spherical" => &["orientation"],
        _ => &[],
    };
    let mut start = if kind == "screw" { "lead = 0.03\n".to_owned() } else { String::new() };
    for (key, position) in keys.iter().zip(branch.position) {
        let _ = match *key {
            "orientation" => writeln!(start, "orientation = {:?}", branch.orientation),
            _ if key.ends_with("angle") => writeln!(start, "{key} = {:?}", f64::from(position) / 100.0),
            _ => writeln!(start, "{key} = {:?}", f64::from(position) / 1000.0),
        };
    }
    let rates = branch.rate.map(|x| f64::from(x) / 100.0);
    let _ = match keys.len() {
        _ if without_rate => Ok(()),
        0 => Ok(()),
        1 if kind == "spherical" => writeln!(start, "rate = {rates:?}"),
        1 => writeln!(start, "rate = {:?}", rates[0]),
        n => writeln!(start, "rate = {:?}", &rates[..n]),
    };
    start
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
        let kind = KINDS[branch.kind];
        let _ = writeln!(page, "[[joint]]\nname = \"j{body}\"\nkind = \"{kind}\"");
        for (key, body, [point, axis, zero]) in
            [("first", first, branch.ends[0]), ("second", second, branch.ends[1])]
        {
            let point = point.map(|x| f64::from(x) / 100.0);
            let frame = match (kind, key) {
                ("spherical", _) | ("point_on_line", "second") => String::new(),
                _ => format!(", axis = {axis:?}, zero = {zero:?}"),
            };
            let _ = writeln!(page, "{key} = {{ body = \"b{body}\", point = {point:?}{frame} }}");
        }
        page += &start_of(branch, kind, last && wanted.is_some());
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
    fn rows_are_the_same_off_the_constraints(
        branches in prop::collection::vec(branch(), 1..8),
        shifts in prop::collection::vec(-1.0..1.0_f64, 49),
    ) {
        let page = page(ROOTS[1], &branches, None);
        let model = read("tree.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
        let mut start = model.assemble().expect("a start");
        for (pose, shifts) in start.q.chunks_exact_mut(7).zip(shifts.chunks_exact(7)) {
            pose.iter_mut().zip(shifts).for_each(|(x, shift)| *x += 0.3 * shift);
            let norm = pose[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
            pose[3..].iter_mut().for_each(|e| *e /= norm);
        }
        let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
        let [expected, _] = residuals(&model, &start);
        let phi = Kinematics::at(&model, 0.0).phi(&start.q, &near);
        let screws: Vec<usize> = (0..phi.len()).filter(|&row| {
            let gyro_model::Row { owner, index, .. } = model.rows()[row];
            matches!(owner, RowOwner::Joint(j) if model.joints[j].kind == JointKind::Screw && index == 2)
        }).collect();
        for (row, (found, expected)) in phi.iter().zip(&expected).enumerate() {
            // The hand-typed row of a screw does not know its turn.
            let turn = 0.03 * std::f64::consts::TAU;
            let turns = if screws.contains(&row) { ((found - expected) / turn).round() } else { 0.0 };
            prop_assert!((found - expected - turns * turn).abs() <= TREE_TOLERANCE, "row {}", row);
        }
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
        let kind = asked.joints.last().expect("joints").kind;
        for (k, (a, b)) in planted.rate.iter().zip(&found.rate).enumerate() {
            // An angular velocity says nothing of displacements.
            if kind.coordinates().get(k).is_some_and(|coordinate| !coordinate.is_angle()) {
                continue;
            }
            prop_assert!((a - b).abs() <= TREE_TOLERANCE, "{} {}", a, b);
        }
    }
}

/// A slider-crank whose rod is a constraint, with numbers of ten digits: position and both rates.
const TYPED: &str = r#"
    format = 1
    name = "typed"
    [[body]]
    name = "ground"
    fixed = true
    [[body]]
    name = "crank"
    mass = 1
    inertia = [0.1, 0.1, 0.1]
    [[body]]
    name = "slider"
    mass = 1
    inertia = [0.1, 0.1, 0.1]
    [[joint]]
    name = "pivot"
    kind = "revolute"
    axis = [0, 0, 1]
    zero = [1, 0, 0]
    first = { body = "ground" }
    second = { body = "crank" }
    angle = 0.5
    rate = 100
    [[joint]]
    name = "rail"
    kind = "prismatic"
    axis = [1, 0, 0]
    zero = [0, 1, 0]
    first = { body = "ground" }
    second = { body = "slider" }
    displacement = 0.6662364387
    rough = true
    rate = -13.01804742
    [[joint]]
    name = "rod"
    kind = "rod"
    length = 0.5
    first = { body = "crank", point = [0.2, 0, 0] }
    second = { body = "slider" }
"#;

/// The largest part of its tolerance that a row of the start takes.
fn part_of_tolerance(model: &Model) -> f64 {
    let (start, kinematics) = (model.assemble().expect("it can be assembled"), Kinematics::at(model, 0.0));
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let v = DVector::from_column_slice(&start.v);
    let rates = kinematics.jacobian(&start.q, &near) * v - kinematics.nu(&start.q, &near);
    let (phi, tolerances) = (kinematics.phi(&start.q, &near), model.start_tolerances(&start));
    assert!(model.redundant.is_empty(), "rows are compared with all");
    let parts = phi.iter().zip(&tolerances.phi).chain(rates.iter().zip(&tolerances.rates));
    parts.map(|(row, tolerance)| (row / tolerance).abs()).fold(0.0, f64::max)
}

#[test]
fn typed_rates_give_way_to_the_constraints() {
    let part = part_of_tolerance(&read("typed.toml", TYPED).unwrap());
    assert!(part < 1.0, "a row takes {part} of its tolerance");
}

#[test]
fn rates_that_are_off_by_more_than_digits_are_refused() {
    let wrong = TYPED.replace("rate = -13.01804742", "rate = -13.01804872");
    let said = read("typed.toml", &wrong).unwrap_err().render();
    assert!(said.contains("the start does not allow the rate of joint `"), "{said}");
}

#[test]
fn angles_of_any_number_of_turns_are_assembled() {
    for angle in [0.1, 1e3, 62831.9, 1e6, 1e9] {
        let page = format!(
            r#"
            format = 1
            name = "gears"
            [[body]]
            name = "ground"
            fixed = true
            [[body]]
            name = "one"
            mass = 1
            inertia = [0.1, 0.1, 0.1]
            [[body]]
            name = "other"
            mass = 1
            inertia = [0.1, 0.1, 0.1]
            [[joint]]
            name = "a"
            kind = "revolute"
            axis = [0, 0, 1]
            zero = [1, 0, 0]
            first = {{ body = "ground" }}
            second = {{ body = "one" }}
            angle = {angle:.1}
            rate = 100000
            [[joint]]
            name = "b"
            kind = "revolute"
            axis = [0, 0, 1]
            zero = [1, 0, 0]
            first = {{ body = "ground", point = [1000, 0, 0] }}
            second = {{ body = "other" }}
            [[coupler]]
            name = "teeth"
            first = {{ joint = "a" }}
            second = {{ joint = "b" }}
            ratio = -1.7
        "#
        );
        let model = read("gears.toml", &page).unwrap_or_else(|said| panic!("{}", said.render()));
        let part = part_of_tolerance(&model);
        assert!(part < 1.0, "from {angle} rad a row takes {part} of its tolerance");
        let wheel = model.assemble().unwrap().joints[1].position[0];
        assert!((wheel + 1.7 * angle).abs() <= 1e-15 * angle + 1e-12, "{wheel}");
    }
}
