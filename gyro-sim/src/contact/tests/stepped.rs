//! Steps of fixed length: what is decided at their ends.

use super::{Cart, Random, fine, random_cart};
use crate::contact::resolve::{Hit, impulses};
use crate::contact::{Contact, Forced, Hybrid, Phase, Stepped};
use crate::{Dop853, Kutta4, Ode, Real};
use core::cell::Cell;
use core::ops::Range;

const GRAVITY: f64 = 9.81;

/// A mass that falls.
#[derive(Clone, Copy)]
struct Falling;

impl Ode for Falling {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        self.forced(model, t, y, &[0.0], dy);
    }
}

impl Forced for Falling {
    fn rates(&self, _: &()) -> Range<usize> {
        1..2
    }

    fn forced(&self, _: &(), _: f64, y: &[f64; 2], forces: &[f64], dy: &mut [f64; 2]) {
        *dy = [y[1], forces[0] - GRAVITY];
    }
}

#[test]
fn a_bouncing_mass_comes_to_rest_within_some_steps_of_its_time() {
    let mut random = Random(31);
    for case in 0..100 {
        let (e, floor) = (random.between(0.0, 0.9), random.between(-3.0, 3.0));
        let h = random.between(1e-4, 1e-3);
        let floor_at = Contact::new(0, 1).with_stops([floor, f64::INFINITY], e).unwrap();
        let start = [floor + 1.0, 0.0];
        let zeno = libm::sqrt(2.0 / GRAVITY) * (1.0 + e) / (1.0 - e);
        let mut y = start;
        let mut motion = Stepped::new(Falling, [floor_at], &y);
        let mut fixed = Hybrid::new(Falling, [floor_at], Kutta4::new(&start), 0.0, &start);
        let mut steps = 0;
        while motion.phases() != &[Phase::AtLower] {
            motion.advance(&(), f64::from(steps) * h, h, 1, &mut y).unwrap();
            fixed.step(&(), h).unwrap();
            steps += 1;
            assert!(f64::from(steps) * h < zeno + 1.0, "case {case}: {e} {h}: {y:?}");
        }
        // A place that is off by a flight of a step moves each impact by as much.
        let off = (f64::from(steps) * h - zeno).abs();
        assert!(off < 60.0 * h / (1.0 - e), "case {case}: {e} {h}: off by {off:e}");
        for _ in 0..100 {
            motion.advance(&(), 0.0, h, 1, &mut y).unwrap();
            fixed.step(&(), h).unwrap();
        }
        assert_eq!((y, *fixed.state()), ([floor, 0.0], [floor, 0.0]), "case {case}");
        assert_eq!(motion.forces(&(), 0.0, &y), [GRAVITY]);
    }
}

fn contacts(random: &mut Random) -> [Contact<f64>; 2] {
    [0, 1].map(|k| {
        let kinetic = random.between(0.1, 1.5);
        let contact = Contact::new(k, k + 2).with_friction(kinetic, kinetic * random.between(1.0, 1.5));
        contact.unwrap().with_stops([-0.5, 0.5], 0.3).unwrap()
    })
}

fn after(cart: Cart, contacts: [Contact<f64>; 2], start: [f64; 4], n: u32) -> [f64; 4] {
    let (mut y, h) = (start, 2.0 / f64::from(n));
    Stepped::new(cart, contacts, &y).advance(&(), 0.0, h, n, &mut y).unwrap();
    y
}

/// Each event comes up to a step late, and so the errors of many motions are halved together with the step.
#[test]
fn errors_are_of_order_one_in_the_step() {
    let mut random = Random(37);
    let mut errors = [0.0; 3];
    for _ in 0..60 {
        let (cart, start) = random_cart(&mut random);
        let contacts = contacts(&mut random);
        let mut exact = Hybrid::new(cart, contacts, Dop853::new(&start), 0.0, &start).with_control(fine());
        exact.advance_to(&(), 2.0).unwrap();
        for (error, n) in errors.iter_mut().zip([2000, 4000, 8000]) {
            let y = after(cart, contacts, start, n);
            *error += (0..2).map(|k| (y[k] - exact.state()[k]).abs()).sum::<f64>();
        }
    }
    let [coarse, middle, fine] = errors;
    let ratios = [coarse / middle, middle / fine];
    assert!(coarse > 1e-3 && ratios.iter().all(|ratio| (1.6..2.5).contains(ratio)), "{errors:?} {ratios:?}");
}

