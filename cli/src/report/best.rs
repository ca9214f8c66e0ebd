//! The best of the points: what to choose for an error, and the envelope of the diagrams.

use super::curve::Point;

/// Errors for which choices are recommended.
pub(crate) const TARGETS: [f64; 5] = [1e-4, 1e-6, 1e-8, 1e-10, 1e-12];

/// The quickest of the points whose error is no larger.
pub(crate) fn best<'a>(points: impl IntoIterator<Item = &'a Point>, target: f64) -> Option<&'a Point> {
    let reached = points.into_iter().filter_map(|point| Some((point, point.outcome.as_ref().ok()?)));
    let reached = reached.filter(|(_, outcome)| outcome.error <= target);
    reached.min_by(|(_, a), (_, b)| a.ratio.total_cmp(&b.ratio)).map(|(point, _)| point)
}

/// The smallest error that any of the points has.
pub(crate) fn smallest_error<'a>(points: impl IntoIterator<Item = &'a Point>) -> Option<f64> {
    let errors = points.into_iter().filter_map(|point| Some(point.outcome.as_ref().ok()?.error));
    errors.filter(|error| error.is_finite()).min_by(f64::total_cmp)
}

/// Points that no other one beats in both, cost and error: from the dearest to the cheapest.
pub(crate) fn front(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut sorted: Vec<_> = points.iter().copied().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for point in sorted {
        if front.last().is_none_or(|last| point.1 < last.1) {
            front.push(point);
        }
    }
    front
}

/// Messages of failures, each with how often it happened, the most frequent first. Numbers in them do not tell them
/// apart.
pub(crate) fn reasons<'a>(points: impl IntoIterator<Item = &'a Point>) -> Vec<(usize, String)> {
    let mut reasons: Vec<(usize, String, String)> = Vec::new();
    for words in points.into_iter().filter_map(|point| point.outcome.as_ref().err()) {
        let kind: String = words.chars().filter(|c| !c.is_ascii_digit()).collect();
        match reasons.iter_mut().find(|(_, known, _)| *known == kind) {
            Some((count, ..)) => *count += 1,
            None => reasons.push((1, kind, words.clone())),
        }
    }
    reasons.sort_by_key(|(count, ..)| std::cmp::Reverse(*count));
    reasons.into_iter().map(|(count, _, words)| (count, words)).collect()
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::args::Precision;
    use crate::report::curve::Engine;
    use crate::report::curve::{Curve, Outcome, Setting, Treatment};
    use gyro_runner::Integrator;

    pub(crate) fn point(setting: f64, outcome: Result<(f64, f64), &str>) -> Point {
        let curve = Curve {
            engine: Engine::Generated,
            precision: Precision::F64,
            integrator: Integrator::Dop853,
            treatment: Treatment::Joint,
        };
        let outcome = outcome.map(|(ratio, error)| Outcome { ratio, error, ..Outcome::default() });
        Point { curve, setting: Setting::Tolerance(setting), outcome: outcome.map_err(str::to_owned) }
    }

    #[test]
    fn the_quickest_that_is_good_enough_is_chosen() {
        let points = [
            point(1e-3, Ok((0.1, 1e-3))),
            point(1e-4, Ok((0.3, 9e-7))),
            point(1e-5, Err("at t = 0.1 s it fails")),
            point(1e-6, Ok((0.2, 1e-6))),
            point(1e-7, Ok((0.05, f64::INFINITY))),
            point(1e-8, Ok((0.05, f64::NAN))),
        ];
        let chosen = |target| best(&points, target).map(|point| point.setting);
        assert_eq!(chosen(1e-4), Some(Setting::Tolerance(1e-6)));
        assert_eq!(chosen(1e-6), Some(Setting::Tolerance(1e-6)));
        assert_eq!(chosen(9.5e-7), Some(Setting::Tolerance(1e-4)));
        assert_eq!(chosen(1e-8), None);
        assert_eq!(smallest_error(&points), Some(9e-7));
    }

    #[test]
    fn the_front_has_only_what_nothing_beats() {
        let points = [(1.0, 1e-3), (2.0, 1e-2), (3.0, 1e-6), (3.0, 1e-5), (4.0, 1e-6), (f64::NAN, 0.0)];
        assert_eq!(front(&points), [(1.0, 1e-3), (3.0, 1e-6)]);
    }

    #[test]
    fn failures_are_counted_and_kept_in_words() {
        let failed = ["at t = 0.5 s it fails", "at t = 0.25 s it fails", "no kit"];
        let mut points: Vec<Point> = failed.iter().map(|words| point(1e-3, Err(words))).collect();
        points.push(point(1e-3, Ok((1.0, 1.0))));
        assert_eq!(reasons(&points), [(2, failed[0].to_owned()), (1, failed[2].to_owned())]);
    }
}
