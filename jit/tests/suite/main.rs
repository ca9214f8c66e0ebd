//! Compiled kernels against interpreted ones, bit for bit.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod compiled;
mod contacts;
mod functions;
mod kernels;
mod lengths;
mod on_heap;
mod pair;
mod partition;
mod proof;
mod rounding;
mod trains;
