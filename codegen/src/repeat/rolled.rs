//! A kernel with loops, as expressions: those of the loops' bodies and those outside of them.

use super::columns::{Columns, Source};
use super::kernel::{At, Before, Local, Repeat, Rolled, Row, Shape};
use super::loops::Loops;
use super::orbits::{Orbit, Orbits};
use super::signs::Signs;
use super::terms::{Kind, Operand, Place, Term, Terms};
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use rustc_hash::FxHashMap as HashMap;

/// An array while it is filled: columns, and its first and last row.
#[derive(Debug, Default)]
struct Array {
    columns: Vec<usize>,
    first: i64,
    last: i64,
}

pub struct Rolling<'t> {
    pub source: &'t Graph,
    pub terms: &'t Terms,
    pub orbits: &'t Orbits,
    pub loops: &'t Loops,
    pub columns: &'t Columns,
    pub signs: &'t Signs,
}

impl Rolling<'_> {
    pub fn rolled(&self) -> Rolled {
        let arrays = self.arrays();
        let mut graph = Graph::new();
        let values = self.outside(&mut graph, &arrays);
        let mut fixed: Vec<ExprId> = Vec::new();
        let loops = (0..self.loops.all.len()).map(|index| {
            let first_fixed = fixed.len();
            let repeat = self.repeat(index, &arrays, &values, &mut fixed);
            let stores = self.stores(index, &mut graph, &arrays, &values);
            (Before { fixed: fixed[first_fixed..].to_vec(), stores }, repeat)
        });
        let loops = loops.collect();
        let signed = |root: &Operand| {
            let value = values[root.term].expect("every root has a value");
            if root.is_negative { graph.neg(value) } else { value }
        };
        let roots = self.terms.roots.iter().map(signed).collect();
        let shape = |array: &Array| Shape {
            rows: usize::try_from(array.last - array.first + 1).unwrap_or(0),
            columns: array.columns.len(),
        };
        Rolled { graph, arrays: arrays.iter().map(shape).collect(), loops, roots }
    }

    /// One array for each loop that computes it, one for each loop that reads what is gathered for it, and one for each
    /// loop that carries numbers from part to part.
    fn arrays(&self) -> Vec<Array> {
        let n = self.loops.all.len();
        let mut arrays: Vec<Array> = Vec::new();
        arrays.resize_with(3 * n, Array::default);
        for (index, found) in self.loops.all.iter().enumerate() {
            for at in [index, n + index] {
                (arrays[at].first, arrays[at].last) = (found.first, found.last);
            }
        }
        for (place, column) in self.columns.all.iter().enumerate() {
            let computed = column.orbit.and_then(|orbit| self.loops.of_orbit(self.orbits, orbit));
            if let (Some(index), true) = (computed, column.is_carried) {
                arrays[2 * n + index].columns.push(place);
                continue;
            }
            let array = &mut arrays[computed.unwrap_or(n + column.reader)];
            array.columns.push(place);
            array.first = column.rows.keys().fold(array.first, |first, &row| first.min(row));
            array.last = column.rows.keys().fold(array.last, |last, &row| last.max(row));
        }
        arrays
    }

    /// Array, row and column of a column's row.
    fn place(&self, arrays: &[Array], column: usize, row: i64) -> [usize; 3] {
        let array = arrays.iter().position(|array| array.columns.contains(&column)).expect("all have one");
        let at = arrays[array].columns.iter().position(|&c| c == column).expect("it is there");
        if self.columns.all[column].is_carried {
            return [array, 0, at];
        }
        [array, usize::try_from(row - arrays[array].first).expect("no row is before the first"), at]
    }

    /// The values of terms outside of loops, loops' results being read from arrays.
    fn outside(&self, graph: &mut Graph, arrays: &[Array]) -> Vec<Option<ExprId>> {
        let mut values = vec![None; self.terms.all.len()];
        for place in 0..self.terms.all.len() {
            let value = match self.loops.of_term[place] {
                Some((_, part)) => {
                    let (orbit, _) = self.orbits.of_term[place].expect("it is computed in a loop");
                    // Nothing outside reads what has no column.
                    let column = self.columns.of_part(self.loops, self.orbits, (orbit, part));
                    let Some(column) = column else { continue };
                    let [array, row, column] = self.place(arrays, column, part);
                    let entry = graph.symbol(Symbol::Entry { array, row, column });
                    if self.signs.of_term[place] { graph.neg(entry) } else { entry }
                }
                None => {
                    let term = &self.terms.all[place];
                    let node = self.source.node(term.id);
                    let operands: Option<Vec<_>> = node
                        .operands()
                        .map(|id| Some((id, self.operand(graph, &values, term, id)?)))
                        .collect();
                    let Some(operands) = operands else { continue };
                    let other =
                        |id| operands.iter().find(|(operand, _)| *operand == id).expect("it is one").1;
                    built(graph, node.with_operands(other))
                }
            };
            values[place] = Some(value);
        }
        values
    }

    /// An operand of the expression that a term stands for, if its value is known.
    fn operand(
        &self,
        graph: &mut Graph,
        values: &[Option<ExprId>],
        term: &Term,
        id: ExprId,
    ) -> Option<ExprId> {
        if let Some(operand) = term.operands.iter().find(|operand| self.terms.all[operand.term].id == id) {
            return values[operand.term];
        }
        match self.source.node(id) {
            Node::Neg(x) => self.operand(graph, values, term, *x).map(|x| graph.neg(x)),
            Node::Recip(x) => self.operand(graph, values, term, *x).map(|x| graph.recip(x)),
            node => Some(built(graph, node.clone())),
        }
    }

    fn stores(
        &self,
        index: usize,
        graph: &mut Graph,
        arrays: &[Array],
        values: &[Option<ExprId>],
    ) -> Vec<([usize; 3], ExprId)> {
        let mut stores = Vec::new();
        for (place, column) in self.columns.all.iter().enumerate() {
            for (&row, &term) in column.rows.iter().filter(|(row, _)| column.readers[row] == index) {
                let value = values[term].expect("what is stored is known");
                let is_opposite = self.signs.of_row.get(&(place, row)).copied().unwrap_or(false);
                let value = if is_opposite { graph.neg(value) } else { value };
                stores.push((self.place(arrays, place, row), value));
            }
        }
        stores.sort_by_key(|(place, _)| *place);
        stores
    }

    fn repeat(
        &self,
        index: usize,
        arrays: &[Array],
        values: &[Option<ExprId>],
        fixed: &mut Vec<ExprId>,
    ) -> Repeat {
        let found = &self.loops.all[index];
        let mut body = Body {
            rolling: self,
            index,
            arrays,
            graph: Graph::new(),
            locals: Vec::new(),
            table: vec![Vec::new(); usize::try_from(found.last - found.first + 1).unwrap_or(0)],
            fixed,
            outside: values,
        };
        let mut order: Vec<(Place, Orbit)> = found
            .orbits
            .iter()
            .map(|&orbit| (self.loops.member(self.orbits, orbit, found.first), orbit))
            .collect();
        order.sort_unstable();
        let mut of_orbit: HashMap<Orbit, ExprId> = HashMap::default();
        for (_, orbit) in order {
            let value = body.value(orbit, &of_orbit);
            of_orbit.insert(orbit, value);
        }
        let Body { graph, locals, table, .. } = body;
        let offset = usize::try_from(found.first - arrays[index].first).expect("no row is before the first");
        let carrying = 2 * self.loops.all.len() + index;
        let rows = [(index, At::Part(offset)), (carrying, At::Only)].into_iter().map(|(array, at)| {
            let orbit = |&column: &usize| self.columns.all[column].orbit.expect("its loop fills it");
            let values = arrays[array].columns.iter().map(orbit).map(|orbit| of_orbit[&orbit]);
            Row { array, at, values: values.collect() }
        });
        let rows = rows.filter(|row| !row.values.is_empty()).collect();
        Repeat {
            direction: found.direction,
            count: table.len(),
            table,
            locals,
            graph,
            rows,
            n_operations: found.orbits.len(),
        }
    }
}

