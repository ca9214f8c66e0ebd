//! The coordinate partition, in one of two ways.

use super::mechanism::n_state;
use super::pieces::lines;
use crate::joints::JointLayout;
use gyro_model::Model;

/// How the coordinate partition is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// One special Euler parameter for each joint.
    Charts,
    /// Through the coordinates of a tree of joints.
    Joints,
}

pub(super) fn partition(model: &Model, name: &str, choice: Choice, joints: Option<&JointLayout>) -> String {
    // Where no loop is closed there are no singular poses.
    let has_poses = joints.is_none_or(|joints| !joints.closure_rows.is_empty());
    match choice {
        Choice::Charts => by_charts(model, name),
        Choice::Joints => by_joints(name, has_poses),
    }
}

const SOLVED: &str = "::core::result::Result<(), gyro_sim::Error>";

fn by_charts(model: &Model, name: &str) -> String {
    let state = n_state(model);
    let solves = ["newton_step", "solve_velocities"];
    let unrolled = lines(solves.map(|solve| {
        format!(
            "fn {solve}_on(
                &self, ANY_t: T, ANY_charts: &[[T; 4]; INT_charts], ANY_y: &mut [T; {state}]
            ) {{ HOLE_{solve} }}"
        )
    }));
    let chosen = lines(solves.map(|solve| {
        format!(
            "fn {solve}(&self, t: T, choice: &Self::Independent, y: &mut Self::State) -> {SOLVED} {{
                self.{solve}_on(t, &gyro_sim::charts::one_hot(choice), y);
                Ok(())
            }}"
        )
    }));
    format!(
        "impl<T: gyro_sim::Scalar> {name}<T> {{
            fn chart_vectors(&self, ANY_y: &[T; {state}]) -> [[T; 4]; INT_charts] {{ HOLE_chart_vectors }}
            {unrolled}
        }}
        impl<T: gyro_sim::Lanes> gyro_sim::Partition for {name}<T> {{
            type Independent = gyro_sim::charts::Charts<T, INT_charts>;
            fn independent(&self, _t: T, y: &Self::State) -> Self::Independent {{
                gyro_sim::charts::best(&self.chart_vectors(y))
            }}
            fn follow(&self, _t: T, y: &Self::State, choice: &mut Self::Independent) -> u32 {{
                gyro_sim::charts::follow(&self.chart_vectors(y), choice)
            }}
            {chosen}
        }}"
    )
}

fn by_joints(name: &str, has_poses: bool) -> String {
    let clearance = if has_poses {
        "fn clearance(&self, t: T, y: &Self::State) -> ::core::option::Option<gyro_sim::Clearance<T>> {
            gyro_sim::joint_partition::clearance(self, t, y)
        }"
    } else {
        ""
    };
    format!(
        "impl<T: gyro_sim::Real> gyro_sim::Partition for {name}<T> {{
            type Independent = ();
            fn independent(&self, _t: T, _y: &Self::State) -> Self::Independent {{}}
            fn follow(&self, _t: T, _y: &Self::State, _choice: &mut Self::Independent) -> u32 {{
                0
            }}
            fn is_met(&self, t: T, y: &Self::State, phi: &Self::Constraints) -> bool {{
                gyro_sim::pivoting::is_met(self, t, y, phi)
            }}
            fn newton_step(&self, t: T, _choice: &Self::Independent, y: &mut Self::State) -> {SOLVED} {{
                gyro_sim::joint_partition::newton_step(self, t, y)
            }}
            fn solve_velocities(&self, t: T, _choice: &Self::Independent, y: &mut Self::State) -> {SOLVED} {{
                gyro_sim::joint_partition::solve_velocities(self, t, y);
                Ok(())
            }}
            {clearance}
        }}"
    )
}
