//! Whether a body consists of what the reader looks at, and of nothing else.
//!
//! A syntax tree has places for much that no emitted body has: attributes, labels, types, type arguments, qualifiers.
//! Instead of naming what must not be there, the body is written down again from the parts that the reader takes its
//! meaning from. What comes out must be the tokens that stand there, so that whatever else there is, is refused.

use super::syntax::refused;
use crate::refusal::Refusal;
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use quote::ToTokens;
use std::fmt::Write;
use syn::spanned::Spanned;
use syn::{Block, Expr, Item, Local, Pat, Stmt};

/// Refuses a body with anything in it that has no meaning to the reader, by the statement that has it.
pub fn check(block: &Block) -> Result<(), Refusal> {
    block.stmts.iter().try_for_each(|statement| {
        let mut written = String::new();
        write_statement(statement, &mut written)?;
        if written == tokens(statement.to_token_stream()) {
            return Ok(());
        }
        Err(Refusal::at(statement.span(), "there is more in this statement than its formula"))
    })
}

/// Tokens one after the other. A comma at the end of a list is left out, as it may or may not be there.
fn tokens(stream: TokenStream) -> String {
    let mut text = String::new();
    write_tokens(stream, &mut text);
    text
}

fn write_tokens(stream: TokenStream, text: &mut String) {
    let mut trees = stream.into_iter().peekable();
    while let Some(tree) = trees.next() {
        match tree {
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Parenthesis => ("( ", ") "),
                    Delimiter::Brace => ("{ ", "} "),
                    Delimiter::Bracket => ("[ ", "] "),
                    Delimiter::None => ("", ""),
                };
                *text += open;
                write_tokens(group.stream(), text);
                *text += close;
            }
            TokenTree::Punct(comma) if comma.as_char() == ',' && trees.peek().is_none() => {}
            tree => write!(text, "{tree} ").expect("a string takes all text"),
        }
    }
}

fn write_statement(statement: &Stmt, text: &mut String) -> Result<(), Refusal> {
    match statement {
        Stmt::Local(local) => write_local(local, text),
        Stmt::Expr(expression, semicolon) => {
            write_expression(expression, text)?;
            *text += if semicolon.is_some() { "; " } else { "" };
            Ok(())
        }
        // A table of constants, whose type the reader looks at.
        Stmt::Item(Item::Const(table)) => {
            write!(text, "const {} : {}= ", table.ident, tokens(table.ty.to_token_stream()))
                .expect("a string takes all text");
            write_expression(&table.expr, text)?;
            *text += "; ";
            Ok(())
        }
        other => Err(refused(other)),
    }
}

/// `let name = value;`, `let mut name = value;`, `let (name, name) = value;`
fn write_local(local: &Local, text: &mut String) -> Result<(), Refusal> {
    let Some(init) = &local.init else { return Err(refused(local)) };
    *text += "let ";
    match &local.pat {
        Pat::Ident(name) => write_name(name.mutability.is_some(), &name.ident, text),
        Pat::Tuple(names) => {
            *text += "( ";
            for (place, name) in names.elems.iter().enumerate() {
                let Pat::Ident(name) = name else { return Err(refused(name)) };
                *text += if place > 0 { ", " } else { "" };
                write_name(false, &name.ident, text);
            }
            *text += ") ";
        }
        other => return Err(refused(other)),
    }
    *text += "= ";
    write_expression(&init.expr, text)?;
    *text += "; ";
    Ok(())
}

fn write_name(is_mutable: bool, name: &syn::Ident, text: &mut String) {
    *text += if is_mutable { "mut " } else { "" };
    write!(text, "{name} ").expect("a string takes all text");
}

