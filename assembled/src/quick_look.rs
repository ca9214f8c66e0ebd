//! A whole run of an assembled mechanism, for a command line: compiled here once, so that its caller need not be
//! optimised.

use crate::{BuildError, Careful, Dense, Recursive};
use gyro_model::Model;
use gyro_runner::{Approach, Event, Failure, Settings, Start, Summary, motion, run_by};
use std::{fmt, io};

/// Which form of assembled mechanism.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// [`Careful`].
    Careful,
    /// [`Dense`].
    Dense,
    /// [`Recursive`].
    Recursive,
}

impl Form {
    /// The better form for a model, on the constraints or off them: the careful one where it
    /// [applies](Careful::supports), the dense one otherwise.
    pub fn for_model(model: &Model) -> Self {
        if Careful::<f64>::supports(model).is_ok() { Self::Careful } else { Self::Dense }
    }
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

/// Runs an assembled model to a schedule; `tell` receives samples and progress, and ends the run by an error.
/// [`Form::for_model`] picks the form that suits a model.
///
/// # Errors
/// [`QuickLookError`]; the samples up to a failure have been told.
pub fn quick_look(
    model: &Model,
    (form, precision): (Form, Precision),
    plan: (&Settings, &Approach),
    start: &Start,
    tell: &mut dyn FnMut(Event<'_>) -> io::Result<()>,
) -> Result<Summary, QuickLookError> {
    match (form, precision) {
        (Form::Careful, Precision::Single) => simulate(Careful::<f32>::new(model), plan, start, tell),
        (Form::Careful, Precision::Double) => simulate(Careful::<f64>::new(model), plan, start, tell),
        (Form::Recursive, Precision::Single) => simulate(Recursive::<f32>::new(model), plan, start, tell),
        (Form::Recursive, Precision::Double) => simulate(Recursive::<f64>::new(model), plan, start, tell),
        (Form::Dense, Precision::Single) => simulate(Dense::<f32>::new(model), plan, start, tell),
        (Form::Dense, Precision::Double) => simulate(Dense::<f64>::new(model), plan, start, tell),
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
