//! In which units rates are counted where loops are closed by the least change.
//!
//! What a spring holds must not be what closes a loop. A stiff spring that is moved by as little as a tolerance is far
//! from where the motion has it: it springs back within a small part of a step, which a method that takes long steps
//! cannot follow, and its forces enter what moves slowly. So coordinates with springs and stops are counted in smaller
//! units, and move where the others alone would have to move much farther. They move all the same: no coordinate can
//! close a loop at every pose.

use super::closure::Closure;
use super::embedding::Embedding;
use super::layout::Layout;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use gyro_model::CoordinateUse;

/// The unit of a coordinate that a spring holds. On a four-bar linkage with a bushing, at a tolerance of 1e-6, `rodas4`
/// is then as good as without closing up to 1e7 N·m/rad, and a soft spring on any joint makes no difference; from 1/100
/// on one on the rocker does, whose other coordinates close the loop badly where crank and coupler are in line.
const HELD: i64 = 32;

/// Of each rate of the state.
pub fn units(system: &mut System, layout: &Layout, by_rates: &Embedding) -> Vec<ExprId> {
    let held = system.graph.fraction(1, HELD);
    let mut units = vec![Graph::ONE; layout.n_rates];
    // What rows yield that depend on others is made for rates as they are.
    if !system.model.dependent_rows().is_empty() {
        return units;
    }
    for force in &system.model.forces {
        let Some((on, CoordinateUse::Value)) = force.kind.parts().on else { continue };
        let Some(scalar) = layout.scalar(on) else { continue };
        for (rate, _) in &by_rates.rates[scalar.place.u].columns {
            units[*rate] = held;
        }
    }
    units
}

/// The rows, their Jacobian in these units.
pub fn in_units(graph: &mut Graph, closure: &Closure, units: &[ExprId]) -> Closure {
    let mut scaled = closure.clone();
    for row in &mut scaled.jacobian {
        row.iter_mut().zip(units).for_each(|(entry, &unit)| *entry = graph.mul(*entry, unit));
    }
    scaled
}
