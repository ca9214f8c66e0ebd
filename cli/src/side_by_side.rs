//! Work on all processors.

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Of the generator and the verifier: expressions are walked by recursion.
const STACK: usize = 64 << 20;

/// What a function gives for each of so many, in their order; each is taken up by whichever thread is free.
///
/// # Panics
/// If the function does.
pub(crate) fn side_by_side<R: Send>(count: usize, of: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= count {
                return done;
            }
            done.push((index, of(index)));
        }
    };
    let n_threads = thread::available_parallelism().map_or(1, NonZeroUsize::get).min(count);
    let mut done: Vec<(usize, R)> = thread::scope(|scope| {
        let begin = |_| thread::Builder::new().stack_size(STACK).spawn_scoped(scope, work);
        let threads: Vec<_> =
            (0..n_threads).map(begin).collect::<Result<_, _>>().expect("the system has threads");
        let results =
            threads.into_iter().map(|thread| thread.join().unwrap_or_else(|e| std::panic::resume_unwind(e)));
        results.flatten().collect()
    });
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::side_by_side;

    #[test]
    fn results_have_their_order() {
        let squares = side_by_side(1000, |n| n * n);
        assert!(squares.iter().enumerate().all(|(n, square)| *square == n * n) && squares.len() == 1000);
        assert!(side_by_side(0, |n| n).is_empty());
    }
}
