use super::*;

#[test]
fn truncated_numbers_are_in_their_interval_and_as_likely_as_they_should_be() {
    for (from, to) in [(-1.0, 2.0), (8.0, 9.0), (-40.0, -39.0), (37.0, 60.0), (-0.5, 0.5)] {
        let distribution = Distribution::Truncated([0.0, 1.0], [from, to]);
        let mut last = f64::NEG_INFINITY;
        for k in 0..1000 {
            let x = distribution.quantile((f64::from(k) + 0.5) / 1000.0);
            assert!((from..=to).contains(&x) && x >= last, "{x} of {from} to {to}");
            last = x;
        }
    }
    // Far out it is nearly exponential: half of what lies beyond 37 lies within ln 2 / 37 of it.
    let median = Distribution::Truncated([0.0, 1.0], [37.0, 60.0]).quantile(0.5);
    assert!((median - 37.0 - std::f64::consts::LN_2 / 37.0).abs() < 2e-5, "{median}");
}

/// Against sums over what is equally likely, and for the far tail against an exponential distribution.
#[test]
fn moments_are_those_of_what_is_drawn() {
    for distribution in [
        Distribution::Uniform([-1.0, 3.0]),
        Distribution::LogUniform([1e-3, 20.0]),
        Distribution::Truncated([0.5, 2e-4], [0.4997, 0.5003]),
        Distribution::Truncated([0.0, 1.0], [-1.0, 2.0]),
        Distribution::Truncated([0.0, 1.0], [0.5, 0.509]),
        Distribution::Truncated([0.0, 1.0], [0.5, 0.511]),
        Distribution::Truncated([3.0, 2.0], [8.0, 9.0]),
    ] {
        let [mean, variance] = distribution.moments();
        let n = 100_000;
        let all = (0..n).map(|k| distribution.quantile((f64::from(k) + 0.5) / f64::from(n)));
        let sums = all.fold([0.0; 2], |[sum, squares], x| [sum + x, squares + (x - mean) * (x - mean)]);
        let [expected, spread] = sums.map(|sum| sum / f64::from(n));
        assert!(
            (mean - expected).abs() < 1e-7 * (1.0 + spread.sqrt()),
            "{distribution:?}: {mean} {expected}"
        );
        assert!((variance / spread - 1.0).abs() < 1e-6, "{distribution:?}: {variance} {spread}");
    }
    assert_eq!(Distribution::Normal([2.0, 3.0]).moments(), [2.0, 9.0]);
    let [mean, variance] = Distribution::Truncated([0.0, 1.0], [-60.0, -37.0]).moments();
    assert!((mean + 37.0 + 1.0 / 37.0).abs() < 1e-4 && (variance * 37.0 * 37.0 - 1.0).abs() < 5e-3);
    let [mean, variance] = Distribution::Truncated([0.0, 1.0], [-60.0, 60.0]).moments();
    assert!(mean.abs() < 1e-15 && (variance - 1.0).abs() < 1e-15);
}

#[test]
fn numbers_drawn_together_have_their_covariance() {
    let (mean, factor) = (vec![1.0, -2.0], vec![2.0, 0.0, -0.9, 0.5]);
    let draw = Draw::Together { targets: vec![1, 0], mean, factor };
    let (mut sums, mut squares, n) = ([0.0; 2], [0.0; 3], 200);
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let mut values = [0.0; 2];
        let u = [i, j].map(|k| (f64::from(k) + 0.5) / f64::from(n));
        draw.write(&u, &mut values);
        let [b, a] = [values[0] + 2.0, values[1] - 1.0];
        sums = [sums[0] + a, sums[1] + b];
        squares = [squares[0] + a * a, squares[1] + a * b, squares[2] + b * b];
    }
    let n = f64::from(n * n);
    assert!(sums.iter().all(|sum| sum.abs() / n < 1e-9), "{sums:?}");
    for (found, expected) in squares.iter().zip([4.0, -1.8, 0.81 + 0.25]) {
        assert!((found / n / expected - 1.0).abs() < 0.02, "{squares:?}");
    }
}

#[test]
#[cfg(feature = "study")]
fn a_factor_gives_its_matrix_back() {
    let matrix = [4.0, -1.8, 0.4, -1.8, 1.06, 0.1, 0.4, 0.1, 2.0];
    let factor = cholesky(&matrix, 3).unwrap();
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let product: f64 = (0..3).map(|k| factor[3 * i + k] * factor[3 * j + k]).sum();
        assert!((product - matrix[3 * i + j]).abs() < 1e-14);
    }
    assert_eq!(cholesky(&[1.0, 2.0, 2.0, 1.0], 2), None);
}
