//! A whole run of the twin, for a command line: compiled here once, so that its caller need not be optimised.

use crate::{Careful, Dense};
use gyro_model::{AssemblyError, Model};
use gyro_runner::{Event, Failure, Settings, Start, Summary, run};
use gyro_sim::Partition;
use std::fmt;

/// Which of the twin's forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// [`Careful`].
    Careful,
    /// [`Dense`].
    Dense,
}

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
    /// The model has no consistent start.
    Start(AssemblyError),
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

/// Runs the twin of a model to a schedule; `tell` hears of samples and progress.
///
/// # Errors
/// [`QuickLookError`]; the samples up to a failure have been told.
pub fn quick_look(
    model: &Model,
    (form, precision): (Form, Precision),
    settings: &Settings,
    start: &Start,
    tell: &mut dyn FnMut(Event<'_>),
) -> Result<Summary, QuickLookError> {
    match (form, precision) {
        (Form::Careful, Precision::Single) => simulate(Careful::<f32>::new(model), settings, start, tell),
        (Form::Careful, Precision::Double) => simulate(Careful::<f64>::new(model), settings, start, tell),
        (Form::Dense, Precision::Single) => simulate(Dense::<f32>::new(model), settings, start, tell),
        (Form::Dense, Precision::Double) => simulate(Dense::<f64>::new(model), settings, start, tell),
    }
}

fn simulate<M: Partition>(
    mechanism: Result<M, AssemblyError>,
    settings: &Settings,
    start: &Start,
    tell: &mut dyn FnMut(Event<'_>),
) -> Result<Summary, QuickLookError> {
    let mechanism = mechanism.map_err(QuickLookError::Start)?;
    let told = |event: Event<'_>| {
        tell(event);
        Ok(())
    };
    run(&mechanism, settings, start, told).map_err(QuickLookError::Run)
}
