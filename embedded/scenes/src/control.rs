//! The rate-control loop.

use gyro_sim::Real;

/// Turns the inner ring at a demanded rate by a torque on the outer axis.
///
/// A fast rotor of angular momentum H answers a torque with a rate at right angles to it, β̇ = τ / H, so integral
/// action of the bandwidth ω turns the ring: τ = H ω ∫ (demand − β̇) dt − D α̇. Nothing else damps the nutation; D
/// does.
#[derive(Clone, Copy, Debug)]
pub struct RateControl<T> {
    gain: T,
    damping: T,
    limit: T,
    integral: T,
}

/// Of the paper's rotor, 1e-5 kg m² at 100 rad/s.
const ANGULAR_MOMENTUM: f64 = 1e-3;
/// A seventh of the nutation's 144 rad/s, which the loop must not excite.
const BANDWIDTH: f64 = 20.0;
/// N m s: 0.3 of what is critical for the nutation.
const DAMPING: f64 = 7e-4;
/// What the motor can do, N m.
const LIMIT: f64 = 2e-4;

impl<T: Real> RateControl<T> {
    /// At rest.
    pub fn new() -> Self {
        let k = T::constant;
        let gain = k(ANGULAR_MOMENTUM * BANDWIDTH);
        Self { gain, damping: k(DAMPING), limit: k(LIMIT), integral: k(0.0) }
    }

    /// The torque for the next `dt` seconds at the rates of both rings.
    pub fn update(&mut self, demand: T, alpha_rate: T, beta_rate: T, dt: T) -> T {
        self.integral = self.limited(self.integral + self.gain * (demand - beta_rate) * dt);
        self.limited(self.integral - self.damping * alpha_rate)
    }

    fn limited(&self, torque: T) -> T {
        if torque > self.limit {
            self.limit
        } else if torque < -self.limit {
            -self.limit
        } else {
            torque
        }
    }
}

impl<T: Real> Default for RateControl<T> {
    fn default() -> Self {
        Self::new()
    }
}
