//! Kernels as Cranelift functions.
//!
//! A function takes the time and six addresses, in the order of [`ARRAYS`], and returns nothing. Straight-line kernels
//! are one block; a loop has a block for its condition and one for its body, with the number of the part (and what is
//! left to do) as a parameter. What Cranelift may do with floating-point operations keeps their bits.

use crate::engine::{Array, Layout, Shape};
use crate::line::{Line, is_same, negated, second};
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::{
    AbiParam, Block, FuncRef, InstBuilder, MemFlagsData, Signature, StackSlot, StackSlotData, StackSlotKind,
    Type, Value, types,
};
use cranelift_codegen::isa::CallConv;
use cranelift_frontend::FunctionBuilder;
use gyro_codegen::tape::{At, Direction, Loop, Operation, Place, Tape};
use gyro_codegen::{ScheduledKernel, Variable};
use gyro_program::elementary::Function;
use gyro_sim::fused::IS_FUSED;

/// The arrays that a function is given, in the order of its arguments after the time.
pub(crate) const ARRAYS: [Array; 6] =
    [Array::State, Array::Given, Array::Own, Array::Tables, Array::Work, Array::Out];

/// How many functions may be called: the elementary ones by their places, and sine with cosine.
pub(crate) const N_FUNCTIONS: usize = SIN_COS + 1;
pub(crate) const SIN_COS: usize = Function::ALL.len();

/// How many functions each curve has after these: its value and three derivatives.
pub(crate) const N_ORDERS: usize = Function::LAST_ORDER as usize + 1;

/// The place of a function among all.
fn place(function: Function) -> usize {
    match function {
        Function::Curve { curve, order } => N_FUNCTIONS + N_ORDERS * usize::from(curve) + usize::from(order),
        function => function.place().expect("it is one of all"),
    }
}

/// A number type of machine code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Width {
    Single,
    Double,
    /// Two lanes of doubles. What has no machine instruction for them takes them by their address.
    Pair,
}

impl Width {
    pub(crate) fn ty(self) -> Type {
        match self {
            Self::Single => types::F32,
            Self::Double => types::F64,
            Self::Pair => types::F64X2,
        }
    }

    /// Bytes of so many numbers.
    fn bytes(self, n: usize) -> i32 {
        i32::try_from(n * self.ty().bytes() as usize).expect("buffers are smaller than 2 GB")
    }

    /// Signature of a kernel.
    pub(crate) fn of_kernel(self, call_conv: CallConv, pointer: Type) -> Signature {
        let mut signature = Signature::new(call_conv);
        signature.params.push(AbiParam::new(if self == Self::Pair { pointer } else { self.ty() }));
        signature.params.extend(ARRAYS.map(|_| AbiParam::new(pointer)));
        signature
    }

    /// Signature of a function that is called.
    pub(crate) fn of_function(self, call_conv: CallConv, pointer: Type, number: usize) -> Signature {
        let mut signature = Signature::new(call_conv);
        if self == Self::Pair {
            signature.params.push(AbiParam::new(pointer));
            return signature;
        }
        let [n_arguments, n_results] = match number {
            SIN_COS => [1, 2],
            number => [Function::ALL.get(number).map_or(1, |function| function.arity()), 1],
        };
        signature.params.extend((0..n_arguments).map(|_| AbiParam::new(self.ty())));
        signature.returns.extend((0..n_results).map(|_| AbiParam::new(self.ty())));
        signature
    }

    /// Whether sine and cosine of an angle are taken by one call: two numbers must come back in registers, as Rust
    /// returns a pair of them. Two `f32` share one.
    fn takes_both(self) -> bool {
        match self {
            Self::Single => false,
            Self::Double => {
                cfg!(all(unix, any(target_arch = "x86_64", target_arch = "aarch64")))
            }
            Self::Pair => true,
        }
    }
}

