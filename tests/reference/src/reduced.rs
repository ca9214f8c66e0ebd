//! The gyroscope reduced to the angle of its inner ring.
//!
//! Where the rotor is symmetric about its axis, its mass centre lies on it, gravity points along the outer
//! ring's axis and nothing rubs but the inner bearing, α and φ do not enter the Lagrangian and their momenta
//! stay (Routh; Goldstein, *Classical Mechanics*, section 8.3). With C and A the rotor's moments along and
//! across its axis, J1 the outer ring's about Y, J2 the inner ring's, m and d the rotor's mass and how far it
//! is out along its axis:
//!
//! ```text
//! σ = C (φ̇ + α̇ sin β)        p = I(β) α̇ + σ sin β        I = J1y + J2x sin²β + K cos²β,  K = J2y + A + m d²
//! N β̈ = (J2x − K) sin β cos β α̇² + σ α̇ cos β − m g d cos β + Q(β, β̇)              N = J2z + A + m d²
//! ```

use crate::DoubleDouble;
use crate::extrapolation::{Scheme, State, advance};
use crate::one_axis::PreciseForce;
use crate::trajectory::decimal;
use crate::{AxisForce, Sample};

/// A gyroscope whose outer and rotor angles are cyclic, and its start. Gravity acts along −Y, and α = φ = 0 at
/// the start. Numbers are the decimals they print as.
#[derive(Clone, Debug, PartialEq)]
pub struct ReducedGyroscope {
    /// The outer ring's moment of inertia about its axis Y, kg·m².
    pub outer: f64,
    /// The inner ring's moments of inertia about x, y and z, kg·m².
    pub inner: [f64; 3],
    /// The rotor's moments of inertia along and across its axis, kg·m².
    pub rotor: [f64; 2],
    /// The rotor's mass, kg.
    pub mass: f64,
    /// How far the rotor's mass centre is from the gimbal centre along its axis, m.
    pub offset: f64,
    /// Size of gravity, m/s².
    pub gravity: f64,
    /// What acts in the inner bearing.
    pub forces: Vec<AxisForce>,
    /// β at time zero, rad.
    pub beta: f64,
    /// α̇ and β̇ at time zero, rad/s.
    pub ring_rates: [f64; 2],
    /// The rotor's absolute angular velocity along its own axis at time zero, rad/s.
    pub spin: f64,
    /// Longest step of the integration, s: at a radian of the fastest motion it needs the fewest evaluations.
    pub step: f64,
}

/// α, β, φ, β̇ and the work of what stores no energy.
type Reduced = State<5>;

/// The gyroscope's numbers in double-double.
struct Precisely {
    /// J1y + J2x and J1y + K: the moments about Y at β = ±90° and at β = 0.
    about_y: [DoubleDouble; 2],
    /// N.
    about_z: DoubleDouble,
    /// C.
    along: DoubleDouble,
    /// m g d.
    weight: DoubleDouble,
    forces: Vec<PreciseForce>,
    /// σ.
    spin_momentum: DoubleDouble,
    /// p.
    momentum: DoubleDouble,
    step: f64,
    start: Reduced,
}

/// A motion that comes back to the same β and β̇.
struct Cycle {
    period: DoubleDouble,
    /// What α, β, φ, β̇ and the work have gained by then; of β and β̇ that is nothing.
    gain: Reduced,
}

impl ReducedGyroscope {
    /// The paper's first scene.
    #[must_use]
    pub fn paper() -> Self {
        ReducedGyroscope {
            outer: 10e-7,
            inner: [10e-7, 20e-7, 10e-7],
            rotor: [100e-7, 50e-7],
            mass: 0.080,
            offset: 0.000125,
            gravity: 10.0,
            forces: Vec::new(),
            beta: 0.0,
            ring_rates: [0.0; 2],
            spin: 100.0,
            step: 5e-3,
        }
    }

