//! Φ_q, (Φ_r, Φ_π') and γ of every generated mechanism against differences of Φ along lines.
//!
//! Along a line Φ is a polynomial of at most the fourth degree (each body's Euler parameters enter squared, at most two
//! bodies in a product), and so is the velocity residual at constant velocities. The five-point formula is exact for
//! those at any step: the tolerance below is for rounding alone. Angles that something acts on and prescribed motions
//! are not polynomials; there the step is small and the formula's own error allowed for.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::Model;
use gyro_sim::{Coordinate, Kinematics, Mechanism};
use gyro_sim_suite::{
    Engine, Random, careful, dense, difference, for_each_generated, generated, model, phi_pi, phi_q, state,
};

const STATES: usize = 100;

/// Angular velocities, rad/s.
const RATE: f64 = 10.0;

/// The five-point formula adds four values of order one and divides by a step of a quarter.
const ROUNDING: f64 = 1e-12;

/// Steps along a line of unit length, and what is allowed.
struct Line {
    step: f64,
    tolerance: f64,
}

/// Polynomials.
const EXACT: Line = Line { step: 0.25, tolerance: ROUNDING };

/// Anything smooth: the formula's error is the fourth power of the step times a fifth derivative of order a hundred,
/// the rounding 1e-16 over the step.
const SMOOTH: Line = Line { step: 5e-4, tolerance: 1e-9 };

/// The same where what is prescribed shakes ten times as fast as elsewhere: at 126 rad/s.
const SHAKEN: Line = Line { step: 5e-5, tolerance: 1e-9 };

/// The least length of (sine, cosine) of the angles between axes that are not parallel: an angle's derivatives grow
/// with the powers of its inverse, and at zero there is no angle.
const DEFINED: f64 = 0.7;

/// Time, s.
const T: f64 = 0.37;

fn line(model: &Model) -> Line {
    if model.name == "gyroscope_rolling_base" {
        return SHAKEN;
    }
    if model.is_driven() || !model.turn_references().is_empty() { SMOOTH } else { EXACT }
}

/// A random state; where angles are acted on, one in which all of them are well defined.
fn drawn(mechanism: &Engine, model: &Model, random: &mut Random) -> Vec<f64> {
    loop {
        let values = state(mechanism, RATE, random);
        if model.turn_references().is_empty() || least_angle(mechanism, &values) >= DEFINED {
            return values;
        }
    }
}

/// The least length of (sine, cosine) of all angles.
fn least_angle(mechanism: &Engine, values: &[f64]) -> f64 {
    let mut readings = mechanism.buffers().readings;
    mechanism.read_joints(T, &values.to_vec(), &mut readings);
    let joints = (0..mechanism.description().joints.len())
        .flat_map(|joint| mechanism.description().joints[joint].coordinates);
    let (mut least, mut at) = (f64::INFINITY, 0);
    for coordinate in joints {
        if *coordinate == Coordinate::Angle {
            least = least.min(f64::hypot(readings[at], readings[at + 1]));
        }
        at += coordinate.n_readings();
    }
    least
}

/// The derivative at zero of a polynomial of the fourth degree, and the same divided by the largest value met.
fn derivative(step: f64, mut f: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * step));
    (0..a.len()).map(|k| (a[k] - d[k] + 8.0 * (c[k] - b[k])) / (12.0 * step)).collect()
}

fn moved(values: &[f64], direction: &[f64], by: f64) -> Vec<f64> {
    let moved = values.iter().zip(direction).map(|(x, d)| x + by * d);
    moved.chain(values[direction.len()..].iter().copied()).collect()
}

fn phi(mechanism: &Engine, t: f64, values: &[f64]) -> Vec<f64> {
    let mut out = mechanism.buffers().constraints;
    mechanism.phi(t, &values.to_vec(), &mut out);
    out
}

fn velocity_residual(mechanism: &Engine, t: f64, values: &[f64]) -> Vec<f64> {
    let mut out = mechanism.buffers().rows;
    mechanism.velocity_residual(t, &values.to_vec(), &mut out);
    out
}

fn gamma(mechanism: &Engine, values: &[f64]) -> Vec<f64> {
    let mut out = mechanism.buffers().rows;
    mechanism.gamma(T, &values.to_vec(), &mut out);
    out
}