fn write_expression(expression: &Expr, text: &mut String) -> Result<(), Refusal> {
    let write = |part: &Expr, text: &mut String| write_expression(part, text);
    match expression {
        Expr::Paren(inner) => {
            *text += "( ";
            write(&inner.expr, text)?;
            *text += ") ";
        }
        Expr::Binary(binary) => {
            write(&binary.left, text)?;
            *text += &tokens(binary.op.to_token_stream());
            write(&binary.right, text)?;
        }
        Expr::Unary(unary) => {
            *text += &tokens(unary.op.to_token_stream());
            write(&unary.expr, text)?;
        }
        Expr::Lit(literal) => {
            write!(text, "{} ", literal.lit.to_token_stream()).expect("a string takes all text")
        }
        Expr::Path(path) => {
            for (place, segment) in path.path.segments.iter().enumerate() {
                *text += if place > 0 { ": : " } else { "" };
                write_name(false, &segment.ident, text);
            }
        }
        Expr::Call(call) => {
            write(&call.func, text)?;
            write_list(("( ", ") "), call.args.iter(), text)?;
        }
        Expr::MethodCall(call) => {
            write(&call.receiver, text)?;
            *text += ". ";
            write_name(false, &call.method, text);
            write_list(("( ", ") "), call.args.iter(), text)?;
        }
        Expr::Index(index) => {
            write(&index.expr, text)?;
            write_list(("[ ", "] "), [&*index.index], text)?;
        }
        Expr::Field(field) => {
            write(&field.base, text)?;
            write!(text, ". {} ", field.member.to_token_stream()).expect("a string takes all text");
        }
        Expr::Array(array) => write_list(("[ ", "] "), array.elems.iter(), text)?,
        // Of a buffer that is zeroed.
        Expr::Repeat(repeat) => {
            *text += "[ ";
            write(&repeat.expr, text)?;
            *text += "; ";
            write(&repeat.len, text)?;
            *text += "] ";
        }
        Expr::Tuple(tuple) => write_list(("( ", ") "), tuple.elems.iter(), text)?,
        Expr::Reference(reference) => {
            *text += if reference.mutability.is_some() { "& mut " } else { "& " };
            write(&reference.expr, text)?;
        }
        Expr::Assign(assign) => {
            write(&assign.left, text)?;
            *text += "= ";
            write(&assign.right, text)?;
        }
        Expr::Struct(value) => {
            *text += &tokens(value.path.to_token_stream());
            *text += "{ ";
            for (place, field) in value.fields.iter().enumerate() {
                *text += if place > 0 { ", " } else { "" };
                write!(text, "{} : ", field.member.to_token_stream()).expect("a string takes all text");
                write(&field.expr, text)?;
            }
            *text += "} ";
        }
        Expr::Block(block) => {
            *text += "{ ";
            block.block.stmts.iter().try_for_each(|statement| write_statement(statement, text))?;
            *text += "} ";
        }
        Expr::ForLoop(repeated) => {
            let Pat::Ident(name) = &*repeated.pat else { return Err(refused(repeated)) };
            write!(text, "for {} in ", name.ident).expect("a string takes all text");
            write(&repeated.expr, text)?;
            *text += "{ ";
            repeated.body.stmts.iter().try_for_each(|statement| write_statement(statement, text))?;
            *text += "} ";
        }
        Expr::Range(range) => {
            let (Some(start), Some(end)) = (&range.start, &range.end) else { return Err(refused(range)) };
            write(start, text)?;
            *text += &tokens(range.limits.to_token_stream());
            write(end, text)?;
        }
        // Of a block that is compiled apart.
        Expr::Closure(closure) => {
            *text += "move | | ";
            write(&closure.body, text)?;
        }
        other => return Err(refused(other)),
    }
    Ok(())
}

fn write_list<'e>(
    (open, close): (&str, &str),
    elements: impl IntoIterator<Item = &'e Expr>,
    text: &mut String,
) -> Result<(), Refusal> {
    *text += open;
    for (place, element) in elements.into_iter().enumerate() {
        *text += if place > 0 { ", " } else { "" };
        write_expression(element, text)?;
    }
    *text += close;
    Ok(())
}
