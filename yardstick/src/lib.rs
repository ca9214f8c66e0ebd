//! What run times are measured by: the paper's second, derived by hand, in the same process and the same moments, and
//! the time that the processor has spent on it.
//!
//! A ratio to it says the same on a quick machine and on a slow one.
#![deny(missing_docs)]

mod beside;
mod floor;

pub use beside::{Measured, beside, processor_time};
pub use floor::{FLOPS, Floor, START, STEP};
