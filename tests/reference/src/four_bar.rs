//! The planar four-bar linkage reduced to the angle of its crank.
//!
//! Bars turn in the x-y plane about z: the crank (1) from pivot O, the coupler (2) from the crank's end A to
//! B, the rocker (3) from pivot D to B. All angles θ_k are those of the bars against global x, counted
//! anticlockwise. B is where the circles about A and D meet. Per unit of the crank's rate, bar k turns at k_k
//! and its mass centre moves at v_k; with ' = d/dθ₁,
//!
//! ```text
//! k2 = −l1 sin(θ3−θ1) / (l2 sin(θ3−θ2))      k3 = l1 sin(θ2−θ1) / (l3 sin(θ2−θ3))
//! M  = Σ m v·v + J k²        C = Σ m v·v' + J k k' = ½ M'        Q = Σ m v·g
//! M θ̈₁ + C θ̇₁² = Q + crank torque
//! ```
//!
//! Source: Kane's equations of one coordinate; k and k' are the loop's closure l1 e1 + l2 e2 = OD + l3 e3
//! differentiated once and twice (Haug, *Computer Aided Kinematics and Dynamics of Mechanical Systems*, 1989,
//! for the loop).

use crate::DoubleDouble;
use crate::extrapolation::State;
use crate::trajectory::{decimal, decimals, rounded, smooth_trajectory};

type Plane = [DoubleDouble; 2];

/// One moving bar. Its frame has x from its first joint to its second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Distance of its two joints, m.
    pub length: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about z through the mass centre, kg·m².
    pub inertia: f64,
    /// The mass centre from the first joint, in the bar's frame, m.
    pub centre: [f64; 2],
}

/// On which side of the line from the crank's end A to the rocker's pivot D the joint B lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// To the left, looking from A to D.
    Left,
    /// To the right.
    Right,
}

/// A four-bar linkage and its start. The crank's pivot O is the origin. Numbers are the decimals they print
/// as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourBar {
    /// Crank, coupler and rocker.
    pub bars: [Bar; 3],
    /// The rocker's pivot D, m.
    pub pivot: [f64; 2],
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 2],
    /// How the loop closes.
    pub branch: Branch,
    /// Crank angle at time zero, rad.
    pub start: f64,
    /// Crank rate at time zero, rad/s.
    pub rate: f64,
}

/// A four-bar linkage at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FourBarSample {
    /// Time, s.
    pub t: f64,
    /// θ₁, θ₂, θ₃, rad: continuous; at time zero the last two are within half a turn.
    pub angles: [f64; 3],
    /// Their rates, rad/s.
    pub rates: [f64; 3],
    /// Their accelerations, rad/s².
    pub accelerations: [f64; 3],
    /// Mass centres of the bars, m.
    pub centres: [[f64; 2]; 3],
    /// Kinetic energy and −Σ m g·r, J.
    pub energy: f64,
    /// Sine of the angle between coupler and rocker: near zero the crank cannot tell where the loop goes.
    pub transmission: f64,
}

struct PreciseBar {
    length: DoubleDouble,
    mass: DoubleDouble,
    inertia: DoubleDouble,
    centre: Plane,
}

struct Linkage {
    bars: [PreciseBar; 3],
    pivot: Plane,
    gravity: Plane,
    side: f64,
}

/// The linkage at a crank angle: directions, ratios k and k', mass centres and their v and v'.
struct Pose {
    directions: [Plane; 3],
    ratios: [DoubleDouble; 3],
    ratio_slopes: [DoubleDouble; 3],
    centres: [Plane; 3],
    partials: [Plane; 3],
    partial_slopes: [Plane; 3],
}

