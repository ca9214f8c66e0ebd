//! The states at which rounding is measured.

use crate::module::Module;
use gyro_model::Model;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::fmt;

/// A kind of states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Near the start: joints violated by about 1e-7, speeds of order one.
    NearStart,
    /// Anything between −1 and 1.
    Random,
    /// Speeds and distances between 1e-6 and 1e6.
    Extreme,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::NearStart, Self::Random, Self::Extreme];
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NearStart => "near the start",
            Self::Random => "random",
            Self::Extreme => "extreme",
        })
    }
}

/// A time and a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Which kind of state it is.
    pub kind: Kind,
    /// Time.
    pub t: f64,
    /// The state, each number one of `f32`; Euler parameters of any length, to be brought to length one.
    pub raw: Vec<f64>,
    /// The state in `f64`: Euler parameters of length one to rounding.
    pub state: Vec<f64>,
}

/// How far near states are from the start.
const NEAR: f64 = 1e-7;

/// Logarithm to base ten of the largest number of extreme states, and of the reciprocal of the smallest.
const EXTREME: f64 = 6.0;

/// Some states of each kind.
pub fn draw(model: &Model, module: &Module, states: usize, seed: u64) -> Vec<Sample> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let kinds = Kind::ALL.into_iter().flat_map(|kind| (0..states).map(move |_| kind));
    kinds.map(|kind| sample(model, module, kind, &mut random)).collect()
}

fn sample(model: &Model, module: &Module, kind: Kind, random: &mut ChaCha8Rng) -> Sample {
    let n = model.coordinate_bodies().len();
    let raw: Vec<f64> = (module.start.iter().enumerate())
        .map(|(place, start)| {
            let is_euler = place < 7 * n && place % 7 >= 3;
            let is_velocity = (7 * n..13 * n).contains(&place);
            let unit = random.random_range(-1.0..1.0);
            to_single(match kind {
                Kind::NearStart if is_velocity => unit,
                Kind::NearStart => start + NEAR * unit,
                Kind::Extreme if !is_euler => unit.signum() * 10.0_f64.powf(EXTREME * unit),
                Kind::Random | Kind::Extreme => unit,
            })
        })
        .collect();
    let mut state = raw.clone();
    for position in state[..7 * n].chunks_mut(7) {
        let length = position[3..].iter().map(|e| e * e).sum::<f64>().sqrt();
        position[3..].iter_mut().for_each(|e| *e /= length);
    }
    Sample { kind, t: to_single(random.random_range(0.0..1.0)), raw, state }
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
fn to_single(x: f64) -> f64 {
    f64::from(x as f32)
}
