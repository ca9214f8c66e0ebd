//! The partition on a four-bar linkage.

extern crate std;

use super::four_bar::{FourBar, NC, NQ, State};
use super::*;
use crate::{Dynamics, JointCoordinate, Partition, Partitioned, Turns};
use core::f64::consts::PI;
use std::vec::Vec;

/// A crank that turns round and round, and a rocker.
fn crank_rocker() -> FourBar {
    FourBar::new(1.0, [0.3, 0.9, 0.7], 9.81)
}

/// All bars are in line at the crank angles 0 and π, where the crossed way of assembly branches off.
fn parallelogram() -> FourBar {
    FourBar::new(1.0, [0.5, 1.0, 0.5], 0.0)
}

fn crank_angles() -> impl Iterator<Item = f64> {
    (0..100).map(|k| 0.1 + 0.0628 * f64::from(k))
}

fn worst(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |worst, value| value.abs().max(worst))
}

/// Rounding of a few operations on numbers of order one.
const ROUNDING: f64 = 1e-14;

#[test]
fn no_dependent_coordinate_changes_much_faster_than_the_independent_one() {
    let bar = crank_rocker();
    let mut choice = bar.independent(0.0, &bar.state(0.1, 1.0, 0.0));
    let mut exchanges = 0;
    for crank in crank_angles() {
        let y = bar.state(crank, 1.0, 1.0);
        exchanges += bar.follow(0.0, &y, &mut choice);
        assert_eq!(bar.follow(0.0, &y, &mut choice), 0, "a choice just made is kept");
        let q_dot = scaled_rates(&bar, &y);
        let [independent] = choice.independent() else { panic!("one degree of freedom") };
        let independent = q_dot[usize::from(*independent)].abs();
        let fastest = worst(&q_dot);
        assert!(fastest <= POOR * independent * (1.0 + ROUNDING), "{crank}: {fastest} and {independent}");
    }
    assert!((2..10).contains(&exchanges), "{exchanges}");
}

/// q̇ with lengths in units of the size, by differences of planted poses; p up to sign.
fn scaled_rates(bar: &FourBar, y: &State) -> [f64; NQ] {
    let mut dy = *y;
    bar.derivative(0.0, y, &mut dy);
    core::array::from_fn(|column| if column % 7 < 3 { dy[column] / bar.size() } else { dy[column] })
}

#[test]
fn a_choice_that_cannot_be_solved_for_is_replaced() {
    let bar = crank_rocker();
    let y = bar.state(1.0, 1.0, 0.0);
    // e1 of the crank is zero whatever the motion.
    let mut columns: [u16; NQ] = core::array::from_fn(|c| c as u16);
    columns.swap(4, NQ - 1);
    let mut choice = Pivots::<NC, NQ>::new(Fixed, columns);
    assert_eq!(choice.independent(), [4]);
    let refused = bar.newton_step(0.5, &choice, &mut y.clone());
    assert!(matches!(refused, Err(Error::Singular { t: 0.5, owner: Some(_), .. })), "{refused:?}");
    assert_eq!(bar.follow(0.0, &y, &mut choice), 1);
    assert_eq!(choice, bar.independent(0.0, &y));
}

#[test]
fn newton_finds_the_planted_pose_back() {
    let bar = crank_rocker();
    for crank in crank_angles() {
        let planted = bar.state(crank, -1.0, 0.0);
        let choice = bar.independent(0.0, &planted);
        let mut y = planted;
        for &column in choice.dependent() {
            y[usize::from(column)] += 1e-3 * libm::sin(crank * f64::from(column));
        }
        (0..4).for_each(|_| bar.newton_step(0.0, &choice, &mut y).unwrap());
        let independent = usize::from(choice.independent()[0]);
        assert_eq!(y[independent], planted[independent], "an independent coordinate keeps its value");
        let error = y.iter().zip(&planted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 1e2 * ROUNDING, "{crank}: {error:e}");
    }
}

#[test]
fn velocities_are_the_planted_ones_of_the_independent_rate() {
    let bar = crank_rocker();
    for crank in crank_angles() {
        let planted = bar.state(crank, 1.0, 2.0);
        let choice = bar.independent(0.0, &planted);
        let mut y = planted;
        for (k, value) in y[NQ..].iter_mut().enumerate() {
            *value += 0.3 * libm::sin(crank + k as f64);
        }
        let before = rate(&y, choice.independent()[0]);
        bar.solve_velocities(0.0, &choice, &mut y).unwrap();
        assert!(
            (rate(&y, choice.independent()[0]) - before).abs() < ROUNDING,
            "the independent rate is kept"
        );
        // Velocities are linear in any of them.
        let factor = before / rate(&planted, choice.independent()[0]);
        let error =
            y[NQ..].iter().zip(&planted[NQ..]).map(|(a, b)| (a - factor * b).abs()).fold(0.0, f64::max);
        assert!(error < 1e2 * ROUNDING, "{crank}: {error:e}");
    }
}

