//! Φ_q, ν and γ, derived from Φ by differentiation.

use crate::derive::constraints::{self, Along};
use crate::derive::in_time::in_time;
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion, Values};
use crate::expr::differentiate::{Derivative, Direction};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use crate::expr::vector::Vec3;
use crate::simplify::normal_form::is_zero_at_points;
use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeSet;

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
        let n_moving_bodies = system.moving_bodies.len();

        let rows_of_moving_bodies = rows_of_moving_bodies(system, &all);
        let mut phi_q = columns(system, &all, &rows_of_moving_bodies, coordinate_directions(n_moving_bodies));
        let rotations = (0..n_moving_bodies).flat_map(|moving_body| (0..6).map(move |k| (moving_body, k)));
        let virtual_motions =
            rotations.map(|(moving_body, k)| system.unit_direction(moving_body, k)).collect();
        let mut phi_pi = columns(system, &phi, &rows_of_moving_bodies, virtual_motions);

        let time = in_time(&mut system.graph, system.model);
        let phi_t = along(system, &phi, time.clone());
        let mut nu: Vec<_> = phi_t.iter().map(|&row| system.graph.neg(row)).collect();
        let mut velocity_residual = motion_derivative(system, &phi);
        for (row, by_time) in constraints::of_velocities(system, &Along(time)) {
            let by_time = at_rest(system, by_time);
            nu[row] = system.graph.neg(by_time);
        }
        let motion = Along(system.motion());
        for (row, residual) in constraints::of_velocities(system, &motion) {
            velocity_residual[row] = residual;
            phi_pi[row] = by_velocities(system, residual);
            phi_q[row] = by_coordinates(system, &phi_pi[row]);
        }
        let second = motion_derivative(system, &velocity_residual);
        let gamma = second.iter().map(|&row| system.graph.neg(row)).collect();
        Self { phi, normalisations, phi_q, phi_pi, velocity_residual, nu, gamma }
    }

    /// Columns π' of a moving body in a row of Φ_π'.
    pub fn rotation(&self, row: usize, moving_body: usize) -> Vec3 {
        std::array::from_fn(|k| self.phi_pi[row][6 * moving_body + 3 + k])
    }
}

/// s and w' of each moving body.
fn velocities(system: &System) -> impl Iterator<Item = Symbol> + use<> {
    let of = |moving_body| {
        let s = (0..3).map(move |k| Symbol::Velocity { moving_body, k });
        s.chain((0..3).map(move |k| Symbol::Spin { moving_body, k }))
    };
    (0..system.moving_bodies.len()).flat_map(of)
}

/// An expression where bodies with coordinates rest.
fn at_rest(system: &mut System, moving: ExprId) -> ExprId {
    let still = velocities(system).map(|symbol| (symbol, Graph::ZERO)).collect();
    Expansion::with_values(&Definitions::default(), still).of(&mut system.graph, moving)
}

/// What each velocity is multiplied by in a row of velocities.
fn by_velocities(system: &mut System, residual: ExprId) -> Vec<ExprId> {
    let euler = system.moving_bodies.iter().map(|&body| system.poses[body].p.to_vec());
    let unit: Vec<_> = euler.collect();
    let velocities = velocities(system);
    let of = |symbol| {
        let direction = Direction::from([(symbol, Graph::ONE)]);
        let factor = Derivative::new(&system.definitions, direction).of(&mut system.graph, residual);
        let expanded = system.expanded(&Values::default(), &[factor])[0];
        if is_zero_at_points(&system.graph, &unit, expanded) { Graph::ZERO } else { factor }
    };
    velocities.map(of).collect()
}

/// The same for rates of (r, p), by `w' = 2 G ṗ`.
fn by_coordinates(system: &mut System, row: &[ExprId]) -> Vec<ExprId> {
    let bodies = system.moving_bodies.iter().map(|&body| system.poses[body].p).zip(row.chunks(6));
    let graph = &mut system.graph;
    let of = |(p, row): ([ExprId; 4], &[ExprId])| {
        let two = graph.integer(2);
        let turned = graph.scale_vec(two, &[row[3], row[4], row[5]]);
        let g = graph.g_matrix(&p);
        let by_p = [0, 1, 2, 3].map(|k| graph.dot(&turned, &[g[0][k], g[1][k], g[2][k]]));
        row[..3].iter().copied().chain(by_p).collect::<Vec<_>>()
    };
    bodies.flat_map(of).collect()
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

/// Unit directions of r and p of each moving body. A and A_iᵀA_j then differentiate as their definitions.
fn coordinate_directions(n_moving_bodies: usize) -> Vec<Direction> {
    let symbol = |moving_body, k| {
        if k < 3 { Symbol::Position { moving_body, k } } else { Symbol::Euler { moving_body, k: k - 3 } }
    };
    (0..n_moving_bodies)
        .flat_map(|moving_body| (0..7).map(move |k| Direction::from([(symbol(moving_body, k), Graph::ONE)])))
        .collect()
}

/// The derivatives of some rows along directions, equally many for each moving body, of rows in which the moving body
/// occurs: others do not change.
fn columns(
    system: &mut System,
    rows: &[ExprId],
    rows_of_moving_bodies: &[Vec<usize>],
    directions: Vec<Direction>,
) -> Matrix {
    let mut matrix = vec![vec![Graph::ZERO; directions.len()]; rows.len()];
    let of_each = directions.len() / rows_of_moving_bodies.len().max(1);
    for (column, direction) in directions.into_iter().enumerate() {
        let mut derivative = Derivative::new(&system.definitions, direction);
        for &row in rows_of_moving_bodies[column / of_each].iter().filter(|row| **row < rows.len()) {
            matrix[row][column] = derivative.of(&mut system.graph, rows[row]);
        }
    }
    matrix
}

/// For each moving body the rows that depend on where its body is.
fn rows_of_moving_bodies(system: &System, rows: &[ExprId]) -> Vec<Vec<usize>> {
    let (mut rows_of_moving_bodies, mut known) =
        (vec![Vec::new(); system.moving_bodies.len()], HashMap::default());
    for (row, &root) in rows.iter().enumerate() {
        slots_of(system, root, &mut known)
            .iter()
            .for_each(|&moving_body| rows_of_moving_bodies[moving_body].push(row));
    }
    rows_of_moving_bodies
}

/// The moving bodies whose coordinates an expression depends on, symbols being what they stand for.
fn slots_of(system: &System, root: ExprId, known: &mut HashMap<Symbol, BTreeSet<usize>>) -> BTreeSet<usize> {
    let mut moving_bodies = BTreeSet::new();
    for id in system.graph.reachable(&[root]) {
        let Node::Symbol(symbol) = *system.graph.node(id) else { continue };
        if let Symbol::Position { moving_body, .. } | Symbol::Euler { moving_body, .. } = symbol {
            moving_bodies.insert(moving_body);
        } else if let Some(definition) = system.definitions.get(symbol) {
            if !known.contains_key(&symbol) {
                let of_definition = slots_of(system, definition, known);
                known.insert(symbol, of_definition);
            }
            moving_bodies.extend(&known[&symbol]);
        }
    }
    moving_bodies
}

fn along(system: &mut System, rows: &[ExprId], direction: Direction) -> Vec<ExprId> {
    let mut derivative = Derivative::new(&system.definitions, direction);
    rows.iter().map(|&row| derivative.of(&mut system.graph, row)).collect()
}
