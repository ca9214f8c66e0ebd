//! Events of motions whose crossings are known.

use super::{Crossing, Direction, Events};
use crate::contract::Storage;
use crate::integrate::Method;
use crate::{ByDuals, Control, Dop853, Dual, Error, Ode, Rodas4, Scalar, Solver, Tsit5, Uncorrected};
use core::marker::PhantomData;
use core::ops::ControlFlow;

const PI: f64 = core::f64::consts::PI;

type Numbers<T> = PhantomData<T>;
const REAL: Numbers<f64> = PhantomData;

/// Numbers that look random, between 0 and 1.
struct Random(u64);

impl Random {
    #[expect(clippy::cast_precision_loss, reason = "53 bits are exact")]
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (self.0 ^ (self.0 >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        (mixed >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
}

/// The crossings of a motion at the tolerance, as many as fit.
fn crossings<D, A, M, S, const N: usize>(
    (dynamics, method, start): (D, A, S),
    model: &M,
    (control, t_end): (Control, f64),
    directions: [Direction; N],
    mut functions: impl FnMut(f64, &S) -> [f64; N],
) -> ([Crossing<f64>; 32], usize)
where
    S: Storage<f64>,
    D: Ode<M, Scalar = f64, State = S>,
    A: Method<D, M>,
{
    let mut solver = Solver::new(dynamics, method, 0.0, &start).with_control(control);
    let mut events = Events::new(directions, &start);
    let (mut found, mut n) = ([Crossing { event: 0, t: 0.0, rises: false }; 32], 0);
    while solver.time() < t_end {
        solver.step_towards(model, t_end).unwrap();
        let list = |crossing, _: &S| {
            found[n] = crossing;
            n += 1;
            ControlFlow::Continue(())
        };
        let flow = events.within_last_step(&mut solver, model, |_, t, y| functions(t, y), list);
        assert_eq!(flow, Ok(ControlFlow::Continue(())));
    }
    (found, n)
}

/// `y' = d/dt Π (t − r)`: a polynomial of the degree at which DOP853 and its interpolant are exact.
struct Planted {
    roots: [f64; 4],
}

impl Planted {
    fn value(&self, t: f64) -> f64 {
        self.roots.iter().map(|r| t - r).product()
    }

    fn slope(&self, t: f64) -> f64 {
        let without = |k: usize| (0..4).filter(|i| *i != k).map(|i| t - self.roots[i]).product::<f64>();
        (0..4).map(without).sum()
    }
}

impl Ode for Planted {
    type Scalar = f64;
    type State = [f64; 1];

    fn derivative(&self, _: &(), t: f64, _: &[f64; 1], dy: &mut [f64; 1]) {
        *dy = [self.slope(t)];
    }
}

/// All crossings in one step of length one.
fn in_one_step(planted: Planted) -> ([f64; 8], usize) {
    let start = [planted.value(0.0)];
    let mut solver = Solver::new(planted, Dop853::new(&start), 0.0, &start);
    solver.step(&(), 1.0).unwrap();
    let mut events = Events::new([Direction::Both], &start);
    let (mut found, mut n) = ([0.0; 8], 0);
    let list = |crossing: Crossing<f64>, _: &[f64; 1]| {
        (found[n], n) = (crossing.t, n + 1);
        ControlFlow::Continue(())
    };
    let flow = events.within_last_step(&mut solver, &(), |_, _, y| *y, list);
    assert_eq!(flow, Ok(ControlFlow::Continue(())));
    (found, n)
}

/// By how much rounding may move a root: interpolation adds terms of some ten times the slopes, which are of order one.
fn bound(slope: f64) -> f64 {
    5e-15 * (1.0 + 1.0 / slope)
}

#[test]
fn planted_roots_are_found_to_rounding_and_in_order() {
    let mut random = Random(24);
    let mut checked = 0;
    for case in 0..2000 {
        let mut roots = [0.0; 4].map(|_| random.between(0.01, 0.99));
        roots.sort_by(f64::total_cmp);
        // What is promised: pairs farther apart than a part of the step, others only alone in theirs.
        let gaps: [f64; 3] = core::array::from_fn(|k| roots[k + 1] - roots[k]);
        if gaps.iter().any(|gap| *gap < 0.13) {
            continue;
        }
        checked += 1;
        let (found, n) = in_one_step(Planted { roots });
        assert_eq!(n, 4, "case {case}: {roots:?}, {found:?}");
        for (root, found) in roots.iter().zip(found) {
            let slope = (Planted { roots }).slope(*root).abs();
            let bound = bound(slope);
            assert!((found - root).abs() <= bound, "case {case}: {found} for {root}, bound {bound:e}");
        }
    }
    assert!(checked > 200, "{checked}");
}

#[test]
fn short_excursions_are_found_down_to_rounding() {
    let mut random = Random(5);
    for case in 0..400 {
        let width = libm::pow(10.0, random.between(-7.0, -1.0));
        let first = random.between(0.01, 0.8);
        let roots = [first, first + width, 1.4, -0.7];
        let (found, n) = in_one_step(Planted { roots });
        assert_eq!(n, 2, "case {case}: {first} and {width:e} on, {found:?}");
        for (root, found) in roots.iter().zip(&found[..2]) {
            let bound = bound(Planted { roots }.slope(*root).abs());
            assert!((found - root).abs() <= bound, "case {case}: {found} for {root}, bound {bound:e}");
        }
    }
}

#[test]
fn what_does_not_reach_zero_is_no_event() {
    let mut random = Random(7);
    for _ in 0..200 {
        let (centre, height) = (random.next(), libm::pow(10.0, random.between(-12.0, 0.0)));
        let start = [centre * centre + height, 0.0];
        let parabola = |t: f64| (t - centre) * (t - centre) + height;
        let mut solver = Solver::new(Planted { roots: [0.0; 4] }, Tsit5::new(&[0.0]), 0.0, &[0.0]);
        solver.step(&(), 1.0).unwrap();
        let mut events = Events::new([Direction::Both], &[start[1]]);
        let flow =
            events.within_last_step(&mut solver, &(), |_, t, _| [parabola(t)], |_, _| ControlFlow::Break(()));
        assert_eq!(flow, Ok(ControlFlow::Continue(())), "{centre} {height:e}");
    }
}

/// A pendulum: θ̈ = −sin θ, in numbers of any type.
#[derive(Clone, Copy, Debug)]
struct Pendulum;

impl<T: Scalar> Ode<Numbers<T>> for Pendulum {
    type Scalar = T;
    type State = [T; 2];

    fn derivative(&self, _: &Numbers<T>, _: T, y: &[T; 2], dy: &mut [T; 2]) {
        *dy = [y[1], -y[0].sin()];
    }
}

/// A quarter of the period from an amplitude: K(sin(θ/2)) by the arithmetic-geometric mean.
fn quarter(amplitude: f64) -> f64 {
    let (mut a, mut b) = (1.0, libm::cos(0.5 * amplitude));
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), libm::sqrt(a * b));
    }
    0.5 * PI / a
}

