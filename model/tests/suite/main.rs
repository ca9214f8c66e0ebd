//! Reading, checking and assembling. One program: each of its parts would be linked with all of it anew.

mod assembly;
mod bad_models;
mod branches;
mod carried;
mod closing;
mod closing_kinds;
mod cures;
mod elements;
mod format_page;
mod formulas;
mod fuzz;
mod guesses;
mod kinematics;
mod loads;
mod point_masses;
mod redundancy;
mod rounded;
mod rows;
mod shipped_models;
mod support;
mod tree;
