//! Seeded random states.

use crate::Engine;
use gyro_model::{
    CoordinateKind, JointCoordinate, JointKind, JointStartSpec, Model, Number, Start, Support, parse_decimal,
};
use gyro_sim::Mechanism;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Seeded random numbers, the same on every machine.
#[derive(Clone, Debug)]
pub struct Random(ChaCha8Rng);

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Uniform in `(−1, 1)`.
    pub fn signed(&mut self) -> f64 {
        self.0.random_range(-1.0..1.0)
    }

    /// Three numbers, each uniform in `(−size, size)`.
    pub fn vector(&mut self, size: f64) -> [f64; 3] {
        [(); 3].map(|()| size * self.signed())
    }

    /// A whole number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        self.0.random_range(0..n)
    }

    /// A direction in four dimensions, uniform: Euler parameters of a uniform rotation (Marsaglia 1972, by rejection).
    pub fn unit(&mut self) -> [f64; 4] {
        loop {
            let p = [self.signed(), self.signed(), self.signed(), self.signed()];
            let square: f64 = p.iter().map(|e| e * e).sum();
            if (0.01..1.0).contains(&square) {
                return p.map(|e| e / square.sqrt());
            }
        }
    }
}

/// A state with every joint row violated: mass centres anywhere within the mechanism's size of where they start, any
/// orientations with |p| = 1, angular velocities up to `rate` rad/s and velocities up to `rate` sizes a second; work
/// and turn references up to one.
pub fn state(mechanism: &Engine, rate: f64, random: &mut Random) -> Vec<f64> {
    let (mut y, n_bodies, size) = (mechanism.start(), mechanism.description().bodies.len(), mechanism.size());
    let (positions, rest) = y.split_at_mut(7 * n_bodies);
    for q in positions.as_chunks_mut::<7>().0 {
        q[..3].iter_mut().for_each(|r| *r += size * random.signed());
        q[3..].copy_from_slice(&random.unit());
    }
    let (velocities, others) = rest.split_at_mut(6 * n_bodies);
    for v in velocities.as_chunks_mut::<6>().0 {
        v[..3].iter_mut().for_each(|s| *s = rate * size * random.signed());
        v[3..].iter_mut().for_each(|w| *w = rate * random.signed());
    }
    others.iter_mut().for_each(|other| *other = random.signed());
    y
}

/// The model with a random pose and random velocities as its start: every joint anywhere, every free body too, at rates
/// up to `rate` rad/s.
pub fn posed(model: &Model, rate: f64, random: &mut Random) -> Model {
    let mut model = model.clone();
    for body in &mut model.bodies {
        body.angular_velocity = None;
        if body.support == Support::Free {
            body.orientation = random.unit().map(number);
            body.position = random.vector(1.0).map(number);
            body.velocity = random.vector(1.0).map(number);
            body.angular_velocity = Some(random.vector(rate).map(number));
        }
    }
    // Any pose, beyond stops, too.
    model.contacts.clear();
    for joint in &mut model.joints {
        let coordinates = joint.kind.coordinates();
        let is_spherical = joint.kind == JointKind::Spherical;
        let n_rates = if is_spherical { 3 } else { coordinates.len() };
        let mut position = |kind: &CoordinateKind| {
            let reach = if kind.is_angle() { 10.0 } else { 1.0 };
            Some(number(reach * random.signed()))
        };
        joint.start = JointStartSpec {
            position: coordinates.iter().map(&mut position).collect(),
            rate: (n_rates > 0).then(|| (0..n_rates).map(|_| number(rate * random.signed())).collect()),
            orientation: is_spherical.then(|| random.unit().map(number)),
            is_rough: false,
            set: Vec::new(),
        };
    }
    model
}

/// A start of a model in the order of the state, no work done yet.
pub fn state_at(model: &Model, start: &Start) -> Vec<f64> {
    let angle = |turn: JointCoordinate| start.joints[turn.joint].position[turn.coordinate];
    let mut y = [&start.q[..], &start.v].concat();
    y.extend(model.has_work().then_some(0.0));
    y.extend(&start.states);
    y.extend(model.turn_references().into_iter().map(angle));
    y
}

/// The start of a model in the order of the state, its positions moved by up to `violation`: mass centres in terms of
/// `size`, Euler parameters in terms of one and then normalised.
pub fn violated_start(model: &Model, violation: f64, random: &mut Random) -> Vec<f64> {
    let mut start = model.assemble().expect("any pose of a tree of joints can be assembled");
    let (y, size) = (&mut start.q, model.size());
    for q in y.as_chunks_mut::<7>().0 {
        q[..3].iter_mut().for_each(|r| *r += violation * size * random.signed());
        q[3..].iter_mut().for_each(|e| *e += violation * random.signed());
        let norm = q[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
        q[3..].iter_mut().for_each(|e| *e /= norm);
    }
    state_at(model, &start)
}

/// The number that is written with the digits of a finite `f64`.
fn number(value: f64) -> Number {
    Number::Exact(parse_decimal(&format!("{value:?}")).expect("finite numbers are written as decimals"))
}
