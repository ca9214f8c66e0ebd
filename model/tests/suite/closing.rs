//! Starts of mechanisms with loops, rods and couplers: closed, held, impossible, on the wrong branch.

use std::f64::consts::FRAC_PI_3;

use gyro_model::{
    AssemblyError, Coupler, Coupling, Driver, JointCoordinate, JointKind, Kinematics, Model, Motion, Move,
    Number, Rational, RowOwner, Start, read,
};

/// Rounding of some dozens of operations on numbers of order one.
pub(crate) const TOLERANCE: f64 = 1e-13;

/// Joints of the four-bar.
const CRANK: usize = 0;
const ROCKER: usize = 1;
const ELBOW: usize = 2;
const KNEE: usize = 3;

fn page(stem: &str) -> Model {
    let path = format!("{}/../models/{stem}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped model file");
    read(stem, &text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// Bars of 0.2, 0.5 and 0.4 m between pivots 0.5 m apart; the crank starts at 60 degrees.
fn four_bar() -> Model {
    page("four-bar-revolute")
}

pub(crate) fn number(x: f64) -> Number {
    Number::Exact(Rational::from_float(x).expect("finite"))
}

fn set(model: &mut Model, joint: usize, position: f64, is_rough: bool) {
    let start = &mut model.joints[joint].start;
    (start.position, start.is_rough) = (vec![Some(number(position))], is_rough);
}

fn constant(x: f64) -> Motion {
    Motion::Polynomial(vec![number(x)])
}

/// Angles of rocker and elbow for a crank angle, knee above, and their derivatives: two circles' intersection.
fn closed_form(crank: f64) -> [f64; 2] {
    let (x, y) = (0.2 * crank.cos() - 0.5, 0.2 * crank.sin());
    let reach = x.hypot(y);
    // From the rocker's pivot: the triangle of rocker 0.4, coupler 0.5 and the distance to the crank's end.
    let at_pivot = ((0.4_f64.powi(2) + reach * reach - 0.5_f64.powi(2)) / (0.8 * reach)).acos();
    let rocker = y.atan2(x) - at_pivot;
    let coupler = (0.4 * rocker.sin() - y).atan2(0.4 * rocker.cos() - x);
    [rocker, coupler - crank]
}

/// Φ and Φ_q q̇ − ν of a start.
pub(crate) fn check(model: &Model, start: &Start) {
    let kinematics = Kinematics::at(model, 0.0);
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let phi = kinematics.phi(&start.q, &near).amax();
    assert!(phi <= TOLERANCE, "rows {phi:e}");
    let v = nalgebra::DVector::from_column_slice(&start.v);
    let rate = kinematics.jacobian(&start.q, &near) * &v - kinematics.nu(&start.q, &near);
    assert!(rate.amax() <= TOLERANCE * (1.0 + v.amax()), "velocity rows {:e}", rate.amax());
    for pose in start.q.chunks_exact(7) {
        assert!((pose[3..].iter().map(|e| e * e).sum::<f64>() - 1.0).abs() <= 1e-15);
    }
}

pub(crate) fn assembled(model: &Model) -> Start {
    let start = model.assemble().unwrap_or_else(|error| panic!("{error}"));
    check(model, &start);
    start
}

#[test]
fn a_four_bar_closes_where_the_crank_is_held() {
    for off in [0.0, 0.3, -0.5] {
        let mut model = four_bar();
        let [rocker, elbow] = closed_form(model.assemble().expect("a start").joints[CRANK].position[0]);
        set(&mut model, ROCKER, rocker + off, true);
        set(&mut model, ELBOW, elbow - 0.7 * off, true);
        let start = assembled(&model);
        let crank = start.joints[CRANK].position[0];
        assert!((crank - FRAC_PI_3).abs() <= 1e-15);
        assert!((start.joints[ROCKER].position[0] - rocker).abs() <= TOLERANCE);
        assert!((start.joints[ELBOW].position[0] - elbow).abs() <= TOLERANCE);
        // The crank's rate is given; the others follow by the closed form's derivative.
        let h = 1e-5;
        let [before, after] = [crank - h, crank + h].map(closed_form);
        assert!((start.joints[CRANK].rate[0] - 6.0).abs() <= TOLERANCE);
        for (joint, k) in [(ROCKER, 0), (ELBOW, 1)] {
            let rate = 6.0 * (after[k] - before[k]) / (2.0 * h);
            assert!((start.joints[joint].rate[0] - rate).abs() <= 1e-8);
        }
        if off != 0.0 {
            let told = |moved: &Move| (moved.owner, moved.coordinate, moved.unit);
            assert_eq!(told(&start.moved[0]), (RowOwner::Joint(ROCKER), "angle", "rad"));
            assert!((start.moved[0].amount + off).abs() <= TOLERANCE, "{:?}", start.moved);
        }
    }
}

/// Sum of squares of rotations and displacements by the size of a planar pose from another, with the crank's weight.
fn distance(model: &Model, a: &Start, b: &Start, weight: f64) -> f64 {
    let weights = [weight, 1.0, 1.0];
    let of = |moving_body: usize| {
        let (a, b) = (&a.q[7 * moving_body..7 * moving_body + 7], &b.q[7 * moving_body..7 * moving_body + 7]);
        let shift: f64 = (0..3).map(|k| (a[k] - b[k]).powi(2)).sum();
        // Rotations about z: the angle is twice the difference of the half angles.
        let turn = 2.0 * (a[6].atan2(a[3]) - b[6].atan2(b[3]));
        weights[moving_body] * (shift / model.size().powi(2) + turn * turn)
    };
    (0..3).map(of).sum()
}

#[test]
fn the_least_change_closes_it_by_weight() {
    let mut cranks = Vec::new();
    for weight in [1.0, 100.0] {
        let mut model = four_bar();
        set(&mut model, CRANK, FRAC_PI_3, true);
        set(&mut model, ROCKER, 1.2, true);
        set(&mut model, ELBOW, -0.9, true);
        model.bodies[1].assembly_weight = number(weight);
        let start = assembled(&model);
        let crank = start.joints[CRANK].position[0];
        cranks.push((crank - FRAC_PI_3).abs());

        // The guess itself is the open tree without the knee.
        let mut open = model.clone();
        open.joints.truncate(KNEE);
        let guess = open.assemble().expect("an open tree");
        let at = |crank: f64| {
            let mut held = model.clone();
            let [rocker, elbow] = closed_form(crank);
            set(&mut held, CRANK, crank, false);
            set(&mut held, ROCKER, rocker, true);
            set(&mut held, ELBOW, elbow, true);
            distance(&model, &guess, &held.assemble().expect("a closed pose"), weight)
        };
        let least = distance(&model, &guess, &start, weight);
        assert!((at(crank) - least).abs() <= 1e-12, "{} {least}", at(crank));
        for step in [1e-3, 1e-2, 0.1] {
            assert!(at(crank + step) > least && at(crank - step) > least, "step {step}");
        }
    }
    assert!(cranks[0] > 1e-3 && cranks[1] < 0.2 * cranks[0], "{cranks:?}");
}

#[test]
fn coordinates_that_contradict_are_named() {
    let mut model = four_bar();
    set(&mut model, ROCKER, 1.3, false);
    let error = model.assemble().expect_err("a contradiction");
    let AssemblyError::Held { name, coordinate, off_by, nearest, unit, .. } = &error else {
        panic!("{error}")
    };
    assert_eq!((*coordinate, *unit), ("angle", "rad"));
    assert!(["crank_pivot", "rocker_pivot"].contains(&name.as_str()), "{name}");
    assert!(*off_by > 0.01 && nearest.is_some(), "{error}");
    // Rounded to the model file's digits they do not contradict if they are rough.
    set(&mut model, ROCKER, 1.453, true);
    assembled(&model);
}

#[test]
fn an_impossible_linkage_is_named_with_what_is_left() {
    let mut model = four_bar();
    model.joints[ROCKER].first.point[0] = number(5.0);
    let error = model.assemble().expect_err("an impossible linkage");
    let AssemblyError::Impossible { residual, .. } = &error else { panic!("{error}") };
    assert!(residual.abs() > 0.1, "{error}");
    assert!(error.to_string().contains(" m") && error.to_string().contains("joint `"), "{error}");
}

#[test]
fn opposite_axes_are_refused() {
    let mut model = four_bar();
    model.joints[KNEE].second.axis[2] = number(-1.0);
    let error = model.assemble().expect_err("a flip");
    assert!(matches!(&error, AssemblyError::Flipped { joint: KNEE, direction: "axis", .. }), "{error}");
}

/// A slider-crank: the crank turns, the slider's rail closes the loop.
const SLIDER_CRANK: &str = r#"
format = 1
name = "slider_crank"
[[body]]
name = "ground"
fixed = true
[[body]]
name = "crank"
mass = 1
inertia = [1e-3, 1e-3, 1e-3]
[[body]]
name = "rod"
mass = 1
inertia = [1e-3, 1e-3, 1e-3]
[[body]]
name = "slider"
mass = 1
inertia = [1e-3, 1e-3, 1e-3]
[[joint]]
name = "pivot"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "crank", point = [-0.1, 0, 0] }
angle = 0.8
rate = 3
[[joint]]
name = "big_end"
kind = "universal"
first = { body = "crank", point = [0.1, 0, 0], axis = [0, 0, 1], zero = [0, 1, 0] }
second = { body = "rod", point = [-0.3, 0, 0], axis = [0, 1, 0], zero = [0, 0, 1] }
first_angle = -1
rough = true
[[joint]]
name = "small_end"
kind = "spherical"
first = { body = "rod", point = [0.3, 0, 0] }
second = { body = "slider" }
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "ground" }
second = { body = "slider" }
"#;

