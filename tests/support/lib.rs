//! What the integration tests share: the shipped models with their generated mechanisms, seeded random states, runs.

mod matrix;
mod random;
mod runs;
mod shipped;

pub use matrix::{Matrix, difference, phi_pi, phi_q};
pub use random::{Random, state, state_of};
pub use runs::{PAPER, Run, angle, simulate, start_of};
pub use shipped::{Check, Engine, for_each_generated, model, page, pages, with_generated};
