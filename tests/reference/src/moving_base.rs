//! The paper's gyroscope on a base that rolls and pitches about the common centre of the rings; and a camera on
//! a gimbal whose base rolls and yaws.
//!
//! The base has A = Rx(roll) Rz(pitch), roll about the global x axis and pitch about the z axis that the roll
//! has turned, each `amplitude · sin(2π · frequency · t)`. On it α, β and φ follow as in the [crate]'s
//! table: A1 = A Ry(α), A2 = A1 Rz(β), A3 = A2 Rx(φ). The equations are Newton's and Euler's along the
//! [`Chain`], apart from Kane's in [`Gyroscope`](crate::Gyroscope), whose motion a base at rest reproduces.
//!
//! ```
//! use gyro_reference::moving_base;
//!
//! let sample = &moving_base::rolling().solve(&[0.1])[0];
//! let [alpha, beta, phi] = sample.positions;
//! assert!(alpha.abs() < 0.1 && beta.abs() < 0.2 && (phi - 10.0).abs() < 0.1);
//! ```

use core::f64::consts::{FRAC_PI_3, PI, TAU};

use crate::{BaseMotion, Chain, ChainSample, Link, Sinusoid};

/// Zero direction f and axis h of the joints α, β and φ, each in the frame of the body before it.
const JOINT_FRAMES: [([f64; 3], [f64; 3]); 3] = [
    ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0]),
    ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]),
    ([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]),
];

/// The paper's first scene as a chain of outer ring, inner ring and rotor: rings at rest in the base, φ̇ =
/// 100 rad/s.
///
/// Set `links[k].rate` for other rates: α̇, β̇ and φ̇ count from the part that carries the axis.
#[must_use]
pub fn resting() -> Chain<3> {
    let rotor = Link { before: [0.000125, 0.0, 0.0], rate: 100.0, ..Link::turning([1.0, 0.0, 0.0]) };
    Chain {
        gravity: [0.0, -10.0, 0.0],
        base: BaseMotion::default(),
        links: [
            Link::turning([0.0, 1.0, 0.0]).with_body(0.010, [20e-7, 10e-7, 10e-7]),
            Link::turning([0.0, 0.0, 1.0]).with_body(0.010, [10e-7, 20e-7, 10e-7]),
            rotor.with_body(0.080, [100e-7, 50e-7, 50e-7]),
        ],
    }
}

/// [`resting`] on a base that rolls 0.1 sin(2π·2 t) rad about the global x axis.
#[must_use]
pub fn rolling() -> Chain<3> {
    Chain { base: BaseMotion::turning(vec![roll()]), ..resting() }
}

/// [`rolling`], and pitching 0.05 sin(2π·3 t) rad about the rolled z axis.
#[must_use]
pub fn rolling_and_pitching() -> Chain<3> {
    let pitch = Sinusoid { amplitude: 0.05, angular_frequency: 3.0 * TAU, phase: 0.0 };
    Chain { base: BaseMotion::turning(vec![roll(), ([0.0, 0.0, 1.0], pitch)]), ..resting() }
}

/// [`resting`] on a base that rolls 0.5 sin(2π·20 t) rad about the global x axis: at up to 63 rad/s, and as
/// often as the rotor and the nutation go round, or nearly so.
#[must_use]
pub fn rolling_fast() -> Chain<3> {
    let roll = Sinusoid { amplitude: 0.5, angular_frequency: 20.0 * TAU, phase: 0.0 };
    Chain { base: BaseMotion::turning(vec![([1.0, 0.0, 0.0], roll)]), ..resting() }
}

/// A camera on the tilt axis of a yoke that pans, on a base that rolls 0.15 sin(2π·0.5 t) rad about the global
/// x axis and yaws 0.05 sin(2π·1.3 t) rad about the rolled z axis: without motors, friction and stops.
#[must_use]
pub fn loose_camera() -> Chain<2> {
    let wave = |amplitude, hertz| Sinusoid { amplitude, angular_frequency: hertz * TAU, phase: 0.0 };
    let pan = Link {
        before: [0.0, 0.0, 0.1],
        own: [0.0, 0.0, -0.08],
        start: FRAC_PI_3,
        ..Link::turning([0.0, 0.0, 1.0])
    };
    let tilt = Link {
        before: [0.0, 0.0, 0.05],
        own: [-1e-3, 0.0, 0.0],
        start: PI / 18.0,
        ..Link::turning([0.0, 1.0, 0.0])
    };
    Chain {
        gravity: [0.0, 0.0, -9.81],
        base: BaseMotion::turning(vec![
            ([1.0, 0.0, 0.0], wave(0.15, 0.5)),
            ([0.0, 0.0, 1.0], wave(0.05, 1.3)),
        ]),
        links: [pan.with_body(1.5, [5e-3, 4e-3, 4e-3]), tilt.with_body(2.0, [4e-3, 6e-3, 6e-3])],
    }
}

/// What the bearings of α, β and φ exert on outer ring, inner ring and rotor: force (N) along f, g and h of
/// the joint's frame on the body before it, then torque (N·m) about the joint point of the body after it. f
/// is z for α, x for β and y for φ.
#[must_use]
pub fn bearing_reactions(sample: &ChainSample<3>) -> [[f64; 6]; 3] {
    core::array::from_fn(|k| {
        let (f, h) = JOINT_FRAMES[k];
        sample.reactions[k].in_joint_frame(f, h)
    })
}

fn roll() -> ([f64; 3], Sinusoid) {
    ([1.0, 0.0, 0.0], Sinusoid { amplitude: 0.1, angular_frequency: 2.0 * TAU, phase: 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand at the start: the rotor's centre falls at β̈ d, β̈ = −m g d / I_β, so its bearing carries m (g
    /// − |β̈| d); the rings' own weight comes on top in the others. Gyroscopic torques need ring rates, which
    /// are zero.
    #[test]
    fn bearings_carry_the_weight_at_the_start() {
        let sample = &resting().solve(&[0.0])[0];
        let [alpha, beta, phi] = bearing_reactions(sample);
        let acceleration = 1e-4 / 6.00125e-6;
        let carried = 0.08 * (10.0 - acceleration * 0.000125);
        // y is h of α, g of β and f of φ.
        let forces = [alpha[2] - 0.2, beta[1] - 0.1, phi[0]];
        assert!(forces.iter().all(|force| (force - carried).abs() < 1e-15), "{forces:?}");
        // The rotor's bearing turns it about z, its h being x: g of φ is z.
        assert!((phi[4] + 5e-6 * acceleration).abs() < 1e-18, "{phi:?}");
        // The pin of β lets the inner ring fall: no torque about z, its h.
        assert!(beta[5].abs() < 1e-30);
    }
}
