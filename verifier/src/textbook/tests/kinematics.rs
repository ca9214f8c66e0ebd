//! Φ and its derivatives, coordinates and their rates, prescribed motions.

use super::support::{
    accelerations, assert_close, at, dense, derivative, dot, for_each_motion, for_each_state, later,
    normalise, raft, random_point,
};
use crate::point::Point;
use crate::textbook::linear::Vector;
use crate::textbook::{Reading, Textbook};
use gyro_model::Kinematics;

/// Step of differences of fourth order: what is left of them is below the rounding, 1e-16 divided by it.
const STEP: f64 = 3e-4;
const DIFFERENCE: f64 = 1e-9;

/// Sums of products of order one.
const ROUNDING: f64 = 1e-12;

#[test]
fn phi_q_is_the_derivative_of_phi() {
    for_each_state(|what, textbook, point| {
        let phi_q = dense(&at(textbook, point).phi_q().expect("Φ_q"));
        for column in 0..7 * textbook.moving_bodies.len() {
            let quotient = derivative(STEP, |step| {
                let mut moved = point.clone();
                moved.state[column] += step;
                at(textbook, &moved).phi().expect("Φ")
            });
            let of_column: Vec<f64> = phi_q.iter().map(|row| row[column]).collect();
            assert_close(&format!("{what} column {column}"), &of_column, &quotient, DIFFERENCE);
        }
    });
}

#[test]
fn phi_pi_is_half_phi_p_g_transposed() {
    for_each_state(|what, textbook, point| {
        let (phi_q, phi_pi) =
            (at(textbook, point).phi_q().expect("Φ_q"), at(textbook, point).phi_pi().expect("Φ_π'"));
        let (phi_q, phi_pi) = (dense(&phi_q), dense(&phi_pi));
        for moving_body in 0..textbook.moving_bodies.len() {
            let [e0, e1, e2, e3] = [3, 4, 5, 6].map(|k| point.state[7 * moving_body + k]);
            let g = [[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]];
            for (by_q, by_pi) in phi_q.iter().zip(&phi_pi) {
                let by_p = &by_q[7 * moving_body + 3..7 * moving_body + 7];
                let turned = g.map(|row| 0.5 * dot(by_p, &row));
                assert_close(what, &by_pi[6 * moving_body + 3..6 * moving_body + 6], &turned, ROUNDING);
                assert_eq!(
                    by_pi[6 * moving_body..6 * moving_body + 3],
                    by_q[7 * moving_body..7 * moving_body + 3],
                    "{what}"
                );
            }
        }
    });
}

#[test]
fn nu_is_minus_the_derivative_of_phi_in_time() {
    let mut driven = 0;
    for_each_state(|what, textbook, point| {
        let nu = at(textbook, point).nu().expect("ν");
        let phi_t = derivative(STEP, |step| {
            let later = Point { t: point.t + step, ..point.clone() };
            at(textbook, &later).phi().expect("Φ")
        });
        let expected: Vec<f64> = phi_t[..nu.len()].iter().map(|rate| -rate).collect();
        assert_close(what, &nu, &expected, DIFFERENCE);
        driven += usize::from(nu.iter().any(|nu| *nu != 0.0));
    });
    assert!(driven > 0, "no model is driven");
}

#[test]
fn the_velocity_residual_is_what_eq_18_says() {
    for_each_state(|what, textbook, point| {
        let (evaluation, n) = (at(textbook, point), textbook.moving_bodies.len());
        let velocities = &point.state[7 * n..13 * n];
        let rows = dense(&evaluation.phi_pi().expect("Φ_π'")).into_iter().zip(evaluation.nu().expect("ν"));
        let expected: Vec<f64> = rows.map(|(row, nu)| dot(&row, velocities) - nu).collect();
        assert_close(what, &evaluation.velocity_residual().expect("residual"), &expected, ROUNDING);
    });
}

