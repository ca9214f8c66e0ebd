//! A linear plant under sampled controllers over the time after which all sample together again, exactly.
//!
//! The state is (x, what the inputs hold, what is computed and waits, the controllers' memory). Between two instants x
//! follows the exponential of `[A B; 0 0]`; at an instant the rest is set by linear maps. Their product is the map over
//! the period.

use crate::eigenvalues;
use gyro_runner::{Controller, Wiring};
use nalgebra::{Complex, DMatrix};
use std::collections::HashMap;

/// The plant as controllers see it.
#[derive(Clone, Debug)]
pub(super) struct Plant {
    pub(super) by_state: DMatrix<f64>,
    /// A column for each input of each controller, one after the other.
    pub(super) by_inputs: DMatrix<f64>,
    /// For each number that they see, one controller after the other: what it is by the state and by these inputs.
    pub(super) seen: Vec<(Vec<f64>, Vec<f64>)>,
}

/// The map over one period, with the loops closed; and what to open one.
#[derive(Clone, Debug)]
pub(super) struct Discrete<'a> {
    plant: &'a Plant,
    controllers: &'a [Controller],
    parts: Vec<Part>,
    instants: Vec<Instant>,
    size: usize,
    pub(super) period: f64,
}

/// A loop that was opened where its controller hands on what it has computed, w: `x ← F x + G w`, with H x what it
/// computes.
#[derive(Clone, Debug)]
pub(super) struct Opened {
    pub(super) f: DMatrix<f64>,
    pub(super) g: DMatrix<f64>,
    pub(super) h: DMatrix<f64>,
}

/// Where the numbers of a controller stand.
#[derive(Clone, Copy, Debug)]
struct Part {
    seen: usize,
    held: usize,
    computed: usize,
    memory: usize,
}

/// What happens at a time, in units of a period: who takes effect, and who samples.
#[derive(Clone, Debug, Default)]
struct Instant {
    t: f64,
    effects: Vec<usize>,
    samples: Vec<usize>,
}

/// More instants in a period than this are not multiplied out.
const MOST_INSTANTS: usize = 4000;

impl<'a> Discrete<'a> {
    pub(super) fn new(plant: &'a Plant, controllers: &'a [Controller]) -> Result<Self, String> {
        let n = plant.by_state.nrows();
        let m = plant.by_inputs.ncols();
        let mut at = Part { seen: 0, held: n, computed: n + m, memory: n + 2 * m };
        let mut parts = Vec::new();
        for controller in controllers {
            parts.push(at);
            at.seen += controller.outputs.len();
            at.held += controller.inputs.len();
            at.computed += controller.inputs.len();
            at.memory += memory(controller);
        }
        let (instants, period) = instants(controllers)?;
        Ok(Self { plant, controllers, parts, instants, size: at.memory, period })
    }

    /// The poles, those at zero of numbers that nothing depends on left out, the largest first.
    pub(super) fn poles(&self) -> Vec<Complex<f64>> {
        let (map, _) = self.map(None);
        let map = map.columns(0, self.size).into_owned();
        // What the map does not depend on adds nothing but a pole at zero.
        let mut kept: Vec<usize> = (0..self.size).collect();
        loop {
            let used = |&column: &usize| kept.iter().any(|&row| map[(row, column)] != 0.0);
            let left: Vec<usize> = kept.iter().filter(|column| used(column)).copied().collect();
            if left.len() == kept.len() {
                break;
            }
            kept = left;
        }
        let reduced = DMatrix::from_fn(kept.len(), kept.len(), |i, j| map[(kept[i], kept[j])]);
        let mut poles = eigenvalues::of(&reduced);
        poles.sort_by(|a, b| b.norm().total_cmp(&a.norm()).then(b.im.total_cmp(&a.im)));
        poles
    }

    /// The loop of a controller of one input, opened; all others are closed. It samples once in a period.
    pub(super) fn opened(&self, index: usize) -> Opened {
        let (map, computed) = self.map(Some(index));
        let n = self.size;
        Opened {
            f: map.columns(0, n).into_owned(),
            g: map.columns(n, 1).into_owned(),
            h: computed.columns(0, n).into_owned(),
        }
    }

