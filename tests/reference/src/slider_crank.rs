//! Slider-cranks, plane and spatial, reduced to the angle of the crank.
//!
//! The crank turns about an axis n through its pivot, from a zero direction f: its end is A = O + a (f cos θ + n×f sin
//! θ). The slider's joint S is on a line through the origin along d, at the rod's length l from A: S = d x,
//!
//! ```text
//! x = d·A + √((d·A)² − A·A + l²)
//! ```
//!
//! The slider does not turn. The rod turns with its direction u from A to S, about it as a universal joint on the
//! slider has it: the joint's second axis, the rod's y, is across the first one, h, and across u. In a plane with the
//! normal h that is what revolute joints have it do.

use crate::extrapolation::State;
use crate::jet::{Arrow, Jet, Moving, along, fixed, inner, minus, outer, plus, unit};
use crate::one_freedom::{Heft, OneFreedom, acceleration, energy, motion};
use crate::rotation::{Precise, Rotation};
use crate::trajectory::{decimal, decimals, rounded};
use crate::vector::{cross, scale};
use crate::{BodyState, DoubleDouble};

/// Crank or connecting rod: a bar whose mass centre is on the line from its first joint to its second, which is x of
/// its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Member {
    /// Distance of its two joints, m.
    pub length: f64,
    /// From its first joint to its mass centre, m.
    pub centre: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Moments of inertia about x, y and z through the mass centre, kg·m².
    pub inertia: [f64; 3],
}

/// A slider-crank and its start. Directions are unit vectors; numbers are the decimals they print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderCrank {
    /// From its pivot outwards.
    pub crank: Member,
    /// From the crank to the slider.
    pub rod: Member,
    /// The slider's mass, kg.
    pub slider: f64,
    /// The crank's pivot, m.
    pub pivot: [f64; 3],
    /// The crank's axis, z of its frame.
    pub axis: [f64; 3],
    /// The crank's direction where its angle is zero.
    pub zero: [f64; 3],
    /// The direction in which the slider moves.
    pub rail: [f64; 3],
    /// The first axis of the universal joint on the slider.
    pub hinge: [f64; 3],
    /// Acceleration of gravity, m/s².
    pub gravity: [f64; 3],
    /// Crank angle at time zero, rad.
    pub start: f64,
    /// Crank rate at time zero, rad/s.
    pub rate: f64,
}

/// A [`SliderCrank`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderCrankSample {
    /// Time, s.
    pub t: f64,
    /// Crank angle, rad.
    pub angle: f64,
    /// Its rate, rad/s.
    pub rate: f64,
    /// Its acceleration, rad/s².
    pub acceleration: f64,
    /// Where the slider is, m.
    pub displacement: f64,
    /// How it moves, m/s.
    pub displacement_rate: f64,
    /// The rod.
    pub rod: BodyState,
    /// Kinetic energy and −Σ m g·r, J.
    pub energy: f64,
}

struct Precisely {
    crank: PreciseMember,
    rod: PreciseMember,
    slider: DoubleDouble,
    pivot: Precise,
    /// The crank's directions at 0 and at a quarter turn, and its axis.
    crank_axes: [Precise; 3],
    rail: Precise,
    hinge: Precise,
    gravity: Precise,
}

struct PreciseMember {
    length: DoubleDouble,
    centre: DoubleDouble,
    heft: Heft,
}

/// Where joints and bodies are.
struct Pose {
    displacement: Jet,
    crank: Moving,
    rod: Moving,
    slider: Moving,
}

impl SliderCrank {
    /// Crank and rod of 0.1 and 0.3 m in a plane, the slider on a line through the pivot along x; gravity 9.81 m/s²
    /// along −y; the crank starts at 40 degrees with 12 rad/s.
    #[must_use]
    pub fn in_line() -> Self {
        let member = |length: f64, mass, inertia| Member { length, centre: 0.5 * length, mass, inertia };
        SliderCrank {
            crank: member(0.1, 0.5, [3e-5, 6e-4, 6e-4]),
            rod: member(0.3, 0.4, [2e-5, 3.2e-3, 3.2e-3]),
            slider: 0.6,
            pivot: [0.0; 3],
            axis: [0.0, 0.0, 1.0],
            zero: [1.0, 0.0, 0.0],
            rail: [1.0, 0.0, 0.0],
            hinge: [0.0, 0.0, 1.0],
            gravity: [0.0, -9.81, 0.0],
            start: 40f64.to_radians(),
            rate: 12.0,
        }
    }

