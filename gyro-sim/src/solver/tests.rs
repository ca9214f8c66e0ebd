//! Methods and solver on systems whose motion is known.

use crate::integrate::{Embedded, Method};
use crate::{
    ByDuals, Control, Differentiable, Direct, Dop853, Dual, Error, Kutta4, Ode, Rodas4, Scalar, Solver,
    Storage, Tsit5, Uncorrected,
};
use core::marker::PhantomData;

/// A pendulum-like motion with a known solution and every kind of term: `y = (sin θ, cos θ)` with θ = t + t²/4.
#[derive(Clone, Copy, Debug)]
struct Chirp<T>(PhantomData<T>);

impl<T: Scalar> Ode for Chirp<T> {
    type Scalar = T;
    type State = [T; 2];

    fn start(&self) -> [T; 2] {
        [T::constant(0.0), T::constant(1.0)]
    }
    fn derivative(&self, t: T, y: &[T; 2], dy: &mut [T; 2]) {
        let rate = T::constant(1.0) + T::constant(0.5) * t;
        // What vanishes on the solution bends the field around it.
        let bend = T::constant(1.0) - (y[0] * y[0] + y[1] * y[1]);
        *dy = [rate * y[1] + bend * y[0], bend * y[1] - rate * y[0]];
    }
}

impl Differentiable for Chirp<f64> {
    type Jacobian = [f64; 4];

    fn jacobian_buffer(&self) -> [f64; 4] {
        [0.0; 4]
    }
    fn jacobian(&self, t: f64, y: &[f64; 2], dfdy: &mut [f64; 4], dfdt: &mut [f64; 2]) {
        let duals = Chirp::<Dual<f64, 3>>(PhantomData);
        ByDuals::new(*self, duals, &[0.0; 4]).jacobian(t, y, dfdy, dfdt);
    }
}

fn exact(t: f64) -> [f64; 2] {
    let angle = t + 0.25 * t * t;
    [libm::sin(angle), libm::cos(angle)]
}

fn distance(y: &[f64; 2], t: f64) -> f64 {
    let exact = exact(t);
    (y[0] - exact[0]).abs().max((y[1] - exact[1]).abs())
}

const CHIRP: Chirp<f64> = Chirp(PhantomData);

/// Errors at the end of two units of time, and in the middle of steps by interpolation, at some number of equal steps.
fn errors<M: Method<Chirp<f64>>>(method: M, n: u32) -> [f64; 2] {
    let mut solver = Solver::new(method, Uncorrected, 0.0, &CHIRP.start());
    let h = 2.0 / f64::from(n);
    let mut within: f64 = 0.0;
    for _ in 0..n {
        let before = solver.time();
        solver.step(&CHIRP, h).unwrap();
        for theta in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let (t, mut y) = (before + theta * h, [0.0; 2]);
            solver.interpolate(&CHIRP, t, &mut y).unwrap();
            within = within.max(distance(&y, t));
        }
    }
    [distance(solver.state(), 2.0), within]
}

/// Order of convergence between two numbers of steps.
fn orders<M: Method<Chirp<f64>>>(method: impl Fn() -> M, steps: [u32; 2]) -> [f64; 2] {
    let [coarse, fine] = steps.map(|n| errors(method(), n));
    let ratio = libm::log(f64::from(steps[1]) / f64::from(steps[0]));
    core::array::from_fn(|k| libm::log(coarse[k] / fine[k]) / ratio)
}

fn assert_orders<M: Method<Chirp<f64>>>(method: impl Fn() -> M, steps: [u32; 2], expected: [f64; 2]) {
    let found = orders(method, steps);
    assert_eq!(f64::from(M::ORDER), expected[0]);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 0.35, "orders {found:?} for {expected:?}");
    }
}

