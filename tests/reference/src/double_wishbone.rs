//! The double wishbone of `models/double-wishbone.toml` in two coordinates: the chassis' height and the angle of the
//! lower arm.
//!
//! Two angles close it, each where a circle meets a sphere: the upper ball joint turns about the upper hinge at the
//! kingpin's length from the lower ball joint, the outer end of the tie rod about the kingpin at the rod's length from
//! its inner end.

use crate::closing::{Side, direction, fixed, point, sine_and_cosine};
use crate::kane::{Mechanism, Placed, Scene, Strut, carried, derivative, global, moving, turned};
use crate::rotation::Precise;
use crate::time_jet::{Jet, unit};
use crate::trajectory::{decimal, decimals, smooth_trajectory};
use crate::vector::{Vector, add, cross, dot, scale, sub};
use crate::{DoubleDouble, JointRow};

/// A quarter of a car on a double wishbone, with the numbers of its model file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleWishbone {
    /// Stiffness of the spring on the lower arm, N/m.
    pub stiffness: f64,
    /// Its damper, N·s/m.
    pub damping: f64,
    /// Damping of the tyre, N·s/m.
    pub tyre_damping: f64,
    /// Height of the chassis above the design pose at time zero, m.
    pub height: f64,
    /// Angle of the lower arm at time zero, rad.
    pub angle: f64,
}

/// What a [`DoubleWishbone`] does at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WishboneInstant {
    /// Position, rate and acceleration of chassis, lower arm and upper arm.
    pub joints: [[f64; 3]; 3],
    /// The upright's mass centre, m.
    pub wheel: [f64; 3],
    /// Kinetic energy and potential of gravity, spring and tyre, J.
    pub energy: f64,
}

const LOWER_AXIS: [f64; 3] = [20.0, 0.0, 1.0];
const UPPER_AXIS: [f64; 3] = [20.0, 0.0, -1.0];

/// The upright's points, in its frame.
const LOWER_BALL: [f64; 3] = [0.0, -0.01, -0.12];
const UPPER_BALL: [f64; 3] = [-0.025, -0.06, 0.2];
const TIE_END: [f64; 3] = [-0.12, -0.04, -0.06];
const TIE_LENGTH: f64 = 0.32031234756;

impl Default for DoubleWishbone {
    fn default() -> Self {
        Self { stiffness: 60000.0, damping: 3000.0, tyre_damping: 100.0, height: 0.05, angle: -0.14 }
    }
}

/// A frame with its origin.
#[derive(Clone, Copy, Debug)]
struct Frame {
    origin: Vector<Jet>,
    axes: [Vector<Jet>; 3],
}

impl Frame {
    fn at(&self, p: [f64; 3]) -> Vector<Jet> {
        add(self.origin, carried(&self.axes, point(p)))
    }

    /// A frame with these axes of which a point is where another one is.
    fn through(at: Vector<Jet>, axes: [Vector<Jet>; 3], own: [f64; 3]) -> Self {
        Frame { origin: sub(at, carried(&axes, point(own))), axes }
    }

    fn body(&self, mass: f64, [xx, yy, zz]: [f64; 3]) -> Placed {
        let inertia = decimals([xx, yy, zz, 0.0, 0.0, 0.0]);
        Placed { mass: decimal(mass), inertia, centre: self.origin, axes: self.axes }
    }
}

