//! Mechanisms written by `cargo xtask generate` from the pages in `tests/models/`. This door is written by hand.
#![allow(
    clippy::all,
    clippy::pedantic,
    reason = "generated code is checked for what it computes, not for its style"
)]
#![allow(missing_docs, reason = "the contract is documented at the traits that these modules implement")]

#[rustfmt::skip]
pub mod all_joints;
#[rustfmt::skip]
pub mod cam;
#[rustfmt::skip]
pub mod carried;
#[rustfmt::skip]
pub mod carried_block;
#[rustfmt::skip]
pub mod cylindrical;
#[rustfmt::skip]
pub mod differential;
#[rustfmt::skip]
pub mod driven_four_bar;
#[rustfmt::skip]
pub mod driven_shaft;
#[rustfmt::skip]
pub mod friction;
#[rustfmt::skip]
pub mod gear;
#[rustfmt::skip]
pub mod gear_pair;
#[rustfmt::skip]
pub mod gyroscope_bearings;
#[rustfmt::skip]
pub mod loads;
#[rustfmt::skip]
pub mod motor;
#[rustfmt::skip]
pub mod parallelogram;
#[rustfmt::skip]
pub mod peaucellier;
#[rustfmt::skip]
pub mod pendulum;
#[rustfmt::skip]
pub mod pitching_bearings;
#[rustfmt::skip]
pub mod planar;
#[rustfmt::skip]
pub mod planetary;
#[rustfmt::skip]
pub mod point_on_line;
#[rustfmt::skip]
pub mod prismatic;
#[rustfmt::skip]
pub mod rack_and_screw;
#[rustfmt::skip]
pub mod rod;
#[rustfmt::skip]
pub mod screw;
#[rustfmt::skip]
pub mod spherical;
#[rustfmt::skip]
pub mod stops;
#[rustfmt::skip]
pub mod tether;
#[rustfmt::skip]
pub mod two_four_bars;
#[rustfmt::skip]
pub mod universal;
#[rustfmt::skip]
pub mod weld;
