//! The equations of motion, the coordinate partition and the multipliers, solved.

pub mod aggregate_joints;
pub mod articulated_body;
pub mod axis_bias;
pub mod cancellation;
pub mod component;
pub mod dependence;
pub mod forward_dynamics;
pub mod gram_schmidt;
pub mod ldl;
pub mod loop_closure;
pub mod motion_subspace;
pub mod multipliers;
pub mod partition;
pub mod reduced_mass_matrix;
pub mod saddle;

use crate::Elimination;
use crate::derive::Textbook;
use crate::derive::system::System;
use crate::expr::graph::ExprId;
use forward_dynamics::ForwardDynamics;

/// The solution of eq. (17), in symbols that are yet to be expanded.
#[derive(Debug)]
pub struct Solution {
    /// (s̈, ẇ') of each moving body, then the multipliers of the rows that close loops or couple joints, those that no
    /// joint of the tree owns. Empty where nobody asks for it.
    pub solved: Vec<ExprId>,
    /// The multiplier of each row, in terms of known accelerations and loop multipliers.
    pub lambda: Vec<ExprId>,
}

impl Solution {
    pub fn of(
        system: &mut System,
        textbook: &Textbook,
        forward_dynamics: &ForwardDynamics,
        (elimination, is_solved): (Elimination, bool),
    ) -> Self {
        if elimination == Elimination::Saddle && system.loop_closure_rows().is_empty() {
            saddle::solve(system, textbook)
        } else {
            forward_dynamics.solve(system, textbook, is_solved)
        }
    }
}
