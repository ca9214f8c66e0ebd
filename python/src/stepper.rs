//! Steps in a loop.

use crate::arguments::{doubles, result, rows, slice, tuple, writable};
use crate::batch::{Many, PACK, threads};
use crate::dynamics::Dynamics;
use crate::errors;
use gyro_jit::{Compiled, NotCompiled};
use gyro_runner::batch::Inputs;
use gyro_runner::describe_in;
use gyro_sim::{CloseLoops, Error, Joint, JointSpace, Rk4};
use numpy::{PyArrayDyn, PyReadonlyArrayDyn, PyUntypedArrayMethods};
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
    /// The inputs of each state, if they are not the same for all.
    own: Option<Vec<f64>>,
    threads: Vec<Thread>,
}

/// What one thread works with.
#[derive(Clone)]
struct Thread {
    dynamics: Dynamics,
    method: Rk4<Vec<f64>>,
    loops: CloseLoops<Compiled<f64>>,
    /// For many states of a mechanism without loops, with these row after row.
    many: Option<(Many, Vec<f64>)>,
}

/// Fewer states than these are not worth another thread.
const SHARE: usize = 64;

/// How many substeps of a state are taken before Python is asked for signals: some milliseconds.
const AT_ONCE: u64 = 1 << 15;

/// When steps begin, s, their length, and which ones are to be taken.
type Steppings = ((f64, f64), Range<u64>);