#[test]
fn the_bare_steps_are_those_of_the_solver() {
    let mut random = Random(41);
    let mut impacts = 0;
    for case in 0..40 {
        let (cart, start) = random_cart(&mut random);
        let contacts = contacts(&mut random);
        let mut fixed = Hybrid::new(cart, contacts, Kutta4::new(&start), 0.0, &start);
        let mut y = start;
        let mut motion = Stepped::new(cart, contacts, &y);
        for step in 0..2000 {
            let t = f64::from(step) * 1e-3;
            motion.advance(&(), t, 1e-3, 1, &mut y).unwrap();
            fixed.step(&(), 1e-3).unwrap();
            assert_eq!(motion.phases(), fixed.phases(), "case {case} at {t}");
            for (a, b) in y.iter().zip(fixed.state()) {
                assert!((a - b).abs() < 1e-9, "case {case} at {t}: {y:?} {:?}", fixed.state());
            }
        }
        assert_eq!(motion.record().impacts, fixed.record().impacts, "case {case}");
        impacts += motion.record().impacts;
    }
    assert!(impacts > 50, "{impacts}");
}

/// Two masses of one kilogram, side by side or one pushing the other, in any precision.
#[derive(Clone, Copy)]
struct Pair<T>([T; 2]);

impl<T: Real> Ode for Pair<T> {
    type Scalar = T;
    type State = [T; 4];

    fn derivative(&self, model: &(), t: T, y: &[T; 4], dy: &mut [T; 4]) {
        self.forced(model, t, y, &[T::constant(0.0); 2], dy);
    }
}

impl<T: Real> Forced for Pair<T> {
    fn rates(&self, _: &()) -> Range<usize> {
        2..4
    }

    /// M = [[2, 1], [1, 1]], as of a cart that carries a slider, with a weight on each coordinate.
    fn forced(&self, _: &(), _: T, y: &[T; 4], forces: &[T], dy: &mut [T; 4]) {
        let (first, second) = (forces[0] + self.0[0], forces[1] + self.0[1]);
        *dy = [y[2], y[3], first - second, second + second - first];
    }
}

fn tossed<T: Real>(loads: [f64; 2], start: [f64; 4], e: [f64; 2]) -> ([f64; 4], u64) {
    let k = T::constant;
    let contacts = [0, 1].map(|i| Contact::new(i, i + 2).with_stops([k(-0.5), k(0.5)], k(e[i])).unwrap());
    let mut y = start.map(k);
    let mut motion = Stepped::new(Pair(loads.map(k)), contacts, &y);
    for step in 0..300 {
        motion.advance(&(), k(f64::from(step) * 1e-3), k(1e-3), 1, &mut y).unwrap();
    }
    (y.map(Real::to_f64), motion.record().impacts)
}

/// What is rounding in single precision is none in double precision: coupled impacts rebound in both.
#[test]
fn single_precision_decides_as_double_precision_does() {
    let mut random = Random(43);
    let (mut alike, mut impacts) = (0, 0);
    for _ in 0..300 {
        let loads = [random.between(-1.0, 1.0), random.between(-1.0, 1.0)];
        let start = core::array::from_fn(|k| random.between(-0.45, 0.45) * if k < 2 { 1.0 } else { 8.0 });
        let e = [random.between(0.3, 1.0), random.between(0.3, 1.0)];
        let ((single, n), (double, m)) = (tossed::<f32>(loads, start, e), tossed::<f64>(loads, start, e));
        let is_near = single.iter().zip(double).all(|(a, b)| (a - b).abs() < 1e-2);
        alike += u32::from(n == m && is_near);
        impacts += m;
    }
    // An impact may be found a step earlier or later.
    assert!(alike > 285 && impacts > 400, "{alike} {impacts}");
}

/// Of four contacts two or three are independent: what is left of the others' pivots is rounding.
#[test]
fn dependent_impulses_are_told_in_single_precision() {
    let mut random = Random(47);
    let (mut alike, mut vast) = (0, 0);
    for case in 0..1000 {
        let rank = 2 + case % 2;
        let g: [[f64; 4]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| random.between(-1.0, 1.0)));
        let compliance: [[f64; 4]; 4] =
            core::array::from_fn(|i| core::array::from_fn(|k| (0..rank).map(|r| g[r][i] * g[r][k]).sum()));
        let freedoms: [f64; 4] = core::array::from_fn(|_| random.between(-1.0, 1.0));
        let rates: [f64; 4] = core::array::from_fn(|i| (0..rank).map(|r| g[r][i] * freedoms[r]).sum());
        let restitution = random.between(0.0, 1.0);
        let hits = rates.map(|rate| Some(Hit { outward: -rate.signum(), rebound: restitution * rate.abs() }));
        let of_single = |hit: Hit<f64>| Hit { outward: hit.outward as f32, rebound: hit.rebound as f32 };
        let single = impulses(
            &compliance.map(|row| row.map(|x| x as f32)),
            &rates.map(|rate| rate as f32),
            &hits.map(|hit| hit.map(of_single)),
        );
        let double = impulses(&compliance, &rates, &hits);
        let largest = rates.into_iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let is_near = |(a, b): (f32, f64)| (f64::from(a) - b).abs() < 1e-3 * largest;
        alike += u32::from(single.1.into_iter().zip(double.1).all(is_near));
        let most = |impulses: [f64; 4]| impulses.into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        vast += u32::from(most(single.0.map(f64::from)) > 3.0 * most(double.0));
    }
    // Elsewhere three are nearly two.
    assert!(alike > 990 && vast < 10, "{alike} {vast}");
}

