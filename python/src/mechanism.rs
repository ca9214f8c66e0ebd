//! Mechanisms.

use crate::arguments::{doubles, of_many, one, result, rows, set_inputs, slice, tuple, writable, zeros};
use crate::batch::{self, Batch, Many};
use crate::dynamics::{self, Dynamics};
use crate::errors;
use crate::linear::linearize;
use crate::run::{Run, interruptible};
use crate::sensitivity;
use crate::stepper::Stepper;
use gyro_cli::failure::Failure;
use gyro_cli::library::{self, Kernels, Request};
use gyro_codegen::{Effort, Functions, Group};
use gyro_jit::Sizes;
use gyro_model::Model;
use gyro_sim::JointSpace;
use gyro_verifier::Depth;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A mechanism: what `gyro_sim.Mechanism` shows.
#[pyclass(subclass, frozen, module = "gyro_sim._native")]
#[derive(Debug)]
pub(crate) struct Mechanism {
    /// As the model file has it.
    page: Model,
    file: String,
    text: String,
    folder: PathBuf,
    kernels: Arc<Kernels>,
    state: Mutex<State>,
}

/// What changes.
#[derive(Debug)]
struct State {
    /// The model with the values of its parameters.
    model: Model,
    /// Which of these were set: the others are as exact as the model file has them.
    set: BTreeMap<String, f64>,
    /// For single states, made when it is first asked for.
    dynamics: Option<Dynamics>,
    /// For many, one for each thread, made when they are first asked for.
    many: Vec<Many>,
}

/// What is compiled for accelerations, and what for linearisations.
fn functions(is_linearised: bool) -> Functions {
    let jacobian: &[Group] = if is_linearised { &[Group::Jacobian] } else { &[] };
    Functions::of([&[Group::Partition, Group::Joint], jacobian].concat())
}

#[pymethods]
impl Mechanism {
    #[new]
    fn new(py: Python<'_>, text: String, file: String, folder: PathBuf) -> PyResult<Self> {
        let page = py.detach(|| library::read_text(&file, &text, &folder));
        let page = page.map_err(|failure| errors::raised(py, failure))?;
        let state =
            Mutex::new(State { model: page.clone(), set: BTreeMap::new(), dynamics: None, many: Vec::new() });
        Ok(Self { page, file, text, folder, kernels: Arc::default(), state })
    }

    /// The text of the model file, its name and its folder.
    #[getter]
    fn source(&self) -> (&str, &str, &Path) {
        (&self.text, &self.file, &self.folder)
    }

    /// The name in the model file.
    #[getter]
    fn name(&self) -> &str {
        &self.page.name
    }

    /// What is to be said of the model.
    #[getter]
    fn remarks(&self) -> Vec<String> {
        library::warnings(&self.page)
    }

    /// Freedoms of motion.
    #[getter]
    fn degrees_of_freedom(&self) -> usize {
        self.page.degrees_of_freedom()
    }

    /// Names of the moving bodies.
    #[getter]
    fn bodies(&self) -> Vec<&str> {
        self.page.coordinate_bodies().into_iter().map(|body| self.page.bodies[body].name.as_str()).collect()
    }

    /// Names of the joints.
    #[getter]
    fn joints(&self) -> Vec<&str> {
        self.page.joints.iter().map(|joint| joint.name.as_str()).collect()
    }

    /// Names of the inputs and the model file's values.
    #[getter(_inputs)]
    fn inputs(&self) -> Vec<(&str, f64)> {
        self.page.inputs.iter().map(|input| (input.name.as_str(), gyro_model::to_f64(&input.value))).collect()
    }

    /// Names of the parameters and their values.
    #[getter(_parameters)]
    fn parameters(&self, py: Python<'_>) -> Vec<(String, f64)> {
        let state = self.locked(py);
        state.model.parameters.iter().map(|p| (p.name.clone(), gyro_model::to_f64(&p.value))).collect()
    }

    /// Those that were set.
    #[getter(_set_parameters)]
    fn set_by_now(&self, py: Python<'_>) -> BTreeMap<String, f64> {
        self.locked(py).set.clone()
    }

    /// Names of the numbers of x and of u.
    #[pyo3(name = "_coordinates")]
    fn coordinates(&self, py: Python<'_>) -> PyResult<(Vec<String>, Vec<String>)> {
        let mut state = self.ready(py)?;
        Ok(dynamics::names(&state.dynamics().mechanism, &self.page))
    }

