//! Coordinates that are elements of the state, and the same ones in a state that has others.

use super::fine;
use crate::contact::{Contact, Forced, Hybrid, Phase};
use crate::{Dop853, Ode};
use core::ops::Range;

/// Two masses of one kilogram on springs, driven. The state has their places x and y, or a and b with x = a + b and
/// y = a − 2 b.
#[derive(Clone, Copy)]
struct Masses {
    springs: [f64; 3],
    drive: [f64; 2],
    is_mixed: bool,
}

impl Masses {
    fn accelerations(&self, t: f64, [x, y]: [f64; 2], forces: &[f64]) -> [f64; 2] {
        let [left, between, right] = self.springs;
        let drive = self.drive[0] * libm::sin(self.drive[1] * t);
        [-left * x + between * (y - x) + drive + forces[0], -right * y - between * (y - x) + forces[1]]
    }

    fn masses(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        if self.is_mixed { [a + b, a - 2.0 * b] } else { [a, b] }
    }

    fn own(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        if self.is_mixed { [(2.0 * x + y) / 3.0, (x - y) / 3.0] } else { [x, y] }
    }
}

impl Ode for Masses {
    type Scalar = f64;
    type State = [f64; 4];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 4], dy: &mut [f64; 4]) {
        self.forced(model, t, y, &[0.0; 2], dy);
    }
}

impl Forced for Masses {
    const HAS_SURFACES: bool = true;

    fn rates(&self, _: &()) -> Range<usize> {
        2..4
    }

    fn forced(&self, _: &(), t: f64, y: &[f64; 4], forces: &[f64], dy: &mut [f64; 4]) {
        let [a, b] = self.own(self.accelerations(t, self.masses([y[0], y[1]]), forces));
        *dy = [y[2], y[3], a, b];
    }

    fn seen(&self, _: &(), t: f64, y: &[f64; 4], forces: &[f64], out: &mut [[f64; 3]]) {
        let (places, rates) = (self.masses([y[0], y[1]]), self.masses([y[2], y[3]]));
        let accelerations = self.accelerations(t, places, forces);
        for k in 0..2 {
            out[k] = [places[k], rates[k], accelerations[k]];
        }
    }
}

/// Numbers from 0 to 1 that look random.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Stops and friction act alike on what the state has and on what only the system sees.
#[test]
fn what_is_seen_stops_and_sticks_as_what_is_in_the_state() {
    let (mut n_hits, mut n_caught, mut n_rests) = (0, 0, 0);
    for seed in 0..60 {
        let mut numbers = Numbers(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * numbers.next();
        let springs = [between(1.0, 30.0), between(1.0, 30.0), between(1.0, 30.0)];
        let drive = [between(0.0, 20.0), between(1.0, 5.0)];
        let ends: [f64; 2] = [between(-0.4, -0.1), between(0.2, 0.6)];
        let (restitution, level) = (between(0.0, 0.9), between(0.5, 3.0));
        let places = [between(-0.09, 0.19), between(-0.5, 0.5)];
        let with = |contact: Contact<f64>, k: usize| match k {
            0 => contact.with_stops(ends, restitution).unwrap(),
            _ => contact.with_friction(level, 1.2 * level).unwrap(),
        };
        let run = |is_mixed: bool| {
            let masses = Masses { springs, drive, is_mixed };
            let contacts = match is_mixed {
                true => [with(Contact::seen(), 0), with(Contact::seen(), 1)],
                false => [with(Contact::new(0, 2), 0), with(Contact::new(1, 3), 1)],
            };
            let [a, b] = masses.own(places);
            let start = [a, b, 0.0, 0.0];
            let mut motion =
                Hybrid::new(masses, contacts, Dop853::new(&start), 0.0, &start).with_control(fine());
            let mut last = 0.0;
            while motion.time() < 3.0 {
                if motion.step_towards(&(), 3.0).unwrap() {
                    last = motion.time();
                }
            }
            let y = *motion.state();
            let (places, rates) = (masses.masses([y[0], y[1]]), masses.masses([y[2], y[3]]));
            (last, [places, rates], *motion.record(), *motion.phases())
        };
        let (in_state, seen) = (run(false), run(true));
        assert_eq!(in_state.3, seen.3, "{seed}");
        for (one, other) in in_state.1.iter().flatten().zip(seen.1.iter().flatten()) {
            assert!((one - other).abs() < 1e-8, "{seed}: {:?} {:?}", in_state.1, seen.1);
        }
        assert!((in_state.2.lost - seen.2.lost).abs() < 1e-9, "{seed}: {:?} {:?}", in_state.2, seen.2);
        // The last rebounds are none where a place is rounded.
        assert!((in_state.0 - seen.0).abs() < 1e-6, "{seed}: {} {}", in_state.0, seen.0);
        n_hits += in_state.2.impacts;
        n_caught += in_state.2.caught;
        n_rests += u64::from(in_state.3[0] != Phase::Free);
    }
    assert!(n_hits > 200 && n_caught > 50 && n_rests > 1, "{n_hits} {n_caught} {n_rests}");
}

/// A mass of one kilogram on a spring, driven, whose place x is seen as so many times x.
#[derive(Clone, Copy)]
struct Levers {
    spring: f64,
    drive: [f64; 2],
    ratios: [f64; 3],
}

impl Ode for Levers {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        self.forced(model, t, y, &[0.0; 3], dy);
    }
}

