//! Motions with a closed form, one for each simple joint: what moves is written down, nothing is integrated.
//!
//! Everything is an elementary function of time, evaluated in `f64` to a few units in the last place. The
//! joint frame (f, g, h) of the first body rests; coordinates and their signs are those of displacements
//! along it and angles about h.

/// A value with its first and second derivative in time.
pub type Derivatives = [f64; 3];

/// `x0 + v0 t + ½ a t²` with its derivatives.
fn uniform(start: f64, rate: f64, acceleration: f64, t: f64) -> Derivatives {
    [start + rate * t + 0.5 * acceleration * t * t, rate + acceleration * t, acceleration]
}

/// `rest + (x0 − rest) cos ω t + v0/ω sin ω t` with its derivatives: the solution of ẍ = −ω² (x − rest).
fn harmonic(rest: f64, squared: f64, [start, rate]: [f64; 2], t: f64) -> Derivatives {
    let omega = squared.sqrt();
    let (sin, cos) = (omega * t).sin_cos();
    let size = start - rest;
    [
        rest + size * cos + rate / omega * sin,
        rate * cos - size * omega * sin,
        -squared * (size * cos + rate / omega * sin),
    ]
}

/// A prismatic joint: a body on an inclined rail, with or without a spring to it.
///
/// m ẍ = m g − k (x − free), g the part of gravity along the rail.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slider {
    /// Mass, kg.
    pub mass: f64,
    /// Gravity along the axis h, m/s².
    pub gravity: f64,
    /// Stiffness, N/m; zero for no spring.
    pub stiffness: f64,
    /// Displacement at which the spring is free, m.
    pub free: f64,
    /// Displacement (m) and its rate (m/s) at time zero.
    pub start: [f64; 2],
}

impl Slider {
    /// Displacement, rate and acceleration at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> Derivatives {
        let [start, rate] = self.start;
        if self.stiffness == 0.0 {
            return uniform(start, rate, self.gravity, t);
        }
        let rest = self.free + self.mass * self.gravity / self.stiffness;
        harmonic(rest, self.stiffness / self.mass, self.start, t)
    }
}

/// A planar joint: a block that slides and spins on a plane. Its mass centre falls freely in the plane, its
/// spin is steady; the joint point goes round the mass centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarBlock {
    /// Gravity along f and g, m/s².
    pub gravity: [f64; 2],
    /// The block's joint point from its mass centre, in the plane and the block's joint frame (its own f and
    /// g), m.
    pub point: [f64; 2],
    /// x, y (m) and angle (rad) of the joint at time zero.
    pub start: [f64; 3],
    /// Their rates.
    pub rates: [f64; 3],
}

impl PlanarBlock {
    /// x, y and angle of the joint, each with rate and acceleration, at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> [Derivatives; 3] {
        let spin = self.rates[2];
        let angle = uniform(self.start[2], spin, 0.0, t);
        let (first, now) = (self.arm(self.start[2]), self.arm(angle[0]));
        let [x, y] = [0, 1].map(|axis| {
            // An arm turning at ω moves at ω times itself a quarter turn on, and accelerates at −ω² times
            // itself.
            let centre_rate = self.rates[axis] - spin * first[1][axis];
            let centre = uniform(self.start[axis] - first[0][axis], centre_rate, self.gravity[axis], t);
            [
                centre[0] + now[0][axis],
                centre[1] + spin * now[1][axis],
                centre[2] - spin * spin * now[0][axis],
            ]
        });
        [x, y, angle]
    }

    /// The arm to the joint point, and the same a quarter turn on.
    fn arm(&self, angle: f64) -> [[f64; 2]; 2] {
        let (sin, cos) = angle.sin_cos();
        let [x, y] = self.point;
        let arm = [cos * x - sin * y, sin * x + cos * y];
        [arm, [-arm[1], arm[0]]]
    }
}

/// A cylindrical joint about the vertical: a body that spins steadily and falls freely along the axis h,
/// which points up. Its mass centre lies beside the axis, and its products of inertia with the axis vanish.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingSpindle {
    /// Mass, kg.
    pub mass: f64,
    /// Size of gravity, m/s².
    pub gravity: f64,
    /// Distance of the mass centre from the joint point along the body's own f, m.
    pub eccentricity: f64,
    /// Angle (rad) and its rate (rad/s) at time zero.
    pub angle: [f64; 2],
    /// Displacement (m) and its rate (m/s) at time zero.
    pub displacement: [f64; 2],
}

