//! Chains of bodies in minimal coordinates, on a base at rest or moved by prescription.
//!
//! The forward equations M(q) q̈ = τ − b come from the inverse ones of [`newton_euler`](crate::newton_euler),
//! evaluated for no acceleration (b) and for unit accelerations (columns of M): Walker and Orin (1982),
//! method 1. A joint of two freedoms is two links, the first without mass.

use crate::base_motion::{BaseMotion, FrameMotion, PreciseBase};
use crate::extrapolation::State;
use crate::link::Link;
use crate::newton_euler::{LinkMotion, Load, PreciseLink, inwards, outwards};
use crate::rotation::Precise;
use crate::trajectory::{decimal, decimals, rounded, smooth_trajectory};
use crate::vector::{add, cross, dot, sub};
use crate::{BodyState, DoubleDouble};

/// A chain of `N` links.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain<const N: usize> {
    /// Acceleration of gravity, global, m/s².
    pub gravity: [f64; 3],
    /// Motion of the base.
    pub base: BaseMotion,
    /// The links, from the base outwards.
    pub links: [Link; N],
}

/// What a joint transmits: without the spring's and the damper's part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force on the link, in the frame of the link before, N.
    pub force: [f64; 3],
    /// Torque on the link about its own joint point, in the frame of the link before, N·m.
    pub torque: [f64; 3],
}

impl Wrench {
    /// Force and torque resolved along (f, g, h), g = h × f, for unit vectors f and h of the frame of the
    /// link before.
    #[must_use]
    pub fn in_joint_frame(&self, f: [f64; 3], h: [f64; 3]) -> [f64; 6] {
        let frame = [f, cross(h, f), h];
        let [force, torque] = [self.force, self.torque].map(|v| frame.map(|axis| dot(axis, v)));
        [force[0], force[1], force[2], torque[0], torque[1], torque[2]]
    }
}

/// What an inertial sensor reads, in its body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InertialReading {
    /// Aᵀ(r̈ − g) at the sensor, m/s².
    pub specific_force: [f64; 3],
    /// Angular velocity w', rad/s.
    pub angular_rate: [f64; 3],
}

/// A chain at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainSample<const N: usize> {
    /// Time, s.
    pub t: f64,
    /// Coordinates, rad or m.
    pub positions: [f64; N],
    /// Their rates.
    pub rates: [f64; N],
    /// Their accelerations.
    pub accelerations: [f64; N],
    /// Kinetic energy, potential energy −m g·r and energy of the springs, J.
    pub energy: f64,
    /// What the energy has gained since time zero, without the rounding of the energy itself, J.
    pub energy_gain: f64,
    /// What whoever moves the base has done so far, J.
    pub base_work: f64,
    /// What it does per second, W.
    pub base_power: f64,
    /// What the dampers have done so far, J; never positive.
    pub damping_work: f64,
    /// The links' bodies.
    pub bodies: [BodyState; N],
    /// Accelerations of their mass centres, global, m/s².
    pub body_accelerations: [[f64; 3]; N],
    /// Their angular accelerations in their own frames, rad/s².
    pub angular_accelerations: [[f64; 3]; N],
    /// What each joint exerts on its link.
    pub reactions: [Wrench; N],
}

/// A [`Chain`] in double-double numbers.
struct PreciseChain<const N: usize> {
    links: [PreciseLink; N],
    gravity: Precise,
    base: PreciseBase,
}

/// How a chain stands at an instant.
struct Instant<'a, const N: usize> {
    chain: &'a PreciseChain<N>,
    base: FrameMotion,
    positions: [DoubleDouble; N],
    rates: [DoubleDouble; N],
}

impl<const N: usize> Chain<N> {
    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or a mass matrix is singular.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<ChainSample<N>> {
        match N {
            1 => self.solve_in::<4>(times),
            2 => self.solve_in::<6>(times),
            3 => self.solve_in::<8>(times),
            4 => self.solve_in::<10>(times),
            _ => panic!("chains have one to four links"),
        }
    }

