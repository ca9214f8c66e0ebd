//! The compound pendulum in its plane, with the force in its bearing.
//!
//! θ counts from the direction of gravity: (J + m d²) θ̈ = −m g d sin θ. With f along gravity and g to the
//! side to which θ grows, the mass centre is r = d (cos θ, sin θ), and Newton's law m r̈ = F + m g f gives
//! the bearing's force F on the body.

use crate::extrapolation::State;
use crate::trajectory::{decimal, rounded, smooth_trajectory};
use crate::{Bar, DoubleDouble};

/// A pendulum and its start. Numbers are the decimals they print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pendulum {
    /// Mass, kg.
    pub mass: f64,
    /// Moment of inertia about the axis through the mass centre, kg·m².
    pub inertia: f64,
    /// From the bearing to the mass centre, m.
    pub distance: f64,
    /// Size of gravity, m/s².
    pub gravity: f64,
    /// Angle at time zero, rad.
    pub start: f64,
    /// Rate at time zero, rad/s.
    pub rate: f64,
}

/// A [`Pendulum`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendulumSample {
    /// Time, s.
    pub t: f64,
    /// θ, rad.
    pub angle: f64,
    /// θ̇, rad/s.
    pub rate: f64,
    /// θ̈, rad/s².
    pub acceleration: f64,
    /// Force of the bearing on the body along gravity and to the side, N: along f and g of a joint frame with
    /// f along gravity and h the axis. Its other components vanish, and so does the torque if the axis is a
    /// principal one.
    pub force: [f64; 2],
    /// Kinetic energy and −m g d cos θ, J.
    pub energy: f64,
}

impl Pendulum {
    /// A slender rod of 1 m and 1.2 kg hung at its end, released from the horizontal: J = 0.1 kg·m², gravity
    /// 9.81 m/s².
    #[must_use]
    pub fn slender_rod() -> Self {
        Pendulum {
            mass: 1.2,
            inertia: 0.1,
            distance: 0.5,
            gravity: 9.81,
            start: core::f64::consts::FRAC_PI_2,
            rate: 0.0,
        }
    }

