//! Tables of prescribed motions: the constants at the head of a module.

use crate::refusal::Refusal;
use gyro_model::{Model, Motion, Spline};
use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};

/// The tables of a module in their order. Each must be a table of the model, number for number. A table can have a hundred thousand
/// rows, so its tokens are read as they come; that nothing else stands there is for [`matching`](super::matching) to say.
pub fn read(model: &Model, tokens: TokenStream) -> Result<Vec<Spline>, Refusal> {
    let constants = arrays(tokens);
    let knots = constants.iter().filter_map(|(name, array)| Some((name.strip_prefix("KNOTS_")?, array)));
    knots
        .map(|(number, array)| {
            let times = numbers(array)?;
            let pieces = format!("PIECES_{number}");
            let Some((_, pieces)) = constants.iter().find(|(name, _)| *name == pieces) else {
                return Err(Refusal::at(array.span(), format!("`{pieces}` is missing")));
            };
            let pieces: Vec<[f64; 4]> =
                elements(pieces).iter().map(|e| piece(e)).collect::<Result<_, _>>()?;
            let same = |table: &&Spline| table.knots == times && table.pieces == pieces;
            of_model(model).into_iter().find(same).cloned().ok_or_else(|| {
                Refusal::at(array.span(), format!("`KNOTS_{number}` is no table of the model"))
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

/// Constants of arrays by their names: `const NAME: [type] = [elements];`, at the head of a module.
fn arrays(tokens: TokenStream) -> Vec<(String, Group)> {
    let (mut found, mut name, mut is_value) = (Vec::new(), None, false);
    let mut before = None;
    for token in tokens {
        match &token {
            TokenTree::Ident(word) if before.as_ref().is_some_and(|b| is_word(b, "const")) => {
                (name, is_value) = (Some(word.to_string()), false);
            }
            TokenTree::Punct(mark) => is_value = mark.as_char() == '=',
            TokenTree::Group(array) if is_value && array.delimiter() == Delimiter::Bracket => {
                if let Some(name) = name.take() {
                    found.push((name, array.clone()));
                }
            }
            _ => {}
        }
        before = Some(token);
    }
    found
}

fn is_word(token: &TokenTree, word: &str) -> bool {
    matches!(token, TokenTree::Ident(found) if found == word)
}

/// What stands between commas.
fn elements(array: &Group) -> Vec<Vec<TokenTree>> {
    let mut elements = vec![Vec::new()];
    for token in array.stream() {
        match (&token, elements.last_mut()) {
            (TokenTree::Punct(mark), _) if mark.as_char() == ',' => elements.push(Vec::new()),
            (_, Some(element)) => element.push(token),
            (_, None) => {}
        }
    }
    elements.pop_if(|last| last.is_empty());
    elements
}

fn numbers(array: &Group) -> Result<Vec<f64>, Refusal> {
    elements(array).iter().map(|element| number(element, array.span())).collect()
}

fn piece(element: &[TokenTree]) -> Result<[f64; 4], Refusal> {
    let [TokenTree::Group(group)] = element else {
        let span = element.first().map_or(Span::call_site(), TokenTree::span);
        return Err(Refusal::at(span, "expected an array"));
    };
    let numbers = numbers(group)?;
    numbers.try_into().map_err(|_| Refusal::at(group.span(), "a piece has four coefficients"))
}

/// A decimal with its sign.
fn number(element: &[TokenTree], around: Span) -> Result<f64, Refusal> {
    let (sign, literal) = match element {
        [TokenTree::Punct(mark), TokenTree::Literal(literal)] if mark.as_char() == '-' => (-1.0, literal),
        [TokenTree::Literal(literal)] => (1.0, literal),
        _ => {
            let span = element.first().map_or(around, TokenTree::span);
            return Err(Refusal::at(span, "expected a decimal"));
        }
    };
    let text = literal.to_string();
    let is_float = text.contains(['.', 'e']);
    let value = text.parse::<f64>().ok().filter(|value| is_float && value.is_finite());
    value
        .map(|value| sign * value)
        .ok_or_else(|| Refusal::at(literal.span(), format!("`{text}` is no decimal")))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The arrays of a text and, where they are of numbers, the numbers.
    fn read(text: &str) -> Vec<(String, Option<Vec<f64>>)> {
        let tokens: TokenStream = text.parse().unwrap();
        arrays(tokens).into_iter().map(|(name, array)| (name, numbers(&array).ok())).collect()
    }

    #[test]
    fn arrays_are_read_number_for_number() {
        let found = read(
            "/// Times.\nconst A: [f64; 3] = [0.0, -1e-3, 2.5]; const B: [f64; 0] = []; fn f() { [1.0] }",
        );
        let expected = [("A".to_owned(), Some(vec![0.0, -1e-3, 2.5])), ("B".to_owned(), Some(vec![]))];
        assert_eq!(found, expected);
    }

    #[test]
    fn what_is_no_decimal_is_refused() {
        for element in ["1", "--1.0", "+1.0", "1.0 + 2.0", "1.0f32", "x", "[1.0]", "", "1.0 1.0", "inf"] {
            let text = format!("const A: [f64; 2] = [0.5, {element}, 1.5];");
            assert_eq!(read(&text), [("A".to_owned(), None)], "{element}");
        }
    }
}