    /// A crank of 0.08 m that turns about an axis parallel to the rail, 0.1 and 0.12 m beside it; a rod of 0.3 m;
    /// gravity 9.81 m/s² along −z; the crank starts upright with 6 rad/s.
    #[must_use]
    pub fn spatial() -> Self {
        SliderCrank {
            crank: Member { length: 0.08, centre: 0.03, mass: 0.12, inertia: [1e-5, 1e-4, 1e-4] },
            rod: Member { length: 0.3, centre: 0.14, mass: 0.5, inertia: [4e-4, 4e-3, 3.9e-3] },
            slider: 2.0,
            pivot: [0.0, 0.1, 0.12],
            axis: [1.0, 0.0, 0.0],
            zero: [0.0, 0.0, 1.0],
            rail: [1.0, 0.0, 0.0],
            hinge: [0.0, 0.0, 1.0],
            gravity: [0.0, 0.0, -9.81],
            start: 0.0,
            rate: 6.0,
        }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or the rod is too short for a crank angle that is reached.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<SliderCrankSample> {
        let mechanism = self.precisely();
        let samples = motion(&mechanism, decimals([self.start, self.rate]), times);
        samples.iter().map(|(t, state)| mechanism.sample(*t, state)).collect()
    }

    fn precisely(&self) -> Precisely {
        let member = |member: &Member| PreciseMember {
            length: decimal(member.length),
            centre: decimal(member.centre),
            heft: Heft::diagonal(member.mass, member.inertia),
        };
        let (axis, zero) = (decimals(self.axis), decimals(self.zero));
        Precisely {
            crank: member(&self.crank),
            rod: member(&self.rod),
            slider: decimal(self.slider),
            pivot: decimals(self.pivot),
            crank_axes: [zero, cross(axis, zero), axis],
            rail: decimals(self.rail),
            hinge: decimals(self.hinge),
            gravity: decimals(self.gravity),
        }
    }
}

impl OneFreedom for Precisely {
    fn bodies(&self, angle: Jet) -> Vec<(Heft, Moving)> {
        let Pose { crank, rod, slider, .. } = self.pose(angle);
        let moved = Heft { mass: self.slider, inertia: [DoubleDouble::ZERO; 6] };
        vec![(self.crank.heft, crank), (self.rod.heft, rod), (moved, slider)]
    }

    fn gravity(&self) -> Precise {
        self.gravity
    }
}

impl Precisely {
    fn pose(&self, angle: Jet) -> Pose {
        let (sin, cos) = angle.sin_cos();
        let [f, g, axis] = self.crank_axes.map(fixed);
        let crank = plus(along(cos, f), along(sin, g));
        let across = plus(along(cos, g), along(-sin, f));
        let (pivot, rail) = (fixed(self.pivot), fixed(self.rail));
        let on_crank = |distance| plus(pivot, crank.map(|x: Jet| x.scaled(distance)));
        let end = on_crank(self.crank.length);
        let near = inner(rail, end);
        let squared = self.rod.length * self.rod.length;
        let displacement = near + (near * near - inner(end, end) + Jet::constant(squared)).sqrt();
        let u = unit(minus(along(displacement, rail), end));
        let y = unit(outer(fixed(self.hinge), u));
        let no_turn = Rotation::IDENTITY.0.map(fixed);
        Pose {
            displacement,
            crank: Moving { centre: on_crank(self.crank.centre), axes: [crank, across, axis] },
            rod: Moving {
                centre: plus(end, u.map(|x| x.scaled(self.rod.centre))),
                axes: [u, y, outer(u, y)],
            },
            slider: Moving { centre: along(displacement, rail), axes: no_turn },
        }
    }

