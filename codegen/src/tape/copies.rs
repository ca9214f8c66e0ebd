//! Numbers that a function hands over as they are, from arrays that were filled before: loops copy those that are
//! evenly apart on both sides.

use super::{Operation, Place, Tape};
use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeMap;

/// An array that numbers are copied from, and whether their opposites are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Source {
    /// The array.
    pub of: Array,
    /// Whether the opposite is taken.
    pub is_negative: bool,
}

/// An array that was filled before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Array {
    /// A column of an array that loops fill.
    Kept {
        /// Which array.
        array: usize,
        /// Its column.
        column: usize,
    },
    /// What another function has filled, or an argument, by its name.
    Named(&'static str),
}

/// A number that is copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Copied {
    /// Where it comes from.
    pub from: Source,
    /// Which row of it, or which element.
    pub row: usize,
}

/// Copies that are evenly apart on both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Where they come from.
    pub from: Source,
    /// The first one's row.
    pub row: usize,
    /// How far the next row is from it.
    pub rows_apart: usize,
    /// The place that the first one goes to.
    pub place: usize,
    /// How far the next place is from it.
    pub places_apart: usize,
    /// How many there are.
    pub count: usize,
}

/// Which numbers loops copy, and which are stored one by one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arranged {
    /// Loops, each with how often it goes round and what it copies.
    pub loops: Vec<(usize, Vec<Run>)>,
    /// The numbers that are left, in their order.
    pub rest: Vec<usize>,
}

/// Copies that are worth a line of a loop.
pub(crate) const LEAST_COPIES: usize = 8;

/// With how many copies of the same column each is tried as the first two of a run.
const MOST_TRIED: usize = 16;

impl Copied {
    /// An element of what another function has filled, or of an argument.
    pub fn of_named(array: &'static str, row: usize) -> Self {
        Self { from: Source { of: Array::Named(array), is_negative: false }, row }
    }
}

impl<V, C> Tape<V, C> {
    /// What a number copies of an array that loops fill, if it does nothing else: `kept` tells array, row and column of
    /// a variable that is an element of one, and what has a name is none.
    pub fn copied(
        &self,
        place: Place,
        has_name: impl Fn(Place) -> bool,
        kept: impl Fn(&V) -> Option<[usize; 3]>,
    ) -> Option<Copied> {
        let (mut place, mut is_negative) = (place, false);
        while !has_name(place) {
            match self.operation(place) {
                Operation::Negate(of) => (place, is_negative) = (*of, !is_negative),
                Operation::Variable(variable) => {
                    let [array, row, column] = kept(variable)?;
                    return Some(Copied {
                        from: Source { of: Array::Kept { array, column }, is_negative },
                        row,
                    });
                }
                _ => return None,
            }
        }
        None
    }
}

/// How numbers are stored at ascending places of an array, each with what it copies; nothing if loops have not computed
/// enough of them.
pub fn arranged(stores: &[(usize, Option<Copied>)]) -> Option<Arranged> {
    let copies: Vec<(usize, Copied)> =
        stores.iter().filter_map(|&(place, copied)| Some((place, copied?))).collect();
    if !copies.iter().any(|(_, copied)| matches!(copied.from.of, Array::Kept { .. })) {
        return None;
    }
    let runs = runs(&copies);
    if runs.is_empty() {
        return None;
    }
    let mut is_copied: HashMap<usize, bool> = stores.iter().map(|&(place, _)| (place, false)).collect();
    let mut by_count: BTreeMap<usize, Vec<Run>> = BTreeMap::new();
    for run in runs {
        (0..run.count).for_each(|k| *is_copied.entry(run.place + k * run.places_apart).or_default() = true);
        by_count.entry(run.count).or_default().push(run);
    }
    let rest = (0..stores.len()).filter(|&n| !is_copied[&stores[n].0]).collect();
    Some(Arranged { loops: by_count.into_iter().rev().collect(), rest })
}

/// The runs among copies, by their places.
fn runs(copies: &[(usize, Copied)]) -> Vec<Run> {
    let mut open: HashMap<usize, Copied> = copies.iter().copied().collect();
    let mut of_column: HashMap<Source, Vec<(usize, usize)>> = HashMap::default();
    for (place, copied) in copies {
        of_column.entry(copied.from).or_default().push((*place, copied.row));
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
                let expected = Copied { from: copied.from, row: copied.row + k * rows_apart };
                open.get(&(place + k * places_apart)) == Some(&expected)
            };
            let count = (0..).take_while(continues).count();
            Run { from: copied.from, row: copied.row, rows_apart, place, places_apart, count }
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

#[cfg(test)]
mod tests;
