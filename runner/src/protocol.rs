//! How the command line and the program that it compiles speak with each other: values as bytes, which keep every bit
//! of a number, each after a mark and its length.
//!
//! The command line writes a [`Request`] to the program's standard input; the program answers with [`Reply`] values on
//! its standard output up to one that ends the run, and waits for the next.

use crate::motion::Linear;
use crate::{Approach, Forecast, Occurrence, Sample, Settings, Start, Summary, Timing};
use nanoserde::{DeBin, SerBin};
use std::io::{self, BufRead, Read, Write};

/// A run to be made.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Request {
    /// When to step, correct and sample.
    pub settings: Settings,
    /// By which method.
    pub approach: Approach,
    /// Values of the mechanism's parameters, in their order.
    pub parameters: Vec<f64>,
    /// Where to start.
    pub start: Start,
    /// How long the run may be repeated for its time, s; `None` if that is not requested.
    pub measure_for: Option<f64>,
}

/// One part of an answer.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Reply {
    /// The mechanism at a sample time.
    Sample(Sample),
    /// Something that has happened.
    Occurred(Occurrence),
    /// The linearisation at the end.
    Linear(Linear),
    /// The last state before the run fails, and its time, s.
    Stopped(f64, Vec<f64>),
    /// The run fails at this time, s, as the scene is stiff for its method.
    Stiff(f64),
    /// The run has reached this time, s.
    Progress(f64),
    /// How long the run will take.
    Forecast(Forecast),
    /// What the run costs if it is not sampled.
    Timed(Timing),
    /// The run is complete.
    Done(Summary),
    /// The run failed: the reason.
    Failed(String),
    /// The same of a run that a program which linearises can tell more of.
    Unexplained(String),
    /// The run cannot be made as requested: the reason.
    Refused(String),
}

/// What stands before each value and its length.
const MARK: [u8; 4] = *b"gyro";

/// Writes a request or a reply.
///
/// # Errors
/// That of the output.
pub fn write<T: SerBin>(output: &mut (impl Write + ?Sized), value: &T) -> io::Result<()> {
    let bytes = value.serialize_bin();
    output.write_all(&MARK)?;
    output.write_all(&(bytes.len() as u64).to_le_bytes())?;
    output.write_all(&bytes)
}

/// Reads a request or a reply; `None` where the input has come to its end.
///
/// # Errors
/// That of the input, also if it is not such a value or ends in the middle of one.
pub fn read<T: DeBin>(input: &mut impl BufRead) -> io::Result<Option<T>> {
    if input.fill_buf()?.is_empty() {
        return Ok(None);
    }
    let (mut mark, mut length) = ([0; MARK.len()], [0; 8]);
    input.read_exact(&mut mark)?;
    let invalid = |words: String| io::Error::new(io::ErrorKind::InvalidData, words);
    if mark != MARK {
        return Err(invalid("this is not what the other side writes".to_owned()));
    }
    input.read_exact(&mut length)?;
    let length = u64::from_le_bytes(length);
    let mut bytes = Vec::new();
    if input.take(length).read_to_end(&mut bytes)? as u64 != length {
        return Err(io::ErrorKind::UnexpectedEof.into());
    }
    T::deserialize_bin(&bytes).map(Some).map_err(|error| invalid(error.to_string()))
}

#[cfg(test)]
mod tests;
