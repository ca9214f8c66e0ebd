//! Literals and the exact constants that they are rounded from.
//!
//! Different constants may round to one literal, so each occurrence of a literal knows its own. While a text is put
//! together the place of a constant stands for its literal, as an integer: `k(3)`. When all of it is there, one walk in
//! the order of the text writes the literals and notes which occurrence stands for what.

use crate::expr::constant::Constant;
use proc_macro2::{Delimiter, Group, Literal, TokenStream, TokenTree};
use quote::quote;
use rustc_hash::FxHashMap as HashMap;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A literal that reads back as the same number.
pub fn float(value: f64) -> TokenStream {
    format!("{value:?}").parse().expect("a float prints as a literal")
}

/// The constants of a module's functions.
#[derive(Debug, Default)]
pub struct Literals {
    constants: RefCell<Vec<Constant>>,
    places: RefCell<HashMap<Constant, usize>>,
}

impl Literals {
    /// What stands for a literal until the text is complete.
    pub fn stand_in(&self, constant: &Constant) -> TokenStream {
        let mut constants = self.constants.borrow_mut();
        let place = *self.places.borrow_mut().entry(constant.clone()).or_insert_with(|| {
            constants.push(constant.clone());
            constants.len() - 1
        });
        let place = Literal::usize_unsuffixed(place);
        quote! { k(#place) }
    }

    /// The same in a table, which has literals alone.
    pub fn tabulated(&self, constant: &Constant) -> TokenStream {
        let stand_in = self.stand_in(constant);
        quote! { tabulated #stand_in }
    }

    /// The complete text with its literals, and the text that says what each of them stands for.
    pub fn write(self, text: TokenStream) -> (TokenStream, String) {
        let constants = self.constants.into_inner();
        let literal = |constant: &Constant| float(constant.to_f64());
        let literals: Vec<_> = constants.iter().map(literal).collect();
        let mut written = Written { constants: &constants, literals: &literals, places: Vec::new() };
        let text = written.literals(text);
        let names: Vec<String> =
            literals.iter().map(|literal| literal.to_string().replace(' ', "")).collect();
        let mut occurrences: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for &place in &written.places {
            occurrences.entry(&names[place]).or_default().push(place);
        }
        let lines = occurrences.iter().map(|(literal, places)| written.line(literal, places));
        (text, lines.collect())
    }
}

struct Written<'a> {
    constants: &'a [Constant],
    literals: &'a [TokenStream],
    /// What the occurrences of literals stand for, by its place, in the order of the text.
    places: Vec<usize>,
}

impl Written<'_> {
    fn literals(&mut self, text: TokenStream) -> TokenStream {
        let (mut is_literal, mut is_tabulated) = (false, false);
        let mut written = TokenStream::new();
        for token in text {
            let is = |name: &str| matches!(&token, TokenTree::Ident(found) if found == name);
            if is("tabulated") || is_tabulated && is("k") {
                (is_tabulated, is_literal) = (true, is("k"));
                continue;
            }
            let follows = std::mem::replace(&mut is_literal, is("k"));
            let TokenTree::Group(group) = token else {
                written.extend([token]);
                continue;
            };
            match stood_for(&group).filter(|_| follows) {
                Some(place) if std::mem::take(&mut is_tabulated) => written.extend(self.literal(place)),
                Some(place) => {
                    let literal = self.literal(place);
                    written.extend([TokenTree::from(Group::new(group.delimiter(), literal))]);
                }
                None => {
                    let inner = self.literals(group.stream());
                    written.extend([TokenTree::from(Group::new(group.delimiter(), inner))]);
                }
            }
        }
        written
    }

    fn literal(&mut self, place: usize) -> TokenStream {
        self.places.push(place);
        self.literals[place].clone()
    }

    /// `0.1 = 1/10`, or `0.1 = 1/10, 1000000000000000000001/10000000000000000000000 as 1*3 2`: the first three
    /// occurrences stand for the first number, the fourth for the second.
    fn line(&self, literal: &str, occurrences: &[usize]) -> String {
        let mut values: Vec<usize> = Vec::new();
        let mut runs: Vec<(usize, usize)> = Vec::new();
        for &place in occurrences {
            let value = values.iter().position(|&known| known == place).unwrap_or(values.len());
            if value == values.len() {
                values.push(place);
            }
            match runs.last_mut().filter(|(last, _)| *last == value) {
                Some((_, length)) => *length += 1,
                None => runs.push((value, 1)),
            }
        }
        let numbers: Vec<_> = values.iter().map(|&place| self.constants[place].to_string()).collect();
        let mut line = format!("{literal} = {}", numbers.join(", "));
        if values.len() > 1 {
            line += " as";
            runs.iter().for_each(|&(value, length)| line += &run(value + 1, length));
        }
        line + "\n"
    }
}

/// ` 2` or ` 2*5`.
fn run(value: usize, length: usize) -> String {
    let mut run = format!(" {value}");
    if length > 1 {
        write!(run, "*{length}").expect("a string takes all that is written");
    }
    run
}

/// The place in `(3)`.
fn stood_for(group: &Group) -> Option<usize> {
    let mut tokens = group.stream().into_iter();
    let (Some(TokenTree::Literal(place)), None) = (tokens.next(), tokens.next()) else { return None };
    place.to_string().parse().ok().filter(|_| group.delimiter() == Delimiter::Parenthesis)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyro_model::parse_decimal;

    fn number(text: &str) -> Constant {
        Constant::rational(parse_decimal(text).expect("a decimal"))
    }

    #[test]
    fn occurrences_are_told_apart_in_the_order_of_the_text() {
        let literals = Literals::default();
        let (half, third, longer) =
            (number("0.5"), number("0.3333333333333333"), number("0.33333333333333330001"));
        let [half, third, longer] = [&half, &third, &longer].map(|number| literals.stand_in(number));
        // Not in the order in which they were made.
        let text = quote! { fn f() { g(#longer * (#third + #half), #third); #third - #longer } };
        let (text, exact) = literals.write(text);
        let expected = "fn f () { g (k (0.3333333333333333) * (k (0.3333333333333333) + k (0.5)) , \
            k (0.3333333333333333)) ; k (0.3333333333333333) - k (0.3333333333333333) }";
        assert_eq!(text.to_string(), expected);
        let (short, long) =
            ("3333333333333333/10000000000000000", "33333333333333330001/100000000000000000000");
        assert_eq!(exact, format!("0.3333333333333333 = {long}, {short} as 1 2*3 1\n0.5 = 1/2\n"));
    }
}
