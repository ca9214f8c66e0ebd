//! Modules that are kept in the repository to be read, written by `cargo xtask generate`. This door is written by hand.

#[cfg(feature = "gyroscope-maximal")]
#[rustfmt::skip]
pub mod gyroscope_maximal;
#[cfg(feature = "heavy-top")]
#[rustfmt::skip]
pub mod heavy_top;
