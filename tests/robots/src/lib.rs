//! The mechanisms of `models` with what is generated on request, by `build.rs`.
#![allow(
    clippy::all,
    clippy::pedantic,
    unused_qualifications,
    reason = "generated code is checked for what it computes, not for its style"
)]
#![allow(missing_docs, reason = "the contract is documented at the traits that these modules implement")]

include!(concat!(env!("OUT_DIR"), "/modules.rs"));
