//! What the code of a mechanism is, as plain data: the functions of a generated module with their signatures, meanings
//! and claims. The generator fills these functions, printers write them in one language or another, and the verifier
//! knows from here what each is called, what it takes and how much it gives.
//!
//! A function is a row of the table in `kernels.rs`; the arrays that functions read and write, and how long they are,
//! are in `spaces.rs`; the traits of the run time's contract, which modules have or leave out, in `groups.rs`. The
//! elementary functions that they call are the table of `elementary.rs`.
#![deny(missing_docs)]

pub mod elementary;
mod groups;
mod kernels;
mod spaces;

pub use groups::Group;
pub use kernels::{Claim, Given, Kernel, Outcome, Signature, State};
pub use spaces::{Buffer, Counts, Space};
