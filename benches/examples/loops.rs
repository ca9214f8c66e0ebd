//! Loops in joint coordinates beside floors derived by hand: what an evaluation takes, a correction (in maximal
//! coordinates, too), and DOP853 for given errors; one process, in turns, medians. And operations of trees with a gear
//! or a driver.
#![allow(clippy::print_stdout, reason = "that is what it is for")]

use gyro_codegen::{Functions, Group, Kernel};
use gyro_mechanisms::{four_bar, slider_crank};
use gyro_reference::scene;
use gyro_sim::pivoting::{self, Pivots};
use gyro_sim::{
    CloseLoops, ClosedForm, Control, Corrected, CorrectedDynamics, Correction, Dop853, Error, Joint,
    JointSpace, Kinematics, Kutta4, Ode, Partition, Partitioning, Solver,
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
    M: JointSpace<Scalar = f64>,
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

/// Corrections in maximal coordinates, of a drift of 1e-9, beside a step: by the partition, through joint coordinates
/// in one go, and by pivoting of `NC` constraints and `NQ` coordinates.
fn correct_maximal<M, const NC: usize, const NQ: usize>(name: &str, mechanism: &M)
where
    M: Partition<Scalar = f64> + CorrectedDynamics + JointSpace + Kinematics,
{
    let start = mechanism.start();
    let (mut by_partition, mut at_once, mut pivoted) = (start.clone(), start.clone(), start.clone());
    let mut partitioning = Partitioning::new(mechanism, 0.0, &start);
    let mut closed_form = ClosedForm::new(mechanism);
    let mut choice: Pivots<NC, NQ> = pivoting::independent(mechanism, 0.0, &start);
    let mut rk4 = Solver::new(Corrected, Kutta4::new(&start), 0.0, &start);
    let [partition, closing, pivots, step] = medians(
        CALLS / 20,
        &mut [
            &mut || {
                by_partition.as_mut()[1] += 1e-9;
                let _ = partitioning.correct(mechanism, 0.0, black_box(&mut by_partition));
            },
            &mut || {
                at_once.as_mut()[1] += 1e-9;
                let _ = closed_form.correct(mechanism, 0.0, black_box(&mut at_once));
            },
            &mut || {
                pivoted.as_mut()[1] += 1e-9;
                let y = black_box(&mut pivoted);
                pivoting::follow(mechanism, 0.0, y, &mut choice);
                let _ = pivoting::newton_step(mechanism, 0.0, &choice, y);
                let _ = pivoting::solve_velocities(mechanism, 0.0, &choice, y);
            },
            &mut || {
                let _ = rk4.step(mechanism, 1e-9);
            },
        ],
    );
    println!(
        "{name}, maximal: a step of RK4 {:.2} us; partition {:.2}, closed form {:.2}, pivoting {:.2} of it",
        1e6 * step,
        partition / step,
        closing / step,
        pivots / step
    );
}

/// A chain of skewed links, with what is added to it.
fn chain(links: usize, added: &str) -> String {
    let head =
        "format = 1\nname = \"chain\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"b0\"\nfixed = true\n";
    let link = |k: usize| {
        format!(
            "[[body]]\nname = \"b{k}\"\nmass = 1.{k}\ninertia = [0.02, 0.03, 0.04]\n[[joint]]\nname = \"j{k}\"\n\
             kind = \"revolute\"\nfirst = {{ body = \"b{}\", point = [0.02, -0.01, -0.1], axis = [1, 2, 2], \
             zero = [2, 1, -2] }}\nsecond = {{ body = \"b{k}\", point = [-0.01, 0.02, 0.1], axis = [2, -1, 2], \
             zero = [2, 2, -1] }}\n",
            k - 1
        )
    };
    (1..=links).fold(head.to_owned(), |text, k| text + &link(k)) + added
}

fn operations(text: &str) -> usize {
    let model = gyro_model::read("chain.toml", text).expect("a good model file");
    let functions = Functions::of([Group::Joint]);
    let module = gyro_codegen::generate_functions("chain.toml", &model, &functions).expect("a module");
    let function = module.data_sheet.function(Kernel::JointAccelerations).expect("it is asked for");
    function.operations.total()
}

/// Operations of joint accelerations of trees with a gear or a driver over those of the same trees without.
fn count_gears() {
    for links in [2, 3, 4, 6, 8, 10, 12, 14] {
        let alone = operations(&chain(links, ""));
        let gear = |from: usize| {
            format!(
                "[[coupler]]\nname = \"gear\"\nfirst = {{ joint = \"j{from}\" }}\nsecond = {{ joint = \
                 \"j{links}\" }}\nratio = -1.5\n"
            )
        };
        let driver = format!(
            "[[driver]]\nname = \"motor\"\njoint = \"j{links}\"\nmotion = {{ polynomial = [0, 1] }}\n"
        );
        let [near, far, driven] = [gear(links - 1), gear(1), driver].map(|added| {
            let operations = operations(&chain(links, &added));
            format!("{operations} ({:.2})", operations as f64 / alone as f64)
        });
        println!(
            "chain of {links}: {alone} operations; last joint geared to the one before {near}, to the first {far}, \
             driven {driven}"
        );
    }
}

fn main() {
    let (linkage, crank) = (four_bar::FourBar::<f64>::default(), slider_crank::SliderCrank::<f64>::default());
    compare("four-bar", FourBar::crank_rocker(), FourBar::start(), &linkage);
    compare("slider-crank", SliderCrank::in_line(), SliderCrank::start(), &crank);
    correct_maximal::<_, 20, 21>("four-bar", &linkage);
    correct_maximal::<_, 20, 21>("slider-crank", &crank);
    count_gears();
}
