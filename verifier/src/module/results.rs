//! How function bodies end: what they give, and where.

use super::block::{Form, Known, Reader};
use super::syntax::{integer, is_name, refused, text};
use crate::program::{Id, Node};
use crate::refusal::Refusal;

use syn::spanned::Spanned;
use syn::{Block, Expr, ExprArray, Stmt, UnOp};

impl Reader<'_> {
    pub fn results(&mut self, statements: &[Stmt], block: &Block, form: Form) -> Result<(), Refusal> {
        match (form, statements) {
            (Form::Filling, stores) if !self.stored.is_empty() => {
                stores.iter().try_for_each(|store| self.one(store))?;
                self.scattered(block)
            }
            (Form::Filling, [fill]) => self.fill(fill, None),
            (Form::Jacobian, [by_state, by_time]) => {
                self.fill(by_state, Some("dfdx"))?;
                self.fill(by_time, Some("dfdt"))
            }
            // A function without results has an empty body.
            (Form::Filling, []) => Ok(()),
            (Form::Vectors, [Stmt::Expr(Expr::Array(vectors), None)]) => {
                vectors.elems.iter().try_for_each(|vector| match vector {
                    Expr::Array(array) if array.elems.len() == 4 => self.all(array),
                    _ => Err(refused(vector)),
                })
            }
            (Form::Energy, [Stmt::Expr(Expr::Struct(energy), None)]) => {
                let fields: Vec<_> = energy.fields.iter().map(|field| text(&field.member)).collect();
                if text(&energy.path) != "gyro_sim :: Energy"
                    || fields != ["kinetic", "potential"]
                    || energy.rest.is_some()
                {
                    return Err(refused(energy));
                }
                energy.fields.iter().try_for_each(|field| self.result(&field.expr))
            }
            (Form::Stores, stores) => self.stores(stores, "y", Known::State),
            (Form::JointStores, stores) => self.stores(stores, "x", Known::Joints),
            (Form::Joints, stores) => {
                self.stores(stores, "x", Known::Joints)?;
                if self.program.places.len() == self.sizes.joints {
                    Ok(())
                } else {
                    Err(Refusal::at(block.span(), "not all joint coordinates are stored"))
                }
            }
            _ => Err(Refusal::at(
                statements.first().map_or(block.span(), Spanned::span),
                "the function does not end as it must",
            )),
        }
    }

    /// `out[3] = ...;`, after loops that have stored other results.
    fn one(&mut self, statement: &Stmt) -> Result<(), Refusal> {
        let Stmt::Expr(Expr::Assign(assign), Some(_)) = statement else { return Err(refused(statement)) };
        let Expr::Index(target) = &*assign.left else { return Err(refused(statement)) };
        if self.known(&target.expr)? != Known::Target {
            return Err(refused(statement));
        }
        let place = integer(&target.index)?;
        self.result(&assign.right)?;
        let value = self.program.results.pop().expect("it was just read");
        self.keep(place, value, statement)
    }

    /// A result by its place.
    pub fn keep(&mut self, place: usize, value: Id, at: &impl Spanned) -> Result<(), Refusal> {
        match self.stored.insert(place, value) {
            Some(_) => Err(Refusal::at(at.span(), "a result is stored twice")),
            None => Ok(()),
        }
    }

    /// Results that were stored one by one, all of an array.
    fn scattered(&mut self, block: &Block) -> Result<(), Refusal> {
        let stored = std::mem::take(&mut self.stored);
        if stored.keys().enumerate().any(|(n, &place)| n != place) {
            return Err(Refusal::at(block.span(), "not all results are stored"));
        }
        self.program.results = stored.into_values().collect();
        Ok(())
    }

    /// `y[3] = ...;` and so on, with what loops have stored before.
    fn stores(&mut self, stores: &[Stmt], name: &str, known: Known) -> Result<(), Refusal> {
        stores.iter().try_for_each(|store| self.store(store, name, known))?;
        let mut all = std::mem::take(&mut self.stored);
        for (place, value) in self.program.places.drain(..).zip(self.program.results.drain(..)) {
            if all.insert(place, value).is_some() {
                return Err(Refusal::at(stores[0].span(), format!("{name}[{place}] is stored twice")));
            }
        }
        (self.program.places, self.program.results) = all.into_iter().unzip();
        Ok(())
    }

    /// `*out = [...];`, of this name if one is given.
    fn fill(&mut self, statement: &Stmt, name: Option<&str>) -> Result<(), Refusal> {
        let Stmt::Expr(Expr::Assign(assign), Some(_)) = statement else { return Err(refused(statement)) };
        match (&*assign.left, &*assign.right) {
            (Expr::Unary(left), Expr::Array(array))
                if matches!(left.op, UnOp::Deref(_))
                    && self.known(&left.expr)? == Known::Target
                    && name.is_none_or(|name| is_name(&left.expr, name)) =>
            {
                self.all(array)
            }
            _ => Err(refused(assign)),
        }
    }

    fn all(&mut self, array: &ExprArray) -> Result<(), Refusal> {
        array.elems.iter().try_for_each(|element| self.result(element))
    }

    /// An expression, or something given that goes through.
    fn result(&mut self, expression: &Expr) -> Result<(), Refusal> {
        let given = match expression {
            Expr::Index(index) => self.argument_element(&index.expr, &index.index)?,
            _ => None,
        };
        let id = match given {
            Some(source) => self.push(Node::Read(source), expression.span()),
            None => self.expression(expression)?,
        };
        self.program.results.push(id);
        Ok(())
    }

    /// `y[3] = ...;`
    fn store(&mut self, statement: &Stmt, name: &str, known: Known) -> Result<(), Refusal> {
        let Stmt::Expr(Expr::Assign(assign), Some(_)) = statement else { return Err(refused(statement)) };
        let Expr::Index(target) = &*assign.left else { return Err(refused(statement)) };
        let place = integer(&target.index)?;
        let is_new = self.program.places.last().is_none_or(|&last| last < place);
        let size = if known == Known::State { self.sizes.state } else { self.sizes.joints };
        if !is_name(&target.expr, name) || self.known(&target.expr)? != known || place >= size {
            return Err(refused(statement));
        }
        if !is_new {
            let message = format!("{name}[{place}] is stored after a later element");
            return Err(Refusal::at(statement.span(), message));
        }
        self.program.places.push(place);
        // What was stored before must not be read.
        match &*assign.right {
            Expr::Index(index) if is_name(&index.expr, name) => Err(refused(statement)),
            right => self.result(right),
        }
    }
}
