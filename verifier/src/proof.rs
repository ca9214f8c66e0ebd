//! Identity testing: both sides at random points modulo a prime, and how likely it is that they agree by accident.

mod case;
mod claim;
mod closure;
mod compare;
mod decide;
mod dependence;
mod elimination;
mod joints;
mod observed;
mod on_request;
mod partition;
mod point;
mod residuals;
mod statements;

pub(crate) use case::point as point_of_terms;

pub use claim::Claim;
pub use compare::Needless;
pub use decide::{Decider, Verdict};
pub use statements::{Statements, prime};
