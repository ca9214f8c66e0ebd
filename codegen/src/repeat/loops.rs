//! Which orbits are computed in which loop, when, and for which parts.

use super::needs::Needs;
use super::orbits::{Orbit, Orbits, signed};
use super::terms::{Place, Terms};
use rustc_hash::FxHashSet as HashSet;
use std::collections::{BTreeMap, BTreeSet};

/// Operations that the loops of connected orbits have to save to be worth their arrays.
const LEAST_SAVED: i64 = 200;

/// How often times are put to the vote.
const SWEEPS: usize = 10;

/// In which order a loop goes through the parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the first to the last.
    Forward,
    /// From the last to the first.
    Backward,
}

/// Orbits that are computed together, one member of each for each part.
#[derive(Debug)]
pub struct Loop {
    pub direction: Direction,
    pub orbits: Vec<Orbit>,
    /// The first and the last part.
    pub first: i64,
    pub last: i64,
}

/// All loops of a kernel, in the order in which they run.
#[derive(Debug)]
pub struct Loops {
    pub all: Vec<Loop>,
    /// To which part the first member of each orbit belongs.
    pub times: Vec<i64>,
    /// Loop and part of each term that is computed in a loop.
    pub of_term: Vec<Option<(usize, i64)>>,
}

/// What is put in order: an orbit or a term that belongs to none.
type Unit = usize;

/// Orbits on their way into loops.
#[derive(Clone)]
pub struct Planning<'t> {
    pub terms: &'t Terms,
    pub orbits: &'t Orbits,
    edges: Vec<Vec<(Orbit, i64)>>,
    pub times: Vec<i64>,
    /// Which orbits are still to be computed in loops.
    is_looped: Vec<bool>,
    /// The connected part of the graph of orbits that each belongs to.
    pub component: Vec<usize>,
    /// First and last time of each component, once they are chosen.
    ranges: Vec<Option<(i64, i64)>>,
}

impl Loops {
    /// `None` if there are none.
    pub fn plan(mut planning: Planning) -> Option<Self> {
        planning.levels().ok()?;
        planning.trim();
        let all = loop {
            match planning.levels() {
                Ok(all) => break all,
                Err(component) => planning.leave(component)?,
            }
        };
        planning.checked(all)
    }
}

impl<'t> Planning<'t> {
    /// Orbits that are connected, at the times that fit best.
    pub fn aligned(terms: &'t Terms, orbits: &'t Orbits) -> Self {
        let n = orbits.members.len();
        let edges = (0..n).map(|orbit| orbits.main_edges(orbit)).collect();
        let (times, is_looped, component) = (vec![0; n], vec![true; n], vec![0; n]);
        let mut planning = Self { terms, orbits, edges, times, is_looped, component, ranges: Vec::new() };
        planning.align();
        planning
    }

    /// Leaves what is connected out of loops, if any of it was to be in one.
    fn leave(&mut self, component: usize) -> Option<()> {
        let mut was_looped = false;
        for (is_looped, of) in self.is_looped.iter_mut().zip(&self.component) {
            was_looped |= *of == component && std::mem::take(is_looped);
        }
        was_looped.then_some(())
    }

    /// Gives the orbits of a component times such that most operands are of the same time as their users.
    fn align(&mut self) {
        let n = self.orbits.members.len();
        let mut beside: Vec<Vec<(Orbit, i64)>> = vec![Vec::new(); n];
        for (user, edges) in self.edges.iter().enumerate() {
            for &(operand, distance) in edges {
                // Of the same time if the user's first member comes so much earlier.
                beside[user].push((operand, -distance));
                beside[operand].push((user, distance));
            }
        }
        let mut known = vec![false; n];
        let mut n_components = 0;
        let mut by_length: Vec<Orbit> = (0..n).collect();
        by_length.sort_by_key(|&orbit| std::cmp::Reverse(self.orbits.members[orbit].len()));
        for start in by_length {
            if known[start] {
                continue;
            }
            let mut queue = std::collections::VecDeque::from([start]);
            known[start] = true;
            while let Some(orbit) = queue.pop_front() {
                self.component[orbit] = n_components;
                for &(other, offset) in &beside[orbit] {
                    if !std::mem::replace(&mut known[other], true) {
                        self.times[other] = self.times[orbit] - offset;
                        queue.push_back(other);
                    }
                }
            }
            n_components += 1;
        }
        let mut votes: Vec<i64> = Vec::new();
        for _ in 0..SWEEPS {
            for (orbit, beside) in beside.iter().enumerate() {
                votes.clear();
                votes.extend(beside.iter().map(|&(other, offset)| self.times[other] + offset));
                votes.sort_unstable();
                let own = self.times[orbit];
                let alike = votes.chunk_by(|a, b| a == b);
                if let Some(most) = alike.max_by_key(|alike| (alike.len(), alike[0] == own)) {
                    self.times[orbit] = most[0];
                }
            }
        }
        self.ranges = vec![None; n_components];
    }

