//! Proofs of right modules, refutations of wrong ones. One program: each of its parts would compile the prover anew.

#[path = "../support/mod.rs"]
mod support;

mod combinations;
mod compiled;
mod dependencies;
mod faults;
mod holes;
mod layouts;
mod loops;
mod mutants;
mod near_numbers;
mod needless;
mod proofs;
mod results;
mod rounding;
mod substituted;
mod verdicts;