    /// A parallelogram linkage hung from two pivots at one height: crank, coupler and rocker, crank and
    /// rocker of one length, mass centres on the lines of their joints. The coupler only goes round with the
    /// crank's end, so the linkage swings as this pendulum does, also through the poses with all bars in
    /// line. Angle and rate are those of crank and rocker.
    #[must_use]
    pub fn parallelogram([crank, coupler, rocker]: [Bar; 3], gravity: f64, start: f64, rate: f64) -> Self {
        let parts =
            [(crank.mass, crank.centre[0]), (coupler.mass, crank.length), (rocker.mass, rocker.centre[0])];
        let mass = crank.mass + coupler.mass + rocker.mass;
        let distance = parts.iter().map(|(mass, arm)| mass * arm).sum::<f64>() / mass;
        let about_pivots: f64 = parts.iter().map(|(mass, arm)| mass * arm * arm).sum();
        let inertia = crank.inertia + rocker.inertia + about_pivots - mass * distance * distance;
        Pendulum { mass, inertia, distance, gravity, start, rate }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend or a number is not finite.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<PendulumSample> {
        let start = [decimal(self.start), decimal(self.rate)];
        let pull = self.pull();
        let motion = smooth_trajectory(|_, state: &State<2>| derivative(pull, state), start, times);
        motion.iter().map(|(t, state)| self.sample(*t, state)).collect()
    }

    /// Torque, N·m, that gives it `acceleration` (rad/s²) at `angle` (rad): what a driver of the bearing must
    /// exert.
    #[must_use]
    pub fn driving_torque(&self, angle: f64, acceleration: f64) -> f64 {
        let inertia = self.inertia + self.mass * self.distance * self.distance;
        inertia * acceleration + self.mass * self.gravity * self.distance * angle.sin()
    }

    /// m g d / (J + m d²).
    fn pull(&self) -> DoubleDouble {
        let (mass, distance) = (decimal(self.mass), decimal(self.distance));
        mass * decimal(self.gravity) * distance / (decimal(self.inertia) + mass * distance * distance)
    }

    fn sample(&self, t: DoubleDouble, state: &State<2>) -> PendulumSample {
        let [angle, rate] = *state;
        let [_, acceleration] = derivative(self.pull(), state);
        let (mass, distance, gravity) = (decimal(self.mass), decimal(self.distance), decimal(self.gravity));
        let (sin, cos) = angle.sin_cos();
        let inwards = rate * rate;
        // d²/dt² of d (cos θ, sin θ), less gravity along f.
        let down = -(distance * (acceleration * sin + inwards * cos)) - gravity;
        let aside = distance * (acceleration * cos - inwards * sin);
        let inertia = decimal(self.inertia) + mass * distance * distance;
        let energy = (inertia * inwards).times(0.5) - mass * gravity * distance * cos;
        PendulumSample {
            t: t.to_f64(),
            angle: angle.to_f64(),
            rate: rate.to_f64(),
            acceleration: acceleration.to_f64(),
            force: rounded([mass * down, mass * aside]),
            energy: energy.to_f64(),
        }
    }
}

fn derivative(pull: DoubleDouble, &[angle, rate]: &State<2>) -> State<2> {
    [rate, -(pull * angle.sin_cos().0)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BaseMotion, Chain, Link};

    /// T = 4 √(I / (m g d)) K(sin 45°) with K = 1.854074677301371918434 (Landau and Lifshitz, *Mechanics*,
    /// section 11).
    const PERIOD: f64 = 1.933_334_854_373_245_8;

    #[test]
    fn the_period_is_the_elliptic_integral() {
        let [back, half] = [PERIOD, PERIOD / 2.0].map(|t| Pendulum::slender_rod().solve(&[t])[0]);
        // At the ends of the swing the angle is stationary; its rate tells the time.
        assert!(back.rate.abs() < 1e-14 && half.rate.abs() < 1e-14, "{back:?} {half:?}");
        assert!((back.angle + half.angle).abs() < 1e-15);
    }

    #[test]
    fn the_bearing_carries_what_statics_and_energy_say() {
        let rod = Pendulum::slender_rod();
        let released = rod.solve(&[0.0])[0];
        // A level rod released at its end: the bearing carries a quarter of its weight.
        assert!((released.force[0] + 1.2 * 9.81 / 4.0).abs() < 1e-14, "{released:?}");
        assert!(released.force[1].abs() < 1e-14);
        // At the lowest point m g + m d θ̇², θ̇² = 2 m g d / I.
        let lowest = rod.solve(&[PERIOD / 4.0])[0];
        assert!((lowest.force[0] + 1.2 * 9.81 * 2.5).abs() < 1e-13, "{lowest:?}");
        assert!((released.energy - lowest.energy).abs() < 1e-15);
        // Nothing drives it.
        let swinging = rod.solve(&[0.3])[0];
        assert!(rod.driving_torque(swinging.angle, swinging.acceleration).abs() < 1e-14);
        assert!((rod.driving_torque(0.0, 2.0) - 0.8).abs() < 1e-15);
    }

    /// Newton and Euler along a chain of one link; f is along gravity, −y, and g along x.
    #[test]
    fn the_chain_of_one_turn_moves_and_pulls_alike() {
        let rod = Pendulum { start: 0.5, rate: -3.0, ..Pendulum::slender_rod() };
        let link = Link { own: [0.0, 0.5, 0.0], start: 0.5, rate: -3.0, ..Link::turning([0.0, 0.0, 1.0]) };
        let links = [link.with_body(1.2, [0.1, 0.01, 0.1])];
        let chain = Chain { gravity: [0.0, -9.81, 0.0], base: BaseMotion::default(), links };
        for (found, expected) in rod.solve(&[0.0, 0.7]).iter().zip(chain.solve(&[0.0, 0.7])) {
            assert_eq!([found.angle], expected.positions);
            assert_eq!([found.acceleration], expected.accelerations);
            assert_eq!(found.energy, expected.energy);
            let reaction = expected.reactions[0].in_joint_frame([0.0, -1.0, 0.0], [0.0, 0.0, 1.0]);
            let ([down, aside, rest @ ..], [expected_down, expected_aside]) = (reaction, found.force);
            assert_eq!([down, aside], [expected_down, expected_aside]);
            assert!(rest.iter().all(|part| part.abs() < 1e-29), "{rest:?}");
        }
    }
}
