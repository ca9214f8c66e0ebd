//! Φ_q, (Φ_r, Φ_π'), γ and forces against finite differences and against one another.

mod support;

use gyro_assembled::Careful;
use gyro_sim::{Equations, Mechanism, Ode};
use support::{Random, assert_close, dense_phi_pi, dense_phi_q, models, phi, state_near, velocity_residual};

const STATES: usize = 50;

/// Rounding of sums of a few products of order one.
const ROUNDING: f64 = 1e-13;

fn for_each_state(mut check: impl FnMut(&str, &Careful<f64>, Vec<f64>)) {
    for (seed, model) in (0..).zip(models()) {
        let mechanism = Careful::<f64>::new(&model).expect("the model has a start");
        let mut random = Random(seed);
        for state in 0..STATES {
            let y = state_near(&mechanism, 0.5, &mut random);
            check(&format!("{} state {state}", model.name), &mechanism, y);
        }
    }
}

#[test]
fn phi_q_is_the_difference_quotient_of_phi() {
    // Φ is quadratic in each coordinate, so a central difference is exact at any step.
    let step = 0.125;
    for_each_state(|what, mechanism, y| {
        let phi_q = dense_phi_q(mechanism, &y);
        for column in 0..7 * mechanism.n_bodies() {
            let at = |sign: f64| {
                let mut y = y.clone();
                y[column] += sign * step;
                phi(mechanism, &y)
            };
            let (plus, minus) = (at(1.0), at(-1.0));
            let quotient: Vec<f64> = plus.iter().zip(&minus).map(|(p, m)| (p - m) / (2.0 * step)).collect();
            let what = format!("{what} column {column}");
            assert_close(&what, phi_q.column(column).as_slice(), &quotient, 1.0, ROUNDING);
        }
    });
}

#[test]
fn phi_pi_is_half_phi_p_g_transposed() {
    for_each_state(|what, mechanism, y| {
        let (phi_q, phi_pi) = (dense_phi_q(mechanism, &y), dense_phi_pi(mechanism, &y));
        for body in 0..mechanism.n_bodies() {
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
fn the_velocity_residual_is_phi_pi_times_the_velocities() {
    for_each_state(|what, mechanism, y| {
        let n = mechanism.n_bodies();
        let v = nalgebra::DVector::from_column_slice(&y[7 * n..13 * n]);
        let product = dense_phi_pi(mechanism, &y) * v;
        assert_close(what, &velocity_residual(mechanism, &y), product.as_slice(), 1.0, ROUNDING);
    });
}

#[test]
fn gamma_is_the_change_of_the_velocity_residual_at_constant_velocities() {
    // Angular velocities reach 17 rad/s: the third derivative of a unit vector is about 5e3, the quotient's error 1e-9.
    let (step, tolerance) = (1e-6, 2e-8);
    for_each_state(|what, mechanism, y| {
        let mut rate = y.clone();
        mechanism.derivative(0.0, &y, &mut rate);
        let along = |sign: f64| {
            let mut moved = y.clone();
            let n = mechanism.n_bodies();
            moved[..7 * n].iter_mut().zip(&rate).for_each(|(q, rate)| *q += sign * step * rate);
            for q in moved[..7 * n].as_chunks_mut::<7>().0 {
                let norm = q[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
                q[3..].iter_mut().for_each(|e| *e /= norm);
            }
            velocity_residual(mechanism, &moved)
        };
        let (plus, minus) = (along(1.0), along(-1.0));
        let expected: Vec<f64> = plus.iter().zip(&minus).map(|(p, m)| -(p - m) / (2.0 * step)).collect();
        let mut gamma = mechanism.rows();
        mechanism.gamma(0.0, &y, &mut gamma);
        assert_close(what, &gamma, &expected, 1.0, tolerance);
    });
}

#[test]
fn the_work_of_friction_is_the_power_of_its_torques() {
    for_each_state(|what, mechanism, y| {
        let n = mechanism.n_bodies();
        if y.len() == 13 * n {
            return;
        }
        let mut rate = y.clone();
        mechanism.derivative(0.0, &y, &mut rate);
        let mut force = mechanism.velocities();
        mechanism.applied_force(0.0, &y, &mut force);
        // The gyroscopic torques do no work; gravity's power is the loss of potential energy.
        let power: f64 = force.iter().zip(&y[7 * n..]).map(|(force, v)| force * v).sum();
        let moved = |sign: f64| {
            let mut moved = y.clone();
            moved[..7 * n].iter_mut().zip(&rate).for_each(|(q, rate)| *q += sign * rate);
            mechanism.energy(&moved).potential
        };
        let potential_rate = (moved(1.0) - moved(-1.0)) / 2.0;
        assert!(rate[13 * n] < 0.0, "{what}");
        assert_close(what, &[rate[13 * n]], &[power + potential_rate], power.abs(), ROUNDING * 10.0);
    });
}
