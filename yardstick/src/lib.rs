//! What run times are measured by: the paper's second, derived by hand, in the same process and the same moments, and
//! the time that the processor has spent on it. A ratio to it says the same on a quick machine and on a slow one.
//!
//! And what closed loops are measured by: [`FourBar`], [`SliderCrank`] and [`Stewart`], derived by hand in as many
//! coordinates as there are degrees of freedom, which [`operations`] counts. `cargo run --release -p gyro-yardstick
//! --example floors` prints counts and times.
#![deny(missing_docs)]

mod beside;
mod counting;
mod floor;
mod four_bar;
mod slider_crank;
mod stewart;

pub use beside::{Measured, beside};
pub use counting::{Counted, Number, Operations, operations};
pub use floor::{FLOPS, Floor, START, STEP};
pub use four_bar::FourBar;
pub use slider_crank::SliderCrank;
pub use stewart::Stewart;

/// Where this crate's manifest was when it was compiled: the command line packs its sources.
#[doc(hidden)]
pub const MANIFEST_FOLDER: &str = env!("CARGO_MANIFEST_DIR");
