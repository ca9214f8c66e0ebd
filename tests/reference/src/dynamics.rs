//! Kane's equations of the gyroscope in the angles (α, β, φ).
//!
//! Vectors are resolved in the inner ring's frame, where the joint axes are a = (sin β, cos β, 0), z and x, and the
//! rotor differs from its own frame by Rx(φ) alone. With w2ᵢ, w3ᵢ and vᵢ the partial velocities (how fast inner ring,
//! rotor and rotor centre turn or move per unit of the i-th rate), the equations are M(q) q̈ = h(q, q̇):
//!
//! ```text
//! M_ij = m3 vi·vj + w2i·J2 w2j + w3i·J3 w3j            (+ J1y where i = j = α)
//! h_i  = m3 vi·(g − b3) − w2i·(J2 e2 + ω2×J2 ω2) − w3i·(J3 e3 + ω3×J3 ω3) − ci q̇i
//! ```
//!
//! where e2, e3 and b3 are the angular accelerations and the acceleration of the rotor centre at q̈ = 0.

use crate::vector::{Turn, Vector, add, cross, diagonal, dot, scale, solve_symmetric, sub};
use crate::{Gyroscope, Real};

/// Where everything is: joint axes and offsets in the inner ring's frame.
struct Configuration<T> {
    alpha: Turn<T>,
    beta: Turn<T>,
    phi: Turn<T>,
    /// Axes of the three joints.
    axes: [Vector<T>; 3],
    /// s2', from the gimbal centre to the bearing.
    to_bearing: Vector<T>,
    /// Rx(φ) s3', from the rotor centre to the bearing.
    from_centre: Vector<T>,
}

/// How everything moves: angular velocities in the inner ring's frame.
struct Velocities<T> {
    ring: Vector<T>,
    rotor: Vector<T>,
}

/// Accelerations at q̈ = 0.
struct Bias<T> {
    ring: Vector<T>,
    rotor: Vector<T>,
    centre: Vector<T>,
}

impl<T: Real> Gyroscope<T> {
    /// The angular accelerations α̈, β̈, φ̈ in rad/s² at the angles (rad) and rates (rad/s) given.
    ///
    /// There is no gimbal lock: the outer ring's own inertia keeps M regular at β = ±π/2.
    ///
    /// ```
    /// let gyroscope = gyro_reference::Gyroscope::paper().rounded();
    /// let [_, beta_acceleration, _] = gyroscope.accelerations([0.0; 3], [0.0, 0.0, 100.0]);
    /// // The weight's moment m g d about z, over the inertia about z.
    /// assert!((beta_acceleration + 1e-4 / 6.00125e-6).abs() < 1e-13);
    /// ```
    #[must_use]
    pub fn accelerations(&self, angles: [T; 3], rates: [T; 3]) -> [T; 3] {
        let here = self.configuration(angles);
        let centre = here.centre_partials();
        let moments = self.generalised_forces(&here, &centre, rates);
        solve_symmetric(self.mass_matrix(&here, &centre), moments)
    }

    /// Kinetic energy of rings and rotor plus the rotor's potential −m3 g·r3 (zero at the gimbal centre), J.
    #[must_use]
    pub fn energy(&self, angles: [T; 3], rates: [T; 3]) -> T {
        let here = self.configuration(angles);
        let mass = self.mass_matrix(&here, &here.centre_partials());
        let momenta = mass.map(|row| dot(row, rates));
        let kinetic = T::from(0.5) * dot(rates, momenta);
        kinetic - self.mass[2] * dot(here.to_ring_frame(self.gravity), sub(here.to_bearing, here.from_centre))
    }

    fn configuration(&self, angles: [T; 3]) -> Configuration<T> {
        let [alpha, beta, phi] = angles.map(Turn::new);
        let (zero, one) = (T::from(0.0), T::from(1.0));
        Configuration {
            alpha,
            beta,
            phi,
            axes: [[beta.sin, beta.cos, zero], [zero, zero, one], [one, zero, zero]],
            to_bearing: self.ring_offset,
            from_centre: phi.about_x(self.rotor_offset),
        }
    }