    /// The state after a period by the state before it and, in the last column, by w, which one controller hands on in
    /// place of what it has computed; and what this is.
    fn map(&self, opened: Option<usize>) -> (DMatrix<f64>, DMatrix<f64>) {
        let mut now = DMatrix::identity(self.size, self.size + 1);
        let mut computed = DMatrix::zeros(1, self.size + 1);
        let mut flows: HashMap<u64, DMatrix<f64>> = HashMap::new();
        for (k, instant) in self.instants.iter().enumerate() {
            let seen: Vec<_> = (0..self.plant.seen.len()).map(|row| self.seen(&now, row)).collect();
            for &index in &instant.effects {
                self.take_effect(&mut now, index);
            }
            for &index in &instant.samples {
                self.sample(&mut now, &seen, index);
                if opened == Some(index) {
                    let row = self.parts[index].computed;
                    computed.copy_from(&now.rows(row, 1));
                    now.row_mut(row).fill(0.0);
                    now[(row, self.size)] = 1.0;
                }
                if self.controllers[index].delay == 0.0 {
                    self.take_effect(&mut now, index);
                }
            }
            let next = self.instants.get(k + 1).map_or(1.0, |next| next.t);
            let dt = (next - instant.t) * self.period;
            let flow = flows.entry(dt.to_bits()).or_insert_with(|| self.flow(dt));
            let (n, m) = (self.plant.by_state.nrows(), self.plant.by_inputs.ncols());
            let moved = flow.rows(0, n) * now.rows(0, n + m);
            now.rows_mut(0, n).copy_from(&moved);
        }
        (now, computed)
    }

    fn flow(&self, dt: f64) -> DMatrix<f64> {
        let (n, m) = (self.plant.by_state.nrows(), self.plant.by_inputs.ncols());
        let mut whole = DMatrix::zeros(n + m, n + m);
        whole.view_mut((0, 0), (n, n)).copy_from(&self.plant.by_state);
        whole.view_mut((0, n), (n, m)).copy_from(&self.plant.by_inputs);
        (whole * dt).exp()
    }

    /// What a number that is seen depends on.
    fn seen(&self, now: &DMatrix<f64>, row: usize) -> DMatrix<f64> {
        let (by_state, by_inputs) = &self.plant.seen[row];
        let all = by_state.iter().chain(by_inputs).enumerate().filter(|(_, factor)| **factor != 0.0);
        all.fold(DMatrix::zeros(1, self.size + 1), |sum, (k, factor)| sum + now.rows(k, 1) * *factor)
    }

    fn take_effect(&self, now: &mut DMatrix<f64>, index: usize) {
        let (part, n) = (self.parts[index], self.controllers[index].inputs.len());
        let computed = now.rows(part.computed, n).into_owned();
        now.rows_mut(part.held, n).copy_from(&computed);
    }