    fn span(&self, orbit: Orbit) -> (i64, i64) {
        let first = self.times[orbit];
        (first, first + signed(self.orbits.members[orbit].len()) - 1)
    }

    /// Each component has the times that all its long orbits have; what is short is left out.
    fn trim(&mut self) {
        for component in 0..self.ranges.len() {
            let own: Vec<Orbit> = (0..self.times.len()).filter(|&o| self.component[o] == component).collect();
            let length = |orbit: Orbit| self.orbits.members[orbit].len();
            let longest = own.iter().map(|&orbit| length(orbit)).max().unwrap_or(0);
            let long = || own.iter().copied().filter(|&orbit| 2 * length(orbit) > longest);
            let first = long().map(|orbit| self.span(orbit).0).max().unwrap_or(0);
            let last = long().map(|orbit| self.span(orbit).1).min().unwrap_or(0);
            let (first, last) = self.even(&own, (first, last));
            self.ranges[component] = Some((first, last));
            let n_saved = (last - first) * signed(own.len());
            for orbit in own {
                let (a, b) = self.span(orbit);
                self.is_looped[orbit] = a <= first && b >= last && last > first && n_saved > LEAST_SAVED;
            }
        }
    }

    /// The longest run of times at which all operands come from where they come from at most times.
    fn even(&self, own: &[Orbit], (mut first, mut last): (i64, i64)) -> (i64, i64) {
        loop {
            let has_all = |&&orbit: &&Orbit| self.span(orbit).0 <= first && self.span(orbit).1 >= last;
            let odd: BTreeSet<i64> =
                own.iter().filter(has_all).flat_map(|&orbit| self.odd_times(orbit, (first, last))).collect();
            let ends: Vec<i64> = [first - 1].into_iter().chain(odd).chain([last + 1]).collect();
            let Some(longest) = ends.windows(2).max_by_key(|pair| pair[1] - pair[0]) else { break };
            let run = (longest[0] + 1, longest[1] - 1);
            if run == (first, last) || run.0 > run.1 {
                return run;
            }
            (first, last) = run;
        }
        (first, last)
    }

    /// The times at which an operand of an orbit does not come from where it comes from at most times.
    fn odd_times(&self, orbit: Orbit, (first, last): (i64, i64)) -> Vec<i64> {
        let mut odd = Vec::new();
        let n_operands = self.orbits.operands[self.orbits.members[orbit][0]].len();
        for slot in 0..n_operands {
            // The orbit of an operand within these times, and how much earlier it is.
            let source = |time: i64| {
                let k = usize::try_from(time - self.times[orbit]).expect("it has all times");
                let operand = self.orbits.operands[self.orbits.members[orbit][k]][slot].term;
                let (of, place) = self.orbits.of_term[operand]?;
                let at = self.times[of] + signed(place);
                let is_within = self.span(of).0 <= first && self.span(of).1 >= last;
                let is_inside = is_within && self.component[of] == self.component[orbit];
                (is_inside && at >= first && at <= last).then_some((of, time - at))
            };
            let mut votes: BTreeMap<Option<(Orbit, i64)>, usize> = BTreeMap::new();
            (first..=last).for_each(|time| *votes.entry(source(time)).or_default() += 1);
            let most = votes.iter().max_by_key(|(_, count)| **count).and_then(|(key, _)| *key);
            odd.extend((first..=last).filter(|&time| {
                let is_beyond =
                    most.is_some_and(|(_, distance)| time - distance < first || time - distance > last);
                let found = source(time);
                found != most && !(is_beyond && found.is_none())
            }));
        }
        odd
    }

    /// Whether a term is computed in a loop, were all of them in one, and in which orbit.
    fn looped(&self, term: Place) -> Option<Orbit> {
        let (orbit, k) = self.orbits.of_term[term]?;
        let time = self.times[orbit] + signed(k);
        let Some((first, last)) = self.ranges[self.component[orbit]] else { return Some(orbit) };
        (self.is_looped[orbit] && time >= first && time <= last).then_some(orbit)
    }

    fn unit(&self, term: Place) -> Unit {
        self.looped(term).unwrap_or(self.times.len() + term)
    }