impl FourBar {
    /// A crank-rocker with bars of 0.2, 0.5 and 0.4 m, centred and between pivots 0.5 m apart along x;
    /// gravity 9.81 m/s² along −y; the crank starts at 60 degrees with 6 rad/s, the joint of coupler and
    /// rocker above.
    #[must_use]
    pub fn crank_rocker() -> Self {
        let bar = |length: f64, mass, inertia| Bar { length, mass, inertia, centre: [0.5 * length, 0.0] };
        FourBar {
            bars: [bar(0.2, 0.4, 1.35e-3), bar(0.5, 1.0, 2.1e-2), bar(0.4, 0.8, 1.08e-2)],
            pivot: [0.5, 0.0],
            gravity: [0.0, -9.81],
            branch: Branch::Left,
            start: core::f64::consts::FRAC_PI_3,
            rate: 6.0,
        }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or the loop cannot close at a crank angle that is
    /// reached.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<FourBarSample> {
        let linkage = self.precisely();
        let angle = decimal(self.start);
        let [_, coupler, rocker] = linkage.pose(angle).directions.map(|[x, y]| y.atan2(x));
        let start = [angle, coupler, rocker, decimal(self.rate)];
        let motion = smooth_trajectory(|_, state| linkage.derivative(state), start, times);
        motion.iter().map(|(t, state)| linkage.sample(*t, state)).collect()
    }

    /// Torque on the crank, N·m, that gives it `acceleration` (rad/s²) at `angle` and `rate`: what a driver
    /// must exert.
    ///
    /// # Panics
    /// As [`solve`](Self::solve).
    #[must_use]
    pub fn crank_torque(&self, angle: f64, rate: f64, acceleration: f64) -> f64 {
        let linkage = self.precisely();
        let (rate, pose) = (decimal(rate), linkage.pose(decimal(angle)));
        let [inertia, slope, force] = linkage.coefficients(&pose);
        (inertia * decimal(acceleration) + slope * rate * rate - force).to_f64()
    }

    fn precisely(&self) -> Linkage {
        Linkage {
            bars: self.bars.map(|bar| PreciseBar {
                length: decimal(bar.length),
                mass: decimal(bar.mass),
                inertia: decimal(bar.inertia),
                centre: decimals(bar.centre),
            }),
            pivot: decimals(self.pivot),
            gravity: decimals(self.gravity),
            side: if self.branch == Branch::Left { 1.0 } else { -1.0 },
        }
    }
}

impl Linkage {
    fn pose(&self, angle: DoubleDouble) -> Pose {
        let directions = self.directions(angle);
        let (ratios, ratio_slopes) = self.ratios(&directions);
        let offsets: [Plane; 3] = core::array::from_fn(|k| {
            let [x, y] = self.bars[k].centre;
            add(scale(x, directions[k]), scale(y, perpendicular(directions[k])))
        });
        let end = scale(self.bars[0].length, directions[0]);
        let nothing = [DoubleDouble::ZERO; 2];
        // Where each bar's first joint is, how it moves, and how that changes.
        let joints = [nothing, end, self.pivot];
        let moves = [nothing, perpendicular(end), nothing];
        let changes = [nothing, scale(DoubleDouble::new(-1.0), end), nothing];
        Pose {
            centres: core::array::from_fn(|k| add(joints[k], offsets[k])),
            partials: core::array::from_fn(|k| add(moves[k], scale(ratios[k], perpendicular(offsets[k])))),
            partial_slopes: core::array::from_fn(|k| {
                let turned = scale(ratio_slopes[k], perpendicular(offsets[k]));
                add(changes[k], add(turned, scale(-(ratios[k] * ratios[k]), offsets[k])))
            }),
            directions,
            ratios,
            ratio_slopes,
        }
    }

    /// Unit vectors along the bars: B is where the circles about A and D meet.
    fn directions(&self, angle: DoubleDouble) -> [Plane; 3] {
        let [l1, l2, l3] = [0, 1, 2].map(|k| self.bars[k].length);
        let (sin, cos) = angle.sin_cos();
        let crank = [cos, sin];
        let line = sub(self.pivot, scale(l1, crank));
        let squared = dot(line, line);
        let along = (l2 * l2 - l3 * l3 + squared) / (squared.times(2.0));
        let height = (l2 * l2 / squared - along * along).sqrt().times(self.side);
        let coupler = add(scale(along, line), scale(height, perpendicular(line)));
        let rocker = sub(coupler, line);
        [crank, coupler.map(|x| x / l2), rocker.map(|x| x / l3)]
    }