struct Body<'r, 't> {
    rolling: &'r Rolling<'t>,
    index: usize,
    arrays: &'r [Array],
    graph: Graph,
    locals: Vec<Local>,
    table: Vec<Vec<Constant>>,
    fixed: &'r mut Vec<ExprId>,
    outside: &'r [Option<ExprId>],
}

impl Body<'_, '_> {
    fn local(&mut self, local: Local) -> ExprId {
        let at = self.locals.iter().position(|known| *known == local).unwrap_or_else(|| {
            self.locals.push(local);
            self.locals.len() - 1
        });
        self.graph.symbol(Symbol::Local(at))
    }

    /// Constants of all parts: themselves if they are the same.
    fn factor(&mut self, constants: Vec<Constant>) -> ExprId {
        if constants.iter().all(|constant| *constant == constants[0]) {
            return self.graph.constant(constants[0].clone());
        }
        let n = self.table[0].len();
        let column =
            (0..n).find(|&column| self.table.iter().zip(&constants).all(|(row, c)| row[column] == *c));
        let column = column.unwrap_or_else(|| {
            self.table.iter_mut().zip(constants).for_each(|(row, constant)| row.push(constant));
            n
        });
        self.local(Local::Factor(column))
    }

    fn operand(&mut self, source: &Source, of_orbit: &HashMap<Orbit, ExprId>) -> ExprId {
        let Rolling { terms, loops, source: graph, .. } = self.rolling;
        let symbol = |term: Place| match graph.node(terms.all[term].id) {
            Node::Symbol(symbol) => Some(*symbol),
            _ => None,
        };
        match *source {
            Source::Local(orbit) => of_orbit[&orbit],
            Source::Element { first, stride } => {
                let first = symbol(first).expect("it is a variable");
                self.local(Local::Element { first, stride })
            }
            Source::Same(term) => match symbol(term) {
                Some(symbol) => self.graph.symbol(symbol),
                None => {
                    let value = self.outside[term].expect("what all parts read is known");
                    let at = self.fixed.iter().position(|&known| known == value).unwrap_or_else(|| {
                        self.fixed.push(value);
                        self.fixed.len() - 1
                    });
                    self.local(Local::Fixed(at))
                }
            },
            Source::Row { column, offset } => {
                let row = loops.all[self.index].first + offset;
                let is_carried = self.rolling.columns.all[column].is_carried;
                let [array, offset, column] = self.rolling.place(self.arrays, column, row);
                self.local(match is_carried {
                    true => Local::Carried { array, column },
                    false => Local::Row { array, offset, column },
                })
            }
        }
    }