#[test]
fn methods_and_their_interpolants_have_the_orders_they_claim() {
    let y = CHIRP.start();
    assert_orders(|| Kutta4::new(&y), [40, 80], [4.0, 4.0]);
    assert_orders(|| Tsit5::new(&y), [100, 200], [5.0, 5.0]);
    assert_orders(|| Dop853::new(&y), [6, 12], [8.0, 8.0]);
    assert_orders(|| Rodas4::new(&CHIRP, &y), [40, 80], [4.0, 4.0]);
}

/// Largest error over the run, with its number of accepted steps.
fn adaptive<M: Embedded<Chirp<f64>>>(method: M, tolerance: f64) -> (f64, u64) {
    let control = Control::default().with_tolerance(tolerance);
    let mut solver = Solver::new(method, Uncorrected, 0.0, &CHIRP.start()).with_control(control);
    let mut worst: f64 = 0.0;
    while solver.time() < 5.0 {
        solver.step_towards(&CHIRP, 5.0).unwrap();
        worst = worst.max(distance(solver.state(), solver.time()));
    }
    assert_eq!(solver.time(), 5.0);
    (worst, solver.statistics().accepted)
}

#[test]
fn errors_follow_the_tolerance() {
    let y = CHIRP.start();
    for tolerance in [1e-4, 1e-7, 1e-10] {
        for (name, (error, steps)) in [
            ("tsit5", adaptive(Tsit5::new(&y), tolerance)),
            ("dop853", adaptive(Dop853::new(&y), tolerance)),
            ("rodas4", adaptive(Rodas4::new(&CHIRP, &y), tolerance)),
        ] {
            assert!(error < 30.0 * tolerance, "{name}: {error:e} at {tolerance:e} in {steps} steps");
            assert!(
                error > 1e-4 * tolerance,
                "{name} tries too hard: {error:e} at {tolerance:e} in {steps} steps"
            );
        }
    }
}

/// Prothero and Robinson's problem: `ẏ = λ (y − cos t) − sin t`.
#[derive(Clone, Copy, Debug)]
struct Stiff(f64);

impl Ode for Stiff {
    type Scalar = f64;
    type State = [f64; 1];

    fn start(&self) -> [f64; 1] {
        [1.5]
    }
    fn derivative(&self, t: f64, y: &[f64; 1], dy: &mut [f64; 1]) {
        *dy = [self.0 * (y[0] - libm::cos(t)) - libm::sin(t)];
    }
}

impl Differentiable for Stiff {
    type Jacobian = [f64; 1];

    fn jacobian_buffer(&self) -> [f64; 1] {
        [0.0]
    }
    fn jacobian(&self, t: f64, _: &[f64; 1], dfdy: &mut [f64; 1], dfdt: &mut [f64; 1]) {
        (*dfdy, *dfdt) = ([self.0], [self.0 * libm::sin(t) - libm::cos(t)]);
    }
}

type Run<S, M> = (Solver<S, f64, M, Uncorrected>, Result<(), Error>);

fn run<O: Ode<Scalar = f64>, M: Embedded<O>>(system: &O, method: M, control: Control) -> Run<O::State, M> {
    let mut solver = Solver::new(method, Uncorrected, 0.0, &system.start()).with_control(control);
    let outcome = solver.advance_to(system, 2.0);
    (solver, outcome)
}

