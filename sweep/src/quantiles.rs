//! Quantiles over scenarios.

/// The quantiles: bands between the outer and between the inner ones, and the median.
pub const QUANTILES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// The quantiles of these numbers, linear between order statistics; those that are not finite are left out, and NaN is
/// returned if none is left.
pub fn quantiles(values: &mut Vec<f64>) -> [f64; QUANTILES.len()] {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return [f64::NAN; QUANTILES.len()] };
    QUANTILES.map(|q| {
        #[expect(clippy::cast_precision_loss, reason = "numbers of scenarios stay below 2⁵³")]
        let place = q * last as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to the last index")]
        let below = place as usize;
        let above = (below + 1).min(last);
        let part = place - place.floor();
        values[below] + part * (values[above] - values[below])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_between_order_statistics() {
        let mut values: Vec<f64> = (0..=20).rev().map(f64::from).chain([f64::NAN]).collect();
        for (found, expected) in quantiles(&mut values).iter().zip([1.0, 5.0, 10.0, 15.0, 19.0]) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
        assert_eq!(quantiles(&mut vec![3.0]), [3.0; 5]);
        assert!(quantiles(&mut vec![f64::NAN])[0].is_nan());
    }
}
