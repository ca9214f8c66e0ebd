//! Equations of motion in maximal coordinates.

use super::{JointSpace, Mechanism, Storage};

/// The equations of motion at any state, on the constraints and off them.
pub trait Dynamics: Mechanism {
    /// The accelerations `(s̈, ẇ')` body after body, followed by what [`Dynamics::multipliers`] needs besides;
    /// possibly nothing.
    type Accelerations: Storage<Self::Scalar>;

    /// A buffer for [`Dynamics::accelerations`], zeroed.
    fn acceleration_buffer(&self) -> Self::Accelerations;
    /// Solves eq. (17) for the accelerations `(s̈, ẇ')`.
    fn accelerations(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Accelerations);
    /// Solves eq. (17) for the multipliers λ of all joint rows, given the accelerations that
    /// [`Dynamics::accelerations`] has found at the same time and state.
    fn multipliers(
        &self,
        t: Self::Scalar,
        y: &Self::State,
        accelerations: &Self::Accelerations,
        lambda: &mut Self::Rows,
    );
    /// Writes `ẏ = f(t, y)`, eqs. (14), (16) and (17); [`Exact`](crate::Exact) integrates it.
    fn derivative(&self, t: Self::Scalar, y: &Self::State, dy: &mut Self::State);
}

/// The equations of motion for states that were corrected a few steps ago: violations of the constraints are then of
/// the order of the integrator's error, and so is the error of these functions. Mechanisms in joint coordinates need
/// far fewer operations for them; others hand on to [`Dynamics`].
pub trait CorrectedDynamics: Mechanism {
    /// Writes (s̈, ẇ') at a state that satisfies the constraints.
    fn corrected_accelerations(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Velocities);
    /// Writes ẏ there; [`Corrected`](crate::Corrected) integrates it.
    fn corrected_derivative(&self, t: Self::Scalar, y: &Self::State, dy: &mut Self::State);
}

/// What else the motion at a maximal state tells that satisfies the constraints.
pub trait CorrectedSolution: CorrectedDynamics + JointSpace {
    /// One scalar for each unknown of eq. (17).
    type Solution: Storage<Self::Scalar>;

    /// A buffer for [`CorrectedSolution::corrected_solution`], zeroed.
    fn solution_buffer(&self) -> Self::Solution;
    /// Writes u̇.
    fn joint_accelerations_at(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rates);
    /// Writes λ of all joint rows at these accelerations.
    fn corrected_multipliers(
        &self,
        t: Self::Scalar,
        y: &Self::State,
        accelerations: &Self::Velocities,
        lambda: &mut Self::Rows,
    );
    /// Writes both, (s̈, ẇ') and then λ; what they have in common is computed once.
    fn corrected_solution(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Solution);
}

/// The projection that the masses weigh.
pub trait Projection: Mechanism {
    /// Writes `δ = (δr, δπ')` body after body, the solution of
    ///
    /// ```text
    /// [ M     Φ_π'ᵀ ] [ δ ]   [  0   ]
    /// [ Φ_π'    0   ] [ μ ] = [ rows ]        Φ_π' short for (Φ_r, Φ_π')
    /// ```
    ///
    /// at the given state, which need not satisfy the constraints. Of all motions that change the joint rows by `rows`
    /// to first order it is the one with the least `δᵀ M δ`: with `rows = −Φ` a step of a correction of the positions
    /// (p follows by `δp = ½ G(p)ᵀ δπ'`), with minus the [velocity residual](Mechanism::velocity_residual) the
    /// correction of the velocities (s, w'). In this metric no coordinate is preferred, and heavy bodies are moved
    /// least.
    fn project(&self, t: Self::Scalar, y: &Self::State, rows: &Self::Rows, out: &mut Self::Velocities);
}
