//! The bearings of the paper's gyroscope by hand: Newton's and Euler's laws for rotor, inner ring and outer
//! ring, in components.
//!
//! The motion is that of Kane's equations; what the chain's recursion says of the bearings must be what the
//! laws say.

use gyro_reference::{Gyroscope, moving_base};

/// Rounding of the `f64` motion, relative to 1 N, and to the rotor's momentum of 1e-3 N·m·s turned at some
/// rad/s.
const FORCE: f64 = 1e-14;
const TORQUE: f64 = 1e-16;

/// The rotor's moments of inertia along and across its axis, the inner ring's along y and across it, the
/// outer ring's about y.
const ROTOR: [f64; 2] = [100e-7, 50e-7];
const INNER: [f64; 2] = [20e-7, 10e-7];
const OUTER: f64 = 10e-7;

const ROTOR_MASS: f64 = 0.08;
const RING_MASS: f64 = 0.01;
const OFFSET: f64 = 0.000125;
const GRAVITY: f64 = 10.0;

type Vector = [f64; 3];

/// Angles with their first and second derivatives.
struct Motion {
    beta: f64,
    rates: Vector,
    accelerations: Vector,
}

fn motion(t: f64) -> Motion {
    let gyroscope = Gyroscope::paper();
    let [_, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, _] = gyroscope.solve(&[t])[0].values();
    let rates = [alpha_rate, beta_rate, phi_rate];
    Motion { beta, rates, accelerations: gyroscope.rounded().accelerations([alpha, beta, phi], rates) }
}

/// Force and torque of the bearing of φ on the rotor, in the inner ring's frame.
///
/// There the ring turns at ω = (a, b, c) = (α̇ sin β, α̇ cos β, β̇); the rotor's momentum is H = (C (a + φ̇),
/// A b, A c), its rate Ḣ + ω × H; its centre is at (d, 0, 0) and accelerates at d (−b² − c², a b + ċ, a c −
/// ḃ); gravity is −g (sin β, cos β, 0).
fn on_rotor(motion: &Motion) -> (Vector, Vector) {
    let ([alpha, beta, phi], [alpha2, beta2, phi2]) = (motion.rates, motion.accelerations);
    let (sin, cos) = motion.beta.sin_cos();
    let [a, b, c] = [alpha * sin, alpha * cos, beta];
    let [a2, b2, c2] = [alpha2 * sin + alpha * beta * cos, alpha2 * cos - alpha * beta * sin, beta2];
    let acceleration = [-b * b - c * c, a * b + c2, a * c - b2].map(|x| OFFSET * x);
    let up = [GRAVITY * sin, GRAVITY * cos, 0.0];
    let force = std::array::from_fn(|k| ROTOR_MASS * (acceleration[k] + up[k]));

    let [along, across] = ROTOR;
    let [x, y, z] = [along * (a + phi), across * b, across * c];
    let change = [along * (a2 + phi2), across * b2, across * c2];
    (force, [change[0] + b * z - c * y, change[1] + c * x - a * z, change[2] + a * y - b * x])
}

/// Force and torque of the bearing of β on the inner ring about its centre, in the outer ring's frame.
fn on_inner_ring(motion: &Motion) -> (Vector, Vector) {
    let ([alpha, beta, _], [alpha2, beta2, _]) = (motion.rates, motion.accelerations);
    let (sin, cos) = motion.beta.sin_cos();
    let [a, b, c] = [alpha * sin, alpha * cos, beta];
    let [a2, b2] = [alpha2 * sin + alpha * beta * cos, alpha2 * cos - alpha * beta * sin];
    let [along, across] = INNER;
    let [x, y, z] = [across * a, along * b, across * c];
    let ring = [across * a2 + b * z - c * y, along * b2 + c * x - a * z, across * beta2 + a * y - b * x];
    let (force, torque) = on_rotor(motion);
    // The rotor's force acts at (d, 0, 0): d x × F = d (0, −Fz, Fy).
    let total = [
        ring[0] + torque[0],
        ring[1] + torque[1] - OFFSET * force[2],
        ring[2] + torque[2] + OFFSET * force[1],
    ];
    let turned = |v: Vector| [cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]];
    let [fx, fy, fz] = turned(force);
    ([fx, fy + RING_MASS * GRAVITY, fz], turned(total))
}

/// Force and torque of the bearing of α on the outer ring, in the outer ring's frame: it turns steadily but
/// for α̈ about y.
fn on_outer_ring(motion: &Motion) -> (Vector, Vector) {
    let ([fx, fy, fz], [x, y, z]) = on_inner_ring(motion);
    ([fx, fy + RING_MASS * GRAVITY, fz], [x, y + OUTER * motion.accelerations[0], z])
}

/// A cyclic change of components: those along f, g, h of a joint from x, y, z.
fn along([f, g, h]: [usize; 3], (force, torque): (Vector, Vector)) -> [f64; 6] {
    [force[f], force[g], force[h], torque[f], torque[g], torque[h]]
}

fn assert_near(found: [f64; 6], expected: [f64; 6], what: &str) {
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        let tolerance = if k < 3 { FORCE } else { TORQUE };
        assert!((found - expected).abs() < tolerance, "{what}, component {k}: {found} but {expected}");
    }
}

#[test]
fn bearings_carry_what_newton_and_euler_say() {
    for t in [0.005, 0.02, 0.4, 1.0] {
        let motion = motion(t);
        let sample = &moving_base::resting().solve(&[t])[0];
        let [alpha, beta, phi] = moving_base::bearing_reactions(sample);
        // The base's frame is the outer ring's turned back by α about y, the h of α.
        let (sin, cos) = sample.positions[0].sin_cos();
        let back = |[x, y, z]: Vector| [cos * x + sin * z, y, cos * z - sin * x];
        let (force, torque) = on_outer_ring(&motion);
        assert_near(phi, along([1, 2, 0], on_rotor(&motion)), "phi");
        assert_near(beta, along([0, 1, 2], on_inner_ring(&motion)), "beta");
        assert_near(alpha, along([2, 0, 1], (back(force), back(torque))), "alpha");
        // And no bearing turns what it lets turn.
        assert!([alpha, beta, phi].iter().all(|reaction| reaction[5].abs() < 1e-30));
    }
}
