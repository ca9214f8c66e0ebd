//! The generator's own text with faults in it, of which one at a time is switched on: see `faults.rs`. All but the list
//! of stale places needs the feature `faults`.
#![allow(warnings, clippy::all, reason = "a copy with faults is not written to be read")]

use std::cell::Cell;

thread_local! {
    static FAULT: Cell<usize> = const { Cell::new(0) };
}

/// Switches a fault on, on this thread: the place in the list, from one; zero for none.
pub fn switch_on(fault: usize) {
    FAULT.set(fault);
}

fn fault() -> usize {
    FAULT.get()
}

/// Faults whose place in the generator's text was not found exactly once.
pub const STALE: &[&str] = include!(concat!(env!("OUT_DIR"), "/stale.rs"));

#[cfg(feature = "faults")]
include!(concat!(env!("OUT_DIR"), "/codegen/lib.rs"));