    /// What a sensor at `point` (m, from the mass centre in the body's frame) on link `k` reads:
    /// Aᵀ(r̈ − g) + ẇ' × s' + w' × (w' × s').
    ///
    /// # Panics
    /// If there is no link `k`.
    #[must_use]
    pub fn inertial_reading(&self, sample: &ChainSample<N>, k: usize, point: [f64; 3]) -> InertialReading {
        let (body, acceleration) = (&sample.bodies[k], sample.body_accelerations[k]);
        let felt = sub(acceleration, self.gravity);
        let local = core::array::from_fn(|column| dot(body.rotation.map(|row| row[column]), felt));
        let w = body.angular_velocity;
        let turning = add(cross(sample.angular_accelerations[k], point), cross(w, cross(w, point)));
        InertialReading { specific_force: add(local, turning), angular_rate: w }
    }

    /// [`solve`](Self::solve) with the state's size given: 2 N + 2.
    fn solve_in<const S: usize>(&self, times: &[f64]) -> Vec<ChainSample<N>> {
        let chain = PreciseChain {
            links: self.links.each_ref().map(PreciseLink::new),
            gravity: decimals(self.gravity),
            base: PreciseBase::new(&self.base),
        };
        let (zero, start) = (DoubleDouble::ZERO, self.start::<S>());
        let first = chain.instant(zero, &start).energy();
        let motion =
            smooth_trajectory(|t, state: &State<S>| chain.instant(t, state).derivative(), start, times);
        motion.iter().map(|(t, state)| chain.instant(*t, state).sample(*t, first, works(state))).collect()
    }

    fn start<const S: usize>(&self) -> State<S> {
        assert_eq!(S, 2 * N + 2, "positions, rates and two works");
        let mut start = [DoubleDouble::ZERO; S];
        for (k, link) in self.links.iter().enumerate() {
            (start[k], start[N + k]) = (decimal(link.start), decimal(link.rate));
        }
        start
    }
}

impl<const N: usize> PreciseChain<N> {
    fn instant<const S: usize>(&self, t: DoubleDouble, state: &State<S>) -> Instant<'_, N> {
        Instant {
            chain: self,
            base: self.base.at(t),
            positions: core::array::from_fn(|k| state[k]),
            rates: core::array::from_fn(|k| state[N + k]),
        }
    }
}

/// Base work and damping work: the last two elements of a state.
fn works<const S: usize>(state: &State<S>) -> [DoubleDouble; 2] {
    [state[S - 2], state[S - 1]]
}

