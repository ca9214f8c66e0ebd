//! From expressions to tapes.

use super::{Exact, Kernel, Loop, Operation, Place, Tape};
use crate::expr::by_expr::ByExpr;
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::Program;
use crate::expr::symbol::Symbol;
use crate::repeat::{Before, Repeat, Rolled, Row};
use gyro_program::elementary::Function;
use rustc_hash::FxHashSet as HashSet;

/// The tape of a kernel without loops.
pub fn straight(graph: &Graph, roots: &[ExprId]) -> Kernel<Symbol, Constant> {
    let mut builder = Builder::new(graph, roots);
    let rest: Vec<Place> =
        builder.program.temporaries.clone().into_iter().map(|id| builder.name(id)).collect();
    let results = builder.values(roots);
    Kernel { outside: builder.tape(), arrays: Vec::new(), loops: Vec::new(), rest, results }
}

/// The tape of a kernel with loops.
pub fn looped(rolled: &Rolled) -> Kernel<Symbol, Constant> {
    let roots = rolled.outside_roots();
    let mut builder = Builder::new(&rolled.graph, &roots);
    let mut parts = parts(rolled, &builder.program).into_iter();
    let mut part = |builder: &mut Builder<'_>| -> Vec<Place> {
        let part = parts.next().unwrap_or_default();
        part.into_iter().map(|id| builder.name(id)).collect()
    };
    let mut loops = Vec::new();
    for (before, repeat) in &rolled.loops {
        let named = part(&mut builder);
        loops.push(builder.repeated(named, before, repeat));
    }
    let rest = part(&mut builder);
    let results = builder.values(&rolled.roots);
    Kernel { outside: builder.tape(), arrays: rolled.arrays.clone(), loops, rest, results }
}

/// Shared expressions that are computed before each loop, and after all of them.
fn parts(rolled: &Rolled, program: &Program) -> Vec<Vec<ExprId>> {
    let mut known: HashSet<ExprId> = HashSet::default();
    let mut rest = program.temporaries.clone();
    let mut parts = Vec::new();
    for (before, _) in &rolled.loops {
        known.extend(rolled.graph.reachable(&before.roots()));
        let (part, after): (Vec<_>, Vec<_>) = rest.into_iter().partition(|id| known.contains(id));
        parts.push(part);
        rest = after;
    }
    parts.push(rest);
    parts
}

struct Builder<'g> {
    graph: &'g Graph,
    program: Program,
    operations: Vec<Operation<Symbol, Constant>>,
    named: ByExpr<Place>,
    has_name: HashSet<ExprId>,
}

impl<'g> Builder<'g> {
    fn new(graph: &'g Graph, roots: &[ExprId]) -> Self {
        let program = Program::new(graph, roots);
        let has_name = program.temporaries.iter().copied().collect();
        Self { graph, program, operations: Vec::new(), named: ByExpr::default(), has_name }
    }

    fn tape(self) -> Exact {
        let named = self.program.temporaries.iter().map(|id| self.named[*id]).collect();
        Tape { operations: self.operations, named }
    }

    fn repeated(&mut self, named: Vec<Place>, before: &Before, repeat: &Repeat) -> Loop<Symbol, Constant> {
        let fixed = self.values(&before.fixed);
        let stores = before.stores.iter().map(|&(place, value)| (place, self.value(value))).collect();
        let body = straight(&repeat.graph, &repeat.values());
        let mut values = body.results.into_iter();
        let rows = repeat.rows.iter().map(|row| {
            let values = values.by_ref().take(row.values.len()).collect();
            Row { array: row.array, at: row.at, values }
        });
        let rows = rows.collect();
        Loop {
            after: self.operations.len(),
            named,
            fixed,
            stores,
            direction: repeat.direction,
            count: repeat.count,
            table: repeat.table.clone(),
            locals: repeat.locals.clone(),
            body: body.outside,
            rows,
        }
    }

    fn push(&mut self, operation: Operation<Symbol, Constant>) -> Place {
        self.operations.push(operation);
        Place(u32::try_from(self.operations.len() - 1).expect("fewer operations than that"))
    }

    /// Computes what has a name.
    fn name(&mut self, id: ExprId) -> Place {
        let place = self.operation(id);
        self.named.insert(id, place);
        place
    }

