//! The contract of `gyro-sim`, with vectors as buffers.

mod joint_space;
mod maximal;
mod partition;
mod plain;

pub use partition::Independent;
