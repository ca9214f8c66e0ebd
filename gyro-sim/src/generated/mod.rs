//! Mechanisms written by `cargo xtask generate` from the pages in `models/`. This door is written by hand.
#![allow(
    clippy::all,
    clippy::pedantic,
    reason = "generated code is checked for what it computes, not for its style"
)]
#![allow(missing_docs, reason = "the contract is documented at the traits that these modules implement")]

pub mod compound_pendulum;
pub mod free_body;
pub mod gyroscope;
pub mod gyroscope_combined_offsets;
pub mod gyroscope_free_nutation;
pub mod gyroscope_maximal;
pub mod gyroscope_parameters;
pub mod gyroscope_radial_imbalance;
pub mod gyroscope_viscous;
pub mod heavy_top;
