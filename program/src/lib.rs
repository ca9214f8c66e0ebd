//! What a mechanism's code is, as plain data: what the generator fills, printers print and the verifier shares.
#![deny(missing_docs)]

pub mod elementary;
