//! The gyroscope's parameters, and the scenes the workspace is judged by.

use crate::{DoubleDouble, Real};

/// A gyroscope on a fixed base, and the state it starts from, in numbers of type `T`.
///
/// Bodies are counted outer ring, inner ring, rotor; vectors are x, y, z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gyroscope<T = DoubleDouble> {
    /// Masses, kg. The rings turn about their own mass centres, so only the rotor's mass acts.
    pub mass: [T; 3],
    /// Principal moments of inertia of each body in its own frame, kg·m².
    pub inertia: [[T; 3]; 3],
    /// s2': from the gimbal centre to the rotor bearing, in the inner ring's frame, m.
    pub ring_offset: [T; 3],
    /// s3': from the rotor's mass centre to the same bearing, in the rotor's frame, m.
    pub rotor_offset: [T; 3],
    /// Acceleration of gravity in the global frame, m/s².
    pub gravity: [T; 3],
    /// Viscous friction of the bearings of α, β, φ: torque −c times the relative rate, N·m·s/rad.
    pub friction: [T; 3],
    /// The state at time zero.
    pub start: Start<T>,
}

/// The state at time zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<T = DoubleDouble> {
    /// α, β, φ, rad.
    pub angles: [T; 3],
    /// α̇ and β̇, rad/s.
    pub ring_rates: [T; 2],
    /// Component of the rotor's absolute angular velocity along its own axis, rad/s: φ̇ + α̇ sin β.
    pub spin: T,
}

impl Gyroscope {
    /// The paper's first scene (section 7, case i): the rotor centre lies 0.000125 m along its axis, gravity 10 m/s²
    /// along −Y, rotor at 100 rad/s, rings at rest.
    #[must_use]
    pub fn paper() -> Self {
        Gyroscope { ring_offset: decimals(["0.000125", "0", "0"]), ..Gyroscope::aligned() }
    }

    /// Static imbalance: the rotor's mass centre 0.0002 m off its axis, the bearing at the gimbal centre.
    ///
    /// The reaction passes through the gimbal centre, so α = β = 0 throughout: judge it by φ.
    #[must_use]
    pub fn radial_imbalance() -> Self {
        Gyroscope { rotor_offset: decimals(["0", "0.0002", "0"]), ..Gyroscope::aligned() }
    }

    /// No gravity, no offsets, rings started at α̇ = 1 and β̇ = 0.5 rad/s.
    #[must_use]
    pub fn free_nutation() -> Self {
        let aligned = Gyroscope::aligned();
        let start = Start { ring_rates: decimals(["1", "0.5"]), ..aligned.start };
        Gyroscope { gravity: decimals(["0"; 3]), start, ..aligned }
    }

    /// [`paper`](Self::paper) with viscous friction of 1e-6 N·m·s/rad in all three bearings.
    #[must_use]
    pub fn viscous_bearings() -> Self {
        Gyroscope { friction: decimals(["1e-6"; 3]), ..Gyroscope::paper() }
    }

    /// [`paper`](Self::paper) with both offsets full: s2' = (0.000125, 0.00005, −0.00003) m and
    /// s3' = (0.0001, 0.0002, −0.00015) m.
    #[must_use]
    pub fn combined_offsets() -> Self {
        Gyroscope {
            ring_offset: decimals(["0.000125", "0.00005", "-0.00003"]),
            rotor_offset: decimals(["0.0001", "0.0002", "-0.00015"]),
            ..Gyroscope::aligned()
        }
    }

    /// What the scenes share: the paper's bodies without any misalignment.
    fn aligned() -> Self {
        let zeros = decimals(["0"; 3]);
        Gyroscope {
            mass: decimals(["0.010", "0.010", "0.080"]),
            inertia: [
                decimals(["20e-7", "10e-7", "10e-7"]),
                decimals(["10e-7", "20e-7", "10e-7"]),
                decimals(["100e-7", "50e-7", "50e-7"]),
            ],
            ring_offset: zeros,
            rotor_offset: zeros,
            gravity: decimals(["0", "-10", "0"]),
            friction: zeros,
            start: Start { angles: zeros, ring_rates: decimals(["0"; 2]), spin: DoubleDouble::new(100.0) },
        }
    }

    /// The same gyroscope with every parameter rounded to `f64`, for its fast
    /// [`accelerations`](Gyroscope::accelerations).
    #[must_use]
    pub fn rounded(&self) -> Gyroscope<f64> {
        let vector = |v: [DoubleDouble; 3]| v.map(DoubleDouble::to_f64);
        Gyroscope {
            mass: vector(self.mass),
            inertia: self.inertia.map(vector),
            ring_offset: vector(self.ring_offset),
            rotor_offset: vector(self.rotor_offset),
            gravity: vector(self.gravity),
            friction: vector(self.friction),
            start: Start {
                angles: vector(self.start.angles),
                ring_rates: self.start.ring_rates.map(DoubleDouble::to_f64),
                spin: self.start.spin.to_f64(),
            },
        }
    }
}

impl<T: Real> Start<T> {
    /// α̇, β̇, φ̇ at time zero, rad/s.
    #[must_use]
    pub fn rates(&self) -> [T; 3] {
        let [alpha_rate, beta_rate] = self.ring_rates;
        let (sin_beta, _) = self.angles[1].sin_cos();
        [alpha_rate, beta_rate, self.spin - alpha_rate * sin_beta]
    }
}

fn decimals<const N: usize>(texts: [&str; N]) -> [DoubleDouble; N] {
    texts.map(|text| text.parse().expect("the scenes are written in decimals"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spin_counts_the_turning_of_the_outer_ring() {
        // With the inner ring a quarter turn round, the rotor's axis is that of the outer ring.
        let quarter = core::f64::consts::FRAC_PI_2;
        let start = Start { angles: [0.3, quarter, 0.0], ring_rates: [2.0, 5.0], spin: 100.0 };
        assert_eq!(start.rates(), [2.0, 5.0, 98.0]);
    }
}
