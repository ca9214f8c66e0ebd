//! Kernels as machine code: the one place where code that rustc has not checked is called.
#![allow(unsafe_code, reason = "compiled code can be called in no other way; each use says why it is sound")]

use crate::clif::{FUNCTIONS, Width, Writer};
use crate::engine::{Arguments, Engine, Layout, Shape, reads_curves, write_curves};
use cranelift_codegen::Context;
use cranelift_codegen::ir::UserFuncName;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, ModuleError};
use gyro_codegen::{Kernel, Scheduled};
use gyro_sim::Scalar;
use gyro_sim::lanes::f64x2;
use std::cell::RefCell;
use std::fmt;
use std::sync::{Arc, Mutex};

/// A number type that Cranelift compiles for: `f32`, `f64`, and `f64x2`, two lanes with the bits of two runs in `f64`.
pub trait Native: Scalar + Send + Sync + 'static {
    /// Bits of a number.
    const BITS: u32;
    /// How a time is passed: packs by their address.
    type Time;
    /// The time as it is passed.
    fn time(&self) -> Self::Time;
    /// The addresses of sine, cosine, hyperbolic tangent and angle, as a module that rustc compiles calls them.
    fn functions() -> [*const u8; 4];
}

// They do not unwind. Being allowed to, they are one jump to the function itself.

extern "C-unwind" fn sin<T: Scalar>(x: T) -> T {
    x.sin()
}

extern "C-unwind" fn cos<T: Scalar>(x: T) -> T {
    x.cos()
}

extern "C-unwind" fn tanh<T: Scalar>(x: T) -> T {
    x.tanh()
}

extern "C-unwind" fn atan2<T: Scalar>(y: T, x: T) -> T {
    y.atan2(x)
}

/// The lanes of a pack at an address, and a second pack after it, if the function takes two; the result takes the place
/// of the first.
extern "C" fn of_pair<const FUNCTION: usize>(at: *mut f64) {
    let pack = |n: usize| {
        // SAFETY: `Writer::call_by_address` has stored as many packs there as the function has arguments.
        f64x2::new([0, 1].map(|lane| unsafe { *at.add(2 * n + lane) }))
    };
    let found = match FUNCTION {
        0 => Scalar::sin(pack(0)),
        1 => Scalar::cos(pack(0)),
        2 => Scalar::tanh(pack(0)),
        _ => Scalar::atan2(pack(0), pack(1)),
    };
    for (lane, value) in found.to_array().into_iter().enumerate() {
        // SAFETY: as above; nobody else has the address of the function's own stack.
        unsafe { *at.add(lane) = value };
    }
}

impl Native for f64x2 {
    const BITS: u32 = 128;
    type Time = *const Self;
    fn time(&self) -> *const Self {
        self
    }
    fn functions() -> [*const u8; 4] {
        [
            of_pair::<0> as *const u8,
            of_pair::<1> as *const u8,
            of_pair::<2> as *const u8,
            of_pair::<3> as *const u8,
        ]
    }
}

impl Native for f64 {
    const BITS: u32 = 64;
    type Time = Self;
    fn time(&self) -> Self {
        *self
    }
    fn functions() -> [*const u8; 4] {
        [
            sin::<Self> as *const u8,
            cos::<Self> as *const u8,
            tanh::<Self> as *const u8,
            atan2::<Self> as *const u8,
        ]
    }
}

impl Native for f32 {
    const BITS: u32 = 32;
    type Time = Self;
    fn time(&self) -> Self {
        *self
    }
    fn functions() -> [*const u8; 4] {
        [
            sin::<Self> as *const u8,
            cos::<Self> as *const u8,
            tanh::<Self> as *const u8,
            atan2::<Self> as *const u8,
        ]
    }
}

