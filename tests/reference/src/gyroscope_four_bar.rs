//! The gyroscope of `models/gyroscope-four-bar.toml`, its inner ring rocked from the base, in two coordinates: the
//! angle of the outer ring and that of the rotor.
//!
//! The inner ring's angle β closes the loop: its arm's end P = Ry(α) Rz(β) (0, −r, 0) is at the coupler's length from
//! the crank's pin, which gives `a cos β + b sin β = c`. The coupler's y axis is across the crank's axis and the
//! coupler.

use crate::closing::{Side, fixed, point, sine_and_cosine};
use crate::kane::{Mechanism, Placed, Scene, carried, derivative, global, moving, turned};
use crate::rotation::Precise;
use crate::time_jet::{Jet, constant, unit};
use crate::trajectory::{decimal, decimals, smooth_trajectory};
use crate::vector::{Vector, add, cross, dot, scale, sub};
use crate::{DoubleDouble, JointRow, Real};

/// The gyroscope with its linkage, with the numbers of its model file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroscopeFourBar {
    /// Speed of the rotor in the inner ring at time zero, rad/s.
    pub spin: f64,
    /// Viscous friction of the outer ring, N·m·s/rad.
    pub friction: f64,
}

const PIVOT: [f64; 3] = [-0.06, -0.04, 0.0];
const CRANK: f64 = 0.003;
const COUPLER: f64 = 0.06;
const ARM: f64 = 0.04;

impl Default for GyroscopeFourBar {
    fn default() -> Self {
        Self { spin: 100.0, friction: 1e-5 }
    }
}

impl GyroscopeFourBar {
    /// The joints of the model file at `times` (s, ascending from zero; each the decimal it prints as), rounded once.
    ///
    /// # Panics
    /// If the times do not ascend, or the outer ring comes to where the linkage cannot close.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<JointRow> {
        let start = [DoubleDouble::ZERO, DoubleDouble::ZERO, DoubleDouble::ZERO, decimal(self.spin)];
        let motion = smooth_trajectory(|t, state| derivative::<2, 2, 4>(self, t, state), start, times);
        motion.iter().map(|(t, state)| moving::<2, 2, 4>(self, *t, state).row(*t)).collect()
    }
}

/// The crank's angle as its driver prescribes it.
fn driven(t: Jet) -> Jet {
    fixed(1.5) + fixed(20.0) * t + fixed(0.2) * (fixed(7.0) * t).sin_cos().0
}

fn body(mass: f64, [xx, yy, zz]: [f64; 3], centre: Vector<Jet>, axes: [Vector<Jet>; 3]) -> Placed {
    Placed { mass: decimal(mass), inertia: decimals([xx, yy, zz, 0.0, 0.0, 0.0]), centre, axes }
}

/// The inner ring's angle.
fn rocked(alpha: Jet, pin: Vector<Jet>) -> Jet {
    let (arm, coupler) = (fixed(ARM), fixed(COUPLER));
    let across = alpha.sin_cos().1 * pin[0] - alpha.sin_cos().0 * pin[2];
    let half = (arm * arm + dot(pin, pin) - coupler * coupler) * Jet::from(0.5);
    let (sin, cos) = sine_and_cosine([-(arm * pin[1]), arm * across, half], Side::Falling);
    sin.atan2(cos)
}

impl Mechanism<2, 2> for GyroscopeFourBar {
    fn gravity(&self) -> Precise {
        decimals([0.0, -10.0, 0.0])
    }

    fn rates(&self, _: &[DoubleDouble; 2], speeds: [DoubleDouble; 2]) -> [DoubleDouble; 2] {
        speeds
    }

    fn place(&self, t: Jet, q: &[DoubleDouble; 2], v: [DoubleDouble; 2], a: [DoubleDouble; 2]) -> Scene {
        let [alpha, phi] = [0, 1].map(|k| Jet::new(q[k], v[k], a[k]));
        let [x, y, z] =
            [0, 1, 2].map(|axis| core::array::from_fn(|k| decimal(f64::from(u8::from(k == axis)))));
        let (crank_angle, origin) = (driven(t), point([0.0; 3]));
        let crank = turned(global(), z, crank_angle);
        let pin = add(point(PIVOT), carried(&crank, point([CRANK, 0.0, 0.0])));
        let beta = rocked(alpha, pin);
        let outer = turned(global(), y, alpha);
        let inner = turned(outer, z, beta);
        let rotor = turned(inner, x, phi);
        let end = carried(&inner, point([0.0, -ARM, 0.0]));
        let way = sub(end, pin);
        let x_coupler = unit(way);
        let y_coupler = unit(cross(constant(z), x_coupler));
        let coupler = [x_coupler, y_coupler, cross(x_coupler, y_coupler)];
        // Crossed axes: from the crank's y to the coupler's about the crank's axis, then about the coupler's y axis.
        let first = (-y_coupler[0]).atan2(y_coupler[1]) - crank_angle;
        let second = (-dot(constant(z), coupler[0])).atan2(dot(constant(z), coupler[2]));
        Scene {
            bodies: vec![
                body(10e-3, [20e-7, 10e-7, 10e-7], origin, outer),
                body(10e-3, [10e-7, 20e-7, 10e-7], origin, inner),
                body(80e-3, [100e-7, 50e-7, 50e-7], origin, rotor),
                body(1e-3, [1e-8, 2e-8, 2e-8], point(PIVOT), crank),
                body(2e-3, [1e-8, 6e-7, 6e-7], add(pin, scale(Jet::from(0.5), way)), coupler),
            ],
            friction: vec![(alpha, decimal(self.friction))],
            joints: vec![alpha, beta, phi, crank_angle, first, second],
            balls: vec![[coupler, inner]],
            ..Scene::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_linkage_closes_and_rocks_the_ring() {
        let zero = [DoubleDouble::ZERO; 2];
        for (t, alpha) in [(0.0, 0.0), (0.1, 0.4), (0.2, -0.3)] {
            let scene =
                GyroscopeFourBar::default().place(Jet::from(t), &[decimal(alpha), decimal(0.5)], zero, zero);
            let beta = scene.joints[1].value.to_f64();
            assert!(beta.abs() < 0.09, "{beta}");
            // The coupler's centre is half way between the crank's pin and the ring's end.
            let (coupler, inner) = (scene.bodies[4], scene.bodies[1]);
            let end = carried(&inner.axes, point([0.0, -ARM, 0.0]));
            let gap = sub(add(coupler.centre, carried(&coupler.axes, point([COUPLER / 2.0, 0.0, 0.0]))), end);
            assert!(gap.iter().all(|x| x.value.to_f64().abs() < 1e-17), "{gap:?}");
        }
    }
}