/// q̇ = (s, ½ G(p)ᵀ w'), eq. (14), body after body.
fn q_dot(values: &[f64], n_bodies: usize) -> Vec<f64> {
    let (positions, velocities) = values.split_at(7 * n_bodies);
    let bodies = positions.as_chunks::<7>().0.iter().zip(velocities.as_chunks::<6>().0);
    let of_body = |(q, v): (&[f64; 7], &[f64; 6])| {
        let ([_, _, _, e0, e1, e2, e3], [sx, sy, sz, x, y, z]) = (*q, *v);
        let p_dot = [
            -e1 * x - e2 * y - e3 * z,
            e0 * x - e3 * y + e2 * z,
            e3 * x + e0 * y - e1 * z,
            e1 * y - e2 * x + e0 * z,
        ];
        [sx, sy, sz, p_dot[0] / 2.0, p_dot[1] / 2.0, p_dot[2] / 2.0, p_dot[3] / 2.0]
    };
    bodies.flat_map(of_body).collect()
}

/// ν.
fn nu(mechanism: &Engine, values: &[f64]) -> Vec<f64> {
    let mut out = mechanism.buffers().rows;
    mechanism.nu(T, &values.to_vec(), &mut out);
    out
}

/// The three comparisons at a state, each as the difference relative to its largest value.
fn errors(mechanism: &Engine, line: &Line, values: &[f64]) -> [f64; 3] {
    let (y, n_bodies) = (values.to_vec(), mechanism.description().bodies.len());
    let jacobian = phi_q(mechanism, T, &y);
    let in_column = |column: usize| {
        let mut direction = vec![0.0; 7 * n_bodies];
        direction[column] = 1.0;
        let slope = derivative(line.step, |by| phi(mechanism, T, &moved(values, &direction, by)));
        let analytic: Vec<f64> = jacobian.rows.iter().map(|row| row[column]).collect();
        difference(&slope, &analytic, 1.0)
    };
    let direction = q_dot(values, n_bodies);
    let step = line.step / direction.iter().map(|x| x.abs()).fold(1.0, f64::max);
    let n_rows = mechanism.buffers().rows.len();
    // The motion of a moment, time included.
    let phi_dot =
        derivative(step, |by| phi(mechanism, T + by, &moved(values, &direction, by))[..n_rows].to_vec());
    let product = phi_pi(mechanism, T, &y).times(&values[7 * n_bodies..13 * n_bodies]);
    let product: Vec<f64> = product.iter().zip(nu(mechanism, values)).map(|(a, nu)| a - nu).collect();
    let change = derivative(step, |by| velocity_residual(mechanism, T + by, &moved(values, &direction, by)));
    let minus_gamma: Vec<f64> = gamma(mechanism, values).iter().map(|x| -x).collect();
    [
        (0..7 * n_bodies).map(in_column).fold(0.0, f64::max),
        difference(&phi_dot, &product, RATE).max(difference(
            &velocity_residual(mechanism, T, values),
            &product,
            RATE,
        )),
        difference(&change, &minus_gamma, RATE * RATE),
    ]
}

/// The worst of all states of a mechanism.
fn check(page: &str, mechanism: &Engine) {
    let (mut random, model) = (Random::new(11), model(page));
    let line = line(&model);
    let mut worst = [0.0; 3];
    for index in 0..STATES {
        let values = drawn(mechanism, &model, &mut random);
        let errors = errors(mechanism, &line, &values);
        let exact = errors.iter().all(|error| *error <= line.tolerance);
        assert!(exact, "{page}, state {index}: Φ_q, Φ_π' v, γ off by {errors:?} at {values:?}");
        worst = std::array::from_fn(|k| errors[k].max(worst[k]));
    }
    println!("{page}: Φ_q, Φ_π' v, γ: {worst:?}");
}

#[test]
fn generated_derivatives_are_those_of_phi() {
    for_each_generated(check);
}

#[test]
fn the_derivatives_of_both_twins_are_those_of_phi() {
    for page in ["gyroscope-maximal", "gyroscope-combined-offsets", "heavy-top"] {
        check(page, &careful(&model(page)));
        check(page, &dense(&model(page)));
    }
}

#[test]
fn off_the_unit_sphere_the_velocities_are_another_matter() {
    // The check must be able to fail. Besides, it states a convention: w' and π' belong to unit Euler parameters.
    let mechanism = generated("gyroscope-combined-offsets");
    let mut values = state(&mechanism, RATE, &mut Random::new(11));
    values[3..7].iter_mut().for_each(|e| *e *= 1.0 + 1e-6);
    let [of_phi_q, of_velocity, of_gamma] = errors(&mechanism, &EXACT, &values);
    assert!(of_phi_q <= ROUNDING, "{of_phi_q:e}");
    assert!(of_velocity.max(of_gamma) > 1e3 * ROUNDING, "{of_velocity:e} {of_gamma:e}");
}