#[test]
fn a_pendulum_passes_its_lowest_point_at_the_times_of_the_elliptic_integral() {
    for amplitude in [0.1, 1.0, 2.5, 3.1] {
        let (t_end, start) = (20.0 * quarter(amplitude), [amplitude, 0.0]);
        let control = Control::default().with_tolerance(1e-14);
        let motion = (Pendulum, Dop853::new(&start), start);
        let both = [Direction::Both, Direction::Falling];
        let (found, n) = crossings(motion, &REAL, (control, t_end - 0.1), both, |_, y| [y[0], y[0]]);
        // Ten passages, of which five fall and come twice.
        assert_eq!(n, 15, "{amplitude}");
        let passages = (1_u32..).step_by(2).map(|k| f64::from(k) * quarter(amplitude));
        let mut passages =
            passages.flat_map(|t| [t; 2]).enumerate().filter(|(k, _)| k % 4 != 3).map(|(_, t)| t);
        for crossing in &found[..n] {
            let t = passages.next().unwrap();
            // Errors of rate and phase grow along the motion near the upper equilibrium.
            let bound = if amplitude > 3.0 { 1e-10 } else { 1e-12 };
            assert!((crossing.t / t - 1.0).abs() < bound, "{amplitude}: {crossing:?} for {t}");
        }
    }
}

