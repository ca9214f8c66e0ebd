//! Loops in joint coordinates beside floors derived by hand: what an evaluation takes, a correction, and DOP853 for
//! given errors. One process, in turns, medians.
#![allow(clippy::print_stdout, reason = "that is what it is for")]

use gyro_mechanisms::{four_bar, slider_crank};
use gyro_reference::scene;
use gyro_sim::{
    CloseLoops, Control, Correction, Dop853, Error, Joint, JointSpace, Kutta4, Ode, Partition, Solver,
};
use gyro_yardstick::{FourBar, SliderCrank};
use std::hint::black_box;
use std::time::Instant;

/// Rounds of which the median counts, and calls in each.
const ROUNDS: usize = 41;
const CALLS: usize = 20_000;

/// The medians of several times, measured in turns, s.
fn medians<const N: usize>(calls: usize, actions: &mut [&mut dyn FnMut(); N]) -> [f64; N] {
    let mut times = [(); N].map(|()| Vec::new());
    for _ in 0..ROUNDS {
        for (times, action) in times.iter_mut().zip(actions.iter_mut()) {
            let began = Instant::now();
            (0..calls).for_each(|_| action());
            times.push(began.elapsed().as_secs_f64() / calls as f64);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[ROUNDS / 2]
    })
}

/// The end of a run and its evaluations.
fn run<D, M, C>(
    (dynamics, correction): (D, C),
    model: &M,
    start: &D::State,
    t_end: f64,
    tolerance: f64,
) -> Result<(D::State, u64), Error>
where
    D: Ode<M, Scalar = f64>,
    C: Correction<D, M>,
{
    let control = Control::default().with_tolerance(tolerance);
    let mut solver = Solver::with_correction(dynamics, Dop853::new(start), correction, 0.0, start);
    solver = solver.with_control(control);
    solver.advance_to(model, t_end)?;
    Ok((solver.state().clone(), solver.statistics().work.evaluations))
}

/// The loosest tolerance of which the error at the end is within a goal.
fn tolerance_for(goal: f64, error: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    (8..60)
        .map(|n| 10f64.powf(-0.25 * f64::from(n)))
        .find(|&tolerance| error(tolerance).is_some_and(|e| e <= goal))
}

fn compare<F, M>(name: &str, floor: F, from: [f64; 2], mechanism: &M)
where
    F: Ode<Scalar = f64, State = [f64; 2]> + Copy,
    M: JointSpace<Scalar = f64> + Partition,
    M::Joints: Clone,
{
    const T_END: f64 = 10.0;
    let start = mechanism.joint_start();
    let (mut dy, mut dx) = ([0.0; 2], start.clone());
    let (mut y, mut x) = (from, start.clone());
    let mut drifted = start.clone();
    let mut loops = CloseLoops::new(mechanism);
    let mut rk4 = Solver::new(Joint, Kutta4::new(&start), 0.0, &start);
    let [by_hand, generated, closing, step] = medians(
        CALLS,
        &mut [
            &mut || {
                floor.derivative(&(), 0.0, black_box(&y), &mut dy);
                y[0] += 1e-6 + 1e-300 * dy[1];
            },
            &mut || {
                Joint.derivative(mechanism, 0.0, black_box(&x), &mut dx);
                let n = dx.as_ref().len();
                x.as_mut()[0] += 1e-6 + 1e-300 * dx.as_ref()[n - 1];
            },
            &mut || {
                drifted.as_mut()[1] += 1e-9;
                let _ = loops.correct(mechanism, 0.0, black_box(&mut drifted));
            },
            &mut || {
                let _ = rk4.step(mechanism, 1e-9);
            },
        ],
    );
    println!(
        "{name}: f by hand {:.1} ns, generated {:.1} ns: {:.2}; a correction {:.1} ns, a step of RK4 {:.1} ns: {:.2}",
        1e9 * by_hand,
        1e9 * generated,
        generated / by_hand,
        1e9 * closing,
        1e9 * step,
        closing / step
    );
    let Some(reference) = scene(name) else { return };
    let expected = reference.solve(&[T_END])[0].positions[0];
    for goal in [1e-6, 1e-9] {
        let by_floor = |tolerance| run((floor, gyro_sim::Uncorrected), &(), &from, T_END, tolerance);
        let by_joints =
            |tolerance| run((Joint, CloseLoops::new(mechanism)), mechanism, &start, T_END, tolerance);
        let of_floor = tolerance_for(goal, |t| by_floor(t).ok().map(|(y, _)| (y[0] - expected).abs()));
        let of_joints =
            tolerance_for(goal, |t| by_joints(t).ok().map(|(x, _)| (x.as_ref()[0] - expected).abs()));
        let (Some(of_floor), Some(of_joints)) = (of_floor, of_joints) else {
            println!("  error {goal:e}: not reached ({of_floor:?}, {of_joints:?})");
            continue;
        };
        let evaluations = [by_floor(of_floor).map(|r| r.1), by_joints(of_joints).map(|r| r.1)];
        let [hand, joints] = medians(
            1,
            &mut [
                &mut || {
                    let _ = black_box(by_floor(black_box(of_floor)));
                },
                &mut || {
                    let _ = black_box(by_joints(black_box(of_joints)));
                },
            ],
        );
        println!(
            "  error {goal:e}: by hand {:.3} ms, generated {:.3} ms: {:.2} ({evaluations:?}, tolerances {of_floor:.1e}, {of_joints:.1e})",
            1e3 * hand,
            1e3 * joints,
            joints / hand
        );
    }
}

fn main() {
    compare("four-bar", FourBar::crank_rocker(), FourBar::start(), &four_bar::FourBar::<f64>::default());
    compare(
        "slider-crank",
        SliderCrank::in_line(),
        SliderCrank::start(),
        &slider_crank::SliderCrank::<f64>::default(),
    );
}
