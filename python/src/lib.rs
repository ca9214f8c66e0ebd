//! The compiled half of the Python package `gyro_sim`: what is computed. How it is called is in `python/gyro_sim`.

mod arguments;
mod batch;
mod dynamics;
mod errors;
mod linear;
mod mechanism;
mod run;
mod sensitivity;
mod stepper;

use pyo3::prelude::*;

/// What is compiled of the package.
#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    gyro_cli::library::be_quiet();
    module.add("version", gyro_cli::VERSION)?;
    module.add_class::<mechanism::Mechanism>()?;
    module.add_class::<run::Run>()?;
    module.add_class::<stepper::Stepper>()?;
    module.add_function(wrap_pyfunction!(mechanism::convert_urdf, module)?)
}
