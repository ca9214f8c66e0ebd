//! Prints of each floor of a closed loop what an evaluation takes, and the time that DOP853 takes for given errors.
#![allow(clippy::print_stdout, reason = "that is what it is for")]

use gyro_reference::{StewartPlatform, scene};
use gyro_sim::{Control, Dop853, Error, Ode, Solver};
use gyro_yardstick::{Counted, FourBar, SliderCrank, Stewart, operations};
use std::hint::black_box;
use std::time::Instant;

/// States that are evaluated, how often between two looks at the clock, and looks, of which the quickest counts.
const STATES: u32 = 100;
const ROUNDS: u32 = 100;
const LOOKS: u32 = 30;

/// The quickest of several times, s.
fn quickest(mut action: impl FnMut()) -> f64 {
    let once = |_| {
        let began = Instant::now();
        action();
        began.elapsed().as_secs_f64()
    };
    (0..LOOKS).map(once).fold(f64::INFINITY, f64::min)
}

/// Of an evaluation, s: of many that a processor may overlap, and where each waits for the one before, as in a solver.
fn evaluation<D: Ode<Scalar = f64, State = [f64; N]>, const N: usize>(
    floor: &D,
    states: &[[f64; N]],
) -> [f64; 2] {
    [0.0, 1e-300].map(|share| {
        let mut dy = [0.0; N];
        let many = || {
            for _ in 0..ROUNDS {
                for state in states {
                    let mut y = *black_box(state);
                    if share > 0.0 {
                        y[0] += share * dy[N - 1];
                    }
                    black_box(floor).derivative(&(), 0.0, &y, &mut dy);
                    black_box(&dy);
                }
            }
        };
        quickest(many) / (f64::from(ROUNDS) * states.len() as f64)
    })
}

/// State at the end, and evaluations.
fn run<D: Ode<Scalar = f64, State = [f64; N]> + Copy, const N: usize>(
    floor: D,
    start: &[f64; N],
    t_end: f64,
    tolerance: f64,
) -> Result<([f64; N], u64), Error> {
    let control = Control::default().with_tolerance(tolerance);
    let mut solver = Solver::new(floor, Dop853::new(start), 0.0, start).with_control(control);
    solver.advance_to(&(), t_end)?;
    Ok((*solver.state(), solver.statistics().work.evaluations))
}

/// The loosest tolerance by which the error at the end is within each goal.
fn goals<D: Ode<Scalar = f64, State = [f64; N]> + Copy, const N: usize>(
    floor: D,
    start: &[f64; N],
    t_end: f64,
    error: impl Fn(&[f64; N]) -> f64,
) {
    for goal in [1e-6, 1e-9] {
        let tolerances = (8..60).map(|n| 10f64.powf(-0.25 * f64::from(n)));
        let good = |tolerance: &f64| {
            run(floor, start, t_end, *tolerance).is_ok_and(|(state, _)| error(&state) <= goal)
        };
        let Some(tolerance) = tolerances.into_iter().find(good) else {
            println!("  error {goal:e}: not reached");
            continue;
        };
        let Ok((state, evaluations)) = run(floor, start, t_end, tolerance) else { continue };
        let seconds = quickest(|| {
            let _ = black_box(run(floor, black_box(start), t_end, tolerance));
        });
        println!(
            "  error {goal:e}: {:.3} ms for {t_end} s, {evaluations} evaluations, tolerance {tolerance:.1e}, error \
             {:.1e}",
            1e3 * seconds,
            error(&state)
        );
    }
}

/// What an evaluation takes, at states of the motion.
fn costs<D, C, const N: usize>(
    name: &str,
    (floor, start): (D, [f64; N]),
    (counted, from): (C, [Counted; N]),
    t_end: f64,
) where
    D: Ode<Scalar = f64, State = [f64; N]> + Copy,
    C: Ode<Scalar = Counted, State = [Counted; N]>,
{
    let cost = operations(|| counted.derivative(&(), Counted(0.0), &from, &mut [Counted(0.0); N]));
    let states: Vec<_> = (0..STATES)
        .filter_map(|k| run(floor, &start, t_end * f64::from(k) / f64::from(STATES), 1e-9).ok())
        .map(|(state, _)| state)
        .collect();
    let [overlapped, waiting] = evaluation(&floor, &states).map(|seconds| 1e9 * seconds);
    println!(
        "{name}: {cost:?}, {overlapped:.1} ns an evaluation, {waiting:.1} ns where each waits for the last"
    );
}

/// Errors of the first coordinate, rad, which is that of the reference.
fn crank<D: Ode<Scalar = f64, State = [f64; 2]> + Copy>(name: &str, floor: D, start: &[f64; 2], t_end: f64) {
    let Some(reference) = scene(name) else { return };
    let expected = reference.solve(&[t_end])[0].positions[0];
    goals(floor, start, t_end, |state| (state[0] - expected).abs());
}

fn main() {
    let (floor, start) = (FourBar::crank_rocker(), FourBar::start());
    costs("four-bar", (floor, start), (FourBar::crank_rocker(), FourBar::start()), 10.0);
    crank("four-bar", floor, &start, 10.0);

    let (floor, start) = (SliderCrank::in_line(), SliderCrank::start());
    costs("slider-crank", (floor, start), (SliderCrank::in_line(), SliderCrank::start()), 10.0);
    crank("slider-crank", floor, &start, 10.0);

    // Errors of the plate's position, m.
    let (floor, start) = (Stewart::platform(), Stewart::start());
    costs("stewart-platform", (floor, start), (Stewart::platform(), Stewart::start()), 1.0);
    let expected = StewartPlatform::plate_of_ten_kilograms().solve(&[1.0])[0].plate.position;
    goals(floor, &start, 1.0, |state| {
        expected.iter().zip(state).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    });
}
