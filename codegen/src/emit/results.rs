//! How a function hands over its results: in one assignment, or, where loops have computed them, by loops that copy
//! columns of their arrays to places that are evenly apart.

use crate::emit::names::{ident, index};
use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, quote};
use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeMap;

/// A result of a function.
#[derive(Clone, Debug)]
pub struct Value {
    pub tokens: TokenStream,
    /// What it copies, if it does nothing else.
    pub copied: Option<Copied>,
}

/// An element of an array that was filled before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Copied {
    pub from: Source,
    pub row: usize,
}

/// An array, or a column of one that loops fill.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Source {
    pub array: String,
    pub column: Option<usize>,
    /// Whether the opposite is taken.
    pub is_negative: bool,
}

/// Copies that are evenly apart on both sides.
#[derive(Debug)]
struct Run {
    from: Source,
    /// Where the first comes from and where it goes to, and how far the next is from it.
    row: usize,
    rows_apart: usize,
    place: usize,
    places_apart: usize,
    count: usize,
}

/// Copies that are worth a line of a loop.
const LEAST_COPIES: usize = 8;

/// With how many copies of the same column each is tried as the first two of a run.
const MOST_TRIED: usize = 16;

impl Value {
    /// The element of a buffer.
    pub fn of_buffer(array: &str, row: usize) -> Self {
        let (name, at) = (ident(array), index(row));
        let from = Source { array: array.to_owned(), column: None, is_negative: false };
        Self { tokens: quote! { #name[#at] }, copied: Some(Copied { from, row }) }
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
    let copies: Vec<(usize, &Copied)> = places
        .iter()
        .copied()
        .zip(values)
        .filter_map(|(place, v)| Some((place, v.copied.as_ref()?)))
        .collect();
    if copies.iter().all(|(_, copied)| copied.from.column.is_none()) {
        return None;
    }
    let runs = runs(&copies);
    if runs.is_empty() {
        return None;
    }
    let mut is_copied: HashMap<usize, bool> = places.iter().map(|&place| (place, false)).collect();
    let mut by_count: BTreeMap<usize, Vec<&Run>> = BTreeMap::new();
    for run in &runs {
        (0..run.count).for_each(|k| *is_copied.entry(run.place + k * run.places_apart).or_default() = true);
        by_count.entry(run.count).or_default().push(run);
    }
    let name = ident(target);
    let loops = by_count.into_iter().rev().map(|(count, runs)| {
        let (count, stores) = (index(count), runs.into_iter().map(|run| run.store(&name)));
        quote! { for i in 0..#count { #(#stores)* } }
    });
    let rest = places.iter().zip(values).filter(|(place, _)| !is_copied[place]).map(|(&place, value)| {
        let place = index(place);
        quote! { #name[#place] = #value; }
    });
    Some(quote! { #(#loops)* #(#rest)* })
}

/// The runs among copies, by their places.
fn runs(copies: &[(usize, &Copied)]) -> Vec<Run> {
    let mut open: HashMap<usize, &Copied> = copies.iter().copied().collect();
    let mut of_column: HashMap<&Source, Vec<(usize, usize)>> = HashMap::default();
    for (place, copied) in copies {
        of_column.entry(&copied.from).or_default().push((*place, copied.row));
    }
    let mut runs = Vec::new();
    for &(place, copied) in copies {
        if !open.contains_key(&place) {
            continue;
        }
        let beside = &of_column[&copied.from];
        let after = beside.partition_point(|&(other, _)| other <= place);
        let later = beside[after..].iter().filter(|(_, row)| *row > copied.row).take(MOST_TRIED);
        let run = later.map(|&(other, row)| {
            let (places_apart, rows_apart) = (other - place, row - copied.row);
            let continues = |k: &usize| {
                open.get(&(place + k * places_apart))
                    .is_some_and(|c| c.from == copied.from && c.row == copied.row + k * rows_apart)
            };
            let count = (0..).take_while(continues).count();
            Run { from: copied.from.clone(), row: copied.row, rows_apart, place, places_apart, count }
        });
        // Of runs of one length the first.
        let longest = run.reduce(|longest, run| if run.count > longest.count { run } else { longest });
        if let Some(run) = longest.filter(|run| run.count >= LEAST_COPIES) {
            (0..run.count).for_each(|k| _ = open.remove(&(place + k * run.places_apart)));
            runs.push(run);
        }
    }
    runs
}

impl Run {
    fn store(&self, target: &Ident) -> TokenStream {
        let (array, place) = (ident(&self.from.array), evenly(self.place, self.places_apart));
        let row = evenly(self.row, self.rows_apart);
        let column = self.from.column.map(|column| {
            let column = index(column);
            quote! { [#column] }
        });
        let sign = self.from.is_negative.then(|| quote! { - });
        quote! { #target[#place] = #sign #array[#row] #column; }
    }
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

    fn kept(row: usize, column: usize) -> Value {
        let from = Source { array: "kept0".to_owned(), column: Some(column), is_negative: column == 1 };
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

    /// Too few copies are no run, and buffers alone are no reason for one.
    #[test]
    fn short_runs_stay_in_one_assignment() {
        let values: Vec<Value> = (0..LEAST_COPIES - 1).map(|row| kept(row, 0)).collect();
        assert!(text(&filled("out", &values)).starts_with("*out=["));
        let values: Vec<Value> = (0..20).map(|row| Value::of_buffer("rates", row)).collect();
        assert!(text(&filled("out", &values)).starts_with("*out=["));
    }

    /// Whatever runs are found, every place gets its own value once: 200 random tables of copies.
    #[test]
    fn every_place_gets_its_value() {
        let mut state = 1_u64;
        let mut random = |n: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            usize::try_from(state >> 33).expect("31 bits") % n
        };
        for _ in 0..200 {
            let (n, columns) = (20 + random(80), 1 + random(3));
            let copies: Vec<Copied> = (0..n)
                .map(|k| kept(if random(9) == 0 { random(n) } else { k / columns }, k % columns))
                .map(|value| value.copied.expect("it is a copy"))
                .collect();
            let places: Vec<(usize, &Copied)> = copies.iter().enumerate().collect();
            let mut given: Vec<usize> = Vec::new();
            for run in runs(&places) {
                assert!(run.count >= LEAST_COPIES);
                for k in 0..run.count {
                    let place = run.place + k * run.places_apart;
                    let expected = Copied { from: run.from.clone(), row: run.row + k * run.rows_apart };
                    assert_eq!(copies[place], expected);
                    given.push(place);
                }
            }
            let n_given = given.len();
            given.sort_unstable();
            given.dedup();
            assert_eq!(given.len(), n_given, "a place is given twice");
        }
    }
}