impl FallingSpindle {
    /// Angle and displacement, each with rate and acceleration, at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> [Derivatives; 2] {
        let ([angle, spin], [height, rate]) = (self.angle, self.displacement);
        [uniform(angle, spin, 0.0, t), uniform(height, rate, -self.gravity, t)]
    }

    /// The mass centre along f, g and h from the first body's joint point at time `t`, m.
    #[must_use]
    pub fn centre(&self, t: f64) -> [f64; 3] {
        let [[angle, ..], [height, ..]] = self.at(t);
        let (sin, cos) = angle.sin_cos();
        [self.eccentricity * cos, self.eccentricity * sin, height]
    }

    /// The joint's force on the body along f, g and h at time `t`, N: towards the axis, −m ω² e. Its torque
    /// about the body's joint point vanishes.
    #[must_use]
    pub fn reaction(&self, t: f64) -> [f64; 3] {
        let (sin, cos) = self.at(t)[0][0].sin_cos();
        let pull = -self.mass * self.angle[1] * self.angle[1] * self.eccentricity;
        [pull * cos, pull * sin, 0.0]
    }
}

/// A screw about the vertical under gravity, h pointing up: (J + m lead²) θ̈ = −m g lead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FallingScrew {
    /// Mass, kg; the mass centre lies on the axis.
    pub mass: f64,
    /// Moment of inertia about the axis, kg·m².
    pub inertia: f64,
    /// Size of gravity, m/s².
    pub gravity: f64,
    /// Advance along the axis per radian, m/rad.
    pub lead: f64,
    /// Angle (rad) and its rate (rad/s) at time zero. The displacement is lead times the angle.
    pub start: [f64; 2],
}

impl FallingScrew {
    /// Angle, rate and acceleration at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> Derivatives {
        let inertia = self.inertia + self.mass * self.lead * self.lead;
        uniform(self.start[0], self.start[1], -self.mass * self.gravity * self.lead / inertia, t)
    }

    /// Force (N) and torque (N·m) of the thread on the body along h; −lead times the force is the torque.
    #[must_use]
    pub fn reaction(&self) -> [f64; 2] {
        let [.., acceleration] = self.at(0.0);
        [self.mass * (self.gravity + self.lead * acceleration), self.inertia * acceleration]
    }
}

/// Two discs on fixed axes with a gear between them, θ2 = ratio θ1 + offset, a constant torque on the first
/// and a torsional spring from the ground to the second: (J1 + ratio² J2) θ̈1 = torque − ratio k (θ2 − free).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GearedDiscs {
    /// Moments of inertia about the axes, kg·m².
    pub inertia: [f64; 2],
    /// Ratio of the gear.
    pub ratio: f64,
    /// θ2 where θ1 is zero, rad.
    pub offset: f64,
    /// Torque on the first disc, N·m.
    pub torque: f64,
    /// Stiffness of the spring on the second, N·m/rad; zero for none.
    pub stiffness: f64,
    /// θ2 at which the spring is free, rad.
    pub free: f64,
    /// θ1 (rad) and its rate (rad/s) at time zero.
    pub start: [f64; 2],
}