#[test]
fn a_slider_crank_closes() {
    let model = read("slider-crank", SLIDER_CRANK).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let start = assembled(&model);
    let crank = 0.8_f64;
    let reach = 0.2 * crank.cos() + (0.36 - (0.2 * crank.sin()).powi(2)).sqrt();
    assert!((start.joints[3].position[0] - reach).abs() <= TOLERANCE);
    let speed = -0.2 * crank.sin() * (1.0 + 0.2 * crank.cos() / (0.36 - (0.2 * crank.sin()).powi(2)).sqrt());
    assert!((start.joints[3].rate[0] - 3.0 * speed).abs() <= TOLERANCE);
}

/// Two wheels on one axis, tied to each other by a joint that closes the loop.
#[test]
fn half_turns_that_satisfy_the_rows_are_refused() {
    for kind in [JointKind::Fixed, JointKind::Prismatic, JointKind::Cylindrical, JointKind::Planar] {
        for (zero, axis, expected) in [
            ([1.0, 0.0, 0.0], 2.0, None),
            ([-1.0, 0.0, 0.0], 2.0, Some("zero")),
            ([1.0, 0.0, 0.0], -2.0, Some("axis")),
        ] {
            let mut model = wheels();
            model.bodies.truncate(3);
            model.joints.truncate(2);
            (0..2).for_each(|joint| set(&mut model, joint, 0.0, false));
            let mut tie = model.joints[0].clone();
            (tie.name, tie.kind) = ("tie".to_owned(), kind);
            (tie.first.body, tie.second.body) = (1, 2);
            tie.start = gyro_model::JointStartSpec::default();
            tie.second.zero = zero.map(number);
            tie.second.axis = [0.0, 0.5 * axis, axis].map(number);
            model.joints.push(tie);
            // Without a zero row a joint may turn.
            let turns = matches!(kind, JointKind::Cylindrical | JointKind::Planar);
            let expected = expected.filter(|direction| !(turns && *direction == "zero"));
            match (model.assemble(), expected) {
                (Ok(start), None) => check(&model, &start),
                (Err(AssemblyError::Flipped { joint: 2, direction, .. }), Some(expected)) => {
                    assert_eq!(direction, expected, "{kind:?}");
                }
                (other, _) => panic!("{kind:?} {zero:?} {axis}: {other:?}"),
            }
        }
    }
}