    /// Sets parameters.
    #[pyo3(name = "_set")]
    fn set_parameters(&self, py: Python<'_>, values: Vec<(String, f64)>) -> PyResult<()> {
        let exact: Vec<_> = values
            .iter()
            .map(|(name, value)| {
                // As the command line reads it: the shortest decimal number that is this one.
                let exact = gyro_model::parse_decimal(&format!("{value:?}"));
                exact.map(|exact| (name.clone(), exact)).ok_or_else(|| {
                    errors::request(py, &format!("{name} = {value}: a finite number was expected"))
                })
            })
            .collect::<PyResult<_>>()?;
        let mut state = self.locked(py);
        let model = state.model.with_parameters(&exact).map_err(|words| errors::request(py, &words))?;
        for (index, parameter) in model.parameters.iter().enumerate() {
            let value = gyro_model::to_f64(&parameter.value);
            if let Some(dynamics) = &mut state.dynamics {
                dynamics.mechanism.set_parameter(index, value);
            }
            state.many.iter_mut().for_each(|many| many.set_parameter(index, value));
        }
        state.model = model;
        state.set.extend(values);
        Ok(())
    }

    /// Refuses a formula with mistakes.
    #[pyo3(name = "_check_formula")]
    fn check_formula(&self, py: Python<'_>, text: &str) -> PyResult<()> {
        let known = self.page.formula(text).map(|_| ());
        known.map_err(|words| errors::raised(py, Failure::Usage(words)))
    }

    /// Makes a run, by options of `simulate`.
    #[pyo3(name = "_run")]
    fn run(
        &self,
        py: Python<'_>,
        mut options: Vec<String>,
        inputs: Vec<(String, Vec<[f64; 2]>)>,
    ) -> PyResult<Run> {
        for (name, value) in self.set_by_now(py) {
            options.extend(["--set".to_owned(), format!("{name}={value:?}")]);
        }
        let request = Request::of(&self.file, &options).map_err(|failure| errors::raised(py, failure))?;
        let request =
            inputs.into_iter().fold(request, |request, (name, rows)| request.with_input(&name, rows));
        let (file, page, kernels) = (self.file.clone(), self.page.clone(), self.kernels.clone());
        interruptible(py, move |stop| library::Run::make((&page, &file), &request, &kernels, stop)).map(Run)
    }

