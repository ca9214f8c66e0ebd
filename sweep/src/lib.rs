//! Studies: thousands to millions of scenarios of one mechanism.
//!
//! A study says what varies ([`Plan`]), what is kept of each scenario ([`Keep`]) and how a scenario is run. Scenario k
//! is a function of the study and of k alone, whichever program, thread or machine runs it. What is kept comes in
//! blocks with a checksum ([`record`]); the program that computes them is made around a generated mechanism
//! ([`child`]).
//!
//! ```text
//! study file ─study─▶ Plan, Keep ─▶ Job ─child─▶ records ─▶ tables, quantiles, indices
//! ```
#![deny(missing_docs)]

pub mod child;
mod draw;
#[cfg(feature = "in-process")]
mod in_process;
mod indices;
mod keep;
mod normal;
mod plan;
mod quantiles;
pub mod record;
mod slopes;
mod sobol;
#[cfg(feature = "study")]
pub mod study;

pub use draw::{Distribution, Draw};
#[cfg(feature = "in-process")]
pub use in_process::InProcess;
pub use indices::{Indices, IndicesOf};
pub use keep::{Keep, Keeper, Passage, Quantity, sample_times};
pub use plan::{Axis, Plan, Sampling, Source, Target};
pub use quantiles::{QUANTILES, quantiles};

/// Where this crate's manifest was when it was compiled: the command line packs its sources.
#[doc(hidden)]
pub const MANIFEST_FOLDER: &str = env!("CARGO_MANIFEST_DIR");
