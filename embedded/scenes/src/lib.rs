//! What the firmware runs, written so that the host can run it too: the same source, the same bits.
//!
//! [`Simulator`] is a gimbal under rate control as a user would write it, [`stabilised`] a camera with stops and
//! bearings that stick, [`quadruped`] a robot with four legs, [`balancer`] one on two wheels, [`runs`]
//! are the runs whose bits are compared, [`kernels`] what is measured.
#![no_std]
#![forbid(unsafe_code)]

pub mod balancer;
mod control;
mod digest;
pub mod kernels;
pub mod mechanisms;
mod minimal;
pub mod quadruped;
pub mod runs;
mod simulator;
pub mod stabilised;

pub use control::RateControl;
pub use minimal::Minimal;
pub use simulator::{Angles, Simulator, TICK, demand};
