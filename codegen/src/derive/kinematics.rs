//! Φ_q, ν and γ, derived from Φ by differentiation.

use crate::derive::constraints;
use crate::derive::system::System;
use crate::expr::differentiate::Derivative;
use crate::expr::differentiate::Direction;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::Vec3;

/// A matrix by rows, zeros included; [`non_zeros`] gives its pattern.
pub type Matrix = Vec<Vec<ExprId>>;

/// Everything that follows from Φ alone. Rotation matrices are still symbols.
#[derive(Debug)]
pub struct Kinematics {
    /// Joint rows.
    pub phi: Vec<ExprId>,
    /// Normalisations, eq. (12).
    pub normalisations: Vec<ExprId>,
    /// With respect to (r, p), joint rows then normalisations.
    pub phi_q: Matrix,
    /// With respect to (r, π'), joint rows.
    pub phi_pi: Matrix,
    /// Φ̇ = Φ_r s + Φ_π' w' − ν.
    pub velocity_residual: Vec<ExprId>,
    /// −Φ_t.
    pub nu: Vec<ExprId>,
    /// Right-hand side of the acceleration equation.
    pub gamma: Vec<ExprId>,
}

impl Kinematics {
    pub fn derive(system: &mut System) -> Self {
        let (phi, normalisations) = (constraints::rows(system), constraints::normalisations(system));
        let all: Vec<_> = phi.iter().chain(&normalisations).copied().collect();
        let n_slots = system.slots.len();

        let phi_q = columns(system, &all, coordinate_directions(n_slots));
        let rotations = (0..n_slots).flat_map(|slot| (0..6).map(move |k| (slot, k)));
        let virtual_motions = rotations.map(|(slot, k)| system.unit_motion(slot, k)).collect::<Vec<_>>();
        let virtual_motions = virtual_motions.iter().map(|motion| system.direction(motion)).collect();
        let phi_pi = columns(system, &phi, virtual_motions);

        let time = Direction::from([(Symbol::Time, Graph::ONE)]);
        let phi_t = along(system, &phi, time);
        let nu = phi_t.iter().map(|&row| system.graph.neg(row)).collect();
        let velocity_residual = motion_derivative(system, &phi);
        let second = motion_derivative(system, &velocity_residual);
        let gamma = second.iter().map(|&row| system.graph.neg(row)).collect();
        Self { phi, normalisations, phi_q, phi_pi, velocity_residual, nu, gamma }
    }

    /// Columns π' of a slot in a row of Φ_π'.
    pub fn rotation(&self, row: usize, slot: usize) -> Vec3 {
        std::array::from_fn(|k| self.phi_pi[row][6 * slot + 3 + k])
    }
}

/// Row, column and value of each entry that is not zero, row by row.
pub fn non_zeros(matrix: &Matrix) -> Vec<(usize, usize, ExprId)> {
    let rows = matrix.iter().enumerate();
    rows.flat_map(|(row, values)| {
        values
            .iter()
            .enumerate()
            .filter(|(_, v)| **v != Graph::ZERO)
            .map(move |(column, v)| (row, column, *v))
    })
    .collect()
}

/// Total time derivative with s and w' held constant: of Φ it is Φ_r s + Φ_π' w' + Φ_t, and of that, −γ, because the
/// terms left out are those with s̈ and ẇ'.
fn motion_derivative(system: &mut System, rows: &[ExprId]) -> Vec<ExprId> {
    let direction = system.motion();
    along(system, rows, direction)
}

/// Unit directions of r and p of each slot. A and A_iᵀA_j then differentiate as their definitions.
fn coordinate_directions(n_slots: usize) -> Vec<Direction> {
    let symbol =
        |slot, k| if k < 3 { Symbol::Position { slot, k } } else { Symbol::Euler { slot, k: k - 3 } };
    (0..n_slots)
        .flat_map(|slot| (0..7).map(move |k| Direction::from([(symbol(slot, k), Graph::ONE)])))
        .collect()
}

fn columns(system: &mut System, rows: &[ExprId], directions: Vec<Direction>) -> Matrix {
    let columns: Vec<_> = directions.into_iter().map(|d| along(system, rows, d)).collect();
    (0..rows.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

fn along(system: &mut System, rows: &[ExprId], direction: Direction) -> Vec<ExprId> {
    let mut derivative = Derivative::new(&system.definitions, direction);
    rows.iter().map(|&row| derivative.of(&mut system.graph, row)).collect()
}