    /// k and k' of the three bars.
    fn ratios(&self, [e1, e2, e3]: &[Plane; 3]) -> ([DoubleDouble; 3], [DoubleDouble; 3]) {
        let [l1, l2, l3] = [0, 1, 2].map(|k| self.bars[k].length);
        let one = DoubleDouble::new(1.0);
        let sine = wedge(*e2, *e3);
        let k2 = -(l1 * wedge(*e1, *e3)) / (l2 * sine);
        let k3 = -(l1 * wedge(*e1, *e2)) / (l3 * sine);
        // The second derivative of the closure along e3 gives k2', along e2 k3'.
        let slope2 = l1 * dot(*e1, *e3) + l2 * k2 * k2 * dot(*e2, *e3) - l3 * k3 * k3;
        let slope3 = l1 * dot(*e1, *e2) + l2 * k2 * k2 - l3 * k3 * k3 * dot(*e2, *e3);
        ([one, k2, k3], [DoubleDouble::ZERO, slope2 / (l2 * sine), slope3 / (l3 * sine)])
    }

    /// M, C and Q.
    fn coefficients(&self, pose: &Pose) -> [DoubleDouble; 3] {
        let mut sums = [DoubleDouble::ZERO; 3];
        for (k, bar) in self.bars.iter().enumerate() {
            let (v, slope) = (pose.partials[k], pose.partial_slopes[k]);
            let shares = [
                bar.mass * dot(v, v) + bar.inertia * pose.ratios[k] * pose.ratios[k],
                bar.mass * dot(v, slope) + bar.inertia * pose.ratios[k] * pose.ratio_slopes[k],
                bar.mass * dot(v, self.gravity),
            ];
            sums = core::array::from_fn(|i| sums[i] + shares[i]);
        }
        sums
    }

    /// Rates of θ₁, θ₂, θ₃ and the crank's acceleration.
    fn derivative(&self, &[angle, _, _, rate]: &State<4>) -> State<4> {
        let pose = self.pose(angle);
        let [inertia, slope, force] = self.coefficients(&pose);
        let [_, k2, k3] = pose.ratios;
        [rate, k2 * rate, k3 * rate, (force - slope * rate * rate) / inertia]
    }

    fn energy(&self, pose: &Pose, rate: DoubleDouble) -> DoubleDouble {
        let [inertia, ..] = self.coefficients(pose);
        let potentials = self.bars.iter().zip(&pose.centres).map(|(bar, r)| bar.mass * dot(self.gravity, *r));
        potentials.fold((inertia * rate * rate).times(0.5), |sum, share| sum - share)
    }

    fn sample(&self, t: DoubleDouble, state: &State<4>) -> FourBarSample {
        let [angle, coupler, rocker, rate] = *state;
        let pose = self.pose(angle);
        let acceleration = self.derivative(state)[3];
        let turned = |k: usize| pose.ratios[k] * acceleration + pose.ratio_slopes[k] * rate * rate;
        FourBarSample {
            t: t.to_f64(),
            angles: rounded([angle, coupler, rocker]),
            rates: rounded(pose.ratios.map(|ratio| ratio * rate)),
            accelerations: rounded([0, 1, 2].map(turned)),
            centres: pose.centres.map(rounded),
            energy: self.energy(&pose, rate).to_f64(),
            transmission: wedge(pose.directions[1], pose.directions[2]).to_f64(),
        }
    }
}

fn add(a: Plane, b: Plane) -> Plane {
    [a[0] + b[0], a[1] + b[1]]
}

fn sub(a: Plane, b: Plane) -> Plane {
    [a[0] - b[0], a[1] - b[1]]
}

fn scale(factor: DoubleDouble, a: Plane) -> Plane {
    [factor * a[0], factor * a[1]]
}

fn dot(a: Plane, b: Plane) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1]
}

/// The sine of the angle from `a` to `b`, times their lengths.
fn wedge(a: Plane, b: Plane) -> DoubleDouble {
    a[0] * b[1] - a[1] * b[0]
}

