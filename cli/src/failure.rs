//! How a command ends when it does not succeed.

use gyro_model::Diagnostics;
use std::io::{IsTerminal, Write};
use std::process::ExitCode;

/// Why a command has not done what it was asked to.
#[derive(Debug)]
pub enum Failure {
    /// What was asked for makes no sense: exit status 2.
    Usage(String),
    /// The model page has mistakes: exit status 2.
    Page(Diagnostics),
    /// It made sense and did not succeed: exit status 1.
    Run(String),
    /// It succeeded, and what has come of it is worthless: exit status 3.
    Worthless(String),
}

impl Failure {
    /// What is wrong.
    pub fn words(&self) -> String {
        match self {
            Self::Usage(words) | Self::Run(words) | Self::Worthless(words) => words.clone(),
            Self::Page(mistakes) => mistakes.render(),
        }
    }

    /// Says so on standard error; returns the exit status.
    pub fn report(&self) -> ExitCode {
        let mut stderr = std::io::stderr();
        let (text, status) = match self {
            Self::Usage(words) => (format!("error: {words}\n"), 2),
            Self::Page(mistakes) if stderr.is_terminal() => (mistakes.render_colored(), 2),
            Self::Page(mistakes) => (mistakes.render(), 2),
            Self::Run(words) => (format!("error: {words}\n"), 1),
            Self::Worthless(words) => (format!("error: {words}\n"), 3),
        };
        // Nobody is left to be told if standard error is closed.
        let _ = stderr.write_all(text.as_bytes());
        ExitCode::from(status)
    }
}
