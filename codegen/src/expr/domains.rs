//! The values that variables take in the runs of a mechanism: where the rounding of expressions is tried.
//!
//! Times reach to the end of the run, parameters are near their values, rates are small and large, coordinates are
//! anywhere where the mechanism may be. All is drawn by a fixed hash: a domain is the same on every machine.

use crate::expr::symbol::Symbol;
use gyro_model::{Model, Spline, to_f64};
use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::hash::{Hash, Hasher};
use std::sync::Arc;

/// How many points of the domain are tried.
pub const POINTS: u32 = 16;

/// Decades of early times, and of speeds about their size.
const EARLY: f64 = 4.0;
const SPEEDS: f64 = 2.0;

/// What is known of a mechanism's variables. Of a mechanism of which nothing is known, all are of order one.
#[derive(Clone, Debug)]
pub struct Domains {
    /// When the run ends, s.
    t_end: f64,
    /// Of the mechanism, m.
    size: f64,
    parameters: Vec<f64>,
    inputs: Vec<f64>,
    tables: Vec<Spline>,
    /// Where states start.
    states: Vec<f64>,
    /// Tables of curves that are called, by their places among all tables.
    pub curves: Arc<[Spline]>,
    /// Of joint coordinates a value and the largest distance from it.
    coordinates: BTreeMap<usize, (f64, f64)>,
    /// Rates at the start.
    rates: Vec<f64>,
    /// The first of each four joint coordinates that are Euler parameters.
    orientations: Vec<usize>,
    /// At each point the values of variables that follow from others.
    pub known: Vec<HashMap<Symbol, f64>>,
}

impl Default for Domains {
    fn default() -> Self {
        let (coordinates, orientations) = (BTreeMap::new(), Vec::new());
        let (parameters, inputs, rates) = (Vec::new(), Vec::new(), Vec::new());
        let (tables, states, known) = (Vec::new(), Vec::new(), Vec::new());
        let (t_end, size, curves) = (1.0, 1.0, Arc::from([]));
        Self {
            t_end,
            size,
            parameters,
            inputs,
            tables,
            states,
            curves,
            coordinates,
            rates,
            orientations,
            known,
        }
    }
}

impl Domains {
    pub fn of(model: &Model) -> Self {
        let parameters = model.parameters.iter().map(|parameter| to_f64(&parameter.value)).collect();
        let inputs = model.inputs.iter().map(|input| to_f64(&input.value)).collect();
        Self { t_end: model.simulation.t_end, size: model.size(), parameters, inputs, ..Self::default() }
    }

    /// From now on joint coordinates are within a distance of a value, rates go by those of the start, and the four
    /// coordinates from each place of `orientations` on are Euler parameters.
    pub fn set_joints(&mut self, near: BTreeMap<usize, (f64, f64)>, rates: &[f64], orientations: Vec<usize>) {
        (self.coordinates, self.rates, self.orientations) = (near, rates.to_vec(), orientations);
    }

    pub fn set_states(&mut self, states: &[f64]) {
        self.states = states.to_vec();
    }

    pub fn set_tables(&mut self, tables: &[&Spline]) {
        self.tables = tables.iter().map(|&table| table.clone()).collect();
    }