#[test]
fn every_method_finds_events_as_well_as_its_states_are() {
    let (start, t_end) = ([1.0, 0.0], 6.0);
    let first = quarter(1.0);
    for tolerance in [1e-5, 1e-8, 1e-11] {
        let setting = (Control::default().with_tolerance(tolerance), t_end);
        let both = [Direction::Both];
        let by_duals = ByDuals::<_, Numbers<Dual<f64, 3>>, _, [f64; 4], 3>::new(
            Pendulum,
            PhantomData,
            [Dual::new(0.0); 2],
        );
        let rodas = (by_duals, Rodas4::new(&start, [0.0; 4]), start);
        let found = [
            crossings((Pendulum, Tsit5::new(&start), start), &REAL, setting, both, |_, y| [y[0]]),
            crossings((Pendulum, Dop853::new(&start), start), &REAL, setting, both, |_, y| [y[0]]),
            crossings(rodas, &REAL, setting, both, |_, y| [y[0]]),
        ];
        for (method, (found, n)) in found.iter().enumerate() {
            assert_eq!(*n, 2, "{method} at {tolerance:e}");
            for (crossing, expected) in found.iter().zip([first, 3.0 * first]) {
                let error = (crossing.t - expected).abs();
                assert!(error < 20.0 * tolerance, "method {method}, {tolerance:e}: {error:e}");
            }
        }
    }
}

#[test]
fn several_at_once_come_in_order_and_a_break_ends_them() {
    let start = [1.0, 0.0];
    let mut solver = Solver::<_, _, _, _, Uncorrected>::new(Pendulum, Dop853::new(&start), 0.0, &start);
    solver.step(&REAL, 2.0).unwrap();
    let mut events = Events::new([Direction::Both; 4], &start);
    let functions =
        |_: &Numbers<f64>, t: f64, _: &[f64; 2]| [t - 1.5, 0.5 - t, 2.0 * t - 3.0, (t - 0.5) * 7.0];
    let (mut order, mut n) = ([9; 8], 0);
    let mut take = |limit: usize| {
        n = 0;
        let flow = events.within_last_step(&mut solver, &REAL, functions, |crossing, _| {
            (order[n], n) = (crossing.event, n + 1);
            if n == limit { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        (flow.unwrap(), order, n)
    };
    let (flow, order, n) = take(99);
    assert_eq!((flow, &order[..n]), (ControlFlow::Continue(()), &[1, 3, 0, 2][..]));
    let (flow, order, n) = take(3);
    assert_eq!((flow, &order[..n]), (ControlFlow::Break(()), &[1, 3, 0][..]));
}

#[test]
fn a_start_at_zero_and_an_end_at_zero_are_counted_once() {
    // t (t − 1): zero at both ends of the step; then t goes on.
    let start = [0.0, 0.0];
    let mut solver = Solver::new(Pendulum, Tsit5::new(&start), 0.0, &start);
    let mut events = Events::new([Direction::Both], &start);
    let mut count = 0;
    for _ in 0..3 {
        solver.step(&REAL, 1.0).unwrap();
        let rises = |crossing: Crossing<f64>, _: &[f64; 2]| {
            assert!(crossing.rises && crossing.t == 1.0, "{crossing:?}");
            count += 1;
            ControlFlow::Continue(())
        };
        assert!(events.within_last_step(&mut solver, &REAL, |_, t, _| [t * (t - 1.0)], rises).is_ok());
    }
    assert_eq!(count, 1);
}

#[test]
fn a_function_that_is_not_finite_is_an_error_with_its_time() {
    let start = [1.0, 0.0];
    let mut solver = Solver::new(Pendulum, Tsit5::new(&start), 0.0, &start);
    solver.step(&REAL, 1.0).unwrap();
    let mut events = Events::new([Direction::Both; 2], &start);
    let functions = |_: &Numbers<f64>, t: f64, _: &[f64; 2]| [t, if t > 0.3 { f64::NAN } else { t }];
    let found = events.within_last_step(&mut solver, &REAL, functions, |_, _| ControlFlow::Continue(()));
    assert_eq!(found, Err(Error::NotFinite { t: 0.375, index: 3 }));
}
