//! What the derived encoding of the types that a run hands out needs in scope.

extern crate alloc;

pub(crate) use alloc::vec::Vec;
pub(crate) use nanoserde::{DeBin, SerBin};