impl Thread {
    /// All states by some steps; `own` has the inputs of each, if they are not the same for all.
    fn advance(
        &mut self,
        steps: &Steppings,
        states: &mut [Vec<f64>],
        own: Option<&[f64]>,
    ) -> Result<(), Error> {
        let n_inputs = self.dynamics.defaults.len();
        if let Some((many, rows)) = &mut self.many {
            let n = (self.dynamics.n_x + self.dynamics.n_u).max(1);
            rows.resize(states.len() * n, 0.0);
            rows.chunks_exact_mut(n).zip(&*states).for_each(|(to, from)| to.copy_from_slice(&from[..n]));
            let inputs = match own {
                Some(own) => Inputs::Own(own).of(0..states.len(), n_inputs),
                None => Inputs::Same(self.dynamics.inputs()),
            };
            many.advance(steps.0, &steps.1, inputs, rows);
            states.iter_mut().zip(rows.chunks_exact(n)).for_each(|(to, from)| to[..n].copy_from_slice(from));
            return Ok(());
        }
        for (row, x) in states.iter_mut().enumerate() {
            if let Some(own) = own {
                self.dynamics.set_inputs(&own[row * n_inputs..][..n_inputs]);
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
        (dt, substeps): (f64, u32),
        (rows, states): (Option<usize>, &[f64]),
        by_cargo: Option<Many>,
    ) -> Result<Self, NotCompiled> {
        let n_state = dynamics.n_x + dynamics.n_u;
        let states: Vec<_> = states.chunks(n_state.max(1)).map(|state| dynamics.whole(state)).collect();
        let is_tree = dynamics.mechanism.joint_layout().closure_rows.is_empty();
        let many = match by_cargo {
            _ if !is_tree || states.len() < 2 => None,
            None => Some(Many::in_process(dynamics)?),
            by_cargo => by_cargo,
        };
        let thread = Thread {
            many: many.map(|many| (many, Vec::new())),
            method: Rk4::new(&dynamics.mechanism.joint_start()),
            loops: CloseLoops::new(&dynamics.mechanism),
            dynamics: dynamics.clone(),
        };
        let n_threads = match states.len().div_ceil(SHARE) {
            0 | 1 => 1,
            shares => shares.min(threads().current_num_threads()),
        };
        let threads = vec![thread; n_threads];
        let steps = Steps {
            dt,
            substeps: substeps.max(1),
            done: 0,
            from: 0.0,
            n_state,
            rows,
            states,
            own: None,
            threads,
        };
        Ok(Self(Mutex::new(steps)))
    }
}

impl Steps {
    #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
    fn time(&self) -> f64 {
        self.from + self.done as f64 * (self.dt / f64::from(self.substeps))
    }

    /// Advances all states by some substeps.
    fn step(&mut self, substeps: u64) -> Result<(), Error> {
        let h = self.dt / f64::from(self.substeps);
        let end = self.done + substeps;
        let steps = ((self.from, h), self.done..end);
        let n_inputs = self.threads[0].dynamics.defaults.len();
        let own = self.own.as_deref();
        if let [thread] = &mut self.threads[..] {
            thread.advance(&steps, &mut self.states, own)?;
        } else {
            // Whole packs, so that none straddles.
            let share = self.states.len().div_ceil(self.threads.len()).next_multiple_of(PACK).max(PACK);
            let parts = self.states.par_chunks_mut(share).zip(self.threads.par_iter_mut());
            threads().install(|| {
                parts.enumerate().try_for_each(|(part, (states, thread))| {
                    thread.advance(&steps, states, own.map(|own| &own[part * share * n_inputs..]))
                })
            })?;
        }
        self.done = end;
        Ok(())
    }

    /// Takes some substeps; without the interpreter's lock where it takes longer than to give it back.
    fn take(&mut self, py: Python<'_>, substeps: u64) -> PyResult<()> {
        let taken = match self.rows {
            None if substeps < AT_ONCE => self.step(substeps),
            _ => py.detach(|| self.step(substeps)),
        };
        taken.map_err(|error| {
            let mechanism = &self.threads[0].dynamics.mechanism;
            errors::run(py, &describe_in(mechanism, Some(mechanism.joint_layout()), error))
        })
    }

    /// An array for the states: the caller's, if it has one.
    fn room<'py>(
        &self,
        py: Python<'py>,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = [self.states.len(), self.n_state];
        let shape = if self.rows.is_some() { &shape[..] } else { &shape[1..] };
        let Some(out) = out else { return Ok(PyArrayDyn::zeros(py, shape, false)) };
        let out = result(py, out, shape)?;
        writable(&out)?;
        Ok(out)
    }

    /// Writes the states into an array of this shape.
    fn show(&self, out: &Bound<'_, PyArrayDyn<f64>>) -> PyResult<()> {
        let mut numbers = writable(out)?;
        for (to, from) in numbers.as_slice_mut()?.chunks_exact_mut(self.n_state.max(1)).zip(&self.states) {
            to.copy_from_slice(&from[..self.n_state]);
        }
        Ok(())
    }

    /// Sets the inputs: the same for all, or those of each state.
    fn set_inputs(&mut self, py: Python<'_>, inputs: &PyReadonlyArrayDyn<'_, f64>) -> PyResult<()> {
        let n_inputs = self.threads[0].dynamics.defaults.len();
        let values = slice(inputs);
        self.own = match rows(py, "inputs", inputs.shape(), n_inputs)? {
            None => {
                self.threads.iter_mut().for_each(|thread| thread.dynamics.set_inputs(values));
                None
            }
            found if found == self.rows => Some(values.to_vec()),
            found => {
                let words =
                    format!("inputs have {} rows: one for each state was expected", found.unwrap_or(1));
                return Err(errors::request(py, &words));
            }
        };
        Ok(())
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
        // Nothing moves if this cannot be told.
        let out = steps.room(py, out)?;
        if let Some(inputs) = &inputs {
            steps.set_inputs(py, inputs)?;
        }
        let substeps = u64::from(steps.substeps);
        let at_once = (AT_ONCE / steps.states.len().max(1) as u64).clamp(1, substeps);
        let before = (at_once < substeps).then(|| (steps.done, steps.states.clone()));
        let mut left = substeps;
        loop {
            steps.take(py, at_once.min(left))?;
            left = left.saturating_sub(at_once);
            if left == 0 {
                steps.show(&out)?;
                return Ok(out);
            }
            if let Err(signal) = py.check_signals() {
                if let Some(before) = before {
                    (steps.done, steps.states) = before;
                }
                return Err(signal);
            }
        }
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
        let steps = self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
        let out = steps.room(py, None)?;
        steps.show(&out)?;
        Ok(out)
    }

    /// Goes on from another state, or others, at a time, with the model file's inputs.
    #[pyo3(signature = (state, t=0.0))]
    fn restart(&self, py: Python<'_>, state: &Bound<'_, PyAny>, t: f64) -> PyResult<()> {
        let given = doubles(state)?;
        let mut steps = self.0.lock_py_attached(py).unwrap_or_else(PoisonError::into_inner);
        let n_state = steps.n_state;
        if rows(py, "state", given.shape(), n_state)? != steps.rows {
            let words = format!(
                "a state of shape {}: that of the stepper's state was expected",
                tuple(given.shape())
            );
            return Err(errors::request(py, &words));
        }
        let numbers = slice(&given).chunks_exact(n_state.max(1));
        steps.states.iter_mut().zip(numbers).for_each(|(state, from)| state[..n_state].copy_from_slice(from));
        for thread in &mut steps.threads {
            let defaults = thread.dynamics.defaults.clone();
            thread.dynamics.set_inputs(&defaults);
        }
        (steps.own, steps.from, steps.done) = (None, t, 0);
        Ok(())
    }
}