#[test]
fn a_jump_is_refused_and_says_where_it_would_close() {
    let mut model = four_bar();
    set(&mut model, ROCKER, -2.5, true);
    let error = model.assemble().expect_err("a jump");
    let AssemblyError::Jump { name, turned, coordinates, .. } = &error else { panic!("{error}") };
    assert!(["rocker", "coupler"].contains(&name.as_str()), "{error}");
    assert!(*turned > 1.57 && coordinates.contains("joint `knee` at angle = "), "{error}");
}

#[test]
fn rates_that_contradict_are_named() {
    let mut model = four_bar();
    model.joints[ROCKER].start.rate = Some(vec![number(0.0)]);
    let error = model.assemble().expect_err("a contradiction");
    let AssemblyError::Rate { name, is_given: true, residual, .. } = &error else { panic!("{error}") };
    assert!(["joint `crank_pivot`", "joint `rocker_pivot`"].contains(&name.as_str()), "{error}");
    assert!(residual.abs() > 0.1);
    // Rates that agree are no contradiction.
    model.joints[ROCKER].start.rate = Some(vec![number(1.976_419_535_719_887_3)]);
    assembled(&model);
}

#[test]
fn a_body_keeps_the_angular_velocity_that_it_is_given() {
    let mut model = four_bar();
    model.joints[CRANK].start.rate = None;
    model.bodies[3].angular_velocity = Some([0.0, 0.0, 1.5].map(number));
    let start = assembled(&model);
    assert!((start.joints[ROCKER].rate[0] - 1.5).abs() <= TOLERANCE);
    model.bodies[3].angular_velocity = Some([0.0, 0.1, 1.5].map(number));
    let error = model.assemble().expect_err("no such angular velocity");
    assert!(
        matches!(&error, AssemblyError::Rate { owner: RowOwner::Body(3), is_given: true, .. }),
        "{error}"
    );
}

