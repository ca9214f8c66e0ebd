//! Exported C: the bits of Rust, and calls that nobody should make.

mod bits;
mod compilers;
mod docs;
mod functions;
mod hostile;
mod languages;
mod program;
mod proof;
mod target;
mod unit;
