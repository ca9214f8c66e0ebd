//! Linear plants in closed loops, exact between samples.

use chacha20::ChaCha8Rng;
use nalgebra::{DMatrix, DVector};
use rand::RngExt;
use serde_json::Value;
use std::fmt::Write as _;

/// Sledges in a row, each on the one before, with springs, dampers, gravity along the row and a motor each.
#[derive(Debug)]
pub(super) struct Plant {
    pub(super) masses: Vec<f64>,
    pub(super) stiffness: Vec<f64>,
    pub(super) damping: Vec<f64>,
    pub(super) gravity: f64,
    /// Positions and rates at the start.
    pub(super) start: Vec<f64>,
    /// Forces of the motors until they are set.
    pub(super) forces: Vec<f64>,
}

/// A controller as the test knows it.
#[derive(Debug)]
pub(super) struct Loop {
    pub(super) law: Law,
    /// The period, s, over whole numbers; the delay as so many tenths of it.
    pub(super) period: [u64; 2],
    pub(super) tenths: u64,
    pub(super) sees: Vec<usize>,
    pub(super) sets: Vec<usize>,
    pub(super) setpoints: Vec<f64>,
    pub(super) limits: Option<[f64; 2]>,
    pub(super) steps: [f64; 2],
}

#[derive(Debug)]
pub(super) enum Law {
    Pid([f64; 3]),
    StateFeedback(Vec<Vec<f64>>),
    TransferFunction(Vec<f64>, Vec<f64>),
}

impl Plant {
    pub(super) fn random(random: &mut ChaCha8Rng) -> Self {
        let n = random.random_range(1..=3);
        let mut some = |from: f64, to: f64, n: usize| -> Vec<f64> {
            (0..n).map(|_| (random.random_range(from..to) * 1e3_f64).round() / 1e3).collect()
        };
        Self {
            masses: some(0.5, 3.0, n),
            stiffness: some(0.0, 30.0, n),
            damping: some(0.0, 2.0, n),
            gravity: some(-2.0, 2.0, 1)[0],
            start: some(-0.5, 0.5, 2 * n),
            forces: some(-1.0, 1.0, n),
        }
    }

    pub(super) fn n(&self) -> usize {
        self.masses.len()
    }

    /// Everything that a controller can see, by its name.
    pub(super) fn names(&self) -> Vec<String> {
        let own = (0..self.n()).flat_map(|k| [format!("slide_{k}"), format!("slide_{k} rate")]);
        own.chain(["tip.vx", "place.rx", "shake.ax"].map(str::to_owned)).collect()
    }

    /// d/dt of (positions, rates, 1) as a matrix, the forces being given.
    fn matrix(&self, forces: &[f64]) -> DMatrix<f64> {
        let n = self.n();
        let carried = |k: usize| self.masses[k..].iter().sum::<f64>();
        let inverse = DMatrix::from_fn(n, n, |i, j| carried(i.max(j))).try_inverse().unwrap();
        let mut whole = DMatrix::zeros(2 * n + 1, 2 * n + 1);
        for i in 0..n {
            whole[(i, n + i)] = 1.0;
            for j in 0..n {
                whole[(n + i, j)] = -inverse[(i, j)] * self.stiffness[j];
                whole[(n + i, n + j)] = -inverse[(i, j)] * self.damping[j];
                whole[(n + i, 2 * n)] += inverse[(i, j)] * (forces[j] + self.gravity * carried(j));
            }
        }
        whole
    }

    fn see(&self, z: &DVector<f64>, forces: &[f64]) -> Vec<f64> {
        let n = self.n();
        let slopes = self.matrix(forces) * z;
        let sum = |of: &DVector<f64>, from: usize| (from..from + n).map(|k| of[k]).sum::<f64>();
        let own = (0..n).flat_map(|k| [z[k], z[n + k]]);
        own.chain([sum(z, n), sum(z, 0), sum(&slopes, n)]).collect()
    }

