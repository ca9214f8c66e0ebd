//! Function bodies of the emitted subset.

use super::arrays::{Array, Table};
use super::syntax::{integer, refused, text};
use crate::constants::Occurrence;
use crate::program::{Id, Node, Program, Source};
use crate::refusal::Refusal;
use gyro_model::Model;
use proc_macro2::Span;
use std::collections::{BTreeMap, HashMap, HashSet};
use syn::spanned::Spanned;
use syn::{Block, Expr, Local, Pat, Stmt};

/// What a name stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// A value.
    Value(Id),
    /// `T::constant`.
    Literals,
    /// The argument t.
    Time,
    /// The argument y.
    State,
    /// The argument or buffer of accelerations or rates.
    Accelerations,
    /// The argument `rows`.
    Changes,
    /// The argument x.
    Joints,
    /// The argument `charts`: unit vectors.
    Charts,
    /// A table's curve, evaluated.
    Curve { table: usize, time: Id },
    /// What is to be written.
    Target,
    /// An array that hands numbers to and from loops, by its place in the reader.
    Array(usize),
    /// A table of constants.
    Table(usize),
    /// The round of a loop.
    Part(usize),
}

/// How long the arrays are that a function reads.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    pub state: usize,
    pub accelerations: usize,
    pub rows: usize,
    pub joints: usize,
    pub charts: usize,
    pub tables: usize,
    pub derived: usize,
}

/// How a function gives its results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// `*out = [...];`
    Filling,
    /// `[[...], ...]`
    Vectors,
    /// `gyro_sim::Energy { kinetic: ..., potential: ... }`
    Energy,
    /// `y[3] = ...;`
    Stores,
    /// `x[0] = ...; x[1] = ...;`, all of them.
    Joints,
    /// `x[3] = ...;`, those that change.
    JointStores,
    /// `*dfdx = [...]; *dfdt = [...];`
    Jacobian,
}

/// What a function has another one compute first: the buffer and the call.
#[derive(Clone, Debug)]
pub struct Before {
    pub buffer: &'static str,
    /// The state that the call hands on, with the time.
    pub state: &'static str,
    pub call: String,
}

/// Reads one function body.
pub struct Reader<'a> {
    pub model: &'a Model,
    /// Literals of the module: until all are known, [`Node::Constant`] names a place here.
    pub occurrences: &'a mut Vec<Occurrence>,
    pub sizes: Sizes,
    pub before: Option<Before>,
    pub program: Program,
    names: HashMap<String, Name>,
    /// Names that were bound, in order, but for those of blocks that were left.
    pub bound: Vec<String>,
    pub arrays: Vec<Array>,
    pub tables: Vec<Table>,
    /// Literals by their line and column: those of a loop are read again in each round.
    pub literals: HashMap<(usize, usize), usize>,
    /// Entries of arrays and rounds of loops.
    pub n_run: usize,
    /// How results are given, and those that loops have stored, by their places.
    pub form: Form,
    pub stored: BTreeMap<usize, Id>,
}

#[derive(Debug)]
struct Name {
    known: Known,
    line: usize,
    is_used: bool,
}

impl<'a> Reader<'a> {
    pub fn new(
        model: &'a Model,
        occurrences: &'a mut Vec<Occurrence>,
        sizes: Sizes,
        before: Option<Before>,
    ) -> Self {
        Self {
            model,
            occurrences,
            sizes,
            before,
            program: Program::default(),
            names: HashMap::new(),
            bound: Vec::new(),
            arrays: Vec::new(),
            tables: Vec::new(),
            literals: HashMap::new(),
            n_run: 0,
            form: Form::Filling,
            stored: BTreeMap::new(),
        }
    }

    /// Makes an argument known; one with an underscore is not to be used.
    pub fn argument(&mut self, name: &str) {
        let known = match name {
            "t" => Known::Time,
            "y" => Known::State,
            "x" => Known::Joints,
            "accelerations" => Known::Accelerations,
            "rows" => Known::Changes,
            "charts" => Known::Charts,
            "out" => Known::Target,
            _ => return,
        };
        self.learn(name, known);
    }

    /// Makes the argument known that is written.
    pub fn target(&mut self, name: &str) {
        self.learn(name, Known::Target);
    }

    /// Makes the buffer x known, which is written, and read before.
    pub fn buffer(&mut self) {
        self.names.insert("x".to_owned(), Name { known: Known::Joints, line: 0, is_used: true });
    }

