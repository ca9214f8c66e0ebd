//! A gimbal under rate control: one millisecond of simulated time for each tick of a clock.

use crate::RateControl;
use crate::mechanisms::gimbal::Gimbal;
use gyro_sim::{Error, JointCoordinate, Mechanism, Partitioned, Real, Turns};

/// Length of a tick, s: two corrections of five steps each.
pub const TICK: f64 = 1e-3;
const STEP: f64 = 1e-4;
const STEPS: u32 = 5;
const CORRECTIONS: u32 = 2;

/// α, β, φ and the rates of the rings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles<T> {
    /// Of the outer ring, rad.
    pub alpha: T,
    /// Of the inner ring, rad.
    pub beta: T,
    /// Of the rotor, continuous over its turns, rad.
    pub phi: T,
    /// Of the outer ring, rad/s.
    pub alpha_rate: T,
    /// Of the inner ring, rad/s: what is controlled.
    pub beta_rate: T,
}

/// The simulated gimbal and its controller: all that a tick needs, in one place of known size.
#[derive(Debug)]
pub struct Simulator<T: Real> {
    gimbal: Gimbal<T>,
    state: <Gimbal<T> as Mechanism>::State,
    solver: Partitioned<Gimbal<T>>,
    turns: Turns<Gimbal<T>>,
    control: RateControl<T>,
    ticks: u32,
}

/// The rate that the inner ring shall have at a tick, rad/s: up, down and still.
pub fn demand<T: Real>(tick: u32) -> T {
    T::constant(match tick {
        0..400 => 0.05,
        400..800 => -0.05,
        _ => 0.0,
    })
}

impl<T: Real> Simulator<T> {
    /// The gimbal at its start.
    // As a function of its own it would hold a second copy of all of it while it returns.
    #[inline(always)]
    pub fn new() -> Self {
        let gimbal = Gimbal::default();
        let state = gimbal.start();
        Self {
            solver: Partitioned::new(&gimbal, &state),
            turns: Turns::new(&gimbal, T::constant(0.0), &state, &[]),
            gimbal,
            state,
            control: RateControl::new(),
            ticks: 0,
        }
    }

    /// Sets the motor, advances by a tick and reads the joints.
    ///
    /// # Errors
    /// [`Error`] if the state cannot be advanced; the simulation must not go on.
    pub fn tick(&mut self, demand: T) -> Result<Angles<T>, Error> {
        let dt = T::constant(TICK);
        let Angles { alpha_rate, beta_rate, .. } = self.angles();
        self.gimbal.torque = self.control.update(demand, alpha_rate, beta_rate, dt);
        for correction in 0..CORRECTIONS {
            let t = self.time() + T::constant(f64::from(correction * STEPS) * STEP);
            self.solver.advance(&self.gimbal, t, T::constant(STEP), STEPS, &mut self.state)?;
        }
        self.ticks += 1;
        self.turns.update(&self.gimbal, self.time(), dt, &self.state);
        Ok(self.angles())
    }

    /// The joint angles at the last tick.
    pub fn angles(&self) -> Angles<T> {
        let [(alpha, alpha_rate), (beta, beta_rate), (phi, _)] = [0, 1, 2].map(|joint| self.angle(joint));
        Angles { alpha, beta, phi, alpha_rate, beta_rate }
    }

    /// Position and rate of a joint; the gimbal's are all revolute.
    fn angle(&self, joint: usize) -> (T, T) {
        match self.turns.coordinate(&self.gimbal, joint, 0) {
            Some(JointCoordinate::Angle { position, rate }) => (position, rate),
            _ => (T::constant(0.0), T::constant(0.0)),
        }
    }

    fn time(&self) -> T {
        T::constant(f64::from(self.ticks) * TICK)
    }

    /// The state `(q, v, work)`, for those who compare it.
    pub fn state(&self) -> &[T] {
        &self.state
    }

    /// Energy less the motor's work, J: it stays what it was.
    pub fn balance(&self) -> T {
        self.gimbal.energy(self.time(), &self.state).total() - self.gimbal.work(&self.state)
    }
}

impl<T: Real> Default for Simulator<T> {
    fn default() -> Self {
        Self::new()
    }
}