#[test]
fn a_stiff_scene_is_no_matter_for_rodas_and_named_as_such_by_explicit_methods() {
    let (system, control) = (Stiff(-1e6), Control::default().with_tolerance(1e-6));
    let (solver, outcome) = run(&system, Rodas4::new(&system, &[0.0]), control);
    assert_eq!(outcome, Ok(()));
    assert!((solver.state()[0] - libm::cos(2.0)).abs() < 1e-5);
    assert!(solver.statistics().accepted < 100, "{:?}", solver.statistics());

    let control = Control { budget: 20_000, ..control };
    for (solver, outcome) in [
        {
            let (solver, outcome) = run(&system, Tsit5::new(&[0.0]), control);
            (*solver.statistics(), outcome)
        },
        {
            let (solver, outcome) = run(&system, Dop853::new(&[0.0]), control);
            (*solver.statistics(), outcome)
        },
    ] {
        let Err(Error::Stiff { t, rate, .. }) = outcome else { panic!("{outcome:?} {solver:?}") };
        assert!(t < 0.1 && (rate / 1e6 - 1.0).abs() < 0.1, "{t} {rate}");
        assert!(solver.accepted < 1000, "it stops instead of crawling: {solver:?}");
    }
    // With steps enough it is an answer, and the steps were limited by stability.
    let (solver, outcome) = run(&Stiff(-1e4), Dop853::new(&[0.0]), Control::default().with_tolerance(1e-6));
    assert_eq!(outcome, Ok(()));
    let statistics = solver.statistics();
    assert!(2 * statistics.limited_by_stability > statistics.accepted, "{statistics:?}");
}

#[test]
fn what_cannot_be_done_is_an_error_that_says_why() {
    let control = Control::default();
    let outcome = |control| run(&CHIRP, Dop853::new(&[0.0; 2]), control).1;
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-17] {
        let outcome = outcome(control.with_tolerance(tolerance));
        assert!(matches!(outcome, Err(Error::Tolerance { .. })), "{tolerance}: {outcome:?}");
    }
    assert!(matches!(outcome(Control { budget: 3, ..control }), Err(Error::TooManySteps { steps: 3, .. })));
    let wide = Control { smallest_step: 1.0, first_step: 1.5, ..control };
    assert!(matches!(outcome(wide), Err(Error::StepTooShort { .. })), "{:?}", outcome(wide));
    assert_eq!(outcome(control.with_tolerance(1.0)), Ok(()));
    for (first_step, smallest_step, largest_step) in
        [(f64::NAN, 0.0, 1.0), (-0.1, 0.0, 1.0), (0.0, f64::NAN, 1.0), (0.0, 0.0, 0.0), (0.0, 0.0, f64::NAN)]
    {
        let outcome = outcome(Control { first_step, smallest_step, largest_step, ..control });
        assert!(matches!(outcome, Err(Error::Setting { .. })), "{outcome:?}");
    }
    let mut solver = Solver::new(Dop853::new(&[0.0; 2]), Uncorrected, 0.0, &CHIRP.start());
    assert!(matches!(solver.advance_to(&CHIRP, f64::NAN), Err(Error::NoEnd { .. })));
}

/// ẏ = y², infinite at t = 1.
#[derive(Clone, Copy, Debug)]
struct BlowUp;

impl Ode for BlowUp {
    type Scalar = f64;
    type State = [f64; 1];

    fn start(&self) -> [f64; 1] {
        [1.0]
    }
    fn derivative(&self, _: f64, y: &[f64; 1], dy: &mut [f64; 1]) {
        *dy = [y[0] * y[0]];
    }
}

#[test]
fn a_motion_that_ends_is_not_followed_beyond_its_end() {
    let (solver, outcome) = run(&BlowUp, Tsit5::new(&[0.0]), Control::default());
    assert!(outcome.is_err());
    assert!(solver.time() < 1.0 + 1e-6, "{} {outcome:?}", solver.time());
    let mut solver = Solver::new(Tsit5::new(&[f64::NAN]), Uncorrected, 0.0, &[f64::NAN]);
    assert!(matches!(solver.step(&BlowUp, 0.1), Err(Error::NotFinite { .. })));
    assert!(matches!(solver.step_towards(&BlowUp, 0.1), Err(Error::NotFinite { .. })));
}

#[test]
fn an_error_leaves_the_motion_where_it_was() {
    let mut solver = Solver::new(Kutta4::new(&[1e200]), Uncorrected, 0.5, &[1e200]);
    assert!(solver.step(&BlowUp, 1.0).is_err());
    assert_eq!((solver.time(), solver.state()), (0.5, &[1e200]));
}

