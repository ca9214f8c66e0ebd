//! Mechanisms assembled at run time: textbook formulas typed by hand, `nalgebra` and a heap.
//!
//! It reads the same [`Model`](gyro_model::Model) as the code generator and keeps the same contract
//! ([`gyro_sim::Partition`], [`gyro_sim::Dynamics`]), but shares no derivation with it: Φ, Φ_q, ν and γ are typed from
//! the paper and from Haug (1989). So it is the reference of the tests, the comparison of the benchmarks and the quick
//! look of `simulate --engine assembled`, all at once. It comes in three forms:
//! * [`Dense`], the paper's: eq. (17) whole, one dense matrix solved by LU, and a partition by full pivoting of the
//!   dense Jacobian. It does every model.
//! * [`Careful`], what a careful engineer would make of it: no allocation, the ground folded, eq. (17) eliminated body
//!   by body from the leaves to the root in the null space of each joint, and a partition by charts from the root to
//!   the leaves. It does the models that [`Careful::supports`]; [`quick_look`] takes this form or the first, as
//!   suits a model.
//! * [`Recursive`], what an expert in rigid-body dynamics would make of it: articulated bodies in joint coordinates,
//!   and a partition in closed form, both linear in the number of bodies. It takes the constraints for granted, and
//!   does the models that [`Recursive::supports`]: trees of any joints.
//!
//! All share the formulas. A row is a linear combination of the textbook's primitives and of angles between joint
//! frames, less a function of time; a kind of joint is a short list of primitives:
//!
//! ```text
//! JointKind ─primitives─▶ coincident points, dot-1, dot-2, distance ┐
//! CoordinateKind ─measure─▶ dot-2, or atan2 of two dot-1 ───────────┴rows─▶ Φ, Φ_q, Φ_π', ν, γ
//! ForceKind ─law, path─▶ forces and torques ─energy─▶ energy, power
//! ```
//!
//! Each primitive has its value with two time derivatives (so Φ, the velocity residual and −γ, driven bodies moving as
//! they do) and its derivatives with respect to the positions of its two bodies.
//!
//! Conventions are those of `gyro-sim`, and of [`Partition::solve_velocities`](gyro_sim::Partition::solve_velocities)
//! this is meant by "independent": of the dense form components of ṙ and of `ṗ = ½ Gᵀ w'`, of the careful one what a
//! joint leaves free of w' (see [`Elimination`]).
//!
//! # Example
//! ```
//! use gyro_assembled::Careful;
//! use gyro_sim::{Mechanism, Partitioned};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/gyroscope.toml");
//! # let page = std::fs::read_to_string(path)?;
//! let model = gyro_model::read("gyroscope.toml", &page).expect("a model file without mistakes");
//! let mechanism = Careful::<f64>::new(&model)?;
//! let mut state = mechanism.start();
//! let mut solver = Partitioned::new(&mechanism, &state);
//! solver.advance(&mechanism, 0.0, 1e-4, 5, &mut state)?;
//! # Ok(())
//! # }
//! ```
#![deny(missing_docs)]

mod assembled;
mod careful;
pub mod child;
mod dense;
mod description;
mod equations;
mod error;
mod lapse;
mod model;
mod number;
mod projection;
mod quick_look;
mod recursive;

pub use assembled::{Assembled, Refusal, Solver};
pub use careful::Elimination;
pub use dense::Saddle;
pub use error::{BuildError, Unsupported};
pub use lapse::{Lapse, lapse};
pub use model::lowered::Lowered;
pub use number::Number;
pub use quick_look::{Precision, QuickLookError, quick_look};
pub use recursive::Recursion;

/// The paper's plain form. See [`Saddle`].
pub type Dense<T> = Assembled<T, Saddle>;

/// The careful form. See [`Elimination`].
pub type Careful<T> = Assembled<T, Elimination<T>>;

/// The recursive form. See [`Recursion`].
pub type Recursive<T> = Assembled<T, Recursion<T>>;