    fn sample(&self, t: DoubleDouble, state: &State<2>) -> SliderCrankSample {
        let [angle, rate] = *state;
        let Pose { displacement, rod, .. } = self.pose(Jet::variable(angle));
        SliderCrankSample {
            t: t.to_f64(),
            angle: angle.to_f64(),
            rate: rate.to_f64(),
            acceleration: acceleration(self, *state).to_f64(),
            displacement: displacement.0[0].to_f64(),
            displacement_rate: (displacement.0[1] * rate).to_f64(),
            rod: body_state(&rod, rate),
            energy: energy(self, *state).to_f64(),
        }
    }
}

/// Of a body whose variable moves at `rate`.
pub(crate) fn body_state(body: &Moving, rate: DoubleDouble) -> BodyState {
    let axes = Rotation(body.axes.map(|axis: Arrow| axis.map(|x| x.0[0])));
    BodyState {
        position: rounded(body.centre_derivative(0)),
        rotation: axes.rounded(),
        velocity: rounded(scale(rate, body.centre_derivative(1))),
        angular_velocity: rounded(scale(rate, body.turning()[0])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check_energy(mechanism: SliderCrank) {
        let samples = mechanism.solve(&[0.0, 0.6, 2.0]);
        for sample in &samples {
            let error = (sample.energy - samples[0].energy).abs();
            assert!(error < 1e-15 * (1.0 + samples[0].energy), "{sample:?}");
        }
        assert!(samples[2].angle.abs() > 3.0, "{samples:?}");
    }

    #[test]
    fn energy_is_kept() {
        check_energy(SliderCrank::in_line());
        check_energy(SliderCrank::spatial());
    }

    #[test]
    fn accelerations_are_derivatives_of_rates() {
        const STEP: f64 = 1e-5;
        for mechanism in [SliderCrank::in_line(), SliderCrank::spatial()] {
            let samples = mechanism.solve(&[0.3 - STEP, 0.3, 0.3 + STEP]);
            let slope = (samples[2].rate - samples[0].rate) / (2.0 * STEP);
            assert!(
                (samples[1].acceleration - slope).abs() < 1e-6 * (1.0 + slope.abs()),
                "{samples:?} {slope}"
            );
        }
    }

    /// The textbook's formulas: sin φ = −(a/l) sin θ, x = a cos θ + l cos φ.
    #[test]
    fn in_line_the_slider_is_where_the_textbook_has_it() {
        let samples = SliderCrank::in_line().solve(&[0.05, 0.2]);
        for sample in samples {
            let (sin, cos) = sample.angle.sin_cos();
            let lean = (-0.1 / 0.3 * sin).asin();
            assert!((sample.displacement - 0.1 * cos - 0.3 * lean.cos()).abs() < 1e-15, "{sample:?}");
            let lean_rate = -0.1 * cos * sample.rate / (0.3 * lean.cos());
            assert!((sample.rod.angular_velocity[2] - lean_rate).abs() < 1e-13, "{sample:?}");
            let speed = -0.1 * sin * sample.rate - 0.3 * lean.sin() * lean_rate;
            assert!((sample.displacement_rate - speed).abs() < 1e-14, "{sample:?}");
        }
    }

    /// The rod's angular velocity has no part along h × y, which the cross of a universal joint cannot follow.
    #[test]
    fn the_rod_turns_about_the_axes_of_its_joint() {
        for sample in SliderCrank::spatial().solve(&[0.1, 0.4]) {
            let rotation = sample.rod.rotation;
            let y = rotation.map(|row| row[1]);
            let w = rotation.map(|row| (0..3).map(|k| row[k] * sample.rod.angular_velocity[k]).sum::<f64>());
            let normal = cross([0.0, 0.0, 1.0], y);
            let beside: f64 = (0..3).map(|k| normal[k] * w[k]).sum();
            assert!(beside.abs() < 1e-14 && y[2].abs() < 1e-16 && w[2].abs() > 1e-2, "{w:?} {normal:?}");
        }
    }
}
