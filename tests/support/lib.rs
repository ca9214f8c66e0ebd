//! What the integration tests share: the model files with their mechanisms, seeded random states, runs, nested builds.

mod against;
mod engine;
mod fixtures;
pub mod generated;
mod matrix;
mod nested;
mod random;
mod runs;

pub use generated as own;
pub use gyro_mechanisms as shipped;

pub use against::{along, body, check, check_pairs, cross, pair, reference_body, rotation, times, worst};
pub use engine::{Choice, Duals, Engine};
pub use fixtures::{
    EXTREME, FixtureFolder, careful, compiled, dense, duals, fixture_folders, for_each_generated, generated,
    generated_in, generated_with_joints, in_single_precision, interpreted, is_open, model, module, page,
    pages,
};
pub use matrix::{Matrix, difference, phi_pi, phi_q};
pub use nested::{Said, cargo, say};
pub use random::{Random, posed, state, state_at, violated_start};
pub use runs::{
    PAPER, Run, as_paged, coordinate, fed, judged, moved, multipliers, output, played, simulate, start_of,
};
