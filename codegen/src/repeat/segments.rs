//! Where a run of parts is interrupted. Numbers that happen to be equal let a part share what others compute twice, or
//! some of its terms correspond to others than elsewhere: parts before and after it go into loops of their own.

use super::loops::Planning;
use super::orbits::{Orbit, Orbits, signed};

/// More times than this are not cut: the work grows with their square.
const MOST_TIMES: usize = 2000;

/// From one time to another, both included.
type Span = (i64, i64);

/// The orbits, cut where their parts are interrupted; `None` if there is nothing to be cut.
pub fn cut(planning: &Planning, n_least: usize) -> Option<Orbits> {
    let orbits = planning.orbits;
    let n_components = planning.component.iter().max().map_or(0, |last| last + 1);
    let mut runs: Vec<Vec<Span>> = vec![Vec::new(); n_components];
    for orbit in 0..orbits.members.len() {
        runs[planning.component[orbit]].extend(even_runs(planning, orbit));
    }
    let segments: Vec<Vec<Span>> = runs.iter().map(|runs| best_segments(runs, signed(n_least))).collect();
    if segments.iter().all(|segments| segments.len() < 2) {
        return None;
    }
    let n = planning.terms.all.len();
    let (of_term, operands) = (vec![None; n], orbits.operands.clone());
    let mut pieces = Orbits { members: Vec::new(), of_term, operands, groups: Vec::new() };
    for (orbit, members) in orbits.members.iter().enumerate() {
        let component = planning.component[orbit];
        let starts = segments[component].iter().skip(1).map(|&(first, _)| first - planning.times[orbit]);
        let bounds: Vec<usize> = starts.map(|start| usize::try_from(start).unwrap_or(0)).collect();
        for (segment, first) in [0].iter().chain(&bounds).enumerate() {
            let end = bounds.get(segment).copied().unwrap_or(members.len()).min(members.len());
            let piece = members.get(*first..end).unwrap_or_default();
            if piece.len() >= n_least {
                let index = pieces.members.len();
                piece.iter().enumerate().for_each(|(k, &term)| pieces.of_term[term] = Some((index, k)));
                pieces.members.push(piece.to_vec());
                // There are fewer segments than terms.
                pieces.groups.push(n * component + segment);
            }
        }
    }
    Some(pieces)
}

/// The longest spans in which each operand of an orbit comes from one orbit, so many parts before.
fn even_runs(planning: &Planning, orbit: Orbit) -> Vec<Span> {
    let Planning { orbits, times, component, .. } = planning;
    let source = |k: usize| -> [Option<(Orbit, i64)>; 2] {
        let time = times[orbit] + signed(k);
        let operands = orbits.operands[orbits.members[orbit][k]];
        [0, 1].map(|slot| {
            let (of, place) = orbits.of_term[operands.get(slot)?.term]?;
            (component[of] == component[orbit]).then_some((of, time - times[of] - signed(place)))
        })
    };
    let sources: Vec<_> = (0..orbits.members[orbit].len()).map(source).collect();
    let mut first = times[orbit];
    let mut runs = Vec::new();
    for run in sources.chunk_by(|a, b| a == b) {
        let after = first + signed(run.len());
        runs.push((first, after - 1));
        first = after;
    }
    runs
}

/// Spans, apart from each other, that save most: what is even all through one is written once, and what is even in a
/// part of it alone stands in the way.
fn best_segments(runs: &[Span], n_least: i64) -> Vec<Span> {
    let Some(origin) = runs.iter().map(|run| run.0).min() else { return Vec::new() };
    let place = |time: i64| usize::try_from(time - origin).expect("none is earlier");
    let n = runs.iter().map(|run| place(run.1) + 1).max().unwrap_or(0);
    if n > MOST_TIMES {
        return Vec::new();
    }
    let saved = Saved::of(runs.iter().map(|&(first, last)| (place(first), place(last))), n);
    // The most that the first so many times save, and where the last segment of them begins if it ends there.
    let mut best = vec![(0, None); n + 1];
    for end in 1..=n {
        best[end] = (best[end - 1].0, None);
        for first in 0..end {
            let total = best[first].0 + saved.between(first, end - 1);
            if signed(end - first) >= n_least && total > best[end].0 {
                best[end] = (total, Some(first));
            }
        }
    }
    let (mut segments, mut end) = (Vec::new(), n);
    while end > 0 {
        match best[end].1 {
            Some(first) => {
                segments.push((origin + signed(first), origin + signed(end) - 1));
                end = first;
            }
            None => end -= 1,
        }
    }
    segments.reverse();
    segments
}

/// How many runs begin at a time or before, and end at a time or after.
struct Saved {
    n: usize,
    counts: Vec<i64>,
    begun: Vec<i64>,
    ended: Vec<i64>,
}

impl Saved {
    fn of(runs: impl Iterator<Item = (usize, usize)>, n: usize) -> Self {
        let mut saved = Self { n, counts: vec![0; n * n], begun: vec![0; n], ended: vec![0; n] };
        for (first, last) in runs {
            saved.counts[first * n + last] += 1;
            saved.begun[first] += 1;
            saved.ended[last] += 1;
        }
        for first in 0..n {
            for last in (0..n).rev() {
                let later = if last + 1 < n { saved.counts[first * n + last + 1] } else { 0 };
                saved.counts[first * n + last] += later;
            }
        }
        for at in n..n * n {
            saved.counts[at] += saved.counts[at - n];
        }
        for at in 1..n {
            saved.begun[at] += saved.begun[at - 1];
            saved.ended[at] += saved.ended[at - 1];
        }
        saved
    }

    /// What one segment saves.
    fn between(&self, first: usize, last: usize) -> i64 {
        let throughout = self.counts[first * self.n + last];
        let ended_before = if first == 0 { 0 } else { self.ended[first - 1] };
        let in_a_part = self.begun[last] - ended_before - throughout;
        (signed(last) - signed(first)) * (throughout - in_a_part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten orbits of twenty parts, one of which is interrupted after the eighth.
    #[test]
    fn an_interruption_is_where_it_is_cut() {
        let mut runs = vec![(0, 19); 9];
        runs.extend([(0, 7), (8, 19)]);
        assert_eq!(best_segments(&runs, 4), [(0, 7), (8, 19)]);
        assert_eq!(best_segments(&[(3, 19); 10], 4), [(3, 19)]);
        // What is interrupted near an end is not worth two loops.
        runs.truncate(9);
        runs.extend([(0, 0), (1, 19)]);
        assert_eq!(best_segments(&runs, 4), [(1, 19)]);
    }
}