    pub(super) fn text(&self, loops: &[Loop], t_end: f64) -> String {
        let mut text = format!(
            "format = 1\nname = \"sledges\"\ngravity = [{:?}, 0, 0]\n[simulation]\nt_end = {t_end:?}\n[inputs]\n",
            self.gravity
        );
        for (k, force) in self.forces.iter().enumerate() {
            let _ = writeln!(text, "push_{k} = {force:?}");
        }
        text += "[[body]]\nname = \"body_0\"\nfixed = true\n";
        for k in 0..self.n() {
            let _ = write!(
                text,
                "[[body]]\nname = \"body_{}\"\nmass = {:?}\ninertia = [1, 1, 1]\n[[joint]]\nname = \"slide_{k}\"\n\
                 kind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = {{ body = \"body_{k}\" }}\n\
                 second = {{ body = \"body_{}\" }}\ndisplacement = {:?}\nrate = {:?}\n[[force]]\nname = \"spring_{k}\"\n\
                 kind = \"spring\"\njoint = \"slide_{k}\"\nstiffness = {:?}\n[[force]]\nname = \"damper_{k}\"\n\
                 kind = \"damper\"\njoint = \"slide_{k}\"\ndamping = {:?}\n[[force]]\nname = \"motor_{k}\"\nkind = \"motor\"\n\
                 joint = \"slide_{k}\"\nvalue = \"push_{k}\"\n",
                k + 1,
                self.masses[k],
                k + 1,
                self.start[k],
                self.start[self.n() + k],
                self.stiffness[k],
                self.damping[k],
            );
        }
        for (name, kind) in [("tip", "velocity"), ("place", "pose"), ("shake", "acceleration")] {
            let _ = write!(
                text,
                "[[output]]\nname = \"{name}\"\nkind = \"{kind}\"\nbody = \"body_{}\"\n",
                self.n()
            );
        }
        for (k, one) in loops.iter().enumerate() {
            let _ = writeln!(text, "[[controller]]\nname = \"loop_{k}\"");
            one.write(&self.names(), &mut text);
        }
        text
    }
}

impl Loop {
    pub(super) fn random(random: &mut ChaCha8Rng, plant: &Plant, sets: Vec<usize>) -> Self {
        let n_seen = plant.names().len();
        // A transfer function of an acceleration has a loop without delay: it is left to state feedback.
        let mut see = |most: usize| random.random_range(0..most);
        let (law, sees) = match see(3) {
            0 if sets.len() == 1 => (Law::Pid([3.0, 5.0, 0.1]), vec![see(n_seen - 1)]),
            1 if sets.len() == 1 => (
                Law::TransferFunction(vec![2.0, -0.5, 0.25], vec![1.25, -0.6, 0.1, 0.05]),
                vec![see(n_seen - 1)],
            ),
            _ => {
                let sees: Vec<usize> = (0..see(4) + 1).map(|_| see(n_seen)).collect();
                let rows = sets.iter().map(|_| sees.iter().map(|_| see(9) as f64 / 8.0 - 0.25).collect());
                (Law::StateFeedback(rows.collect()), sees)
            }
        };
        let number = |random: &mut ChaCha8Rng| (random.random_range(-1.0..1.0_f64) * 1e2).round() / 1e2;
        Self {
            setpoints: sees.iter().map(|_| number(random)).collect(),
            law,
            period: [random.random_range(1..=3), random.random_range(20..=90)],
            tenths: [0, 0, 3, 10][random.random_range(0..4)],
            sees,
            sets,
            limits: [None, Some([-2.0, 1.5])][random.random_range(0..2)],
            steps: [[0.0, 0.0], [0.01, 0.05]][random.random_range(0..2)],
        }
    }

    fn write(&self, names: &[String], text: &mut String) {
        let sees: Vec<&String> = self.sees.iter().map(|&k| &names[k]).collect();
        let sets: Vec<String> = self.sets.iter().map(|k| format!("push_{k}")).collect();
        let [n, d] = self.period;
        let _ = writeln!(text, "outputs = {sees:?}\ninputs = {sets:?}\nperiod = \"{n}/{d}\"");
        let _ = writeln!(text, "delay = \"{}/{}\"\nsetpoint = {:?}", n * self.tenths, 10 * d, self.setpoints);
        let [output_step, input_step] = self.steps;
        let _ = writeln!(text, "output_step = {output_step:?}\ninput_step = {input_step:?}");
        if let Some(limits) = self.limits {
            let _ = writeln!(text, "limits = {limits:?}");
        }
        let _ = match &self.law {
            Law::Pid([kp, ki, kd]) => writeln!(text, "kind = \"pid\"\nkp = {kp:?}\nki = {ki:?}\nkd = {kd:?}"),
            Law::StateFeedback(rows) => writeln!(text, "kind = \"state_feedback\"\ngains = {rows:?}"),
            Law::TransferFunction(over, under) => {
                writeln!(text, "kind = \"transfer_function\"\nnumerator = {over:?}\ndenominator = {under:?}")
            }
        };
    }

