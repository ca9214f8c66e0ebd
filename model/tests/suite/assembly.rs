//! The assembled start satisfies every constraint row and its derivative, typed here by hand.

use std::fmt::Write as _;

use crate::rows::{TOLERANCE, check, cross, residuals};
use gyro_model::{JointKind, Kinematics, Model, RowOwner, read};
use nalgebra::DVector;
use proptest::prelude::*;

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

/// Coordinates of a joint in its model file, the angles of up to three turns, and its rates.
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

/// A model file of a random tree. Body `k` hangs on an earlier one; the last `wanted` replaces its joint's rate.
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
