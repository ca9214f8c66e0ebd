//! The states at which rounding is measured.

use crate::module::Module;
use chacha20::ChaCha8Rng;
use gyro_model::Model;
use rand::{RngExt, SeedableRng};
use std::fmt;
use std::ops::Range;

/// A kind of states.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Near the start: joints violated by about 1e-7, speeds of order one.
    NearStart,
    /// Anything between −1 and 1, rates up to the largest of the start's if that is more.
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

/// A time of the run, up to its end, and a state.
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
    /// By how much the rows are asked to change, each number one of `f32`.
    pub changes: Vec<f64>,
    /// A joint state, raw like the state; empty where there are no joint coordinates.
    pub raw_joints: Vec<f64>,
    /// The joint state in `f64`.
    pub joints: Vec<f64>,
}

/// How far near states are from the start.
const NEAR: f64 = 1e-7;

/// Logarithm to base ten of the largest number of extreme states, and of the reciprocal of the smallest.
const EXTREME: f64 = 6.0;

/// Some states of each kind.
pub fn draw(model: &Model, module: &Module, states: usize, seed: u64) -> Vec<Sample> {
    let mut streams = [0, 1, 2].map(|stream| ChaCha8Rng::seed_from_u64(seed + (stream << 32)));
    let kinds = Kind::ALL.into_iter().flat_map(|kind| (0..states).map(move |_| kind));
    kinds.map(|kind| sample(model, module, kind, &mut streams)).collect()
}

fn sample(
    model: &Model,
    module: &Module,
    kind: Kind,
    [random, of_joints, of_rows]: &mut [ChaCha8Rng; 3],
) -> Sample {
    let n = model.coordinate_bodies().len();
    let euler: Vec<usize> = (0..n).map(|moving_body| 7 * moving_body + 3).collect();
    let raw = raw(kind, &module.start, &euler, 7 * n..13 * n, random);
    let (rates, euler_of_joints) = module.joints.as_ref().map_or_else(
        || (0..0, Vec::new()),
        |layout| (layout.n_coordinates..layout.n_motion(), layout.euler().collect()),
    );
    let raw_joints = self::raw(kind, &module.joint_start, &euler_of_joints, rates, of_joints);
    let t = to_single(model.simulation.t_end * random.random_range(0.0..=1.0));
    let (state, joints) = (of_length_one(&raw, &euler), of_length_one(&raw_joints, &euler_of_joints));
    let zeros = vec![0.0; model.rows().len()];
    let changes = self::raw(kind, &zeros, &[], 0..zeros.len(), of_rows);
    Sample { kind, t, raw, state, changes, raw_joints, joints }
}

/// Numbers of a kind; `euler` says where Euler parameters start, `rates` where velocities are.
fn raw(kind: Kind, start: &[f64], euler: &[usize], rates: Range<usize>, random: &mut ChaCha8Rng) -> Vec<f64> {
    let fastest = start[rates.clone()].iter().fold(1.0_f64, |fastest, rate| fastest.max(rate.abs()));
    let number = |(place, start): (usize, &f64)| {
        let is_euler = euler.iter().any(|&first| (first..first + 4).contains(&place));
        let unit = random.random_range(-1.0..1.0);
        to_single(match kind {
            Kind::NearStart if rates.contains(&place) => unit,
            Kind::NearStart => start + NEAR * unit,
            Kind::Extreme if !is_euler => unit.signum() * 10.0_f64.powf(EXTREME * unit),
            Kind::Random if rates.contains(&place) => fastest * unit,
            Kind::Random | Kind::Extreme => unit,
        })
    };
    start.iter().enumerate().map(number).collect()
}

fn of_length_one(raw: &[f64], euler: &[usize]) -> Vec<f64> {
    let mut state = raw.to_vec();
    for &first in euler {
        let p = &mut state[first..first + 4];
        let length = p.iter().map(|e| e * e).sum::<f64>().sqrt();
        p.iter_mut().for_each(|e| *e /= length);
    }
    state
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
fn to_single(x: f64) -> f64 {
    f64::from(x as f32)
}
