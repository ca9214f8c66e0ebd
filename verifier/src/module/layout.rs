//! The layout of the joint state, which a module states and its formulas are proved for.
//!
//! It is read before the text around the formulas is compared, as that depends on it: the layout that was read is part
//! of the text that is then expected, token by token, so that it can stand nowhere else and say nothing more.

use super::syntax::{integer, refused};
use crate::joints::{Freedom, JointLayout};
use crate::refusal::Refusal;
use gyro_model::{JointCoordinate, Model};
use proc_macro2::{TokenStream, TokenTree};
use syn::spanned::Spanned;
use syn::{Expr, ExprStruct};

/// Name of the constant.
const NAME: &str = "LAYOUT";

/// The layout in a module's text; `None` of one without joint coordinates.
///
/// # Errors
/// Where it is written otherwise than a layout is, or cannot be one of the model.
pub fn read(model: &Model, text: &TokenStream) -> Result<Option<JointLayout>, Refusal> {
    let Some(value) = value(text.clone()) else { return Ok(None) };
    let written: ExprStruct = syn::parse2(value)?;
    let places: Vec<Freedom> = list(&written, "places")?.map(freedom).collect::<Result<_, _>>()?;
    let closure_rows = list(&written, "closure_rows")?.map(integer).collect::<Result<_, _>>()?;
    let layout = JointLayout::new(model, &places, closure_rows);
    layout.map(Some).map_err(|words| Refusal::at(written.span(), format!("of the joint state: {words}")))
}

/// The tokens between `const LAYOUT: type =` and the semicolon.
fn value(text: TokenStream) -> Option<TokenStream> {
    let is_mark = |token: &TokenTree, mark| matches!(token, TokenTree::Punct(p) if p.as_char() == mark);
    let mut tokens = text.into_iter();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Ident(name) if name == NAME => {
                let after = tokens.skip_while(|token| !is_mark(token, '=')).skip(1);
                return Some(after.take_while(|token| !is_mark(token, ';')).collect());
            }
            TokenTree::Group(group) => {
                if let Some(value) = value(group.stream()) {
                    return Some(value);
                }
            }
            _ => {}
        }
    }
    None
}

/// The value of a field.
fn field<'e>(written: &'e ExprStruct, name: &str) -> Result<&'e Expr, Refusal> {
    let is_it = |member: &syn::Member| matches!(member, syn::Member::Named(ident) if ident == name);
    let field = written.fields.iter().find(|field| is_it(&field.member));
    field.map(|field| &field.expr).ok_or_else(|| refused(written))
}

/// The elements of `&[...]`.
fn list<'e>(written: &'e ExprStruct, name: &str) -> Result<impl Iterator<Item = &'e Expr>, Refusal> {
    let value = field(written, name)?;
    let Expr::Reference(reference) = value else { return Err(refused(value)) };
    let Expr::Array(array) = &*reference.expr else { return Err(refused(value)) };
    Ok(array.elems.iter())
}

/// `gyro_sim::JointPlace::Scalar { joint: 0, coordinate: 0 }` and the like.
fn freedom(written: &Expr) -> Result<Freedom, Refusal> {
    let Expr::Struct(place) = written else { return Err(refused(written)) };
    let number = |name: &str| integer(field(place, name)?);
    let kind = place.path.segments.last().map(|segment| segment.ident.to_string());
    Ok(match kind.as_deref() {
        Some("Scalar") => {
            Freedom::Scalar(JointCoordinate { joint: number("joint")?, coordinate: number("coordinate")? })
        }
        Some("Turn") => {
            Freedom::Turn(JointCoordinate { joint: number("joint")?, coordinate: number("coordinate")? })
        }
        Some("State") => Freedom::State(number("state")?),
        Some("Orientation") => Freedom::Orientation { joint: number("joint")? },
        Some("Body") => Freedom::Body { moving_body: number("body")? },
        _ => return Err(refused(written)),
    })
}
