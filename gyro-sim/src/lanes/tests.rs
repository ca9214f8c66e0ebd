//! Lanes against their scalars, bit for bit.

extern crate std;

use super::{Adaptive, Lanes, Outcome, f32x8, f64x2, f64x4, f64x8};
use crate::integrate::{Embedded, Method};
use crate::{Control, Dop853, Error, Ode, Scalar, Solver, Tsit5};
use std::vec;
use std::vec::Vec;

/// Steps of a walk through all exponents, chosen odd so that mantissas are irregular.
const WALK: u64 = 0x0000_7fff_1234_567b;

/// Holds a function of a pack against that of its scalar at these arguments.
fn check<T: Lanes<Lane: PartialEq>>(
    arguments: impl Iterator<Item = f64>,
    (pack, scalar): (impl Fn(T) -> T, impl Fn(T::Lane) -> T::Lane),
) {
    let mut lanes = [T::Lane::constant(0.0); 8];
    for (count, x) in arguments.enumerate() {
        lanes[count % T::COUNT] = T::Lane::constant(x);
        if count % T::COUNT == T::COUNT - 1 {
            let found = pack(T::from_lanes(|lane| lanes[lane]));
            for (lane, &x) in lanes[..T::COUNT].iter().enumerate() {
                same(found.lane(lane), scalar(x), x);
            }
        }
    }
}

/// The same bits; any NaN is like any other.
fn same<T: crate::Real>(found: T, expected: T, x: T) {
    let (a, b) = (found.to_f64(), expected.to_f64());
    assert!(a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()), "at {x:?}: {a:e} {b:e}");
}

/// Numbers of every size and sign, the neighbours of multiples of π/4, and what is special.
fn arguments() -> impl Iterator<Item = f64> {
    let everywhere = (0..200_000u64).map(|k| f64::from_bits(k.wrapping_mul(WALK)));
    let usual = (0..200_000).map(|k| (f64::from(k) - 1e5) * 1.234_567e-3);
    let multiples = (-40..40).flat_map(|n| {
        let middle = f64::from(n) * core::f64::consts::FRAC_PI_4;
        (-300..300).map(move |k| middle * (1.0 + f64::from(k * k * k) * 1e-13))
    });
    let close = (-40..40).flat_map(|n| {
        let middle = (f64::from(n) * core::f64::consts::FRAC_PI_4).to_bits();
        (0..9).map(move |k| f64::from_bits(middle.wrapping_add(k).wrapping_sub(4)))
    });
    let edges = [2f64.powi(20), 2f64.powi(28)].map(|n| n * core::f64::consts::FRAC_PI_2);
    let edges = edges.into_iter().flat_map(|x| (-50..50).map(move |k| x * (1.0 + f64::from(k) * 1e-7)));
    let special =
        [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MIN_POSITIVE, -5e-324, f64::MAX];
    everywhere.chain(usual).chain(multiples).chain(close).chain(edges).chain(special)
}

#[test]
fn sines_and_cosines_are_those_of_libm() {
    check::<f64x8>(arguments(), (Scalar::sin, libm::sin));
    check::<f64x8>(arguments(), (Scalar::cos, libm::cos));
    check::<f64x4>(arguments(), (Scalar::sin, libm::sin));
    check::<f64x4>(arguments(), (Scalar::cos, libm::cos));
    check::<f64x2>(arguments(), (Scalar::sin, libm::sin));
    check::<f64x2>(arguments(), (Scalar::cos, libm::cos));
}

#[test]
fn sines_and_cosines_in_single_precision_are_those_of_one_number() {
    check::<f32x8>(arguments(), (Scalar::sin, Scalar::sin));
    check::<f32x8>(arguments(), (Scalar::cos, Scalar::cos));
}

