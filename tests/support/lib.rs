//! What the integration tests share: the shipped models with their generated mechanisms, seeded random states, runs,
//! nested builds.

mod matrix;
mod nested;
mod random;
mod runs;
mod shipped;

pub use matrix::{Matrix, difference, phi_pi, phi_q};
pub use nested::{Said, cargo, say};
pub use random::{Random, posed, state, state_of, violated_start};
pub use runs::{PAPER, Run, angle, simulate, start_of};
pub use shipped::{Check, Engine, for_each_generated, model, page, pages, with_generated};
