//! Outputs against Newton and Euler by hand, and against difference quotients along the motion.

use crate::support::{Random, assert_close, careful_models, dense, read_text, state_near, test_model};
use gyro_assembled::Dense;
use gyro_model::{BodyFrame, JointKind, Model, Number, OutputKind, Support};
use gyro_sim::{Dynamics, Exact, Mechanism, Rk4};
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

const STATES: usize = 50;

/// A body that a joint of the kind holds on a moving one.
fn single_joint(kind: &str, keys: &str) -> Model {
    let directions = if kind == "spherical" { "" } else { "axis = [1, 2, 3]\nzero = [1, 0, 0]" };
    let second = if kind == "point_on_line" { "" } else { directions };
    let list = |lines: &str| lines.replace('\n', ", ");
    let end = |directions: &str| {
        if directions.is_empty() { String::new() } else { format!(", {}", list(directions)) }
    };
    read_text(&format!(
        "format = 1
name = \"single\"
gravity = [1, -9, 2]
[[body]]
name = \"carrier\"
free = true
mass = 2
inertia = {{ xx = 3e-1, yy = 4e-1, zz = 5e-1, xy = 2e-2, xz = -3e-2, yz = 1e-2 }}
[[body]]
name = \"carried\"
mass = 0.5
inertia = {{ xx = 3e-2, yy = 4e-2, zz = 5e-2, xy = 2e-3, xz = -3e-3, yz = 1e-3 }}
[[joint]]
name = \"joint\"
kind = \"{kind}\"
{keys}
first = {{ body = \"carrier\", point = [0.1, 0.2, -0.1]{} }}
second = {{ body = \"carried\", point = [-0.2, 0.1, 0.3]{} }}
[[output]]
name = \"reaction\"
kind = \"reaction\"
joint = \"joint\"
",
        end(directions),
        end(second),
    ))
}

/// One of each kind.
fn singles() -> Vec<Model> {
    let pages = [
        ("revolute", ""),
        ("spherical", ""),
        ("fixed", ""),
        ("universal", ""),
        ("cylindrical", ""),
        ("prismatic", ""),
        ("planar", ""),
        ("screw", "lead = 0.05"),
        ("point_on_line", ""),
    ];
    let mut models = pages.map(|(kind, keys)| single_joint(kind, keys)).to_vec();
    // A rod carries nothing, so no model file has one alone: two free bodies.
    let mut rod = single_joint("spherical", "");
    rod.bodies[1].support = Support::Free;
    rod.bodies[1].position = [1, 0, 0].map(Number::integer);
    rod.joints[0].kind = JointKind::Rod;
    rod.joints[0].length = Number::integer(1);
    models.push(rod);
    models
}

fn vector(values: &[f64]) -> Vector3<f64> {
    Vector3::from_column_slice(values)
}

/// A(p).
fn rotation(p: &[f64]) -> Matrix3<f64> {
    let p = Quaternion::new(p[0], p[1], p[2], p[3]);
    UnitQuaternion::from_quaternion(p).to_rotation_matrix().into_inner()
}

#[test]
fn a_joint_pulls_as_newton_and_euler_ask_it_to() {
    for (seed, model) in (0..).zip(singles()) {
        let mechanism = dense(&model);
        let (joint, body) = (&model.joints[0], &model.bodies[1]);
        let mut random = Random(seed);
        for state in 0..STATES {
            let y = state_near(&mechanism, 0.2, &mut random);
            let mut rates = y.clone();
            mechanism.derivative(0.0, &y, &mut rates);
            let [i, j] = [&y[3..7], &y[10..14]].map(rotation);
            let (s_dot, w, w_dot) = (vector(&rates[20..23]), vector(&y[23..26]), vector(&rates[23..26]));
            let [xx, yy, zz, xy, xz, yz] = model.values(&body.inertia);
            let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
            let force = (s_dot - vector(&model.values(&model.gravity))) * model.value(&body.mass);
            let about_centre = j * (inertia * w_dot + w.cross(&(inertia * w)));
            let torque = about_centre - (j * vector(&model.values(&joint.second.point))).cross(&force);
            let h = vector(&model.values(&joint.first.axis)).normalize();
            let zero = vector(&model.values(&joint.first.zero));
            let f = (zero - h * h.dot(&zero)).normalize();
            let frame = i * Matrix3::from_columns(&[f, h.cross(&f), h]);
            let expected =
                [frame.tr_mul(&force), frame.tr_mul(&torque)].map(|v| v.as_slice().to_vec()).concat();
            let mut outputs = mechanism.buffers().outputs;
            mechanism.outputs(0.0, &y, &mut outputs);
            let what = format!("{:?} state {state}", joint.kind);
            assert_close(&what, &outputs, &expected, 1.0, 1e-11);
        }
    }
}

#[test]
fn a_joint_has_as_many_rows_as_it_takes_freedoms() {
    let freedoms = |kind| match kind {
        JointKind::Fixed => 0,
        JointKind::Revolute | JointKind::Prismatic | JointKind::Screw => 1,
        JointKind::Universal | JointKind::Cylindrical => 2,
        JointKind::Spherical | JointKind::Planar => 3,
        JointKind::PointOnLine => 4,
        JointKind::Rod => 5,
    };
    for model in singles() {
        let mechanism = dense(&model);
        let phi_pi = crate::support::dense_phi_pi(&mechanism, 0.0, &mechanism.start());
        let kind = model.joints[0].kind;
        assert_eq!(mechanism.buffers().rows.len(), 6 - freedoms(kind), "{kind:?}");
        assert_eq!(phi_pi.rank(1e-9), 6 - freedoms(kind), "{kind:?}");
    }
}

/// The same output on the motion's next moments: what a difference quotient needs.
fn derivative(mechanism: &Dense<f64>, t: f64, y: &[f64], h: f64) -> Vec<f64> {
    let at = |h: f64| {
        let mut y = y.to_vec();
        Rk4::new(&y).step(&Exact, mechanism, t, h, &mut y);
        let mut outputs = mechanism.buffers().outputs;
        mechanism.outputs(t + h, &y, &mut outputs);
        outputs
    };
    at(h).iter().zip(at(-h)).map(|(after, before)| (after - before) / (2.0 * h)).collect()
}

#[test]
fn velocities_and_accelerations_are_what_poses_and_velocities_change_by() {
    for (name, bodies) in [("kinds", ["bob", "nut"]), ("carried", ["deck", "inner"])] {
        for body in bodies {
            let mut model = test_model(name);
            let body = model.bodies.iter().position(|other| other.name == body).expect("it is there");
            let point = [1, 2, -1].map(Number::integer);
            for orientation in [None, Some([3, -1, 2, 1].map(Number::integer))] {
                let frame = BodyFrame { body, point: point.clone(), orientation };
                let kinds =
                    [OutputKind::Pose, OutputKind::Velocity, OutputKind::Acceleration, OutputKind::Inertial];
                let output = |kind: fn(BodyFrame) -> OutputKind| gyro_model::Output {
                    name: String::new(),
                    kind: kind(frame.clone()),
                };
                model.outputs = kinds.map(output).to_vec();
                check_kinematics(&model.name, &model, &dense(&model));
            }
        }
    }
}

/// Seven numbers of a pose, then six each of velocity, acceleration and inertial sensor.
fn check_kinematics(what: &str, model: &Model, mechanism: &Dense<f64>) {
    // At these rates the third derivatives are of the order of 1e4: the quotient's error is of the order of 1e-7.
    let (t, h, tolerance) = (0.2, 1e-5, 1e-6);
    let mut y = mechanism.start();
    Rk4::new(&y).step(&Exact, mechanism, t, 1e-3, &mut y);
    let mut now = mechanism.buffers().outputs;
    mechanism.outputs(t, &y, &mut now);
    let rates = derivative(mechanism, t, &y, h);
    let (v, w) = (&now[7..10], &now[10..13]);
    assert_close(&format!("{what} velocity"), v, &rates[..3], 1.0, tolerance);
    let [e0, e1, e2, e3] = [3, 4, 5, 6].map(|k| now[k]);
    let g = [[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]];
    let spin = g.map(|row| (0..4).map(|k| 2.0 * row[k] * rates[3 + k]).sum::<f64>());
    assert_close(&format!("{what} angular velocity"), w, &spin, 1.0, tolerance);
    assert_close(&format!("{what} acceleration"), &now[13..19], &rates[7..13], 1.0, tolerance);
    let gravity = vector(&model.values(&model.gravity));
    let felt = rotation(&now[3..7]).tr_mul(&(vector(&now[13..16]) - gravity));
    assert_close(&format!("{what} specific force"), &now[19..22], felt.as_slice(), 1.0, 1e-13);
    assert_eq!(&now[22..25], w, "{what}");
}

#[test]
fn both_forms_have_the_same_outputs() {
    let mut compared = 0;
    for (seed, model) in (0..).zip(careful_models()) {
        let (dense, careful) =
            (dense(&model), gyro_assembled::Careful::<f64>::new(&model).expect("it is supported"));
        let mut random = Random(seed);
        for _ in 0..STATES {
            let y = state_near(&dense, 0.3, &mut random);
            let (mut a, mut b) = (dense.buffers().outputs, careful.buffers().outputs);
            dense.outputs(0.3, &y, &mut a);
            careful.outputs(0.3, &y, &mut b);
            assert_close(&model.name, &a, &b, 1.0, 1e-10);
            compared += a.len();
        }
    }
    assert!(compared > 0, "no model has outputs");
}
