//! One inertia on one axis, a rotor or a slider, under springs, dampers, friction, stops, motors and a
//! sampled input.
//!
//! I ẍ = Σ F(x, ẋ) + u: x counts continuously over any number of turns, so a spring winds up over them. u is
//! held from step to step. The motion is smooth between the changes of u and is integrated from one to the
//! next.

use crate::DoubleDouble;
use crate::extrapolation::{Scheme, State, advance};
use crate::trajectory::decimal;

/// Friction that turns round and a stop that sets in are sudden: steps of a millisecond, shortened where they
/// must be and only there.
const SHORT: Scheme = Scheme { step: 1e-3, columns: 14, tolerance: 1e-26 };

/// A force (N) or torque (N·m) on the inertia at coordinate x (m or rad). All numbers are the decimals they
/// print as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisForce {
    /// −stiffness (x − free).
    Spring {
        /// N/m or N·m/rad.
        stiffness: f64,
        /// Where it is free.
        free: f64,
    },
    /// −damping ẋ, the damping in N·s/m or N·m·s/rad.
    Damper(f64),
    /// −level tanh(ẋ / rate).
    Coulomb {
        /// N or N·m.
        level: f64,
        /// m/s or rad/s.
        rate: f64,
    },
    /// Upper: −stiffness ρ(x − limit) − damping σ(x − limit) ẋ; lower: stiffness ρ(limit − x) − damping
    /// σ(limit − x) ẋ; with ρ(z) = ½ (z + √(z² + softness²)) and σ(z) = ½ (1 + z / √(z² + softness²)).
    Stop {
        /// Where it is.
        limit: f64,
        /// Which side is blocked.
        side: Side,
        /// N/m or N·m/rad.
        stiffness: f64,
        /// N·s/m or N·m·s/rad.
        damping: f64,
        /// Width over which it sets in.
        softness: f64,
    },
    /// A constant.
    Motor(f64),
}

/// Which side of a limit is blocked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Below it.
    Lower,
    /// Above it.
    Upper,
}

/// An inertia on an axis and its start. Numbers are the decimals they print as.
#[derive(Clone, Debug, PartialEq)]
pub struct OneAxis {
    /// kg·m² or kg.
    pub inertia: f64,
    /// What acts on it.
    pub forces: Vec<AxisForce>,
    /// Coordinate at time zero, rad or m.
    pub start: f64,
    /// Rate at time zero.
    pub rate: f64,
}

/// A force set as a sampled controller sets it: at the start of each step of length `step` it takes the
/// value of the table (linear between rows, held beyond them) and keeps it over the step.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledInput {
    /// Time, s, and force or torque; times ascend. At least one.
    pub rows: Vec<[f64; 2]>,
    /// Length of a step, s; the first starts at time zero.
    pub step: f64,
}

/// A [`OneAxis`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSample {
    /// Time, s.
    pub t: f64,
    /// x.
    pub position: f64,
    /// ẋ.
    pub rate: f64,
    /// ẍ; where the input changes, that of one of the two steps that meet.
    pub acceleration: f64,
    /// Kinetic energy and energy of the springs, J.
    pub energy: f64,
    /// Work of everything else since time zero, J.
    pub work: f64,
}

/// One of the forces in double-double numbers.
pub(crate) enum PreciseForce {
    Spring {
        stiffness: DoubleDouble,
        free: DoubleDouble,
    },
    Damper(DoubleDouble),
    Coulomb {
        level: DoubleDouble,
        rate: DoubleDouble,
    },
    /// An upper stop for x, or with `sign` −1 for −x.
    Stop {
        sign: f64,
        limit: DoubleDouble,
        stiffness: DoubleDouble,
        damping: DoubleDouble,
        softness: DoubleDouble,
    },
    Motor(DoubleDouble),
}

struct Axis {
    inertia: DoubleDouble,
    forces: Vec<PreciseForce>,
}

