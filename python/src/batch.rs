//! Many states at once.

use crate::dynamics::Dynamics;
use gyro_jit::{Compiled, Library, NotCompiled};
use gyro_runner::batch::{self, Inputs};
use gyro_sim::lanes::f64x2;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::ops::Range;
use std::process;
use std::sync::{Arc, Mutex, PoisonError};

/// Fewer states than these are not worth another thread.
const SHARE: usize = 256;

/// States in a pack at most: parts of a batch are whole packs, but for the last one.
pub(crate) const PACK: usize = 8;

/// What computes many states, in packs.
#[derive(Clone, Debug)]
pub(crate) enum Many {
    /// Compiled in the process for two lanes.
    InProcess(Compiled<f64x2>),
    /// Compiled by cargo for eight, with the values of the parameters.
    ByCargo(Library, Vec<f64>),
}

impl Many {
    /// With the parameters as they are.
    pub(crate) fn in_process(dynamics: &Dynamics) -> Result<Self, NotCompiled> {
        dynamics.mechanism.compiled().map(Self::InProcess)
    }

    /// The same by what cargo compiled.
    pub(crate) fn by_cargo(compiled: Library, dynamics: &Dynamics) -> Self {
        Self::ByCargo(compiled, dynamics.mechanism.parameters().to_vec())
    }

    /// Sets a parameter for all states.
    pub(crate) fn set_parameter(&mut self, index: usize, value: f64) {
        match self {
            Self::InProcess(mechanism) => {
                mechanism.set_parameter(index, f64x2::splat(value));
            }
            Self::ByCargo(_, parameters) => parameters[index] = value,
        }
    }

    fn accelerations(&mut self, t: f64, inputs: Inputs<'_>, of: (&[f64], &[f64]), out: &mut [f64]) {
        match self {
            Self::InProcess(mechanism) => batch::accelerations(mechanism, t, inputs, of, out),
            Self::ByCargo(compiled, parameters) => compiled.accelerations(t, (parameters, inputs), of, out),
        }
    }

    /// States (x, u) of a tree by these steps of length h, counted from a time.
    pub(crate) fn advance(
        &mut self,
        from_and_h: (f64, f64),
        steps: &Range<u64>,
        inputs: Inputs<'_>,
        states: &mut [f64],
    ) {
        match self {
            Self::InProcess(mechanism) => batch::advance(mechanism, from_and_h, steps, inputs, states),
            Self::ByCargo(compiled, parameters) => {
                compiled.advance(from_and_h, steps, (parameters, inputs), states);
            }
        }
    }
}

/// Arguments and results of many states, row after row.
pub(crate) struct Batch<'a> {
    pub(crate) t: f64,
    pub(crate) x: &'a [f64],
    pub(crate) u: &'a [f64],
    pub(crate) inputs: Inputs<'a>,
    pub(crate) out: &'a mut [f64],
}

/// The threads of this process: one that was forked has none of its parent's.
static THREADS: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// A thread for each core.
pub(crate) fn threads() -> Arc<ThreadPool> {
    let mut threads = THREADS.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((of, pool)) = &*threads
        && *of == process::id()
    {
        return pool.clone();
    }
    // Of a parent's nothing is left that could be waited for.
    std::mem::forget(threads.take());
    let pool = Arc::new(ThreadPoolBuilder::new().build().expect("threads can be started"));
    *threads = Some((process::id(), pool.clone()));
    pool
}

/// The accelerations of many states of these sizes (x, u, inputs), on all cores. The pool grows to one for each thread.
pub(crate) fn accelerations(pool: &mut Vec<Many>, [n_x, n_u, n_inputs]: [usize; 3], batch: Batch<'_>) {
    if pool.is_empty() || n_u == 0 {
        return;
    }
    let (n, threads) = (batch.out.len() / n_u, threads());
    let share = n.div_ceil(threads.current_num_threads()).max(SHARE).next_multiple_of(PACK);
    while pool.len() < n.div_ceil(share) {
        pool.push(pool[0].clone());
    }
    let Batch { t, x, u, inputs, out } = batch;
    let compute = |(part, (out, many)): (usize, (&mut [f64], &mut Many))| {
        let rows = part * share..part * share + out.len() / n_u;
        let of = (&x[rows.start * n_x..rows.end * n_x], &u[rows.start * n_u..rows.end * n_u]);
        many.accelerations(t, inputs.of(rows, n_inputs), of, out);
    };
    if n <= share {
        return compute((0, (out, &mut pool[0])));
    }
    threads
        .install(|| out.par_chunks_mut(share * n_u).zip(pool.par_iter_mut()).enumerate().for_each(compute));
}
