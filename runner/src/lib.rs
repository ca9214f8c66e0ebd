//! Runs a mechanism to a schedule and streams samples: the loop that both engines share.
//!
//! [`run`] takes any [`gyro_sim::Partition`] from its start to the end of the run and hands out a [`Sample`] at each
//! sample time. The command line calls it in its own process for the runtime-assembled twin; for generated code it
//! compiles a small program around [`child::main`] and speaks with it in the words of [`protocol`]. [`time_by`] makes the same run for its time.
//!
//! ```text
//! settings ─schedule─▶ segments ─run─▶ samples ─summary─▶ worst violations, energy drift
//! ```
#![deny(missing_docs)]

mod approach;
pub mod child;
mod companion;
mod failure;
mod input;
pub mod motion;
mod pivots;
pub mod protocol;
mod run;
mod sample;
mod schedule;
mod summary;
mod timing;

pub use approach::{Approach, Coordinates, Correction, Integrator, When};
pub use companion::{companions, differences};
pub use failure::{Failure, describe, describe_in};
pub use input::Input;
pub use run::{Event, Start, run, run_by};
pub use sample::{BodySample, JointSample, Sample};
pub use schedule::{Impossible, Schedule, Segment, Settings};
pub use summary::{Summary, Tracker, energy_error};
pub use timing::{Timing, time_by};

#[cfg(test)]
mod spinner;