/// `a` turned by a quarter turn, anticlockwise.
fn perpendicular(a: Plane) -> Plane {
    [-a[1], a[0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pendulum;

    /// Central differences err by this squared; rounding is worth 1e-31 over it.
    const STEP: f64 = 1e-10;
    const DIFFERENCE: f64 = 1e-17;

    /// A crank-rocker with nothing special: shortest and longest together are shorter than the other two.
    fn unsymmetric() -> FourBar {
        let bar = |length, mass, inertia, centre| Bar { length, mass, inertia, centre };
        FourBar {
            bars: [
                bar(0.2, 0.5, 0.004, [0.08, 0.01]),
                bar(0.7, 1.1, 0.06, [0.4, -0.05]),
                bar(0.5, 0.8, 0.02, [0.2, 0.03]),
            ],
            pivot: [0.6, -0.1],
            gravity: [1.0, -9.5],
            branch: Branch::Left,
            start: 0.3,
            rate: 25.0,
        }
    }

    fn number(x: f64) -> DoubleDouble {
        DoubleDouble::new(x)
    }

    fn slope(linkage: &Linkage, angle: f64, value: impl Fn(&Pose) -> DoubleDouble) -> f64 {
        let at = |sign: f64| value(&linkage.pose(number(angle) + number(sign * STEP)));
        (at(1.0) - at(-1.0)).divided_by(2.0 * STEP).to_f64()
    }

    #[test]
    fn the_loop_closes_on_its_branch() {
        for branch in [Branch::Left, Branch::Right] {
            let linkage = FourBar { branch, ..unsymmetric() }.precisely();
            for step in 0..20 {
                let [e1, e2, e3] = linkage.pose(number(f64::from(step) * 0.35)).directions;
                let [l1, l2, l3] = [0, 1, 2].map(|k| linkage.bars[k].length);
                let gap = sub(add(scale(l1, e1), scale(l2, e2)), add(linkage.pivot, scale(l3, e3)));
                assert!(dot(gap, gap).to_f64() < 1e-60, "{gap:?}");
                assert!((dot(e3, e3) - number(1.0)).to_f64().abs() < 1e-29);
                assert_eq!(wedge(e2, e3).to_f64() < 0.0, branch == Branch::Right);
            }
        }
    }

    #[test]
    fn ratios_partial_velocities_and_their_slopes_are_derivatives() {
        let linkage = unsymmetric().precisely();
        for angle in [0.0, 1.1, 3.0, 5.5] {
            let pose = linkage.pose(number(angle));
            let agree = |found: f64, expected: DoubleDouble| {
                assert!(
                    (found - expected.to_f64()).abs() < DIFFERENCE + 4e-16 * found.abs(),
                    "{found} {expected:?}"
                );
            };
            for k in 0..3 {
                agree(
                    slope(&linkage, angle, |p| p.directions[k][1].atan2(p.directions[k][0])),
                    pose.ratios[k],
                );
                agree(slope(&linkage, angle, |p| p.ratios[k]), pose.ratio_slopes[k]);
                for axis in 0..2 {
                    agree(slope(&linkage, angle, |p| p.centres[k][axis]), pose.partials[k][axis]);
                    agree(slope(&linkage, angle, |p| p.partials[k][axis]), pose.partial_slopes[k][axis]);
                }
            }
            let [_, half_slope, _] = linkage.coefficients(&pose);
            agree(slope(&linkage, angle, |p| linkage.coefficients(p)[0]), half_slope.times(2.0));
        }
    }

    fn check_energy_and_closure(four_bar: FourBar) {
        let samples = four_bar.solve(&[0.0, 3.0, 10.0]);
        let size = samples[0].energy.abs() + 1.0;
        for sample in &samples {
            assert!((sample.energy - samples[0].energy).abs() < 1e-15 * size, "{sample:?}");
            let end: [f64; 2] = core::array::from_fn(|axis| {
                let part = |k: usize| {
                    let (sin, cos) = sample.angles[k].sin_cos();
                    four_bar.bars[k].length * [cos, sin][axis]
                };
                part(0) + part(1) - part(2) - four_bar.pivot[axis]
            });
            assert!(end[0].abs() + end[1].abs() < 1e-14, "the integrated angles close the loop: {end:?}");
        }
    }

    #[test]
    fn energy_and_closure_are_kept_over_ten_seconds() {
        assert!(unsymmetric().solve(&[10.0])[0].angles[0] > 50.0, "the crank goes round");
        check_energy_and_closure(unsymmetric());
        check_energy_and_closure(FourBar::crank_rocker());
    }

    #[test]
    fn a_free_crank_needs_no_torque() {
        /// The sampled angle, tens of radians, is rounded by 4e-15; the torque changes by some 10 N·m a radian.
        const ROUNDING: f64 = 1e-13;
        let four_bar = unsymmetric();
        for sample in four_bar.solve(&[0.7, 2.0]) {
            let torque = four_bar.crank_torque(sample.angles[0], sample.rates[0], sample.accelerations[0]);
            // The same standing still.
            let share = four_bar.crank_torque(sample.angles[0], 0.0, sample.accelerations[0]);
            assert!(torque.abs() < ROUNDING && share.abs() > 1e-1, "{torque} {share}");
        }
    }

    #[test]
    fn accelerations_are_derivatives_of_rates() {
        /// Step and error of the central difference, s and rad/s²: 1e-10 times a third derivative of some 1e5.
        const STEP: f64 = 1e-5;
        const DIFFERENCE: f64 = 1e-4;
        let samples = unsymmetric().solve(&[0.7 - STEP, 0.7, 0.7 + STEP]);
        let (before, here, after) = (samples[0], samples[1], samples[2]);
        for k in 0..3 {
            let slope = (after.rates[k] - before.rates[k]) / (2.0 * STEP);
            assert!((here.accelerations[k] - slope).abs() < DIFFERENCE, "bar {k}: {here:?} {slope}");
        }
    }

    #[test]
    fn a_parallelogram_swings_like_its_pendulum() {
        let bar = |length, mass, centre| Bar { length, mass, inertia: 0.01, centre: [centre, 0.0] };
        let bars = [bar(0.3, 0.5, 0.1), bar(0.7, 0.8, 0.4), bar(0.3, 0.6, 0.2)];
        let pendulum = Pendulum::parallelogram(bars, 9.81, 0.4, 2.0);
        // Gravity points along −y: the crank's angle is the pendulum's less a quarter turn. The bars never
        // come in line.
        let four_bar = FourBar {
            bars,
            pivot: [0.7, 0.0],
            gravity: [0.0, -9.81],
            branch: Branch::Right,
            start: 0.4 - core::f64::consts::FRAC_PI_2,
            rate: 2.0,
        };
        for (found, expected) in four_bar.solve(&[0.5, 3.0]).iter().zip(pendulum.solve(&[0.5, 3.0])) {
            assert!((found.angles[0] + core::f64::consts::FRAC_PI_2 - expected.angle).abs() < 1e-15);
            assert!((found.angles[2] - found.angles[0]).abs() < 1e-15 && found.angles[1].abs() < 1e-15);
            assert!((found.energy - expected.energy).abs() < 1e-14);
        }
    }

    /// A parallelogram of massless crank and rocker swings its coupler like a point mass on a string of their
    /// length.
    #[test]
    fn a_driven_parallelogram_carries_its_coupler() {
        let bar = |length, mass| Bar { length, mass, inertia: 0.3 * mass, centre: [0.5 * length, 0.0] };
        let four_bar = FourBar {
            bars: [bar(0.4, 0.0), bar(1.0, 2.0), bar(0.4, 0.0)],
            pivot: [1.0, 0.0],
            gravity: [0.0, -10.0],
            branch: Branch::Left,
            start: 1.0,
            rate: 0.0,
        };
        let torque = four_bar.crank_torque(1.0, 3.0, 5.0);
        assert!((torque - 2.0 * 0.4 * (0.4 * 5.0 + 10.0 * 1.0f64.cos())).abs() < 1e-14, "{torque}");
    }
}
