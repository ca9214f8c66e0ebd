//! Where the operands of a loop come from, and the arrays that hand numbers from one part of a function to another.

use super::loops::{Direction, Loops};
use super::orbits::{Orbit, Orbits};
use super::terms::{Kind, Place, Terms};
use crate::equations::Argument;
use std::collections::BTreeMap;

/// Where an operand of an orbit comes from, for all parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Source {
    /// The member of that orbit for the same part.
    Local(Orbit),
    /// A column's row, so many rows after that of the part.
    Row { column: usize, offset: i64 },
    /// Elements of an argument: that of the first part, and how far apart they are.
    Element { first: Place, stride: usize },
    /// One term, whatever the part.
    Same(Place),
}

/// A number for each of several parts.
#[derive(Debug)]
pub struct Column {
    /// Computed in the orbit's loop.
    pub orbit: Option<Orbit>,
    /// The orbit's loop alone reads it, and of the part before: each part overwrites what that has left.
    pub is_carried: bool,
    /// Rows that are filled outside of loops.
    pub rows: BTreeMap<i64, Place>,
    /// The first loop that reads each of them.
    pub readers: BTreeMap<i64, usize>,
    /// The loop that a column is for that no loop computes.
    pub reader: usize,
}

#[derive(Debug)]
pub struct Columns {
    pub all: Vec<Column>,
    /// Of each orbit the sources of its operands.
    pub sources: BTreeMap<Orbit, Vec<Source>>,
}

/// Which array an element of an argument is in, and where.
pub type Element = (Argument, usize);

struct Filling<'t> {
    terms: &'t Terms,
    orbits: &'t Orbits,
    loops: &'t Loops,
    elements: &'t dyn Fn(Place) -> Option<Element>,
    columns: Vec<Column>,
}

impl Columns {
    /// `None` if a loop would have to read of itself what is not the same for all parts.
    pub fn of(
        terms: &Terms,
        orbits: &Orbits,
        loops: &Loops,
        elements: &dyn Fn(Place) -> Option<Element>,
    ) -> Option<Self> {
        let mut filling = Filling { terms, orbits, loops, elements, columns: Vec::new() };
        let mut sources = BTreeMap::new();
        for (index, found) in loops.all.iter().enumerate() {
            for &orbit in &found.orbits {
                let n_operands = orbits.operands[orbits.members[orbit][0]].len();
                let of: Option<Vec<_>> =
                    (0..n_operands).map(|slot| filling.source(index, orbit, slot)).collect();
                sources.insert(orbit, of?);
            }
        }
        filling.read_outside(&sources);
        Some(Self { all: filling.columns, sources })
    }

    /// Whether a loop fills a row.
    pub fn is_computed(&self, loops: &Loops, orbits: &Orbits, column: usize, row: i64) -> bool {
        let computed = self.all[column].orbit.and_then(|orbit| loops.of_orbit(orbits, orbit));
        computed.is_some_and(|index| (loops.all[index].first..=loops.all[index].last).contains(&row))
    }

    /// The column in which the number of an orbit's part stands when its loop is done.
    pub fn of_part(&self, loops: &Loops, orbits: &Orbits, (orbit, part): (Orbit, i64)) -> Option<usize> {
        column_of_part(&self.all, (loops, orbits), (orbit, part))
    }
}

fn column_of_part(
    columns: &[Column],
    (loops, orbits): (&Loops, &Orbits),
    (orbit, part): (Orbit, i64),
) -> Option<usize> {
    let is_last = || loops.of_orbit(orbits, orbit).is_some_and(|index| loops.last_done(index) == part);
    let serves = |column: &Column| column.orbit == Some(orbit) && (!column.is_carried || is_last());
    columns.iter().position(serves)
}

