//! How a command ends when it does not succeed.

use gyro_model::Diagnostics;
use std::io::{IsTerminal, Write};
use std::process::ExitCode;

/// The exit status of a program that was interrupted, as shells have it.
pub(crate) const INTERRUPTED: u8 = 130;

/// Why a command failed.
#[derive(Debug)]
pub enum Failure {
    /// The request is invalid: exit status 2.
    Usage(String),
    /// The model file is invalid: exit status 2.
    ModelFile(Diagnostics),
    /// The request is valid, but its execution failed: exit status 1.
    Run(String),
    /// The command completed, but its result is worthless: exit status 3.
    Worthless(String),
    /// The command completed, but what its result is worth cannot be said: exit status 4.
    Unjudged(String),
    /// The command was interrupted, and has kept what it had: exit status 130.
    Interrupted(String),
}

impl Failure {
    /// The message.
    pub fn words(&self) -> String {
        match self {
            Self::Usage(words)
            | Self::Run(words)
            | Self::Worthless(words)
            | Self::Unjudged(words)
            | Self::Interrupted(words) => words.clone(),
            Self::ModelFile(mistakes) => mistakes.render(),
        }
    }

    /// Prints the message on standard error; returns the exit status.
    pub fn report(&self) -> ExitCode {
        let mut stderr = std::io::stderr();
        let (text, status) = match self {
            Self::Usage(words) => (format!("error: {words}\n"), 2),
            Self::ModelFile(mistakes) if stderr.is_terminal() => (mistakes.render_colored(), 2),
            Self::ModelFile(mistakes) => (mistakes.render(), 2),
            Self::Run(words) => (format!("error: {words}\n"), 1),
            Self::Worthless(words) => (format!("error: {words}\n"), 3),
            Self::Unjudged(words) => (format!("error: {words}\n"), 4),
            Self::Interrupted(words) => (format!("{words}\n"), INTERRUPTED),
        };
        // Nobody is left to be told if standard error is closed.
        let _ = stderr.write_all(text.as_bytes());
        ExitCode::from(status)
    }
}
