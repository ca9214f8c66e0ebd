//! Methods and solver on systems whose motion is known.

use crate::contract::Storage;
use crate::integrate::Method;
use crate::{
    ByDuals, Control, Direct, Dop853, Dual, Error, Jacobian, Kutta4, Ode, Rodas4, Scalar, Solver, Tsit5,
    Uncorrected,
};
use core::marker::PhantomData;

/// A pendulum-like motion with a known solution and every kind of term: `y = (sin θ, cos θ)` with θ = t + t²/4, in
/// numbers of any type.
#[derive(Clone, Copy, Debug)]
struct Chirp;

type Numbers<T> = PhantomData<T>;
const REAL: Numbers<f64> = PhantomData;

impl<T: Scalar> Ode<Numbers<T>> for Chirp {
    type Scalar = T;
    type State = [T; 2];

    fn derivative(&self, _: &Numbers<T>, t: T, y: &[T; 2], dy: &mut [T; 2]) {
        let rate = T::constant(1.0) + T::constant(0.5) * t;
        // What vanishes on the solution bends the field around it.
        let bend = T::constant(1.0) - (y[0] * y[0] + y[1] * y[1]);
        *dy = [rate * y[1] + bend * y[0], bend * y[1] - rate * y[0]];
    }
}

type ChirpByDuals = ByDuals<Chirp, Numbers<Dual<f64, 3>>, [Dual<f64, 3>; 2], [f64; 4], 3>;

fn by_duals() -> ChirpByDuals {
    ByDuals::new(Chirp, PhantomData, [Dual::new(0.0); 2])
}

fn exact(t: f64) -> [f64; 2] {
    let angle = t + 0.25 * t * t;
    [libm::sin(angle), libm::cos(angle)]
}

fn distance(y: &[f64; 2], t: f64) -> f64 {
    let exact = exact(t);
    (y[0] - exact[0]).abs().max((y[1] - exact[1]).abs())
}

const START: [f64; 2] = [0.0, 1.0];

/// Errors at the end of two units of time, and in the middle of steps by interpolation, at some number of equal steps.
fn errors<D, A>(dynamics: D, method: A, n: u32) -> [f64; 2]
where
    D: Ode<Numbers<f64>, Scalar = f64, State = [f64; 2]>,
    A: Method<D, Numbers<f64>>,
{
    let mut solver = Solver::new(dynamics, method, 0.0, &START);
    let h = 2.0 / f64::from(n);
    let mut within: f64 = 0.0;
    for _ in 0..n {
        let before = solver.time();
        solver.step(&REAL, h).unwrap();
        for theta in [0.1, 0.3, 0.5, 0.7, 0.9] {
            let (t, mut y) = (before + theta * h, [0.0; 2]);
            solver.interpolate(&REAL, t, &mut y).unwrap();
            within = within.max(distance(&y, t));
        }
    }
    [distance(solver.state(), 2.0), within]
}

fn assert_orders<D, A>(dynamics: D, method: A, steps: [u32; 2], expected: [f64; 2])
where
    D: Ode<Numbers<f64>, Scalar = f64, State = [f64; 2]> + Clone,
    A: Method<D, Numbers<f64>> + Clone,
{
    let [coarse, fine] = steps.map(|n| errors(dynamics.clone(), method.clone(), n));
    let ratio = libm::log(f64::from(steps[1]) / f64::from(steps[0]));
    let found: [f64; 2] = core::array::from_fn(|k| libm::log(coarse[k] / fine[k]) / ratio);
    assert_eq!(f64::from(A::ORDER), expected[0]);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 0.35, "orders {found:?} for {expected:?}");
    }
}

#[test]
fn methods_and_their_interpolants_have_the_orders_they_claim() {
    assert_orders(Chirp, Kutta4::new(&START), [40, 80], [4.0, 4.0]);
    assert_orders(Chirp, Tsit5::new(&START), [100, 200], [5.0, 5.0]);
    assert_orders(Chirp, Dop853::new(&START), [6, 12], [8.0, 8.0]);
    assert_orders(by_duals(), Rodas4::new(&START, [0.0; 4]), [40, 80], [4.0, 4.0]);
}

/// Largest error over the run, with its number of accepted steps.
fn adaptive<D, A>(dynamics: D, method: A, tolerance: f64) -> (f64, u64)
where
    D: Ode<Numbers<f64>, Scalar = f64, State = [f64; 2]>,
    A: Method<D, Numbers<f64>>,
{
    let control = Control::default().with_tolerance(tolerance);
    let mut solver = Solver::new(dynamics, method, 0.0, &START).with_control(control);
    let mut worst: f64 = 0.0;
    while solver.time() < 5.0 {
        solver.step_towards(&REAL, 5.0).unwrap();
        worst = worst.max(distance(solver.state(), solver.time()));
    }
    assert_eq!(solver.time(), 5.0);
    (worst, solver.statistics().accepted)
}