    fn mass_matrix(&self, here: &Configuration<T>, centre: &[Vector<T>; 3]) -> [Vector<T>; 3] {
        let [outer, inner, rotor] = self.inertia;
        let zero = T::from(0.0);
        let rotor_momenta = here.axes.map(|axis| here.rotor_inertia_times(rotor, axis));
        let mut matrix = [[zero; 3]; 3];
        for i in 0..3 {
            for j in 0..=i {
                let ring = if i < 2 { dot(here.axes[i], diagonal(inner, here.axes[j])) } else { zero };
                let turning = dot(here.axes[i], rotor_momenta[j]);
                matrix[i][j] = self.mass[2] * dot(centre[i], centre[j]) + ring + turning;
                matrix[j][i] = matrix[i][j];
            }
        }
        matrix[0][0] = matrix[0][0] + outer[1];
        matrix
    }

    fn generalised_forces(&self, here: &Configuration<T>, centre: &[Vector<T>; 3], rates: [T; 3]) -> [T; 3] {
        let [_, inner, rotor] = self.inertia;
        let velocities = here.velocities(rates);
        let bias = here.bias(&velocities, rates);

        let force = scale(self.mass[2], sub(here.to_ring_frame(self.gravity), bias.centre));
        let ring_change =
            add(diagonal(inner, bias.ring), cross(velocities.ring, diagonal(inner, velocities.ring)));
        let rotor_change = add(
            here.rotor_inertia_times(rotor, bias.rotor),
            cross(velocities.rotor, here.rotor_inertia_times(rotor, velocities.rotor)),
        );
        let both_change = add(ring_change, rotor_change);

        // The inner ring's partial velocity for φ is zero, the others are the rotor's.
        let [a, z, x] = here.axes;
        [
            dot(centre[0], force) - dot(a, both_change) - self.friction[0] * rates[0],
            dot(centre[1], force) - dot(z, both_change) - self.friction[1] * rates[1],
            dot(centre[2], force) - dot(x, rotor_change) - self.friction[2] * rates[2],
        ]
    }
}

impl<T: Real> Configuration<T> {
    /// Partial velocities of the rotor's mass centre: α and β carry the whole arm from the gimbal centre, φ the part
    /// fixed in the rotor.
    fn centre_partials(&self) -> [Vector<T>; 3] {
        let arm = sub(self.to_bearing, self.from_centre);
        let [a, z, x] = self.axes;
        [cross(a, arm), cross(z, arm), cross(self.from_centre, x)]
    }

    fn velocities(&self, rates: [T; 3]) -> Velocities<T> {
        let [a, z, x] = self.axes;
        let ring = add(scale(rates[0], a), scale(rates[1], z));
        Velocities { ring, rotor: add(ring, scale(rates[2], x)) }
    }

    /// The axis of α is fixed in space, that of β turns with the outer ring, that of φ with the inner one.
    fn bias(&self, velocities: &Velocities<T>, rates: [T; 3]) -> Bias<T> {
        let [a, z, x] = self.axes;
        let ring = scale(rates[0] * rates[1], cross(a, z));
        let rotor = add(ring, scale(rates[2], cross(velocities.ring, x)));
        let bearing = point_acceleration(ring, velocities.ring, self.to_bearing);
        Bias {
            ring,
            rotor,
            centre: sub(bearing, point_acceleration(rotor, velocities.rotor, self.from_centre)),
        }
    }

    /// A2ᵀ `global`.
    fn to_ring_frame(&self, global: Vector<T>) -> Vector<T> {
        self.beta.inverse().about_z(self.alpha.inverse().about_y(global))
    }

    /// Rx(φ) J3 Rx(φ)ᵀ `a`.
    fn rotor_inertia_times(&self, inertia: Vector<T>, a: Vector<T>) -> Vector<T> {
        self.phi.about_x(diagonal(inertia, self.phi.inverse().about_x(a)))
    }
}

/// e × arm + ω × (ω × arm): the acceleration of a point fixed in a body that turns about a point at rest.
fn point_acceleration<T: Real>(angular: Vector<T>, velocity: Vector<T>, arm: Vector<T>) -> Vector<T> {
    add(cross(angular, arm), cross(velocity, cross(velocity, arm)))
}
