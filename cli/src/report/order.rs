//! Orders of convergence, from errors at fixed steps.

/// Errors between which an order is fitted: above them steps are too long, below them rounding shows.
pub(crate) const WINDOW: (f64, f64) = (1e-11, 1e-7);

/// A fitted order and the number of errors behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Order {
    pub(crate) order: f64,
    pub(crate) n_points: usize,
}

/// The slope of log error over log step by least squares, for errors within the window, at steps no shorter than that
/// of the smallest error: shorter ones add up rounding. `None` with fewer than three.
pub(crate) fn fit(errors: &[(f64, f64)]) -> Option<Order> {
    let (least, most) = WINDOW;
    let shortest = errors.iter().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0.0, |(h, _)| *h);
    let logs: Vec<(f64, f64)> = errors
        .iter()
        .filter(|(h, error)| *h > 0.0 && *h >= shortest && (least..=most).contains(error))
        .map(|(h, error)| (h.ln(), error.ln()))
        .collect();
    if logs.len() < 3 {
        return None;
    }
    let n = logs.len() as f64;
    let (x, y) = logs.iter().fold((0.0, 0.0), |(x, y), log| (x + log.0 / n, y + log.1 / n));
    let (xx, xy) = logs.iter().fold((0.0, 0.0), |(xx, xy), log| {
        let dx = log.0 - x;
        (xx + dx * dx, xy + dx * (log.1 - y))
    });
    Some(Order { order: xy / xx, n_points: logs.len() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of the logarithms.
    const EXACT: f64 = 1e-9;

    #[test]
    fn a_planted_order_is_found_and_rounding_left_out() {
        for order in [4.0, 5.0, 8.0_f64] {
            let error = |h: f64| 0.3 * h.powf(order);
            let mut errors: Vec<(f64, f64)> =
                (0..60).map(|k| 10f64.powf(-0.1 * f64::from(k))).map(|h| (h, error(h))).collect();
            // Below some step errors do not shrink any more, and grow again.
            errors.retain(|(_, error)| *error > 1e-12);
            let shortest = errors.last().unwrap().0;
            errors.extend((1..9).map(|k| (shortest * 0.5_f64.powi(k), 3e-13 * 4.0_f64.powi(k - 1))));
            let found = fit(&errors).unwrap();
            assert!((found.order - order).abs() < EXACT && found.n_points >= 4, "{order}: {found:?}");
        }
    }

    #[test]
    fn two_points_are_no_order() {
        assert_eq!(fit(&[(1e-2, 1e-8), (1e-3, 1e-10), (1e-4, 1e-13), (1.0, 1.0)]), None);
    }
}