/// `Φ̈ = Φ_π' v̇ − γ` for any accelerations: the residual's change along them.
#[test]
fn gamma_is_what_the_second_derivative_of_phi_leaves() {
    for_each_state(|what, textbook, point| {
        let (evaluation, n) = (at(textbook, point), textbook.moving_bodies.len());
        let accelerations: Vec<f64> = (0..6 * n).map(|k| (k as f64).sin()).collect();
        // The turn references stay: they are constants in derivatives of Φ.
        let references = 13 * n..point.state.len();
        let change = derivative(STEP / 10.0, |dt| {
            let mut moved = later(textbook, point, &accelerations, dt);
            moved.state[references.clone()].copy_from_slice(&point.state[references.clone()]);
            at(textbook, &moved).velocity_residual().expect("residual")
        });
        let rows = dense(&evaluation.phi_pi().expect("Φ_π'")).into_iter().zip(evaluation.gamma().expect("γ"));
        let expected: Vec<f64> = rows.map(|(row, gamma)| dot(&row, &accelerations) - gamma).collect();
        assert_close(what, &change, &expected, 100.0 * DIFFERENCE);
    });
}

/// The model's kinematics, which assemble the start, are written apart from these.
#[test]
fn the_model_says_the_same_of_phi_phi_pi_and_nu() {
    for_each_state(|what, textbook, point| {
        let (model, evaluation, n) = (textbook.model, at(textbook, point), textbook.moving_bodies.len());
        let kinematics = Kinematics::at(model, point.t);
        let q = &point.state[..7 * n];
        let mut near: Vec<Vec<f64>> =
            model.assemble().expect("a start").joints.into_iter().map(|j| j.position).collect();
        for (place, turn) in textbook.turns.iter().enumerate() {
            near[turn.joint][turn.coordinate] = *point.turn_reference(model, place);
        }
        let kept = |values: &[f64]| -> Vec<f64> {
            values
                .iter()
                .zip(textbook.blocks.iter().flat_map(|block| &block.is_kept))
                .filter(|(_, kept)| **kept)
                .map(|(value, _)| *value)
                .collect()
        };
        let phi = evaluation.phi().expect("Φ");
        assert_close(what, &phi[..phi.len() - n], &kept(kinematics.phi(q, &near).as_slice()), ROUNDING);
        assert_close(what, &evaluation.nu().expect("ν"), &kept(kinematics.nu(q, &near).as_slice()), ROUNDING);
        let (jacobian, phi_pi) = (kinematics.jacobian(q, &near), dense(&evaluation.phi_pi().expect("Φ_π'")));
        for column in 0..6 * n {
            let of_column: Vec<f64> = phi_pi.iter().map(|row| row[column]).collect();
            let expected = kept(jacobian.column(column).as_slice());
            assert_close(&format!("{what} column {column}"), &of_column, &expected, ROUNDING);
        }
    });
}

/// On the constraints an angle's rate is its derivative, and so is the rate of its turn reference.
#[test]
fn rates_are_derivatives_of_coordinates() {
    for_each_motion(|what, textbook, point| {
        let (accelerations, _) = accelerations(textbook, point);
        let values = |dt: f64| -> Vec<f64> {
            let moved = later(textbook, point, &accelerations, dt);
            let readings = at(textbook, &moved).readings().expect("readings");
            readings.iter().filter_map(value_of).map(|(value, _)| value).collect()
        };
        let readings = at(textbook, point).readings().expect("readings");
        let rates: Vec<f64> = readings.iter().filter_map(value_of).map(|(_, rate)| rate).collect();
        assert_close(what, &rates, &derivative(1e-4, values), 1e-8);
    });
}

fn value_of(reading: &Reading<f64>) -> Option<(f64, f64)> {
    match reading {
        Reading::Angle { sine, cosine, rate } => Some((sine.atan2(*cosine), *rate)),
        Reading::Length([value, rate]) => Some((*value, *rate)),
        Reading::Orientation(_) => None,
    }
}

