//! Kane's equations against Lagrange's: the energy alone, differentiated numerically, must give the same accelerations.

use gyro_reference::{DoubleDouble, Gyroscope};

/// Difference step, s, rad or rad/s: central differences err by its square, second ones round by 1e-32 over it.
const STEP: f64 = 2e-9;

/// Relative to the largest term. Truncation is worth STEP² times the square of 100 rad/s times some ten; rounding,
/// where the terms are a hundredth of the energy, 1e-30 / STEP².
const RESIDUAL: f64 = 1e-11;

type Vector = [DoubleDouble; 3];

/// Angles (rad) and rates (rad/s): generic, at rest but for the spin, and near the inner ring's upright position.
const STATES: [([f64; 3], [f64; 3]); 4] = [
    ([0.3, -0.4, 1.1], [2.0, -3.0, 100.0]),
    ([0.0, 0.0, 0.0], [0.0, 0.0, 100.0]),
    ([-2.0, 1.57, -40.0], [-5.0, 4.0, 30.0]),
    ([1.0, 0.9, 2.5], [-50.0, 70.0, -20.0]),
];

/// No two parameters alike and none zero, so that each term of the equations counts.
fn unsymmetric() -> Gyroscope {
    let numbers = |texts: [&str; 3]| texts.map(|text| text.parse().expect("a decimal"));
    Gyroscope {
        inertia: [
            numbers(["20e-7", "11e-7", "10e-7"]),
            numbers(["10e-7", "21e-7", "13e-7"]),
            numbers(["100e-7", "57e-7", "49e-7"]),
        ],
        ring_offset: numbers(["0.0125", "0.005", "-0.003"]),
        rotor_offset: numbers(["0.01", "0.002", "-0.015"]),
        gravity: numbers(["1.5", "-9.1", "3.3"]),
        friction: numbers(["1e-6", "2e-5", "3e-4"]),
        ..Gyroscope::combined_offsets()
    }
}

fn shifted(v: Vector, index: usize, by: f64) -> Vector {
    let mut shifted = v;
    shifted[index] = v[index] + DoubleDouble::new(by);
    shifted
}

/// `v` moved along `direction` for `STEP` forwards or backwards (`sign`).
fn along(v: Vector, direction: Vector, sign: f64) -> Vector {
    std::array::from_fn(|i| v[i] + direction[i] * DoubleDouble::new(sign * STEP))
}

/// T − V, from the energy E = T + V and its value at rest, V.
fn lagrangian(gyroscope: &Gyroscope, angles: Vector, rates: Vector) -> DoubleDouble {
    let potential = gyroscope.energy(angles, [DoubleDouble::ZERO; 3]);
    gyroscope.energy(angles, rates) - potential - potential
}

fn central(upper: DoubleDouble, lower: DoubleDouble) -> DoubleDouble {
    (upper - lower).divided_by(2.0 * STEP)
}

/// ∂L/∂q̇ᵢ.
fn momentum(gyroscope: &Gyroscope, angles: Vector, rates: Vector, index: usize) -> DoubleDouble {
    let at = |by| lagrangian(gyroscope, angles, shifted(rates, index, by));
    central(at(STEP), at(-STEP))
}

/// d/dt ∂L/∂q̇ᵢ, ∂L/∂qᵢ and the friction, whose balance is Lagrange's equation.
fn terms(gyroscope: &Gyroscope, angles: Vector, rates: Vector, index: usize) -> [f64; 3] {
    let accelerations = gyroscope.accelerations(angles, rates);
    let later =
        |sign| momentum(gyroscope, along(angles, rates, sign), along(rates, accelerations, sign), index);
    let at = |by| lagrangian(gyroscope, shifted(angles, index, by), rates);
    let friction = gyroscope.friction[index] * rates[index];
    [central(later(1.0), later(-1.0)), central(at(STEP), at(-STEP)), friction].map(DoubleDouble::to_f64)
}

#[test]
fn accelerations_satisfy_lagrange() {
    let gyroscope = unsymmetric();
    for (angles, rates) in STATES {
        for index in 0..3 {
            let parts = terms(&gyroscope, angles.map(DoubleDouble::new), rates.map(DoubleDouble::new), index);
            let [change, slope, friction] = parts;
            let largest = parts.iter().fold(1e-12, |largest: f64, part| largest.max(part.abs()));
            let residual = (change - slope + friction).abs() / largest;
            assert!(
                residual < RESIDUAL,
                "{angles:?} {rates:?}, coordinate {index}: {residual:e} of {parts:?}"
            );
        }
    }
}

/// The potential is a formula of its own: −m g·r with the rotor centre where the joints put it.
#[test]
fn energy_at_rest_is_the_potential_of_the_rotor() {
    let zero = DoubleDouble::ZERO;
    let quarter = "1.5707963267948966192313216916397514".parse().unwrap();
    let gyroscope = unsymmetric();
    // A quarter turn about z takes (x, y, z) to (-y, x, z), about y to (z, y, -x), about x to (x, -z, y): by hand,
    // s2' = (a, b, c) becomes (c, a, b) and s3' = (d, e, f) becomes (e, d, -f).
    let (ring, rotor, g) = (gyroscope.ring_offset, gyroscope.rotor_offset, gyroscope.gravity);
    let centre = [ring[2] - rotor[1], ring[0] - rotor[0], ring[1] + rotor[2]];
    let expected = -gyroscope.mass[2] * (g[0] * centre[0] + g[1] * centre[1] + g[2] * centre[2]);
    let found = gyroscope.energy([quarter; 3], [zero; 3]);
    assert!((found - expected).to_f64().abs() < 1e-32, "{found:?} {expected:?}");
}

/// The plain `f64` right-hand side is the precise one, rounded.
#[test]
fn f64_accelerations_are_the_precise_ones() {
    /// Rounding, times the condition of a 3×3 mass matrix.
    const RELATIVE: f64 = 1e-12;
    let gyroscope = unsymmetric();
    for (angles, rates) in STATES {
        let precise = gyroscope.accelerations(angles.map(DoubleDouble::new), rates.map(DoubleDouble::new));
        let plain = gyroscope.rounded().accelerations(angles, rates);
        let largest = plain.iter().fold(0.0, |largest: f64, a| largest.max(a.abs()));
        for (precise, plain) in precise.iter().zip(plain) {
            assert!((precise.to_f64() - plain).abs() < RELATIVE * largest, "{angles:?}: {plain}");
        }
    }
}
