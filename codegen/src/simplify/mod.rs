//! Passes that write expressions with fewer operations, whatever they compute.

pub mod cheapest;
pub mod normal_form;
pub mod parameter_setup;
pub mod reassociate;
pub mod scales;
