//! A motion under way, whatever integrates it.

mod attempt;
mod builders;
mod contract;
mod correction;
mod course;
mod feed;
mod independent;
mod kink;
mod lens;
mod linearise;
mod linearising;
mod moving;
mod single;
mod touching;

pub use attempt::{Attempt, Look};
pub use builders::{Any, Projecting, Tree, TreeWithJacobian, WithDuals};
pub use contract::{Begun, COLUMNS, Element, Linear, Maximal, Motion, MotionBuilder, OperatingPoint};
pub use course::Course;
pub use independent::Closing;
pub use lens::joints_near;
pub use linearising::{ByDuals, ByJacobian, Examined, Linearise, Nothing};
pub use single::{
    Direct, Implicit, ImplicitInJoints, ImplicitInJointsByDuals, InClosedForm, InJoints, Kind, Only,
    Partitioned, Projected, Stabilised, Touched, Touching,
};
