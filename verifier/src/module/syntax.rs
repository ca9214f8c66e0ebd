//! Numbers and names of the emitted subset, and the refusal of all else.

use crate::refusal::Refusal;
use quote::ToTokens;
use syn::spanned::Spanned;
use syn::{Expr, Lit, UnOp};

/// The text of a decimal with its sign, as it stands in the text of constants.
pub fn decimal(expression: &Expr) -> Result<String, Refusal> {
    match expression {
        Expr::Unary(unary) if matches!(unary.op, UnOp::Neg(_)) => Ok(format!(
            "-{}",
            decimal(&unary.expr)
                .ok()
                .filter(|text| !text.starts_with('-'))
                .ok_or_else(|| refused(expression))?
        )),
        Expr::Lit(literal) => match &literal.lit {
            Lit::Float(float) if float.suffix().is_empty() => Ok(float.to_string()),
            _ => Err(refused(expression)),
        },
        _ => Err(refused(expression)),
    }
}

/// An index.
pub fn integer(expression: &Expr) -> Result<usize, Refusal> {
    match expression {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(integer) if integer.suffix().is_empty() => Ok(integer.base10_parse()?),
            _ => Err(refused(expression)),
        },
        _ => Err(refused(expression)),
    }
}

/// Whether an expression is just this name.
pub fn is_name(expression: &Expr, name: &str) -> bool {
    matches!(expression, Expr::Path(path) if path.path.is_ident(name))
}

/// The refusal of something that is not of the emitted subset.
pub fn refused(tokens: &(impl ToTokens + Spanned)) -> Refusal {
    let text: String = text(tokens).chars().take(60).collect();
    Refusal::at(tokens.span(), format!("`{text}` is not of the emitted subset"))
}

/// The tokens as one text.
pub fn text(tokens: &impl ToTokens) -> String {
    tokens.to_token_stream().to_string()
}