    /// (x, u) of a sample of one of this mechanism's runs.
    #[pyo3(name = "_state_of")]
    fn state_of<'py>(
        &self,
        py: Python<'py>,
        run: &Run,
        sample: usize,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut state = self.ready(py)?;
        let places = state.dynamics().mechanism.joint_layout().places;
        let found = run.0.state(sample, places);
        let found = found.ok_or_else(|| {
            errors::request(
                py,
                "the samples of this mechanism's runs do not have all of its joint coordinates",
            )
        })?;
        Ok(PyArray1::from_vec(py, found))
    }

    /// The joint state (x, u) that runs start from, with the parameters as they are; shape (n,).
    fn start<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut state = self.ready(py)?;
        let start =
            library::start(&self.file, &state.model).map_err(|failure| errors::raised(py, failure))?;
        Ok(PyArray1::from_vec(py, state.dynamics().start(&start)))
    }

    /// The accelerations u̇ of the joint coordinates, rad/s² and m/s².
    ///
    /// x: positions, shape (n,), or (rows, n) of many states, which are computed on all cores without the
    ///     interpreter's lock.
    /// u: rates, (m,) or (rows, m).
    /// inputs: (inputs,) or (rows, inputs); the model file's values if they are not given.
    /// out: a float64 array in C order of u's shape that receives the result and is returned.
    /// t: the time, s, on which driven joints depend.
    ///
    /// Arrays of float64 in C order are read where they are; anything else is converted first. Of a mechanism with
    /// loops the state should satisfy them.
    #[pyo3(signature = (x, u, inputs=None, out=None, t=0.0))]
    fn joint_accelerations<'py>(
        &self,
        py: Python<'py>,
        x: &Bound<'py, PyAny>,
        u: &Bound<'py, PyAny>,
        inputs: Option<&Bound<'py, PyAny>>,
        out: Option<Bound<'py, PyAny>>,
        t: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (x, u) = (doubles(x)?, doubles(u)?);
        let inputs = inputs.map(doubles).transpose()?;
        let mut state = self.ready(py)?;
        let dynamics = state.dynamics();
        let (n_x, n_u) = (dynamics.n_x, dynamics.n_u);
        let n = rows(py, "x", x.shape(), n_x)?;
        if rows(py, "u", u.shape(), n_u)? != n {
            let words = format!(
                "x of shape {} and u of {}: as many rows were expected",
                tuple(x.shape()),
                tuple(u.shape())
            );
            return Err(errors::request(py, &words));
        }
        let out = out.map_or_else(|| Ok(zeros(py, n, n_u)), |out| result(py, out, u.shape()))?;
        let mut results = writable(&out)?;
        let results = results.as_slice_mut()?;
        if n.is_some() {
            let defaults = dynamics.defaults.clone();
            let inputs = of_many(py, n, inputs.as_ref(), &defaults)?;
            let batch = Batch { t, x: slice(&x), u: slice(&u), inputs, out: results };
            let sizes = [n_x, n_u, defaults.len()];
            let many = state.many(py)?;
            py.detach(|| batch::accelerations(many, sizes, batch));
        } else {
            set_inputs(py, dynamics, inputs.as_ref())?;
            dynamics.accelerations(t, (slice(&x), slice(&u)), results);
        }
        Ok(out.into_any())
    }

    /// The derivative of the joint state (x, u), as scipy.integrate.solve_ivp calls it: f(t, state); shape (n,).
    #[pyo3(signature = (t, state, inputs=None, out=None))]
    fn f<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        state: &Bound<'py, PyAny>,
        inputs: Option<&Bound<'py, PyAny>>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (given, inputs) = (doubles(state)?, inputs.map(doubles).transpose()?);
        let mut state = self.ready(py)?;
        let dynamics = state.dynamics();
        let n = dynamics.n_x + dynamics.n_u;
        one(py, given.shape(), n)?;
        set_inputs(py, dynamics, inputs.as_ref())?;
        let out = out.map_or_else(|| Ok(zeros(py, None, n)), |out| result(py, out, given.shape()))?;
        dynamics.derivative(t, slice(&given), writable(&out)?.as_slice_mut()?);
        Ok(out.into_any())
    }

    /// The linearisation about a state.
    #[pyo3(name = "_linearized")]
    fn linearized<'py>(
        &self,
        py: Python<'py>,
        t: f64,
        state: &Bound<'py, PyAny>,
        inputs: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Linearized<'py>> {
        let (given, inputs) = (doubles(state)?, inputs.map(doubles).transpose()?);
        let model = self.locked(py).model.clone();
        let (kernels, page) = (self.kernels.clone(), self.page.clone());
        let compiled = interruptible(py, move |_| kernels.get(&page, &functions(true), Effort::Full))?;
        let mut dynamics = Dynamics::new(compiled, &model);
        one(py, given.shape(), dynamics.n_x + dynamics.n_u)?;
        set_inputs(py, &mut dynamics, inputs.as_ref())?;
        let values = inputs.as_ref().map_or(&dynamics.defaults[..], slice);
        let linear = linearize(&dynamics, t, slice(&given), values);
        let linear = linear.ok_or_else(|| {
            errors::run(
                py,
                "the loops of the mechanism cannot be closed near this state: give one that satisfies them",
            )
        })?;
        let (n, n_inputs, n_outputs) = (linear.state.len(), model.inputs.len(), linear.outputs.len());
        let matrix =
            |values: &[f64], rows, columns| PyArray1::from_slice(py, values).reshape([rows, columns]);
        Ok((
            library::names(&model, &linear),
            PyArray1::from_slice(py, &linear.state),
            PyArray1::from_slice(py, &linear.slope),
            PyArray1::from_slice(py, &linear.outputs),
            [
                matrix(&linear.by_state, n, n)?,
                matrix(&linear.by_inputs, n, n_inputs)?,
                matrix(&linear.outputs_by_state, n_outputs, n)?,
                matrix(&linear.outputs_by_inputs, n_outputs, n_inputs)?,
            ],
            library::text(&model, &linear),
        ))
    }

    /// A motion in steps of one length, of one state or of many.
    #[pyo3(name = "_steps", signature = (dt, state, substeps=1))]
    fn steps(&self, py: Python<'_>, dt: f64, state: &Bound<'_, PyAny>, substeps: u32) -> PyResult<Stepper> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(errors::request(py, "dt: a positive number of seconds was expected, such as 1e-3"));
        }
        let given = doubles(state)?;
        let mut ready = self.ready(py)?;
        let by_cargo = ready.many.first().filter(|many| matches!(many, Many::ByCargo(..))).cloned();
        let dynamics = ready.dynamics();
        dynamics.reset_inputs();
        let n = rows(py, "state", given.shape(), dynamics.n_x + dynamics.n_u)?;
        let stepper = Stepper::new(dynamics, (dt, substeps), (n, slice(&given)), by_cargo);
        stepper.map_err(|error| errors::request(py, &error.to_string()))
    }

    /// States at times and their slopes by parameters.
    #[pyo3(name = "_sensitivities")]
    fn sensitivities<'py>(
        &self,
        py: Python<'py>,
        times: &Bound<'py, PyAny>,
        parameters: Vec<String>,
        step: f64,
        state: &Bound<'py, PyAny>,
        inputs: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<StatesAndSlopes<'py>> {
        let (times, given, inputs) = (doubles(times)?, doubles(state)?, inputs.map(doubles).transpose()?);
        let times = slice(&times).to_vec();
        let is_time = |t: &f64| t.is_finite() && *t >= 0.0;
        if !(step > 0.0 && times.is_sorted() && times.iter().all(is_time)) {
            return Err(errors::request(
                py,
                "increasing times from 0 on and a positive step were expected, s",
            ));
        }
        let dynamics = {
            let mut ready = self.ready(py)?;
            let dynamics = ready.dynamics();
            one(py, given.shape(), dynamics.n_x + dynamics.n_u)?;
            set_inputs(py, dynamics, inputs.as_ref())?;
            dynamics.clone()
        };
        let place = |name: &String| {
            let found = self.page.parameters.iter().position(|parameter| parameter.name == *name);
            found.ok_or_else(|| errors::request(py, &format!("the model has no parameter `{name}`")))
        };
        let places: Vec<usize> = parameters.iter().map(place).collect::<PyResult<_>>()?;
        let values = inputs.as_ref().map_or(dynamics.defaults.clone(), |inputs| slice(inputs).to_vec());
        let (shape, state) = ([times.len(), slice(&given).len()], slice(&given).to_vec());
        let found = interruptible(py, move |stop| {
            let from = (&state[..], &values[..]);
            sensitivity::sensitivities(&dynamics, from, (&times, step), &places, stop)
        })?;
        Ok((PyArray1::from_vec(py, found.states).reshape(shape)?, PyArray1::from_vec(py, found.slopes)))
    }

    /// Has cargo compile what batches need.
    #[pyo3(name = "_compile")]
    fn compile(&self, py: Python<'_>, native: bool) -> PyResult<()> {
        let sizes = {
            let mut state = self.ready(py)?;
            let dynamics = state.dynamics();
            let (parameters, inputs) = (self.page.parameters.len(), self.page.inputs.len());
            Sizes { x: dynamics.n_x, u: dynamics.n_u, parameters, inputs }
        };
        let (file, page) = (self.file.clone(), self.page.clone());
        let compiled =
            interruptible(py, move |_| library::batches(&file, &page, &functions(false), sizes, native))?;
        let mut state = self.ready(py)?;
        state.many = vec![Many::by_cargo(compiled, state.dynamics())];
        Ok(())
    }

    /// The Rust module, as `gyro generate` writes it, with what was proved of it in its head.
    fn generate(&self, py: Python<'_>) -> PyResult<String> {
        let (file, page) = (self.file.clone(), self.page.clone());
        interruptible(py, move |_| library::generate(&file, &page))
    }

    /// Whether all is proved, the proof as text and as JSON.
    #[pyo3(name = "_proof")]
    fn proof(&self, py: Python<'_>, quick: bool) -> PyResult<(bool, String, String)> {
        let depth = if quick { Depth::Quick } else { Depth::Full };
        let (file, page) = (self.file.clone(), self.page.clone());
        let (is_proved, text, object) = interruptible(py, move |_| library::verify(&file, &page, depth))?;
        Ok((is_proved, text, object.to_string()))
    }
}

