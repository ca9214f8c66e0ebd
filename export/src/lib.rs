//! Generated modules in C99: a header and one source, which has the whole solver.
//!
//! A module is read back as Rust, statement by statement, and each statement is written in C: what was proved of the
//! Rust text holds for the C text as far as the two agree, and `gyro_verifier` reads the C text back to see that they
//! do. The run time around the kernels is C of its own (the folder `c`), with the same operations in the same order as
//! `gyro-sim`, so that both compute the same bits.
#![deny(missing_docs)]

mod expressions;
mod functions;
mod module;
mod names;
mod runtime;
mod text;

use gyro_model::Model;
use quote::ToTokens;
use std::fmt;

/// The number type of the C text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `double`.
    F64,
    /// `float`.
    F32,
}

impl Precision {
    /// C's name of it.
    fn real(self) -> &'static str {
        match self {
            Self::F64 => "double",
            Self::F32 => "float",
        }
    }

    /// What rounds a `double` to it, if anything does.
    fn cast(self) -> Option<&'static str> {
        match self {
            Self::F64 => None,
            Self::F32 => Some("K"),
        }
    }

    /// An elementary function by its name in Rust.
    fn function(self, name: &str) -> Option<&'static str> {
        Some(match (self, name) {
            (Self::F64, "sqrt") => "sqrt",
            (Self::F64, "sin") => "libm_sin",
            (Self::F64, "cos") => "libm_cos",
            (Self::F64, "tanh") => "libm_tanh",
            (Self::F64, "atan2") => "libm_atan2",
            (Self::F32, "sqrt") => "sqrtf",
            (Self::F32, "sin") => "libm_sinf",
            (Self::F32, "cos") => "libm_cosf",
            (Self::F32, "tanh") => "libm_tanhf",
            (Self::F32, "atan2") => "libm_atan2f",
            _ => return None,
        })
    }
}

/// A mechanism in C.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// The header, `name.h`.
    pub header: String,
    /// The source, `name.c`.
    pub source: String,
}

/// What of a module cannot be written in C.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error(pub(crate) String);

impl Error {
    fn unknown(what: &str, tokens: &impl ToTokens) -> Self {
        let text: String = tokens.to_token_stream().to_string().chars().take(200).collect();
        Self(format!("{what} that C has no words for: {text}"))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Error {}

/// Writes a module in C. `code` is the text of the module that was generated of the model.
///
/// # Errors
/// What the module has that cannot be written: no module of the generator has such.
pub fn c(model: &Model, code: &str, precision: Precision) -> Result<Exported, Error> {
    text::written(model, &module::Module::read(code)?, precision)
}
