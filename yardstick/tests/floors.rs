//! The floors of closed loops against their references, and what they cost.
#![allow(clippy::print_stdout, reason = "the counts, for runs with --nocapture")]

use gyro_reference::{StewartPlatform, StewartSample, scene};
use gyro_sim::{Control, Dop853, Ode, Solver};
use gyro_yardstick::{Counted, FourBar, Operations, SliderCrank, Stewart, operations};

/// Over one and the value: what is left of tolerances of 1e-13 after a second.
const MOTION: f64 = 1e-10;

/// After `times` of control by the finest tolerances.
fn moved<D: Ode<Scalar = f64, State = [f64; N]> + Copy, const N: usize>(
    floor: D,
    start: [f64; N],
    times: &[f64],
) -> Vec<[f64; N]> {
    let control = Control::default().with_tolerance(1e-13);
    let mut solver = Solver::new(floor, Dop853::new(&start), 0.0, &start).with_control(control);
    let to = |t: &f64| {
        solver.advance_to(&(), *t).unwrap_or_else(|error| panic!("{error}"));
        *solver.state()
    };
    times.iter().map(to).collect()
}

/// The first coordinate of the reference and its rate.
fn check_crank<D: Ode<Scalar = f64, State = [f64; 2]> + Copy>(name: &str, floor: D, start: [f64; 2]) {
    let times = [0.0, 0.1, 0.35, 1.0];
    let rows = scene(name).expect("it has a reference").solve(&times);
    for (found, row) in moved(floor, start, &times).iter().zip(&rows) {
        for (found, expected) in found.iter().zip([row.positions[0], row.rates[0]]) {
            let error = (found - expected).abs() / (1.0 + expected.abs());
            assert!(error <= MOTION, "{name} at {} s: {found}, not {expected}", row.t);
        }
    }
}

fn cost<D: Ode<Scalar = Counted, State = [Counted; N]>, const N: usize>(
    floor: &D,
    start: &[Counted; N],
) -> Operations {
    let found = operations(|| floor.derivative(&(), Counted(0.0), start, &mut [Counted(0.0); N]));
    println!("{found:?}");
    found
}

#[test]
fn the_four_bar_moves_as_its_reference() {
    check_crank("four-bar", FourBar::crank_rocker(), FourBar::start());
}

#[test]
fn the_four_bar_takes_as_many_operations_as_are_written_down() {
    let found = cost(&FourBar::crank_rocker(), &FourBar::start());
    assert_eq!(found, Operations { flops: 50, roots: 1, angles: 1 });
}

#[test]
fn the_slider_crank_moves_as_its_reference() {
    check_crank("slider-crank", SliderCrank::in_line(), SliderCrank::start());
}

#[test]
fn the_slider_crank_takes_as_many_operations_as_are_written_down() {
    let found = cost(&SliderCrank::in_line(), &SliderCrank::start());
    assert_eq!(found, Operations { flops: 29, roots: 1, angles: 1 });
}

/// The floor's state.
fn state(sample: &StewartSample) -> [f64; 13] {
    let ([x, y, z], [e0, e1, e2, e3]) = (sample.plate.position, sample.euler_parameters);
    let (rotation, v, [wx, wy, wz]) =
        (sample.plate.rotation, sample.plate.velocity, sample.plate.angular_velocity);
    let [vx, vy, vz] = [0, 1, 2].map(|k| (0..3).map(|row| rotation[row][k] * v[row]).sum());
    [x, y, z, e0, e1, e2, e3, vx, vy, vz, wx, wy, wz]
}

#[test]
fn the_stewart_platform_moves_as_its_reference() {
    let times = [0.0, 0.1, 0.5];
    let expected = StewartPlatform::plate_of_ten_kilograms().solve(&times);
    for (found, sample) in moved(Stewart::platform(), Stewart::start(), &times).iter().zip(&expected) {
        for (found, expected) in found.iter().zip(state(sample)) {
            let error = (found - expected).abs() / (1.0 + expected.abs());
            assert!(error <= MOTION, "at {} s: {found:?}, not {:?}", sample.t, state(sample));
        }
    }
}

#[test]
fn the_stewart_platform_takes_as_many_operations_as_are_written_down() {
    let found = cost(&Stewart::platform(), &Stewart::start());
    assert_eq!(found, Operations { flops: 1585, roots: 6, angles: 0 });
}

#[test]
fn single_precision_is_offered_as_well() {
    let [angle, rate] = FourBar::<f32>::start();
    let found = FourBar::<f32>::crank_rocker().acceleration(angle, rate);
    let [angle, rate] = FourBar::<f64>::start();
    let expected = FourBar::<f64>::crank_rocker().acceleration(angle, rate);
    assert!((f64::from(found) - expected).abs() <= 1e-4 * expected.abs(), "{found} {expected}");
}