/// Three masses in a row on the ground, each carrying the next: what holds them is solved for to rounding.
#[derive(Clone, Copy)]
struct Stack([f32; 3], [f32; 3]);

impl Ode for Stack {
    type Scalar = f32;
    type State = [f32; 6];

    fn derivative(&self, model: &(), t: f32, y: &[f32; 6], dy: &mut [f32; 6]) {
        self.forced(model, t, y, &[0.0; 3], dy);
    }
}

impl Forced for Stack {
    fn rates(&self, _: &()) -> Range<usize> {
        3..6
    }

    fn forced(&self, _: &(), _: f32, y: &[f32; 6], forces: &[f32], dy: &mut [f32; 6]) {
        // Along relative coordinates; of each mass the acceleration in space.
        let pushes: [f32; 3] = core::array::from_fn(|k| forces[k] + self.1[k]);
        let [a, b, c] = [pushes[0] - pushes[1], pushes[1] - pushes[2], pushes[2]];
        let [a, b, c] = [a / self.0[0], b / self.0[1], c / self.0[2]];
        *dy = [y[3], y[4], y[5], a, b - a, c - b];
    }
}

#[test]
fn what_is_held_in_single_precision_is_not_called_jammed() {
    let mut random = Random(53);
    for case in 0..2000 {
        let mut numbers = |low, high| core::array::from_fn(|_| random.between(low, high) as f32);
        let stack = Stack(numbers(0.05, 20.0), numbers(-1.0, 1.0));
        let contacts = [0, 1, 2].map(|k| Contact::new(k, k + 3).with_friction(2.0, 3.0).unwrap());
        let mut y = [0.0, 0.0, 0.0, random.between(-1.0, 1.0) as f32, 0.0, 0.0];
        let mut motion = Stepped::new(stack, contacts, &y);
        for step in 0..20 {
            let outcome = motion.advance(&(), step as f32 * 1e-2, 1e-2, 1, &mut y);
            assert!(outcome.is_ok(), "case {case}, step {step}: {outcome:?}");
        }
    }
}

#[test]
fn a_contact_beyond_the_state_does_nothing() {
    let beyond = Contact::new(7, 9).with_stops([-1.0, 1.0], 0.5).unwrap().with_friction(0.1, 0.2).unwrap();
    let mut y = [1.0, 0.0];
    Stepped::new(Falling, [beyond], &y).advance(&(), 0.0, 0.125, 8, &mut y).unwrap();
    assert!((y[0] - 1.0 + 0.5 * GRAVITY).abs() < 1e-14 && (y[1] + GRAVITY).abs() < 1e-14, "{y:?}");
}

/// The cart, and how often its accelerations have been evaluated.
#[derive(Clone)]
struct Counted<'a>(Cart, &'a Cell<u32>);

impl Ode for Counted<'_> {
    type Scalar = f64;
    type State = [f64; 4];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 4], dy: &mut [f64; 4]) {
        self.1.set(self.1.get() + 1);
        self.0.derivative(model, t, y, dy);
    }
}

impl Forced for Counted<'_> {
    fn rates(&self, model: &()) -> Range<usize> {
        self.0.rates(model)
    }

    fn forced(&self, model: &(), t: f64, y: &[f64; 4], forces: &[f64], dy: &mut [f64; 4]) {
        self.1.set(self.1.get() + 1);
        self.0.forced(model, t, y, forces, dy);
    }
}

#[test]
fn a_step_evaluates_no_more_than_it_says() {
    let mut random = Random(59);
    let count = Cell::new(0);
    let mut most = [[0; 2]; 3];
    for _ in 0..100 {
        let (cart, start) = random_cart(&mut random);
        let contacts = contacts(&mut random);
        let mut y = start;
        let mut motion = Stepped::new(Counted(cart, &count), contacts, &y);
        motion.advance(&(), 0.0, 1e-3, 1, &mut y).unwrap();
        for step in 1..2000 {
            count.set(0);
            let before = (*motion.phases(), motion.record().impacts);
            let n_held = motion.phases().iter().filter(|phase| phase.is_held()).count();
            motion.advance(&(), f64::from(step) * 1e-3, 1e-3, 1, &mut y).unwrap();
            let happened = before != (*motion.phases(), motion.record().impacts);
            let most = &mut most[n_held][usize::from(happened)];
            *most = count.get().max(*most);
        }
    }
    let [free, held, both] = most;
    assert_eq!([free[0], held[0], both[0]], [4, 9 + 5 * 2, 9 + 5 * 2], "two contacts");
    let more = 4 + 4 * 2;
    assert!(free[1] <= 4 + more && held[1].max(both[1]) <= 9 + 5 * 2 + more, "{most:?}");
    assert!(free[1] > free[0] && held[1] > held[0], "something has happened: {most:?}");
}
