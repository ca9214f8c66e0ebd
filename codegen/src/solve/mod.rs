//! The equations of motion, the coordinate partition and the multipliers, solved.

pub mod articulated_body;
pub mod axis_bias;
pub mod cancellation;
pub mod forward_dynamics;
pub mod gram_schmidt;
pub mod ldl;
pub mod loop_closure;
pub mod motion_subspace;
pub mod multipliers;
pub mod partition;
pub mod reduced_mass_matrix;
pub mod saddle;
