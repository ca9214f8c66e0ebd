//! The four-bar linkage of `models/four-bar-bushing.toml` in two coordinates: the angle of the crank and that by which
//! the bushing bends its coupler.
//!
//! The bent coupler reaches as far as `a + b e^{iφ}` in the frame of its first half, so its end is where two circles
//! meet, and the first half's direction is the quotient of the two ways, as complex numbers.

use crate::closing::{along, fixed, point};
use crate::collocation::{Steps, advance};
use crate::kane::{Mechanism, Placed, Scene, derivative, global, moving};
use crate::rotation::Precise;
use crate::time_jet::Jet;
use crate::trajectory::{decimal, decimals};
use crate::vector::{Vector, add, dot, scale, sub};
use crate::{DoubleDouble, JointRow};

/// The linkage, with the numbers of its model file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BushingFourBar {
    /// Stiffness of the bushing, N·m/rad.
    pub stiffness: f64,
    /// Its damping, N·m·s/rad.
    pub damping: f64,
    /// Crank angle at time zero, rad.
    pub start: f64,
    /// Crank rate at time zero, rad/s.
    pub rate: f64,
}

const CRANK: f64 = 0.2;
const HALF: f64 = 0.25;
const ROCKER: f64 = 0.4;
const PIVOT: [f64; 3] = [0.5, 0.0, 0.0];

/// The bushing comes to rest within some hundredths of a millisecond, the crank takes its time.
const STEPS: Steps = Steps { first: 2e-7, growth: 0.25, largest: 4e-3 };

impl Default for BushingFourBar {
    fn default() -> Self {
        Self { stiffness: 1e6, damping: 100.0, start: core::f64::consts::FRAC_PI_3, rate: 6.0 }
    }
}

impl BushingFourBar {
    /// The joints of the model file at `times` (s, ascending from zero; each the decimal it prints as), rounded once.
    ///
    /// # Panics
    /// If the times do not ascend, or the crank comes to where the linkage cannot close.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<JointRow> {
        let row = |(t, state): &(DoubleDouble, _)| moving::<2, 2, 4>(self, *t, state).row(*t);
        self.states(STEPS, times).iter().map(row).collect()
    }

    /// Kinetic energy and potential of gravity and of the bushing along the same motion, J.
    #[must_use]
    pub fn energies(&self, times: &[f64]) -> Vec<f64> {
        let energy = |(t, state): &(DoubleDouble, _)| {
            moving::<2, 2, 4>(self, *t, state).energy(Mechanism::<2, 2>::gravity(self)).to_f64()
        };
        self.states(STEPS, times).iter().map(energy).collect()
    }

    fn states(&self, steps: Steps, times: &[f64]) -> Vec<(DoubleDouble, [DoubleDouble; 4])> {
        let mut state = [decimal(self.start), DoubleDouble::ZERO, decimal(self.rate), DoubleDouble::ZERO];
        let mut now = DoubleDouble::ZERO;
        let reach = |&t: &f64| {
            let next = decimal(t);
            assert!(next >= now, "times ascend from zero: found {t}");
            // Nothing depends on time.
            let rhs = |state: &_| derivative::<2, 2, 4>(self, DoubleDouble::ZERO, state);
            state = advance(rhs, steps, state, now, next);
            now = next;
            (now, state)
        };
        times.iter().map(reach).collect()
    }
}

/// Directions of the coupler's first half and of the rocker, the coupler's end above the line from the crank's end to
/// the rocker's pivot.
fn directions(crank: Vector<Jet>, bend: Vector<Jet>) -> [Vector<Jet>; 2] {
    let line = sub(point(PIVOT), scale(fixed(CRANK), crank));
    let way = add(point([HALF, 0.0, 0.0]), scale(fixed(HALF), bend));
    let (square, reach, rocker) = (dot(line, line), dot(way, way), fixed(ROCKER));
    let part = (reach - rocker * rocker + square) / (square + square);
    let height = (reach / square - part * part).sqrt();
    let end = add(scale(part, line), scale(height, [-line[1], line[0], line[2]]));
    let near = times(end, [way[0], -way[1], way[2]]).map(|x| x / reach);
    [near, sub(end, line).map(|x| x / rocker)]
}

fn in_plane(angle: Jet) -> Vector<Jet> {
    let [x, y] = along(angle);
    [x, y, fixed(0.0)]
}

/// The product of complex numbers.
fn times([a, b, zero]: Vector<Jet>, [c, d, _]: Vector<Jet>) -> Vector<Jet> {
    [a * c - b * d, a * d + b * c, zero]
}

