//! The shift: which term of the next part corresponds to a term of this part.

use super::colours::colours;
use super::terms::{Kind, Place, Terms, variable};
use crate::expr::graph::{Graph, Node};
use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeMap;

/// A partial one-to-one map of terms to terms of the same kind, such that operands of what corresponds correspond.
#[derive(Debug)]
pub struct Shift {
    pub next: Vec<Option<Place>>,
    pub previous: Vec<Option<Place>>,
}

struct Search<'t> {
    terms: &'t Terms,
    colours: Vec<u64>,
    shift: Shift,
    /// Terms around which something has changed since they were looked at.
    is_open: Vec<bool>,
}

impl Shift {
    /// Starts from variables of one colour, in their order: to each corresponds the one so many places after it.
    pub fn find(graph: &Graph, terms: &Terms, (n_steps, stride): (usize, usize)) -> Self {
        let n = terms.all.len();
        let shift = Self { next: vec![None; n], previous: vec![None; n] };
        let mut search = Search { terms, colours: colours(terms, n_steps), shift, is_open: vec![true; n] };
        let mut classes: BTreeMap<(Kind, u64), Vec<(usize, Place)>> = BTreeMap::new();
        for (place, term) in terms.all.iter().enumerate() {
            if let Node::Symbol(symbol) = graph.node(term.id) {
                let index = variable(*symbol).2;
                classes.entry((term.kind, search.colours[place])).or_default().push((index, place));
            }
        }
        for mut class in classes.into_values() {
            class.sort_unstable();
            class.windows(stride + 1).for_each(|members| search.pair(members[0].1, members[stride].1));
        }
        search.spread(true);
        search.spread(false);
        search.shift
    }
}

impl Search<'_> {
    fn pair(&mut self, one: Place, other: Place) {
        let Shift { next, previous } = &mut self.shift;
        let is_free = next[one].is_none() && previous[other].is_none();
        if one != other && is_free && self.terms.all[one].kind == self.terms.all[other].kind {
            next[one] = Some(other);
            previous[other] = Some(one);
            self.open_around(one, other);
        }
    }

    /// What looks at a new pair is to look again: the pair, what shares a user with its first term, and terms whose
    /// operands or users, or those of the terms that correspond to them, are in the pair.
    fn open_around(&mut self, one: Place, other: Place) {
        let Self { terms, shift, is_open, .. } = self;
        let operands = |place: Place| terms.all[place].operands.iter().map(|operand| operand.term);
        is_open[one] = true;
        for user in terms.all[one].users.iter().copied() {
            is_open[user] = true;
            operands(user).for_each(|beside| is_open[beside] = true);
        }
        operands(one).for_each(|operand| is_open[operand] = true);
        let beside_other = terms.all[other].users.iter().copied().chain(operands(other));
        beside_other.filter_map(|place| shift.previous[place]).for_each(|place| is_open[place] = true);
    }

    fn spread(&mut self, by_colour: bool) {
        self.is_open.fill(true);
        while self.is_open.contains(&true) {
            for one in 0..self.terms.all.len() {
                if !std::mem::replace(&mut self.is_open[one], false) {
                    continue;
                }
                if let Some(other) = self.shift.next[one] {
                    self.operands(one, other, by_colour);
                    self.users(one, other, by_colour);
                }
            }
        }
    }

    /// Whether terms may correspond as far as is known.
    fn may_pair(&self, one: Place, other: Place, by_colour: bool) -> bool {
        let is_alike = if by_colour {
            self.colours[one] == self.colours[other]
        } else {
            self.terms.all[one].kind == self.terms.all[other].kind
        };
        match (self.shift.next[one], self.shift.previous[other]) {
            (None, None) => is_alike,
            (next, _) => next == Some(other),
        }
    }

    /// Whether terms are the same or correspond.
    fn is_known(&self, one: Place, other: Place) -> bool {
        self.shift.next[one] == Some(other) || one == other
    }

    fn operands(&mut self, one: Place, other: Place, by_colour: bool) {
        let [a, b] = [one, other].map(|place| {
            self.terms.all[place].operands.iter().map(|operand| operand.term).collect::<Vec<_>>()
        });
        match (&a[..], &b[..]) {
            (&[a0, a1], &[b0, b1]) if self.terms.all[one].kind.is_commutative() => {
                if self.is_known(a0, b0) || self.is_known(a1, b1) {
                    self.pair_alike(a0, b0, by_colour);
                    self.pair_alike(a1, b1, by_colour);
                } else if self.is_known(a0, b1) || self.is_known(a1, b0) {
                    self.pair_alike(a0, b1, by_colour);
                    self.pair_alike(a1, b0, by_colour);
                } else {
                    let straight = self.may_pair(a0, b0, by_colour) && self.may_pair(a1, b1, by_colour);
                    let crossed = self.may_pair(a0, b1, by_colour) && self.may_pair(a1, b0, by_colour);
                    match (straight, crossed) {
                        (true, false) => {
                            self.pair(a0, b0);
                            self.pair(a1, b1);
                        }
                        (false, true) => {
                            self.pair(a0, b1);
                            self.pair(a1, b0);
                        }
                        _ => {}
                    }
                }
            }
            _ => {
                for (&a, &b) in a.iter().zip(&b) {
                    self.pair_alike(a, b, by_colour);
                }
            }
        }
    }

    fn pair_alike(&mut self, one: Place, other: Place, by_colour: bool) {
        if self.may_pair(one, other, by_colour) {
            self.pair(one, other);
        }
    }

    fn users(&mut self, one: Place, other: Place, by_colour: bool) {
        // What has another operand that is known.
        for &user in &self.terms.all[one].users {
            if self.shift.next[user].is_some() {
                continue;
            }
            let kind = self.terms.all[user].kind;
            let Some(&beside) = self.beside(user, one).first() else { continue };
            let fits = |&&candidate: &&Place| {
                self.terms.all[candidate].kind == kind
                    && self.shift.previous[candidate].is_none()
                    && self.beside(candidate, other).iter().any(|&b| self.is_known(beside, b))
            };
            let found: Vec<_> = self.terms.all[other].users.iter().filter(fits).copied().collect();
            if let &[candidate] = &found[..] {
                self.pair(user, candidate);
            }
        }
        // What is the only one of its kind.
        let group = |search: &Self, place: Place, is_open: &dyn Fn(Place) -> bool| {
            let mut groups: HashMap<(Kind, u64), Vec<Place>> = HashMap::default();
            for &user in search.terms.all[place].users.iter().filter(|&&user| is_open(user)) {
                let colour = if by_colour { search.colours[user] } else { 0 };
                groups.entry((search.terms.all[user].kind, colour)).or_default().push(user);
            }
            groups
        };
        let ours = group(self, one, &|user| self.shift.next[user].is_none());
        let theirs = group(self, other, &|user| self.shift.previous[user].is_none());
        for (key, ours) in ours {
            if let (&[a], Some(&[b])) = (&ours[..], theirs.get(&key).map(Vec::as_slice)) {
                self.pair(a, b);
            }
        }
    }

    /// The operands of a term but for one.
    fn beside(&self, term: Place, operand: Place) -> Vec<Place> {
        let operands = self.terms.all[term].operands.iter().map(|operand| operand.term);
        let mut beside: Vec<_> = operands.collect();
        if let Some(at) = beside.iter().position(|&term| term == operand) {
            beside.remove(at);
        }
        beside
    }
}
