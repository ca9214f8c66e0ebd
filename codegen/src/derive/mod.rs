//! From the model to Φ and its derivatives, masses, forces and outputs: the textbook, symbol by symbol.

pub mod constraints;
pub mod dynamics;
pub mod forces;
pub mod frames;
pub mod joint_coordinate;
pub mod kinematics;
pub mod outputs;
pub mod prescribed_motion;
pub mod readings;
pub mod system;