/// Writes a kernel into a function.
pub(crate) struct Writer<'w, 'f> {
    pub(crate) builder: &'w mut FunctionBuilder<'f>,
    pub(crate) width: Width,
    pub(crate) layout: Layout,
    pub(crate) shape: &'w Shape,
    /// Where the tables of each loop begin.
    pub(crate) tables: &'w [usize],
    pub(crate) functions: &'w [FuncRef],
    pub(crate) pointer: Type,
    /// How much of each array is read or written.
    pub(crate) reach: [usize; 6],
    /// Addresses of what strides through arrays, of the part of a loop that is written.
    pub(crate) strides: Vec<((Array, usize), Value)>,
    /// Where arguments stand that are taken by their address.
    pub(crate) slot: Option<StackSlot>,
    /// What was loaded last outside of loops: array and place, and by which operation.
    pub(crate) loaded: Vec<((Array, usize), Value, usize)>,
    /// Sine and cosine of angles, of the tape that is written.
    pub(crate) turns: Vec<(Place, [Value; 2])>,
}

/// How many operations long a number stays in its register: it is loaded again where it is used later.
const KEPT: usize = 24;

/// What is known while a function is written.
struct Known {
    time: Value,
    arrays: [Value; 6],
    fixed: Vec<Value>,
}

/// The part of a loop that is done: its number, and the loop's columns and the place of its table.
#[derive(Clone, Copy)]
struct Part {
    number: Value,
    count: usize,
    table: usize,
    columns: usize,
}

impl Writer<'_, '_> {
    /// Writes the whole function.
    pub(crate) fn write(&mut self, kernel: &ScheduledKernel) {
        let entry = self.builder.create_block();
        self.builder.append_block_params_for_function_params(entry);
        self.builder.switch_to_block(entry);
        let parameters = self.builder.block_params(entry).to_vec();
        let arrays = std::array::from_fn(|n| parameters[n + 1]);
        let time = if self.width == Width::Pair { self.load(parameters[0], 0) } else { parameters[0] };
        let mut known = Known { time, arrays, fixed: Vec::new() };
        let tape = &kernel.tape;
        let of_loops = tape
            .loops
            .iter()
            .flat_map(|each| each.fixed.iter().chain(each.stores.iter().map(|(_, value)| value)));
        let outside = Line::new(&tape.outside, of_loops.chain(&tape.results));
        let mut values: Vec<Value> = Vec::with_capacity(tape.outside.operations.len());
        for (number, each) in tape.loops.iter().enumerate() {
            self.operations(&known, &outside, (each.after, None), &mut values);
            known.fixed.extend(each.fixed.iter().map(|place| values[place.0 as usize]));
            for &([array, row, column], value) in &each.stores {
                let place = self.shape.kept(array, row, column);
                self.store(&known, (Array::Work, place), values[value.0 as usize]);
            }
            self.repeat(&known, each, self.tables[number]);
        }
        self.results(&known, kernel, &outside, &mut values);
        self.builder.ins().return_(&[]);
    }

    /// Does what is left to do. Each result is stored as soon as it is known, which leaves its register to others, but
    /// where results take the place of what is read.
    fn results(
        &mut self,
        known: &Known,
        kernel: &ScheduledKernel,
        outside: &Line<'_>,
        values: &mut Vec<Value>,
    ) {
        let mut results: Vec<(usize, Place)> = kernel.tape.results.iter().copied().enumerate().collect();
        if self.shape.is_overwritten() {
            self.operations(known, outside, (outside.tape.operations.len(), None), values);
        } else {
            results.sort_by_key(|(_, place)| *place);
        }
        for (n, result) in results {
            self.operations(known, outside, (result.0 as usize + 1, None), values);
            let place = kernel.places.get(n).copied().unwrap_or(n);
            self.store(known, (Array::Out, place), values[result.0 as usize]);
        }
    }

