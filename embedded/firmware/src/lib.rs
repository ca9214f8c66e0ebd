//! The scenes on a Cortex-M under QEMU.
//!
//! `control` is firmware as a user would write it. `runs` prints the bits that are compared with the host's,
//! `figures` counts instructions, `stabilised` does both for stops and friction, `quadruped` and `balancer` for
//! robots. All of it links only if no panic can be reached: see [`panic`](mod@panic).
#![no_std]

pub mod board;
pub mod control;
pub mod device;
pub mod figures;
pub mod panic;
pub mod print;
pub mod runs;
