//! Generated multibody dynamics at run time: `no_std`, no allocation, no `unsafe`, no panic on numerical input.
//!
//! # The contract on one page
//! A *solver* combines equations, a method and a correction, and is handed the model at each call. Who only integrates
//! meets three names: [`Ode`], the equations; [`Solver`]; and a method such as [`Tsit5`].
//!
//! | trait | what it is | implemented by |
//! |---|---|---|
//! | [`Scalar`] | a number of a kernel | `f32`, `f64`, [`Dual`], packs of SIMD lanes |
//! | [`Real`], [`Lanes`] | a number, or pack, on which a solver decides | `f32`, `f64`; packs (feature `lanes`) |
//! | [`Ode`] | equations `ẏ = f(t, y)` of a model | [`Exact`], [`Corrected`], [`Joint`], [`Baumgarte`], [`ByDuals`] |
//! | [`Method`](integrate::Method) | a step | [`Kutta4`], [`Tsit5`], [`Dop853`], [`Rodas4`] |
//! | [`Correction`] | a way back onto the constraints | see [`correct`] |
//! | [`Jacobian`] | the derivatives of such equations, for implicit methods | [`Joint`], [`ByDuals`] |
//! | [`Mechanism`] | description, Φ, energy, inputs, outputs | generated and runtime-assembled mechanisms |
//! | [`Kinematics`] | Φ_q, (Φ_r, Φ_π'), ν, γ | the same |
//! | [`Dynamics`], [`CorrectedDynamics`] | accelerations at any state, at corrected states | the same |
//! | [`Partition`], [`Projection`] | independent and dependent coordinates; the least change of a state | the same |
//! | [`JointSpace`], [`JointJacobian`], [`ParameterJacobian`] | joint coordinates; their derivatives | generated mechanisms that have them |
//! | [`CorrectedSolution`] | multipliers and rates' rates at corrected states | the same |
//! | [`InverseDynamics`], [`MassMatrix`] | τ of given u̇, bias and gravity forces; M and its factor | the same, without loops |
//! | [`DynamicsDerivatives`], [`Regressor`] | derivatives of forces and accelerations; forces by inertial parameters | the same |
//! | [`JointOutputs`], [`OutputDerivatives`], [`Frames`] | what is observed of a joint state | the same, with loops |
//!
//! Of the traits below [`Mechanism`] a generated module has those that were asked for (`[generate] functions`).
//!
//! * **Description.** [`Mechanism::description`] returns names, rows and sizes as one constant ([`Description`]).
//! * **Buffers.** Nothing is allocated: results are written to buffers of the caller's, whose sizes are part of their
//!   types. [`Mechanism::buffers`], [`Kinematics::terms`], [`JointSpace::joint_buffers`] and others return them,
//!   zeroed.
//! * **Equations.** The equations are a value without content, and the mechanism stays the caller's: its inputs and
//!   parameters may change between two calls. [`Exact`] holds at any state, [`Corrected`] takes fewer operations near
//!   the constraints, [`Joint`] integrates joint coordinates, which satisfy all of them by construction but those of
//!   loops.
//! * **Corrections** admit some equations and not others: a `Correction<D, M>` is one for the equations `D` of a model
//!   `M`. [`MassWeighted`] needs [`Exact`] ones; with others the program does not compile.
//! * **What a program does not use costs nothing:** a mechanism is straight-line code for each function, and a solver
//!   holds the buffers of its own method and correction alone.
//!
//! ```
//! use gyro_mechanisms::gyroscope::Gyroscope;
//! use gyro_sim::{Corrected, Dop853, Mechanism, Partitioned, Partitioning, Solver};
//!
//! let gyroscope = Gyroscope::<f64>::default();
//! assert_eq!(gyroscope.description().bodies, ["outer_ring", "inner_ring", "rotor"]);
//! let start = gyroscope.start();
//!
//! // One second under error control, corrected by coordinate partitioning.
//! let correction = Partitioning::new(&gyroscope, 0.0, &start);
//! let mut solver = Solver::with_correction(Corrected, Dop853::new(&start), correction, 0.0, &start);
//! solver.advance_to(&gyroscope, 1.0)?;
//! assert!((gyroscope.energy(1.0, solver.state()).total() - 0.05).abs() < 1e-9);
//!
//! // The paper's algorithm at the paper's settings, in four buffers: RK4, corrected after every five steps.
//! let mut state = start;
//! let mut solver = Partitioned::new(&gyroscope, &state);
//! for interval in 0..2000 {
//!     let t = f64::from(interval) * 5e-4;
//!     solver.advance(&gyroscope, t, 1e-4, 5, &mut state)?;
//! }
//! assert!((gyroscope.energy(1.0, &state).total() - 0.05).abs() < 1e-12);
//! # Ok::<(), gyro_sim::Error>(())
//! ```
//!
//! Mechanisms are modules that `gyro-codegen` writes from a model file (this crate ships some in `generated`), or
//! anything else that keeps this contract. The two algorithms of Gruzman and Sarzeto's section 5, *direct integration*
//! and *coordinate partitioning*, are [`Direct`] and [`Partitioned`].
//!
//! # Conventions
//! Stated once, here, and followed everywhere:
//! * SI units; angles in radians.
//! * A body's frame has its origin at the mass centre. `r` is its position in the global frame, `p = (e0, e1, e2, e3)`
//!   its Euler parameters, scalar first, `A(p)` (eq. (3)) maps body components to global ones.
//! * Velocities are `s = ṙ` in the global frame and the angular velocity `w'` in the *body* frame; `ṗ = ½ G(p)ᵀ w'`
//!   (eq. (14)).
//! * The state is one flat buffer: seven positions `(r, p)` for each body, then six velocities `(s, w')` for each body;
//!   then, in mechanisms with non-conservative forces or drivers only, the work that these have done (model files leave
//!   it out by `count_work = false`); then the states that the model file has of its own (`[[state]]`); then one *turn
//!   reference* for each joint angle on whose continuous value something acts (a spring, a stop, a coupler, a driver).
//!   Solvers integrate what follows the velocities with the rest; corrections leave work and states alone and set turn
//!   references to their angles.
//! * Only bodies that move freely have coordinates: those held fixed or moved by prescription are folded into the
//!   formulas, the latter as functions of time.
//! * The constraint rows (*joint rows* for short) are those of constrained bodies, joints, couplers and drivers, in the
//!   order of the model file, redundant ones left out; and then one normalisation `pᵀp − 1` (eq. (12)) for each body.
//!   Functions that speak of velocities or accelerations have the joint rows only.
//! * A turn reference ρ has the rate of its angle; the continuous angle with raw sine S and cosine C is `ρ + atan2(S
//!   cos ρ − C sin ρ, C cos ρ + S sin ρ)`, as long as ρ has not strayed from it by half a turn. Where nothing is
//!   corrected ([`Direct`], [`Uncorrected`]) it strays by what steps lose of an angle, and [`refer_turns`] sets it to
//!   its angle.
//! * `Φ_r s + Φ_π' w' = ν` with `ν = −Φ_t`, and `Φ_r s̈ + Φ_π' ẇ' = γ`. The multipliers λ are those of eq. (17), where
//!   `Φ_qᵀ λ` stands on the left: the reaction on a body is `−Φ_qᵀ λ`.
//! * `p` is a unit vector wherever `w'` or `π'` is used.
#![no_std]
#![forbid(unsafe_code)]
#![deny(missing_docs)]