/// A bar with its mass centre in the middle: from where it starts, its length and its direction.
fn bar((mass, inertia): (f64, f64), from: Vector<Jet>, length: f64, along: Vector<Jet>) -> Placed {
    let ([x, y, zero], up) = (along, global()[2]);
    Placed {
        mass: decimal(mass),
        inertia: decimals([inertia, inertia, inertia, 0.0, 0.0, 0.0]),
        centre: add(from, scale(fixed(0.5 * length), along)),
        axes: [along, [-y, x, zero], up],
    }
}

impl Mechanism<2, 2> for BushingFourBar {
    fn gravity(&self) -> Precise {
        decimals([0.0, -9.81, 0.0])
    }

    fn rates(&self, _: &[DoubleDouble; 2], speeds: [DoubleDouble; 2]) -> [DoubleDouble; 2] {
        speeds
    }

    fn place(&self, _: Jet, q: &[DoubleDouble; 2], v: [DoubleDouble; 2], a: [DoubleDouble; 2]) -> Scene {
        let [angle, bend] = [0, 1].map(|k| Jet::new(q[k], v[k], a[k]));
        let crank = in_plane(angle);
        let [near, rocker] = directions(crank, in_plane(bend));
        let far = times(near, in_plane(bend));
        let [near_angle, rocker_angle] = [near, rocker].map(|[x, y, _]| y.atan2(x));
        let [origin, pivot] = [[0.0; 3], PIVOT].map(point);
        let elbow = scale(fixed(CRANK), crank);
        Scene {
            bodies: vec![
                bar((0.4, 1.35e-3), origin, CRANK, crank),
                bar((0.5, 2.6e-3), elbow, HALF, near),
                bar((0.5, 2.6e-3), add(elbow, scale(fixed(HALF), near)), HALF, far),
                bar((0.8, 1.08e-2), pivot, ROCKER, rocker),
            ],
            springs: vec![(bend, decimal(self.stiffness))],
            friction: vec![(bend, decimal(self.damping))],
            joints: vec![angle, rocker_angle, near_angle - angle, bend, rocker_angle - near_angle - bend],
            ..Scene::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FourBar;

    #[test]
    fn the_loop_closes_however_the_coupler_is_bent() {
        for (angle, bend) in [(1.0, 0.0), (2.5, 0.3), (-1.0, -0.4)] {
            let zero = [DoubleDouble::ZERO; 2];
            let scene =
                BushingFourBar::default().place(Jet::from(0.0), &[decimal(angle), decimal(bend)], zero, zero);
            let end = |k: usize, length: f64| {
                let Placed { centre, axes, .. } = scene.bodies[k];
                add(centre, scale(fixed(0.5 * length), axes[0]))
            };
            let gap = sub(end(2, HALF), end(3, ROCKER));
            assert!(gap.iter().all(|x| x.value.to_f64().abs() < 1e-30), "{gap:?}");
        }
    }

    #[test]
    fn half_the_step_leads_to_the_same() {
        let half =
            Steps { first: 0.5 * STEPS.first, growth: 0.5 * STEPS.growth, largest: 0.5 * STEPS.largest };
        let linkage = BushingFourBar::default();
        let times = [1e-5, 1e-4, 1e-3, 0.5];
        for ((t, a), (_, b)) in linkage.states(STEPS, &times).into_iter().zip(linkage.states(half, &times)) {
            for (a, b) in a.into_iter().zip(b) {
                let error = (a - b).to_f64().abs();
                assert!(error < 1e-17 * (1.0 + b.to_f64().abs()), "{t:?}: {error:e}");
            }
        }
    }

    #[test]
    fn a_bushing_takes_energy_only_by_its_damper() {
        let free = BushingFourBar { damping: 0.0, stiffness: 1e3, ..BushingFourBar::default() };
        let energies = free.energies(&[0.0, 0.05]);
        assert!((energies[1] - energies[0]).abs() < 1e-14 * energies[0], "{energies:?}");
        let damped = BushingFourBar { stiffness: 1e3, ..BushingFourBar::default() }.energies(&[0.0, 0.05]);
        assert!(damped[1] < damped[0] - 1e-6, "{damped:?}");
    }

    /// Halves that hardly bend move as a coupler in one piece, whose moment of inertia is 2 (2.6e-3 + 0.5 · 0.125²).
    #[test]
    fn a_stiff_coupler_moves_as_one_piece() {
        let mut rigid = FourBar::crank_rocker();
        rigid.bars[1].inertia = 2.0 * (2.6e-3 + 0.5 * 0.125 * 0.125);
        let expected = rigid.solve(&[0.3])[0];
        for (stiffness, off) in [(1e6, 3e-5), (1e8, 3e-7)] {
            let found = &BushingFourBar { stiffness, ..BushingFourBar::default() }.solve(&[0.3])[0];
            let error = (found.positions[0] - expected.angles[0]).abs();
            assert!(error < off && error > 1e-3 * off, "{stiffness}: {error:e}");
        }
    }
}
