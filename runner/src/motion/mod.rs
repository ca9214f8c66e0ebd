//! A motion under way, whatever integrates it.

mod builders;
mod contract;
mod correction;
mod independent;
mod lens;
mod linearise;
mod moving;
mod single;

pub use builders::{Any, Projecting, Tree, TreeWithJacobian, WithDuals};
pub use contract::{COLUMNS, Element, Linear, Maximal, Motion, MotionBuilder, OperatingPoint};
pub use independent::Closing;
pub use single::{Direct, InClosedForm, InJoints, Kind, Only, Partitioned, Projected, Stabilised};
