//! Runs.

use crate::errors;
use gyro_cli::failure::Failure;
use gyro_cli::library::{self, Stop};
use numpy::PyArray1;
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

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

    /// The values of a formula.
    #[pyo3(name = "_formula")]
    fn formula<'py>(&self, py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let values = self.0.formula(text).map_err(|failure| errors::raised(py, failure))?;
        Ok(PyArray1::from_vec(py, values))
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
        let run = self.0.clone();
        interruptible(py, move |stop| run.verdict(stop)).map(|verdict| verdict.to_string())
    }
}

/// How often Python is asked for signals.
const PATIENCE: Duration = Duration::from_millis(20);

/// How long work may go on that was asked to stop, before it is left to itself.
const GRACE: Duration = Duration::from_millis(200);

/// Enough for whatever can be derived: main threads have 8 MB.
const STACK: usize = 64 << 20;

/// Works on a thread of its own, without the interpreter's lock, until Python has a signal to handle. What does not ask
/// whether to stop, such as deriving, is then left to itself.
pub(crate) fn interruptible<R: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(Stop<'_>) -> Result<R, Failure> + Send + 'static,
) -> PyResult<R> {
    let (sender, receiver) = mpsc::sync_channel(1);
    let is_over = Arc::new(AtomicBool::new(false));
    let asked = is_over.clone();
    let worker = move || {
        // Nobody listens any more to what was left to itself.
        let _ = sender.send(work(&|| asked.load(Ordering::Relaxed)));
    };
    thread::Builder::new().stack_size(STACK).spawn(worker)?;
    let receiver = Mutex::new(receiver);
    let wait = |patience| {
        py.detach(|| receiver.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(patience))
    };
    loop {
        match wait(PATIENCE) {
            Ok(outcome) => return outcome.map_err(|failure| errors::raised(py, failure)),
            Err(RecvTimeoutError::Timeout) => py.check_signals().inspect_err(|_| {
                is_over.store(true, Ordering::Relaxed);
                let _ = wait(GRACE);
            })?,
            Err(RecvTimeoutError::Disconnected) => {
                return Err(errors::run(py, "this ended without a result, which is a mistake of gyro_sim"));
            }
        }
    }
}
