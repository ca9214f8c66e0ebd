//! Compiled code, called: the one file of the project where code runs that rustc has not checked together with its
//! caller. Kernels that Cranelift compiled are [`Code`], a library that cargo compiled is a [`Library`].
#![allow(unsafe_code, reason = "compiled code can be called in no other way; each use says why it is sound")]

use crate::engine::Arguments;
use crate::native::Native;
use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use gyro_codegen::Kernel;
use gyro_model::Spline;
use gyro_runner::batch::{BLOCK, Inputs};
use std::fmt;
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, Mutex};

/// The time, then the arrays in the order of [`crate::clif::ARRAYS`].
type Address<T> =
    unsafe extern "C" fn(<T as Native>::Time, *const T, *const T, *const T, *const T, *mut T, *mut T);

/// What [`Code`] is made of: a function of its module that has the signature of [`crate::clif::Width::of_kernel`].
pub(crate) struct Finished {
    pub(crate) kernel: Kernel,
    pub(crate) id: FuncId,
    /// How much of each array it reads or writes.
    pub(crate) reach: [usize; 6],
    /// Length of its work space.
    pub(crate) n_work: usize,
    pub(crate) reads_curves: bool,
}

/// A compiled kernel.
pub(crate) struct Function<T: Native> {
    address: Address<T>,
    reach: [usize; 6],
    pub(crate) n_work: usize,
    pub(crate) reads_curves: bool,
    /// Whether it needs nothing but its arguments: neither work space nor curves.
    pub(crate) is_plain: bool,
}

impl<T: Native> Function<T> {
    /// Calls it after comparing the lengths of all arrays with its reach; `tables` and `work` are those of a kernel
    /// that is not plain.
    #[inline(always)]
    pub(crate) fn call(&self, kernel: Kernel, arguments: Arguments<'_, T>, beside: Option<(&[T], &mut [T])>) {
        let Arguments { t, state, given, own, out } = arguments;
        let [of_state, of_given, of_own, of_tables, of_work, of_out] = self.reach;
        let is_short = (state.len() < of_state)
            | (given.len() < of_given)
            | (own.len() < of_own)
            | (out.len() < of_out)
            | match &beside {
                Some((tables, work)) => (tables.len() < of_tables) | (work.len() < of_work),
                None => !self.is_plain,
            };
        if is_short {
            short(kernel, &self.reach);
        }
        let [state, given, own] = [state, given, own].map(<[T]>::as_ptr);
        let (tables, work) = beside
            .map_or((state, std::ptr::null_mut()), |(tables, work)| (tables.as_ptr(), work.as_mut_ptr()));
        // SAFETY: the function reads and writes no more of each array than `reach`, which was counted as its loads and
        // stores were written and is within the arrays' lengths (zero for the tables and the work space of plain
        // ones); it writes to the last two alone, which are borrowed mutably; it keeps no address. The code is alive
        // as `Code`, which owns both, is.
        unsafe { (self.address)(t.time(), state, given, own, tables, work, out.as_mut_ptr()) }
    }
}

/// A caller's mistake, kept out of the way of calls.
#[cold]
#[inline(never)]
fn short(kernel: Kernel, reach: &[usize; 6]) -> ! {
    panic!("{}: buffers of fewer numbers than {reach:?}", kernel.name())
}

/// The machine code of all kernels of a mechanism.
pub(crate) struct Code<T: Native> {
    /// By kernel.
    pub(crate) functions: Vec<Option<Function<T>>>,
    /// Constants of loops.
    pub(crate) tables: Vec<T>,
    /// What functions of curves have the addresses of.
    _curves: Box<[Spline]>,
    /// What the functions are part of; always there until it is dropped.
    module: Mutex<Option<JITModule>>,
}

