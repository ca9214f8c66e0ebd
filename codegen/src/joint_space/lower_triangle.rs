//! Symmetric matrices between unknowns, by their lower triangles.

use crate::expr::graph::{ExprId, Graph};
use crate::solve::gram_schmidt::Armature;
use std::collections::BTreeMap;

/// Adds what two motions of two unknowns have in common to the lower triangle; on the diagonal both orders of two
/// motions of the same unknown.
pub fn couple(
    graph: &mut Graph,
    matrix: &mut BTreeMap<(usize, usize), ExprId>,
    (a, b): (usize, usize),
    entry: ExprId,
    is_same_motion: bool,
) {
    let both = if a == b && !is_same_motion { graph.add(entry, entry) } else { entry };
    let whole = matrix.entry((a.max(b), a.min(b))).or_insert(Graph::ZERO);
    *whole = graph.add(*whole, both);
}

/// What armatures resist the unknowns by.
pub fn resistance(graph: &mut Graph, armatures: &[Armature]) -> BTreeMap<(usize, usize), ExprId> {
    let mut matrix = BTreeMap::new();
    for (inertia, by) in armatures {
        for (k, &(place, factor)) in by.iter().enumerate() {
            let scaled = graph.mul(*inertia, factor);
            for (l, &(other, other_factor)) in by[..=k].iter().enumerate() {
                let entry = graph.mul(scaled, other_factor);
                couple(graph, &mut matrix, (place, other), entry, k == l);
            }
        }
    }
    matrix
}
