//! Trees in joint coordinates: the state-space form, and the short way to the maximal accelerations of a state that
//! satisfies the constraints.
//!
//! `layout` orders the coordinates, `carriage` says how a body moves on its carrier, `dynamics` solves for the rates' rates, `maps` leads to
//! maximal coordinates and back. Where a recursion and a factored mass matrix in polynomial normal form both exist, the one with
//! fewer operations is taken.

mod candidates;
mod dynamics;
mod jacobian;
mod layout;
mod link_kinematics;
mod maps;
mod multipliers;

pub use candidates::JointSpace;