    /// No gravity and no offset, rings started at α̇ = 1 and β̇ = 0.5 rad/s.
    #[must_use]
    pub fn free_nutation() -> Self {
        ReducedGyroscope { offset: 0.0, gravity: 0.0, ring_rates: [1.0, 0.5], ..ReducedGyroscope::paper() }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded. The
    /// energy counts what springs store. Once it has come to a steady precession it is not integrated further.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or a force is too abrupt to integrate.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<Sample> {
        let gyroscope = self.precisely();
        gyroscope.states(times).iter().map(|(t, state)| gyroscope.sample(*t, state)).collect()
    }

    /// What friction and dampers of the bearing have done at `times`, J; never positive.
    ///
    /// # Panics
    /// As [`solve`](Self::solve).
    #[must_use]
    pub fn works(&self, times: &[f64]) -> Vec<f64> {
        self.precisely().states(times).iter().map(|(_, [.., work])| work.to_f64()).collect()
    }

    /// [`solve`](Self::solve) for motions that nothing damps, at times however late: β and β̇ come back after
    /// a period, α and φ gain the same in each, so that one period is integrated. What it is wrong by grows
    /// with time alone, from 1e-26 after the first period.
    ///
    /// # Panics
    /// If something acts in the bearing that stores no energy, or as `solve`.
    #[must_use]
    pub fn solve_by_periods(&self, times: &[f64]) -> Vec<Sample> {
        let gyroscope = self.precisely();
        let cycle = gyroscope.cycle();
        let at = |&t: &f64| {
            let t = decimal(t);
            let n = (t / cycle.period).to_f64().floor();
            let rest = t - cycle.period.times(n);
            let begun = core::array::from_fn(|k| gyroscope.start[k] + cycle.gain[k].times(n));
            gyroscope.sample(t, &gyroscope.advanced(begun, DoubleDouble::ZERO, rest))
        };
        times.iter().map(at).collect()
    }

    /// The time after which β and β̇ come back, s.
    ///
    /// # Panics
    /// As [`solve_by_periods`](Self::solve_by_periods).
    #[must_use]
    pub fn period(&self) -> f64 {
        self.precisely().cycle().period.to_f64()
    }

    fn precisely(&self) -> Precisely {
        let ([x, y, z], [along, across]) = (self.inner.map(decimal), self.rotor.map(decimal));
        let (mass, offset, outer) = (decimal(self.mass), decimal(self.offset), decimal(self.outer));
        let carried = across + mass * offset * offset;
        let (beta, [alpha_rate, beta_rate]) = (decimal(self.beta), self.ring_rates.map(decimal));
        let spin_momentum = along * decimal(self.spin);
        let (sin, cos) = beta.sin_cos();
        let about_y = [outer + x, outer + y + carried];
        let momentum = moment(about_y, sin, cos) * alpha_rate + spin_momentum * sin;
        let zero = DoubleDouble::ZERO;
        Precisely {
            about_y,
            about_z: z + carried,
            along,
            weight: mass * decimal(self.gravity) * offset,
            forces: self.forces.iter().map(PreciseForce::new).collect(),
            spin_momentum,
            momentum,
            step: self.step,
            start: [zero, beta, zero, beta_rate, zero],
        }
    }
}

/// I(β).
fn moment([upright, level]: [DoubleDouble; 2], sin: DoubleDouble, cos: DoubleDouble) -> DoubleDouble {
    upright * sin * sin + level * cos * cos
}

impl Precisely {
    /// α̇ and φ̇.
    fn cyclic_rates(&self, sin: DoubleDouble, cos: DoubleDouble) -> [DoubleDouble; 2] {
        let alpha = (self.momentum - self.spin_momentum * sin) / moment(self.about_y, sin, cos);
        [alpha, self.spin_momentum / self.along - alpha * sin]
    }

    fn derivative(&self, &[_, beta, _, rate, _]: &Reduced) -> Reduced {
        let (sin, cos) = beta.sin_cos();
        let [alpha_rate, phi_rate] = self.cyclic_rates(sin, cos);
        let [upright, level] = self.about_y;
        let gyroscopic = ((upright - level) * sin * alpha_rate + self.spin_momentum) * alpha_rate;
        let mut moment = (gyroscopic - self.weight) * cos;
        let mut power = DoubleDouble::ZERO;
        for force in &self.forces {
            let value = force.at(beta, rate);
            moment = moment + value;
            if force.energy(beta).is_none() {
                power = power + value * rate;
            }
        }
        [alpha_rate, rate, phi_rate, moment / self.about_z, power]
    }

