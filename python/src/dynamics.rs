//! A mechanism in joint coordinates with the buffers that its functions need: for one state at a time, and for two.

use gyro_jit::{Compiled, NotCompiled};
use gyro_model::Model;
use gyro_runner::Start;
use gyro_runner::motion::joints_near;
use gyro_sim::lanes::f64x2;
use gyro_sim::{Joint, JointPlace, JointSpace, Mechanism as _, Rk4};
use std::ops::Range;

/// Computes from positions x, rates u and inputs.
#[derive(Clone, Debug)]
pub(crate) struct Dynamics {
    pub(crate) mechanism: Compiled<f64>,
    pub(crate) n_x: usize,
    pub(crate) n_u: usize,
    /// What the inputs are unless something else is given: the model file's.
    pub(crate) defaults: Vec<f64>,
    /// What they are set to.
    inputs: Vec<f64>,
    /// (x, u), then the work where there is some, on which nothing depends.
    state: Vec<f64>,
    rates: Vec<f64>,
    slope: Vec<f64>,
}

impl Dynamics {
    /// Of a compiled mechanism that has joint coordinates, with the values of its parameters.
    pub(crate) fn new(mut mechanism: Compiled<f64>, model: &Model) -> Self {
        for (index, parameter) in model.parameters.iter().enumerate() {
            mechanism.set_parameter(index, gyro_model::to_f64(&parameter.value));
        }
        let (state, layout) = (mechanism.joint_start(), mechanism.joint_layout());
        let (n_x, n_u) = (layout.n_coordinates(), layout.n_rates());
        let defaults: Vec<f64> = model.inputs.iter().map(|input| gyro_model::to_f64(&input.value)).collect();
        Self {
            n_x,
            n_u,
            inputs: defaults.clone(),
            defaults,
            slope: state.clone(),
            rates: vec![0.0; n_u],
            state,
            mechanism,
        }
    }

    /// Sets the inputs.
    pub(crate) fn set_inputs(&mut self, inputs: &[f64]) {
        for (index, (now, &then)) in self.inputs.iter_mut().zip(inputs).enumerate() {
            if now.to_bits() != then.to_bits() {
                *now = then;
                self.mechanism.set_input(index, then);
            }
        }
    }

    /// Sets them to the model file's values.
    pub(crate) fn reset_inputs(&mut self) {
        let defaults = std::mem::take(&mut self.defaults);
        self.set_inputs(&defaults);
        self.defaults = defaults;
    }

    /// u̇.
    pub(crate) fn accelerations(&mut self, t: f64, (x, u): (&[f64], &[f64]), out: &mut [f64]) {
        self.state[..self.n_x].copy_from_slice(x);
        self.state[self.n_x..self.n_x + self.n_u].copy_from_slice(u);
        self.mechanism.joint_accelerations(t, &self.state, &mut self.rates);
        out.copy_from_slice(&self.rates);
    }

    /// The derivative of (x, u).
    pub(crate) fn derivative(&mut self, t: f64, state: &[f64], out: &mut [f64]) {
        let n = self.n_x + self.n_u;
        self.state[..n].copy_from_slice(state);
        self.mechanism.joint_derivative(t, &self.state, &mut self.slope);
        out.copy_from_slice(&self.slope[..n]);
    }

    /// (x, u) with the work, if any.
    pub(crate) fn whole(&self, state: &[f64]) -> Vec<f64> {
        let mut whole = self.mechanism.joint_start();
        whole[..state.len()].copy_from_slice(state);
        whole[state.len()..].fill(0.0);
        whole
    }

    /// (x, u) of where a run starts.
    pub(crate) fn start(&self, start: &Start) -> Vec<f64> {
        let mut y = self.mechanism.start();
        let known = start.positions.len() + start.velocities.len();
        for (element, value) in y[..known].iter_mut().zip(start.positions.iter().chain(&start.velocities)) {
            *element = *value;
        }
        let references = y.len() - start.turn_references.len();
        y[references..].copy_from_slice(&start.turn_references);
        let mut x = joints_near(&self.mechanism, 0.0, &y, &start.angles);
        x.truncate(self.n_x + self.n_u);
        x
    }

    /// For each coordinate of each joint the angle that a joint state has; zero for others.
    pub(crate) fn angles(&self, state: &[f64]) -> Vec<f64> {
        let joints = self.mechanism.description().joints;
        let before =
            |joint: usize| joints[..joint].iter().map(|joint| joint.coordinates.len()).sum::<usize>();
        let mut angles = vec![0.0; before(joints.len())];
        let mut at = 0;
        for place in self.mechanism.joint_layout().places {
            if let JointPlace::Scalar { joint, coordinate } = *place {
                angles[before(joint.into()) + usize::from(coordinate)] = state[at];
            }
            at += place.n_coordinates();
        }
        angles
    }
}

