//! Expressions of a module's functions as C, operation for operation.

use crate::Error;
use crate::module::whole;
use crate::names::Names;
use quote::ToTokens;
use syn::{BinOp, Expr, ExprCall, ExprMethodCall, Lit, Member, UnOp};

/// How strongly an expression binds, for parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Unary,
    Call,
}

/// An expression, as it stands at the end of an assignment.
pub(crate) fn value(names: &Names, expr: &Expr) -> Result<String, Error> {
    Ok(written(names, expr)?.0)
}

/// In parentheses if it binds less strongly than needed.
fn bound(names: &Names, expr: &Expr, needed: Binding) -> Result<String, Error> {
    let (text, binding) = written(names, expr)?;
    Ok(if binding < needed { format!("({text})") } else { text })
}

fn written(names: &Names, expr: &Expr) -> Result<(String, Binding), Error> {
    match expr {
        Expr::Paren(inner) => written(names, &inner.expr),
        Expr::Binary(binary) => {
            let (sign, own, right) = match binary.op {
                BinOp::Add(_) => ("+", Binding::Sum, Binding::Product),
                BinOp::Sub(_) => ("-", Binding::Sum, Binding::Product),
                BinOp::Mul(_) => ("*", Binding::Product, Binding::Unary),
                BinOp::Div(_) => ("/", Binding::Product, Binding::Unary),
                _ => return Err(Error::unknown("an operation", expr)),
            };
            let (left, right) = (bound(names, &binary.left, own)?, bound(names, &binary.right, right)?);
            Ok((format!("{left} {sign} {right}"), own))
        }
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => {
            let of = bound(names, &unary.expr, Binding::Unary)?;
            let of = if of.starts_with('-') { format!("({of})") } else { of };
            Ok((format!("-{of}"), Binding::Unary))
        }
        Expr::Call(call) => called(names, call),
        Expr::MethodCall(call) => method(names, call),
        Expr::Path(_) | Expr::Index(_) | Expr::Field(_) => Ok((place(names, expr)?, Binding::Call)),
        _ => Err(Error::unknown("an expression", expr)),
    }
}

/// `k(0.5)` and `T::fused(a, b, c)`.
fn called(names: &Names, call: &ExprCall) -> Result<(String, Binding), Error> {
    let function = call.func.to_token_stream().to_string();
    let arguments: Vec<&Expr> = call.args.iter().collect();
    match (function.as_str(), arguments.as_slice()) {
        ("k" | "T :: constant", [argument]) => constant(names, argument),
        ("T :: fused", [a, b, c]) => {
            let (a, b) = (bound(names, a, Binding::Product)?, bound(names, b, Binding::Unary)?);
            let c = bound(names, c, Binding::Product)?;
            Ok((format!("{a} * {b} + {c}"), Binding::Sum))
        }
        _ => Err(Error::unknown("a call", call)),
    }
}

/// A number, or one of a table.
fn constant(names: &Names, argument: &Expr) -> Result<(String, Binding), Error> {
    let text = match argument {
        Expr::Index(_) => place(names, argument)?,
        _ => number(argument)?,
    };
    let is_negative = text.starts_with('-');
    Ok(match names.precision.cast() {
        Some(cast) => (format!("{cast}({text})"), Binding::Call),
        None if is_negative => (text, Binding::Unary),
        None => (text, Binding::Call),
    })
}

/// A floating-point literal with its sign; it reads alike in both languages.
pub(crate) fn number(expr: &Expr) -> Result<String, Error> {
    match expr {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Float(number) => Ok(number.base10_digits().to_owned()),
            _ => Err(Error::unknown("a number", expr)),
        },
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => Ok(format!("-{}", number(&unary.expr)?)),
        _ => Err(Error::unknown("a number", expr)),
    }
}

fn method(names: &Names, call: &ExprMethodCall) -> Result<(String, Binding), Error> {
    let name = call.method.to_string();
    let mut arguments = vec![value(names, &call.receiver)?];
    for argument in &call.args {
        arguments.push(value(names, argument)?);
    }
    let Some(function) = names.precision.function(&name, arguments.len()) else {
        return Err(Error::unknown("a function", call));
    };
    Ok((format!("{function}({})", arguments.join(", ")), Binding::Call))
}

/// A variable or an element of an array.
pub(crate) fn place(names: &Names, expr: &Expr) -> Result<String, Error> {
    match expr {
        Expr::Paren(inner) => place(names, &inner.expr),
        Expr::Unary(unary) if matches!(unary.op, UnOp::Deref(_)) => place(names, &unary.expr),
        Expr::Path(path) => match path.path.get_ident() {
            Some(name) => Ok(names.variable(&name.to_string())),
            None => Err(Error::unknown("a variable", expr)),
        },
        Expr::Index(indexed) => Ok(format!("{}[{}]", place(names, &indexed.expr)?, index(&indexed.index)?)),
        Expr::Field(field) => {
            let Member::Named(member) = &field.member else { return Err(Error::unknown("a field", expr)) };
            let member = member.to_string();
            match field.base.to_token_stream().to_string().as_str() {
                "self" if member == "derived" => Ok("m->derived".to_owned()),
                "self" => Ok(format!("m->inputs[{}]", names.constant(&["input", &member]))),
                "self . parameters" => {
                    Ok(format!("m->parameters[{}]", names.constant(&["parameter", &member])))
                }
                _ => Err(Error::unknown("a field", expr)),
            }
        }
        _ => Err(Error::unknown("a place", expr)),
    }
}

/// `3`, `i`, `i + 2`, `7 * i + 1`.
fn index(expr: &Expr) -> Result<String, Error> {
    match expr {
        Expr::Lit(_) => Ok(whole(expr)?.to_string()),
        Expr::Path(path) if path.path.is_ident("i") => Ok("i".to_owned()),
        Expr::Paren(inner) => index(&inner.expr),
        Expr::Binary(binary) => {
            let sign = match binary.op {
                BinOp::Add(_) => "+",
                BinOp::Mul(_) => "*",
                _ => return Err(Error::unknown("an index", expr)),
            };
            Ok(format!("{} {sign} {}", index(&binary.left)?, index(&binary.right)?))
        }
        _ => Err(Error::unknown("an index", expr)),
    }
}
