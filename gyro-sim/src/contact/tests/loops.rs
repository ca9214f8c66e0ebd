//! Contacts of a system with a constraint, whose mass matrix has a rank of one.

use crate::contact::{Contact, Forced, Hybrid};
use crate::{Control, Correction, Dop853, Error, Ode};
use core::ops::Range;

const GRAVITY: f64 = 9.81;

/// Two masses of one kilogram on rails, one level and one upright, whose distance is one metre: the state is
/// `(x, y, ẋ, ẏ)`. With `x = sin θ`, `y = −cos θ` this is a pendulum of one kilogram and one metre.
struct Trammel;

impl Ode for Trammel {
    type Scalar = f64;
    type State = [f64; 4];

    fn derivative(&self, model: &(), t: f64, y: &[f64; 4], dy: &mut [f64; 4]) {
        self.forced(model, t, y, &[0.0; 2], dy);
    }
}

impl Forced for Trammel {
    fn rates(&self, _: &()) -> Range<usize> {
        2..4
    }

    fn forced(&self, _: &(), _: f64, state: &[f64; 4], forces: &[f64], dy: &mut [f64; 4]) {
        let [x, y, u, v] = *state;
        let [f, g] = [forces[0], forces[1] - GRAVITY];
        // x ẍ + y ÿ = −(ẋ² + ẏ²), with a force along (x, y) that sees to it.
        let along = -(u * u + v * v + x * f + y * g) / (x * x + y * y);
        *dy = [u, v, f + along * x, g + along * y];
    }
}

/// Keeps distance and rates.
struct Rod;

impl Correction<Trammel> for Rod {
    fn correct(&mut self, _: &(), _: f64, state: &mut [f64; 4]) -> Result<(), Error> {
        let [x, y, u, v] = *state;
        let length = libm::hypot(x, y);
        let [x, y] = [x / length, y / length];
        let along = u * x + v * y;
        *state = [x, y, u - along * x, v - along * y];
        Ok(())
    }

    fn violation(&mut self, _: &(), _: f64, state: &[f64; 4]) -> f64 {
        (libm::hypot(state[0], state[1]) - 1.0).abs()
    }
}

/// The time of the pendulum from one angle to another, between which it has this rate at the first: ∫ dθ / θ̇, by
/// Simpson's rule.
fn time(from: f64, to: f64, rate: f64) -> f64 {
    let n = 20_000;
    let slowness = |k: i32| {
        let angle = from + (to - from) * f64::from(k) / f64::from(n);
        1.0 / libm::sqrt(rate * rate + 2.0 * GRAVITY * (libm::cos(angle) - libm::cos(from)))
    };
    let weight = |k: i32| if k == 0 || k == n { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
    let sum: f64 = (0..=n).map(|k| weight(k) * slowness(k)).sum();
    sum * (to - from).abs() / f64::from(3 * n)
}

#[test]
fn stops_on_both_masses_are_hit_at_the_times_of_the_pendulum() {
    let (limit, e, rate) = (0.7, 0.8, 5.0);
    let [sine, cosine] = [libm::sin(limit), libm::cos(limit)];
    // At −0.7 rad both stops are reached in one instant, at 0.7 rad the upper one alone.
    let contacts = [
        Contact::new(0, 2).with_stops([-sine, f64::INFINITY], e).unwrap(),
        Contact::new(1, 3).with_stops([f64::NEG_INFINITY, -cosine], e).unwrap(),
    ];
    let start = [0.0, -1.0, rate, 0.0];
    let control = Control::default().with_tolerance(1e-13);
    let mut motion = Hybrid::with_correction(Trammel, contacts, Dop853::new(&start), Rod, 0.0, &start)
        .with_control(control);
    let mut at_stop = libm::sqrt(rate * rate - 2.0 * GRAVITY * (1.0 - cosine));
    let (mut t, mut outward) = (time(0.0, limit, rate), 1.0);
    let mut energy = 0.5 * rate * rate - GRAVITY;
    for impact in 0..8 {
        while !motion.step_towards(&(), 100.0).unwrap() {}
        let y = *motion.state();
        assert!((motion.time() / t - 1.0).abs() < 1e-11, "impact {impact}: {} for {t}", motion.time());
        assert!((y[0] - outward * sine).abs() < 1e-13 && (y[1] + cosine).abs() < 1e-13, "{impact}: {y:?}");
        energy -= 0.5 * at_stop * at_stop * (1.0 - e * e);
        at_stop *= e;
        let rates = [-outward * at_stop * cosine, -at_stop * sine];
        assert!(
            (y[2] - rates[0]).abs() < 1e-11 && (y[3] - rates[1]).abs() < 1e-11,
            "{impact}: {y:?} {rates:?}"
        );
        let found = 0.5 * (y[2] * y[2] + y[3] * y[3]) + GRAVITY * y[1];
        assert!((found - energy).abs() < 1e-11, "{impact}: {found} for {energy}");
        let lost = 0.5 * rate * rate - GRAVITY - energy;
        assert!((motion.record().lost - lost).abs() < 1e-11, "{impact}: {:?}, {lost}", motion.record());
        t += time(outward * limit, -outward * limit, at_stop);
        outward = -outward;
    }
    // In the end it comes to rest in the middle, or on a stop that it is pressed against: here it swings free.
    assert_eq!(motion.record().impacts, 12);
}
