//! The ways of writing rotation matrices, of which each function takes the cheapest: by Euler parameters or their
//! doubles, of bodies or of one body relative to another.

use crate::derive::readings::relative_euler;
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion, Values};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, Vec4};
use crate::simplify::cheapest::{Chosen, FinalPasses};

/// With more bodies nearly all entries of rotation matrices are used, and 2p is the cheaper way to them: of ten bodies
/// with parallel axes one function takes 3 operations of 1369 more, all others the same.
const MAX_UNDOUBLED: usize = 8;

/// A way of writing rotation matrices.
struct Way<'d> {
    name: &'static str,
    expansion: Expansion<'d>,
    /// Whether it means the same for any p, not just for unit vectors.
    holds_for_any: bool,
    /// Whether it goes by 2p.
    is_doubled: bool,
}

/// All ways of writing rotation matrices.
pub struct Rotations<'d> {
    ways: Vec<Way<'d>>,
    pub passes: FinalPasses,
}

impl<'d> Rotations<'d> {
    /// `definitions` are those of the system, with rotation matrices by p.
    pub fn of(system: &mut System, definitions: &'d Definitions) -> Self {
        let doubled = by_doubles(system);
        let relative = relative(system, Graph::rotation);
        let mut doubled_relative = self::relative(system, Graph::rotation_by_doubles);
        doubled_relative.extend(doubled.clone());
        let passes = FinalPasses::of(!system.loop_closure_rows().is_empty());
        let way = |name, values, holds_for_any, is_doubled| Way {
            name,
            expansion: Expansion::with_values(definitions, values),
            holds_for_any,
            is_doubled,
        };
        let mut ways = vec![
            way("rotations of the bodies", Values::default(), true, false),
            way("rotations of the bodies, doubled", doubled, true, true),
            way("relative Euler parameters", relative, false, false),
            way("relative Euler parameters, doubled", doubled_relative, false, true),
        ];
        if system.moving_bodies.len() > MAX_UNDOUBLED {
            ways.retain(|way| way.is_doubled);
        }
        Self { ways, passes }
    }

    /// The cheapest of those that mean the same for any p.
    pub fn expanded(&mut self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        self.cheapest_of(graph, roots, |way| way.holds_for_any).roots
    }

    /// The cheapest of all, for unit Euler parameters.
    pub fn cheapest(&mut self, graph: &mut Graph, roots: &[ExprId]) -> Chosen {
        self.cheapest_of(graph, roots, |_| true)
    }

    fn cheapest_of(&mut self, graph: &mut Graph, roots: &[ExprId], is_tried: fn(&Way) -> bool) -> Chosen {
        let ways = self.ways.iter_mut().filter(|way| is_tried(way));
        let candidates = ways.map(|way| (way.name.to_owned(), way.expansion.all(graph, roots))).collect();
        self.passes.cheapest(graph, candidates)
    }
}

/// A(p) of each moving body by way of 2p.
fn by_doubles(system: &mut System) -> Values {
    let mut values = Values::default();
    for (moving_body, &body) in system.moving_bodies.iter().enumerate() {
        let rotation = system.graph.rotation_by_doubles(&system.poses[body].p);
        insert(&mut values, &rotation, |row, column| Symbol::Rotation { moving_body, row, column });
    }
    values
}

/// `A_iᵀ A_j = A(p_i* p_j)` of each joint: eq. (4) for unit p, in fewer operations where A_i and A_j are not needed
/// anyhow.
fn relative(system: &mut System, rotation: fn(&mut Graph, &Vec4) -> Mat3) -> Values {
    let mut values = Values::default();
    if !system.loop_closure_rows().is_empty() {
        return values;
    }
    for (joint, frames) in system.joints.clone().iter().enumerate() {
        let p = relative_euler(system, frames);
        let rotation = rotation(&mut system.graph, &p);
        insert(&mut values, &rotation, |row, column| Symbol::Relative { joint, row, column });
    }
    values
}

fn insert(values: &mut Values, rotation: &Mat3, symbol: impl Fn(usize, usize) -> Symbol) {
    for (row, entries) in rotation.iter().enumerate() {
        for (column, &entry) in entries.iter().enumerate() {
            values.insert(symbol(row, column), entry);
        }
    }
}