    /// Puts orbits into loops: each as early as what it needs allows. Before ranges are chosen, only orbits count. An
    /// error names a component that cannot be in loops, as what is left out of them lies between its parts.
    fn levels(&mut self) -> Result<Vec<Loop>, usize> {
        let operands = self.operands_of_units();
        let n_orbits = self.times.len();
        let mut level = vec![0_usize; operands.n_units()];
        let mut loops: BTreeMap<(usize, usize), Draft> = BTreeMap::new();
        let (groups, ends) = operands.groups();
        let mut is_own = vec![false; operands.n_units()];
        for (&first, &end) in [0].iter().chain(&ends).zip(&ends) {
            let group = &groups[first..end];
            let is_cycle = group.len() > 1 || operands.by(group[0]).contains(&group[0]);
            if group[0] >= n_orbits || group.len() > 1 && group.iter().any(|&unit| unit >= n_orbits) {
                if is_cycle {
                    let orbit = group.iter().find(|&&unit| unit < n_orbits);
                    return Err(self.component[*orbit.expect("terms by themselves are in order")]);
                }
                let after = |&operand: &Unit| level[operand] + usize::from(operand < n_orbits);
                level[group[0]] = operands.by(group[0]).iter().map(after).max().unwrap_or(0);
                continue;
            }
            let component = self.component[group[0]];
            let direction = if is_cycle { Some(self.direction(group).ok_or(component)?) } else { None };
            let is_function = |orbit: Orbit| self.terms.all[self.orbits.members[orbit][0]].kind.is_function();
            // Functions have a loop of their own: around a call nothing stays in a processor's registers.
            let is_elsewhere = |orbit: Orbit| {
                self.component[orbit] != component || is_function(orbit) != is_function(group[0])
            };
            let least = |unit: &Unit| level[*unit] + usize::from(*unit < n_orbits && is_elsewhere(*unit));
            group.iter().for_each(|&unit| is_own[unit] = true);
            let before = group.iter().flat_map(|&unit| operands.by(unit)).filter(|unit| !is_own[**unit]);
            let mut at = before.map(least).max().unwrap_or(0);
            group.iter().for_each(|&unit| is_own[unit] = false);
            let conflicts =
                |draft: &Draft| direction.is_some_and(|d| draft.direction.is_some_and(|e| d != e));
            while loops.get(&(component, at)).is_some_and(conflicts) {
                at += 1;
            }
            let draft = loops.entry((component, at)).or_default();
            draft.direction = draft.direction.or(direction);
            self.shift(group, draft);
            draft.orbits.extend(group);
            group.iter().for_each(|&unit| level[unit] = at);
        }
        let mut drafts: Vec<_> = loops.into_iter().collect();
        drafts.sort_by_key(|&((component, level), _)| (level, component));
        let finished = |((component, _), draft)| self.finished(component, draft);
        Ok(drafts.into_iter().filter_map(finished).collect())
    }

    fn operands_of_units(&self) -> Needs {
        let n_orbits = self.times.len();
        if self.ranges.iter().all(Option::is_none) {
            let of = |(orbit, edges): (Orbit, &Vec<(Orbit, i64)>)| -> Vec<_> {
                edges.iter().map(|&(operand, _)| (orbit, operand)).collect()
            };
            return Needs::of(n_orbits, || self.edges.iter().enumerate().flat_map(of));
        }
        let units: Vec<Unit> = (0..self.terms.all.len()).map(|term| self.unit(term)).collect();
        Needs::of(n_orbits + units.len(), || self.orbits.pairs(&units)).sorted()
    }

    /// In which order a cycle of orbits has to be computed, its times made fit.
    fn direction(&mut self, group: &[Orbit]) -> Option<Direction> {
        let given = self.times.clone();
        for direction in [Direction::Forward, Direction::Backward] {
            if self.relax(group, direction) {
                return Some(direction);
            }
            self.times.clone_from(&given);
        }
        None
    }

    /// Moves orbits such that no operand comes after its user; whether that is possible.
    fn relax(&mut self, group: &[Orbit], direction: Direction) -> bool {
        let is_member: HashSet<Orbit> = group.iter().copied().collect();
        for _ in 0..=group.len() {
            let mut is_changed = false;
            for &user in group {
                for &(operand, distance) in &self.edges[user] {
                    let least = self.times[operand] - distance;
                    let is_late = match direction {
                        Direction::Forward => self.times[user] < least,
                        Direction::Backward => self.times[user] > least,
                    };
                    if is_member.contains(&operand) && is_late {
                        self.times[user] = least;
                        is_changed = true;
                    }
                }
            }
            if !is_changed {
                return true;
            }
        }
        false
    }