/// Relative Euler parameters turn with the relative angular velocity: `ṗ = ½ G(p)ᵀ w'`.
#[test]
fn relative_orientations_turn_as_read() {
    let model = raft();
    let textbook = Textbook::new(&model);
    let point = random_point(&textbook, 1);
    let read = |dt: f64| {
        let moved = later(&textbook, &point, &vec![0.0; 6 * textbook.moving_bodies.len()], dt);
        let readings = at(&textbook, &moved).readings().expect("readings");
        let of_ball = readings.into_iter().find_map(|reading| match reading {
            Reading::Orientation(values) => Some(values.to_vec()),
            _ => None,
        });
        of_ball.expect("a spherical joint")
    };
    let now = read(0.0);
    let ([e0, e1, e2, e3], w) = ([0, 1, 2, 3].map(|k| now[k]), &now[4..]);
    let g = [[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]];
    let expected: Vec<f64> =
        (0..4).map(|k| 0.5 * (0..3).map(|row| g[row][k] * w[row]).sum::<f64>()).collect();
    assert_close("spherical", &derivative(1e-4, read)[..4], &expected, DIFFERENCE);
}

/// Pose, velocity and acceleration of driven bodies, which the model computes from Euler parameters.
#[test]
fn driven_bodies_move_as_the_model_says() {
    let mut driven = 0;
    for_each_state(|what, textbook, point| {
        let evaluation = at(textbook, point);
        for (index, body) in textbook.model.bodies.iter().enumerate() {
            let Some(motion) = &body.motion else { continue };
            let (expected, moving) = (motion.state(textbook.model, body, point.t), evaluation.moving(index));
            let acceleration = evaluation.acceleration(index, &[]);
            let values = |v: &Vector<f64>| v.0.each_ref().map(|x| x.value);
            assert_close(what, &values(&moving.pose.r), &<[f64; 3]>::from(expected.r), ROUNDING);
            assert_close(what, &moving.pose.p.each_ref().map(|e| e.value), &expected.p.0, ROUNDING);
            assert_close(what, &values(&moving.s), &<[f64; 3]>::from(expected.s), ROUNDING);
            assert_close(what, &values(&moving.w), &<[f64; 3]>::from(expected.w), ROUNDING);
            assert_close(what, &values(&acceleration.s), &<[f64; 3]>::from(expected.ds), ROUNDING);
            assert_close(what, &values(&acceleration.w), &<[f64; 3]>::from(expected.dw), ROUNDING);
            // Both ways to the orientation agree.
            let from_p = evaluation.scope.rotation(&moving.pose.p);
            for (row, other) in moving.pose.a.0.iter().zip(&from_p.0) {
                assert_close(
                    what,
                    &row.each_ref().map(|x| x.value),
                    &other.each_ref().map(|x| x.value),
                    ROUNDING,
                );
            }
            driven += 1;
        }
    });
    assert!(driven > 0, "no model has a driven body");
}

#[test]
fn position_rates_are_eqs_14_and_16() {
    for_each_state(|what, textbook, point| {
        let (rates, n) = (at(textbook, point).position_rates(), textbook.moving_bodies.len());
        for moving_body in 0..n {
            let velocity = &point.state[7 * n + 6 * moving_body..7 * n + 6 * moving_body + 6];
            let [e0, e1, e2, e3] = [3, 4, 5, 6].map(|k| point.state[7 * moving_body + k]);
            let g = [[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]];
            let w = g.map(|row| 2.0 * dot(&row, &rates[7 * moving_body + 3..7 * moving_body + 7]));
            assert_close(what, &rates[7 * moving_body..7 * moving_body + 3], &velocity[..3], ROUNDING);
            assert_close(what, &w, &velocity[3..], ROUNDING);
            let along = dot(&[e0, e1, e2, e3], &rates[7 * moving_body + 3..7 * moving_body + 7]);
            assert_close(what, &[along], &[0.0], ROUNDING);
        }
        let mut state = point.state.clone();
        normalise(&mut state, n);
        assert_close(what, &state, &point.state, ROUNDING);
    });
}