#[test]
fn a_driver_sets_a_crank_and_its_rate() {
    let mut model = four_bar();
    model.joints[CRANK].start = gyro_model::JointStartSpec { position: vec![None], ..Default::default() };
    let coordinate = JointCoordinate { joint: CRANK, coordinate: 0 };
    let motion = Motion::Polynomial([FRAC_PI_3 + 4.0 * std::f64::consts::PI, 6.0, 1.0].map(number).to_vec());
    model.drivers.push(Driver { name: "motor".to_owned(), coordinate, motion });
    let start = assembled(&model);
    assert!((start.joints[CRANK].position[0] - FRAC_PI_3 - 4.0 * std::f64::consts::PI).abs() <= TOLERANCE);
    assert!((start.joints[CRANK].rate[0] - 6.0).abs() <= TOLERANCE);
    assert!((start.joints[ROCKER].rate[0] - 1.976_419_535_719_887_3).abs() <= 1e-9);
}

/// Two wheels on the ground.
fn wheels() -> Model {
    let mut page = "format = 1\nname = \"wheels\"\n[[body]]\nname = \"ground\"\nfixed = true\n".to_owned();
    for wheel in ["a", "b", "c"] {
        page += &format!(
            "[[body]]\nname = \"{wheel}\"\nmass = 1\ninertia = [1, 1, 1]\n[[joint]]\nname = \"pivot_{wheel}\"\n\
             kind = \"revolute\"\naxis = [0, 1, 2]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\" }}\n\
             second = {{ body = \"{wheel}\" }}\n"
        );
    }
    read("wheels", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn gear(name: &str, first: usize, second: usize, ratio: f64, offset: f64) -> Coupler {
    let of = |joint| JointCoordinate { joint, coordinate: 0 };
    Coupler {
        name: name.to_owned(),
        second: Some(of(second)),
        by: Coupling::Linear { first: of(first), ratio: number(ratio), offset: number(offset) },
    }
}

#[test]
fn gears_turn_many_times() {
    let mut model = wheels();
    set(&mut model, 0, 20.0, false);
    model.joints[0].start.rate = Some(vec![number(4.0)]);
    // The last wheel is told by the middle one, in either order of the model file.
    model.couplers = vec![gear("late", 1, 2, 0.5, 0.0), gear("early", 0, 1, -2.0, 0.25)];
    let start = assembled(&model);
    for (joint, position, rate) in [(0, 20.0, 4.0), (1, -39.75, -8.0), (2, -19.875, -4.0)] {
        assert!((start.joints[joint].position[0] - position).abs() <= TOLERANCE, "{:?}", start.joints);
        assert!((start.joints[joint].rate[0] - rate).abs() <= TOLERANCE, "{:?}", start.joints);
    }
    assert_eq!(start.moved, []);
    set(&mut model, 2, -19.8, false);
    let error = model.assemble().expect_err("a contradiction");
    assert!(matches!(error, AssemblyError::Held { .. }), "{error}");
    model.joints[2].start.is_rough = true;
    assembled(&model);
}

#[test]
fn gears_that_contradict_are_impossible() {
    let mut model = wheels();
    let hold = |joint, offset| {
        let coordinate = JointCoordinate { joint, coordinate: 0 };
        Driver { name: format!("hold_{joint}"), coordinate, motion: constant(offset) }
    };
    model.couplers = vec![gear("gear", 0, 1, 1.0, 0.0)];
    model.drivers = vec![hold(0, 0.0), hold(1, 0.5)];
    let error = model.assemble().expect_err("a contradiction");
    assert!(matches!(error, AssemblyError::Impossible { .. }), "{error}");
}

const SPINDLE: &str = r#"
format = 1
name = "spindle"
[[body]]
name = "ground"
fixed = true
[[body]]
name = "nut"
mass = 1
inertia = [1, 1, 1]
[[body]]
name = "spindle"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "rail"
kind = "prismatic"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "nut" }
displacement = 0.25
rate = 0.5
[[joint]]
name = "bearing"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "spindle" }
[[joint]]
name = "thread"
kind = "screw"
lead = 0.01
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "spindle" }
second = { body = "nut" }
"#;

#[test]
fn a_screw_that_closes_a_loop_is_on_the_turn_that_its_advance_tells() {
    let model = read("spindle", SPINDLE).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let start = assembled(&model);
    assert!((start.joints[2].position[0] - 25.0).abs() <= 1e-12, "{:?}", start.joints);
    assert!((start.joints[2].rate[0] - 50.0).abs() <= 1e-11);
    let spindle = 8.0 * std::f64::consts::PI - 25.0;
    assert!((start.joints[1].position[0] - spindle).abs() <= 1e-12, "{:?}", start.joints);
    assert!((start.joints[1].rate[0] + 50.0).abs() <= 1e-11);
    assert!((start.joints[0].position[0] - 0.25).abs() <= 1e-15);
}