/// What Cranelift is told. Tapes are in a good order, with each operation once: its own search for such an order takes
/// half of the time to compile, and what comes out is no quicker (`examples/beside_rustc`). What it is given is checked
/// in this crate's tests.
const FLAGS: [(&str, &str); 2] =
    [("opt_level", "none"), ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" })];

/// The time, then the arrays in the order of [`crate::clif::ARRAYS`].
type Function<T> =
    unsafe extern "C" fn(<T as Native>::Time, *const T, *const T, *const T, *const T, *mut T, *mut T);

/// A compiled kernel.
struct Compiled<T: Native> {
    function: Function<T>,
    /// How much of each array it reads or writes.
    reach: [usize; 6],
    n_work: usize,
    reads_curves: bool,
    /// Whether it needs nothing but its arguments: neither work space nor curves.
    is_plain: bool,
}

impl<T: Native> Compiled<T> {
    /// Calls it after comparing the lengths of all arrays with its reach; `tables` and `work` are those of a kernel
    /// that is not plain.
    #[inline(always)]
    fn call(&self, kernel: Kernel, arguments: Arguments<'_, T>, beside: Option<(&[T], &mut [T])>) {
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
        unsafe { (self.function)(t.time(), state, given, own, tables, work, out.as_mut_ptr()) }
    }
}

/// The machine code of all kernels of a mechanism.
struct Code<T: Native> {
    /// By kernel.
    functions: Vec<Option<Compiled<T>>>,
    /// Constants of loops.
    tables: Vec<T>,
    /// What the functions are part of; always there until it is dropped.
    module: Mutex<Option<JITModule>>,
}

/// Calls compiled kernels. Clones share the code.
#[derive(Clone)]
pub struct MachineCode<T: Native> {
    code: Arc<Code<T>>,
    /// Curves and arrays of loops. Borrowed inside each call and never across.
    work: RefCell<Vec<T>>,
}

impl<T: Native> fmt::Debug for MachineCode<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MachineCode").field("kernels", &self.code.functions.iter().flatten().count()).finish()
    }
}

/// A kernel on its way to machine code: what a proof is about.
#[derive(Debug)]
pub struct Input<'a> {
    /// Which one it is.
    pub kernel: Kernel,
    /// The function that Cranelift compiles, as text.
    pub clif: String,
    /// All constants of loops up to here, which functions read by their places.
    pub tables: &'a [f64],
}

/// Why there is no machine code.
#[derive(Debug)]
pub struct NotCompiled(String);

impl fmt::Display for NotCompiled {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the functions cannot be compiled in this process: {}", self.0)
    }
}

impl std::error::Error for NotCompiled {}

impl From<ModuleError> for NotCompiled {
    fn from(error: ModuleError) -> Self {
        Self(format!("{error:?}"))
    }
}

