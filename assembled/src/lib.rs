//! The runtime-assembled twin of any mechanism: textbook formulas typed by hand, `nalgebra` and a heap.
//!
//! The twin reads the same [`Model`](gyro_model::Model) as the code generator and keeps the same contract
//! ([`gyro_sim::Partition`], [`gyro_sim::Equations`]), but shares no derivation with it: Φ, Φ_q, ν and γ are typed from
//! the paper and from Haug (1989). So it is the oracle of the tests, the honest opponent of the benchmarks and the quick
//! look of `simulate --engine assembled`, all at once. It comes in two forms:
//! * [`Dense`], the paper's: eq. (17) whole, one dense matrix solved by LU, and a partition by full pivoting of the dense
//!   Jacobian.
//! * [`Careful`], what a careful engineer would make of it: no allocation, the ground folded, eq. (17) eliminated body by
//!   body from the leaves to the root in the null space of each joint, and a partition by charts from the root to the
//!   leaves.
//!
//! Conventions are those of `gyro-sim`. There are no drivers yet: ν = 0, and time enters nothing.
//!
//! # Example
//! ```
//! use gyro_assembled::Careful;
//! use gyro_sim::{Mechanism, Ode, Partitioned};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/gyroscope.toml");
//! # let page = std::fs::read_to_string(path)?;
//! let model = gyro_model::read("gyroscope.toml", &page).expect("a page without mistakes");
//! let mechanism = Careful::<f64>::new(&model)?;
//! let mut state = mechanism.start();
//! let mut solver = Partitioned::new(&mechanism, &state);
//! solver.advance(&mechanism, 0.0, 1e-4, 5, &mut state)?;
//! # Ok(())
//! # }
//! ```
#![deny(missing_docs)]

mod articulated;
mod assembled;
mod careful;
mod charts;
mod dense;
mod forces;
mod freedom;
mod lowered;
mod number;
mod partition;
mod quick_look;
mod reactions;
mod readings;
mod rows;
mod spatial;
mod textbook;

pub use assembled::{Assembled, Solver};
pub use careful::Elimination;
pub use dense::Saddle;
pub use lowered::Lowered;
pub use number::Number;
pub use quick_look::{Form, Precision, QuickLookError, quick_look};

/// The paper's plain form. See [`Saddle`].
pub type Dense<T> = Assembled<T, Saddle>;

/// The careful form. See [`Elimination`].
pub type Careful<T> = Assembled<T, Elimination<T>>;