fn rate(y: &State, column: u16) -> f64 {
    let bar = crank_rocker();
    let mut dy = *y;
    bar.derivative(0.0, y, &mut dy);
    dy[usize::from(column)]
}

#[test]
fn a_crank_goes_round_on_its_branch_and_keeps_its_energy() {
    let bar = crank_rocker();
    let mut y = bar.state(1.0, 1.0, 8.0);
    let start = bar.energy(0.0, &y).total();
    let mut solver = Partitioned::new(&bar, &y);
    for interval in 0..1000 {
        solver.advance(&bar, f64::from(interval) * 2.5e-3, 5e-4, 5, &mut y).unwrap();
        assert!(is_on(&bar, 1.0, &y) < 1e3 * ROUNDING, "{interval}: {:e}", is_on(&bar, 1.0, &y));
    }
    let drift = (bar.energy(0.0, &y).total() - start).abs();
    assert!(drift < 1e-8, "{drift:e}");
    assert!(solver.switches() > 10, "{}", solver.switches());
}

/// How far the rods' directions are from a way of assembly at the crank's own angle.
fn is_on(bar: &FourBar, side: f64, y: &State) -> f64 {
    let [cos, sin] = FourBar::direction(y, 0);
    let expected = bar.directions(libm::atan2(sin, cos), side);
    let found: [[f64; 2]; 3] = core::array::from_fn(|body| FourBar::direction(y, body));
    let differences = found.as_flattened().iter().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn the_clearance_is_smooth_and_vanishes_in_line() {
    const TURN: f64 = 1e-3;
    let clear =
        |bar: &FourBar, crank: f64| clearance::<_, NC, NQ>(bar, 0.0, &bar.state(crank, 1.0, 0.0)).pivot;
    let bar = crank_rocker();
    for crank in crank_angles() {
        let near = [-1.0, 0.0, 1.0].map(|k| clear(&bar, crank + k * TURN));
        let bend = near[0] - 2.0 * near[1] + near[2];
        // Where an elimination takes another pivot, its smallest one changes by as much as the step at once.
        assert!(bend.abs() < 0.1 * TURN, "{crank}: {near:?}");
    }
    let bar = parallelogram();
    let [near, far] = [1e-4, 2e-4].map(|crank| clear(&bar, crank));
    assert!((far / near - 2.0).abs() < 1e-3, "{near} {far}");
}

/// Runs a parallelogram over its two poses in line; whether it has come through. The coupler must never have turned.
fn passes(bar: &FourBar, crank: f64, rate: f64, (step, n_steps): (f64, u32)) -> Result<(), Error> {
    let mut y = bar.state(crank, 1.0, rate);
    // The planted rates are 0/0 in line.
    let [[c1, s1], ..] = bar.directions(crank, 1.0);
    y[27..33].copy_from_slice(&[-0.5 * rate * s1, 0.5 * rate * c1, 0.0, 0.0, 0.0, 0.0]);
    y[33..39].copy_from_slice(&[-0.25 * rate * s1, 0.25 * rate * c1, 0.0, 0.0, 0.0, rate]);
    let mut solver = Partitioned::new(bar, &y);
    let interval = step * f64::from(n_steps);
    for k in 0..(7.0 / (rate * interval)) as u32 {
        solver.advance(bar, f64::from(k) * interval, step, n_steps, &mut y)?;
        let [cos, sin] = FourBar::direction(&y, 1);
        assert!(
            sin.abs() < 1e-3 && cos > 0.99,
            "crank {crank}, step {step}: the coupler has turned by {sin}"
        );
    }
    Ok(())
}

#[test]
fn a_parallelogram_comes_through_its_singular_poses_or_says_why_not() {
    let bar = parallelogram();
    let mut through = 0;
    for step in [1e-2, 2e-2, 5e-2, 0.1] {
        for k in 0..25 {
            let outcome = passes(&bar, 0.5 + 0.02 * f64::from(k), 1.0, (step, 1 + k % 3));
            through += u32::from(outcome.is_ok());
            assert!(
                matches!(outcome, Ok(()) | Err(Error::Jump { .. } | Error::Singular { .. })),
                "{outcome:?}"
            );
        }
    }
    assert!(through > 90, "only {through} of 100 runs have come through");
}

#[test]
fn in_line_the_error_names_a_joint() {
    let bar = parallelogram();
    let y = bar.state(0.0, 1.0, 0.0);
    let choice = bar.independent(0.0, &y);
    for outcome in
        [bar.newton_step(0.25, &choice, &mut y.clone()), bar.solve_velocities(0.25, &choice, &mut y.clone())]
    {
        let Err(Error::Singular { t, pivot, owner }) = outcome else { panic!("{outcome:?}") };
        assert!(t == 0.25 && pivot < 1e-15 && matches!(owner, Some(Owner::Joint(_))), "{outcome:?}");
    }
}

/// Moves the coordinates in the plane by up to `size`, differently for each seed, with p of unit length.
fn shake(y: &mut State, size: f64, seed: f64) {
    for body in y[..NQ].as_chunks_mut::<7>().0 {
        for k in [0, 1, 3, 6] {
            body[k] += size * libm::sin(17.3 * seed + 9.1 * body[0] + (seed + 1.3) * k as f64);
        }
        let norm = libm::sqrt(body[3..].iter().map(|e| e * e).sum());
        body[3..].iter_mut().for_each(|e| *e /= norm);
    }
}

#[test]
fn no_drift_leads_to_the_other_branch() {
    let bar = parallelogram();
    let (mut corrected, mut refused) = (0, 0);
    for crank in [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.03, 0.1, 0.3, 1.0] {
        for exponent in 1..10 {
            for seed in 0..40 {
                let mut y = bar.state(crank, 1.0, 1.0);
                shake(&mut y, libm::pow(10.0, -f64::from(exponent)), f64::from(seed));
                match Partitioned::new(&bar, &y).correct(&bar, 0.0, &mut y) {
                    Ok(()) => {
                        corrected += 1;
                        let (right, wrong) = (is_on(&bar, 1.0, &y), is_on(&bar, -1.0, &y));
                        assert!(right < wrong, "{crank}, 1e-{exponent}, {seed}: {right:e} {wrong:e}");
                    }
                    Err(error) => {
                        refused += 1;
                        assert!(matches!(error, Error::Jump { .. }), "{error}");
                    }
                }
            }
        }
    }
    // Drift that is small beside the distance of the branches is corrected, and only that.
    assert!(corrected > 1500 && refused > 1000, "{corrected} corrected, {refused} refused");
}

#[test]
fn turns_show_every_coordinate_of_every_joint() {
    let bar = crank_rocker();
    let state = |k: i32| bar.state(0.5 * f64::from(k), 1.0, 1.0);
    let turns = |nearest: &[f64]| Turns::new(&bar, 0.0, &state(0), nearest);
    let mut read = turns(&[6.0 * PI, f64::NAN, -4.0 * PI]);
    for k in 1..=60 {
        read.update(&bar, 0.5 * f64::from(k), 0.5, &state(k));
    }
    let Some(JointCoordinate::Angle { position, rate }) = read.coordinate(&bar, 0, 0) else {
        panic!("{read:?}")
    };
    assert!((position - (6.0 * PI + 30.0)).abs() < 1e2 * ROUNDING && rate == 1.0, "{position}, {rate}");
    let y = state(60);
    let length = JointCoordinate::Length { position: y[7], rate: y[27] };
    assert_eq!(read.coordinate(&bar, 1, 0), Some(length), "a length is what it is");
    // The coupler swings about one direction, so against the crank it turns backwards with the crank's turns.
    let Some(JointCoordinate::Angle { position, .. }) = read.coordinate(&bar, 1, 1) else {
        panic!("{read:?}")
    };
    assert!((position + 4.0 * PI + 30.0).abs() < PI / 2.0, "{position}");
    for (joint, index) in [(0, 1), (1, 2), (2, 0), (4, 0)] {
        assert_eq!(read.coordinate(&bar, joint, index), None, "{joint}, {index}");
    }
    let zero = turns(&[]).coordinate(&bar, 0, 0);
    assert!(matches!(zero, Some(JointCoordinate::Angle { position: 0.0, .. })), "{zero:?}");
}

#[test]
fn no_number_panics() {
    let bar = crank_rocker();
    for hard in [f64::NAN, f64::INFINITY, 1e300, -1e200, 0.0, 1e-300] {
        for place in 0..39 {
            let mut y = bar.state(1.0, 1.0, 1.0);
            y[place] = hard;
            let mut choice = bar.independent(0.0, &y);
            bar.follow(0.0, &y, &mut choice);
            let mut sorted: Vec<u16> =
                choice.dependent().iter().chain(choice.independent()).copied().collect();
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq(0..21), "{choice:?}");
            let outcome = Partitioned::new(&bar, &y).correct(&bar, 0.0, &mut y);
            assert!(hard.is_finite() || outcome.is_err(), "{place}: {hard}");
        }
    }
}
