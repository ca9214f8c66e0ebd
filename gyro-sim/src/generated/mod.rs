//! Mechanisms written by `cargo xtask generate` from the pages in `models/`. This door is written by hand.
#![allow(
    clippy::all,
    clippy::pedantic,
    reason = "generated code is checked for what it computes, not for its style"
)]
#![allow(missing_docs, reason = "the contract is documented at the traits that these modules implement")]

#[rustfmt::skip]
pub mod compound_pendulum;
#[rustfmt::skip]
pub mod free_body;
#[rustfmt::skip]
pub mod gyroscope_combined_offsets;
#[rustfmt::skip]
pub mod gyroscope_free_nutation;
#[rustfmt::skip]
pub mod gyroscope_maximal;
#[rustfmt::skip]
pub mod gyroscope_misalignments;
#[rustfmt::skip]
pub mod gyroscope_parameters;
#[rustfmt::skip]
pub mod gyroscope_radial_imbalance;
#[rustfmt::skip]
pub mod gyroscope_viscous;
#[rustfmt::skip]
pub mod gyroscope;
#[rustfmt::skip]
pub mod heavy_top;
#[rustfmt::skip]
pub mod driven_gyroscope;
#[rustfmt::skip]
pub mod four_bar;
#[rustfmt::skip]
pub mod four_bar_revolute;
#[rustfmt::skip]
pub mod pitching_gyroscope;
#[rustfmt::skip]
pub mod spinning_top;
#[rustfmt::skip]
pub mod torsion;
#[rustfmt::skip]
pub mod gyroscope_at_rest;
#[rustfmt::skip]
pub mod gyroscope_coulomb;
#[rustfmt::skip]
pub mod gyroscope_fast;
#[rustfmt::skip]
pub mod gyroscope_gimbal_lock;
#[rustfmt::skip]
pub mod gyroscope_heavy_rotor;
#[rustfmt::skip]
pub mod gyroscope_light_rings;
#[rustfmt::skip]
pub mod gyroscope_long;
#[rustfmt::skip]
pub mod gyroscope_overdamped;
#[rustfmt::skip]
pub mod gyroscope_rolling_base;
#[rustfmt::skip]
pub mod gyroscope_stiff;
#[rustfmt::skip]
pub mod four_bar_in_line;
