//! A whole run of an assembled mechanism, for a command line: compiled here once, so that its caller need not be
//! optimised.

use crate::{BuildError, Careful, Dense};
use gyro_model::Model;
use gyro_runner::{Approach, Event, Failure, Settings, Start, Summary, motion, run_by};
use std::{fmt, io};

/// The number type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `f32`.
    Single,
    /// `f64`.
    Double,
}

/// Why there is no summary.
#[derive(Debug)]
pub enum QuickLookError {
    /// The model has no consistent start, or is beyond the chosen form.
    Start(BuildError),
    /// The run failed midway.
    Run(Failure),
}

impl fmt::Display for QuickLookError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Start(error) => error.fmt(f),
            Self::Run(failure) => failure.fmt(f),
        }
    }
}

impl std::error::Error for QuickLookError {}

/// Runs an assembled model to a schedule, in the better form for it: the careful one where it
/// [applies](Careful::supports), the dense one otherwise. `tell` receives samples and progress, and ends the run by an
/// error.
///
/// # Errors
/// [`QuickLookError`]; the samples up to a failure have been told.
pub fn quick_look(
    model: &Model,
    precision: Precision,
    plan: (&Settings, &Approach),
    start: &Start,
    tell: &mut dyn FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, QuickLookError> {
    let is_careful = Careful::<f64>::supports(model).is_ok();
    match (is_careful, precision) {
        (true, Precision::Single) => simulate(Careful::<f32>::new(model), plan, start, tell),
        (true, Precision::Double) => simulate(Careful::<f64>::new(model), plan, start, tell),
        (false, Precision::Single) => simulate(Dense::<f32>::new(model), plan, start, tell),
        (false, Precision::Double) => simulate(Dense::<f64>::new(model), plan, start, tell),
    }
}

fn simulate<M: motion::Maximal + Clone + 'static>(
    mechanism: Result<M, BuildError>,
    plan: (&Settings, &Approach),
    start: &Start,
    tell: &mut dyn FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, QuickLookError> {
    let mut mechanism = mechanism.map_err(QuickLookError::Start)?;
    run_by(&mut mechanism, &motion::Projecting, plan, start, tell).map_err(QuickLookError::Run)
}
