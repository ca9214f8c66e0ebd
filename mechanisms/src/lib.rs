//! The mechanisms of `models/`, ready to run: a module for each model file, behind a feature of the file's name.
//!
//! `gyroscope-maximal` and `heavy-top` are kept in the repository (`mechanisms/src/golden`), the paper's scene is part
//! of `gyro-sim`, too; all others are generated while this crate is built. `mechanisms/sheets` has the data sheet of
//! each: what is left out of it, what every function costs, and what is proved.
#![no_std]
#![allow(
    clippy::all,
    clippy::pedantic,
    unused_qualifications,
    reason = "generated code is checked for what it computes, not for its style"
)]

mod golden;

#[allow(unused_imports, reason = "empty unless a feature asks for one of them")]
pub use golden::*;
#[cfg(feature = "gyroscope")]
#[rustfmt::skip]
#[path = "../../gyro-sim/src/generated/gyroscope.rs"]
pub mod gyroscope;

#[cfg(feature = "generator")]
include!(concat!(env!("OUT_DIR"), "/modules.rs"));
