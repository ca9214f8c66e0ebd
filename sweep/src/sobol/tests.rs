use super::*;

/// The first points of the authors' program in three dimensions.
#[test]
fn the_first_points_are_the_published_ones() {
    let published = [
        [0.0, 0.0, 0.0],
        [0.5, 0.5, 0.5],
        [0.75, 0.25, 0.25],
        [0.25, 0.75, 0.75],
        [0.375, 0.375, 0.625],
        [0.875, 0.875, 0.125],
        [0.625, 0.125, 0.875],
        [0.125, 0.625, 0.375],
        [0.1875, 0.3125, 0.9375],
        [0.6875, 0.8125, 0.4375],
    ];
    let sobol = Sobol::new(3);
    for (k, point) in (0..).zip(published) {
        for (dimension, expected) in point.into_iter().enumerate() {
            assert_eq!(sobol.bits(k, dimension), (expected * 2f64.powi(BITS as i32)) as u64, "{k}");
        }
    }
}

/// Each dimension puts one of the first 2^m points into each interval of length 2^−m, as does each 2^m after them.
#[test]
fn every_dimension_is_stratified() {
    let sobol = Sobol::new(DIMENSIONS);
    for (dimension, first) in (0..DIMENSIONS).flat_map(|d| [(d, 0), (d, 3 << 10)]) {
        let mut seen = [false; 1 << 10];
        (first..first + (1 << 10))
            .for_each(|k| seen[(sobol.bits(k, dimension) >> (BITS - 10)) as usize] = true);
        assert!(seen.into_iter().all(|seen| seen), "dimension {dimension}");
    }
}

/// Joe and Kuo's criterion is about pairs: of the first ten dimensions each pair is a (t, 10, 2) net of a small t.
#[test]
fn pairs_of_dimensions_are_nets() {
    let sobol = Sobol::new(10);
    for (i, j) in (0..10).flat_map(|i| (0..i).map(move |j| (i, j))) {
        let cell = |k: u64| (sobol.bits(k, i) >> (BITS - 3)) << 3 | sobol.bits(k, j) >> (BITS - 3);
        let mut counts = [0; 64];
        (0..1024).for_each(|k| counts[cell(k) as usize] += 1);
        assert!(counts.iter().all(|&count| count == 16), "{i}, {j}: {counts:?}");
    }
}
