//! Functions of many states that cargo compiled: the one place where a library is loaded and called.
#![allow(
    unsafe_code,
    reason = "a library's functions can be called in no other way; each use says why it is sound"
)]

use gyro_cli::failure::Failure;
use gyro_runner::batch::Inputs;
use libloading::Library;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Time, number of states, whether each has its own inputs; parameters, inputs, x, u; results.
type Accelerations = unsafe extern "C" fn(f64, usize, u8, &[*const f64; 4], *mut f64);

/// When steps are counted from and their length; the first and the one after the last; number of states, whether each
/// has its own inputs; parameters, inputs; states.
type Advance = unsafe extern "C" fn(&[f64; 2], &[u64; 2], usize, u8, &[*const f64; 2], *mut f64);

/// A library of `gyro_cli::library::batches`. Clones share it.
#[derive(Clone, Debug)]
pub(crate) struct ByCargo {
    accelerations: Accelerations,
    advance: Advance,
    /// Numbers of coordinates, rates, parameters and inputs.
    sizes: [usize; 4],
    /// What the functions are part of.
    _library: Arc<Library>,
}

impl ByCargo {
    /// Loads the library of a mechanism of these sizes.
    pub(crate) fn load(path: &Path, sizes: [usize; 4]) -> Result<Self, Failure> {
        let failed = |error| Failure::Run(format!("{}: {error}", path.display()));
        // SAFETY: it was compiled for this mechanism from generated text, and has nothing that runs when it is loaded.
        let library = unsafe { Library::new(path) }.map_err(failed)?;
        // SAFETY: `cli/src/batches.rs` writes the functions with these signatures, of numbers as C has them.
        let (accelerations, advance) = unsafe {
            let accelerations = *library.get::<Accelerations>(b"gyro_accelerations\0").map_err(failed)?;
            (accelerations, *library.get::<Advance>(b"gyro_advance\0").map_err(failed)?)
        };
        Ok(Self { accelerations, advance, sizes, _library: Arc::new(library) })
    }

    /// u̇ of many states.
    pub(crate) fn accelerations(
        &self,
        t: f64,
        (parameters, inputs): (&[f64], Inputs<'_>),
        (x, u): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let [n_x, n_u, ..] = self.sizes;
        let rows = out.len() / n_u.max(1);
        assert_eq!([x.len(), u.len(), out.len()], [rows * n_x, rows * n_u, rows * n_u], "rows of states");
        let (given, are_own) = self.given(parameters, inputs, rows);
        let arrays = [parameters.as_ptr(), given.as_ptr(), x.as_ptr(), u.as_ptr()];
        // SAFETY: all arrays have the lengths that were compared above and in `given`; the last alone is written, and it
        // is borrowed mutably. The library is there as long as `self` is.
        unsafe { (self.accelerations)(t, rows, are_own, &arrays, out.as_mut_ptr()) }
    }

    /// Many states by these steps.
    pub(crate) fn advance(
        &self,
        (from, h): (f64, f64),
        steps: &Range<u64>,
        (parameters, inputs): (&[f64], Inputs<'_>),
        states: &mut [f64],
    ) {
        let n = self.sizes[0] + self.sizes[1];
        let rows = states.len() / n.max(1);
        assert_eq!(states.len(), rows * n, "rows of states");
        let (given, are_own) = self.given(parameters, inputs, rows);
        let arrays = [parameters.as_ptr(), given.as_ptr()];
        let steps = [steps.start, steps.end];
        // SAFETY: as above.
        unsafe { (self.advance)(&[from, h], &steps, rows, are_own, &arrays, states.as_mut_ptr()) }
    }

    /// The inputs, and whether each state has its own.
    fn given<'a>(&self, parameters: &[f64], inputs: Inputs<'a>, rows: usize) -> (&'a [f64], u8) {
        let [.., n_parameters, n_inputs] = self.sizes;
        let (given, are_own, n_rows) = match inputs {
            Inputs::Same(values) => (values, 0, 1),
            Inputs::Own(values) => (values, 1, rows),
        };
        assert_eq!(
            [parameters.len(), given.len()],
            [n_parameters, n_rows * n_inputs],
            "parameters and inputs"
        );
        (given, are_own)
    }
}