#[test]
fn other_functions_are_those_of_libm() {
    check::<f64x8>(arguments(), (Scalar::sqrt, libm::sqrt));
    check::<f64x8>(arguments(), (Scalar::tanh, libm::tanh));
    check::<f32x8>(arguments(), (Scalar::sqrt, libm::sqrtf));
    check::<f64x4>(arguments(), (|y| Scalar::atan2(y, f64x4::splat(-0.3)), |y| libm::atan2(y, -0.3)));
    check::<f64x8>(arguments(), (Scalar::exp, libm::exp));
    check::<f64x2>(arguments(), (Scalar::ln, libm::log));
    check::<f64x4>(arguments(), (Scalar::abs, libm::fabs));
    check::<f64x4>(arguments(), (Scalar::floor, libm::floor));
    check::<f32x8>(arguments(), (Scalar::exp, libm::expf));
    check::<f32x8>(arguments(), (Scalar::ln, libm::logf));
    check::<f32x8>(arguments(), (Scalar::abs, libm::fabsf));
    check::<f32x8>(arguments(), (Scalar::floor, libm::floorf));
    let table = ([0.0, 1.0, 2.0], [[0.0, 1.5, 0.0, -0.5], [1.0, 0.0, -1.5, 0.5]]);
    let value = |[value, slope, bend]: [f64x8; 3]| value + slope + bend;
    let scalar = |[value, slope, bend]: [f64; 3]| value + slope + bend;
    check(
        arguments(),
        (|t: f64x8| value(t.spline(&table.0, &table.1)), |t: f64| scalar(t.spline(&table.0, &table.1))),
    );
}

/// Conditions of every kind by lane, with whatever is chosen by them.
fn check_choices<T: Lanes<Lane: PartialEq>>() {
    for chosen in [0.3, -0.0, f64::INFINITY, f64::NAN] {
        let (lane, pack) = (T::Lane::constant(chosen), T::constant(chosen));
        check::<T>(arguments(), (|c| c.when(pack), |c| c.when(lane)));
        check::<T>(arguments(), (|c| c.unless(pack), |c| c.unless(lane)));
    }
}

#[test]
fn choices_are_those_of_one_number() {
    check_choices::<f64x2>();
    check_choices::<f64x4>();
    check_choices::<f64x8>();
    check_choices::<f32x8>();
}

#[test]
fn what_is_not_chosen_has_no_effect() {
    let [chosen, infinite, none] = [0.3, f64::INFINITY, f64::NAN];
    for (condition, is_positive) in
        [(1.0, true), (f64::INFINITY, true), (0.0, false), (-0.0, false), (-5e-324, false)]
    {
        let both: [fn(f64, f64) -> f64; 2] = [Scalar::when, Scalar::unless];
        let [taken, other] = if is_positive { both } else { [both[1], both[0]] };
        for x in [chosen, infinite, none] {
            same(taken(condition, x), x, condition);
            assert_eq!(other(condition, x).to_bits(), 0, "{condition}: {x}");
        }
        assert!(taken(none, chosen).is_nan() && other(none, chosen).is_nan());
    }
}

#[test]
fn masks_are_bits() {
    for bits in 0..256 {
        let mask = f64x8::mask(bits);
        assert_eq!(f64x8::bits(mask), bits);
        let chosen = Lanes::select(mask, f64x8::splat(1.0), f64x8::splat(2.0));
        assert!((0..8).all(|lane| (chosen.lane(lane) == 1.0) == (bits >> lane & 1 == 1)));
    }
}

/// `y₀' = −λ (y₀ − cos t)`, `y₁' = y₀ y₁`, which is stiff for large λ and knows the time.
struct Follower<T>(T);

#[derive(Clone, Copy)]
struct Equations;

impl<T: Scalar> Ode<Follower<T>> for Equations {
    type Scalar = T;
    type State = [T; 2];
    fn derivative(&self, follower: &Follower<T>, t: T, y: &[T; 2], dy: &mut [T; 2]) {
        *dy = [-follower.0 * (y[0] - t.cos()), y[0] * y[1]];
    }
}

/// What a motion comes to: its states at these times, up to its error.
type Motion = (Vec<[f64; 2]>, Option<Error>);

fn alone<A: Method<Equations, Follower<f64>>>(
    method: A,
    (rate, control): (f64, Control),
    times: &[f64],
) -> Motion {
    let follower = Follower(rate);
    let mut solver = Solver::new(Equations, method, 0.0, &[0.0, 1.0]).with_control(control);
    let (mut states, mut state) = (Vec::new(), [0.0; 2]);
    let mut run = || {
        for t in times {
            while solver.time() < *t {
                solver.step_towards(&follower, times[times.len() - 1])?;
            }
            solver.interpolate(&follower, *t, &mut state)?;
            states.push(state);
        }
        Ok(())
    };
    let error = run().err();
    (states, error)
}

