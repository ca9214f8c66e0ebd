//! Loops of the emitted subset. They are run as they are read, so that a program is what is computed, operation by
//! operation, and everything that is proved of a program is proved of its loops.

use super::arrays::{Array, Table, uses};
use super::block::{Form, Known, Reader};
use super::syntax::{decimal, integer, refused, text};
use crate::constants::Occurrence;
use crate::program::{Id, Node};
use crate::refusal::Refusal;

use std::collections::HashSet;
use syn::spanned::Spanned;
use syn::{BinOp, Expr, ExprForLoop, ExprIndex, Item, ItemConst, Local, Pat, RangeLimits, Stmt};

impl Reader<'_> {
    /// Reads a statement of what loops need; whether it was one.
    pub fn loop_statement(&mut self, statement: &Stmt) -> Result<bool, Refusal> {
        match statement {
            Stmt::Item(Item::Const(table)) => self.table(table).map(|()| true),
            Stmt::Expr(Expr::ForLoop(repeated), None) => self.repeated(repeated).map(|()| true),
            Stmt::Expr(Expr::Assign(assign), Some(_)) => {
                let Expr::Index(target) = &*assign.left else { return Ok(false) };
                if !matches!(&*target.expr, Expr::Index(_)) {
                    return Ok(false);
                }
                let (array, row, column) = self.entry(target)?;
                let value = self.expression(&assign.right)?;
                let entry = &mut self.arrays[array].rows[row][column];
                match entry.replace(value) {
                    Some(_) => Err(Refusal::at(statement.span(), "a number is stored twice")),
                    None => Ok(true),
                }
            }
            _ => Ok(false),
        }
    }

    /// `let mut kept0 = [[T::constant(0.0); 3]; 12];`
    pub fn array(&mut self, name: String, local: &Local, value: &Expr) -> Result<(), Refusal> {
        let Expr::Repeat(rows) = value else { return Err(refused(local)) };
        let Expr::Repeat(columns) = &*rows.expr else { return Err(refused(local)) };
        if text(&columns.expr) != "T :: constant (0.0)" {
            return Err(refused(local));
        }
        let (n_rows, n_columns) = (integer(&rows.len)?, integer(&columns.len)?);
        self.count(n_rows.saturating_mul(n_columns), local)?;
        let column = uses(&name, local.span().start().line, n_columns);
        self.arrays.push(Array { rows: vec![vec![None; n_columns]; n_rows], column });
        self.bind(name, Known::Array(self.arrays.len() - 1), local.span())
    }

    fn table(&mut self, table: &ItemConst) -> Result<(), Refusal> {
        let Expr::Array(array) = &*table.expr else { return Err(refused(table)) };
        let n_columns = match array.elems.first() {
            Some(Expr::Array(row)) => row.elems.len(),
            _ => return Err(refused(table)),
        };
        if text(&table.ty) != format!("[[f64 ; {n_columns}] ; {}]", array.elems.len()) {
            return Err(refused(&table.ty));
        }
        let mut rows = Vec::new();
        for row in &array.elems {
            let Expr::Array(row) = row else { return Err(refused(row)) };
            if row.elems.len() != n_columns {
                return Err(refused(row));
            }
            let mut places = Vec::new();
            for entry in &row.elems {
                places.push(self.occurrences.len());
                self.occurrences.push(Occurrence { literal: decimal(entry)?, at: entry.span().start() });
            }
            rows.push(places);
        }
        let name = table.ident.to_string();
        let column = uses(&name, table.span().start().line, n_columns);
        self.tables.push(Table { rows, column });
        self.bind(name, Known::Table(self.tables.len() - 1), table.span())
    }

    /// `for i in 0..12 { ... }` or `for i in (0..12).rev() { ... }`: bindings, then rows that are stored. Or nothing
    /// but results that are stored.
    fn repeated(&mut self, repeated: &ExprForLoop) -> Result<(), Refusal> {
        let Pat::Ident(name) = &*repeated.pat else { return Err(refused(&repeated.pat)) };
        let name = name.ident.to_string();
        let parts = parts(&repeated.expr)?;
        if let Some(Stmt::Expr(Expr::Assign(assign), Some(_))) = repeated.body.stmts.first()
            && !matches!(&*assign.right, Expr::Array(_))
        {
            return self.copies(&name, parts, repeated);
        }
        let is_binding = |statement: &&Stmt| matches!(statement, Stmt::Local(_));
        let n_bindings = repeated.body.stmts.iter().take_while(is_binding).count();
        let (bindings, rows) = repeated.body.stmts.split_at(n_bindings);
        if rows.is_empty() {
            return Err(refused(repeated));
        }
        self.before_results(repeated)?;
        self.count(parts.len(), repeated)?;
        self.program.loops.push((repeated.span().start().line, repeated.span().end().line));
        let mut is_first = true;
        for part in parts {
            let start = self.bound.len();
            let n_unused = self.program.unused.len();
            self.bind(name.clone(), Known::Part(part), repeated.span())?;
            for statement in bindings {
                let Stmt::Local(local) = statement else { return Err(refused(statement)) };
                self.binding(local)?;
            }
            for statement in rows {
                self.row(statement)?;
            }
            let inside: HashSet<String> = self.bound.drain(start..).collect();
            self.leave(inside, &[]);
            // What is unused once is unused always.
            if !std::mem::take(&mut is_first) {
                self.program.unused.truncate(n_unused);
            }
        }
        Ok(())
    }

    /// `for i in 0..12 { out[3 * i + 1] = kept0[i][2]; ... }`
    fn copies(&mut self, name: &str, parts: Vec<usize>, repeated: &ExprForLoop) -> Result<(), Refusal> {
        self.count(parts.len().saturating_mul(repeated.body.stmts.len()), repeated)?;
        self.program.loops.push((repeated.span().start().line, repeated.span().end().line));
        for part in parts {
            let start = self.bound.len();
            self.bind(name.to_owned(), Known::Part(part), repeated.span())?;
            for statement in &repeated.body.stmts {
                self.copy(statement)?;
            }
            let inside: HashSet<String> = self.bound.drain(start..).collect();
            self.leave(inside, &[]);
        }
        Ok(())
    }

    /// `out[3 * i + 1] = -kept0[i][2];`: an expression reads no argument, which might be what is written.
    fn copy(&mut self, statement: &Stmt) -> Result<(), Refusal> {
        let Stmt::Expr(Expr::Assign(assign), Some(_)) = statement else { return Err(refused(statement)) };
        let Expr::Index(target) = &*assign.left else { return Err(refused(statement)) };
        let size = match (self.form, self.known(&target.expr)?) {
            (Form::Filling, Known::Target) => MOST,
            (Form::Stores, Known::State) => self.sizes.state,
            (Form::Joints | Form::JointStores, Known::Joints) => self.sizes.joints,
            _ => return Err(refused(statement)),
        };
        let place = self.place(&target.index)?;
        let value = self.expression(&assign.right)?;
        if place >= size {
            return Err(refused(statement));
        }
        self.keep(place, value, statement)
    }

    /// `kept0[i + 1] = [...];`, or `kept1[0] = [...];`: an array's only row is overwritten.
    fn row(&mut self, statement: &Stmt) -> Result<(), Refusal> {
        let Stmt::Expr(Expr::Assign(assign), Some(_)) = statement else { return Err(refused(statement)) };
        let (Expr::Index(target), Expr::Array(values)) = (&*assign.left, &*assign.right) else {
            return Err(refused(assign));
        };
        let Known::Array(array) = self.known(&target.expr)? else { return Err(refused(target)) };
        let row = self.place(&target.index)?;
        let values =
            values.elems.iter().map(|value| self.expression(value)).collect::<Result<Vec<_>, _>>()?;
        let is_only = self.arrays[array].rows.len() == 1;
        let Some(stored) = self.arrays[array].rows.get_mut(row) else { return Err(refused(target)) };
        if stored.len() != values.len() || !is_only && stored.iter().any(Option::is_some) {
            return Err(Refusal::at(target.span(), "a row is stored twice, or not whole"));
        }
        *stored = values.into_iter().map(Some).collect();
        Ok(())
    }

    /// Array, row and column of `kept0[i + 1][2]`.
    fn entry(&mut self, index: &ExprIndex) -> Result<(usize, usize, usize), Refusal> {
        let Expr::Index(inner) = &*index.expr else { return Err(refused(index)) };
        let Known::Array(array) = self.known(&inner.expr)? else { return Err(refused(index)) };
        let (row, column) = (self.place(&inner.index)?, integer(&index.index)?);
        let exists = self.arrays[array].rows.get(row).is_some_and(|row| column < row.len());
        if exists { Ok((array, row, column)) } else { Err(refused(index)) }
    }

    /// What stands in `kept0[i + 1][2]`.
    pub fn kept(&mut self, index: &ExprIndex) -> Result<Id, Refusal> {
        let (array, row, column) = self.entry(index)?;
        let array = &mut self.arrays[array];
        array.column[column].is_read = true;
        let stored = array.rows[row][column];
        stored.ok_or_else(|| Refusal::at(index.span(), "a number is read before it is stored"))
    }

    /// The literal of `k(PARTS_0[i][2])`.
    pub fn tabulated(&mut self, index: &ExprIndex) -> Result<Id, Refusal> {
        let Expr::Index(inner) = &*index.expr else { return Err(refused(index)) };
        let Known::Table(table) = self.known(&inner.expr)? else { return Err(refused(index)) };
        let (row, column) = (self.place(&inner.index)?, integer(&index.index)?);
        let table = &mut self.tables[table];
        let Some(&occurrence) = table.rows.get(row).and_then(|row| row.get(column)) else {
            return Err(refused(index));
        };
        table.column[column].is_read = true;
        Ok(self.push(Node::Constant(occurrence), index.span()))
    }

    /// `3`, `i`, `i + 3`, `7 * i`, `7 * i + 3`.
    pub fn place(&mut self, index: &Expr) -> Result<usize, Refusal> {
        match index {
            Expr::Path(_) => match self.known(index)? {
                Known::Part(part) => Ok(part),
                _ => Err(refused(index)),
            },
            Expr::Binary(sum) if matches!(sum.op, BinOp::Add(_)) => {
                let (part, offset) = (self.place(&sum.left)?, integer(&sum.right)?);
                if matches!(&*sum.left, Expr::Lit(_)) || offset == 0 {
                    return Err(refused(index));
                }
                part.checked_add(offset).ok_or_else(|| refused(index))
            }
            Expr::Binary(product) if matches!(product.op, BinOp::Mul(_)) => {
                let (factor, part) = (integer(&product.left)?, self.place(&product.right)?);
                if !matches!(&*product.right, Expr::Path(_)) || factor < 2 {
                    return Err(refused(index));
                }
                part.checked_mul(factor).ok_or_else(|| refused(index))
            }
            _ => integer(index),
        }
    }

    /// Refuses to run what no module needs.
    fn count(&mut self, more: usize, at: &impl Spanned) -> Result<(), Refusal> {
        self.n_run = self.n_run.saturating_add(more);
        if self.n_run <= MOST {
            Ok(())
        } else {
            Err(Refusal::at(at.span(), "a loop or an array is too long"))
        }
    }

    /// Columns of arrays and tables that nothing reads.
    pub fn unread(&self) -> Vec<(String, usize)> {
        let arrays = self.arrays.iter().flat_map(|array| &array.column);
        let columns = arrays.chain(self.tables.iter().flat_map(|table| &table.column));
        columns.filter(|column| !column.is_read).map(|column| (column.name.clone(), column.line)).collect()
    }
}

/// Entries of arrays and rounds of loops of one function, at most.
const MOST: usize = 4_000_000;

/// `0..12` or `(0..12).rev()`.
fn parts(range: &Expr) -> Result<Vec<usize>, Refusal> {
    let (range, is_backward) = match range {
        Expr::MethodCall(call) if call.method == "rev" && call.args.is_empty() => match &*call.receiver {
            Expr::Paren(inner) => (&*inner.expr, true),
            _ => return Err(refused(range)),
        },
        _ => (range, false),
    };
    let Expr::Range(range) = range else { return Err(refused(range)) };
    let (Some(start), Some(end), RangeLimits::HalfOpen(_)) = (&range.start, &range.end, &range.limits) else {
        return Err(refused(range));
    };
    let end = integer(end)?;
    if integer(start)? != 0 || end > MOST {
        return Err(refused(range));
    }
    Ok(if is_backward { (0..end).rev().collect() } else { (0..end).collect() })
}
