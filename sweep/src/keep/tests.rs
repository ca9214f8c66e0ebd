use super::*;

#[test]
fn a_parabola_is_kept() {
    let passage = |level, rises| Passage { column: 0, level, rises };
    let keep = Keep {
        columns: vec![Quantity::Kinetic, Quantity::Potential],
        finals: vec![1, 0],
        extremes: vec![0],
        passages: vec![passage(2.0, true), passage(-1.0, false), passage(9.0, true), passage(0.0, true)],
        series: vec![1],
        ..Keep::default()
    };
    let mut keeper = Keeper::new(&keep, 6);
    for _ in 0..2 {
        for k in 0..6 {
            let t = f64::from(k);
            let kinetic = t * (4.0 - t);
            keeper.sample(&Sample { t, kinetic, potential: -t, ..Sample::default() });
        }
        let mut numbers = vec![0.5];
        keeper.finish(true, &mut numbers);
        let expected = [0.5, -5.0, -5.0, -5.0, 4.0, 2.0 / 3.0, 4.2];
        assert_eq!(numbers[..7], expected);
        assert!(numbers[7].is_nan() && numbers[8] == 0.0, "{numbers:?}");
        assert_eq!(numbers[9..], [0.0, -1.0, -2.0, -3.0, -4.0, -5.0]);
        assert_eq!(numbers.len(), 1 + keep.width(6));
    }
    keeper.sample(&Sample { kinetic: 3.0, ..Sample::default() });
    let mut numbers = Vec::new();
    keeper.finish(false, &mut numbers);
    assert!(numbers[..8].iter().all(|x| x.is_nan()) && numbers[8] == 0.0 && numbers[9].is_nan());
}

#[test]
fn samples_are_those_of_the_schedule() {
    let settings = Settings { t_end: 1.0, step: 0.1, correct_every: Some(0.25), sample_every: 0.3 };
    assert_eq!(sample_times(&settings), [0.0, 0.3, 0.6, 3.0 * 0.3, 1.0]);
}
