//! Modules that are kept in the repository to be read, written by `cargo xtask generate`. This door is written by hand.

#[cfg(feature = "driven-gyroscope")]
#[rustfmt::skip]
pub mod driven_gyroscope;
#[cfg(feature = "four-bar")]
#[rustfmt::skip]
pub mod four_bar;
#[cfg(feature = "gyroscope-maximal")]
#[rustfmt::skip]
pub mod gyroscope_maximal;
#[cfg(feature = "gyroscope-parameters")]
#[rustfmt::skip]
pub mod gyroscope_parameters;
#[cfg(feature = "heavy-top")]
#[rustfmt::skip]
pub mod heavy_top;