impl GearedDiscs {
    /// θ1 and θ2, each with rate and acceleration, at time `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> [Derivatives; 2] {
        let inertia = self.inertia[0] + self.ratio * self.ratio * self.inertia[1];
        let first = if self.stiffness == 0.0 {
            uniform(self.start[0], self.start[1], self.torque / inertia, t)
        } else {
            let stiffness = self.ratio * self.ratio * self.stiffness;
            let rest = (self.torque / (self.ratio * self.stiffness) + self.free - self.offset) / self.ratio;
            harmonic(rest, stiffness / inertia, self.start, t)
        };
        let [angle, rate, acceleration] = first.map(|x| self.ratio * x);
        [first, [angle + self.offset, rate, acceleration]]
    }

    /// The multiplier of the row θ2 − ratio θ1 − offset at time `t`, N·m: −λ is the gear's torque on the
    /// second disc, ratio λ that on the first.
    #[must_use]
    pub fn multiplier(&self, t: f64) -> f64 {
        let [_, [angle, _, acceleration]] = self.at(t);
        -self.stiffness * (angle - self.free) - self.inertia[1] * acceleration
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BaseMotion, Chain, Link};

    /// Rounding of the closed forms and of both sides' samples.
    const ROUNDING: f64 = 1e-14;

    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < ROUNDING * (1.0 + expected.abs()), "{found} but {expected}");
    }

    fn all_near<const N: usize>(found: [f64; N], expected: [f64; N]) {
        found.into_iter().zip(expected).for_each(|(f, e)| near(f, e));
    }

    fn chain<const N: usize>(gravity: [f64; 3], links: [Link; N]) -> Chain<N> {
        Chain { gravity, base: BaseMotion::default(), links }
    }

    #[test]
    fn sliders_move_like_chains_of_one_link() {
        for stiffness in [0.0, 37.0] {
            let slider = Slider { mass: 1.3, gravity: -4.905, stiffness, free: 0.2, start: [0.5, 1.5] };
            // The rail rises at 30 degrees: only half of gravity acts along it.
            let rail = Link {
                stiffness,
                free: 0.2,
                start: 0.5,
                rate: 1.5,
                ..Link::sliding([3.0f64.sqrt(), 1.0, 0.0])
            };
            let links = [rail.with_body(1.3, [1.0; 3])];
            for sample in chain([0.0, -9.81, 0.0], links).solve(&[0.3, 2.0]) {
                let [x, rate, acceleration] = slider.at(sample.t);
                near(x, sample.positions[0]);
                near(rate, sample.rates[0]);
                near(acceleration, sample.accelerations[0]);
            }
        }
    }

    #[test]
    fn blocks_move_like_chains_of_three_links() {
        let block = PlanarBlock {
            gravity: [1.5, -4.0],
            point: [0.2, -0.1],
            start: [0.3, -0.4, 0.7],
            rates: [1.0, 2.0, -6.0],
        };
        let started = |link: Link, k: usize| Link { start: block.start[k], rate: block.rates[k], ..link };
        let turning = Link { own: [0.2, -0.1, 0.0], ..Link::turning([0.0, 0.0, 1.0]) };
        let links = [
            started(Link::sliding([1.0, 0.0, 0.0]), 0),
            started(Link::sliding([0.0, 1.0, 0.0]), 1),
            started(turning.with_body(0.8, [0.01, 0.02, 0.025]), 2),
        ];
        for sample in chain([1.5, -4.0, -8.0], links).solve(&[0.3, 2.0]) {
            let motion = block.at(sample.t);
            for (k, derivatives) in motion.into_iter().enumerate() {
                all_near(derivatives, [sample.positions[k], sample.rates[k], sample.accelerations[k]]);
            }
        }
    }

    #[test]
    fn spindles_move_and_pull_like_chains_of_two_links() {
        let spindle = FallingSpindle {
            mass: 0.8,
            gravity: 9.81,
            eccentricity: 0.15,
            angle: [0.4, 11.0],
            displacement: [0.5, 2.0],
        };
        let turning =
            Link { own: [-0.15, 0.0, 0.0], start: 0.4, rate: 11.0, ..Link::turning([0.0, 0.0, 1.0]) };
        let links = [
            Link { start: 0.5, rate: 2.0, ..Link::sliding([0.0, 0.0, 1.0]) },
            turning.with_body(0.8, [0.01, 0.02, 0.025]),
        ];
        for sample in chain([0.0, 0.0, -9.81], links).solve(&[0.3, 1.0]) {
            let [angle, height] = spindle.at(sample.t);
            all_near([height[0], angle[0]], sample.positions);
            all_near([height[1], angle[1]], sample.rates);
            all_near([height[2], angle[2]], sample.accelerations);
            all_near(spindle.centre(sample.t), sample.bodies[1].position);
            all_near(spindle.reaction(sample.t), sample.reactions[1].force);
            all_near([0.0; 3], sample.reactions[1].torque);
        }
    }

    #[test]
    fn a_screw_trades_its_height_for_spin() {
        let screw = FallingScrew { mass: 2.0, inertia: 0.003, gravity: 9.81, lead: 0.02, start: [0.5, 4.0] };
        let energy = |t: f64| {
            let [angle, rate, _] = screw.at(t);
            let turning = 0.5 * 0.003 * rate * rate;
            turning + 0.5 * 2.0 * (0.02 * rate).powi(2) + 2.0 * 9.81 * 0.02 * angle
        };
        near(energy(0.7), energy(0.0));
        let [force, torque] = screw.reaction();
        near(torque, -0.02 * force);
        near(screw.at(0.7)[0], 0.5 + 4.0 * 0.7 + 0.5 * screw.at(0.0)[2] * 0.49);
    }

    #[test]
    fn gears_share_energy_and_torque() {
        for stiffness in [0.0, 0.4] {
            let discs = GearedDiscs {
                inertia: [0.02, 0.05],
                ratio: -2.5,
                offset: 0.3,
                torque: 0.7,
                stiffness,
                free: -0.2,
                start: [0.1, 3.0],
            };
            let energy = |t: f64| {
                let [[first, rate1, _], [second, rate2, _]] = discs.at(t);
                let kinetic = 0.5 * (0.02 * rate1 * rate1 + 0.05 * rate2 * rate2);
                kinetic + 0.5 * stiffness * (second + 0.2).powi(2) - 0.7 * first
            };
            near(energy(1.7), energy(0.0));
            let ([[.., acceleration1], second], lambda) = (discs.at(1.7), discs.multiplier(1.7));
            near(0.02 * acceleration1, 0.7 + -2.5 * lambda);
            near(0.05 * second[2], -stiffness * (second[0] + 0.2) - lambda);
        }
    }
}