    /// What the law makes of the errors so far, the last being the present one, and of what it made of those before.
    fn compute(&self, errors: &[Vec<f64>], before: &[f64], integral: &mut f64) -> Vec<f64> {
        let (now, period) = (errors.last().unwrap(), self.period[0] as f64 / self.period[1] as f64);
        let past = |k: usize| errors.len().checked_sub(k + 1).map_or(0.0, |at| errors[at][0]);
        let cut = |u: f64| self.limits.map_or(u, |[least, largest]| u.clamp(least, largest));
        match &self.law {
            Law::Pid([kp, ki, kd]) => {
                let last = if errors.len() > 1 { past(1) } else { now[0] };
                let added = ki * period * now[0];
                let u = kp * now[0] + kd * (now[0] - last) / period + *integral + added;
                // It does not grow in the direction of a limit that holds.
                if cut(u) == u || (u - cut(u)) * added <= 0.0 {
                    *integral += added;
                }
                vec![cut(u)]
            }
            Law::StateFeedback(rows) => {
                rows.iter().map(|row| cut(row.iter().zip(now).map(|(k, e)| k * e).sum())).collect()
            }
            Law::TransferFunction(over, under) => {
                // As it is defined, from all that was before; `before` is what it made uncut.
                let made = |k: usize| before.len().checked_sub(k).map_or(0.0, |at| before[at]);
                let sum: f64 = over.iter().enumerate().map(|(k, b)| b * past(k)).sum();
                let fed: f64 = under.iter().enumerate().skip(1).map(|(k, a)| a * made(k)).sum();
                vec![(sum - fed) / under[0]]
            }
        }
    }
}

pub(super) fn rounded(value: f64, step: f64) -> f64 {
    if step > 0.0 { (value / step).round() * step } else { value }
}

/// The state and the forces after so many thousandths of a second, and before the end: a matrix exponential between
/// all times at which something happens.
pub(super) fn exact(plant: &Plant, loops: &[Loop], thousandths: u64) -> (DVector<f64>, Vec<f64>) {
    // All times in units of 1/(10 Π d) s: whole numbers.
    let unit: u128 = loops.iter().map(|one| u128::from(one.period[1])).product::<u128>() * 10_000;
    let end = u128::from(thousandths) * unit / 1000;
    let period = |one: &Loop| u128::from(one.period[0]) * unit / u128::from(one.period[1]);
    let mut z = DVector::from_vec([&plant.start[..], &[1.0]].concat());
    let mut forces = plant.forces.clone();
    let mut memory: Vec<(Vec<Vec<f64>>, Vec<f64>, f64)> = vec![Default::default(); loops.len()];
    // Times and values of what is yet to take effect.
    let mut waiting: Vec<(u128, usize, Vec<f64>)> = Vec::new();
    let mut now = 0_u128;
    loop {
        let seen = plant.see(&z, &forces);
        waiting.retain(|(at, k, values)| {
            if *at <= now {
                loops[*k].sets.iter().zip(values).for_each(|(&to, value)| forces[to] = *value);
            }
            *at > now
        });
        for (k, one) in loops.iter().enumerate().filter(|(_, one)| now.is_multiple_of(period(one))) {
            let errors =
                one.sees.iter().zip(&one.setpoints).map(|(&at, r)| r - rounded(seen[at], one.steps[0]));
            let (all, made, integral) = &mut memory[k];
            all.push(errors.collect());
            let values = one.compute(all, made, integral);
            made.push(values[0]);
            let cut = |u: f64| one.limits.map_or(u, |[least, largest]| u.clamp(least, largest));
            let values: Vec<f64> = values.iter().map(|u| rounded(cut(*u), one.steps[1])).collect();
            if one.tenths == 0 {
                one.sets.iter().zip(&values).for_each(|(&to, value)| forces[to] = *value);
            } else {
                waiting.push((now + period(one) * u128::from(one.tenths) / 10, k, values));
            }
        }
        if now == end {
            return (z, forces);
        }
        let samples = loops.iter().map(|one| (now / period(one) + 1) * period(one));
        let next = samples.chain(waiting.iter().map(|(at, ..)| *at)).chain([end]).min().unwrap();
        z = (plant.matrix(&forces) * ((next - now) as f64 / unit as f64)).exp() * z;
        now = next;
    }
}

/// The largest difference of a run, its positions, rates and forces, from the exact motion.
pub(super) fn difference(found: &Value, (z, forces): &(DVector<f64>, Vec<f64>)) -> f64 {
    let n = forces.len();
    let number = |value: &Value| value.as_f64().unwrap();
    let each = (0..n).flat_map(|k| {
        let joint = &found["joints"][format!("slide_{k}")];
        let force = number(&found["inputs"][format!("push_{k}")]);
        [number(&joint["position"]) - z[k], number(&joint["rate"]) - z[n + k], force - forces[k]]
    });
    each.map(f64::abs).fold(0.0, f64::max)
}

/// A wheel whose rate is held: an integrator, of which all margins are known.
pub(super) const WHEEL: &str = r#"format = 1
name = "wheel"
[parameters]
kp = 3
[inputs]
torque = 0
[[body]]
name = "ground"
fixed = true
[[body]]
name = "wheel"
mass = 1
inertia = [0.3, 0.3, 0.5]
[[joint]]
name = "shaft"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "wheel" }
[[force]]
name = "motor"
kind = "motor"
joint = "shaft"
value = "torque"
[[controller]]
name = "hold"
kind = "pid"
outputs = ["shaft rate"]
inputs = ["torque"]
period = 0.05
kp = "kp"
"#;
