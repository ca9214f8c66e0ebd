//! How a run may end before its time.

use gyro_sim::{Error, contact};
use std::io;

/// Why a run ends before its time.
pub(super) enum Halt {
    Motion(contact::Error),
    /// A law, and what is the matter with it.
    Law(String),
    Output(io::Error),
}

impl From<Error> for Halt {
    fn from(error: Error) -> Self {
        Self::Motion(error.into())
    }
}

impl From<contact::Error> for Halt {
    fn from(error: contact::Error) -> Self {
        Self::Motion(error)
    }
}

impl From<io::Error> for Halt {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}
