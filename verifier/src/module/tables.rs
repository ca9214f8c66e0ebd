//! Tables of prescribed motions: the constants at the head of a module.

use super::expression::decimal;
use crate::refusal::Refusal;
use gyro_model::{Model, Motion, Spline};
use proc_macro2::TokenStream;
use syn::spanned::Spanned;
use syn::{Expr, File, Item};

/// The tables of a module in their order. Each must be a table of the model, number for number.
pub fn read(model: &Model, tokens: TokenStream) -> Result<Vec<Spline>, Refusal> {
    let file: File = syn::parse2(tokens)?;
    let constants =
        file.items.iter().filter_map(|item| if let Item::Const(c) = item { Some(c) } else { None });
    let knots = constants.filter(|constant| constant.ident.to_string().starts_with("KNOTS_"));
    knots
        .map(|constant| {
            let times = elements(&constant.expr)?.into_iter().map(number).collect::<Result<Vec<f64>, _>>()?;
            let pieces = pieces(&file, &constant.ident.to_string().replace("KNOTS_", "PIECES_"))?;
            let same = |table: &&Spline| table.knots == times && table.pieces == pieces;
            of_model(model).into_iter().find(same).cloned().ok_or_else(|| {
                Refusal::at(constant.span(), format!("`{}` is no table of the model", constant.ident))
            })
        })
        .collect()
}

/// All tables that motions of the model follow.
pub fn of_model(model: &Model) -> Vec<&Spline> {
    let mut tables = Vec::new();
    model.drivers.iter().for_each(|driver| collect(&driver.motion, &mut tables));
    for motion in model.bodies.iter().filter_map(|body| body.motion.as_ref()) {
        motion.translation.iter().for_each(|m| collect(m, &mut tables));
        motion.rotations.iter().for_each(|(_, angle)| collect(angle, &mut tables));
    }
    tables
}

fn collect<'m>(motion: &'m Motion, tables: &mut Vec<&'m Spline>) {
    match motion {
        Motion::Polynomial(_) | Motion::Sinusoid { .. } => {}
        Motion::Sum(parts) | Motion::Product(parts) => parts.iter().for_each(|part| collect(part, tables)),
        Motion::Table(table) => tables.push(table),
    }
}

fn pieces(file: &File, name: &str) -> Result<Vec<[f64; 4]>, Refusal> {
    let constant = file.items.iter().find_map(|item| match item {
        Item::Const(constant) if constant.ident == name => Some(constant),
        _ => None,
    });
    let Some(constant) = constant else { return Err(Refusal::new(1, format!("`{name}` is missing"))) };
    let piece = |piece: &Expr| {
        let numbers = elements(piece)?.into_iter().map(number).collect::<Result<Vec<f64>, _>>()?;
        numbers.try_into().map_err(|_| Refusal::at(piece.span(), "a piece has four coefficients"))
    };
    elements(&constant.expr)?.into_iter().map(piece).collect()
}

fn elements(expression: &Expr) -> Result<Vec<&Expr>, Refusal> {
    match expression {
        Expr::Array(array) => Ok(array.elems.iter().collect()),
        other => Err(Refusal::at(other.span(), "expected an array")),
    }
}

fn number(expression: &Expr) -> Result<f64, Refusal> {
    let text = decimal(expression)?;
    text.parse().map_err(|_| Refusal::at(expression.span(), format!("`{text}` is no number")))
}