impl DoubleWishbone {
    /// The joints of the model file at `times` (s, ascending from zero; each the decimal it prints as), rounded once.
    ///
    /// # Panics
    /// If the times do not ascend, or the arms come to where they cannot close.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<JointRow> {
        let start = [decimal(self.height), decimal(self.angle), DoubleDouble::ZERO, DoubleDouble::ZERO];
        let motion = smooth_trajectory(|t, state| derivative::<2, 2, 4>(self, t, state), start, times);
        motion.iter().map(|(t, state)| moving::<2, 2, 4>(self, *t, state).row(*t)).collect()
    }

    /// The mechanism at a height, an angle and their rates, as it moves on from there.
    #[must_use]
    pub fn instant(&self, state: [f64; 4]) -> WishboneInstant {
        let scene = moving::<2, 2, 4>(self, DoubleDouble::ZERO, &state.map(decimal));
        let joint = |k: usize| {
            let Jet { value, rate, second } = scene.joints[k];
            [value, rate, second].map(DoubleDouble::to_f64)
        };
        WishboneInstant {
            joints: [joint(0), joint(1), joint(2)],
            wheel: scene.bodies[3].centre.map(|x| x.value.to_f64()),
            energy: scene.energy(Mechanism::<2, 2>::gravity(self)).to_f64(),
        }
    }

    /// Kinetic energy and potential of gravity, spring and tyre along the same motion, J.
    #[must_use]
    pub fn energies(&self, times: &[f64]) -> Vec<f64> {
        let start = [decimal(self.height), decimal(self.angle), DoubleDouble::ZERO, DoubleDouble::ZERO];
        let motion = smooth_trajectory(|t, state| derivative::<2, 2, 4>(self, t, state), start, times);
        let energy = |(t, state): &(DoubleDouble, [DoubleDouble; 4])| {
            moving::<2, 2, 4>(self, *t, state).energy(Mechanism::<2, 2>::gravity(self)).to_f64()
        };
        motion.iter().map(energy).collect()
    }
}

/// The upper arm: its ball joint at a distance from the lower one. Its angle and frame.
fn upper_arm(chassis: &Frame, lower_ball: Vector<Jet>) -> (Jet, Frame) {
    let (hinge, axis) = (chassis.at([-0.02, 0.45, -0.02]), direction(UPPER_AXIS));
    let (h, arm) = (axis.map(Jet::constant), point([-0.005, 0.25, 0.02]));
    let [kingpin, along] = [sub(point(UPPER_BALL), point(LOWER_BALL)), scale(dot(h, arm), h)];
    let (way, across, side) = (add(sub(hinge, lower_ball), along), sub(arm, along), cross(h, arm));
    let half = (dot(kingpin, kingpin) - dot(way, way) - dot(across, across)) * Jet::from(0.5);
    let (sin, cos) = sine_and_cosine([dot(way, across), dot(way, side), half], Side::Rising);
    let angle = sin.atan2(cos);
    (angle, Frame::through(hinge, turned(chassis.axes, axis, angle), [0.0, -0.13, -0.01]))
}

/// The upright on its ball joints, steered by the tie rod.
fn upright(chassis: &Frame, [lower, upper]: [Vector<Jet>; 2]) -> Frame {
    let own = |p: [f64; 3]| sub(point(p), point(LOWER_BALL));
    // The same triad on the upright and in space: along the kingpin, across it towards the tie rod's end, and across.
    let b1 = unit(own(UPPER_BALL));
    let reach = dot(own(TIE_END), b1);
    let off = sub(own(TIE_END), scale(reach, b1));
    let (radius, b2) = (dot(off, off).sqrt(), unit(off));
    let g1 = unit(sub(upper, lower));
    let left = point([0.0, 1.0, 0.0]);
    let n1 = unit(sub(left, scale(dot(left, g1), g1)));
    let n2 = cross(g1, n1);
    let way = sub(add(lower, scale(reach, g1)), chassis.at([-0.13, 0.4, -0.25]));
    let length = fixed(TIE_LENGTH);
    let half = (length * length - dot(way, way) - radius * radius) * Jet::from(0.5);
    let (sin, cos) = sine_and_cosine([radius * dot(way, n1), radius * dot(way, n2), half], Side::Falling);
    let g2 = add(scale(cos, n1), scale(sin, n2));
    let (b, g) = ([b1, b2, cross(b1, b2)], [g1, g2, cross(g1, g2)]);
    let axes =
        core::array::from_fn(|k| add(scale(b[0][k], g[0]), add(scale(b[1][k], g[1]), scale(b[2][k], g[2]))));
    Frame::through(lower, axes, LOWER_BALL)
}

impl Mechanism<2, 2> for DoubleWishbone {
    fn gravity(&self) -> Precise {
        decimals([0.0, 0.0, -9.81])
    }

    fn rates(&self, _: &[DoubleDouble; 2], speeds: [DoubleDouble; 2]) -> [DoubleDouble; 2] {
        speeds
    }

