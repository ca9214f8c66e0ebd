//! Fewer points that draw the same curve.

/// Columns of a panel: two points of one column cannot be told apart.
const BUCKETS: usize = 600;

/// Indices of the values to draw: of each bucket the first, smallest, largest and last, in their order.
pub(crate) fn indices(values: &[f64]) -> Vec<usize> {
    if values.len() <= 4 * BUCKETS {
        return (0..values.len()).collect();
    }
    let mut indices = Vec::with_capacity(4 * BUCKETS);
    for bucket in 0..BUCKETS {
        let range = bucket * values.len() / BUCKETS..(bucket + 1) * values.len() / BUCKETS;
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        let smallest = range.clone().min_by(by_value).unwrap_or(range.start);
        let largest = range.clone().max_by(by_value).unwrap_or(range.start);
        let mut chosen = [range.start, smallest, largest, range.end - 1];
        chosen.sort_unstable();
        indices.extend(chosen);
    }
    indices.dedup();
    indices
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_points_are_kept_and_of_many_the_extremes() {
        assert_eq!(indices(&[1.0, 2.0, 0.0]), [0, 1, 2]);
        let mut values: Vec<f64> = (0..100_000).map(|k| (f64::from(k) * 0.01).sin()).collect();
        values[54_321] = 10.0;
        values[12_345] = -10.0;
        let kept = indices(&values);
        assert!(kept.len() <= 4 * BUCKETS && kept.is_sorted());
        assert!([0, 12_345, 54_321, 99_999].iter().all(|k| kept.contains(k)));
    }
}
