//! The shift: which term of the next part corresponds to a term of this part.

use super::colours::colours;
use super::terms::{Kind, Operand, Place, Term, Terms, variable};
use crate::expr::graph::{Graph, Node};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// How parts are found.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Steps from term to term by which colours are compared.
    pub n_steps: usize,
    /// After how many variables of one colour a part repeats.
    pub stride: usize,
    /// Whether what serves two terms in one part and one of them in another is computed twice.
    pub copies: bool,
}

/// A partial one-to-one map of terms to terms of the same kind, such that operands of what corresponds correspond.
#[derive(Debug)]
pub struct Shift {
    pub next: Vec<Option<Place>>,
    pub previous: Vec<Option<Place>>,
}

/// So many operations for each one that is computed twice: the verifier allows twice as many.
pub const OPERATIONS_A_COPY: usize = 100;

/// A set of terms, of which the next one in order is found quickly: a bit for each, and one for each word of these that
/// has any.
struct Open {
    bits: Vec<u64>,
    words: Vec<u64>,
}

impl Open {
    fn all(n: usize) -> Self {
        let mut all = Self { bits: Vec::new(), words: Vec::new() };
        (0..n).for_each(|place| all.insert(place));
        all
    }

    fn insert(&mut self, place: Place) {
        let word = place / 64;
        if word >= self.bits.len() {
            self.bits.resize(word + 1, 0);
            self.words.resize(word / 64 + 1, 0);
        }
        self.bits[word] |= 1 << (place % 64);
        self.words[word / 64] |= 1 << (word % 64);
    }

    fn remove(&mut self, place: Place) {
        let word = place / 64;
        self.bits[word] &= !(1 << (place % 64));
        if self.bits[word] == 0 {
            self.words[word / 64] &= !(1 << (word % 64));
        }
    }

    /// The first of them that is not before a place.
    fn next(&self, place: Place) -> Option<Place> {
        next_bit(&self.bits[..self.bits.len().min(place / 64 + 1)], place).or_else(|| {
            let word = next_bit(&self.words, place / 64 + 1)?;
            next_bit(&self.bits, 64 * word)
        })
    }

    /// All of them, in order.
    fn places(&self) -> Vec<Place> {
        std::iter::successors(self.next(0), |place| self.next(place + 1)).collect()
    }
}

/// The first bit that is set and not before a place.
fn next_bit(words: &[u64], place: usize) -> Option<usize> {
    let first = words.get(place / 64)? & (u64::MAX << (place % 64));
    let rest = words.iter().copied().enumerate().skip(place / 64 + 1);
    let (word, bits) = [(place / 64, first)].into_iter().chain(rest).find(|&(_, bits)| bits != 0)?;
    Some(64 * word + bits.trailing_zeros() as usize)
}

struct Search<'t> {
    terms: Cow<'t, Terms>,
    colours: Vec<u64>,
    shift: Shift,
    /// Terms around which something has changed since they were looked at.
    open: Open,
    /// Of which term each is a copy: most of themselves.
    originals: Vec<Place>,
    most_terms: usize,
    /// Room for users of a term and of its counterpart.
    only_ones: [Vec<((Kind, u64), Place)>; 2],
}

impl Shift {
    /// Starts from variables of one colour, in their order: to each corresponds the one so many places after it. What
    /// serves two terms in one part and has a counterpart for each in another is copied: the terms, with the copies.
    pub fn find<'t>(graph: &Graph, terms: &'t Terms, way: Way) -> (Cow<'t, Terms>, Self) {
        let Way { n_steps, stride, copies } = way;
        let n = terms.all.len();
        let mut search = Search {
            terms: Cow::Borrowed(terms),
            colours: colours(terms, n_steps),
            shift: Self { next: vec![None; n], previous: vec![None; n] },
            open: Open::all(n),
            originals: (0..n).collect(),
            most_terms: n + n / OPERATIONS_A_COPY,
            only_ones: [Vec::new(), Vec::new()],
        };
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
        for by_colour in [true, false] {
            search.open = Open::all(n);
            search.spread(by_colour);
        }
        search.choose_users();
        if copies {
            search.copy_operands();
        }
        search.sorted()
    }
}

