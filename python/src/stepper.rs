//! Steps in a loop.

use crate::arguments::{doubles, result, rows, slice};
use crate::dynamics::{Dynamics, Pair};
use crate::errors;
use gyro_jit::{Compiled, NotCompiled};
use gyro_runner::describe_in;
use gyro_sim::{CloseLoops, Error, Joint, JointSpace, Rk4};
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use rayon::prelude::*;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// A motion that its caller advances in steps of one length: Kutta's method of order 4, loops closed after each step.
/// From Mechanism.stepper.
#[pyclass(frozen, module = "gyro_sim")]
pub(crate) struct Stepper(Mutex<Steps>);

struct Steps {
    dt: f64,
    substeps: u32,
    /// How many substeps were taken.
    done: u64,
    /// When they began, s.
    from: f64,
    n_state: usize,
    /// `None` for one state alone.
    rows: Option<usize>,
    /// Of each state (x, u), and the work where there is some.
    states: Vec<Vec<f64>>,
    threads: Vec<Thread>,
}

/// What one thread works with.
#[derive(Clone)]
struct Thread {
    dynamics: Dynamics,
    method: Rk4<Vec<f64>>,
    loops: CloseLoops<Compiled<f64>>,
    /// For many states of a mechanism without loops, two at a time.
    pair: Option<Pair>,
}

/// Fewer states than these are not worth another thread.
const SHARE: usize = 64;

/// When steps begin, s, their length, and which ones are to be taken.
type Steppings = ((f64, f64), Range<u64>);

impl Thread {
    fn set_inputs(&mut self, inputs: &[f64]) {
        self.dynamics.set_inputs(inputs);
        self.pair.iter_mut().for_each(|pair| pair.set_inputs([inputs; 2]));
    }

    /// All states by some steps; `own` has the inputs of each, if they are not the same for all.
    fn advance(
        &mut self,
        steps: &Steppings,
        states: &mut [Vec<f64>],
        own: Option<&[f64]>,
    ) -> Result<(), Error> {
        let n_inputs = self.dynamics.defaults.len();
        let inputs_of = |row: usize| own.map(|own| &own[row * n_inputs..][..n_inputs]);
        let (pairs, rest) = match self.pair {
            Some(_) => states.as_chunks_mut::<2>(),
            None => (&mut [][..], states),
        };
        let n_paired = 2 * pairs.len();
        for (k, [a, b]) in pairs.iter_mut().enumerate() {
            let Some(pair) = &mut self.pair else { break };
            if let (Some(a), Some(b)) = (inputs_of(2 * k), inputs_of(2 * k + 1)) {
                pair.set_inputs([a, b]);
            }
            pair.advance(steps.0, steps.1.clone(), [a, b]);
        }
        for (k, x) in rest.iter_mut().enumerate() {
            if let Some(inputs) = inputs_of(n_paired + k) {
                self.dynamics.set_inputs(inputs);
            }
            self.advance_one(steps, x)?;
        }
        Ok(())
    }

    fn advance_one(&mut self, ((from, h), steps): &Steppings, x: &mut Vec<f64>) -> Result<(), Error> {
        let mechanism = &self.dynamics.mechanism;
        for step in steps.clone() {
            #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
            let [t, next] = [from + step as f64 * h, from + (step + 1) as f64 * h];
            self.method.step(&Joint, mechanism, t, *h, x);
            self.loops.correct(mechanism, next, x)?;
        }
        Ok(())
    }
}

impl Stepper {
    pub(crate) fn new(
        dynamics: &Dynamics,
        dt: f64,
        substeps: u32,
        (rows, states): (Option<usize>, &[f64]),
    ) -> Result<Self, NotCompiled> {
        let n_state = dynamics.n_x + dynamics.n_u;
        let states: Vec<_> = states.chunks(n_state.max(1)).map(|state| dynamics.whole(state)).collect();
        let is_tree = dynamics.mechanism.joint_layout().closure_rows.is_empty();
        let thread = Thread {
            pair: (is_tree && states.len() > 1).then(|| Pair::of(dynamics)).transpose()?,
            method: Rk4::new(&dynamics.mechanism.joint_start()),
            loops: CloseLoops::new(&dynamics.mechanism),
            dynamics: dynamics.clone(),
        };
        let n_threads = states.len().div_ceil(SHARE).clamp(1, rayon::current_num_threads());
        let threads = vec![thread; n_threads];
        let steps =
            Steps { dt, substeps: substeps.max(1), done: 0, from: 0.0, n_state, rows, states, threads };
        Ok(Self(Mutex::new(steps)))
    }
}

impl Steps {
    #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
    fn time(&self) -> f64 {
        self.from + self.done as f64 * (self.dt / f64::from(self.substeps))
    }

