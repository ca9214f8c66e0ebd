use super::*;
use std::cell::Cell;

/// By a clock that the run and the yardstick move on; both are interrupted for a second now and then.
#[test]
fn a_run_is_measured_in_yardsticks() {
    let (clock, n_calls) = (Cell::new(0.0), Cell::new(0));
    let pass = |seconds: f64| {
        n_calls.set(n_calls.get() + 1);
        clock.set(clock.get() + seconds + if n_calls.get() % 5 == 0 { 1.0 } else { 0.0 });
    };
    let yardstick = || pass(0.001);
    let run = || {
        pass(0.004);
        Ok::<(), ()>(())
    };
    let measured = in_turns(Duration::from_secs(1), || clock.get(), yardstick, run).unwrap();
    assert_eq!(measured.runs, TURNS as u64);
    assert!((measured.seconds - 0.004).abs() < 1e-12 && (measured.ratio - 4.0).abs() < 1e-9, "{measured:?}");
}

#[test]
fn a_long_run_is_made_once() {
    let clock = Cell::new(0.0);
    let run = || {
        clock.set(clock.get() + 10.0);
        Ok::<(), ()>(())
    };
    let yardstick = || clock.set(clock.get() + 0.5);
    let measured = in_turns(Duration::from_secs(1), || clock.get(), yardstick, run).unwrap();
    assert_eq!(measured, Measured { runs: 1, seconds: 10.0, ratio: 20.0 });
}

#[test]
fn a_run_that_fails_is_not_measured() {
    let mut left = 3;
    let failing = || {
        left -= 1;
        if left == 0 { Err("it fails") } else { Ok(()) }
    };
    assert_eq!(beside(Duration::from_millis(100), failing), Err("it fails"));
}
