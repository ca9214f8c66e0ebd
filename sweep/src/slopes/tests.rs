use super::*;
use crate::{Passage, Quantity};

/// `y = p t (4 − t)` and its derivative by p.
fn parabola(p: f64, t: f64) -> Sloped {
    Sloped { value: p * t * (4.0 - t), slopes: vec![2.0 * t * (4.0 - t)] }
}

#[test]
fn slopes_of_a_parabola_are_differences_of_what_is_kept() {
    let passage = |level, rises| Passage { column: 0, level, rises };
    let keep = Keep {
        columns: vec![Quantity::Kinetic],
        finals: vec![0],
        extremes: vec![0],
        passages: vec![passage(2.0, true), passage(-1.0, false), passage(9.0, true), passage(0.0, true)],
        by: vec![0],
        sloped: vec![0],
        ..Keep::default()
    };
    let mut slopes = Slopes::new(&keep, 6);
    let kept = |p: f64| {
        let mut keeper = crate::Keeper::new(&keep, 6);
        (0..6).for_each(|k| keeper.take(f64::from(k), |_| parabola(p, f64::from(k)).value));
        let mut numbers = Vec::new();
        keeper.finish(true, &mut numbers);
        numbers
    };
    for _ in 0..2 {
        (0..6).for_each(|k| slopes.take(f64::from(k), vec![parabola(1.0, f64::from(k))]));
        let mut found = Vec::new();
        slopes.finish(true, &[2.0], &mut found);
        let (above, below) = (kept(1.0 + 1e-5), kept(1.0 - 1e-5));
        let series = found.split_off(keep.slopes());
        let expected: Vec<f64> = (0..6).map(|k| parabola(1.0, f64::from(k)).slopes[0] / 2.0).collect();
        assert_eq!(series, expected);
        assert_eq!(found.len(), keep.slopes());
        for (found, (above, below)) in found.iter().zip(above.iter().zip(&below)) {
            let expected = (above - below) / 2e-5;
            assert!(
                found.is_nan() && expected.is_nan() || (found - expected).abs() < 1e-8,
                "{found} {expected}"
            );
        }
    }
    slopes.take(0.0, vec![parabola(1.0, 0.0)]);
    let mut found = Vec::new();
    slopes.finish(false, &[1.0], &mut found);
    let series = found.split_off(keep.slopes());
    assert!(found.len() == keep.slopes() && found.iter().all(|x| x.is_nan()));
    assert!(series.len() == 6 && series[0] == 0.0 && series[1..].iter().all(|x| x.is_nan()));
}
