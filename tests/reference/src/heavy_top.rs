//! A rigid body that turns about a fixed point under gravity.
//!
//! Euler's equations about the point, in the body's frame: I ẇ = c × m Aᵀg − w × I w with I = J + m (c·c 1 −
//! c cᵀ) (Steiner), and ṗ = ½ Gᵀ w of the Euler parameters. With the point at the mass centre (c = 0) this is
//! free rotation.

use crate::extrapolation::State;
use crate::rotation::{Precise, Rotation, euler_parameter_rates, moved_tensor, tensor_times};
use crate::trajectory::{decimal, decimals, rounded, smooth_trajectory};
use crate::vector::{add, cross, dot, scale, solve_symmetric, sub};
use crate::{BodyState, DoubleDouble};

/// A body on a fixed point, which is the global origin, and its start. Numbers are the decimals they print
/// as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeavyTop {
    /// Mass, kg.
    pub mass: f64,
    /// Inertia tensor about the mass centre in the body's frame, kg·m²: `[xx, yy, zz, xy, xz, yz]`.
    pub inertia: [f64; 6],
    /// The mass centre from the fixed point, in the body's frame, m.
    pub centre: [f64; 3],
    /// Acceleration of gravity, global, m/s².
    pub gravity: [f64; 3],
    /// Euler parameters at time zero, of any length but zero.
    pub orientation: [f64; 4],
    /// Angular velocity in the body's frame at time zero, rad/s.
    pub angular_velocity: [f64; 3],
}

/// A [`HeavyTop`] at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TopSample {
    /// Time, s.
    pub t: f64,
    /// The body; its position is that of the mass centre.
    pub body: BodyState,
    /// Kinetic energy and −m g·r, J.
    pub energy: f64,
    /// Force that the point exerts on the body, global, N.
    pub force: [f64; 3],
}

/// The top's numbers in double-double.
struct Precisely {
    mass: DoubleDouble,
    /// About the fixed point.
    inertia: [DoubleDouble; 6],
    centre: Precise,
    gravity: Precise,
}

impl HeavyTop {
    /// The heavy top of multibody benchmarks: 15 kg with J = diag(0.234375, 0.46875, 0.234375) kg·m², its
    /// centre 1 m along y, spinning at (0, 150, −4.61538) rad/s, gravity 9.81 m/s² along −z.
    ///
    /// Source: Brüls and Cardona (2010), "On the use of Lie group time integrators in multibody
    /// dynamics".
    #[must_use]
    pub fn benchmark() -> Self {
        HeavyTop {
            mass: 15.0,
            inertia: [0.234375, 0.46875, 0.234375, 0.0, 0.0, 0.0],
            centre: [0.0, 1.0, 0.0],
            gravity: [0.0, 0.0, -9.81],
            orientation: [1.0, 0.0, 0.0, 0.0],
            angular_velocity: [0.0, 150.0, -4.61538],
        }
    }

    /// The motion at `times` (s, ascending from zero; each the decimal it prints as), correctly rounded.
    ///
    /// # Panics
    /// If the times do not ascend or a number is not finite.
    #[must_use]
    pub fn solve(&self, times: &[f64]) -> Vec<TopSample> {
        let top = self.precisely();
        let motion = smooth_trajectory(|_, state| top.derivative(state), self.start(), times);
        motion.iter().map(|(t, state)| top.sample(*t, state)).collect()
    }

    fn start(&self) -> State<7> {
        let p = decimals(self.orientation);
        let length = p.iter().fold(DoubleDouble::ZERO, |sum, &x| sum + x * x).sqrt();
        let w = decimals(self.angular_velocity);
        core::array::from_fn(|i| if i < 4 { p[i] / length } else { w[i - 4] })
    }

    fn precisely(&self) -> Precisely {
        let (mass, centre) = (decimal(self.mass), decimals(self.centre));
        let inertia = moved_tensor(decimals(self.inertia), mass, centre);
        Precisely { mass, inertia, centre, gravity: decimals(self.gravity) }
    }
}

fn parted(state: &State<7>) -> (Rotation, Precise) {
    let [e0, e1, e2, e3, x, y, z] = *state;
    (Rotation::from_euler_parameters([e0, e1, e2, e3]), [x, y, z])
}

impl Precisely {
    fn angular_acceleration(&self, rotation: &Rotation, w: Precise) -> Precise {
        let [xx, yy, zz, xy, xz, yz] = self.inertia;
        let weight = scale(self.mass, rotation.transposed_times(self.gravity));
        let moment = sub(cross(self.centre, weight), cross(w, tensor_times(self.inertia, w)));
        solve_symmetric([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], moment)
    }

    fn derivative(&self, state: &State<7>) -> State<7> {
        let (rotation, w) = parted(state);
        let turning = euler_parameter_rates([state[0], state[1], state[2], state[3]], w);
        let acceleration = self.angular_acceleration(&rotation, w);
        core::array::from_fn(|i| if i < 4 { turning[i] } else { acceleration[i - 4] })
    }

