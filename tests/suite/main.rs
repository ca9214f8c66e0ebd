//! The integration tests that need nothing of their own: one program, so that what they share is compiled once.

mod all_joints;
mod closed_forms;
mod convergence;
mod finite_differences;
mod forces;
mod four_bar;
mod generated_files;
mod joint_kinds;
mod joint_readings;
mod long_run;
mod moving_base;
mod paper_scenes;
mod reactions;
mod recursive_twin;
mod robustness;
mod scalars;
mod terms;