    /// A block with the condition, one with the body, and one for what follows.
    fn repeat(&mut self, known: &Known, each: &Loop<Variable, f64>, table: usize) {
        self.loaded.clear();
        let [condition, body, after] = [(); 3].map(|()| self.builder.create_block());
        let number = self.builder.append_block_param(condition, self.pointer);
        let (first, end, step) = match each.direction {
            Direction::Forward => (0, each.count as i64, 1),
            Direction::Backward => (each.count as i64 - 1, -1, -1),
        };
        let first = self.builder.ins().iconst(self.pointer, first);
        self.jump(condition, first);
        self.builder.switch_to_block(condition);
        let is_done = self.builder.ins().icmp_imm_s(IntCC::Equal, number, end);
        self.builder.ins().brif(is_done, after, &[], body, &[]);
        self.builder.switch_to_block(body);
        self.strides.clear();
        let outside = std::mem::take(&mut self.turns);
        let part = Part { number, count: each.count, table, columns: each.table.first().map_or(0, Vec::len) };
        let mut values = Vec::with_capacity(each.body.operations.len());
        let n = each.body.operations.len();
        self.operations(known, &Line::new(&each.body, each.values()), (n, Some(part)), &mut values);
        for row in &each.rows {
            let stored = row.values.iter().map(|value| values[value.0 as usize]);
            self.store_row(known, (row.array, row.at), (number, each.count), stored);
        }
        let next = self.builder.ins().iadd_imm_s(number, step);
        self.jump(condition, next);
        self.turns = outside;
        self.builder.switch_to_block(after);
    }

    fn jump(&mut self, to: Block, number: Value) {
        self.builder.ins().jump(to, &[number.into()]);
    }

    /// Does the operations of a tape that are not yet done, up to one of them.
    fn operations(
        &mut self,
        known: &Known,
        line: &Line<'_>,
        (end, part): (usize, Option<Part>),
        values: &mut Vec<Value>,
    ) {
        for place in values.len()..end {
            let value = match line.tape.operations[place] {
                // Nobody reads it.
                Operation::Negate(of) if line.is_taken[place] => values[of.0 as usize],
                // It has the sign already.
                Operation::Negate(of) if line.scaled_by[of.0 as usize].is_some() => values[of.0 as usize],
                Operation::Constant(value) if line.is_opposite[place] => self.constant(-value),
                ref operation => self.operation(known, (line.tape, operation), part, values),
            };
            values.push(value);
        }
    }

    fn operation(
        &mut self,
        known: &Known,
        (tape, operation): (&Tape<Variable, f64>, &Operation<Variable, f64>),
        part: Option<Part>,
        values: &[Value],
    ) -> Value {
        let at = |place: &Place| values[place.0 as usize];
        match operation {
            Operation::Constant(value) => self.constant(*value),
            Operation::Variable(variable) => self.variable(known, *variable, part, values.len()),
            Operation::Add(a, b) => {
                let [a, b] = second(tape, [*a, *b]).map(|place| at(&place));
                self.builder.ins().fadd(a, b)
            }
            Operation::Subtract(a, b) => self.builder.ins().fsub(at(a), at(b)),
            Operation::Multiply(a, b) => self.product(tape, (*a, *b), values),
            Operation::Divide(a, b) => self.builder.ins().fdiv(at(a), at(b)),
            Operation::Negate(a) => self.builder.ins().fneg(at(a)),
            Operation::Fused(a, b, c) if IS_FUSED => self.builder.ins().fma(at(a), at(b), at(c)),
            Operation::Fused(a, b, c) => self.rounded_twice(tape, [*a, *b, *c], values),
            Operation::Call(Function::Sqrt, [a, _]) => self.builder.ins().sqrt(at(a)),
            Operation::Call(Function::Abs, [a, _]) => self.builder.ins().fabs(at(a)),
            Operation::Call(Function::Sin, [a, _]) => self.sine_or_cosine(tape, (*a, Function::Sin), at(a)),
            Operation::Call(Function::Cos, [a, _]) => self.sine_or_cosine(tape, (*a, Function::Cos), at(a)),
            Operation::Call(function, operands) => {
                let operands = operands.map(|place| at(&place));
                self.call(place(*function), &operands[..function.arity()])[0]
            }
        }
    }

