//! A four-bar linkage on a carrier that is free in space, in seven speeds: of the crank, of the carrier's mass centre
//! and of its turning. The loop is closed in its own plane; the plane is carried along.

use crate::closing::{along, direction, fixed, point};
use crate::kane::{Mechanism, Placed, Scene, carried, derivative, moving};
use crate::rotation::{ORIGIN, Precise, euler_parameter_rates};
use crate::time_jet::Jet;
use crate::trajectory::{decimal, decimals, smooth_trajectory};
use crate::vector::{Vector, add, cross, scale};
use crate::{DoubleDouble, JointRow};

/// The carrier and the linkage of `tests/models/carried-four-bar.toml`, and their start. Numbers are the decimals they
/// print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedFourBar {
    /// Angle of the crank at time zero, rad, and its rate, rad/s.
    pub crank: [f64; 2],
    /// Mass centre of the carrier at time zero, m, and its Euler parameters.
    pub pose: [f64; 7],
    /// Its velocity, m/s, and w' in its frame, rad/s.
    pub velocity: [f64; 6],
}

/// What stays the same of a body that nothing acts on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constants {
    /// Energy, J.
    pub energy: f64,
    /// Angular momentum about the global origin, kg·m²/s.
    pub angular_momentum: [f64; 3],
}

/// Length, mass and moments of inertia of crank, coupler and rocker, each with its centre in its middle.
const BARS: [(f64, f64, [f64; 3]); 3] = [
    (0.2, 0.4, [2e-5, 1.35e-3, 1.35e-3]),
    (0.5, 1.0, [5e-5, 2.1e-2, 2.1e-2]),
    (0.4, 0.8, [4e-5, 1.08e-2, 1.08e-2]),
];
const BASE: f64 = 0.5;

impl CarriedFourBar {
    /// The joints of the model file at `times` (s, ascending from zero; each the decimal it prints as), rounded once.
    ///
    /// # Panics
    /// If the times do not ascend.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<JointRow> {
        let motion =
            smooth_trajectory(|t, state| derivative::<8, 7, 15>(self, t, state), self.start(), times);
        motion.iter().map(|(t, state)| moving::<8, 7, 15>(self, *t, state).row(*t)).collect()
    }

    /// What the motion keeps.
    #[must_use]
    pub fn constants(&self) -> Constants {
        let scene = moving::<8, 7, 15>(self, DoubleDouble::ZERO, &self.start());
        let angular_momentum = scene.angular_momentum().map(DoubleDouble::to_f64);
        Constants { energy: scene.energy(ORIGIN).to_f64(), angular_momentum }
    }

    fn start(&self) -> [DoubleDouble; 15] {
        let ([angle, rate], [x, y, z, e0, e1, e2, e3]) = (decimals(self.crank), decimals(self.pose));
        let [a, b, c, u, v, w] = decimals(self.velocity);
        let length = (e0 * e0 + e1 * e1 + e2 * e2 + e3 * e3).sqrt();
        let [e0, e1, e2, e3] = [e0, e1, e2, e3].map(|e| e / length);
        [angle, x, y, z, e0, e1, e2, e3, rate, a, b, c, u, v, w]
    }
}

/// The axes of a frame with moving Euler parameters: eq. (3) of the paper, column by column.
fn axes([e0, e1, e2, e3]: [Jet; 4]) -> [Vector<Jet>; 3] {
    let (two, one) = (Jet::from(2.0), Jet::from(1.0));
    [
        [two * (e0 * e0 + e1 * e1) - one, two * (e1 * e2 + e0 * e3), two * (e1 * e3 - e0 * e2)],
        [two * (e1 * e2 - e0 * e3), two * (e0 * e0 + e2 * e2) - one, two * (e2 * e3 + e0 * e1)],
        [two * (e1 * e3 + e0 * e2), two * (e2 * e3 - e0 * e1), two * (e0 * e0 + e3 * e3) - one],
    ]
}

/// Unit vectors along crank, coupler and rocker in the plane of the loop: where the circles about the crank's end and
/// the rocker's pivot meet, to the left.
fn directions(crank: Jet) -> [[Jet; 2]; 3] {
    let [l1, l2, l3] = BARS.map(|(length, ..)| fixed(length));
    let e1 = along(crank);
    let line = [fixed(BASE) - l1 * e1[0], -(l1 * e1[1])];
    let square = line[0] * line[0] + line[1] * line[1];
    let part = (l2 * l2 - l3 * l3 + square) / (Jet::from(2.0) * square);
    let height = (l2 * l2 / square - part * part).sqrt();
    let coupler = [part * line[0] - height * line[1], part * line[1] + height * line[0]];
    let rocker = [coupler[0] - line[0], coupler[1] - line[1]];
    [e1, coupler.map(|x| x / l2), rocker.map(|x| x / l3)]
}

