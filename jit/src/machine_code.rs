//! Kernels as machine code: what Cranelift makes of them, and the engine that has it.

use crate::calls::{Code, Finished, Function};
use crate::clif::{N_FUNCTIONS, N_ORDERS, Width, Writer};
use crate::engine::{Arguments, Engine, Input, Layout, NotCompiled, Shape, reads_curves, write_curves};
use crate::native::Native;
use cranelift_codegen::Context;
use cranelift_codegen::ir::{AbiParam, FuncRef, InstBuilder, UserFuncName};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, ModuleError};
use gyro_codegen::{Kernel, Scheduled};
use gyro_model::Spline;
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
        builder.symbol(CURVE, T::curve());
        let curves: Box<[Spline]> = called(scheduled).into();
        let mut compiler = Compiler::new(JITModule::new(builder), T::BITS, layout, &curves)?;
        let kernels = scheduled.kernels.keys();
        let finished = kernels.map(|&kernel| compiler.kernel(scheduled, kernel, &mut told));
        let finished = finished.collect::<Result<Vec<_>, _>>()?;
        let Compiler { mut module, tables, .. } = compiler;
        module.finalize_definitions()?;
        let tables = tables.into_iter().map(T::constant).collect();
        Ok(Self { code: Arc::new(Code::new(module, &finished, (tables, curves))), work: RefCell::default() })
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
    match (Elementary::ALL.get(number), number.checked_sub(N_FUNCTIONS)) {
        (Some(function), _) => format!("gyro_{}", function.name()),
        (None, None) => "gyro_sin_cos".to_owned(),
        (None, Some(place)) => format!("gyro_curve_{}_{}", place / N_ORDERS, place % N_ORDERS),
    }
}

/// What evaluates all curves.
const CURVE: &str = "gyro_curve";

/// The tables of a mechanism, if any of its kernels calls one.
fn called(scheduled: &Scheduled) -> Vec<Spline> {
    let is_called = scheduled.kernels.values().any(|kernel| kernel.tape.curves().next().is_some());
    if is_called { scheduled.curves.clone() } else { Vec::new() }
}

/// Compiles one kernel after the other.
struct Compiler {
    module: JITModule,
    width: Width,
    layout: Layout,
    context: Context,
    functions: Vec<FuncId>,
    tables: Vec<f64>,
}

impl Compiler {
    fn new(mut module: JITModule, bits: u32, layout: Layout, curves: &[Spline]) -> Result<Self, NotCompiled> {
        let width = match bits {
            32 => Width::Single,
            64 => Width::Double,
            _ => Width::Pair,
        };
        let target = module.target_config();
        let mut functions = Vec::new();
        let n_curves = N_ORDERS * curves.len();
        for number in 0..N_FUNCTIONS + n_curves {
            let signature = width.of_function(target.default_call_conv, target.pointer_type(), number);
            let linkage = if number < N_FUNCTIONS { Linkage::Import } else { Linkage::Preemptible };
            functions.push(module.declare_function(&symbol(number), linkage, &signature)?);
        }
        let context = module.make_context();
        let mut compiler = Self { module, width, layout, context, functions, tables: Vec::new() };
        for place in 0..n_curves {
            compiler.curve(N_FUNCTIONS + place, &curves[place / N_ORDERS], place % N_ORDERS)?;
        }
        Ok(compiler)
    }

    /// A function that hands its argument on to the one that evaluates curves, with which curve it is and which
    /// derivative. Who calls it sees a function of one number, as elementary ones are.
    fn curve(&mut self, number: usize, curve: &Spline, order: usize) -> Result<(), NotCompiled> {
        let target = self.module.target_config();
        let pointer = target.pointer_type();
        let signature = self.width.of_function(target.default_call_conv, pointer, number);
        let mut evaluates = signature.clone();
        evaluates.params.extend([AbiParam::new(pointer); 2]);
        let evaluates = self.module.declare_function(CURVE, Linkage::Import, &evaluates)?;
        self.context.func.signature = signature;
        self.context.func.name = UserFuncName::user(0, self.functions[number].as_u32());
        let mut parts = FunctionBuilderContext::new();
        let mut builder = FunctionBuilder::new(&mut self.context.func, &mut parts);
        let evaluates = self.module.declare_func_in_func(evaluates, builder.func);
        let entry = builder.create_block();
        builder.append_block_params_for_function_params(entry);
        builder.switch_to_block(entry);
        let argument = builder.block_params(entry)[0];
        let address = builder.ins().iconst(pointer, std::ptr::from_ref(curve).addr() as i64);
        let order = builder.ins().iconst(pointer, order as i64);
        let call = builder.ins().call(evaluates, &[argument, address, order]);
        let results = builder.inst_results(call).to_vec();
        builder.ins().return_(&results);
        builder.seal_all_blocks();
        builder.finalize(target);
        self.module.define_function(self.functions[number], &mut self.context)?;
        self.module.clear_context(&mut self.context);
        Ok(())
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
        let functions = self.functions.iter().map(|&id| self.module.declare_func_in_func(id, builder.func));
        let functions: Vec<FuncRef> = functions.collect();
        let mut writer = Writer {
            builder: &mut builder,
            width: self.width,
            layout: self.layout,
            shape: &shape,
            tables: &tables,
            functions: &functions,
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
