//! Motions with contacts that are known piece by piece.

mod fading;
mod listed;
mod loads;
mod loops;
mod seen;
mod stepped;
mod surfaces;

use super::resolve::{Hit, impulses, work};
use super::{Contact, Forced, Hybrid, Phase};
use crate::{Control, Dop853, Kutta4, Ode, Tsit5, Uncorrected};
use core::ops::Range;

const GRAVITY: f64 = 9.81;

/// A mass of one kilogram under a force.
#[derive(Clone, Copy)]
struct Mass<F>(F);

impl<F: Fn(f64, f64, f64) -> f64> Ode for Mass<F> {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        self.forced(model, t, y, &[0.0], dy);
    }
}

impl<F: Fn(f64, f64, f64) -> f64> Forced for Mass<F> {
    fn rates(&self, _: &()) -> Range<usize> {
        1..2
    }

    fn forced(&self, _: &(), t: f64, y: &[f64; 2], forces: &[f64], dy: &mut [f64; 2]) {
        *dy = [y[1], (self.0)(t, y[0], y[1]) + forces[0]];
    }
}

fn fine() -> Control {
    Control::default().with_tolerance(1e-13)
}

#[test]
fn a_bouncing_mass_comes_to_rest_at_its_zeno_time() {
    for (e, floor) in [(0.5, 0.0), (0.9, 0.0), (0.1, 0.0), (0.5, -3.0), (0.8, 100.0), (0.0, 0.0)] {
        let contact = Contact::new(0, 1).with_stops([floor, f64::INFINITY], e).unwrap();
        let start = [floor + 1.0, 0.0];
        let fall = libm::sqrt(2.0 / GRAVITY);
        let zeno = fall * (1.0 + e) / (1.0 - e);
        let motion = Mass(|_, _, _| -GRAVITY);
        let mut ball = Hybrid::new(motion, [contact], Dop853::new(&start), 0.0, &start).with_control(fine());
        while ball.phases() != &[Phase::AtLower] {
            ball.step_towards(&(), 2.0 * zeno).unwrap();
        }
        // The height is rounded where the floor is not at zero: the last rebounds cannot be told from rest.
        let bound = if floor == 0.0 { 1e-11 } else { 1e-7 };
        assert!((ball.time() / zeno - 1.0).abs() < bound, "{e}: {} for {zeno}", ball.time());
        ball.advance_to(&(), 2.0 * zeno).unwrap();
        assert_eq!(*ball.state(), [floor, 0.0]);
        let record = ball.record();
        assert!((record.lost / GRAVITY - 1.0).abs() < 1e-12, "{e}: {record:?}");
        assert_eq!(ball.forces(&()), [GRAVITY]);
    }
}

/// A pendulum of one kilogram and one metre, whose stop is at its lowest point.
type Pendulum = Hybrid<Mass<fn(f64, f64, f64) -> f64>, [f64; 2], f64, Dop853<[f64; 2], f64>, Uncorrected, 1>;

fn pendulum(e: f64, control: Control) -> Pendulum {
    let contact = Contact::new(0, 1).with_stops([0.0, f64::INFINITY], e).unwrap();
    let start = [1.0, 0.0];
    let motion: Mass<fn(f64, f64, f64) -> f64> = Mass(|_, x, _| -libm::sin(x));
    Hybrid::new(motion, [contact], Dop853::new(&start), 0.0, &start).with_control(control)
}

fn energy(y: &[f64; 2]) -> f64 {
    let half = libm::sin(0.5 * y[0]);
    0.5 * y[1] * y[1] + 2.0 * half * half
}

/// Restitution e over so many impacts: by how much energy differs from what e leaves, and from what the record says.
fn balance(e: f64, n: u32) -> [f64; 2] {
    let mut motion = pendulum(e, Control::default().with_tolerance(1e-15));
    let start = energy(motion.state());
    while motion.record().impacts < u64::from(n) {
        motion.step_towards(&(), f64::MAX).unwrap();
    }
    let expected = start * libm::exp(2.0 * f64::from(n) * libm::log(e));
    let found = energy(motion.state());
    [found / expected - 1.0, (found + motion.record().lost) / start - 1.0]
}