    fn learn(&mut self, name: &str, known: Known) {
        self.names.insert(name.to_owned(), Name { known, line: 0, is_used: false });
    }

    pub fn push(&mut self, node: Node, span: Span) -> Id {
        self.program.push(node, span.start().line)
    }

    /// What a name stands for.
    pub fn known(&mut self, expression: &Expr) -> Result<Known, Refusal> {
        let Expr::Path(path) = expression else { return Err(refused(expression)) };
        let Some(name) = path.path.get_ident().map(ToString::to_string) else {
            return Err(refused(expression));
        };
        match self.names.get_mut(&name) {
            Some(entry) => {
                entry.is_used = true;
                Ok(entry.known)
            }
            None => Err(Refusal::at(expression.span(), format!("`{name}` is not known here"))),
        }
    }

    /// Reads the whole body.
    pub fn body(mut self, block: &Block, form: Form) -> Result<Program, Refusal> {
        self.form = form;
        let mut statements = block.stmts.as_slice();
        while let [statement, rest @ ..] = statements {
            let Stmt::Local(local) = statement else {
                if !self.loop_statement(statement)? {
                    break;
                }
                statements = rest;
                continue;
            };
            self.before_results(statement)?;
            statements = rest;
            let starts = |before: &&Before| before.starts(local, self.sizes.accelerations);
            if let Some(before) = self.before.as_ref().filter(starts).cloned() {
                let [call, rest @ ..] = statements else { return Err(refused(local)) };
                self.compute_first(&before, call)?;
                statements = rest;
            } else {
                self.binding(local)?;
            }
        }
        self.results(statements, block, form)?;
        if !self.stored.is_empty() {
            return Err(Refusal::at(block.span(), "results are stored that the function does not give"));
        }
        let unread = self.unread();
        let mut unused: Vec<_> =
            self.names.into_iter().filter(|(_, n)| !n.is_used && n.known != Known::Target).collect();
        unused.sort_by_key(|(_, name)| name.line);
        self.program.unused = unused.into_iter().map(|(name, entry)| (name, entry.line)).collect();
        self.program.unused.extend(unread);
        Ok(self.program)
    }

    /// Refuses what comes after results that were stored: it might read them.
    pub fn before_results(&self, at: &impl Spanned) -> Result<(), Refusal> {
        if self.stored.is_empty() {
            return Ok(());
        }
        Err(Refusal::at(at.span(), "something is computed after results were stored"))
    }

    pub fn bind(&mut self, name: String, known: Known, span: Span) -> Result<(), Refusal> {
        let entry = Name { known, line: span.start().line, is_used: false };
        self.bound.push(name.clone());
        match self.names.insert(name.clone(), entry) {
            Some(_) => Err(Refusal::at(span, format!("`{name}` is bound twice"))),
            None => Ok(()),
        }
    }

    pub fn binding(&mut self, local: &Local) -> Result<(), Refusal> {
        let Some(init) = local.init.as_ref().filter(|init| init.diverge.is_none() && local.attrs.is_empty())
        else {
            return Err(refused(local));
        };
        match &local.pat {
            Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => {
                let is_array = name.mutability.is_some();
                let name = name.ident.to_string();
                if is_array {
                    return self.array(name, local, &init.expr);
                }
                let known = self.initial(&init.expr)?;
                self.bind(name, known, local.span())
            }
            Pat::Tuple(names) => self.chunk(names.elems.iter(), &init.expr),
            _ => Err(refused(local)),
        }
    }

    /// What the right side of a binding stands for.
    fn initial(&mut self, expression: &Expr) -> Result<Known, Refusal> {
        if text(expression) == "T :: constant" {
            return Ok(Known::Literals);
        }
        match expression {
            Expr::MethodCall(call) if call.method == "spline" => {
                let (table, time) = self.curve(call)?;
                Ok(Known::Curve { table, time })
            }
            Expr::Index(index) => match self.argument_element(&index.expr, &index.index)? {
                Some(source) => Ok(Known::Value(self.push(Node::Read(source), expression.span()))),
                None => Ok(Known::Value(self.expression(expression)?)),
            },
            _ => Ok(Known::Value(self.expression(expression)?)),
        }
    }

