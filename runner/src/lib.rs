//! Runs a mechanism to a schedule and streams samples: the loop that both engines share.
//!
//! [`run`] takes any [`gyro_sim::Partition`] from its start to the end of the run and hands out a [`Sample`] at each
//! sample time. The command line calls it in its own process for the runtime-assembled model; for generated code it
//! compiles a small program around [`child::main`] and speaks with it in the words of [`protocol`]. [`time_by`] makes
//! the same run for its time.
//!
//! ```text
//! settings ─schedule─▶ segments ─run─▶ samples ─summary─▶ worst violations, energy drift
//! ```
#![deny(missing_docs)]

mod advice;
mod approach;
pub mod batch;
pub mod child;
mod companion;
mod control;
mod failure;
mod forecast;
mod formula;
mod grade;
mod input;
mod kink;
mod line;
pub mod motion;
mod offers;
mod pivots;
pub mod protocol;
mod remark;
mod run;
mod sample;
mod schedule;
mod spectrum;
mod summary;
mod timing;
mod touch;
mod watch;

pub use advice::{Advice, Change, Plan};
pub use approach::{Approach, Coordinates, Correction, Integrator, When};
pub use companion::{Difference, closely, companions, differences};
pub use control::{Controller, Wiring};
pub use failure::{Failure, describe, describe_in};
pub use forecast::{Forecast, duration_words};
pub use formula::{Formula, Operation, Seen};
pub use grade::{Grade, Judgement, Measure, Reason, balance, judge};
pub use input::{Between, Input, any_varies};
pub use kink::{Kink, Levels, Stay};
pub use line::{End, Line};
pub use offers::{Offers, listed};
pub use path::Path;
pub use remark::{Promise, Remark};
pub use run::{Event, Start, run, run_by, scheduled};
pub use sample::{BodySample, JointSample, Sample};
pub use schedule::{Impossible, Schedule, Segment, Settings};
pub use spectrum::fastest_rate;
pub use summary::{Summary, Tracker, energy_error};
pub use timing::{Timing, time_by};
pub use touch::{Stop, Surfaces, Touch};
pub use watch::{Occurrence, Watch, What};

/// Where this crate's manifest was when it was compiled: the command line packs its sources.
#[doc(hidden)]
pub const MANIFEST_FOLDER: &str = env!("CARGO_MANIFEST_DIR");

#[cfg(test)]
mod linkage;
#[cfg(test)]
mod loops;
mod path;
#[cfg(test)]
mod spinner;
