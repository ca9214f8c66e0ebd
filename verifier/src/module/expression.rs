//! Expressions of the emitted subset.

use super::block::{Known, Reader};
use super::syntax::{decimal, refused, text};
use crate::constants::Occurrence;
use crate::program::{Function, Id, Node, Source};
use crate::refusal::Refusal;

use syn::spanned::Spanned;
use syn::{BinOp, Expr, ExprBinary, ExprCall, ExprField, ExprIndex, ExprMethodCall, Member, UnOp};

impl Reader<'_> {
    /// Reads an expression and gives the place of its value.
    pub fn expression(&mut self, expression: &Expr) -> Result<Id, Refusal> {
        match expression {
            Expr::Paren(inner) => self.expression(&inner.expr),
            Expr::Binary(binary) => self.binary(binary),
            Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
                let operand = self.expression(&unary.expr)?;
                Ok(self.push(Node::Neg(operand), unary.op.span()))
            }
            Expr::Path(_) => match self.known(expression)? {
                Known::Value(id) => Ok(id),
                Known::Time => Ok(self.push(Node::Read(Source::Time), expression.span())),
                _ => Err(refused(expression)),
            },
            Expr::Call(call) if text(&call.func) == "T :: fused" => self.fused(call),
            Expr::Call(call) => self.literal(call),
            Expr::MethodCall(call) => self.call(call),
            Expr::Index(index) => self.element(index),
            Expr::Field(field) => self.field(field),
            _ => Err(refused(expression)),
        }
    }

    fn binary(&mut self, binary: &ExprBinary) -> Result<Id, Refusal> {
        let left = self.expression(&binary.left)?;
        let right = self.expression(&binary.right)?;
        let node = match binary.op {
            BinOp::Add(_) => Node::Add(left, right),
            BinOp::Sub(_) => Node::Sub(left, right),
            BinOp::Mul(_) => Node::Mul(left, right),
            BinOp::Div(_) => Node::Div(left, right),
            other => return Err(Refusal::at(other.span(), format!("`{}`: no such operation", text(&other)))),
        };
        Ok(self.push(node, binary.op.span()))
    }

    /// `T::fused(a, b, c)`: `a b + c`, one product and one sum.
    fn fused(&mut self, call: &ExprCall) -> Result<Id, Refusal> {
        if call.args.len() != 3 {
            return Err(refused(call));
        }
        let [a, b, c] = [0, 1, 2].map(|place| self.expression(&call.args[place]));
        let (a, b, c) = (a?, b?, c?);
        let product = self.push(Node::Mul(a, b), call.func.span());
        Ok(self.push(Node::Add(product, c), call.func.span()))
    }

    /// `k(0.5)`.
    fn literal(&mut self, call: &ExprCall) -> Result<Id, Refusal> {
        if !matches!(self.known(&call.func)?, Known::Literals) || call.args.len() != 1 {
            return Err(refused(call));
        }
        if let Expr::Index(entry) = &call.args[0] {
            return self.tabulated(entry);
        }
        let (literal, at) = (decimal(&call.args[0])?, call.span().start());
        let occurrence = *self.literals.entry((at.line, at.column)).or_insert_with(|| {
            self.occurrences.push(Occurrence { literal, at });
            self.occurrences.len() - 1
        });
        Ok(self.push(Node::Constant(occurrence), call.span()))
    }

    /// `x.spline(&KNOTS_0, &PIECES_0)`, or another method with these arguments: which table, and where.
    pub fn curve(&mut self, call: &ExprMethodCall) -> Result<(usize, Id), Refusal> {
        let at = self.expression(&call.receiver)?;
        let table = (0..self.sizes.tables).find(|k| {
            let expected = [format!("& KNOTS_{k}"), format!("& PIECES_{k}")];
            call.args.len() == 2 && call.args.iter().map(text).eq(expected)
        });
        table.map(|table| (table, at)).ok_or_else(|| refused(call))
    }

    fn call(&mut self, call: &ExprMethodCall) -> Result<Id, Refusal> {
        if call.method == "spline_third" {
            let (table, time) = self.curve(call)?;
            return Ok(self.push(Node::Curve { table, order: 3, time }, call.method.span()));
        }
        let receiver = self.expression(&call.receiver)?;
        let arguments = call.args.iter().map(|a| self.expression(a)).collect::<Result<Vec<_>, _>>()?;
        let name = call.method.to_string();
        let function = Function::named(&name).filter(|function| function.arity() == 1 + arguments.len());
        let Some(function) = function else {
            return Err(Refusal::at(call.method.span(), format!("`{name}`: no such function")));
        };
        let operands = [receiver, arguments.first().copied().unwrap_or(receiver)];
        Ok(self.push(Node::Call(function, operands), call.method.span()))
    }

    /// `table0[1]`, `accelerations[2]`, `self.derived[3]`, `kept0[i + 1][2]`.
    fn element(&mut self, index: &ExprIndex) -> Result<Id, Refusal> {
        if matches!(&*index.expr, Expr::Index(_)) {
            return self.kept(index);
        }
        let place = self.place(&index.index)?;
        if let Expr::MethodCall(call) = &*index.expr
            && call.method == "spline"
            && place < 3
        {
            let (table, time) = self.curve(call)?;
            return Ok(self.push(Node::Curve { table, order: place, time }, index.span()));
        }
        if matches!(&*index.expr, Expr::Field(_)) {
            if text(&index.expr) != "self . derived" || place >= self.sizes.derived {
                return Err(refused(index));
            }
            return Ok(self.push(Node::Read(Source::ParameterSetup(place)), index.span()));
        }
        let node = match self.known(&index.expr)? {
            Known::Curve { table, time } if place < 3 => Node::Curve { table, order: place, time },
            Known::Accelerations if place < self.sizes.accelerations => {
                Node::Read(Source::Acceleration(place))
            }
            _ => return Err(refused(index)),
        };
        Ok(self.push(node, index.span()))
    }

    /// `self.parameters.gravity`, `self.torque`.
    fn field(&mut self, field: &ExprField) -> Result<Id, Refusal> {
        let Member::Named(name) = &field.member else { return Err(refused(field)) };
        let at = |fields: &[gyro_model::Parameter]| fields.iter().position(|f| name == &f.name);
        let source = match text(&field.base).as_str() {
            "self . parameters" => at(&self.model.parameters).map(Source::Parameter),
            "self" => at(&self.model.inputs).map(Source::Input),
            _ => return Err(refused(field)),
        };
        match source {
            Some(source) => Ok(self.push(Node::Read(source), field.span())),
            None => Err(Refusal::at(field.span(), format!("`{name}` is neither a parameter nor an input"))),
        }
    }
}