impl<T: Native> MachineCode<T> {
    /// Compiles all kernels; `told`, if there is someone to tell, hears of each what Cranelift is given.
    pub(crate) fn compile(
        scheduled: &Scheduled,
        layout: Layout,
        mut told: Option<&mut dyn FnMut(Input<'_>)>,
    ) -> Result<Self, NotCompiled> {
        let mut builder = JITBuilder::with_flags(&FLAGS, cranelift_module::default_libcall_names())?;
        for (name, address) in FUNCTIONS.iter().zip(T::functions()) {
            builder.symbol(symbol(name), address);
        }
        let mut compiler = Compiler::new(JITModule::new(builder), T::BITS, layout)?;
        let mut compiled = Vec::new();
        for &kernel in scheduled.kernels.keys() {
            compiled.push((kernel, compiler.kernel(scheduled, kernel, &mut told)?));
        }
        let Compiler { mut module, tables, .. } = compiler;
        module.finalize_definitions()?;
        let mut functions: Vec<Option<Compiled<T>>> = Kernel::all().map(|_| None).collect();
        for (kernel, (id, reach, n_work)) in compiled {
            let address = module.get_finalized_function(id);
            // SAFETY: the address is that of a function with this signature, which `Width::of_kernel` declares; it is
            // only called while `module`, which owns the memory, is alive.
            let function = unsafe { std::mem::transmute::<*const u8, Function<T>>(address) };
            let reads_curves = reads_curves(scheduled, kernel);
            let [_, _, _, of_tables, of_work, _] = reach;
            let is_plain = !reads_curves && of_tables == 0 && of_work == 0;
            functions[kernel as usize] = Some(Compiled { function, reach, n_work, reads_curves, is_plain });
        }
        let tables = tables.into_iter().map(T::constant).collect();
        let code = Code { functions, tables, module: Mutex::new(Some(module)) };
        Ok(Self { code: Arc::new(code), work: RefCell::default() })
    }
}

impl<T: Native> Engine<T> for MachineCode<T> {
    #[inline(always)]
    fn compute(&self, scheduled: &Scheduled, kernel: Kernel, arguments: Arguments<'_, T>) {
        // Taken apart, they stay in registers on the short way.
        let Arguments { t, state, given, own, out } = arguments;
        match &self.code.functions[kernel as usize] {
            Some(compiled) if compiled.is_plain => {
                compiled.call(kernel, Arguments { t, state, given, own, out }, None);
            }
            Some(compiled) => {
                self.compute_with_work(compiled, scheduled, kernel, Arguments { t, state, given, own, out });
            }
            None => (),
        }
    }
}

impl<T: Native> MachineCode<T> {
    /// Computes a kernel that reads curves or tables of loops.
    #[inline(never)]
    fn compute_with_work(
        &self,
        compiled: &Compiled<T>,
        scheduled: &Scheduled,
        kernel: Kernel,
        arguments: Arguments<'_, T>,
    ) {
        let mut work = self.work.borrow_mut();
        if work.len() < compiled.n_work {
            work.resize(compiled.n_work, T::constant(0.0));
        }
        if compiled.reads_curves {
            write_curves(scheduled, arguments.t, &mut work[..3 * scheduled.curves.len()]);
        }
        compiled.call(kernel, arguments, Some((&self.code.tables, &mut work)));
    }
}

/// A caller's mistake, kept out of the way of calls.
#[cold]
#[inline(never)]
fn short(kernel: Kernel, reach: &[usize; 6]) -> ! {
    panic!("{}: buffers of fewer numbers than {reach:?}", kernel.name())
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

/// The name under which an elementary function is found: not that of the C library's.
fn symbol(name: &str) -> String {
    format!("gyro_{name}")
}

/// Compiles one kernel after the other.
struct Compiler {
    module: JITModule,
    width: Width,
    layout: Layout,
    context: Context,
    functions: [FuncId; 4],
    tables: Vec<f64>,
}

impl Compiler {
    fn new(mut module: JITModule, bits: u32, layout: Layout) -> Result<Self, NotCompiled> {
        let width = match bits {
            32 => Width::Single,
            64 => Width::Double,
            _ => Width::Pair,
        };
        let target = module.target_config();
        let mut declare = |name: &str| {
            let signature = width.of_function(target.default_call_conv, target.pointer_type(), name);
            module.declare_function(&symbol(name), Linkage::Import, &signature).map_err(NotCompiled::from)
        };
        let [a, b, c, d] = FUNCTIONS.map(&mut declare);
        let functions = [a?, b?, c?, d?];
        let context = module.make_context();
        Ok(Self { module, width, layout, context, functions, tables: Vec::new() })
    }

    /// The function, how much of each array it reads or writes, and the length of its work space.
    fn kernel(
        &mut self,
        scheduled: &Scheduled,
        kernel: Kernel,
        told: &mut Option<&mut dyn FnMut(Input<'_>)>,
    ) -> Result<(FuncId, [usize; 6], usize), NotCompiled> {
        let (described, shape) = (&scheduled.kernels[&kernel], Shape::of(scheduled, kernel));
        let target = self.module.target_config();
        self.context.func.signature = self.width.of_kernel(target.default_call_conv, target.pointer_type());
        let id = self.module.declare_function(kernel.name(), Linkage::Local, &self.context.func.signature)?;
        self.context.func.name = UserFuncName::user(0, id.as_u32());
        let mut tables = Vec::new();
        for each in &described.tape.loops {
            tables.push(self.tables.len());
            self.tables.extend(each.table.iter().flatten());
        }
        let mut parts = FunctionBuilderContext::new();
        let mut builder = FunctionBuilder::new(&mut self.context.func, &mut parts);
        let functions = self.functions.map(|id| self.module.declare_func_in_func(id, builder.func));
        let mut writer = Writer {
            builder: &mut builder,
            width: self.width,
            layout: self.layout,
            shape: &shape,
            tables: &tables,
            functions,
            pointer: target.pointer_type(),
            reach: [0; 6],
            strides: Vec::new(),
            slot: None,
            loaded: Vec::new(),
        };
        writer.write(described);
        let reach = writer.reach;
        builder.seal_all_blocks();
        builder.finalize(target);
        if let Some(told) = told {
            told(Input { kernel, clif: self.context.func.display().to_string(), tables: &self.tables });
        }
        self.module.define_function(id, &mut self.context)?;
        self.module.clear_context(&mut self.context);
        Ok((id, reach, shape.n_work))
    }
}