    /// Moves a group as a whole such that it does not come before what it needs of its loop.
    fn shift(&mut self, group: &[Orbit], draft: &mut Draft) {
        let mut late = Vec::new();
        for &user in group {
            for &(operand, distance) in &self.edges[user] {
                if draft.orbits.contains(&operand) {
                    late.push(distance + self.times[user] - self.times[operand]);
                }
            }
        }
        if draft.direction.is_none() && late.iter().any(|&late| late != 0) {
            let is_forward = late.iter().sum::<i64>() >= 0;
            draft.direction = Some(if is_forward { Direction::Forward } else { Direction::Backward });
        }
        let by = match draft.direction {
            Some(Direction::Backward) => -late.iter().copied().max().unwrap_or(0).max(0),
            _ => -late.iter().copied().min().unwrap_or(0).min(0),
        };
        group.iter().for_each(|&orbit| self.times[orbit] += by);
    }

    fn finished(&self, component: usize, Draft { direction, orbits }: Draft) -> Option<Loop> {
        let (first, last) = self.ranges[component]?;
        let orbits: Vec<_> = orbits.into_iter().filter(|&orbit| self.is_looped[orbit]).collect();
        let has_all = |&orbit: &Orbit| self.span(orbit).0 <= first && self.span(orbit).1 >= last;
        let direction = direction.unwrap_or(Direction::Forward);
        (!orbits.is_empty() && orbits.iter().all(has_all)).then_some(Loop { direction, orbits, first, last })
    }

    /// Puts the loops in order, if there is one.
    fn checked(self, all: Vec<Loop>) -> Option<Loops> {
        let mut of_term = vec![None; self.terms.all.len()];
        for (index, found) in all.iter().enumerate() {
            for &orbit in &found.orbits {
                for part in found.first..=found.last {
                    let k = usize::try_from(part - self.times[orbit]).expect("each orbit has this part");
                    of_term[self.orbits.members[orbit][k]] = Some((index, part));
                }
            }
        }
        let unit =
            |(term, of): (Place, &Option<(usize, i64)>)| of.map_or(all.len() + term, |(index, _)| index);
        let units: Vec<Unit> = of_term.iter().enumerate().map(unit).collect();
        let between = || self.orbits.pairs(&units).filter(|(user, operand)| user != operand);
        let (mut order, ends) = Needs::of(all.len() + units.len(), between).groups();
        if ends.len() < order.len() {
            return None;
        }
        order.retain(|&unit| unit < all.len());
        if order.is_empty() {
            return None;
        }
        let rank: Vec<usize> =
            (0..all.len()).map(|k| order.iter().position(|&o| o == k).expect("all are there")).collect();
        let mut ordered: Vec<_> = rank.iter().zip(all).collect();
        ordered.sort_by_key(|(rank, _)| **rank);
        of_term.iter_mut().flatten().for_each(|(index, _)| *index = rank[*index]);
        let all = ordered.into_iter().map(|(_, found)| found).collect();
        Some(Loops { all, times: self.times, of_term })
    }
}

/// A loop that grows.
#[derive(Default)]
struct Draft {
    direction: Option<Direction>,
    orbits: Vec<Orbit>,
}

impl Loops {
    /// Operations of its text at least: those outside of loops, and one for each orbit in a loop.
    pub fn n_written(&self, terms: &Terms) -> usize {
        let outside = terms.all.iter().zip(&self.of_term).filter(|(_, looped)| looped.is_none());
        let inside: usize = self.all.iter().map(|each| each.orbits.len()).sum();
        outside.filter(|(term, _)| term.kind.is_counted()).count() + inside
    }

    /// The member of an orbit for a part.
    pub fn member(&self, orbits: &Orbits, orbit: Orbit, part: i64) -> Place {
        let k = usize::try_from(part - self.times[orbit]).expect("each orbit has the parts of its loop");
        orbits.members[orbit][k]
    }

    /// The loop that computes an orbit.
    pub fn of_orbit(&self, orbits: &Orbits, orbit: Orbit) -> Option<usize> {
        orbits.members[orbit].iter().find_map(|&term| self.of_term[term]).map(|(index, _)| index)
    }

    /// The part that a loop does last.
    pub fn last_done(&self, index: usize) -> i64 {
        let Loop { direction, first, last, .. } = self.all[index];
        if direction == Direction::Forward { last } else { first }
    }

    /// The parts of a loop in the order in which it goes through them.
    pub fn parts(&self, index: usize) -> Vec<i64> {
        let Loop { direction, first, last, .. } = self.all[index];
        match direction {
            Direction::Forward => (first..=last).collect(),
            Direction::Backward => (first..=last).rev().collect(),
        }
    }
}
