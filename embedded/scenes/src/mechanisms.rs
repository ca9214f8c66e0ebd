//! Mechanisms that `cargo xtask embedded` generates before it builds this: the compiler for the chip may be too old for
//! the generator. They are not kept in the repository.
#![allow(clippy::all, unused_qualifications, reason = "generated code is checked for what it computes")]

include!("../generated/balancer.rs");
include!("../generated/chain.rs");
include!("../generated/gimbal.rs");
include!("../generated/gyroscope_combined_offsets.rs");
include!("../generated/long_chain.rs");
include!("../generated/quadruped.rs");
include!("../generated/stabilised_gimbal.rs");