    /// The law, of the errors −y.
    fn sample(&self, now: &mut DMatrix<f64>, seen: &[DMatrix<f64>], index: usize) {
        let (controller, part) = (&self.controllers[index], self.parts[index]);
        let error = |k: usize| -&seen[part.seen + k];
        match &controller.law {
            Wiring::Pid([kp, ki, kd]) => {
                let period = controller.period_s();
                let integral = now.rows(part.memory, 1) + error(0) * (ki * period);
                let change = error(0) - now.rows(part.memory + 1, 1);
                let computed = error(0) * *kp + change * (kd / period) + &integral;
                now.rows_mut(part.memory, 1).copy_from(&integral);
                now.rows_mut(part.memory + 1, 1).copy_from(&error(0));
                now.rows_mut(part.computed, 1).copy_from(&computed);
            }
            Wiring::StateFeedback(rows) => {
                for (k, row) in rows.iter().enumerate() {
                    let terms = row.iter().enumerate().filter(|(_, gain)| **gain != 0.0);
                    let zero = DMatrix::zeros(1, self.size + 1);
                    let computed = terms.fold(zero, |sum, (l, gain)| sum + error(l) * *gain);
                    now.rows_mut(part.computed + k, 1).copy_from(&computed);
                }
            }
            Wiring::TransferFunction(over, under) => {
                let first = under.first().copied().unwrap_or(1.0);
                let of = |from: &[f64], k: usize| from.get(k).map_or(0.0, |x| x / first);
                let n = memory(controller);
                let before = |now: &DMatrix<f64>, k: usize| match k < n {
                    true => now.rows(part.memory + k, 1).into_owned(),
                    false => DMatrix::zeros(1, self.size + 1),
                };
                let computed = error(0) * of(over, 0) + before(now, 0);
                for k in 0..n {
                    let next = error(0) * of(over, k + 1) - &computed * of(under, k + 1) + before(now, k + 1);
                    now.rows_mut(part.memory + k, 1).copy_from(&next);
                }
                now.rows_mut(part.computed, 1).copy_from(&computed);
            }
        }
    }
}

/// How many numbers a controller remembers.
fn memory(controller: &Controller) -> usize {
    match &controller.law {
        Wiring::Pid(_) => 2,
        Wiring::StateFeedback(_) => 0,
        Wiring::TransferFunction(over, under) => over.len().max(under.len()).saturating_sub(1),
    }
}

/// All instants of the least time after which all controllers sample together again, and that time, s.
fn instants(controllers: &[Controller]) -> Result<(Vec<Instant>, f64), String> {
    let too_long = || {
        "the controllers sample together too seldom: choose periods with a short common multiple".to_owned()
    };
    let multiple = |a: u128, b: u128| (a / gcd(a, b)).checked_mul(b);
    // Over a common denominator periods are whole numbers.
    let denominators = controllers.iter().map(|controller| u128::from(controller.period[1]));
    let denominator = denominators.clone().try_fold(1, multiple).ok_or_else(too_long)?;
    let periods: Option<Vec<u128>> = controllers
        .iter()
        .zip(denominators)
        .map(|(controller, own)| u128::from(controller.period[0]).checked_mul(denominator / own))
        .collect();
    let periods = periods.ok_or_else(too_long)?;
    let whole = periods.iter().copied().try_fold(1, multiple).ok_or_else(too_long)?;
    let n_samples = periods.iter().map(|period| whole / period).sum::<u128>();
    if n_samples > MOST_INSTANTS as u128 {
        return Err(too_long());
    }
    let mut instants: Vec<Instant> = Vec::new();
    #[expect(clippy::cast_precision_loss, reason = "a fraction that is rounded once")]
    for (index, (controller, period)) in controllers.iter().zip(&periods).enumerate() {
        let ratio = controller.delay / controller.period_s();
        for k in 0..whole / period {
            let t = (k * period) as f64 / whole as f64;
            instants.push(Instant { t, samples: vec![index], ..Instant::default() });
            if controller.delay > 0.0 {
                let late = (k as f64 + ratio) * (*period as f64 / whole as f64);
                let t = if late >= 1.0 - CLOSE { 0.0 } else { late };
                instants.push(Instant { t, effects: vec![index], ..Instant::default() });
            }
        }
    }
    instants.sort_by(|a, b| a.t.total_cmp(&b.t));
    let mut merged: Vec<Instant> = Vec::new();
    for instant in instants {
        match merged.last_mut().filter(|last| instant.t - last.t <= CLOSE / n_samples as f64) {
            Some(last) => {
                last.effects.extend(instant.effects);
                last.samples.extend(instant.samples);
            }
            None => merged.push(instant),
        }
    }
    #[expect(clippy::cast_precision_loss, reason = "rounded once")]
    let period = whole as f64 / denominator as f64;
    Ok((merged, period))
}

/// Instants nearer to each other than this part of a period are one.
const CLOSE: f64 = 1e-9;

fn gcd(a: u128, b: u128) -> u128 {
    if b == 0 { a } else { gcd(b, a % b) }
}