    fn energy(&self, state: &State<7>) -> DoubleDouble {
        let (rotation, w) = parted(state);
        let kinetic = dot(w, tensor_times(self.inertia, w)).times(0.5);
        kinetic - self.mass * dot(self.gravity, rotation.times(self.centre))
    }

    fn sample(&self, t: DoubleDouble, state: &State<7>) -> TopSample {
        let (rotation, w) = parted(state);
        let velocity = cross(w, self.centre);
        let turning = cross(self.angular_acceleration(&rotation, w), self.centre);
        let acceleration = rotation.times(add(turning, cross(w, velocity)));
        TopSample {
            t: t.to_f64(),
            body: BodyState {
                position: rounded(rotation.times(self.centre)),
                rotation: rotation.rounded(),
                velocity: rounded(rotation.times(velocity)),
                angular_velocity: rounded(w),
            },
            energy: self.energy(state).to_f64(),
            force: rounded(scale(self.mass, sub(acceleration, self.gravity))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where the benchmark's centre is after a second, to the ten digits published.
    const PUBLISHED: [f64; 3] = [0.1733439641, 0.6400885921, -0.7484907911];
    const HALF_A_DIGIT: f64 = 0.500_001e-10;

    /// Two hundred radians of spin, rounding at 1e-32 a step.
    const DRIFT: f64 = 1e-24;

    #[test]
    fn the_published_centre_is_met() {
        let found = HeavyTop::benchmark().solve(&[1.0])[0].body.position;
        for (found, published) in found.iter().zip(PUBLISHED) {
            assert!((found - published).abs() < HALF_A_DIGIT, "{found}");
        }
    }

    /// Height u and azimuth ψ of a symmetric top's axis by quadratures: with E, Lz and L3 kept, u̇² = f(u)
    /// and I (1 − u²) ψ̇ = Lz − L3 u (Goldstein, *Classical Mechanics*, section 5.7); ü = ½ f'(u) has no
    /// square root.
    fn by_quadratures(wz: f64) -> [f64; 3] {
        // About the point: I = 0.234375 + 15 · 1², C = 0.46875; the axis starts level, along y.
        let [i, c, w3, wz, weight] = decimals([15.234375, 0.46875, 150.0, wz, 147.15]);
        let (l3, lz, doubled_energy, one) = (c * w3, i * wz, i * wz * wz, DoubleDouble::new(1.0));
        let derivative = |_, state: &State<3>| {
            let [u, rate, _] = *state;
            let (level, share) = (one - u * u, lz - l3 * u);
            // f = (1 − u²) (2 E − 2 m g d u) / I − (Lz − L3 u)² / I².
            let slope = -(u * (doubled_energy - (weight * u).times(2.0))) - level * weight;
            [rate, slope / i + l3 * share / (i * i), share / (i * level)]
        };
        let (_, [u, _, azimuth]) = smooth_trajectory(derivative, [DoubleDouble::ZERO; 3], &[1.0])[0];
        let (sin, cos) = azimuth.sin_cos();
        let radius = (one - u * u).sqrt();
        rounded([-(radius * sin), radius * cos, u])
    }

    #[test]
    fn the_quadratures_of_the_symmetric_top_give_the_same_centre() {
        // The benchmark itself has Lz = −L3 but for 1e-6: its axis sweeps too close past the pole u = −1.
        for wz in [20.0, -15.0] {
            let top = HeavyTop { angular_velocity: [0.0, 150.0, wz], ..HeavyTop::benchmark() };
            for (found, expected) in top.solve(&[1.0])[0].body.position.iter().zip(by_quadratures(wz)) {
                assert!((found - expected).abs() < 1e-15, "{wz} rad/s: {found} {expected}");
            }
        }
    }

    #[test]
    fn what_is_conserved_stays() {
        // A skew tensor and a skew centre: energy, vertical momentum and the length of p.
        let top = HeavyTop {
            inertia: [0.25, 0.5, 0.375, 0.01, -0.02, 0.03],
            centre: [0.3, 0.5, -0.2],
            angular_velocity: [3.0, 20.0, -5.0],
            ..HeavyTop::benchmark()
        };
        let precise = top.precisely();
        let invariants = |state: &State<7>| {
            let (rotation, w) = parted(state);
            let momentum = rotation.times(tensor_times(precise.inertia, w));
            let length = state[..4].iter().fold(DoubleDouble::ZERO, |sum, &x| sum + x * x);
            [precise.energy(state), momentum[2], length]
        };
        let end = smooth_trajectory(|_, state| precise.derivative(state), top.start(), &[1.0])[0].1;
        for (a, b) in invariants(&top.start()).iter().zip(invariants(&end)) {
            assert!(((*a - b) / *a).to_f64().abs() < DRIFT, "{a:?} {b:?}");
        }
    }

    #[test]
    fn the_point_carries_a_top_at_rest() {
        let hanging =
            HeavyTop { centre: [0.0, 0.0, -1.0], angular_velocity: [0.0, 0.0, 7.0], ..HeavyTop::benchmark() };
        let sample = hanging.solve(&[0.5])[0];
        assert_eq!(sample.body.position, [0.0, 0.0, -1.0]);
        assert_eq!(sample.force, [0.0, 0.0, 147.15]);
    }
}
