//! Failures as exceptions of `gyro_sim.errors`.

use gyro_cli::failure::Failure;
use gyro_model::Diagnostics;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// An exception of the package.
fn exception<A>(py: Python<'_>, name: &str, arguments: A) -> PyErr
where
    A: for<'py> pyo3::call::PyCallArgs<'py>,
{
    let raised = py.import("gyro_sim.errors").and_then(|errors| errors.getattr(name)?.call1(arguments));
    raised.map_or_else(|error| error, PyErr::from_value)
}

/// A request that cannot be met.
pub(crate) fn request(py: Python<'_>, words: &str) -> PyErr {
    exception(py, "RequestError", (words,))
}

/// What went wrong while something was computed.
pub(crate) fn run(py: Python<'_>, words: &str) -> PyErr {
    exception(py, "RunError", (words,))
}

/// A failure of what command line and package share.
pub(crate) fn raised(py: Python<'_>, failure: Failure) -> PyErr {
    match failure {
        Failure::Usage(words) => request(py, &words),
        Failure::ModelFile(mistakes) => model(py, &mistakes),
        Failure::Run(words) | Failure::Worthless(words) | Failure::Unjudged(words) => run(py, &words),
        Failure::Interrupted(words) => PyKeyboardInterrupt::new_err(words),
    }
}

fn model(py: Python<'_>, mistakes: &Diagnostics) -> PyErr {
    let list: Vec<(usize, usize, &str, &str)> = mistakes
        .mistakes()
        .iter()
        .map(|mistake| {
            let (line, column) = mistakes.place(mistake.span.start);
            (line, column, mistake.message.as_str(), mistake.help.as_str())
        })
        .collect();
    exception(py, "ModelError", (mistakes.render(), mistakes.file_name(), list))
}