    /// A product.
    fn product(&mut self, tape: &Tape<Variable, f64>, (a, b): (Place, Place), values: &[Value]) -> Value {
        let [a, b] = second(tape, [a, b]).map(|place| values[place.0 as usize]);
        self.builder.ins().fmul(a, b)
    }

    /// `a b + c` with two roundings. A sign of `a`, or of `c`, makes it a difference, which rounds alike.
    fn rounded_twice(
        &mut self,
        tape: &Tape<Variable, f64>,
        [a, b, c]: [Place; 3],
        values: &[Value],
    ) -> Value {
        let at = |place: Place| values[place.0 as usize];
        let (without, of_c) = (negated(tape, a), negated(tape, c));
        let product = self.product(tape, (without.unwrap_or(a), b), values);
        match (without, of_c) {
            (Some(_), _) => self.builder.ins().fsub(at(c), product),
            (None, Some(c)) => self.builder.ins().fsub(product, at(c)),
            (None, None) => self.builder.ins().fadd(product, at(c)),
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
    fn constant(&mut self, value: f64) -> Value {
        match self.width {
            Width::Single => self.builder.ins().f32const(value as f32),
            Width::Double => self.builder.ins().f64const(value),
            Width::Pair => {
                let lane = self.builder.ins().f64const(value);
                self.builder.ins().splat(types::F64X2, lane)
            }
        }
    }

    /// Sine or cosine of an angle, by one call if the other one is asked for, too.
    fn sine_or_cosine(
        &mut self,
        tape: &Tape<Variable, f64>,
        (angle, function): (Place, Function),
        value: Value,
    ) -> Value {
        let (which, other) = match function {
            Function::Sin => (0, Function::Cos),
            _ => (1, Function::Sin),
        };
        let is_other = |operation: &Operation<Variable, f64>| match *operation {
            Operation::Call(called, [of, _]) => called == other && is_same(tape, of, angle),
            _ => false,
        };
        if !self.width.takes_both() || !tape.operations.iter().any(is_other) {
            return self.call(place(function), &[value])[0];
        }
        if let Some((_, both)) = self.turns.iter().find(|(of, _)| is_same(tape, *of, angle)) {
            return both[which];
        }
        let both = self.call(SIN_COS, &[value]);
        self.turns.push((angle, both));
        both[which]
    }

    /// The results of a function; of one result it is there twice.
    fn call(&mut self, function: usize, arguments: &[Value]) -> [Value; 2] {
        // No register outlives a call.
        self.loaded.clear();
        if self.width == Width::Pair {
            return self.call_by_address(function, arguments);
        }
        let call = self.builder.ins().call(self.functions[function], arguments);
        match *self.builder.inst_results(call) {
            [first, second] => [first, second],
            [only] => [only, only],
            _ => unreachable!("it is declared with one result or two"),
        }
    }

    /// The arguments are in memory, and the results then are in their place.
    fn call_by_address(&mut self, function: usize, arguments: &[Value]) -> [Value; 2] {
        let slot = *self.slot.get_or_insert_with(|| {
            let pairs = StackSlotData::new(StackSlotKind::ExplicitSlot, 2 * types::F64X2.bytes(), 4);
            self.builder.create_sized_stack_slot(pairs)
        });
        for (n, argument) in arguments.iter().enumerate() {
            self.builder.ins().stack_store(self.pointer, *argument, slot, self.width.bytes(n));
        }
        let address = self.builder.ins().stack_addr(self.pointer, slot, 0);
        self.builder.ins().call(self.functions[function], &[address]);
        let mut result =
            |n| self.builder.ins().stack_load(self.pointer, self.width.ty(), slot, self.width.bytes(n));
        let first = result(0);
        if function == SIN_COS { [first, result(1)] } else { [first, first] }
    }

    /// Stores a row of an array for a part, whose number this is of so many.
    fn store_row(
        &mut self,
        known: &Known,
        (array, at): (usize, At),
        (number, count): (Value, usize),
        values: impl Iterator<Item = Value>,
    ) {
        let At::Part(offset) = at else {
            for (column, value) in values.enumerate() {
                self.store(known, (Array::Work, self.shape.kept(array, 0, column)), value);
            }
            return;
        };
        let (row, stride) = (self.shape.kept(array, offset, 0), self.shape.columns(array));
        let base = self.strided(known, Array::Work, (number, stride));
        self.reaches(Array::Work, row + stride * count);
        for (column, value) in values.enumerate() {
            let offset = self.width.bytes(row + column);
            self.builder.ins().store(MemFlagsData::trusted(), value, base, offset);
        }
    }

    fn variable(&mut self, known: &Known, variable: Variable, part: Option<Part>, at: usize) -> Value {
        let (array, place, stride) = match (variable, part) {
            (Variable::Time, _) => return known.time,
            (Variable::Fixed(place), _) => return known.fixed[place],
            (Variable::Factor(column), Some(part)) => (Array::Tables, part.table + column, part.columns),
            (Variable::Row { array, offset, column }, Some(_)) => {
                (Array::Work, self.shape.kept(array, offset, column), self.shape.columns(array))
            }
            (Variable::Strided { argument, first, stride }, Some(_)) => {
                (self.shape.array(argument), first, stride)
            }
            (other, _) => {
                let (array, place) = self.layout.place(self.shape, other).expect("it is outside of loops");
                self.reaches(array, place + 1);
                return match part {
                    Some(_) => self.load(known.array(array), place),
                    None => self.load_once(known, (array, place), at),
                };
            }
        };
        let Part { number, count, .. } = part.expect("it is read in a loop");
        self.reaches(array, place + stride * count.saturating_sub(1) + 1);
        let base = self.strided(known, array, (number, stride));
        self.load(base, place)
    }

    /// The address of an array's element number · stride, computed once for each part.
    fn strided(&mut self, known: &Known, array: Array, (number, stride): (Value, usize)) -> Value {
        if let Some((_, address)) = self.strides.iter().find(|(of, _)| *of == (array, stride)) {
            return *address;
        }
        let bytes = i64::from(self.width.bytes(stride));
        let offset = self.builder.ins().imul_imm_s(number, bytes);
        let address = self.builder.ins().iadd(known.array(array), offset);
        self.strides.push(((array, stride), address));
        address
    }

    /// A number outside of loops, if it was not loaded a few operations ago.
    fn load_once(&mut self, known: &Known, what: (Array, usize), at: usize) -> Value {
        self.loaded.retain(|(_, _, by)| at - by <= KEPT);
        if let Some((_, value, _)) = self.loaded.iter().find(|(other, ..)| *other == what) {
            return *value;
        }
        let value = self.load(known.array(what.0), what.1);
        self.loaded.push((what, value, at));
        value
    }

    fn load(&mut self, base: Value, place: usize) -> Value {
        let offset = self.width.bytes(place);
        self.builder.ins().load(self.width.ty(), MemFlagsData::trusted(), base, offset)
    }

    fn store(&mut self, known: &Known, (array, place): (Array, usize), value: Value) {
        self.reaches(array, place + 1);
        let offset = self.width.bytes(place);
        self.builder.ins().store(MemFlagsData::trusted(), value, known.array(array), offset);
    }

    fn reaches(&mut self, array: Array, len: usize) {
        let reach = &mut self.reach[place_of(array)];
        *reach = len.max(*reach);
    }
}

impl Known {
    fn array(&self, array: Array) -> Value {
        self.arrays[place_of(array)]
    }
}

fn place_of(array: Array) -> usize {
    ARRAYS.iter().position(|other| *other == array).expect("all are given")
}