    /// The value of a variable at a point of the domain.
    pub fn value(&self, symbol: Symbol, point: u32) -> f64 {
        if let Some(&value) = self.known.get(point as usize).and_then(|known| known.get(&symbol)) {
            return value;
        }
        let between = between(u64::from(point), symbol);
        match symbol {
            Symbol::Time => self.time(point),
            Symbol::Position { .. } => self.size * between,
            Symbol::Euler { moving_body, k } => {
                let part = |k| self::between(u64::from(point), Symbol::Euler { moving_body, k });
                part(k) / norm([0, 1, 2, 3].map(part))
            }
            Symbol::Velocity { .. } => self.size * speed(point) * between,
            Symbol::Spin { .. } => speed(point) * between,
            Symbol::Rate(u) => {
                self.rates.get(u).map_or(1.0, |rate| rate.abs().max(1.0)) * speed(point) * between
            }
            Symbol::RateOfRate(_) | Symbol::Acceleration { .. } | Symbol::LoopMultiplier(_) => {
                speed(point).powi(2) * between
            }
            Symbol::Parameter(index) => near(self.parameters.get(index), point, between),
            Symbol::Input(index) => self.input(index, point, between),
            Symbol::State(state) => {
                let start = self.states.get(state).copied().unwrap_or(0.0);
                start + start.abs().max(1.0) * between
            }
            Symbol::Turn(_) | Symbol::Angle(_) => PI * between,
            Symbol::Table { table, order } => match self.tables.get(table) {
                Some(table) => table.value(self.time(point)).get(order).copied().unwrap_or(between),
                None => between,
            },
            Symbol::Coordinate(x) => self.coordinate(x, point, between),
            Symbol::Sine(x) => self.value(Symbol::Coordinate(x), point).sin(),
            Symbol::Cosine(x) => self.value(Symbol::Coordinate(x), point).cos(),
            _ => between,
        }
    }

    /// From the end of the run back to its start, and ever nearer to that.
    fn time(&self, point: u32) -> f64 {
        let part = f64::from(point / 2) / f64::from(POINTS / 2);
        self.t_end * if point.is_multiple_of(2) { 1.0 - part } else { 10.0_f64.powf(-EARLY * part) }
    }

    fn input(&self, index: usize, point: u32, between: f64) -> f64 {
        let value = self.inputs.get(index).copied().unwrap_or(0.0);
        if point.is_multiple_of(4) { value } else { value + value.abs().max(1.0) * between }
    }

    fn coordinate(&self, x: usize, point: u32, between: f64) -> f64 {
        let drawn = |x, between| {
            let (middle, distance) = self.coordinates.get(&x).copied().unwrap_or((0.0, 1.0));
            middle + distance * between
        };
        let Some(&first) = self.orientations.iter().find(|&&first| (first..first + 4).contains(&x)) else {
            return drawn(x, between);
        };
        let part = |k| drawn(first + k, self::between(u64::from(point), Symbol::Coordinate(first + k)));
        part(x - first) / norm([0, 1, 2, 3].map(part))
    }
}

fn norm(p: [f64; 4]) -> f64 {
    p.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The value of a parameter, or half to twice as much.
fn near(value: Option<&f64>, point: u32, between: f64) -> f64 {
    let value = value.copied().unwrap_or(1.0);
    if point.is_multiple_of(2) { value } else { value * between.exp2() }
}

/// Rates of a point: slow and fast ones in turn.
fn speed(point: u32) -> f64 {
    10.0_f64.powf(SPEEDS * (f64::from(point * 7 % POINTS) / f64::from(POINTS) - 0.5))
}

/// A reproducible number between −1 and 1 for each symbol.
pub fn between(seed: u64, symbol: Symbol) -> f64 {
    let mut mixing = Mixing(mix(seed));
    symbol.hash(&mut mixing);
    #[expect(clippy::cast_precision_loss, reason = "a random fraction")]
    let fraction = (mixing.finish() >> 11) as f64 / (1u64 << 53) as f64;
    2.0 * fraction - 1.0
}

/// A hash that is the same on all machines.
struct Mixing(u64);

impl Hasher for Mixing {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(u64::from(byte)));
    }

    fn write_u64(&mut self, x: u64) {
        self.0 = mix(self.0 ^ x);
    }

    fn write_usize(&mut self, x: usize) {
        self.write_u64(x as u64);
    }

    fn write_isize(&mut self, x: isize) {
        self.write_u64(x as u64);
    }
}

/// A number that looks random (splitmix64).
pub fn mix(x: u64) -> u64 {
    let mut z = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
