//! Many states at once.

use crate::dynamics::Pair;
use rayon::prelude::*;

/// Fewer states than these are not worth another thread.
const SHARE: usize = 256;

/// Arguments and results of many states, row after row.
pub(crate) struct Batch<'a> {
    pub(crate) t: f64,
    pub(crate) x: &'a [f64],
    pub(crate) u: &'a [f64],
    /// Of each state its own.
    pub(crate) inputs: Inputs<'a>,
    pub(crate) out: &'a mut [f64],
}

/// The inputs of many states.
#[derive(Clone, Copy)]
pub(crate) enum Inputs<'a> {
    Same(&'a [f64]),
    Own(&'a [f64]),
}

impl<'a> Inputs<'a> {
    fn of(self, row: usize, n: usize) -> &'a [f64] {
        match self {
            Self::Same(inputs) => inputs,
            Self::Own(inputs) => &inputs[row * n..][..n],
        }
    }
}

/// The accelerations of many states of these sizes (x, u, inputs), two at a time and on all cores. The pool grows to
/// one for each thread.
pub(crate) fn accelerations(pool: &mut Vec<Pair>, [n_x, n_u, n_inputs]: [usize; 3], batch: Batch<'_>) {
    if pool.is_empty() || n_u == 0 {
        return;
    }
    let n = batch.out.len() / n_u;
    // Even, so that pairs do not straddle.
    let share = n.div_ceil(rayon::current_num_threads()).max(SHARE).next_multiple_of(2);
    while pool.len() < n.div_ceil(share) {
        pool.push(pool[0].clone());
    }
    let Batch { t, x, u, inputs, out } = batch;
    let parts = out.par_chunks_mut(share * n_u).zip(pool.par_iter_mut()).enumerate();
    parts.for_each(|(part, (out, pair))| {
        let mut odd = vec![0.0; n_u];
        for (k, out) in out.chunks_mut(2 * n_u).enumerate() {
            let first = part * share + 2 * k;
            // The last of an odd number is there twice.
            let rows = [first, (first + 1).min(n - 1)];
            pair.set_inputs(rows.map(|row| inputs.of(row, n_inputs)));
            let (x, u) = (rows.map(|row| &x[row * n_x..][..n_x]), rows.map(|row| &u[row * n_u..][..n_u]));
            let (one, other) = out.split_at_mut(n_u);
            let other = if other.is_empty() { &mut odd[..] } else { other };
            pair.accelerations(t, x, u, [one, other]);
        }
    });
}