#[test]
fn a_pendulum_on_a_stop_keeps_what_restitution_leaves() {
    for (e, n) in [(1.0 - 1e-5, 2000), (0.99, 500), (1.0, 500)] {
        for error in balance(e, n) {
            assert!(error.abs() < 1e-12, "{e}: {error:e}");
        }
    }
}

/// The rate of a belt that carries a mass on a spring. Coordinates are relative to the belt.
const BELT: f64 = 0.1;

/// A mass of one kilogram on a spring that starts stuck to the belt, with the spring slack: piece by piece.
struct Oscillator {
    stiffness: f64,
    kinetic: f64,
    at_rest: f64,
}

impl Oscillator {
    /// The position relative to the ground at a time.
    fn at(&self, t: f64) -> f64 {
        let omega = libm::sqrt(self.stiffness);
        let [slipping, sticking] = [self.kinetic, self.at_rest].map(|level| level / self.stiffness);
        // Stuck to the belt until the spring pulls at the static level; then x = slipping + a cos + b sin.
        let (mut begin, mut x) = (0.0, 0.0);
        loop {
            let breaks = begin + (sticking - x) / BELT;
            if t <= breaks {
                return x + BELT * (t - begin);
            }
            let (a, b) = (sticking - slipping, BELT / omega);
            // The rate is that of the belt again at twice the angle to the rear of the circle.
            let phase = 2.0 * (core::f64::consts::PI - libm::atan2(a, b));
            let stops = breaks + phase / omega;
            if t <= stops {
                let angle = omega * (t - breaks);
                return slipping + a * libm::cos(angle) + b * libm::sin(angle);
            }
            (begin, x) = (stops, slipping + a * libm::cos(phase) + b * libm::sin(phase));
        }
    }
}

#[test]
fn a_mass_on_a_belt_sticks_and_slips_as_the_pieces_say() {
    for (stiffness, kinetic, at_rest) in
        [(1.0, 0.5, 1.0), (25.0, 0.2, 0.3), (4.0, 0.9, 1.0), (100.0, 1.0, 3.0)]
    {
        let exact = Oscillator { stiffness, kinetic, at_rest };
        let contact = Contact::new(0, 1).with_friction(kinetic, at_rest).unwrap();
        let motion = Mass(|t, x, _| -stiffness * (x + BELT * t));
        let start = [0.0, 0.0];
        let mut mass = Hybrid::new(motion, [contact], Dop853::new(&start), 0.0, &start).with_control(fine());
        for k in 1..=400 {
            let t = 0.1 * f64::from(k);
            mass.advance_to(&(), t).unwrap();
            let (found, expected) = (mass.state()[0] + BELT * t, exact.at(t));
            assert!((found - expected).abs() < 1e-9, "{stiffness} {t}: {found} for {expected}");
        }
        let record = mass.record();
        assert!(record.released > 1 && record.caught + 1 >= record.released, "{stiffness}: {record:?}");
    }
}

#[test]
fn a_slider_stops_at_its_time_and_place_and_stays_there() {
    for (rate, level) in [(1.0, 0.5), (-3.0, 2.0), (1e-6, 1.0), (100.0, 0.1)] {
        let contact = Contact::new(0, 1).with_friction(level, level).unwrap();
        let start = [0.7, rate];
        let mut slider =
            Hybrid::new(Mass(|_, _, _| 0.0), [contact], Tsit5::new(&start), 0.0, &start).with_control(fine());
        while slider.phases() != &[Phase::Sticks] {
            slider.step_towards(&(), 1e4).unwrap();
        }
        let (time, place) = (rate.abs() / level, 0.7 + 0.5 * rate * rate.abs() / level);
        assert!((slider.time() / time - 1.0).abs() < 1e-14, "{rate}: {} for {time}", slider.time());
        assert!((slider.state()[0] / place - 1.0).abs() < 1e-14, "{rate}: {:?} for {place}", slider.state());
        assert_eq!(slider.state()[1], 0.0);
    }
}