impl<const N: usize> Instant<'_, N> {
    fn motions(&self, accelerations: [DoubleDouble; N]) -> [LinkMotion; N] {
        outwards(&self.chain.links, &self.base, [self.positions, self.rates, accelerations])
    }

    /// Generalised forces that these accelerations need.
    fn needed(&self, accelerations: [DoubleDouble; N]) -> [DoubleDouble; N] {
        let motions = self.motions(accelerations);
        let loads = inwards(&self.chain.links, &motions, self.chain.gravity);
        core::array::from_fn(|k| self.chain.links[k].along(&motions[k], &loads[k]))
    }

    /// What spring and damper of joint `k` give.
    fn applied(&self, k: usize) -> DoubleDouble {
        let link = &self.chain.links[k];
        -(link.stiffness * (self.positions[k] - link.free)) - link.damping * self.rates[k]
    }

    fn accelerations(&self) -> [DoubleDouble; N] {
        let zero = [DoubleDouble::ZERO; N];
        let bias = self.needed(zero);
        let columns = core::array::from_fn(|column| {
            let mut unit = zero;
            unit[column] = DoubleDouble::new(1.0);
            let needed = self.needed(unit);
            core::array::from_fn(|row| needed[row] - bias[row])
        });
        solve(columns, core::array::from_fn(|k| self.applied(k) - bias[k]))
    }

    /// Rates, accelerations, power of the base's mover and of the dampers.
    fn derivative<const S: usize>(&self) -> State<S> {
        let accelerations = self.accelerations();
        let damping = (0..N).fold(DoubleDouble::ZERO, |sum, k| {
            sum - self.chain.links[k].damping * self.rates[k] * self.rates[k]
        });
        let powers = [self.base_power(accelerations), damping];
        core::array::from_fn(|i| match i {
            i if i < N => self.rates[i],
            i if i < 2 * N => accelerations[i - N],
            i => powers[i - 2 * N],
        })
    }

    /// F·v + T·Ω of what the base exerts on the first link, at the base's own velocity.
    fn base_power(&self, accelerations: [DoubleDouble; N]) -> DoubleDouble {
        let motions = self.motions(accelerations);
        let load = inwards(&self.chain.links, &motions, self.chain.gravity)[0];
        let mut point = self.base;
        point.shift(sub(motions[0].joint, self.base.position));
        dot(load.force, point.velocity) + dot(load.torque, self.base.angular_velocity)
    }

    fn energy(&self) -> DoubleDouble {
        let motions = self.motions([DoubleDouble::ZERO; N]);
        (0..N).fold(DoubleDouble::ZERO, |sum, k| {
            let (link, motion) = (&self.chain.links[k], &motions[k]);
            let stretch = self.positions[k] - link.free;
            let spring = (link.stiffness * stretch * stretch).times(0.5);
            sum + link.kinetic_energy(motion) - link.mass * dot(self.chain.gravity, motion.frame.position)
                + spring
        })
    }

    fn sample(
        &self,
        t: DoubleDouble,
        first_energy: DoubleDouble,
        [base_work, damping_work]: [DoubleDouble; 2],
    ) -> ChainSample<N> {
        let accelerations = self.accelerations();
        let motions = self.motions(accelerations);
        let energy = self.energy();
        ChainSample {
            t: t.to_f64(),
            positions: rounded(self.positions),
            rates: rounded(self.rates),
            accelerations: rounded(accelerations),
            energy: energy.to_f64(),
            energy_gain: (energy - first_energy).to_f64(),
            base_work: base_work.to_f64(),
            base_power: self.base_power(accelerations).to_f64(),
            damping_work: damping_work.to_f64(),
            bodies: motions.map(|motion| body_state(&motion.frame)),
            body_accelerations: motions.map(|motion| rounded(motion.frame.acceleration)),
            angular_accelerations: motions.map(|motion| {
                rounded(motion.frame.rotation.transposed_times(motion.frame.angular_acceleration))
            }),
            reactions: self.reactions(&motions),
        }
    }

    fn reactions(&self, motions: &[LinkMotion; N]) -> [Wrench; N] {
        let loads = inwards(&self.chain.links, motions, self.chain.gravity);
        core::array::from_fn(|k| {
            let Load { force, torque } = self.chain.links[k].without(&motions[k], &loads[k], self.applied(k));
            let parent = if k == 0 { &self.base } else { &motions[k - 1].frame };
            let local = |v| rounded(parent.rotation.transposed_times(v));
            Wrench { force: local(force), torque: local(torque) }
        })
    }
}

fn body_state(frame: &FrameMotion) -> BodyState {
    BodyState {
        position: rounded(frame.position),
        rotation: frame.rotation.rounded(),
        velocity: rounded(frame.velocity),
        angular_velocity: rounded(frame.rotation.transposed_times(frame.angular_velocity)),
    }
}

/// x of A x = b for a symmetric positive definite A: elimination without pivoting.
pub(crate) fn solve<const N: usize>(
    mut a: [[DoubleDouble; N]; N],
    mut b: [DoubleDouble; N],
) -> [DoubleDouble; N] {
    for pivot in 0..N {
        for row in pivot + 1..N {
            let factor = a[row][pivot] / a[pivot][pivot];
            let upper = a[pivot];
            for (entry, above) in a[row].iter_mut().zip(upper).skip(pivot) {
                *entry = *entry - factor * above;
            }
            b[row] = b[row] - factor * b[pivot];
        }
    }
    for row in (0..N).rev() {
        let known = (row + 1..N).fold(b[row], |rest, column| rest - a[row][column] * b[column]);
        b[row] = known / a[row][row];
    }
    b
}
