//! Why a text was refused.

use proc_macro2::Span;
use std::fmt;

/// Something in a module or its constants that is not as it must be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refusal {
    /// Line of the text, from one.
    pub line: usize,
    /// What was found and what was expected.
    pub message: String,
}

impl Refusal {
    /// At a line.
    pub fn new(line: usize, message: impl Into<String>) -> Self {
        Self { line, message: message.into() }
    }

    /// At a place in a parsed text.
    pub fn at(span: Span, message: impl Into<String>) -> Self {
        Self::new(span.start().line, message)
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.message)
    }
}

impl std::error::Error for Refusal {}

impl From<syn::Error> for Refusal {
    fn from(error: syn::Error) -> Self {
        Self::at(error.span(), error.to_string())
    }
}
