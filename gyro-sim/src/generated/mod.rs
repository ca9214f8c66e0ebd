//! The paper's scene, written by `cargo xtask generate` from `models/gyroscope.toml`. This door is written by hand. The
//! other models' mechanisms are in the package `gyro-mechanisms`.
#![allow(
    clippy::all,
    clippy::pedantic,
    reason = "generated code is checked for what it computes, not for its style"
)]
#![allow(missing_docs, reason = "the contract is documented at the traits that these modules implement")]

#[rustfmt::skip]
pub mod gyroscope;