// Generated modules name this crate from outside and from within alike.
extern crate self as gyro_sim;

pub mod admissible;
mod apart;
pub mod charts;
pub mod contact;
mod contract;
pub mod correct;
mod dual;
mod euler_parameters;
pub mod events;
mod floats;
pub mod fused;
#[cfg(feature = "generated")]
pub mod generated;
pub mod integrate;
pub mod joint_partition;
#[cfg(feature = "lanes")]
pub mod lanes;
pub mod pivoting;
pub mod sampled;
mod scalar;
mod sine;
mod solver;
pub mod spline;
mod turns;
mod violation;
#[cfg(feature = "wire")]
mod wire;

pub use apart::apart;
pub use contract::{
    Buffers, Clearance, Coordinate, Corrected, CorrectedDynamics, CorrectedSolution, Description, Dynamics,
    DynamicsDerivatives, Energy, Error, Exact, FrameBuffers, Frames, InverseDynamics, Jacobian,
    JacobianBuffers, Joint, JointBuffers, JointInfo, JointJacobian, JointLayout, JointOutputs, JointPlace,
    JointSpace, Kinematics, MassMatrix, Mechanism, Ode, OutputDerivatives, OutputInfo, OutputSlopes, Owner,
    ParameterJacobian, Partition, Projection, Regressor, RowInfo, System, Terms, set_turn_references,
};
pub use correct::{
    Baumgarte, CloseLoops, ClosedForm, Correction, Direct, MassWeighted, Partitioned, Partitioning,
    Uncorrected, Watched, When,
};
pub use dual::{ByDuals, Dual};
pub use integrate::{Dop853, Kutta4, Rk4, Rodas4, Tsit5};
pub use scalar::{Elementary, Lanes, Real, Scalar};
pub use solver::{Control, Passage, Solver, Statistics, Tried};
pub use turns::{JointCoordinate, Turns, keep_turns, refer_turns};
pub use violation::{Violation, violation};

/// Where this crate's manifest was when it was compiled: the command line packs its sources.
#[doc(hidden)]
pub const MANIFEST_FOLDER: &str = env!("CARGO_MANIFEST_DIR");
