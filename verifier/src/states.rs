//! States in which modules are tried: any, and those where mechanisms are likely to divide by zero.

use crate::atoms::Elementary;
use crate::field::Field;
use crate::interpreter::{self, Given};
use crate::joints::{Freedom, JointLayout};
use crate::module::Module;
use crate::point::{Point, first_state};
use crate::seed::Seed;
use chacha20::ChaCha8Rng;
use gyro_model::{Model, to_f64};
use rand::RngExt;
use std::f64::consts::{FRAC_PI_2, PI};

/// Angles at which sines and cosines vanish.
const ALIGNED: [f64; 4] = [0.0, FRAC_PI_2, -FRAC_PI_2, PI];

/// Half turns, and none.
const HALF_TURNS: [[f64; 4]; 4] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

/// States of random combinations of these.
const COMBINATIONS: usize = 12;

/// How fast the last coordinate of an extreme state moves, rad/s.
const FAST: f64 = 1e6;

/// How far joints of an extreme state are torn.
const TORN: f64 = 1e-2;

/// Where functions are run.
#[derive(Clone, Debug)]
pub struct Place {
    /// In words.
    pub what: &'static str,
    /// A maximal state.
    pub state: Vec<f64>,
    /// The joint state that it is of, if it is of one.
    pub joints: Option<Vec<f64>>,
}

/// Where mechanisms are likely to divide by zero.
pub fn places(model: &Model, module: &Module, seed: Seed) -> Vec<Place> {
    let mut random = seed.numbers(1);
    let mut places = match &module.joints {
        Some(layout) => of_joints(model, module, layout, &mut random),
        None => vec![Place { what: "at the start", state: module.start.clone(), joints: None }],
    };
    places.extend(torn(model, &module.start, &mut random));
    places
}

/// States of joint states.
fn of_joints(model: &Model, module: &Module, layout: &JointLayout, random: &mut ChaCha8Rng) -> Vec<Place> {
    let start = &module.joint_start;
    let rates = layout.n_coordinates..layout.n_motion();
    let resting = |joints: &[f64]| {
        let mut joints = joints.to_vec();
        joints[rates.clone()].fill(0.0);
        joints
    };
    let mut states = vec![("at the start", start.clone()), ("at rest", resting(start))];
    for (k, &angle) in ALIGNED.iter().enumerate() {
        let aligned = turned(layout, start, || (angle, HALF_TURNS[k]));
        states.push(("at rest, all angles 0, ±90 or 180 degrees", resting(&aligned)));
        states.push(("with all angles 0, ±90 or 180 degrees", aligned));
    }
    for _ in 0..COMBINATIONS {
        let mut mixed = turned(layout, start, || {
            (ALIGNED[random.random_range(0..4)], HALF_TURNS[random.random_range(0..4)])
        });
        states.push(("at rest, each angle 0, ±90 or 180 degrees", resting(&mixed)));
        mixed[rates.clone()].iter_mut().for_each(|rate| *rate = random.random_range(-100.0..100.0));
        states.push(("with each angle 0, ±90 or 180 degrees", mixed));
    }
    let mut fast = start.clone();
    fast[rates.clone()].iter_mut().next_back().into_iter().for_each(|rate| *rate = FAST);
    states.push(("with the last body at 1e6 rad/s", fast));
    let constants: Vec<f64> = interpreter::constants((), module);
    let point = point(model, (), &module.start, 0.0, |x| x);
    let place = |(what, joints): (&'static str, Vec<f64>)| {
        let given = Given { point: &point, accelerations: &[], charts: &[], changes: &[], joints: &joints };
        let state = interpreter::run(module, &module.programs["to_maximal"], &constants, &Elementary, &given);
        Some(Place { what, state: state.ok()?, joints: Some(joints) })
    };
    states.into_iter().filter_map(place).collect()
}

/// A joint state with other angles and orientations.
fn turned(layout: &JointLayout, start: &[f64], mut turn: impl FnMut() -> (f64, [f64; 4])) -> Vec<f64> {
    let mut joints = start.to_vec();
    for place in &layout.places {
        let (angle, half) = turn();
        match (place.of, place.of.euler()) {
            (Freedom::Scalar(_) | Freedom::Turn(_), _) => joints[place.x] = angle,
            (_, Some(euler)) => joints[place.x + euler..][..4].copy_from_slice(&half),
            (_, None) => {}
        }
    }
    joints
}

/// States that satisfy no constraint: bodies at rest in any half turn, and joints torn a little.
fn torn(model: &Model, start: &[f64], random: &mut ChaCha8Rng) -> Vec<Place> {
    let n = model.coordinate_bodies().len();
    let mut places = Vec::new();
    let mut add = |what, state| places.push(Place { what, state, joints: None });
    let mut rest = start.to_vec();
    rest[7 * n..13 * n].fill(0.0);
    add("at rest", rest.clone());
    for half in HALF_TURNS {
        let mut state = rest.clone();
        state[..7 * n].chunks_mut(7).for_each(|position| position[3..].copy_from_slice(&half));
        add("at rest, all bodies turned by half a turn", state);
    }
    let mut state = start.to_vec();
    for position in state[..7 * n].chunks_mut(7) {
        position.iter_mut().for_each(|x| *x += random.random_range(-TORN..TORN));
        let length = position[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
        position[3..].iter_mut().for_each(|e| *e /= length);
    }
    add("with joints torn by 1e-2", state);
    add("at a random state", random_state(model, random));
    places
}

/// A state of numbers between −1 and 1 with |p| = 1 to rounding.
pub fn random_state(model: &Model, random: &mut ChaCha8Rng) -> Vec<f64> {
    let n = model.coordinate_bodies().len();
    let mut state: Vec<f64> = (0..first_state(model) + model.states.len() + model.turn_references().len())
        .map(|_| random.random_range(-1.0..1.0))
        .collect();
    for position in state[..7 * n].chunks_mut(7) {
        let length = position[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
        position[3..].iter_mut().for_each(|e| *e /= length);
    }
    state
}

/// A point of given numbers, with parameters and inputs at their defaults.
pub fn point<F: Field>(
    model: &Model,
    context: F::Context,
    state: &[f64],
    t: f64,
    number: impl Fn(f64) -> F,
) -> Point<F> {
    let values = |fields: &[gyro_model::Parameter]| fields.iter().map(|f| number(to_f64(&f.value))).collect();
    Point {
        context,
        t: number(t),
        state: state.iter().map(|&x| number(x)).collect(),
        parameters: values(&model.parameters),
        inputs: values(&model.inputs),
    }
}