impl Forced for Levers {
    const HAS_SURFACES: bool = true;

    fn rates(&self, _: &()) -> Range<usize> {
        1..2
    }

    fn forced(&self, _: &(), t: f64, y: &[f64; 2], forces: &[f64], dy: &mut [f64; 2]) {
        let push: f64 = self.ratios.iter().zip(forces).map(|(ratio, force)| ratio * force).sum();
        *dy = [y[1], self.drive[0] * libm::sin(self.drive[1] * t) - self.spring * y[0] + push];
    }

    fn seen(&self, model: &(), t: f64, y: &[f64; 2], forces: &[f64], out: &mut [[f64; 3]]) {
        let mut dy = [0.0; 2];
        self.forced(model, t, y, forces, &mut dy);
        for (out, ratio) in out.iter_mut().zip(self.ratios) {
            *out = [ratio * y[0], ratio * y[1], ratio * dy[1]];
        }
    }
}

/// Friction on three coordinates of one freedom is that of one coordinate.
#[test]
fn what_moves_together_sticks_together() {
    let mut n_caught = 0;
    for seed in 0..60 {
        let mut numbers = Numbers(seed);
        let mut between = |low: f64, high: f64| low + (high - low) * numbers.next();
        let (spring, drive) = (between(1.0, 30.0), [between(0.0, 20.0), between(1.0, 5.0)]);
        let ratios: [f64; 3] = [between(-2.0, -0.3), between(0.3, 2.0), 1.0];
        let levels: [f64; 3] = core::array::from_fn(|_| between(0.1, 1.0));
        let start = [between(-1.0, 1.0), 0.0];
        let run = |contacts: [Contact<f64>; 3]| {
            let levers = Levers { spring, drive, ratios };
            let mut motion =
                Hybrid::new(levers, contacts, Dop853::new(&start), 0.0, &start).with_control(fine());
            motion.advance_to(&(), 3.0).unwrap_or_else(|error| panic!("{seed}: {error}"));
            (*motion.state(), motion.record().caught)
        };
        let with = |level: f64| Contact::seen().with_friction(level, 1.2 * level).unwrap();
        let all = run(levels.map(with));
        let sum: f64 = ratios.iter().zip(levels).map(|(ratio, level)| ratio.abs() * level).sum();
        let one = run([with(0.0), with(0.0), with(sum)]);
        for (all, one) in all.0.iter().zip(one.0) {
            assert!((all - one).abs() < 1e-9, "{seed}: {all} {one}");
        }
        n_caught += one.1;
    }
    assert!(n_caught > 30, "{n_caught}");
}
