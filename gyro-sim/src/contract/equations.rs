//! The equations of motion term by term.

use super::{Mechanism, Storage};

/// The equations of motion term by term, for corrections, inspection, tests and other solvers.
pub trait Equations: Mechanism {
    /// One scalar for each velocity: `(s, w')` body after body.
    type Velocities: Storage<Self::Scalar>;
    /// The non-zeros of Φ_q with respect to (r, p), normalisation rows included.
    type PhiQ: Storage<Self::Scalar>;
    /// The non-zeros of (Φ_r, Φ_π').
    type PhiPi: Storage<Self::Scalar>;
    /// The accelerations `(s̈, ẇ')` body after body, followed by what [`Equations::multipliers`] needs besides;
    /// possibly nothing.
    type Accelerations: Storage<Self::Scalar>;

    /// Buffers, zeroed.
    fn terms(&self) -> Terms<Self>;
    /// Row and column of each non-zero of Φ_q, row by row.
    fn phi_q_pattern(&self) -> &[(u16, u16)];
    /// Row and column of each non-zero of (Φ_r, Φ_π'), row by row.
    fn phi_pi_pattern(&self) -> &[(u16, u16)];

    /// Writes the non-zeros of Φ_q, joint rows and normalisations, columns `(r, p)` body after body.
    fn phi_q(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::PhiQ);
    /// Writes the non-zeros of (Φ_r, Φ_π'), joint rows, columns `(r, π')` body after body.
    fn phi_pi(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::PhiPi);
    /// Writes ν = −Φ_t.
    fn nu(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rows);
    /// Writes γ, the right-hand side of `Φ_r s̈ + Φ_π' ẇ' = γ`.
    fn gamma(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Rows);
    /// Writes `(f, n' − w̃'J'w')`, body after body.
    fn applied_force(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Velocities);
    /// Solves eq. (17) for the accelerations `(s̈, ẇ')`.
    fn accelerations(&self, t: Self::Scalar, y: &Self::State, out: &mut Self::Accelerations);
    /// Solves eq. (17) for the multipliers λ of all joint rows, given the accelerations that
    /// [`Equations::accelerations`] has found at the same time and state.
    fn multipliers(
        &self,
        t: Self::Scalar,
        y: &Self::State,
        accelerations: &Self::Accelerations,
        lambda: &mut Self::Rows,
    );
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

/// What the functions of [`Equations`] write to.
#[derive(Clone, Debug)]
pub struct Terms<M: Equations + ?Sized> {
    /// For [`Equations::applied_force`] and [`Equations::project`].
    pub velocities: M::Velocities,
    /// For [`Equations::phi_q`].
    pub phi_q: M::PhiQ,
    /// For [`Equations::phi_pi`].
    pub phi_pi: M::PhiPi,
    /// For [`Equations::accelerations`].
    pub accelerations: M::Accelerations,
}
