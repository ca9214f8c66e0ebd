use super::*;

const ROWS: [[f64; 2]; 3] = [[1.0, 10.0], [2.0, 20.0], [4.0, 0.0]];

#[test]
fn tables_are_linear_inside_and_held_outside() {
    let input = Input::new(0, ROWS.to_vec(), Between::Linear);
    for (t, value) in
        [(0.0, 10.0), (1.0, 10.0), (1.25, 12.5), (2.0, 20.0), (3.5, 5.0), (4.0, 0.0), (9.0, 0.0)]
    {
        assert_eq!(input.at(t), value, "{t}");
    }
    assert_eq!(Input::new(0, vec![[5.0, 3.0]], Between::Linear).at(-1.0), 3.0);
    assert_eq!(Input::new(0, vec![], Between::Linear).at(1.0), 0.0);
}

#[test]
fn held_inputs_jump_at_their_rows_and_smooth_ones_are_splines() {
    let held = Input::new(0, ROWS.to_vec(), Between::Held);
    for (t, value) in [(0.0, 10.0), (1.9, 10.0), (2.0, 20.0), (3.9, 20.0), (4.0, 0.0), (9.0, 0.0)] {
        assert_eq!(held.at(t), value, "{t}");
    }
    // The spline through (0, 0), (1, 1), (3, 0), whose pieces are 1.25 u − u³/4 and 1 + u/2 − 3/4 u² + u³/8.
    let smooth = Input::new(0, vec![[0.0, 0.0], [1.0, 1.0], [3.0, 0.0]], Between::Smooth);
    for (t, value) in [(-1.0, 0.0), (0.5, 0.59375), (1.0, 1.0), (2.0, 0.875), (3.0, 0.0), (5.0, 0.0)] {
        assert!((smooth.at(t) - value).abs() < 1e-15, "{t}: {}", smooth.at(t));
    }
    let extremes = smooth.extremes();
    assert_eq!(extremes.len(), 4, "{extremes:?}");
    // Where 1/2 − 3/2 u + 3/8 u² vanishes.
    let u = 2.0 - (8.0_f64 / 3.0).sqrt();
    assert!((extremes[3][0] - 1.0 - u).abs() < 1e-14, "{extremes:?}");
}

#[test]
fn knots_are_where_something_changes() {
    let rows = vec![[0.0, 1.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0], [4.0, 3.0]];
    let knots = |between| Input::new(0, rows.clone(), between).knots().collect::<Vec<_>>();
    assert_eq!(knots(Between::Held), [2.0, 3.0]);
    assert_eq!(knots(Between::Linear), [1.0, 3.0]);
    assert_eq!(knots(Between::Smooth), [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert_eq!(Input::constant(0, 2.0).knots().count(), 0);
}

#[test]
fn a_table_of_equal_values_does_not_vary() {
    let constant = Input::new(0, vec![[0.0, 1.0], [1.0, 1.0]], Between::Linear);
    let ramp = Input::new(1, vec![[0.0, 1.0], [1.0, 2.0]], Between::Linear);
    assert!(!any_varies(std::slice::from_ref(&constant)) && any_varies(&[constant, ramp]));
}
