//! Functions that return lists of numbers.

use super::syntax::{decimal, integer, is_name, refused, text};
use crate::refusal::Refusal;
use syn::spanned::Spanned;
use syn::{Block, Expr, Stmt};

/// The literals of the start: `let k = T::constant; [k(0.5), ...]`.
pub fn start(block: &Block) -> Result<Vec<f64>, Refusal> {
    let [Stmt::Local(local), Stmt::Expr(Expr::Array(array), None)] = block.stmts.as_slice() else {
        return Err(Refusal::at(block.span(), "the start must be an array of literals"));
    };
    if text(local) != "let k = T :: constant ;" {
        return Err(refused(local));
    }
    let value = |element: &Expr| match element {
        Expr::Call(call) if is_name(&call.func, "k") && call.args.len() == 1 => {
            decimal(&call.args[0])?.parse().map_err(|_| refused(element))
        }
        _ => Err(refused(element)),
    };
    array.elems.iter().map(value).collect()
}

/// The numbers below n, each once: `&[1, 0, 2]`.
pub fn order(block: &Block, n: usize) -> Result<Vec<usize>, Refusal> {
    let [Stmt::Expr(Expr::Reference(reference), None)] = block.stmts.as_slice() else {
        return Err(Refusal::at(block.span(), "an order must be a list of places"));
    };
    let Expr::Array(array) = &*reference.expr else { return Err(refused(reference)) };
    let order: Vec<usize> = array.elems.iter().map(integer).collect::<Result<_, _>>()?;
    let is_permutation = order.len() == n && (0..n).all(|place| order.contains(&place));
    if reference.mutability.is_none() && is_permutation { Ok(order) } else { Err(refused(reference)) }
}

/// The places of a pattern: `&[(0, 3), ...]`.
pub fn pattern(block: &Block) -> Result<Vec<(usize, usize)>, Refusal> {
    let [Stmt::Expr(Expr::Reference(reference), None)] = block.stmts.as_slice() else {
        return Err(Refusal::at(block.span(), "a pattern must be a list of places"));
    };
    if reference.mutability.is_some() {
        return Err(refused(reference));
    }
    let Expr::Array(array) = &*reference.expr else { return Err(refused(reference)) };
    let place = |element: &Expr| match element {
        Expr::Tuple(pair) if pair.elems.len() == 2 => {
            Ok((integer(&pair.elems[0])?, integer(&pair.elems[1])?))
        }
        _ => Err(refused(element)),
    };
    array.elems.iter().map(place).collect()
}
