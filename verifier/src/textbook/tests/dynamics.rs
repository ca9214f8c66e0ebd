//! Energy against power, reactions against Newton's and Euler's laws.

use super::support::{
    accelerations, assert_close, at, dense, derivative, for_each_motion, later, random_point,
};
use crate::point::Point;
use crate::textbook::Textbook;
use crate::textbook::jet::Jet;
use crate::textbook::linear::Matrix;
use gyro_model::{Output, OutputKind};

/// Differences of fourth order over steps at which their error is of the size of rounding divided by the step.
const STEP: f64 = 1e-4;
const DIFFERENCE: f64 = 1e-8;

/// The dense solution of a hundred equations.
const SOLVED: f64 = 1e-9;

/// All that is not energy is power: of forces that store none, of drivers and of driven bodies.
#[test]
fn energy_changes_by_the_power_of_what_is_not_conservative() {
    for_each_motion(|what, textbook, point| {
        let (accelerations, lambda) = accelerations(textbook, point);
        let [non_conservative, drivers] = at(textbook, point).power(&lambda, &accelerations).expect("power");
        let energies = |dt: f64| {
            let moved = later(textbook, point, &accelerations, dt);
            at(textbook, &moved).energy().expect("energy").to_vec()
        };
        // Of a stiff spring both are large, and cancel.
        let [kinetic, potential] = derivative(STEP, energies).try_into().expect("two energies");
        assert_close(
            what,
            &[kinetic, potential],
            &[non_conservative + drivers - potential, potential],
            DIFFERENCE,
        );
        if !textbook.model.has_work() {
            assert_close(what, &[non_conservative, drivers], &[0.0, 0.0], 0.0);
        }
    });
}

#[test]
fn solutions_of_eq_17_leave_no_residual() {
    for_each_motion(|what, textbook, point| {
        let (accelerations, lambda) = accelerations(textbook, point);
        let residual = at(textbook, point).residual_of_motion(&accelerations, &lambda).expect("residual");
        // A residual is a difference of forces.
        let forces = at(textbook, point).applied_force().expect("forces");
        let size = forces.iter().fold(1.0_f64, |size, force| size.max(force.abs()));
        assert_close(what, &residual, &vec![0.0; residual.len()], SOLVED * size);
        let mut wrong = accelerations.clone();
        wrong[0] += 1.0;
        let residual = at(textbook, point).residual_of_motion(&wrong, &lambda).expect("residual");
        assert!(residual.iter().any(|x| x.abs() > 1e-3), "{what}: a wrong solution passes");
    });
}

/// A weight on two ends of the same joint, once as its second body and once as its first.
const PENDULUM: &str = r#"
format = 1
name = "pendulum"
gravity = [1, -9, 2.5]
[[body]]
name = "cart"
orientation = [1, 2, -1, 3]
driven = { translation = [{ polynomial = [0, 1, 2] }, 0, 0], rotations = [{ axis = [1, 1, 0], angle = { polynomial = [0, 2, 1] } }] }
[[body]]
name = "bob"
mass = 0.7
inertia = { xx = 3e-2, yy = 4e-2, zz = 5e-2, xy = 2e-3, xz = -3e-3, yz = 1e-3 }
[[joint]]
name = "pivot"
kind = "revolute"
angle = 0.4
rate = 3
first = { body = "FIRST", point = [0.1, 0.2, 0.3], axis = [1, 2, 3], zero = [1, 0, 0] }
second = { body = "SECOND", point = [-0.1, 0.4, 0], axis = [0, 1, 1], zero = [0, 0, 1] }
"#;

#[test]
fn reactions_are_what_newton_and_euler_ask_for() {
    for [first, second] in [["cart", "bob"], ["bob", "cart"]] {
        let page = PENDULUM.replace("FIRST", first).replace("SECOND", second);
        let mut model = gyro_model::read("pendulum.toml", &page).expect("a good model file");
        let kind = OutputKind::Reaction { joint: 0 };
        model.outputs = vec![Output { name: "load".to_owned(), kind }];
        let textbook = Textbook::new(&model);
        let point = random_point(&textbook, 3);
        let (accelerations, lambda) = accelerations(&textbook, &point);
        let evaluation = at(&textbook, &point);
        let reaction = evaluation.outputs(&accelerations, &lambda).expect("outputs");
        assert_close(first, &reaction, &needed(&textbook, &point, &accelerations, second == "bob"), SOLVED);
    }
}

/// Force `m (s̈ − g)` and torque `J' ẇ' + w' × J' w'` that the bob needs, as the joint's reaction on its second body.
fn needed(textbook: &Textbook, point: &Point<f64>, accelerations: &[f64], bob_is_second: bool) -> Vec<f64> {
    let evaluation = at(textbook, point);
    let model = textbook.model;
    let bob = evaluation.moving(1);
    let acceleration = evaluation.acceleration(1, accelerations);
    let mass = evaluation.scope.number(&model.bodies[1].mass);
    let inertia = dense(&evaluation.mass_matrix());
    let inertia = Matrix(std::array::from_fn(|row| {
        std::array::from_fn(|column| Jet::constant(inertia[3 + row][3 + column]))
    }));
    let gravity = evaluation.gravity_at(&bob.pose.r).expect("uniform gravity");
    let force = (acceleration.s - gravity).times(&mass);
    let torque = inertia.apply(&acceleration.w) + bob.w.cross(&inertia.apply(&bob.w));
    let torque = bob.pose.a.apply(&torque);
    // About the second body's joint point.
    let second =
        evaluation.moving(evaluation.joints[0].second.body).pose.point(&evaluation.joints[0].second.point);
    let torque = torque + (bob.pose.r.clone() - second).cross(&force);
    let placed = evaluation.joints[0].placed(&evaluation.still);
    let sign = if bob_is_second { 1.0 } else { -1.0 };
    let of = |v| [&placed.f_i, &placed.g_i, &placed.h_i].map(|u| sign * u.dot(&v).value);
    [of(force), of(torque)].concat()
}
