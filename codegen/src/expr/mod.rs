//! Expressions: the graph, exact constants, derivatives, and the order in which expressions are computed.

pub mod by_expr;
pub mod calls;
pub mod constant;
pub mod definitions;
pub mod differentiate;
pub mod domains;
pub mod elementary;
pub mod evaluate;
pub mod graph;
pub mod rounding;
pub mod schedule;
pub mod spatial_vector;
pub mod symbol;
pub mod vector;
