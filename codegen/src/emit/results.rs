//! How a function hands over its results: in one assignment, or, where loops have computed them, by loops that copy
//! columns of their arrays to places that are evenly apart.

use crate::emit::names::{ident, index};
use crate::tape::{Arranged, Array, Copied, Run, arranged};
use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, quote};

/// A result of a function.
#[derive(Clone, Debug)]
pub struct Value {
    pub tokens: TokenStream,
    /// What it copies, if it does nothing else.
    pub copied: Option<Copied>,
}

impl Value {
    /// The element of what another function has filled, or of an argument.
    pub fn of_named(array: &'static str, row: usize) -> Self {
        let (name, at) = (ident(array), index(row));
        Self { tokens: quote! { #name[#at] }, copied: Some(Copied::of_named(array, row)) }
    }
}

impl ToTokens for Value {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        self.tokens.to_tokens(tokens);
    }
}

/// Fills an array with results.
pub fn filled(target: &str, values: &[Value]) -> TokenStream {
    let (name, places): (_, Vec<usize>) = (ident(target), (0..values.len()).collect());
    stored_in_loops(target, &places, values).unwrap_or_else(|| quote! { *#name = [#(#values),*]; })
}

/// Stores results at these places of an array, which ascend.
pub fn stored(target: &str, places: &[usize], values: &[Value]) -> TokenStream {
    let (name, at) = (ident(target), places.iter().copied().map(index));
    stored_in_loops(target, places, values).unwrap_or_else(|| quote! { #(#name[#at] = #values;)* })
}

/// Nothing if loops have not computed enough of them.
fn stored_in_loops(target: &str, places: &[usize], values: &[Value]) -> Option<TokenStream> {
    let stores: Vec<_> = places.iter().zip(values).map(|(&place, value)| (place, value.copied)).collect();
    let Arranged { loops, rest } = arranged(&stores)?;
    let name = ident(target);
    let loops = loops.iter().map(|(count, runs)| {
        let (count, stores) = (index(*count), runs.iter().map(|run| store(&name, run)));
        quote! { for i in 0..#count { #(#stores)* } }
    });
    let rest = rest.into_iter().map(|n| {
        let (place, value) = (index(places[n]), &values[n]);
        quote! { #name[#place] = #value; }
    });
    Some(quote! { #(#loops)* #(#rest)* })
}

fn store(target: &Ident, run: &Run) -> TokenStream {
    let (place, row) = (evenly(run.place, run.places_apart), evenly(run.row, run.rows_apart));
    let sign = run.from.is_negative.then(|| quote! { - });
    match run.from.of {
        Array::Named(array) => {
            let array = ident(array);
            quote! { #target[#place] = #sign #array[#row]; }
        }
        Array::Kept { array, column } => {
            let (array, column) = (kept_name(array), index(column));
            quote! { #target[#place] = #sign #array[#row][#column]; }
        }
    }
}

/// The name of an array that loops fill.
pub fn kept_name(array: usize) -> Ident {
    ident(&format!("kept{array}"))
}

/// `i`, `i + 3`, `7 * i`, `7 * i + 3`.
pub fn evenly(first: usize, apart: usize) -> TokenStream {
    let i = match apart {
        1 => quote! { i },
        _ => {
            let apart = index(apart);
            quote! { #apart * i }
        }
    };
    if first == 0 {
        return i;
    }
    let first = index(first);
    quote! { #i + #first }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tape::{LEAST_COPIES, Source};

    fn kept(row: usize, column: usize) -> Value {
        let from = Source { of: Array::Kept { array: 0, column }, is_negative: column == 1 };
        let (at, column) = (index(row), index(column));
        Value { tokens: quote! { kept0[#at][#column] }, copied: Some(Copied { from, row }) }
    }

    fn text(tokens: &TokenStream) -> String {
        tokens.to_string().replace(' ', "")
    }

    /// Two columns go to places three apart; what is between them, and the ends, are stored one by one.
    #[test]
    fn columns_are_copied_in_one_loop() {
        let other = || Value { tokens: quote! { t0 }, copied: None };
        let values: Vec<Value> = (0..9).flat_map(|row| [kept(row + 1, 0), other(), kept(row, 1)]).collect();
        let stores: String = (0..9).map(|k| format!("out[{}]=t0;", 3 * k + 1)).collect();
        let expected = "fori0..9{out[3*i]=kept0[i+1][0];out[3*i+2]=-kept0[i][1];}";
        let expected = expected.replace("fori0", "foriin0");
        assert_eq!(text(&filled("out", &values)), expected + &stores);
    }

    /// Too few copies are one assignment.
    #[test]
    fn short_runs_stay_in_one_assignment() {
        let values: Vec<Value> = (0..LEAST_COPIES - 1).map(|row| kept(row, 0)).collect();
        assert!(text(&filled("out", &values)).starts_with("*out=["));
    }
}
