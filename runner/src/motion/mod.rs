//! A motion under way, whatever integrates it.

mod builders;
mod contract;
mod correction;
mod independent;
mod lens;
mod moving;

pub use builders::{Any, Projecting, Tree, TreeWithJacobian, WithDuals};
pub use contract::{COLUMNS, Element, Linear, Motion, MotionBuilder};
pub use independent::Closing;