impl Filling<'_> {
    fn source(&mut self, index: usize, orbit: Orbit, slot: usize) -> Option<Source> {
        let own = &self.loops.all[index];
        let parts = own.first..=own.last;
        let operand = |part: i64| {
            let member = self.loops.member(self.orbits, orbit, part);
            self.orbits.operands[member][slot].term
        };
        let read: Vec<(i64, Place)> = parts.map(|part| (part, operand(part))).collect();
        let first = read[0].1;
        if read.iter().all(|&(_, term)| term == first) {
            return (self.loops.of_term[first].is_none_or(|(of, _)| of != index))
                .then_some(Source::Same(first));
        }
        if let Some(stride) = self.stride(&read) {
            return Some(Source::Element { first, stride });
        }
        let mut votes: BTreeMap<(Orbit, i64), usize> = BTreeMap::new();
        for &(part, term) in &read {
            if let (Some((_, at)), Some((of, _))) = (self.loops.of_term[term], self.orbits.of_term[term]) {
                *votes.entry((of, at - part)).or_default() += 1;
            }
        }
        let most = votes.iter().max_by_key(|(_, count)| **count).map(|(key, _)| *key);
        if let Some((of, offset)) = most {
            let computed = self.loops.of_orbit(self.orbits, of)?;
            let range = &self.loops.all[computed];
            let rows = read.iter().map(|&(part, term)| (part + offset, term));
            let fits = |&(row, term): &(i64, Place)| {
                let is_computed = row >= range.first && row <= range.last;
                if is_computed {
                    self.loops.member(self.orbits, of, row) == term
                } else {
                    self.loops.of_term[term].is_none_or(|(other, _)| other != index)
                }
            };
            if offset == 0 && computed == index {
                let is_local =
                    rows.clone().all(|(row, term)| self.loops.member(self.orbits, of, row) == term);
                return is_local.then_some(Source::Local(of));
            }
            // What a loop reads of itself comes before.
            let is_before = match own.direction {
                Direction::Forward => offset < 0,
                Direction::Backward => offset > 0,
            };
            if (is_before || computed != index) && rows.clone().all(|row| fits(&row)) {
                let straight = rows
                    .filter(|(row, _)| *row < range.first || *row > range.last)
                    .collect::<BTreeMap<_, _>>();
                let is_carried = computed == index && offset.abs() == 1;
                let column = self.column(index, (Some(of), is_carried), straight);
                return Some(Source::Row { column, offset });
            }
        }
        let is_own = |&(_, term): &(i64, Place)| self.loops.of_term[term].is_some_and(|(of, _)| of == index);
        if read.iter().any(is_own) {
            return None;
        }
        let column = self.column(index, (None, false), read.into_iter().collect());
        Some(Source::Row { column, offset: 0 })
    }

    /// How far apart the elements of an argument are that are read.
    fn stride(&self, read: &[(i64, Place)]) -> Option<usize> {
        let is_variable =
            |&(_, term): &(i64, Place)| matches!(self.terms.all[term].kind, Kind::Variable { .. });
        if !read.iter().all(is_variable) {
            return None;
        }
        let places: Option<Vec<Element>> = read.iter().map(|&(_, term)| (self.elements)(term)).collect();
        let places = places?;
        let stride = places[1].1.checked_sub(places[0].1)?;
        let is_even = places.windows(2).all(|pair| pair[0].0 == pair[1].0 && pair[0].1 + stride == pair[1].1);
        (is_even && stride > 0).then_some(stride)
    }

    /// A column with these rows, one that there is already if it has none that differ.
    fn column(
        &mut self,
        reader: usize,
        (orbit, is_carried): (Option<Orbit>, bool),
        rows: BTreeMap<i64, Place>,
    ) -> usize {
        let agrees = |column: &Column| {
            (column.orbit, column.is_carried) == (orbit, is_carried)
                && (orbit.is_some() || column.reader == reader)
                && rows.iter().all(|(row, term)| column.rows.get(row).is_none_or(|known| known == term))
        };
        let at = self.columns.iter().position(agrees).unwrap_or_else(|| {
            let (rows, readers) = (BTreeMap::new(), BTreeMap::new());
            self.columns.push(Column { orbit, is_carried, rows, readers, reader });
            self.columns.len() - 1
        });
        let column = &mut self.columns[at];
        for &row in rows.keys() {
            let first = column.readers.entry(row).or_insert(reader);
            *first = reader.min(*first);
        }
        column.rows.extend(rows);
        at
    }

    /// Whatever is read outside of loops has a column.
    fn read_outside(&mut self, sources: &BTreeMap<Orbit, Vec<Source>>) {
        let mut needed: Vec<(Orbit, i64)> = Vec::new();
        let mut need = |term: Place| {
            if let (Some((_, part)), Some((orbit, _))) = (self.loops.of_term[term], self.orbits.of_term[term])
            {
                needed.push((orbit, part));
            }
        };
        for (term, operands) in self.orbits.operands.iter().enumerate() {
            if self.loops.of_term[term].is_none() {
                operands.iter().for_each(|operand| need(operand.term));
            }
        }
        self.terms.roots.iter().for_each(|root| need(root.term));
        let same = self.columns.iter().flat_map(|column| column.rows.values());
        same.for_each(|&term| need(term));
        for source in sources.values().flatten() {
            if let Source::Same(term) = source {
                need(*term);
            }
        }
        for part in needed {
            if column_of_part(&self.columns, (self.loops, self.orbits), part).is_none() {
                self.columns.push(Column {
                    orbit: Some(part.0),
                    is_carried: false,
                    rows: BTreeMap::new(),
                    readers: BTreeMap::new(),
                    reader: 0,
                });
            }
        }
    }
}
