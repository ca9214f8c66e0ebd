//! A motion under way, whatever integrates it.

mod builders;
mod contract;
mod correction;
mod lens;
mod moving;

pub use builders::{Any, Projecting, Tree, TreeWithJacobian, WithDuals};
pub use contract::{COLUMNS, Linear, Motion, MotionBuilder};
