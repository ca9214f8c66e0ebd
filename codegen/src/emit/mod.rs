//! From expressions to the text of a module.

pub mod data_sheet;
pub mod literals;
pub mod loops;
pub mod module;
pub mod names;
pub mod results;
pub mod tokens;
