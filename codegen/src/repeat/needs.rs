//! What needs what, and what needs each other in circles.

use std::ops::Range;

/// Of each of some units, by numbers, which units it needs.
pub struct Needs {
    all: Vec<usize>,
    /// Where those of each unit are.
    ranges: Vec<Range<usize>>,
}

impl Needs {
    /// `pairs` are a unit and one that it needs, the same each time.
    pub fn of<P: Iterator<Item = (usize, usize)>>(n: usize, pairs: impl Fn() -> P) -> Self {
        let mut counts = vec![0; n];
        pairs().for_each(|(unit, _)| counts[unit] += 1);
        let mut end = 0;
        let ranges = counts.iter().map(|count| {
            end += count;
            end - count..end - count
        });
        let mut ranges: Vec<Range<usize>> = ranges.collect();
        let mut all = vec![0; end];
        for (unit, needed) in pairs() {
            all[ranges[unit].end] = needed;
            ranges[unit].end += 1;
        }
        Self { all, ranges }
    }

    /// The same in ascending order, each once.
    pub fn sorted(mut self) -> Self {
        for range in &mut self.ranges {
            let own = &mut self.all[range.clone()];
            own.sort_unstable();
            let mut n = 0;
            for k in 0..own.len() {
                if n == 0 || own[k] != own[n - 1] {
                    own[n] = own[k];
                    n += 1;
                }
            }
            range.end = range.start + n;
        }
        self
    }

    pub fn n_units(&self) -> usize {
        self.ranges.len()
    }

    pub fn by(&self, unit: usize) -> &[usize] {
        &self.all[self.ranges[unit].clone()]
    }

    /// Groups of what needs each other in a circle, those that are needed first (R. Tarjan (1972)): all of them, and
    /// where each ends.
    pub fn groups(&self) -> (Vec<usize>, Vec<usize>) {
        const UNSEEN: usize = usize::MAX;
        let n = self.n_units();
        let (mut index, mut low) = (vec![UNSEEN; n], vec![0; n]);
        let (mut is_open, mut open) = (vec![false; n], Vec::new());
        let (mut groups, mut ends) = (Vec::with_capacity(n), Vec::new());
        let mut n_seen = 0;
        let mut path = Vec::new();
        for start in 0..n {
            if index[start] != UNSEEN {
                continue;
            }
            path.push((start, 0));
            while let Some((at, next)) = path.pop() {
                if next == 0 {
                    (index[at], low[at]) = (n_seen, n_seen);
                    n_seen += 1;
                    open.push(at);
                    is_open[at] = true;
                }
                if let Some(&needed) = self.by(at).get(next) {
                    path.push((at, next + 1));
                    if index[needed] == UNSEEN {
                        path.push((needed, 0));
                    } else if is_open[needed] {
                        low[at] = low[at].min(index[needed]);
                    }
                    continue;
                }
                if let Some(&(user, _)) = path.last() {
                    low[user] = low[user].min(low[at]);
                }
                if low[at] == index[at] {
                    let from = open.iter().rposition(|&other| other == at).expect("it is open");
                    open[from..].iter().for_each(|&other: &usize| is_open[other] = false);
                    groups.extend(open.drain(from..));
                    ends.push(groups.len());
                }
            }
        }
        (groups, ends)
    }
}