    /// `y[3]`, `x[3]`, `charts[0][1]`.
    pub fn argument_element(&mut self, array: &Expr, index: &Expr) -> Result<Option<Source>, Refusal> {
        if let Expr::Index(inner) = array {
            match self.known(&inner.expr)? {
                Known::Charts => {}
                Known::Array(_) => return Ok(None),
                _ => return Err(refused(array)),
            }
            let (chart, k) = (integer(&inner.index)?, integer(index)?);
            let exists = chart < self.sizes.charts && k < 4;
            return if exists { Ok(Some(Source::Chart(chart, k))) } else { Err(refused(index)) };
        }
        // What is set up belongs to the mechanism, not to an argument.
        if !matches!(array, Expr::Path(_)) {
            return Ok(None);
        }
        let (size, source): (usize, fn(usize) -> Source) = match self.known(array)? {
            Known::State => (self.sizes.state, Source::State),
            Known::Changes => (self.sizes.rows, Source::Change),
            Known::Joints => (self.sizes.joints, Source::Joint),
            _ => return Ok(None),
        };
        let place = self.place(index)?;
        if place < size { Ok(Some(source(place))) } else { Err(refused(index)) }
    }

    /// `let (a, b,) = { ...; (a, b,) };`: the bindings inside, of which only some go on. The block may be compiled
    /// apart.
    fn chunk<'p>(&mut self, names: impl Iterator<Item = &'p Pat>, block: &Expr) -> Result<(), Refusal> {
        let block = within(block).unwrap_or(block);
        let Expr::Block(inner) = block else { return Err(refused(block)) };
        let Some((Stmt::Expr(Expr::Tuple(handed), None), statements)) = inner.block.stmts.split_last() else {
            return Err(refused(block));
        };
        let start = self.bound.len();
        for statement in statements {
            let Stmt::Local(local) = statement else { return Err(refused(statement)) };
            self.binding(local)?;
        }
        let names: Vec<String> = names.map(text).collect();
        if handed.elems.iter().map(text).collect::<Vec<_>>() != names {
            return Err(Refusal::at(block.span(), "a block must hand on the names that it binds"));
        }
        let inside: HashSet<String> = self.bound.drain(start..).collect();
        if let Some(name) = names.iter().find(|name| !inside.contains(*name)) {
            return Err(Refusal::at(block.span(), format!("`{name}` is not bound in this block")));
        }
        self.leave(inside, &names);
        self.bound.extend(names);
        Ok(())
    }

    /// Forgets the names of a block that are not handed on.
    pub fn leave(&mut self, mut inside: HashSet<String>, handed: &[String]) {
        handed.iter().for_each(|name| _ = inside.remove(name));
        for name in inside {
            if let Some(entry) = self.names.remove(&name).filter(|entry| !entry.is_used) {
                self.program.unused.push((name, entry.line));
            }
        }
    }

    /// `gyro_sim::Dynamics::accelerations(self, t, y, &mut accelerations);` or the like, after its buffer.
    fn compute_first(&mut self, before: &Before, statement: &Stmt) -> Result<(), Refusal> {
        // A long call is written in a list of lines, with a comma at the end.
        let is_call = text(statement).replace(" ,)", ")") == before.call;
        for argument in ["t", before.state] {
            let entry = self.names.get_mut(argument).filter(|_| is_call);
            entry.ok_or_else(|| refused(statement))?.is_used = true;
        }
        self.bind(before.buffer.to_owned(), Known::Accelerations, statement.span())?;
        // Of an empty buffer there is nothing to read.
        if self.sizes.accelerations == 0
            && let Some(entry) = self.names.get_mut(before.buffer)
        {
            entry.is_used = true;
        }
        Ok(())
    }
}

/// The block of `gyro_sim::apart(move || { ... })`.
fn within(expression: &Expr) -> Option<&Expr> {
    let Expr::Call(call) = expression else { return None };
    let [Expr::Closure(closure)] = call.args.iter().collect::<Vec<_>>()[..] else { return None };
    let is_plain = text(expression) == format!("gyro_sim :: apart (move | | {})", text(&closure.body));
    is_plain.then_some(&*closure.body)
}

impl Before {
    /// Whether this is its buffer, of so many numbers.
    fn starts(&self, local: &Local, count: usize) -> bool {
        text(local) == format!("let mut {} = [T :: constant (0.0) ; {count}] ;", self.buffer)
    }
}
