//! The runtime-assembled model's formulas and solvers. One program: each of its parts would compile the whole
//! crate anew.

#[path = "../support/mod.rs"]
mod support;

mod allocation;
mod armature;
mod closed_forms;
mod energy;
mod equations_of_motion;
mod four_bar;
mod gyroscope;
mod jacobians;
mod outputs;
mod partition;
mod readings;
