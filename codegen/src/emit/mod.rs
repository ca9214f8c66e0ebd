//! From expressions to the text of a module.

pub mod data_sheet;
pub mod literals;
pub mod module;
pub mod tokens;
