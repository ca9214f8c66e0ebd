//! Orbits: terms that are mapped to each other by the shift, in order.

use super::shift::Shift;
use super::terms::{Operand, Operands, Place, Terms};
use std::collections::BTreeMap;

/// Index of an orbit.
pub type Orbit = usize;

/// Terms that compute the same of what corresponds, one for each part.
#[derive(Debug)]
pub struct Orbits {
    pub members: Vec<Vec<Place>>,
    /// Orbit of each term, and which of its members it is.
    pub of_term: Vec<Option<(Orbit, usize)>>,
    /// The operands of each term, in the order in which they correspond to those of the other members.
    pub operands: Vec<Operands>,
    /// Orbits of different groups are not computed in one loop.
    pub groups: Vec<usize>,
}

impl Orbits {
    /// Those with at least so many members.
    pub fn of(terms: &Terms, shift: &Shift, n_least: usize) -> Self {
        let n = terms.all.len();
        let operands = terms.all.iter().map(|term| term.operands).collect();
        let (of_term, groups) = (vec![None; n], Vec::new());
        let mut orbits = Self { members: Vec::new(), of_term, operands, groups };
        for first in 0..n {
            if shift.previous[first].is_some() || !terms.all[first].kind.is_operation() {
                continue;
            }
            let members: Vec<Place> =
                std::iter::successors(Some(first), |&place| shift.next[place]).collect();
            if members.len() < n_least {
                continue;
            }
            let orbit = orbits.members.len();
            members.iter().enumerate().for_each(|(k, &place)| orbits.of_term[place] = Some((orbit, k)));
            orbits.align(terms, shift, &members);
            orbits.members.push(members);
            orbits.groups.push(0);
        }
        orbits
    }

    /// Puts the operands of commutative operations in the order of those of the member in the middle.
    fn align(&mut self, terms: &Terms, shift: &Shift, members: &[Place]) {
        if !terms.all[members[0]].kind.is_commutative() {
            return;
        }
        let corresponds = |one: Place, other: Place| {
            u8::from(shift.next[one] == Some(other)) * 2
                + u8::from(one == other)
                + u8::from(terms.all[one].kind == terms.all[other].kind)
        };
        let middle = members.len() / 2;
        let forward = (middle..members.len() - 1).map(|k| (k, k + 1));
        for (from, to) in forward.chain((0..middle).rev().map(|k| (k + 1, k))) {
            let [a, b] = [from, to].map(|k| self.operands[members[k]]);
            let pair = |a: Operand, b: Operand| {
                if from < to { corresponds(a.term, b.term) } else { corresponds(b.term, a.term) }
            };
            if pair(a[0], b[1]) + pair(a[1], b[0]) > pair(a[0], b[0]) + pair(a[1], b[1]) {
                self.operands[members[to]].swap(0, 1);
            }
        }
    }

    /// The unit of each term and that of each of its operands.
    pub fn pairs(&self, units: &[usize]) -> impl Iterator<Item = (usize, usize)> {
        self.operands
            .iter()
            .zip(units)
            .flat_map(move |(operands, &own)| operands.iter().map(move |operand| (own, units[operand.term])))
    }

    /// Each orbit of its group that operands of an orbit belong to, and how many members later the user comes: what
    /// holds for most members.
    pub fn main_edges(&self, orbit: Orbit) -> Vec<(Orbit, i64)> {
        let mut counts: BTreeMap<(Orbit, i64), usize> = BTreeMap::new();
        for (k, &member) in self.members[orbit].iter().enumerate() {
            for operand in self.operands[member].iter() {
                if let Some((of, place)) = self.of_term[operand.term]
                    && self.groups[of] == self.groups[orbit]
                {
                    *counts.entry((of, signed(k) - signed(place))).or_default() += 1;
                }
            }
        }
        let is_main = |count: usize| 2 * count >= self.members[orbit].len();
        counts.into_iter().filter(|&(_, count)| is_main(count)).map(|(edge, _)| edge).collect()
    }
}

/// A count as a time.
#[expect(clippy::cast_possible_wrap, reason = "there are fewer terms than that")]
pub fn signed(count: usize) -> i64 {
    count as i64
}