    /// Advances all states; `own` has the inputs of each, if they are not the same for all.
    fn step(&mut self, own: Option<&[f64]>) -> Result<(), Error> {
        let h = self.dt / f64::from(self.substeps);
        let end = self.done + u64::from(self.substeps);
        let steps = ((self.from, h), self.done..end);
        let n_inputs = self.threads[0].dynamics.defaults.len();
        if let [thread] = &mut self.threads[..] {
            thread.advance(&steps, &mut self.states, own)?;
        } else {
            // Even, so that pairs do not straddle.
            let share = self.states.len().div_ceil(self.threads.len()).next_multiple_of(2).max(2);
            let parts = self.states.par_chunks_mut(share).zip(self.threads.par_iter_mut());
            parts.enumerate().try_for_each(|(part, (states, thread))| {
                thread.advance(&steps, states, own.map(|own| &own[part * share * n_inputs..]))
            })?;
        }
        self.done = end;
        Ok(())
    }

    /// The states as an array, or written into one.
    fn show<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.states.len(), self.n_state];
        let shape = if self.rows.is_some() { &shape[..] } else { &shape[1..] };
        let out = match out {
            None => PyArrayDyn::zeros(py, shape, false),
            Some(out) => result(py, out, shape)?,
        };
        let mut numbers = out.try_readwrite()?;
        for (to, from) in numbers.as_slice_mut()?.chunks_exact_mut(self.n_state.max(1)).zip(&self.states) {
            to.copy_from_slice(&from[..self.n_state]);
        }
        drop(numbers);
        Ok(out)
    }

    /// Sets the inputs that are the same for all; gives those of each state otherwise.
    fn set_inputs<'a>(
        &mut self,
        py: Python<'_>,
        inputs: &'a PyReadonlyArrayDyn<'_, f64>,
    ) -> PyResult<Option<&'a [f64]>> {
        let n_inputs = self.threads[0].dynamics.defaults.len();
        let values = slice(inputs);
        match rows(py, "inputs", inputs.shape(), n_inputs)? {
            None => {
                self.threads.iter_mut().for_each(|thread| thread.set_inputs(values));
                Ok(None)
            }
            found if found == self.rows => Ok(Some(values)),
            found => {
                let words =
                    format!("inputs have {} rows: one for each state was expected", found.unwrap_or(1));
                Err(errors::request(py, &words))
            }
        }
    }
}

#[pymethods]
impl Stepper {
    /// Takes a step and returns the state (x, u): shape (n,), or (rows, n) of many, which advance on all cores.
    ///
    /// inputs: (inputs,), or (rows, inputs); they are held over the step, and stay as they are until others are given.
    /// out: a float64 array in C order that receives the state and is returned.
    #[pyo3(signature = (inputs=None, out=None))]
    fn step<'py>(
        &self,
        py: Python<'py>,
        inputs: Option<&Bound<'py, PyAny>>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let inputs = inputs.map(doubles).transpose()?;
        let mut steps = self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
        let own = match &inputs {
            Some(inputs) => steps.set_inputs(py, inputs)?,
            None => None,
        };
        let stepped = match steps.rows {
            None => steps.step(own),
            Some(_) => {
                let steps = &mut *steps;
                py.detach(|| steps.step(own))
            }
        };
        stepped.map_err(|error| {
            let mechanism = &steps.threads[0].dynamics.mechanism;
            errors::run(py, &describe_in(mechanism, Some(mechanism.joint_layout()), &error))
        })?;
        steps.show(py, out)
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let steps = self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
        let many = steps.rows.map_or(String::new(), |rows| format!(" of {rows} states"));
        format!("<Stepper{many}: steps of {} s, at t = {} s>", steps.dt, steps.time())
    }

    /// The time, s.
    #[getter]
    fn t(&self, py: Python<'_>) -> f64 {
        self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner).time()
    }

    /// Length of a step, s.
    #[getter]
    fn dt(&self, py: Python<'_>) -> f64 {
        self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner).dt
    }

    /// (x, u) now.
    #[getter]
    fn state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner).show(py, None)
    }

    /// Goes on from another state, or others, at a time, with the model file's inputs.
    #[pyo3(signature = (state, t=0.0))]
    fn restart(&self, py: Python<'_>, state: &Bound<'_, PyAny>, t: f64) -> PyResult<()> {
        let given = doubles(state)?;
        let mut steps = self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
        let n_state = steps.n_state;
        if rows(py, "state", given.shape(), n_state)? != steps.rows {
            let words =
                format!("state has the shape {:?}: that of the stepper's state was expected", given.shape());
            return Err(errors::request(py, &words));
        }
        let numbers = slice(&given).chunks_exact(n_state.max(1));
        steps.states.iter_mut().zip(numbers).for_each(|(state, from)| state[..n_state].copy_from_slice(from));
        for thread in &mut steps.threads {
            let defaults = thread.dynamics.defaults.clone();
            thread.set_inputs(&defaults);
        }
        (steps.from, steps.done) = (t, 0);
        Ok(())
    }
}
