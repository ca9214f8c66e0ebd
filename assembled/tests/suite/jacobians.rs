//! Φ_q, (Φ_r, Φ_π'), ν and γ against finite differences and against one another, on and off the constraints.

use crate::support::{
    Random, assert_close, dense_models, dense_phi_pi, dense_phi_q, normalise, phi, state_near,
    velocity_residual,
};
use gyro_assembled::Dense;
use gyro_sim::{Dynamics, Kinematics, Mechanism};

const STATES: usize = 50;

/// Any time at which what is driven moves and accelerates.
const TIME: f64 = 0.3;

/// Rounding of sums of a few products of order one.
const ROUNDING: f64 = 1e-13;

/// Step of the differences: at 17 rad/s their error of fourth order is below the rounding, which is 1e-10 of what is
/// differentiated. Angles may be a few times as steep where joint frames are far apart.
const STEP: f64 = 1e-5;
const DIFFERENCE: f64 = 2e-9;

fn for_each_state(mut check: impl FnMut(&str, &Dense<f64>, Vec<f64>)) {
    for (name, mechanism) in dense_models() {
        // Of the name: a new model leaves the states of all others as they are.
        let mut random = Random(name.bytes().fold(0, |seed, byte| 31 * (seed % (1 << 32)) + u64::from(byte)));
        for state in 0..STATES {
            let y = state_near(&mechanism, 0.5, &mut random);
            check(&format!("{name} state {state}"), &mechanism, y);
        }
    }
}

/// The derivative at zero by central differences of fourth order.
fn derivative(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let quotient = |step: f64| -> Vec<f64> {
        f(step).iter().zip(f(-step)).map(|(plus, minus)| (plus - minus) / (2.0 * step)).collect()
    };
    quotient(STEP).iter().zip(quotient(2.0 * STEP)).map(|(near, far)| (4.0 * near - far) / 3.0).collect()
}

#[test]
fn phi_q_is_the_difference_quotient_of_phi() {
    for_each_state(|what, mechanism, y| {
        let phi_q = dense_phi_q(mechanism, TIME, &y);
        for column in 0..7 * mechanism.description().bodies.len() {
            let quotient = derivative(|step| {
                let mut y = y.clone();
                y[column] += step;
                phi(mechanism, TIME, &y)
            });
            let what = format!("{what} column {column}");
            assert_close(&what, phi_q.column(column).as_slice(), &quotient, 1.0, DIFFERENCE);
        }
    });
}

#[test]
fn phi_pi_is_half_phi_p_g_transposed() {
    for_each_state(|what, mechanism, y| {
        let (phi_q, phi_pi) = (dense_phi_q(mechanism, TIME, &y), dense_phi_pi(mechanism, TIME, &y));
        for body in 0..mechanism.description().bodies.len() {
            let [e0, e1, e2, e3] = [0, 1, 2, 3].map(|k| y[7 * body + 3 + k]);
            let g = [[-e1, e0, e3, -e2], [-e2, -e3, e0, e1], [-e3, e2, -e1, e0]];
            for row in 0..phi_pi.nrows() {
                for (k, g) in g.iter().enumerate() {
                    let expected: f64 = (0..4).map(|m| 0.5 * phi_q[(row, 7 * body + 3 + m)] * g[m]).sum();
                    assert_close(what, &[phi_pi[(row, 6 * body + 3 + k)]], &[expected], 1.0, ROUNDING);
                    assert_eq!(phi_pi[(row, 6 * body + k)], phi_q[(row, 7 * body + k)], "{what}");
                }
            }
        }
    });
}

#[test]
fn nu_is_minus_the_difference_quotient_of_phi_in_time() {
    let mut driven = 0;
    for_each_state(|what, mechanism, y| {
        let mut nu = mechanism.buffers().rows;
        mechanism.nu(TIME, &y, &mut nu);
        let phi_t = derivative(|step| phi(mechanism, TIME + step, &y));
        let expected: Vec<f64> = phi_t[..nu.len()].iter().map(|rate| -rate).collect();
        assert_close(what, &nu, &expected, 1.0, DIFFERENCE);
        driven += usize::from(nu.iter().any(|nu| *nu != 0.0));
    });
    assert!(driven > 0, "no model has a driver");
}

#[test]
fn the_velocity_residual_is_phi_pi_times_the_velocities_less_nu() {
    for_each_state(|what, mechanism, y| {
        let n = mechanism.description().bodies.len();
        let mut nu = mechanism.buffers().rows;
        mechanism.nu(TIME, &y, &mut nu);
        let v = nalgebra::DVector::from_column_slice(&y[7 * n..13 * n]);
        let expected = dense_phi_pi(mechanism, TIME, &y) * v - nalgebra::DVector::from_vec(nu);
        let residual = velocity_residual(mechanism, TIME, &y);
        assert_close(what, &residual, expected.as_slice(), 1.0, ROUNDING);
    });
}

#[test]
fn gamma_is_minus_the_change_of_the_velocity_residual_at_constant_velocities() {
    for_each_state(|what, mechanism, y| {
        let mut rate = y.clone();
        mechanism.derivative(TIME, &y, &mut rate);
        let change = derivative(|step| {
            let mut moved = y.clone();
            let n = 7 * mechanism.description().bodies.len();
            moved[..n].iter_mut().zip(&rate).for_each(|(q, rate)| *q += step * rate);
            normalise(&mut moved[..n]);
            velocity_residual(mechanism, TIME + step, &moved)
        });
        let expected: Vec<f64> = change.iter().map(|change| -change).collect();
        let mut gamma = mechanism.buffers().rows;
        mechanism.gamma(TIME, &y, &mut gamma);
        assert_close(what, &gamma, &expected, 1.0, DIFFERENCE);
    });
}