impl Mechanism<8, 7> for CarriedFourBar {
    fn gravity(&self) -> Precise {
        ORIGIN
    }

    fn rates(&self, q: &[DoubleDouble; 8], v: [DoubleDouble; 7]) -> [DoubleDouble; 8] {
        let p = euler_parameter_rates([q[4], q[5], q[6], q[7]], [v[4], v[5], v[6]]);
        [v[0], v[1], v[2], v[3], p[0], p[1], p[2], p[3]]
    }

    fn place(&self, _: Jet, q: &[DoubleDouble; 8], v: [DoubleDouble; 7], a: [DoubleDouble; 7]) -> Scene {
        let (p, w) = ([q[4], q[5], q[6], q[7]], [v[4], v[5], v[6]]);
        let rates = euler_parameter_rates(p, w);
        // p̈ = ½ Gᵀẇ' + ½ Ġᵀw'.
        let (turn, change) = (euler_parameter_rates(p, [a[4], a[5], a[6]]), euler_parameter_rates(rates, w));
        let carrier = axes(core::array::from_fn(|k| Jet::new(p[k], rates[k], turn[k] + change[k])));
        let centre: Vector<Jet> = core::array::from_fn(|k| Jet::new(q[1 + k], v[1 + k], a[1 + k]));
        let [crank, coupler, rocker] = directions(Jet::new(q[0], v[0], a[0]));

        // The plane of the loop in the carrier: f along the line of the pivots, h along the axes.
        let (f, h) = (direction([2.0, 1.0, -2.0]), direction([1.0, 2.0, 2.0]));
        let [f, g, h] = [f, cross(h, f), h].map(|u| carried(&carrier, u.map(Jet::constant)));
        let in_plane = |[x, y]: [Jet; 2]| add(scale(x, f), scale(y, g));
        let pivot = add(centre, carried(&carrier, point([0.05, -0.1, 0.08])));
        let end = add(pivot, scale(fixed(BARS[0].0), in_plane(crank)));
        let other = add(pivot, scale(fixed(BASE), f));
        let bar = |(length, mass, [xx, yy, zz]): (f64, f64, [f64; 3]), from, e: [Jet; 2]| Placed {
            mass: decimal(mass),
            inertia: decimals([xx, yy, zz, 0.0, 0.0, 0.0]),
            centre: add(from, scale(fixed(length) * Jet::from(0.5), in_plane(e))),
            axes: [in_plane(e), in_plane([-e[1], e[0]]), h],
        };
        let angle = |e: [Jet; 2]| e[1].atan2(e[0]);
        let (first, second, third) = (Jet::new(q[0], v[0], a[0]), angle(coupler), angle(rocker));
        Scene {
            bodies: vec![
                Placed {
                    mass: decimal(2.0),
                    inertia: decimals([0.05, 0.07, 0.09, 0.0, 0.0, 0.0]),
                    centre,
                    axes: carrier,
                },
                bar(BARS[0], pivot, crank),
                bar(BARS[1], end, coupler),
                bar(BARS[2], other, rocker),
            ],
            joints: vec![first, third, second - first, third - second],
            ..Scene::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tumbling() -> CarriedFourBar {
        CarriedFourBar {
            crank: [1.0, 30.0],
            pose: [0.1, -0.2, 0.3, 0.8, 0.2, -0.4, 0.4],
            velocity: [0.02, 0.01, -0.03, 25.0, 40.0, -35.0],
        }
    }

    #[test]
    fn energy_and_angular_momentum_are_kept() {
        let linkage = tumbling();
        let (start, before) = (linkage.start(), linkage.constants());
        let end = smooth_trajectory(|t, state| derivative::<8, 7, 15>(&linkage, t, state), start, &[0.02]);
        let scene = moving::<8, 7, 15>(&linkage, end[0].0, &end[0].1);
        assert!((scene.energy(ORIGIN).to_f64() - before.energy).abs() < 1e-13 * before.energy);
        for (found, expected) in scene.angular_momentum().iter().zip(before.angular_momentum) {
            assert!((found.to_f64() - expected).abs() < 1e-13, "{found:?} {expected}");
        }
    }

    /// A much heavier carrier would leave the loop alone; this one is moved by it.
    #[test]
    fn the_linkage_turns_its_carrier() {
        let still = CarriedFourBar { velocity: [0.0; 6], ..tumbling() };
        let state = derivative::<8, 7, 15>(&still, DoubleDouble::ZERO, &still.start());
        assert!(state[12].to_f64().abs() > 1.0, "{:?}", &state[12..]);
    }
}