impl<'t> Search<'t> {
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
        let Self { terms, shift, open, .. } = self;
        let operands = |place: Place| terms.all[place].operands.iter().map(|operand| operand.term);
        open.insert(one);
        for user in terms.all[one].users.iter().copied() {
            open.insert(user);
            operands(user).for_each(|beside| open.insert(beside));
        }
        operands(one).for_each(|operand| open.insert(operand));
        let beside_other = terms.all[other].users.iter().copied().chain(operands(other));
        beside_other.filter_map(|place| shift.previous[place]).for_each(|place| open.insert(place));
    }

    fn spread(&mut self, by_colour: bool) {
        // In the order of their places, again and again.
        let mut at = 0;
        while let Some(place) = self.open.next(at).or_else(|| self.open.next(0)) {
            at = place;
            self.open.remove(place);
            if let Some(other) = self.shift.next[place] {
                self.operands(place, other, by_colour);
                self.users(place, other, by_colour);
            }
        }
    }

    /// A pair that was chosen, and what follows from it.
    fn choose(&mut self, one: Place, other: Place) {
        self.pair(one, other);
        let open = self.open.places();
        self.spread(true);
        open.into_iter().for_each(|place| self.open.insert(place));
        self.spread(false);
    }

    /// Where several users of a term are alike, they correspond in their order.
    fn choose_users(&mut self) {
        for one in 0..self.terms.all.len() {
            let Some(other) = self.shift.next[one] else { continue };
            let ours = self.groups(one, |user| self.shift.next[user].is_none());
            let theirs = self.groups(other, |user| self.shift.previous[user].is_none());
            for (key, ours) in ours {
                let theirs = theirs.get(&key).filter(|theirs| theirs.len() == ours.len());
                for (a, &b) in ours.into_iter().zip(theirs.into_iter().flatten()) {
                    if self.shift.next[a].is_none() && self.shift.previous[b].is_none() {
                        self.choose(a, b);
                    }
                }
            }
        }
    }

    /// The users of a term by kind, colour and whether their operands have one sign.
    fn groups(
        &self,
        place: Place,
        is_open: impl Fn(Place) -> bool,
    ) -> BTreeMap<(Kind, u64, bool), Vec<Place>> {
        let mut groups: BTreeMap<_, Vec<Place>> = BTreeMap::new();
        for &user in self.terms.all[place].users.iter().filter(|&&user| is_open(user)) {
            let Term { kind, operands, .. } = &self.terms.all[user];
            let is_one_sign = operands.iter().all(|o| o.is_negative == operands[0].is_negative);
            groups.entry((*kind, self.colours[user], is_one_sign)).or_default().push(user);
        }
        groups
    }

    /// Copies operands of terms that correspond and themselves do not.
    fn copy_operands(&mut self) {
        let mut one = 0;
        while one < self.terms.all.len() {
            let other = self.shift.next[one];
            let counterparts = other.map(|other| self.counterparts(one, other)).unwrap_or_default();
            for (a, b) in counterparts {
                let Some(other) = self.shift.next[one].filter(|_| !self.is_known(a, b)) else { continue };
                let kinds = [a, b].map(|place| self.terms.all[place].kind);
                if kinds[0] != kinds[1] || !kinds[0].is_operation() {
                    continue;
                }
                let a = if self.shift.next[a].is_some() { self.copy(a, one) } else { Some(a) };
                let b = if self.shift.previous[b].is_some() { self.copy(b, other) } else { Some(b) };
                if let (Some(a), Some(b)) = (a, b) {
                    self.choose(a, b);
                }
            }
            one += 1;
        }
    }

    /// Operands that would have to correspond.
    fn counterparts(&self, one: Place, other: Place) -> Vec<(Place, Place)> {
        let operands =
            |place: Place| self.terms.all[place].operands.iter().map(|o| o.term).collect::<Vec<_>>();
        let (a, mut b) = (operands(one), operands(other));
        if self.terms.all[one].kind.is_commutative() {
            let known = |k: usize, l: usize| self.is_known(a[k], b[l]);
            let alike = |k: usize, l: usize| self.do_the_same(a[k], b[l]);
            if !known(0, 0) && !known(1, 1) {
                if known(0, 1) || known(1, 0) || alike(0, 1) && alike(1, 0) {
                    b.swap(0, 1);
                } else if !alike(0, 0) || !alike(1, 1) {
                    return Vec::new();
                }
            }
        }
        a.into_iter().zip(b).collect()
    }

    /// Whether terms do the same with operands that correspond.
    fn do_the_same(&self, one: Place, other: Place) -> bool {
        let [a, b] = [one, other].map(|place| &self.terms.all[place]);
        let known = |a: &Operand, b: &Operand| self.is_known(a.term, b.term);
        let straight = || a.operands.iter().zip(&*b.operands).all(|(a, b)| known(a, b));
        let crossed = || a.operands.iter().zip(b.operands.iter().rev()).all(|(a, b)| known(a, b));
        a.kind == b.kind && a.kind.is_operation() && (straight() || a.kind.is_commutative() && crossed())
    }

    /// A copy of a term for one of its users, if there are others and not too many copies.
    fn copy(&mut self, term: Place, user: Place) -> Option<Place> {
        let copy = self.terms.all.len();
        let original = &self.terms.all[term];
        if copy == self.most_terms || original.users.len() == 1 && !original.is_root {
            return None;
        }
        let all = &mut self.terms.to_mut().all;
        let original = &mut all[term];
        original.users.retain(|&other| other != user);
        let copied = Term { users: vec![user], is_root: false, ..original.clone() };
        for operand in copied.operands.iter() {
            let users = &mut all[operand.term].users;
            if users.last() != Some(&copy) {
                users.push(copy);
            }
        }
        let of_user = all[user].operands.iter_mut();
        of_user.filter(|operand| operand.term == term).for_each(|operand| operand.term = copy);
        all.push(copied);
        self.colours.push(self.colours[term]);
        self.originals.push(self.originals[term]);
        self.shift.next.push(None);
        self.shift.previous.push(None);
        self.open.insert(copy);
        Some(copy)
    }

    /// Puts copies beside their originals: operands come before their users again.
    fn sorted(self) -> (Cow<'t, Terms>, Shift) {
        if let Cow::Borrowed(_) = self.terms {
            return (self.terms, self.shift);
        }
        let mut order: Vec<Place> = (0..self.terms.all.len()).collect();
        order.sort_by_key(|&place| (self.originals[place], place));
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(at, &place)| places[place] = at);
        let moved = |operand: &Operand| Operand { term: places[operand.term], ..*operand };
        let all = order.iter().map(|&place| {
            let mut term = self.terms.all[place].clone();
            term.operands = term.operands.iter().map(moved).collect();
            term.users.iter_mut().for_each(|user| *user = places[*user]);
            term
        });
        let terms = Terms { all: all.collect(), roots: self.terms.roots.iter().map(moved).collect() };
        let map = |of: &[Option<Place>]| order.iter().map(|&p| of[p].map(|q| places[q])).collect();
        let shift = Shift { next: map(&self.shift.next), previous: map(&self.shift.previous) };
        (Cow::Owned(terms), shift)
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
        // Those of `one` may be paired on the way, but stay what they are.
        let [a, b] = [one, other].map(|place| self.places(place));
        match ([a[0], a[1]], [b[0], b[1]]) {
            ([Some(a0), Some(a1)], [Some(b0), Some(b1)]) if self.terms.all[one].kind.is_commutative() => {
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
                for (a, b) in a.into_iter().flatten().zip(b.into_iter().flatten()) {
                    self.pair_alike(a, b, by_colour);
                }
            }
        }
    }

    /// The operands of a term: no operation has more than two.
    fn places(&self, term: Place) -> [Option<Place>; 2] {
        let operands = &self.terms.all[term].operands;
        [0, 1].map(|slot| operands.get(slot).map(|operand| operand.term))
    }

    fn pair_alike(&mut self, one: Place, other: Place, by_colour: bool) {
        if self.may_pair(one, other, by_colour) {
            self.pair(one, other);
        }
    }

    fn users(&mut self, one: Place, other: Place, by_colour: bool) {
        // What has another operand that is known.
        for at in 0..self.terms.all[one].users.len() {
            let user = self.terms.all[one].users[at];
            if self.shift.next[user].is_some() {
                continue;
            }
            let kind = self.terms.all[user].kind;
            let Some(beside) = self.beside(user, one) else { continue };
            let fits = |&candidate: &Place| {
                self.terms.all[candidate].kind == kind && self.shift.previous[candidate].is_none()
            };
            let known = [Some(beside), self.shift.next[beside]].into_iter().flatten();
            let mut found = known.flat_map(|beside| self.users_of_both(other, beside)).filter(fits);
            let both = (found.next(), found.next());
            drop(found);
            if let (Some(candidate), None) = both {
                self.pair(user, candidate);
            }
        }
        // What is the only one of its kind.
        let [mut ours, mut theirs] = std::mem::take(&mut self.only_ones);
        self.only_ones(one, by_colour, &self.shift.next, &mut ours);
        if !ours.is_empty() {
            self.only_ones(other, by_colour, &self.shift.previous, &mut theirs);
        }
        for &(key, a) in &ours {
            if let Ok(at) = theirs.binary_search_by_key(&key, |&(key, _)| key) {
                self.pair(a, theirs[at].1);
            }
        }
        self.only_ones = [ours, theirs];
    }

    /// The users of a term without a counterpart that are the only ones of their kind and colour, in the order of
    /// these.
    fn only_ones(
        &self,
        place: Place,
        by_colour: bool,
        counterparts: &[Option<Place>],
        found: &mut Vec<((Kind, u64), Place)>,
    ) {
        let is_open = |user: &&Place| counterparts[**user].is_none();
        let open = self.terms.all[place].users.iter().filter(is_open).map(|&user| {
            let colour = if by_colour { self.colours[user] } else { 0 };
            ((self.terms.all[user].kind, colour), user)
        });
        found.clear();
        found.extend(open);
        found.sort_unstable();
        let mut n = 0;
        for at in 0..found.len() {
            let key = found[at].0;
            let is_first = at == 0 || found[at - 1].0 != key;
            if is_first && found.get(at + 1).is_none_or(|next| next.0 != key) {
                found[n] = found[at];
                n += 1;
            }
        }
        found.truncate(n);
    }

    /// The terms whose operands are these two.
    fn users_of_both(&self, one: Place, other: Place) -> impl Iterator<Item = Place> {
        let users = |place: Place| &self.terms.all[place].users;
        let [few, many] = if users(one).len() <= users(other).len() { [one, other] } else { [other, one] };
        users(few).iter().copied().filter(move |&user| self.beside(user, few) == Some(many))
    }

    /// The other operand of a term.
    fn beside(&self, term: Place, operand: Place) -> Option<Place> {
        let [first, second] = self.places(term);
        if first == Some(operand) { second } else { first }
    }
}