/// The motions one after the other in whatever lane is free.
fn in_lanes<A, B>(method: A, motions: &[(f64, Control)], times: &[f64]) -> Vec<Motion>
where
    A: Embedded<Equations, Follower<f64x4>>,
    B: Embedded<Equations, Follower<f64>>,
{
    let mut packs =
        Adaptive::<_, _, f64x4, A, _, [f64; 2], B>::new(Equations, method, &[f64x4::splat(0.0); 2]);
    let mut found: Vec<Motion> = vec![(Vec::new(), None); motions.len()];
    let mut running = [None; 4];
    let (mut next, mut ended) = (0, 0);
    while ended < motions.len() {
        for (lane, running) in running.iter_mut().enumerate() {
            if running.is_none() && next < motions.len() {
                packs.begin(lane, Equations, &[0.0, 1.0], motions[next].1);
                *running = Some(next);
                next += 1;
            }
        }
        let rate = |lane: usize| running[lane].map_or(1.0, |motion: usize| motions[motion].0);
        let all = Follower(f64x4::from_lanes(rate));
        let systems: [_; 4] = core::array::from_fn(|lane| Follower(rate(lane)));
        let mut outcomes = [None; 4];
        packs.attempt(
            |lane| &systems[lane],
            &all,
            times[times.len() - 1],
            |lane, outcome| {
                outcomes[lane] = Some(outcome);
            },
        );
        loop {
            let due: [_; 4] = core::array::from_fn(|lane| {
                let t = *times.get(found[running[lane]?].0.len())?;
                (outcomes[lane] == Some(Outcome::Kept) && packs.time(lane)? >= t).then_some(t)
            });
            if due == [None; 4] {
                break;
            }
            let mut out = [f64x4::splat(0.0); 2];
            packs.interpolate(&all, |lane| due[lane], &mut out);
            for lane in (0..4).filter(|lane| due[*lane].is_some()) {
                found[running[lane].unwrap()].0.push(out.map(|x| x.lane(lane)));
            }
        }
        for (lane, running) in running.iter_mut().enumerate() {
            let Some(motion) = *running else { continue };
            if let Some(Outcome::Failed(error)) = outcomes[lane] {
                found[motion].1 = Some(error);
            } else if found[motion].0.len() < times.len() {
                continue;
            }
            packs.end(lane);
            *running = None;
            ended += 1;
        }
    }
    found
}

/// Gentle, stiff and hopeless motions, of many tolerances and budgets.
#[test]
fn steps_of_each_lane_are_those_of_its_motion_alone() {
    let times: Vec<f64> = (1..40).map(|k| 0.01 * f64::from(k * k)).collect();
    let motion = |k: i32| {
        let rate = 10f64.powf(f64::from(k * 37 % 100) * 0.06 - 1.0);
        let control = Control::default().with_tolerance(10f64.powi(-3 - k % 9));
        (rate, Control { budget: 30 * (1 + u64::from(k.unsigned_abs() % 31)), ..control })
    };
    let motions: Vec<_> = (0..100).map(motion).collect();
    let tsit5 = in_lanes::<_, Tsit5<[f64; 2]>>(Tsit5::new(&[f64x4::splat(0.0); 2]), &motions, &times);
    let dop853 = in_lanes::<_, Dop853<[f64; 2], f64>>(Dop853::new(&[f64x4::splat(0.0); 2]), &motions, &times);
    let [mut ended, mut stiff, mut lengthy] = [0; 3];
    for (k, motion) in motions.iter().enumerate() {
        assert_eq!(tsit5[k], alone(Tsit5::new(&[0.0; 2]), *motion, &times), "{k}, {motion:?}");
        assert_eq!(dop853[k], alone(Dop853::new(&[0.0; 2]), *motion, &times), "{k}, {motion:?}");
        for (_, error) in [&tsit5[k], &dop853[k]] {
            ended += i32::from(error.is_none());
            stiff += i32::from(matches!(error, Some(Error::Stiff { .. })));
            lengthy += i32::from(matches!(error, Some(Error::TooManySteps { .. })));
        }
    }
    assert!(ended > 20 && stiff > 20 && lengthy > 5, "{ended} {stiff} {lengthy}");
}