#[test]
fn what_sticks_does_not_move_by_one_bit() {
    // A load that swings just below the static level for a thousand seconds.
    let contact = Contact::new(0, 1).with_friction(0.5, 1.0).unwrap();
    let start = [0.123_456_789, 0.0];
    let motion = Mass(|t, x, _| 0.999 * libm::sin(7.0 * t) + 1e-4 * x);
    let mut mass = Hybrid::new(motion, [contact], Dop853::new(&start), 0.0, &start);
    mass.advance_to(&(), 1000.0).unwrap();
    assert_eq!(*mass.state(), start);
    assert_eq!(mass.record().released, 0);
    let motion = Mass(|t, x, _| 0.999 * libm::sin(7.0 * t) + 1e-4 * x);
    let mut mass = Hybrid::new(motion, [contact], Kutta4::new(&start), 0.0, &start);
    for _ in 0..100_000 {
        mass.step(&(), 0.01).unwrap();
    }
    assert_eq!(*mass.state(), start);
    // Just above, it does.
    let motion = Mass(|t, x, _| 1.001 * libm::sin(7.0 * t) + 1e-4 * x);
    let mut mass = Hybrid::new(motion, [contact], Dop853::new(&start), 0.0, &start);
    mass.advance_to(&(), 1.0).unwrap();
    assert!(mass.record().released > 0 && mass.state()[0] != start[0]);
}

/// Numbers that look random, between two others.
pub(super) struct Random(pub(super) u64);