    fn place(&self, _: Jet, q: &[DoubleDouble; 2], v: [DoubleDouble; 2], a: [DoubleDouble; 2]) -> Scene {
        let [height, angle] = [0, 1].map(|k| Jet::new(q[k], v[k], a[k]));
        let mut origin = point([0.0, 0.0, 0.5]);
        origin[2] = origin[2] + height;
        let chassis = Frame { origin, axes: global() };
        let lower_axes = turned(chassis.axes, direction(LOWER_AXIS), angle);
        let lower = Frame::through(chassis.at([0.0, 0.4, -0.3]), lower_axes, [-0.01, -0.18, 0.01]);
        let lower_ball = lower.at([-0.01, 0.17, -0.01]);
        let (upper_angle, upper) = upper_arm(&chassis, lower_ball);
        let upright = upright(&chassis, [lower_ball, upper.at([-0.005, 0.12, 0.01])]);
        let strut = |ends, [stiffness, damping, free]: [f64; 3]| Strut {
            ends,
            stiffness: decimal(stiffness),
            damping: decimal(damping),
            free: decimal(free),
        };
        Scene {
            bodies: vec![
                chassis.body(320.0, [40.0, 60.0, 70.0]),
                lower.body(6.0, [0.08, 0.06, 0.13]),
                upper.body(3.0, [0.025, 0.02, 0.04]),
                upright.body(32.0, [0.8, 1.1, 0.8]),
            ],
            struts: vec![
                strut(
                    [lower.at([-0.01, 0.04, 0.01]), chassis.at([0.02, 0.48, 0.08])],
                    [self.stiffness, self.damping, 0.49],
                ),
                strut(
                    [point([0.0, 0.78, 0.0]), upright.at([0.0, 0.02, 0.0])],
                    [200000.0, self.tyre_damping, 0.32],
                ),
            ],
            joints: vec![height, angle, upper_angle],
            balls: vec![[lower.axes, upright.axes], [upper.axes, upright.axes]],
            ..Scene::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(height: f64, angle: f64) -> Scene {
        let zero = [DoubleDouble::ZERO; 2];
        let wishbone = DoubleWishbone::default();
        wishbone.place(Jet::from(0.0), &[decimal(height), decimal(angle)], zero, zero)
    }

    #[test]
    fn the_design_pose_is_where_the_points_were_chosen() {
        let scene = scene(0.0, 0.0);
        assert!(scene.joints[2].value.to_f64().abs() < 1e-30);
        // The tie rod's length is rounded to eleven digits.
        let [x, y, z] = scene.bodies[3].centre.map(|x| x.value.to_f64());
        assert!((x.abs() + (y - 0.76).abs() + (z - 0.3).abs()) < 1e-10, "{x} {y} {z}");
    }

    #[test]
    fn all_lengths_are_kept_away_from_the_design_pose() {
        let scene = scene(0.05, -0.3);
        let [_, lower, upper, upright] = [0, 1, 2, 3].map(|k| scene.bodies[k]);
        let at = |body: Placed, p: [f64; 3]| add(body.centre, carried(&body.axes, point(p)));
        let gap = |a: Vector<Jet>, b: Vector<Jet>| dot(sub(a, b), sub(a, b)).value.to_f64().abs().sqrt();
        assert!(gap(at(lower, [-0.01, 0.17, -0.01]), at(upright, LOWER_BALL)) < 1e-15);
        assert!(gap(at(upper, [-0.005, 0.12, 0.01]), at(upright, UPPER_BALL)) < 1e-15);
        let inner = point([-0.13, 0.4, 0.3]);
        assert!((gap(at(upright, TIE_END), inner) - TIE_LENGTH).abs() < 1e-15);
    }

    #[test]
    fn energy_is_kept_without_dampers() {
        let wishbone = DoubleWishbone { damping: 0.0, tyre_damping: 0.0, ..DoubleWishbone::default() };
        let energies = wishbone.energies(&[0.0, 0.05]);
        assert!((energies[1] - energies[0]).abs() < 1e-12 * energies[0].abs(), "{energies:?}");
        let damped = DoubleWishbone::default().energies(&[0.0, 0.05]);
        assert!(damped[1] < damped[0] - 1.0, "{damped:?}");
    }
}
