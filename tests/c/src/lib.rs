//! The mechanisms whose C is compared with their Rust.
#![allow(
    clippy::all,
    missing_docs,
    missing_debug_implementations,
    unused_qualifications,
    reason = "generated modules"
)]

include!(concat!(env!("OUT_DIR"), "/modules.rs"));