impl Random {
    #[expect(clippy::cast_precision_loss, reason = "53 bits are exact")]
    pub(super) fn between(&mut self, a: f64, b: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let mixed = (self.0 ^ (self.0 >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        a + (b - a) * ((mixed >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

#[test]
fn impulses_are_complementary_and_take_energy() {
    let mut random = Random(3);
    for case in 0..5000 {
        // W = Gᵀ G of four contacts of which two or three are independent.
        let rank = if case % 3 == 0 { 2 } else { 4 };
        let g: [[f64; 4]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| random.between(-1.0, 1.0)));
        let column = |i: usize, k: usize| (0..rank).map(|r| g[r][i] * g[r][k]).sum::<f64>();
        let compliance: [[f64; 4]; 4] = core::array::from_fn(|i| core::array::from_fn(|k| column(i, k)));
        // Rates that the freedoms allow.
        let freedoms: [f64; 4] = core::array::from_fn(|_| random.between(-1.0, 1.0));
        let rates: [f64; 4] = core::array::from_fn(|i| (0..rank).map(|r| g[r][i] * freedoms[r]).sum::<f64>());
        let hits: [Option<Hit<f64>>; 4] = core::array::from_fn(|k| {
            // What is hit is approached; of odd cases some are touched only, and left.
            let towards = if rates[k] > 0.0 { -1.0 } else { 1.0 };
            let is_left = case % 2 == 1 && random.between(0.0, 1.0) < 0.3;
            let restitution = if is_left { 0.0 } else { random.between(0.0, 1.0) };
            let outward = if is_left { -towards } else { towards };
            let rebound = if is_left { 0.0 } else { -outward * restitution * rates[k] };
            (random.between(0.0, 1.0) < 0.7).then_some(Hit { outward, rebound })
        });
        let outcome = impulses(&compliance, &rates, &hits);
        let (impulses, after) = &outcome;
        assert!(work(&outcome, &rates) <= 1e-12, "case {case}: {:e}", work(&outcome, &rates));
        for (k, hit) in hits.iter().enumerate() {
            let sum = (0..4).map(|i| compliance[k][i] * impulses[i]).sum::<f64>();
            assert!((rates[k] + sum - after[k]).abs() < 1e-8, "case {case}");
            match hit {
                None => assert_eq!(impulses[k], 0.0),
                Some(hit) => {
                    assert!(hit.outward * impulses[k] >= -1e-8, "case {case}: {outcome:?}");
                    assert!(hit.outward * after[k] >= -1e-9, "case {case}: {outcome:?}");
                    let excess = after[k] - hit.outward * hit.rebound;
                    let is_complementary = (excess * impulses[k]).abs() < 1e-8;
                    assert!(is_complementary || case % 2 == 1, "case {case}: {outcome:?}");
                }
            }
        }
    }
}

/// A cart of 1 kg on a spring with a slider of 1 kg on it, whose coordinate is relative and which has a spring, too:
/// M = [[2, 1], [1, 1]].
#[derive(Clone, Copy)]
struct Cart {
    stiffness: [f64; 2],
    load: f64,
}

impl Cart {
    fn energy(&self, y: &[f64; 4]) -> f64 {
        let [x, z, u, w] = *y;
        let kinetic = 0.5 * u * u + 0.5 * (u + w) * (u + w);
        kinetic + 0.5 * (self.stiffness[0] * x * x + self.stiffness[1] * z * z) - self.load * x
    }
}

impl Ode for Cart {
    type Scalar = f64;
    type State = [f64; 4];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 4], dy: &mut [f64; 4]) {
        self.forced(model, t, y, &[0.0; 2], dy);
    }
}

impl Forced for Cart {
    fn rates(&self, _: &()) -> Range<usize> {
        2..4
    }

    fn forced(&self, _: &(), _: f64, y: &[f64; 4], forces: &[f64], dy: &mut [f64; 4]) {
        let first = forces[0] - self.stiffness[0] * y[0] + self.load;
        let second = forces[1] - self.stiffness[1] * y[1];
        *dy = [y[2], y[3], first - second, 2.0 * second - first];
    }
}

fn random_cart(random: &mut Random) -> (Cart, [f64; 4]) {
    let cart = Cart {
        stiffness: core::array::from_fn(|_| random.between(0.5, 20.0)),
        load: random.between(-3.0, 3.0),
    };
    let start = core::array::from_fn(|k| random.between(-0.45, 0.45) * if k < 2 { 1.0 } else { 6.0 });
    (cart, start)
}

#[test]
fn coupled_stops_keep_a_ledger_and_are_not_passed() {
    let mut random = Random(11);
    let mut impacts = 0;
    for case in 0..60 {
        let (cart, start) = random_cart(&mut random);
        let e = if case % 4 == 0 { [1.0; 2] } else { [random.between(0.0, 1.0); 2] };
        let contacts = [0, 1].map(|k| Contact::new(k, k + 2).with_stops([-0.5, 0.5], e[k]).unwrap());
        let mut motion = Hybrid::new(cart, contacts, Dop853::new(&start), 0.0, &start).with_control(fine());
        while motion.time() < 5.0 {
            motion.step_towards(&(), 5.0).unwrap();
            let y = motion.state();
            assert!(y[..2].iter().all(|x| x.abs() < 0.5 + 1e-12), "case {case}: {y:?}");
            let ledger = cart.energy(y) + motion.record().lost - cart.energy(&start);
            assert!(ledger.abs() < 1e-10, "case {case} at {}: {ledger:e}", motion.time());
            for (k, phase) in motion.phases().iter().enumerate() {
                assert!(
                    !phase.is_held() || (y[k].abs(), y[k + 2]) == (0.5, 0.0),
                    "case {case}: {phase:?} {y:?}"
                );
            }
        }
        impacts += motion.record().impacts;
    }
    assert!(impacts > 300, "{impacts}");
}

#[test]
fn stops_reached_in_one_instant_are_resolved_together() {
    let cart = Cart { stiffness: [0.0; 2], load: 0.0 };
    for [first, second] in [[1.0, 1.0], [3.0, 0.25], [1.0, -1.0]] {
        // Both reach their stops after half a second.
        let start = [0.5 - 0.5 * first, 0.5 * (f64::signum(second) - second), first, second];
        let ends = [[-9.0, 0.5], if second > 0.0 { [-9.0, 0.5] } else { [-0.5, 9.0] }];
        let contacts = [0, 1].map(|k| Contact::new(k, k + 2).with_stops(ends[k], 1.0).unwrap());
        let mut motion = Hybrid::new(cart, contacts, Tsit5::new(&start), 0.0, &start).with_control(fine());
        motion.advance_to(&(), 0.6).unwrap();
        let y = motion.state();
        assert_eq!(motion.record().impacts, 2, "{y:?}");
        assert!((y[2] + first).abs() < 1e-13 && (y[3] + second).abs() < 1e-13, "{y:?}");
    }
}

#[test]
fn friction_on_coupled_coordinates_is_consistent_and_agrees_with_fixed_steps() {
    let mut random = Random(17);
    let mut caught = 0;
    for case in 0..30 {
        let (cart, start) = random_cart(&mut random);
        let contacts = [0, 1].map(|k| {
            let kinetic = random.between(0.1, 1.5);
            let contact = Contact::new(k, k + 2).with_friction(kinetic, kinetic * random.between(1.0, 1.5));
            contact.unwrap().with_stops([-0.5, 0.5], 0.3).unwrap()
        });
        let mut motion = Hybrid::new(cart, contacts, Dop853::new(&start), 0.0, &start).with_control(fine());
        while motion.time() < 3.0 {
            motion.step_towards(&(), 3.0).unwrap();
            let (forces, y) = (motion.forces(&()), *motion.state());
            for (k, phase) in motion.phases().iter().enumerate() {
                let [kinetic, at_rest] = contacts[k].levels;
                let (rate, force) = (y[k + 2], forces[k]);
                let is_consistent = match phase {
                    Phase::Free => false,
                    Phase::Up => rate >= 0.0 && force == -kinetic,
                    Phase::Down => rate <= 0.0 && force == kinetic,
                    Phase::Sticks => rate == 0.0 && force.abs() <= at_rest * (1.0 + 1e-12),
                    Phase::AtLower => rate == 0.0 && y[k] == -0.5 && force >= -at_rest * (1.0 + 1e-12),
                    Phase::AtUpper => rate == 0.0 && y[k] == 0.5 && force <= at_rest * (1.0 + 1e-12),
                    Phase::Slides => false,
                };
                assert!(is_consistent, "case {case} at {}: {k} {phase:?} {y:?} {forces:?}", motion.time());
            }
        }
        caught += motion.record().caught;
        let mut fixed = Hybrid::new(cart, contacts, Kutta4::new(&start), 0.0, &start);
        for _ in 0..30_000 {
            fixed.step(&(), 1e-4).unwrap();
        }
        for k in 0..2 {
            let difference = fixed.state()[k] - motion.state()[k];
            assert!(difference.abs() < 5e-3, "case {case}: {:?} {:?}", fixed.state(), motion.state());
        }
    }
    assert!(caught > 30, "{caught}");
}

#[test]
fn sticking_costs_less_than_a_smooth_law() {
    let (stiffness, kinetic, at_rest, t_end) = (1.0, 0.5, 1.0, 40.0);
    let start = [0.0, 0.0];
    let count = core::cell::Cell::new(0_u32);
    let spring = |t: f64, x: f64| {
        count.set(count.get() + 1);
        -stiffness * (x + BELT * t)
    };
    let control = Control::default().with_tolerance(1e-9);
    let contact = Contact::new(0, 1).with_friction(kinetic, at_rest).unwrap();
    let motion = Mass(|t, x, _| spring(t, x));
    let mut exact = Hybrid::new(motion, [contact], Dop853::new(&start), 0.0, &start).with_control(control);
    exact.advance_to(&(), t_end).unwrap();
    let of_exact = count.replace(0);
    // The smooth law creeps by its width over the time that it sticks, and yet is off by 1e4 times as much.
    let width = 1e-4;
    let smooth = Mass(|t, x, v: f64| {
        let level = kinetic + (at_rest - kinetic) * libm::exp(-v * v / (1e4 * width * width));
        spring(t, x) - level * libm::tanh(v / width)
    });
    let mut smooth = crate::Solver::new(smooth, Tsit5::new(&start), 0.0, &start).with_control(control);
    smooth.advance_to(&(), t_end).unwrap();
    let of_smooth = count.get();
    let expected = Oscillator { stiffness, kinetic, at_rest }.at(t_end) - BELT * t_end;
    assert!((exact.state()[0] - expected).abs() < 1e-9);
    assert!((smooth.state()[0] - expected).abs() > 1e-9);
    assert!(50 * of_exact < of_smooth, "{of_exact} evaluations for {of_smooth}");
}
