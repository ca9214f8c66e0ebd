//! The textbook over `f64`: derivatives against differences, dynamics against energy, and against the model's own
//! kinematics.

mod dynamics;
mod functions;
mod kinematics;
mod support;