#[test]
fn only_the_last_step_can_be_looked_into() {
    let mut solver = Solver::new(Tsit5::new(&[0.0]), Uncorrected, 0.0, &BlowUp.start());
    let (mut out, no_way) = ([0.0], |outcome| matches!(outcome, Err(Error::NoEnd { .. })));
    assert!(no_way(solver.interpolate(&BlowUp, -0.1, &mut out)), "nothing has been stepped yet");
    solver.step(&BlowUp, 0.1).unwrap();
    solver.step(&BlowUp, 0.1).unwrap();
    assert!(no_way(solver.interpolate(&BlowUp, 0.05, &mut out)), "the step before the last");
    solver.interpolate(&BlowUp, 0.15, &mut out).unwrap();
    assert!((out[0] - 1.0 / 0.85).abs() < 1e-6, "{out:?}");
    // The attempt leaves its own slopes behind.
    assert!(solver.step(&BlowUp, 1e300).is_err());
    assert!(no_way(solver.interpolate(&BlowUp, 0.15, &mut out)), "{out:?}");
}

#[test]
fn dual_numbers_and_symbols_agree() {
    fn sum<T: Scalar>(y: &impl Storage<T>) -> T {
        y.as_ref().iter().fold(T::constant(0.0), |sum, y| sum + *y)
    }
    let x = Dual { value: 0.7, slopes: [1.0] };
    let c = Dual::new(2.0);
    for (found, expected) in [
        ((x * c / (x + c)).slopes[0], 4.0 / (2.7 * 2.7)),
        (x.sqrt().slopes[0], 0.5 / libm::sqrt(0.7)),
        ((-x.cos()).slopes[0], libm::sin(0.7)),
        (x.sin().slopes[0], libm::cos(0.7)),
        (x.tanh().slopes[0], 1.0 - libm::tanh(0.7) * libm::tanh(0.7)),
        (x.atan2(c).slopes[0], 2.0 / (4.0 + 0.49)),
        (c.atan2(x).slopes[0], -2.0 / (4.0 + 0.49)),
        (sum(&[x - c, x]).slopes[0], 2.0),
    ] {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}

#[test]
fn what_is_not_finite_is_an_error_at_once() {
    let system = Chirp::<f64>(PhantomData);
    for t in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut solver = Solver::new(Dop853::new(&[1.0, 0.0]), Uncorrected, t, &[1.0, 0.0]);
        assert!(matches!(solver.advance_to(&system, 1.0), Err(Error::NoEnd { .. })), "{t}");
        assert!(matches!(solver.step(&system, 0.1), Err(Error::NoEnd { .. })), "{t}");
        assert!(matches!(solver.correct(&system), Err(Error::NoEnd { .. })), "{t}");
        assert_eq!(solver.statistics().work.evaluations, 0, "{t}");
        let mut solver = Solver::new(Dop853::new(&[1.0, 0.0]), Uncorrected, 0.0, &[1.0, 0.0]);
        assert!(matches!(solver.step(&system, t), Err(Error::Setting { setting: "step", .. })), "{t}");
        assert!(matches!(solver.advance_to(&system, t), Err(Error::NoEnd { .. })), "{t}");
        solver.set_state(&[1.0, t]);
        assert!(matches!(solver.advance_to(&system, 1.0), Err(Error::NotFinite { index: 1, .. })), "{t}");
        let mut direct = Direct::new(&[1.0, 0.0]);
        assert!(
            matches!(direct.advance(&system, t, 0.1, 3, &mut [1.0, 0.0]), Err(Error::NoEnd { .. })),
            "{t}"
        );
        assert!(
            matches!(direct.advance(&system, 0.0, t, 3, &mut [1.0, 0.0]), Err(Error::NoEnd { .. })),
            "{t}"
        );
    }
}
