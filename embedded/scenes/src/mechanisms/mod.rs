//! Mechanisms written by `cargo xtask generate` from the pages beside them. This door is written by hand.
#![allow(clippy::all, unused_qualifications, reason = "generated code is checked for what it computes")]

#[rustfmt::skip]
pub mod chain;
#[rustfmt::skip]
pub mod gimbal;