    fn states(&self, times: &[f64]) -> Vec<(DoubleDouble, Reduced)> {
        let (mut state, mut now) = (self.start, DoubleDouble::ZERO);
        let reach = |&t: &f64| {
            let next = decimal(t);
            assert!(next >= now, "times ascend from zero: found {t}");
            state = self.advanced(state, now, next);
            now = next;
            (now, state)
        };
        times.iter().map(reach).collect()
    }

    /// Step by step, so that where one is too long for what happens in it only that one is shortened.
    fn advanced(&self, mut state: Reduced, from: DoubleDouble, to: DoubleDouble) -> Reduced {
        let scheme = Scheme { step: f64::INFINITY, ..Scheme::default() };
        let count = ((to - from).to_f64().abs() / self.step).ceil().max(1.0);
        let step = (to - from).divided_by(count);
        let mut done = 0.0;
        while done < count {
            let slope = self.derivative(&state);
            if is_steady(&slope) {
                let ([alpha_rate, _, phi_rate, ..], rest) = (slope, step.times(count - done));
                let [alpha, beta, phi, rate, work] = state;
                return [alpha + rest * alpha_rate, beta, phi + rest * phi_rate, rate, work];
            }
            let now = from + step.times(done);
            state = match advance(|_, state| self.derivative(state), &scheme, state, now, now + step) {
                Ok(state) => state,
                Err(failure) => panic!("{failure}"),
            };
            done += 1.0;
        }
        state
    }

    /// Where the motion comes back: the first time that it crosses the line through the start, at right angles to how
    /// it sets out, in the same sense.
    fn cycle(&self) -> Cycle {
        assert!(
            self.forces.iter().all(|force| force.energy(self.start[1]).is_some()),
            "friction ends a cycle"
        );
        let out = self.derivative(&self.start);
        let along = |slope: &Reduced| slope[1] * out[1] + slope[3] * out[3];
        let beyond = |state: &Reduced| along(&core::array::from_fn(|k| state[k] - self.start[k]));
        let stride = DoubleDouble::new(0.1 * self.step);
        let (mut state, mut now, mut is_returning) = (self.start, DoubleDouble::ZERO, false);
        loop {
            state = self.advanced(state, now, now + stride);
            now = now + stride;
            let is_before = beyond(&state) < DoubleDouble::ZERO;
            if is_returning && !is_before {
                break;
            }
            is_returning = is_before;
        }
        // Newton's method doubles the digits: from a tenth of a step to 31 of them.
        for _ in 0..8 {
            let late = beyond(&state) / along(&self.derivative(&state));
            state = self.advanced(state, now, now - late);
            now = now - late;
        }
        Cycle { period: now, gain: core::array::from_fn(|k| state[k] - self.start[k]) }
    }

    fn energy(&self, state: &Reduced) -> DoubleDouble {
        let [_, beta, _, rate, _] = *state;
        let (sin, cos) = beta.sin_cos();
        let [alpha_rate, _] = self.cyclic_rates(sin, cos);
        let turning = moment(self.about_y, sin, cos) * alpha_rate * alpha_rate
            + self.about_z * rate * rate
            + self.spin_momentum * self.spin_momentum / self.along;
        let stored = self.forces.iter().filter_map(|force| force.energy(beta));
        stored.fold(turning.times(0.5) + self.weight * sin, |sum, share| sum + share)
    }

    fn sample(&self, t: DoubleDouble, state: &Reduced) -> Sample {
        let [alpha, beta, phi, beta_rate, _] = *state;
        let [alpha_rate, _, phi_rate, ..] = self.derivative(state);
        let energy = self.energy(state);
        Sample { t, alpha, beta, phi, alpha_rate, beta_rate, phi_rate, energy }.rounded()
    }
}

/// Whether β has come to rest: it may then still be off by less than 1e-26 rad, whatever the spring.
fn is_steady(slope: &Reduced) -> bool {
    let [_, rate, _, acceleration, _] = slope.map(|x| x.to_f64().abs());
    rate < 1e-24 && acceleration < 1e-20
}