    fn values(&mut self, ids: &[ExprId]) -> Vec<Place> {
        ids.iter().map(|&id| self.value(id)).collect()
    }

    /// What was computed before, or is computed where it is used.
    fn value(&mut self, id: ExprId) -> Place {
        self.named.get(id).copied().unwrap_or_else(|| self.operation(id))
    }

    fn operation(&mut self, id: ExprId) -> Place {
        let operation = match *self.graph.node(id) {
            Node::Constant(ref value) => Operation::Constant(value.clone()),
            Node::Symbol(symbol) => Operation::Variable(symbol),
            Node::Add(a, b) => self.sum(a, b),
            Node::Mul(a, b) => self.product(a, b),
            Node::Neg(a) => self.negation(a),
            Node::Recip(a) => {
                let one = self.push(Operation::Constant(Constant::integer(1)));
                Operation::Divide(one, self.value(a))
            }
            Node::Call(Function::Atan2, [y, x]) => self.angle(y, x),
            Node::Call(function, [a, b]) => {
                let a = self.value(a);
                Operation::Call(function, [a, if function.arity() == 2 { self.value(b) } else { a }])
            }
        };
        self.push(operation)
    }

    /// A product that nobody else uses becomes one operation with the sum.
    fn sum(&mut self, a: ExprId, b: ExprId) -> Operation<Symbol, Constant> {
        if let Node::Neg(subtracted) = *self.graph.node(b) {
            return self.difference(a, subtracted);
        }
        let with_b = self.fusible(b).map(|factors| (factors, a));
        if let Some(((x, y), added)) = with_b.or_else(|| Some((self.fusible(a)?, b))) {
            return Operation::Fused(self.value(x), self.value(y), self.value(added));
        }
        Operation::Add(self.value(a), self.value(b))
    }

    fn difference(&mut self, from: ExprId, subtracted: ExprId) -> Operation<Symbol, Constant> {
        if let Some((x, y)) = self.fusible(subtracted) {
            let x = self.value(x);
            return Operation::Fused(self.push(Operation::Negate(x)), self.value(y), self.value(from));
        }
        if let Some((x, y)) = self.fusible(from) {
            let (x, y, added) = (self.value(x), self.value(y), self.value(subtracted));
            return Operation::Fused(x, y, self.push(Operation::Negate(added)));
        }
        Operation::Subtract(self.value(from), self.value(subtracted))
    }

    /// The factors of a product that is computed where it is used, and is not a quotient.
    fn fusible(&self, id: ExprId) -> Option<(ExprId, ExprId)> {
        match *self.graph.node(id) {
            Node::Mul(a, b) if !self.has_name.contains(&id) && self.quotient(a, b).is_none() => Some((a, b)),
            _ => None,
        }
    }

    fn quotient(&self, a: ExprId, b: ExprId) -> Option<(ExprId, ExprId)> {
        self.program.uses.quotient(self.graph, a, b)
    }

    fn product(&mut self, a: ExprId, b: ExprId) -> Operation<Symbol, Constant> {
        match self.quotient(a, b) {
            Some((numerator, denominator)) => {
                Operation::Divide(self.value(numerator), self.value(denominator))
            }
            None => Operation::Multiply(self.value(a), self.value(b)),
        }
    }

    /// A difference that is not needed elsewhere has its operands swapped instead of being negated.
    fn negation(&mut self, a: ExprId) -> Operation<Symbol, Constant> {
        if let Node::Add(x, y) = *self.graph.node(a)
            && let Node::Neg(y) = *self.graph.node(y)
            && !self.has_name.contains(&a)
        {
            return self.difference(y, x);
        }
        Operation::Negate(self.value(a))
    }

    /// Odd in y: a sign before it is one before the angle.
    fn angle(&mut self, y: ExprId, x: ExprId) -> Operation<Symbol, Constant> {
        let Node::Neg(opposite) = *self.graph.node(y) else {
            return Operation::Call(Function::Atan2, [y, x].map(|id| self.value(id)));
        };
        match self.negation(opposite) {
            Operation::Negate(y) => {
                let angle = Operation::Call(Function::Atan2, [y, self.value(x)]);
                Operation::Negate(self.push(angle))
            }
            y => Operation::Call(Function::Atan2, [self.push(y), self.value(x)]),
        }
    }
}
