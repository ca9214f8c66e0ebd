//! Generated multibody dynamics at run time: `no_std`, no allocation, no `unsafe`, no panic on numerical input.
//!
//! A mechanism is a type that implements [`Mechanism`]: either a module that `gyro-codegen` wrote from a page of bodies
//! and joints (this crate has the paper's scene in [`generated`]) or anything else that keeps the same contract. The two
//! algorithms of Gruzman and Sarzeto's section 5 run on it: *direct integration* and *coordinate partitioning*
//! ([`Partitioned`]).
//!
//! # Conventions
//! Stated once, here, and followed everywhere:
//! * SI units; angles in radians.
//! * A body's frame has its origin at the mass centre. `r` is its position in the global frame, `p = (e0, e1, e2, e3)`
//!   its Euler parameters, scalar first, `A(p)` (eq. (3)) maps body components to global ones.
//! * Velocities are `s = ṙ` in the global frame and the angular velocity `w'` in the *body* frame; `ṗ = ½ G(p)ᵀ w'`
//!   (eq. (14)).
//! * The state is one flat buffer: seven positions `(r, p)` for each body, then six velocities `(s, w')` for each body;
//!   then, in mechanisms with non-conservative forces or drivers only, the work that these have done (pages leave it out by
//!   `count_work = false`); then one *turn reference* for each joint angle on whose continuous value something acts (a spring, a stop, a coupler, a driver). Solvers
//!   integrate what follows the velocities with the rest; corrections leave the work alone and set turn references to their angles.
//! * Only bodies that move freely have coordinates: those held fixed or moved by prescription are folded into the formulas, the
//!   latter as functions of time.
//! * The constraint rows (*joint rows* for short) are those of constrained bodies, joints, couplers and drivers, in the order of
//!   the model page, redundant ones left out; and then one normalisation `pᵀp − 1` (eq. (12)) for each body. Functions that
//!   speak of velocities or accelerations have the joint rows only.
//! * A turn reference ρ has the rate of its angle; the continuous angle with raw sine S and cosine C is
//!   `ρ + atan2(S cos ρ − C sin ρ, C cos ρ + S sin ρ)`, as long as ρ has not strayed from it by half a turn. Where nothing is corrected
//!   ([`Direct`], [`Uncorrected`]) it strays by what steps lose of an angle, and [`refer_turns`] sets it to its angle.
//! * `Φ_r s + Φ_π' w' = ν` with `ν = −Φ_t`, and `Φ_r s̈ + Φ_π' ẇ' = γ`. The multipliers λ are those of eq. (17), where
//!   `Φ_qᵀ λ` stands on the left: the reaction on a body is `−Φ_qᵀ λ`.
//! * `p` is a unit vector wherever `w'` or `π'` is used.
//!
//! # Example
//! The paper's gyroscope, one second at the paper's settings:
//! ```
//! # #[cfg(feature = "generated")]
//! # fn main() -> Result<(), gyro_sim::Error> {
//! use gyro_sim::{Mechanism, Ode, Partitioned, generated::gyroscope::Gyroscope};
//!
//! let gyroscope = Gyroscope::<f64>::default();
//! let mut state = gyroscope.start();
//! let mut solver = Partitioned::new(&gyroscope, &state);
//! for interval in 0..2000 {
//!     let t = f64::from(interval) * 5e-4;
//!     solver.advance(&gyroscope, t, 1e-4, 5, &mut state)?;
//! }
//! assert!((gyroscope.energy(1.0, &state).total() - 0.05).abs() < 1e-12);
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "generated"))]
//! # fn main() {}
//! ```
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

// Generated modules name this crate from outside and from within alike.
extern crate self as gyro_sim;

pub mod admissible;
mod apart;
pub mod charts;
pub mod correct;
mod dual;
mod error;
pub mod fused;
#[cfg(feature = "generated")]
pub mod generated;
pub mod integrate;
#[cfg(feature = "lanes")]
pub mod lanes;
mod mechanism;
pub mod pivoting;
mod rounding;
mod scalar;
mod solver;
pub mod spline;
mod turns;
mod violation;

pub use apart::apart;
pub use correct::{
    Baumgarte, ClosedForm, Corrected, Correction, Direct, MassWeighted, Maximal, Partitioned, Partitioning,
    Uncorrected, Watched, When,
};
pub use dual::{ByDuals, Dual};
pub use error::Error;
pub use integrate::{Dop853, Kutta4, Rk4, Rodas4, Tsit5};
pub use mechanism::{
    Charted, Clearance, Coordinate, Differentiable, Energy, Equations, JointForm, JointInfo, JointJacobian,
    JointSpace, Mechanism, Ode, OutputInfo, Owner, Partition, Ports, Projection, RowInfo, Storage,
    set_turn_references,
};
pub use scalar::{Real, Scalar};
pub use solver::{Control, Passage, Solver, Statistics};
pub use turns::{JointCoordinate, Turns, refer_turns};
pub use violation::{Violation, violation};