/// Names, state, slope, outputs, the four matrices and their text.
type Linearized<'py> = (
    Vec<String>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<f64>>,
    [Bound<'py, PyArray2<f64>>; 4],
    String,
);

/// States row by row, and their slopes in one row.
type StatesAndSlopes<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray1<f64>>);

impl Mechanism {
    fn locked(&self, py: Python<'_>) -> MutexGuard<'_, State> {
        self.state.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner)
    }

    /// The same with the functions of joint coordinates compiled.
    fn ready(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, State>> {
        let mut state = self.locked(py);
        if state.dynamics.is_none() {
            let (kernels, page) = (self.kernels.clone(), self.page.clone());
            let compiled = interruptible(py, move |_| kernels.get(&page, &functions(false), Effort::Full))?;
            state.dynamics = Some(Dynamics::new(compiled, &state.model));
        }
        Ok(state)
    }
}

impl State {
    /// For single states, once [`Mechanism::ready`] has made it.
    fn dynamics(&mut self) -> &mut Dynamics {
        self.dynamics.as_mut().expect("it is ready")
    }

    fn many(&mut self, py: Python<'_>) -> PyResult<&mut Vec<Many>> {
        if self.many.is_empty() {
            let dynamics = self.dynamics().clone();
            let many = py
                .detach(move || Many::in_process(&dynamics))
                .map_err(|error| errors::request(py, &error.to_string()))?;
            self.many.push(many);
        }
        Ok(&mut self.many)
    }
}

/// The model file of a robot, and what of it has no counterpart there.
#[pyfunction]
pub(crate) fn convert_urdf(
    py: Python<'_>,
    path: PathBuf,
    options: Vec<String>,
) -> PyResult<(String, Vec<String>)> {
    library::import(&path, &options).map_err(|failure| errors::raised(py, failure))
}
