//! Runs.

use crate::errors;
use gyro_cli::failure::Failure;
use gyro_cli::library::{self, Stop};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A run that was made: what `gyro_sim.Run` shows.
#[pyclass(frozen, module = "gyro_sim._native")]
#[derive(Debug)]
pub(crate) struct Run(pub(crate) library::Run);

#[pymethods]
impl Run {
    /// Name, unit and values of each column.
    fn columns<'py>(&self, py: Python<'py>) -> Vec<(String, &'static str, Bound<'py, PyArray1<f64>>)> {
        let columns = self.0.columns().into_iter();
        columns.map(|column| (column.name, column.unit, PyArray1::from_vec(py, column.values))).collect()
    }

    /// Names and units of the numbers of outputs.
    fn outputs(&self) -> Vec<(String, &'static str)> {
        self.0.outputs()
    }

    /// What the run was and what it cost, as JSON.
    fn summary(&self) -> String {
        self.0.summary().to_string()
    }

    /// The same as text.
    fn text(&self) -> String {
        self.0.text()
    }

    /// What the run says of itself that is not good.
    fn warnings(&self) -> Vec<String> {
        self.0.warnings()
    }

    /// How far it can be trusted, as JSON.
    fn verdict(&self, py: Python<'_>) -> PyResult<String> {
        interruptible(py, |stop| self.0.verdict(stop)).map(|verdict| verdict.to_string())
    }
}

/// How often Python is asked for signals.
const PATIENCE: Duration = Duration::from_millis(20);

/// Works without the interpreter's lock, until Python has a signal to handle.
pub(crate) fn interruptible<R: Send>(
    py: Python<'_>,
    work: impl FnOnce(Stop<'_>) -> Result<R, Failure> + Send,
) -> PyResult<R> {
    let (raised, asked) = (Mutex::new(None), Mutex::new(Instant::now()));
    let stop = || {
        let mut asked = asked.lock().unwrap_or_else(PoisonError::into_inner);
        if asked.elapsed() < PATIENCE {
            return false;
        }
        *asked = Instant::now();
        let error = Python::attach(|py| py.check_signals()).err();
        let is_raised = error.is_some();
        *raised.lock().unwrap_or_else(PoisonError::into_inner) = error;
        is_raised
    };
    let outcome = py.detach(|| work(&stop));
    match (outcome, raised.into_inner().unwrap_or_else(PoisonError::into_inner)) {
        (Err(Failure::Interrupted(_)), Some(error)) => Err(error),
        (outcome, _) => outcome.map_err(|failure| errors::raised(py, failure)),
    }
}
