//! The integration tests that need nothing of their own: one program, so that what they share is compiled once.

mod closed_forms;
mod convergence;
mod finite_differences;
mod generated_files;
mod joint_readings;
mod long_run;
mod paper_scenes;
mod robustness;
mod scalars;
mod terms;