    fn value(&mut self, orbit: Orbit, of_orbit: &HashMap<Orbit, ExprId>) -> ExprId {
        let Rolling { terms, orbits, signs, columns, .. } = self.rolling;
        let sources = &columns.sources[&orbit];
        let operands: Vec<ExprId> = sources.iter().map(|source| self.operand(source, of_orbit)).collect();
        let is_opposite = |slot: usize| signs.of_operand.get(&(orbit, slot)).copied().unwrap_or(false);
        let kind = terms.all[orbits.members[orbit][0]].kind;
        let operands: Vec<ExprId> = (operands.into_iter().enumerate())
            .map(|(slot, x)| if is_opposite(slot) { self.graph.neg(x) } else { x })
            .collect();
        let node = match (kind, &operands[..]) {
            (Kind::Sum, &[a, b]) => Node::Add(a, b),
            (Kind::Product, &[a, b]) => Node::Mul(a, b),
            (Kind::Quotient, &[a, b]) => {
                let inverse = self.graph.recip(b);
                Node::Mul(a, inverse)
            }
            (Kind::Scaled | Kind::Shifted, &[x]) => {
                let constants = self.constants(orbit, kind);
                let constant = self.factor(constants);
                if kind == Kind::Scaled { Node::Mul(constant, x) } else { Node::Add(constant, x) }
            }
            (Kind::Reciprocal, &[x]) => Node::Recip(x),
            (Kind::Call(function), &[x]) => Node::Call(function, [x, x]),
            (Kind::Call(function), &[x, y]) => Node::Call(function, [x, y]),
            _ => unreachable!("variables and constants are not computed"),
        };
        built(&mut self.graph, node)
    }

    /// The constant of each part, with the sign that makes up for those of the operand and of the result.
    fn constants(&self, orbit: Orbit, kind: Kind) -> Vec<Constant> {
        let Rolling { terms, orbits, signs, columns, loops, source: graph, .. } = self.rolling;
        let found = &loops.all[self.index];
        let constant = |part: i64| {
            let term = loops.member(orbits, orbit, part);
            let constant = terms.all[term].constant.and_then(|id| graph.as_constant(id));
            let constant = constant.expect("its kind has a constant");
            let operand = orbits.operands[term][0];
            let of_operand = operand.is_negative
                ^ match &columns.sources[&orbit][0] {
                    Source::Local(_) => signs.of_term[operand.term],
                    Source::Row { column, offset } => {
                        let row = part + offset;
                        if columns.is_computed(loops, orbits, *column, row) {
                            signs.of_term[operand.term]
                        } else {
                            signs.of_row[&(*column, row)]
                        }
                    }
                    Source::Element { .. } | Source::Same(_) => false,
                };
            let of_operand = kind == Kind::Scaled && of_operand;
            if signs.of_term[term] ^ of_operand { constant.neg() } else { constant.clone() }
        };
        (found.first..=found.last).map(constant).collect()
    }
}

/// An expression whose operands may have signs, otherwise as it is.
fn built(graph: &mut Graph, node: Node) -> ExprId {
    match node {
        Node::Add(a, b) => {
            let sign = |id: ExprId| if let Node::Neg(x) = graph.node(id) { (true, *x) } else { (false, id) };
            let ((negative_a, x), (negative_b, y)) = (sign(a), sign(b));
            match (negative_a, negative_b) {
                (false, _) => graph.intern(Node::Add(a, b)),
                (true, false) => graph.intern(Node::Add(b, a)),
                (true, true) => {
                    let sum = graph.intern(Node::Add(x, y));
                    graph.neg(sum)
                }
            }
        }
        Node::Mul(a, b) => {
            let ((negative_a, a), (negative_b, b)) = (graph.split_sign(a), graph.split_sign(b));
            let product = graph.intern(Node::Mul(a, b));
            if negative_a == negative_b { product } else { graph.neg(product) }
        }
        node => graph.rebuilt(node),
    }
}