impl<T: Native> Code<T> {
    /// Of a module whose functions are final.
    pub(crate) fn new(
        module: JITModule,
        finished: &[Finished],
        (tables, curves): (Vec<T>, Box<[Spline]>),
    ) -> Self {
        let mut functions: Vec<Option<Function<T>>> = Kernel::all().map(|_| None).collect();
        for &Finished { kernel, id, reach, n_work, reads_curves } in finished {
            let address = module.get_finalized_function(id);
            // SAFETY: the address is that of a function with this signature, as `Finished` says; it is only called
            // while `module`, which owns the memory, is alive.
            let address = unsafe { std::mem::transmute::<*const u8, Address<T>>(address) };
            let [_, _, _, of_tables, of_work, _] = reach;
            let is_plain = !reads_curves && of_tables == 0 && of_work == 0;
            functions[kernel as usize] = Some(Function { address, reach, n_work, reads_curves, is_plain });
        }
        Self { functions, tables, _curves: curves, module: Mutex::new(Some(module)) }
    }
}

impl<T: Native> Drop for Code<T> {
    fn drop(&mut self) {
        let module = self.module.get_mut().map(Option::take);
        if let Ok(Some(module)) = module {
            // SAFETY: this was the last owner of the code, so none of its functions runs or will be called.
            unsafe { module.free_memory() }
        }
    }
}

/// Time and number of states; parameters, then row after row inputs, x, u and results.
type Accelerations =
    unsafe extern "C" fn(f64, usize, *const f64, *const f64, *const f64, *const f64, *mut f64);

/// When steps are counted from and their length; the first and the one after the last; number of states; parameters,
/// then row after row inputs and states.
type Advance = unsafe extern "C" fn(f64, f64, u64, u64, usize, *const f64, *const f64, *mut f64);

/// How many numbers of each kind a mechanism has.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// Coordinates of a joint state.
    pub x: usize,
    /// Its rates.
    pub u: usize,
    /// Parameters.
    pub parameters: usize,
    /// Inputs.
    pub inputs: usize,
}

/// Functions of many states in a library that cargo compiled: what `gyro_cli::library::batches` makes. Clones share it.
#[derive(Clone, Debug)]
pub struct Library {
    accelerations: Accelerations,
    advance: Advance,
    sizes: Sizes,
    /// What the functions are part of.
    _library: Arc<libloading::Library>,
}

/// A library is none of a mechanism.
#[derive(Debug)]
pub struct NotLoaded(libloading::Error);

impl fmt::Display for NotLoaded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the library cannot be loaded: {}", self.0)
    }
}

impl std::error::Error for NotLoaded {}

impl From<libloading::Error> for NotLoaded {
    fn from(error: libloading::Error) -> Self {
        Self(error)
    }
}

impl Library {
    /// Loads the library of a mechanism of these sizes.
    ///
    /// # Errors
    /// [`NotLoaded`]: there is none, or none of this machine.
    pub fn load(path: &Path, sizes: Sizes) -> Result<Self, NotLoaded> {
        // SAFETY: it was compiled for this mechanism from generated text, and has nothing that runs when it is loaded.
        let library = unsafe { libloading::Library::new(path) }?;
        // SAFETY: the generated text has the functions with these signatures, of numbers as C has them; its references
        // to arrays of fixed lengths are addresses.
        let (accelerations, advance) = unsafe {
            let accelerations = *library.get::<Accelerations>(b"gyro_accelerations\0")?;
            (accelerations, *library.get::<Advance>(b"gyro_advance\0")?)
        };
        Ok(Self { accelerations, advance, sizes, _library: Arc::new(library) })
    }