/// The same in two lanes, with the bits of two states one by one.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    mechanism: Compiled<f64x2>,
    n_x: usize,
    inputs: Vec<[f64; 2]>,
    state: Vec<f64x2>,
    rates: Vec<f64x2>,
    method: Rk4<Vec<f64x2>>,
}

impl Pair {
    /// With the parameters and inputs as they are.
    pub(crate) fn of(dynamics: &Dynamics) -> Result<Self, NotCompiled> {
        let mechanism = dynamics.mechanism.compiled::<f64x2>()?;
        let (state, rates) = (mechanism.joint_start(), mechanism.joint_buffers().rates);
        let inputs = dynamics.defaults.iter().map(|&value| [value; 2]).collect();
        Ok(Self { method: Rk4::new(&state), mechanism, n_x: dynamics.n_x, inputs, state, rates })
    }

    /// Sets a parameter for both.
    pub(crate) fn set_parameter(&mut self, index: usize, value: f64) {
        self.mechanism.set_parameter(index, f64x2::splat(value));
    }

    /// Sets the inputs of each lane.
    pub(crate) fn set_inputs(&mut self, inputs: [&[f64]; 2]) {
        for (index, now) in self.inputs.iter_mut().enumerate() {
            let then = inputs.map(|inputs| inputs[index]);
            if now.map(f64::to_bits) != then.map(f64::to_bits) {
                *now = then;
                self.mechanism.set_input(index, f64x2::new(then));
            }
        }
    }

    /// u̇ of both.
    pub(crate) fn accelerations(&mut self, t: f64, x: [&[f64]; 2], u: [&[f64]; 2], out: [&mut [f64]; 2]) {
        let (of_x, of_u) = self.state.split_at_mut(self.n_x);
        for (to, of) in [(of_x, x), (of_u, u)] {
            for ((to, a), b) in to.iter_mut().zip(of[0]).zip(of[1]) {
                *to = f64x2::new([*a, *b]);
            }
        }
        self.mechanism.joint_accelerations(f64x2::splat(t), &self.state, &mut self.rates);
        let [first, second] = out;
        for ((rate, a), b) in self.rates.iter().zip(first).zip(second) {
            [*a, *b] = rate.to_array();
        }
    }
}

impl Pair {
    /// Both of two states (x, u) by so many steps h; of trees, as no loop is closed.
    pub(crate) fn advance(&mut self, (from, h): (f64, f64), steps: Range<u64>, [a, b]: [&mut [f64]; 2]) {
        let n = a.len().min(b.len()).min(self.state.len());
        self.state[n..].fill(f64x2::splat(0.0));
        for ((to, a), b) in self.state.iter_mut().zip(&*a).zip(&*b) {
            *to = f64x2::new([*a, *b]);
        }
        for step in steps {
            #[expect(clippy::cast_precision_loss, reason = "step numbers stay below 2⁵³")]
            let t = f64x2::splat(from + step as f64 * h);
            self.method.step(&Joint, &self.mechanism, t, f64x2::splat(h), &mut self.state);
        }
        for ((from, a), b) in self.state.iter().zip(a).zip(b) {
            [*a, *b] = from.to_array();
        }
    }
}

/// Names of the numbers of x and of u.
pub(crate) fn names(mechanism: &Compiled<f64>, model: &Model) -> (Vec<String>, Vec<String>) {
    let shown = gyro_cli::library::coordinates(model);
    let (mut x, mut u) = (Vec::new(), Vec::new());
    let numbered =
        |name: &str, parts: &[&str]| parts.iter().map(|part| format!("{name} {part}")).collect::<Vec<_>>();
    const PARAMETERS: [&str; 4] = ["e0", "e1", "e2", "e3"];
    const AXES: [&str; 3] = ["x", "y", "z"];
    for place in mechanism.joint_layout().places {
        match *place {
            JointPlace::Scalar { joint, coordinate } => {
                let mut own = shown.iter().filter(|s| s.joint == usize::from(joint) && !s.is_orientation());
                let name = own.nth(coordinate.into()).map_or(String::new(), |shown| shown.name.clone());
                u.push(format!("{name} rate"));
                x.push(name);
            }
            JointPlace::Orientation { joint } => {
                let name = &model.joints[usize::from(joint)].name;
                x.extend(numbered(name, &PARAMETERS));
                u.extend(numbered(name, &["rate x", "rate y", "rate z"]));
            }
            JointPlace::Body { body } => {
                let name = &model.bodies[model.coordinate_bodies()[usize::from(body)]].name;
                x.extend(numbered(name, &AXES));
                x.extend(numbered(name, &PARAMETERS));
                u.extend(numbered(name, &["velocity x", "velocity y", "velocity z"]));
                u.extend(numbered(
                    name,
                    &["angular velocity x'", "angular velocity y'", "angular velocity z'"],
                ));
            }
        }
    }
    (x, u)
}