impl OneAxis {
    /// A disc of 0.02 kg·m² wound up by three and a quarter turns on a torsion spring of 0.5 N·m/rad, in a
    /// bearing with 0.01 N·m·s/rad, released at rest.
    #[must_use]
    pub fn torsion() -> Self {
        OneAxis {
            inertia: 0.02,
            forces: vec![AxisForce::Spring { stiffness: 0.5, free: 0.0 }, AxisForce::Damper(0.01)],
            start: 6.5 * core::f64::consts::PI,
            rate: 0.0,
        }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend, a number is not finite, or a force is too abrupt to integrate.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<AxisSample> {
        self.solve_with_input(times, &SampledInput { rows: vec![[0.0; 2]], step: SHORT.step })
    }

    /// The same with an input.
    ///
    /// # Panics
    /// As [`solve`](Self::solve).
    #[must_use]
    pub fn solve_with_input(&self, times: &[f64], input: &SampledInput) -> Vec<AxisSample> {
        let axis = self.precisely();
        let (mut state, mut now, mut held) = (self.initial(), DoubleDouble::ZERO, DoubleDouble::ZERO);
        let (step, mut n_steps) = (decimal(input.step), 0.0);
        let mut samples = Vec::with_capacity(times.len());
        for &t in times {
            let target = decimal(t);
            assert!(target >= now, "times ascend from zero: found {t}");
            while now < target {
                let boundary = step.times(n_steps);
                if now == boundary {
                    held = DoubleDouble::new(input.at(boundary.to_f64()));
                    n_steps += 1.0;
                }
                let end = step.times(n_steps);
                let next = if end < target { end } else { target };
                let rhs = |_, state: &State<3>| axis.derivative(state, held);
                state = match advance(rhs, &SHORT, state, now, next) {
                    Ok(state) => state,
                    Err(failure) => panic!("{failure}"),
                };
                now = next;
            }
            samples.push(axis.sample(now, &state, held));
        }
        samples
    }

    fn initial(&self) -> State<3> {
        [decimal(self.start), decimal(self.rate), DoubleDouble::ZERO]
    }

    fn precisely(&self) -> Axis {
        Axis { inertia: decimal(self.inertia), forces: self.forces.iter().map(PreciseForce::new).collect() }
    }
}

impl SampledInput {
    /// The table's value at a time.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let (first, last) = (self.rows[0], self.rows[self.rows.len() - 1]);
        if t <= first[0] {
            return first[1];
        }
        let around = self.rows.windows(2).find(|pair| t < pair[1][0]);
        around.map_or(last[1], |pair| {
            let [[t0, before], [t1, after]] = [pair[0], pair[1]];
            before + (after - before) * (t - t0) / (t1 - t0)
        })
    }
}

impl PreciseForce {
    pub(crate) fn new(force: &AxisForce) -> Self {
        match *force {
            AxisForce::Spring { stiffness, free } => {
                PreciseForce::Spring { stiffness: decimal(stiffness), free: decimal(free) }
            }
            AxisForce::Damper(damping) => PreciseForce::Damper(decimal(damping)),
            AxisForce::Coulomb { level, rate } => {
                PreciseForce::Coulomb { level: decimal(level), rate: decimal(rate) }
            }
            AxisForce::Stop { limit, side, stiffness, damping, softness } => PreciseForce::Stop {
                sign: if side == Side::Upper { 1.0 } else { -1.0 },
                limit: decimal(limit),
                stiffness: decimal(stiffness),
                damping: decimal(damping),
                softness: decimal(softness),
            },
            AxisForce::Motor(value) => PreciseForce::Motor(decimal(value)),
        }
    }

    pub(crate) fn at(&self, x: DoubleDouble, rate: DoubleDouble) -> DoubleDouble {
        match *self {
            PreciseForce::Spring { stiffness, free } => -(stiffness * (x - free)),
            PreciseForce::Damper(damping) => -(damping * rate),
            PreciseForce::Coulomb { level, rate: typical } => -(level * (rate / typical).tanh()),
            PreciseForce::Stop { sign, limit, stiffness, damping, softness } => {
                let depth = (x - limit).times(sign);
                let root = (depth * depth + softness * softness).sqrt();
                let (ramp, slope) = (depth + root, DoubleDouble::new(1.0) + depth / root);
                -(stiffness * ramp.times(sign) + damping * slope * rate).times(0.5)
            }
            PreciseForce::Motor(value) => value,
        }
    }

