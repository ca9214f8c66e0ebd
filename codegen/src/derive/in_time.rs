//! What time changes by itself.

use crate::expr::differentiate::Direction;
use crate::expr::graph::Graph;
use crate::expr::symbol::Symbol;
use gyro_model::Model;

/// What changes with time alone: time, and inputs that motions follow, each as the next of its derivatives says.
pub fn in_time(graph: &mut Graph, model: &Model) -> Direction {
    let mut direction = Direction::from([(Symbol::Time, Graph::ONE)]);
    for (_, [place, rate, acceleration]) in model.followed_inputs() {
        for (of, by) in [(place, rate), (rate, acceleration)] {
            direction.insert(Symbol::Input(of), graph.symbol(Symbol::Input(by)));
        }
    }
    direction
}
