//! Derivatives of the constraints.

use super::{Mechanism, Storage};

/// The derivatives of Φ that the equations of motion are made of, for pivoting, inspection, tests and other solvers.
pub trait Kinematics: Mechanism {
    /// The non-zeros of Φ_q with respect to (r, p), normalisation rows included.
    type PhiQ: Storage<Self::Scalar>;
    /// The non-zeros of (Φ_r, Φ_π').
    type PhiPi: Storage<Self::Scalar>;

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
}

/// What the functions of [`Kinematics`] write to.
#[derive(Clone, Debug)]
pub struct Terms<M: Kinematics + ?Sized> {
    /// For [`Kinematics::phi_q`].
    pub phi_q: M::PhiQ,
    /// For [`Kinematics::phi_pi`].
    pub phi_pi: M::PhiPi,
}
