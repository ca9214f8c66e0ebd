//! Arrays of numpy as arguments and results.

use crate::dynamics::Dynamics;
use crate::errors;
use gyro_runner::batch::Inputs;
use numpy::{
    BorrowError, PyArray, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyReadwriteArrayDyn,
    PyUntypedArrayMethods,
};
use pyo3::prelude::*;

/// An array of doubles in C order; what is none is copied into one, if its numbers are real.
pub(crate) fn doubles<'py>(given: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    if let Ok(array) = given.cast::<PyArrayDyn<f64>>()
        && is_plain(array)
    {
        return readonly(array);
    }
    let py = given.py();
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (given,))?;
    let is_real: bool =
        numpy.call_method1("can_cast", (array.getattr("dtype")?, "f8", "same_kind"))?.extract()?;
    if !is_real {
        let words = format!("real numbers were expected, not an array of {}", array.getattr("dtype")?);
        return Err(errors::request(py, &words));
    }
    // Elements need not stand where their type asks for: a copy's do.
    let copy = numpy.call_method1("array", (array, "f8"))?;
    readonly(numpy.call_method1("ascontiguousarray", (copy,))?.cast::<PyArrayDyn<f64>>()?)
}

/// Whether Rust can take the elements where they are.
fn is_plain(array: &Bound<'_, PyArrayDyn<f64>>) -> bool {
    array.is_c_contiguous() && array.data().is_aligned()
}

fn readonly<'py>(array: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<PyReadonlyArrayDyn<'py, f64>> {
    let busy = |_| errors::request(array.py(), "an array was given that another thread is writing to");
    array.try_readonly().map_err(busy)
}

/// Its numbers.
pub(crate) fn slice<'a>(array: &'a PyReadonlyArrayDyn<'_, f64>) -> &'a [f64] {
    array.as_slice().unwrap_or_default()
}

/// A shape as Python writes it.
pub(crate) fn tuple(shape: &[usize]) -> String {
    match shape {
        [only] => format!("({only},)"),
        shape => format!("({})", shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")),
    }
}

/// How many states an array has: `None` for one alone, `(n,)`; else `(rows, n)`.
pub(crate) fn rows(py: Python<'_>, name: &str, shape: &[usize], n: usize) -> PyResult<Option<usize>> {
    match *shape {
        [found] if found == n => Ok(None),
        [rows, found] if found == n => Ok(Some(rows)),
        _ if n == 0 => {
            Err(errors::request(py, &format!("{name} of shape {}: the model file has none", tuple(shape))))
        }
        _ => Err(errors::request(
            py,
            &format!(
                "{name} of shape {}: ({n},) was expected, or (rows, {n}) for many at once",
                tuple(shape)
            ),
        )),
    }
}

/// Refuses what is not one state.
pub(crate) fn one(py: Python<'_>, shape: &[usize], n: usize) -> PyResult<()> {
    match shape {
        [found] if *found == n => Ok(()),
        _ => Err(errors::request(
            py,
            &format!("a state of shape {}: ({n},) was expected, x and then u", tuple(shape)),
        )),
    }
}

/// Sets the inputs of one state: the model file's values, if none are given.
pub(crate) fn set_inputs(
    py: Python<'_>,
    dynamics: &mut Dynamics,
    given: Option<&PyReadonlyArrayDyn<'_, f64>>,
) -> PyResult<()> {
    let Some(given) = given else {
        dynamics.reset_inputs();
        return Ok(());
    };
    match rows(py, "inputs", given.shape(), dynamics.defaults.len())? {
        None => dynamics.set_inputs(slice(given)),
        Some(rows) => {
            return Err(errors::request(
                py,
                &format!("inputs have {rows} rows: those of one state were expected"),
            ));
        }
    }
    Ok(())
}

/// The inputs of many states.
pub(crate) fn of_many<'a>(
    py: Python<'_>,
    n: Option<usize>,
    given: Option<&'a PyReadonlyArrayDyn<'_, f64>>,
    defaults: &'a [f64],
) -> PyResult<Inputs<'a>> {
    let Some(given) = given else { return Ok(Inputs::Same(defaults)) };
    match rows(py, "inputs", given.shape(), defaults.len())? {
        None => Ok(Inputs::Same(slice(given))),
        found if found == n => Ok(Inputs::Own(slice(given))),
        found => {
            let words = format!("inputs have {} rows: as many were expected as x has", found.unwrap_or(1));
            Err(errors::request(py, &words))
        }
    }
}

/// An array for results.
pub(crate) fn zeros(py: Python<'_>, rows: Option<usize>, n: usize) -> Bound<'_, PyArrayDyn<f64>> {
    match rows {
        None => PyArray::zeros(py, &[n][..], false),
        Some(rows) => PyArray::zeros(py, &[rows, n][..], false),
    }
}

/// The caller's array for results.
pub(crate) fn result<'py>(
    py: Python<'py>,
    out: Bound<'py, PyAny>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    match out.cast_into::<PyArrayDyn<f64>>() {
        Ok(array) if is_plain(&array) && array.shape() == shape => Ok(array),
        _ => {
            let words =
                format!("out: an array of float64 in C order with the shape {} was expected", tuple(shape));
            Err(errors::request(py, &words))
        }
    }
}

/// The numbers of an array for results.
pub(crate) fn writable<'py>(out: &Bound<'py, PyArrayDyn<f64>>) -> PyResult<PyReadwriteArrayDyn<'py, f64>> {
    out.try_readwrite().map_err(|error| {
        errors::request(
            out.py(),
            match error {
                BorrowError::NotWriteable => "out: an array was expected that can be written to",
                _ => "out: an array was expected that has no memory in common with the arguments",
            },
        )
    })
}
