//! The integration tests: one program, so that what they share is compiled once, and builds of other packages run
//! beside the rest.

mod all_joints;
mod allocation;
mod branches;
mod build_script;
mod carried_loops;
mod closed_forms;
mod convergence;
mod estimate;
mod extreme;
mod finite_differences;
mod forces;
mod four_bar;
mod gear_trains;
mod generated_files;
mod integrators;
mod joint_jacobian;
mod joint_kinds;
mod joint_readings;
mod joint_space;
mod lanes;
mod long_run;
mod moving_base;
mod no_std_probe;
mod paper_scenes;
mod poses;
mod reactions;
mod recursive_twin;
mod references;
mod robustness;
mod scalars;
mod solved;
mod sweep;
mod terms;
mod turns;
mod verdict;
