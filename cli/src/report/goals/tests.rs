use super::*;
use crate::report::best::tests::point;

#[test]
fn goals_are_met_or_not() {
    let goal =
        |limit, reached| Goal { what: String::new(), limit, reached, by: String::new(), is_time: false };
    for (limit, reached, is_met) in [
        (Limit::AtMost(0.08), Some(0.08), true),
        (Limit::AtMost(0.08), Some(0.081), false),
        (Limit::AtMost(0.08), Some(f64::NAN), false),
        (Limit::AtMost(0.08), None, false),
        (Limit::AtLeast(80.0), Some(79.0), false),
        (Limit::Near(8.0, 0.5), Some(7.6), true),
        (Limit::Near(8.0, 0.5), Some(8.6), false),
    ] {
        assert_eq!(goal(limit, reached).is_met(), is_met, "{limit:?} {reached:?}");
    }
}

#[test]
fn the_paper_s_goals_are_read_off_the_points() {
    let points = [point(1e-8, Ok((0.05, 2e-7))), point(1e-10, Ok((0.3, 5e-10)))];
    let goals = of_the_paper(&points, 1.0);
    let reached: Vec<_> = goals.iter().take(3).map(|goal| (goal.reached, goal.is_met())).collect();
    assert_eq!(reached, [(Some(0.05), true), (Some(0.3), false), (None, false)]);
    assert!(goals[0].by.starts_with("dop853, joint coordinates, tolerance 1e-8"), "{}", goals[0].by);
    assert!(goals[3..].iter().all(|goal| goal.reached.is_none()));
}