    /// Energy stored; `None` where the force stores none.
    pub(crate) fn energy(&self, x: DoubleDouble) -> Option<DoubleDouble> {
        match *self {
            PreciseForce::Spring { stiffness, free } => {
                Some((stiffness * (x - free) * (x - free)).times(0.5))
            }
            _ => None,
        }
    }
}

impl Axis {
    /// Rate, acceleration, and power of what stores no energy.
    fn derivative(&self, &[x, rate, _]: &State<3>, input: DoubleDouble) -> State<3> {
        let (mut storing, mut other) = (DoubleDouble::ZERO, input);
        for force in &self.forces {
            let sum = if force.energy(x).is_some() { &mut storing } else { &mut other };
            *sum = *sum + force.at(x, rate);
        }
        [rate, (storing + other) / self.inertia, other * rate]
    }

    fn sample(&self, t: DoubleDouble, state: &State<3>, input: DoubleDouble) -> AxisSample {
        let [x, rate, work] = *state;
        let kinetic = (self.inertia * rate * rate).times(0.5);
        let energy = self.forces.iter().filter_map(|force| force.energy(x)).fold(kinetic, |sum, e| sum + e);
        AxisSample {
            t: t.to_f64(),
            position: x.to_f64(),
            rate: rate.to_f64(),
            acceleration: self.derivative(state, input)[1].to_f64(),
            energy: energy.to_f64(),
            work: work.to_f64(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: f64, expected: f64, tolerance: f64) {
        assert!((found - expected).abs() < tolerance, "{found} but {expected}");
    }

    fn axis(inertia: f64, forces: Vec<AxisForce>, start: f64, rate: f64) -> OneAxis {
        OneAxis { inertia, forces, start, rate }
    }

    #[test]
    fn a_damped_spring_swings_by_its_closed_form_over_three_turns() {
        // I = 2, c = 0.4, k = 0.5: δ = 0.1, ω² = 0.25 − 0.01. Released 22 rad from where the spring is free.
        let forces = vec![AxisForce::Spring { stiffness: 0.5, free: 1.0 }, AxisForce::Damper(0.4)];
        let (delta, omega) = (0.1f64, 0.24f64.sqrt());
        for sample in axis(2.0, forces, 23.0, 0.0).solve(&[0.7, 4.0, 10.0]) {
            let (sin, cos) = (omega * sample.t).sin_cos();
            let size = 22.0 * (-delta * sample.t).exp();
            near(sample.position, 1.0 + size * (cos + delta / omega * sin), 1e-14);
            near(sample.rate, -size * 0.25 / omega * sin, 1e-14);
            near(sample.energy - 121.0, sample.work, 1e-13);
        }
    }

    #[test]
    fn friction_alone_stops_by_its_closed_form() {
        // I v̇ = −L tanh(v/r) has sinh(v/r) = sinh(v0/r) exp(−L t / (I r)).
        let friction = AxisForce::Coulomb { level: 3.0, rate: 0.5 };
        for sample in axis(2.0, vec![friction], 0.0, 4.0).solve(&[1.0, 2.5, 4.0]) {
            let expected = 0.5 * ((8.0f64).sinh() * (-3.0 * sample.t).exp()).asinh();
            near(sample.rate, expected, 1e-14);
            near(sample.energy - 16.0, sample.work, 1e-14);
        }
    }

    /// Stick and slip: a spring wound up by three turns against friction that reverses within some 10 µs.
    #[test]
    fn sudden_friction_balances_its_energy_and_holds_in_the_end() {
        let forces = vec![
            AxisForce::Spring { stiffness: 0.5, free: 0.0 },
            AxisForce::Coulomb { level: 1.0, rate: 0.01 },
        ];
        let wound = axis(0.02, forces, 19.0, 0.0);
        let samples = wound.solve(&[0.1, 1.0, 3.0, 6.0]);
        for sample in &samples {
            near(sample.energy - 0.25 * 19.0 * 19.0, sample.work, 1e-13);
        }
        // It creeps where the spring is weaker than friction: k |x| < L.
        assert!(samples[3].position.abs() < 2.0 && samples[3].rate.abs() < 0.01, "{samples:?}");
        assert!(samples[1].rate.abs() > 1.0);
    }

    #[test]
    fn an_undamped_stop_gives_back_what_it_took() {
        /// ∫ρ = ¼ (z² + z √(z² + s²) + s² asinh(z/s)).
        fn stored(z: f64, s: f64) -> f64 {
            0.25 * (z * z + z * z.hypot(s) + s * s * (z / s).asinh())
        }
        for (side, sign) in [(Side::Upper, 1.0), (Side::Lower, -1.0)] {
            let stop =
                AxisForce::Stop { limit: 0.2 * sign, side, stiffness: 900.0, damping: 0.0, softness: 0.01 };
            let samples = axis(1.0, vec![stop], 0.0, 3.0 * sign).solve(&[0.1, 0.4]);
            assert!(samples[0].position * sign > 0.2 && samples[1].rate * sign < -2.9, "{samples:?}");
            for sample in samples {
                let depth = sample.position * sign - 0.2;
                near(sample.work, 900.0 * (stored(-0.2, 0.01) - stored(depth, 0.01)), 1e-13);
                near(sample.energy, 4.5 + sample.work, 1e-14);
            }
        }
    }

    #[test]
    fn a_stop_damps_only_where_it_acts() {
        let stop = |damping| {
            let stop =
                AxisForce::Stop { limit: 0.2, side: Side::Upper, stiffness: 900.0, damping, softness: 0.01 };
            axis(1.0, vec![stop], 0.0, 3.0).solve(&[0.05, 0.4])
        };
        let (free, damped) = (stop(0.0), stop(5.0));
        near(free[0].rate, damped[0].rate, 1e-2);
        assert!(damped[1].rate > free[1].rate + 0.3, "{damped:?}");
        // Deep inside σ = 1 and ρ = z: the force is that of spring and damper.
        let deep = PreciseForce::new(&AxisForce::Stop {
            limit: 0.0,
            side: Side::Lower,
            stiffness: 900.0,
            damping: 5.0,
            softness: 1e-9,
        });
        near(deep.at(decimal(-0.5), decimal(-2.0)).to_f64(), 450.0 + 10.0, 1e-9);
    }

    #[test]
    fn an_input_is_held_from_step_to_step() {
        // u = 2 t up to 1 s, then 2: steps of 0.05 hold 0, 0.1, …, 1.9, so v(1) = 0.95 and v grows by 2 a
        // second.
        let input = SampledInput { rows: vec![[0.0, 0.0], [1.0, 2.0]], step: 0.05 };
        let samples = axis(1.0, vec![], 0.0, 0.0).solve_with_input(&[0.0, 0.05, 0.075, 1.0, 2.0], &input);
        near(samples[1].rate, 0.0, 1e-300);
        near(samples[2].rate, 0.1 * 0.025, 1e-17);
        near(samples[3].rate, 0.95, 1e-15);
        near(samples[4].rate, 2.95, 1e-15);
        // x(1) = Σ (v_k h + u_k h²/2) with v_k = 0.005 · k (k − 1) / 2.
        let expected: f64 =
            (0..20).map(|k| f64::from(k * (k - 1)) * 0.0025 * 0.05 + f64::from(k) * 0.1 * 0.00125).sum();
        near(samples[3].position, expected, 1e-15);
        near(samples[4].work, samples[4].energy, 1e-14);
        assert_eq!([input.at(-1.0), input.at(0.25), input.at(3.0)], [0.0, 0.5, 2.0]);
    }
}