    /// Writes u̇ of many states at a time, s, row after row.
    ///
    /// # Panics
    /// An array has not as many numbers as the mechanism asks for.
    pub fn accelerations(
        &self,
        t: f64,
        (parameters, inputs): (&[f64], Inputs<'_>),
        (x, u): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        let Sizes { x: n_x, u: n_u, inputs: n_inputs, .. } = self.sizes;
        let n = out.len() / n_u.max(1);
        self.compare(n, parameters, inputs);
        assert_eq!([x.len(), u.len(), out.len()], [n * n_x, n * n_u, n * n_u], "rows of states");
        let [mut of_inputs, mut of_x, mut of_u, mut of_out] = [(); 4].map(|()| Vec::new());
        for rows in blocks(n) {
            let given = whole(inputs.of(rows.clone(), n_inputs), &rows, n_inputs, &mut of_inputs);
            let x = whole(Inputs::Own(&x[rows.start * n_x..rows.end * n_x]), &rows, n_x, &mut of_x);
            let u = whole(Inputs::Own(&u[rows.start * n_u..rows.end * n_u]), &rows, n_u, &mut of_u);
            whole_out(&mut out[rows.start * n_u..rows.end * n_u], n_u, &mut of_out, |out| {
                let (parameters, given) = (parameters.as_ptr(), given.as_ptr());
                // SAFETY: the parameters have the length that was compared, all others those of a block; the last
                // alone is written, and it is borrowed mutably. The library is there as long as `self` is.
                unsafe {
                    let (x, u) = (x.as_ptr(), u.as_ptr());
                    (self.accelerations)(t, rows.len(), parameters, given, x, u, out.as_mut_ptr());
                }
            });
        }
    }

    /// Advances many states (x, u) of a tree, row after row, by these steps of a length, counted from a time, s.
    ///
    /// # Panics
    /// As [`Library::accelerations`].
    pub fn advance(
        &self,
        (from, h): (f64, f64),
        steps: &Range<u64>,
        (parameters, inputs): (&[f64], Inputs<'_>),
        states: &mut [f64],
    ) {
        let (n_state, n_inputs) = (self.sizes.x + self.sizes.u, self.sizes.inputs);
        let n = states.len() / n_state.max(1);
        self.compare(n, parameters, inputs);
        assert_eq!(states.len(), n * n_state, "rows of states");
        let [mut of_inputs, mut of_states] = [(); 2].map(|()| Vec::new());
        for rows in blocks(n) {
            let given = whole(inputs.of(rows.clone(), n_inputs), &rows, n_inputs, &mut of_inputs);
            let states = &mut states[rows.start * n_state..rows.end * n_state];
            whole_out(states, n_state, &mut of_states, |states| {
                let (parameters, given, states) = (parameters.as_ptr(), given.as_ptr(), states.as_mut_ptr());
                // SAFETY: as above.
                unsafe {
                    (self.advance)(from, h, steps.start, steps.end, rows.len(), parameters, given, states);
                }
            });
        }
    }

    /// Refuses parameters and inputs of other numbers.
    fn compare(&self, n: usize, parameters: &[f64], inputs: Inputs<'_>) {
        let found = match inputs {
            Inputs::Same(values) => (parameters.len(), values.len()),
            Inputs::Own(values) if n == 0 => (parameters.len(), self.sizes.inputs + values.len()),
            Inputs::Own(values) if values.len() % n == 0 => (parameters.len(), values.len() / n),
            Inputs::Own(_) => (parameters.len(), usize::MAX),
        };
        assert_eq!(found, (self.sizes.parameters, self.sizes.inputs), "parameters and inputs");
    }
}

/// Rows, so many at a time as the functions of libraries take.
fn blocks(n: usize) -> impl Iterator<Item = Range<usize>> {
    (0..n).step_by(BLOCK).map(move |first| first..(first + BLOCK).min(n))
}

/// Numbers of some rows as those of a whole block, what is missing being zero.
fn whole<'a>(numbers: Inputs<'a>, rows: &Range<usize>, n: usize, room: &'a mut Vec<f64>) -> &'a [f64] {
    match numbers {
        Inputs::Own(own) if rows.len() == BLOCK => own,
        Inputs::Own(own) => {
            room.clear();
            room.extend_from_slice(own);
            room.resize(BLOCK * n, 0.0);
            room
        }
        Inputs::Same(same) => {
            if room.is_empty() {
                *room = same.repeat(BLOCK);
            }
            room
        }
    }
}

/// The same for what is written.
fn whole_out(numbers: &mut [f64], n: usize, room: &mut Vec<f64>, call: impl FnOnce(&mut [f64])) {
    if numbers.len() == BLOCK * n {
        return call(numbers);
    }
    room.clear();
    room.extend_from_slice(numbers);
    room.resize(BLOCK * n, 0.0);
    call(room);
    numbers.copy_from_slice(&room[..numbers.len()]);
}
