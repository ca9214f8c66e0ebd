//! What is measured of the paper's scene, once for all who measure it: criterion, the interleaved table and the
//! counting of instructions.
//!
//! Every kernel does its work on the same state, in the middle of the paper's second and on the constraints, in the
//! same build. [`Scene::new`] checks all that is measured against the floor first: what is wrong is not fast.

mod data_sheet;
mod kernel;
mod kernels;
pub mod lanes;
mod round;
mod scene;

pub use gyro_yardstick::Floor;
pub use kernel::Kernel;
pub use kernels::{kernels, runs};
pub use round::{Clock, Figure, counted, interleaved};
pub use scene::Scene;
