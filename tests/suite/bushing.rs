//! An implicit method on a loop with a stiff bushing: the error is that of its tolerance, and steps are as long as the
//! slow motion allows. Closing the loop after each step must not move the bushing, whose spring throws it back within
//! a hundredth of a step.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_reference::{BushingFourBar, JointRow};
use gyro_sim::{CloseLoops, Control, Joint, JointJacobian, JointSpace, Rodas4, Solver};
use gyro_sim_suite::compiled;

/// s.
const T_END: f64 = 1.0;

/// Over one and the value, in tolerances: errors of some hundred steps add up.
const TIMES: f64 = 10.0;

/// Steps in that second at a tolerance of 1e-6.
const STEPS: u64 = 200;

/// The worst error over one and the value, and the number of steps.
fn run(tolerance: f64, expected: &JointRow) -> (f64, u64) {
    let linkage = compiled::<f64>("four-bar-bushing");
    let (mut x, mut loops) = (linkage.joint_start(), CloseLoops::new(&linkage));
    loops.correct(&linkage, 0.0, &mut x).unwrap();
    let method = Rodas4::new(&x, linkage.jacobian_buffers().jacobian);
    let control = Control { relative: tolerance, absolute: tolerance, ..Control::default() };
    let mut solver = Solver::with_correction(Joint, method, loops, 0.0, &x).with_control(control);
    solver.advance_to(&linkage, T_END).unwrap_or_else(|error| panic!("{tolerance:e}: {error:?}"));
    let expected = expected.positions[..4].iter().chain(&expected.rates[..4]);
    let errors = solver.state().iter().zip(expected).map(|(a, b)| (a - b).abs() / (1.0 + b.abs()));
    (errors.fold(0.0, f64::max), solver.statistics().accepted)
}

#[test]
fn rodas_is_as_good_as_its_tolerance_and_takes_the_steps_of_the_slow_motion() {
    let expected = &BushingFourBar::default().solve(&[T_END])[0];
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
        let (error, steps) = run(tolerance, expected);
        println!("{tolerance:e}: off by {error:.1e} in {steps} steps");
        assert!(error <= TIMES * tolerance, "{tolerance:e}: off by {error:e}");
        assert!(tolerance < 1e-6 || steps <= STEPS, "{tolerance:e}: {steps} steps");
    }
}