#[test]
fn errors_follow_the_tolerance() {
    for tolerance in [1e-4, 1e-7, 1e-10] {
        for (name, (error, steps)) in [
            ("tsit5", adaptive(Chirp, Tsit5::new(&START), tolerance)),
            ("dop853", adaptive(Chirp, Dop853::new(&START), tolerance)),
            ("rodas4", adaptive(by_duals(), Rodas4::new(&START, [0.0; 4]), tolerance)),
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

    fn derivative(&self, _: &(), t: f64, y: &[f64; 1], dy: &mut [f64; 1]) {
        *dy = [self.0 * (y[0] - libm::cos(t)) - libm::sin(t)];
    }
}

impl Jacobian for Stiff {
    type Matrix = [f64; 1];

    fn jacobian(&self, _: &(), t: f64, _: &[f64; 1], dfdy: &mut [f64; 1], dfdt: &mut [f64; 1]) {
        (*dfdy, *dfdt) = ([self.0], [self.0 * libm::sin(t) - libm::cos(t)]);
    }
}

type Run<D, S, A> = (Solver<D, S, f64, A, Uncorrected>, Result<(), Error>);

fn run<D, M, S, A>((dynamics, model): (D, M), start: S, method: A, control: Control) -> Run<D, S, A>
where
    D: Ode<M, Scalar = f64, State = S>,
    S: Storage<f64>,
    A: Method<D, M>,
{
    let mut solver = Solver::new(dynamics, method, 0.0, &start).with_control(control);
    let outcome = solver.advance_to(&model, 2.0);
    (solver, outcome)
}

#[test]
fn a_stiff_scene_is_no_matter_for_rodas_and_named_as_such_by_explicit_methods() {
    let (system, control) = (Stiff(-1e6), Control::default().with_tolerance(1e-6));
    let (solver, outcome) = run((system, ()), [1.5], Rodas4::new(&[0.0], [0.0]), control);
    assert_eq!(outcome, Ok(()));
    assert!((solver.state()[0] - libm::cos(2.0)).abs() < 1e-5);
    assert!(solver.statistics().accepted < 100, "{:?}", solver.statistics());

    let control = Control { budget: 20_000, ..control };
    for (solver, outcome) in [
        {
            let (solver, outcome) = run((system, ()), [1.5], Tsit5::new(&[0.0]), control);
            (*solver.statistics(), outcome)
        },
        {
            let (solver, outcome) = run((system, ()), [1.5], Dop853::new(&[0.0]), control);
            (*solver.statistics(), outcome)
        },
    ] {
        let Err(Error::Stiff { t, rate, .. }) = outcome else { panic!("{outcome:?} {solver:?}") };
        assert!(t < 0.1 && (rate / 1e6 - 1.0).abs() < 0.1, "{t} {rate}");
        assert!(solver.accepted < 1000, "it stops instead of crawling: {solver:?}");
    }
    // With steps enough it is an answer, and the steps were limited by stability.
    let (solver, outcome) =
        run((Stiff(-1e4), ()), [1.5], Dop853::new(&[0.0]), Control::default().with_tolerance(1e-6));
    assert_eq!(outcome, Ok(()));
    let statistics = solver.statistics();
    assert!(2 * statistics.limited_by_stability > statistics.accepted, "{statistics:?}");
}

#[test]
fn what_cannot_be_done_is_an_error_that_says_why() {
    let control = Control::default();
    let outcome = |control| run((Chirp, REAL), START, Dop853::new(&[0.0; 2]), control).1;
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
    let mut solver = Solver::new(Chirp, Dop853::new(&START), 0.0, &START);
    assert!(matches!(solver.advance_to(&REAL, f64::NAN), Err(Error::InvalidEndTime { .. })));
}

/// ẏ = y², infinite at t = 1.
#[derive(Clone, Copy, Debug)]
struct BlowUp;

impl Ode for BlowUp {
    type Scalar = f64;
    type State = [f64; 1];

    fn derivative(&self, _: &(), _: f64, y: &[f64; 1], dy: &mut [f64; 1]) {
        *dy = [y[0] * y[0]];
    }
}

#[test]
fn a_motion_that_ends_is_not_followed_beyond_its_end() {
    let (solver, outcome) = run((BlowUp, ()), [1.0], Tsit5::new(&[0.0]), Control::default());
    assert!(outcome.is_err());
    assert!(solver.time() < 1.0 + 1e-6, "{} {outcome:?}", solver.time());
    let mut solver = Solver::new(BlowUp, Tsit5::new(&[f64::NAN]), 0.0, &[f64::NAN]);
    assert!(matches!(solver.step(&(), 0.1), Err(Error::NotFinite { .. })));
    assert!(matches!(solver.step_towards(&(), 0.1), Err(Error::NotFinite { .. })));
}

#[test]
fn an_error_leaves_the_motion_where_it_was() {
    let mut solver = Solver::new(BlowUp, Kutta4::new(&[1e200]), 0.5, &[1e200]);
    assert!(solver.step(&(), 1.0).is_err());
    assert_eq!((solver.time(), solver.state()), (0.5, &[1e200]));
}

#[test]
fn only_the_last_step_can_be_looked_into() {
    let mut solver = Solver::new(BlowUp, Tsit5::new(&[0.0]), 0.0, &[1.0]);
    let (mut out, is_outside) = ([0.0], |outcome| matches!(outcome, Err(Error::InvalidEndTime { .. })));
    assert!(is_outside(solver.interpolate(&(), -0.1, &mut out)), "nothing has been stepped yet");
    solver.step(&(), 0.1).unwrap();
    solver.step(&(), 0.1).unwrap();
    assert!(is_outside(solver.interpolate(&(), 0.05, &mut out)), "the step before the last");
    solver.interpolate(&(), 0.15, &mut out).unwrap();
    assert!((out[0] - 1.0 / 0.85).abs() < 1e-6, "{out:?}");
    // The attempt leaves its own slopes behind.
    assert!(solver.step(&(), 1e300).is_err());
    assert!(is_outside(solver.interpolate(&(), 0.15, &mut out)), "{out:?}");
}

/// The natural spline through (0, 0), (1, 1), (3, 0).
const TABLE: [[f64; 4]; 2] = [[0.0, 1.25, 0.0, -0.25], [1.0, 0.5, -0.75, 0.125]];

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
        (x.exp().slopes[0], libm::exp(0.7)),
        (x.ln().slopes[0], 1.0 / 0.7),
        (x.abs().slopes[0], 1.0),
        ((-x).abs().slopes[0], 1.0),
        (Dual { value: 0.0, slopes: [1.0] }.abs().slopes[0], 0.0),
        (x.floor().slopes[0], 0.0),
        (c.when(x).slopes[0], 1.0),
        (x.unless(x).slopes[0], 0.0),
        // The root of zero changes infinitely fast, and that of a negative number is none.
        ((c.when(x) + c.unless((x - x).sqrt())).slopes[0], 1.0),
        (((-c).when((-x).sqrt()) + (-c).unless(x * x)).slopes[0], 1.4),
        (sum(&[x - c, x]).slopes[0], 2.0),
        // The derivative of a table's second derivative, before a knot and at it.
        (x.spline(&[0.0, 1.0, 3.0], &TABLE)[2].slopes[0], -1.5),
        (Dual { value: 1.0, slopes: [2.0] }.spline(&[0.0, 1.0, 3.0], &TABLE)[2].slopes[0], 1.5),
    ] {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}

#[test]
fn what_is_not_finite_is_an_error_at_once() {
    for t in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut solver = Solver::new(Chirp, Dop853::new(&[1.0, 0.0]), t, &[1.0, 0.0]);
        assert!(matches!(solver.advance_to(&REAL, 1.0), Err(Error::InvalidEndTime { .. })), "{t}");
        assert!(matches!(solver.step(&REAL, 0.1), Err(Error::InvalidEndTime { .. })), "{t}");
        assert!(matches!(solver.correct(&REAL), Err(Error::InvalidEndTime { .. })), "{t}");
        assert_eq!(solver.statistics().work.evaluations, 0, "{t}");
        let mut solver = Solver::new(Chirp, Dop853::new(&[1.0, 0.0]), 0.0, &[1.0, 0.0]);
        assert!(matches!(solver.step(&REAL, t), Err(Error::Setting { setting: "step", .. })), "{t}");
        assert!(matches!(solver.advance_to(&REAL, t), Err(Error::InvalidEndTime { .. })), "{t}");
        solver.set_state(&[1.0, t]);
        assert!(matches!(solver.advance_to(&REAL, 1.0), Err(Error::NotFinite { index: 1, .. })), "{t}");
        let mut direct = Direct::new(Chirp, &[1.0, 0.0]);
        assert!(
            matches!(direct.advance(&REAL, t, 0.1, 3, &mut [1.0, 0.0]), Err(Error::InvalidEndTime { .. })),
            "{t}"
        );
        assert!(
            matches!(direct.advance(&REAL, 0.0, t, 3, &mut [1.0, 0.0]), Err(Error::InvalidEndTime { .. })),
            "{t}"
        );
    }
}

/// ẏ = u − y, with the input u as the model.
struct Lag;

impl Ode<f64> for Lag {
    type Scalar = f64;
    type State = [f64; 1];

    fn derivative(&self, input: &f64, _: f64, y: &[f64; 1], dy: &mut [f64; 1]) {
        dy[0] = input - y[0];
    }
}

#[test]
fn inputs_that_jump_are_no_fast_rates() {
    fn rate<A: Method<Lag, f64>>(method: A) -> f64 {
        let mut solver = Solver::new(Lag, method, 0.0, &[0.0]);
        let mut input = 1.0;
        for k in 1_u32..=1000 {
            solver.advance_to(&input, f64::from(k) * 0.05).unwrap();
            input = -input;
            // Now and then nothing changes, so that there are estimates.
            if k % 7 != 0 {
                solver.system_has_changed();
            } else {
                input = -input;
            }
        }
        assert_eq!(solver.statistics().limited_by_stability, 0);
        solver.statistics().fastest_rate
    }
    let rates = [rate(Tsit5::new(&[0.0])), rate(Dop853::new(&[0.0]))];
    // Differences of a hundred roundings have an error of some per cent.
    assert!(rates.iter().all(|rate| (rate - 1.0).abs() < 0.1), "{rates:?}");
}
