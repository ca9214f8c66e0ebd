//! Bennett's linkage of sides 1 and 2, twisted by 30 and 90 degrees, reduced to the angle of its first joint.
//!
//! With θ0 and θ1 from normal to normal about neighbouring axes, `tan(θ0/2) tan(θ1/2) = sin(½(β + α)) / sin(½(β − α))`;
//! opposite angles are opposite. With `T = ½ I(θ0) θ̇0²` and the potential V(θ0) it follows that
//! `I θ̈0 = −½ I' θ̇0² − V'`.

use crate::{Axis, Link, Loop};
use nalgebra::Vector3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

/// Three links that move, and the ground.
#[derive(Clone, Copy, Debug)]
pub struct WholeNumbers;

const GRAVITY: f64 = 9.81;

/// Mass of a link, and its moments of inertia along the link and across.
const LINKS: [(f64, [f64; 2]); 3] =
    [(1.0, [0.001, 0.083_333]), (2.0, [0.002, 0.666_667]), (1.0, [0.001, 0.083_333])];

impl WholeNumbers {
    /// θ0 and its rate.
    pub const START: [f64; 2] = [FRAC_PI_2, 1.0];

    /// θ1 and its first two derivatives by θ0.
    fn second(angle: f64) -> [f64; 3] {
        let ratio = ((FRAC_PI_2 + FRAC_PI_6) / 2.0).sin() / ((FRAC_PI_2 - FRAC_PI_6) / 2.0).sin();
        let (sine, cosine) = (angle / 2.0).sin_cos();
        let square = ratio * ratio * cosine * cosine + sine * sine;
        let slope = -ratio / square;
        let bend = ratio * (1.0 - ratio * ratio) * sine * cosine / (square * square);
        [2.0 * (ratio * cosine).atan2(sine), slope, bend]
    }

    /// Axes of the joints, from θ0.
    fn axes(angle: f64) -> Vec<Axis> {
        let [second, ..] = Self::second(angle);
        let link = |length, twist| Link { length, twist, offset: 0.0 };
        let links = [(1.0, FRAC_PI_6), (2.0, FRAC_PI_2), (1.0, FRAC_PI_6), (2.0, FRAC_PI_2)];
        let links = links.map(|(length, twist)| link(length, twist)).to_vec();
        Loop { name: "bennett", links }.around(&[angle, second, -angle, -second]).0
    }

    /// Centres of the links.
    pub fn places(angle: f64) -> [[f64; 3]; 3] {
        let axes = Self::axes(angle);
        [0, 1, 2].map(|k| ((axes[k].point + axes[k + 1].point) / 2.0).into())
    }

    /// I and V.
    fn energies(angle: f64) -> [f64; 2] {
        let axes = Self::axes(angle);
        let [_, slope, _] = Self::second(angle);
        let (mut turning, mut moving) = (Vector3::zeros(), Vector3::zeros());
        let mut energies = [0.0; 2];
        for (k, ((mass, [along, across]), rate)) in LINKS.into_iter().zip([1.0, slope, -1.0]).enumerate() {
            let normal = (axes[k + 1].point - axes[k].point).normalize();
            turning += axes[k].direction * rate;
            let arm = (axes[k + 1].point - axes[k].point) / 2.0;
            moving += turning.cross(&arm);
            let spin = turning.dot(&normal);
            let inertia = across * (turning.norm_squared() - spin * spin) + along * spin * spin;
            energies[0] += mass * moving.norm_squared() + inertia;
            energies[1] += mass * GRAVITY * (axes[k].point + arm).z;
            moving += turning.cross(&arm);
        }
        energies
    }

    /// θ̈0. Slopes are differences of sixth order.
    fn acceleration([angle, rate]: [f64; 2]) -> f64 {
        let step = 0.01;
        let difference = |n: f64| {
            let [ahead, behind] = [n, -n].map(|n| Self::energies(angle + n * step));
            [0, 1].map(|k| ahead[k] - behind[k])
        };
        let [one, two, three] = [1.0, 2.0, 3.0].map(difference);
        let slope = |k: usize| (45.0 * one[k] - 9.0 * two[k] + three[k]) / (60.0 * step);
        let [inertia, _] = Self::energies(angle);
        -(slope(0) * rate * rate / 2.0 + slope(1)) / inertia
    }

    /// θ0 and its rate after some seconds, by the classical method of fourth order.
    pub fn after(time: f64, step: f64) -> [f64; 2] {
        let steps = (time / step).round();
        let h = time / steps;
        let slope = |y: [f64; 2]| [y[1], Self::acceleration(y)];
        let moved = |y: [f64; 2], k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
        let mut y = Self::START;
        for _ in 0..steps as usize {
            let a = slope(y);
            let b = slope(moved(y, a, h / 2.0));
            let c = slope(moved(y, b, h / 2.0));
            let d = slope(moved(y, c, h));
            y = [0, 1].map(|k| y[k] + h / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]));
        }
        y
    }

    /// Angle of a joint, its rate and its acceleration.
    ///
    /// # Panics
    /// There are four.
    pub fn joint(joint: usize, state: [f64; 2]) -> [f64; 3] {
        let [angle, rate] = state;
        let acceleration = Self::acceleration(state);
        let [second, slope, bend] = Self::second(angle);
        let first = [angle, rate, acceleration];
        let second = [second, slope * rate, slope * acceleration + bend * rate * rate];
        match joint {
            0 => first,
            1 => second,
            2 => first.map(|x| -x),
            3 => second.map(|x| -x),
            _ => unreachable!("no joint {joint}"),
        }
    }
}
