//! A motion under way, whatever integrates it.

mod builders;
mod contract;
mod correction;
mod independent;
mod lens;
mod linearise;
mod moving;

pub use builders::{Any, Projecting, Tree, TreeWithJacobian, WithDuals};
pub use contract::{COLUMNS, Element, Linear, Motion, MotionBuilder, OperatingPoint};
pub use independent::Closing;
