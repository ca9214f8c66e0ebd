//! What controllers of robots ask for in joint coordinates. Each trait is implemented where its functions are asked for
//! (`functions = ["inverse"]` and so on), by mechanisms without loops.

use super::{JointSpace, Storage};

/// Forces for given accelerations.
///
/// With the joint state `(x, u)` of [`JointSpace`] the equations of motion are
///
/// ```text
/// M(t, x) u̇ + h(t, x, u) = τ
/// ```
///
/// τ is what acts along the rates *besides all that the model file describes*: gravity, springs, dampers, friction and
/// motors with their inputs are in h, as is what the motion of a moving base and of driven joints takes. So τ = 0 is
/// the motion of [`JointSpace::joint_accelerations`], and a controller that computes τ leaves the inputs of its motors
/// at zero.
///
/// τ has one number for each rate, in the order of u: N m along an angle and along each component of an angular
/// velocity (in the frame of the second body, about the joint), N along a displacement; of a free body the force along
/// s, in the global frame, and the torque along w', in the body's frame and about its mass centre. A rate that follows
/// others by couplers is not among them: its force is felt along those that it follows. Forces of drivers are not
/// computed.
pub trait InverseDynamics: JointSpace {
    /// Writes τ for given u̇.
    fn inverse_dynamics(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        accelerations: &Self::Rates,
        out: &mut Self::Rates,
    );
    /// Writes h: τ for u̇ = 0.
    fn bias_forces(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::Rates);
    /// Writes what holds the mechanism at rest against gravity alone, the part of h that is the gradient of the
    /// potential `−Σ m g·r` along the rates.
    fn gravity_forces(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::Rates);
}

/// The mass matrix and its factor.
///
/// M is symmetric and positive definite, `½ uᵀ M u` the kinetic energy at resting carriers: its entries have the units
/// of a force along the one rate by an acceleration of the other (kg m², kg m, kg). Rows and columns are the rates in
/// the order of u.
///
/// The factor is that of `M = Lᵀ D L`, eliminated from the leaves of the tree to its roots: then `L_ij` is zero unless
/// joint j carries joint i, so of branched trees most of it is (R. Featherstone (2005)). In the order of
/// [`MassMatrix::mass_order`], in which joints that carry others stand first, L is lower triangular with ones on its
/// diagonal, in whose place `D_i` is stored.
pub trait MassMatrix: JointSpace {
    /// n × n for n rates, row by row.
    type MassMatrix: Storage<Self::Scalar>;

    /// A buffer, zeroed.
    fn mass_buffer(&self) -> Self::MassMatrix;
    /// The rates, each behind those of all joints that carry its own.
    fn mass_order(&self) -> &[u16];
    /// Writes M, all of it.
    fn mass_matrix(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::MassMatrix);
    /// Writes the factor: `D_i` in place (i, i), `L_ij` in place (i, j), and zeros.
    fn mass_factor(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::MassMatrix);
    /// Solves `M z = b` with a factor that [`MassMatrix::mass_factor`] has written: z takes the place of b.
    fn mass_solve(&self, factor: &Self::MassMatrix, b: &mut Self::Rates) {
        let (order, factor, z) = (self.mass_order(), factor.as_ref(), b.as_mut());
        let n = order.len();
        let places = || order.iter().map(|&place| usize::from(place));
        // Lᵀ y = b, from the leaves.
        for i in places().rev() {
            for j in places().take_while(|&j| j != i) {
                z[j] = z[j] - factor[n * i + j] * z[i];
            }
        }
        // D w = y and L z = w, from the roots.
        for i in places() {
            let mut own = z[i] / factor[n * i + i];
            for j in places().take_while(|&j| j != i) {
                own = own - factor[n * i + j] * z[j];
            }
            z[i] = own;
        }
    }
}

/// Derivatives of forces and accelerations, whatever the number of rates.
///
/// Positions change along the rates: the column of a rate says what becomes of a result if the coordinates move by a
/// small ε as that rate moves them, all other rates being zero. An angle or a displacement grows by ε; Euler parameters
/// turn by ε about an axis of the second body's frame (of a free body: of its own), `p + ½ ε G(p)ᵀ e`; a free body is
/// displaced by ε along an axis of the global frame. So every block has a column for each rate, not one for each
/// coordinate. Rates u, accelerations u̇, time, inputs and parameters are held.
pub trait DynamicsDerivatives: InverseDynamics {
    /// n × 2n for n rates, row by row.
    type InverseDerivatives: Storage<Self::Scalar>;
    /// n × 3n for n rates, row by row.
    type ForwardDerivatives: Storage<Self::Scalar>;

    /// A buffer, zeroed.
    fn inverse_buffer(&self) -> Self::InverseDerivatives;
    /// A buffer, zeroed.
    fn forward_buffer(&self) -> Self::ForwardDerivatives;
    /// Writes ∂τ/∂(x, u) of [`InverseDynamics::inverse_dynamics`] for given u̇, n rows of n numbers by x and then n by
    /// u. (∂τ/∂u̇ is M.)
    fn inverse_derivatives(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        accelerations: &Self::Rates,
        out: &mut Self::InverseDerivatives,
    );
    /// Writes ∂u̇/∂(x, u, τ) of [`JointSpace::joint_accelerations`], n rows of n numbers by x, n by u and n by forces
    /// along the rates, which are M⁻¹.
    fn forward_derivatives(&self, t: Self::Scalar, x: &Self::Joints, out: &mut Self::ForwardDerivatives);
}

/// Forces as a product with the inertial parameters of the bodies, for their identification.
///
/// θ has ten numbers for each body, bodies in the order of [`Description::bodies`](super::Description): the mass m
/// (kg), the first moment `∫ r dm` (x, y, z; kg m) and the moments of inertia (xx, yy, zz, xy, xz, yz; kg m²), both
/// about the origin of the body's frame and in that frame. The origin is where the model file has the mass centre: its
/// own values are `(m, 0, 0, 0, J')`; the moment xy is the entry of the inertia matrix, as in model files.
///
/// `Y θ` is what inertia and gravity take of τ. What else acts does not depend on θ: the difference of
/// [`InverseDynamics::inverse_dynamics`] and `Y θ`, θ being that of the model, is the same for all θ.
pub trait Regressor: JointSpace {
    /// n × 10 N for n rates and N bodies, row by row.
    type Regressor: Storage<Self::Scalar>;

    /// A buffer, zeroed.
    fn regressor_buffer(&self) -> Self::Regressor;
    /// Writes Y for given u̇.
    fn regressor(
        &self,
        t: Self::Scalar,
        x: &Self::Joints,
        accelerations: &Self::Rates,
        out: &mut Self::Regressor,
    );
}
