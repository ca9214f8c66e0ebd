//! The JSON schema of model files, for editors that complete and check them while they are written.
//!
//! It knows keys, types, words and what must be there; what depends on several keys is the reader's to say (`gyro
//! check`). Its test makes it from the table of keys in
//! `gyro-model`, and holds it against good and bad model files.
#![deny(missing_docs)]

/// The schema, as JSON.
pub const SCHEMA: &str = include_str!("../model.schema.json");
