//! The contract of `gyro-sim`, with vectors as buffers.

mod joint_space;
mod maximal;
mod observed;
mod partition;

pub use partition::{Independent, OnHeap};
