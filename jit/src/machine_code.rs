//! Kernels as machine code: what Cranelift makes of them, and the engine that has it.

use crate::calls::{Code, Finished, Function};
use crate::clif::{N_FUNCTIONS, Width, Writer};
use crate::engine::{Arguments, Engine, Input, Layout, NotCompiled, Shape, reads_curves, write_curves};
use crate::native::Native;
use cranelift_codegen::Context;
use cranelift_codegen::ir::UserFuncName;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, ModuleError};
use gyro_codegen::{Kernel, Scheduled};
use gyro_program::elementary::Function as Elementary;
use std::cell::RefCell;
use std::fmt;
use std::sync::Arc;

/// What Cranelift is told. Tapes are in a good order, with each operation once: its own search for such an order takes
/// half of the time to compile, and what comes out is no quicker (`examples/beside_rustc`). What it is given is checked
/// in this crate's tests.
const FLAGS: [(&str, &str); 2] =
    [("opt_level", "none"), ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" })];

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
        for (number, address) in T::functions().into_iter().enumerate() {
            builder.symbol(symbol(number), address);
        }
        let mut compiler = Compiler::new(JITModule::new(builder), T::BITS, layout)?;
        let kernels = scheduled.kernels.keys();
        let finished = kernels.map(|&kernel| compiler.kernel(scheduled, kernel, &mut told));
        let finished = finished.collect::<Result<Vec<_>, _>>()?;
        let Compiler { mut module, tables, .. } = compiler;
        module.finalize_definitions()?;
        let tables = tables.into_iter().map(T::constant).collect();
        Ok(Self { code: Arc::new(Code::new(module, &finished, tables)), work: RefCell::default() })
    }
}

impl<T: Native> Engine<T> for MachineCode<T> {
    #[inline(always)]
    fn compute(&self, scheduled: &Scheduled, kernel: Kernel, arguments: Arguments<'_, T>) {
        match &self.code.functions[kernel as usize] {
            Some(compiled) if compiled.is_plain => compiled.call(kernel, arguments, None),
            Some(compiled) => {
                let Arguments { t, state, given, own, out } = arguments;
                self.compute_with_work(compiled, (scheduled, kernel), t, state, given, own, out);
            }
            None => (),
        }
    }
}

impl<T: Native> MachineCode<T> {
    /// Computes a kernel that reads curves or tables of loops. Its arguments come one by one: together they would be
    /// written to memory on the short way, too.
    #[inline(never)]
    #[expect(clippy::too_many_arguments, reason = "see above")]
    fn compute_with_work(
        &self,
        compiled: &Function<T>,
        (scheduled, kernel): (&Scheduled, Kernel),
        t: T,
        state: &[T],
        given: &[T],
        own: &[T],
        out: &mut [T],
    ) {
        let mut work = self.work.borrow_mut();
        if work.len() < compiled.n_work {
            work.resize(compiled.n_work, T::constant(0.0));
        }
        if compiled.reads_curves {
            write_curves(scheduled, t, &mut work[..3 * scheduled.curves.len()]);
        }
        let arguments = Arguments { t, state, given, own, out };
        compiled.call(kernel, arguments, Some((&self.code.tables, &mut work)));
    }
}

/// The name under which a function is found that is called: not that of the C library's.
fn symbol(number: usize) -> String {
    format!("gyro_{}", Elementary::ALL.get(number).map_or("sin_cos", |function| function.name()))
}

/// Compiles one kernel after the other.
struct Compiler {
    module: JITModule,
    width: Width,
    layout: Layout,
    context: Context,
    functions: [FuncId; N_FUNCTIONS],
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
        let mut functions = [FuncId::from_u32(0); N_FUNCTIONS];
        for (number, id) in functions.iter_mut().enumerate() {
            let signature = width.of_function(target.default_call_conv, target.pointer_type(), number);
            *id = module.declare_function(&symbol(number), Linkage::Import, &signature)?;
        }
        let context = module.make_context();
        Ok(Self { module, width, layout, context, functions, tables: Vec::new() })
    }

    fn kernel(
        &mut self,
        scheduled: &Scheduled,
        kernel: Kernel,
        told: &mut Option<&mut dyn FnMut(Input<'_>)>,
    ) -> Result<Finished, NotCompiled> {
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
            turns: Vec::new(),
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
        let reads_curves = reads_curves(scheduled, kernel);
        Ok(Finished { kernel, id, reach, n_work: shape.n_work, reads_curves })
    }
}
