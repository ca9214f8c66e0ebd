//! A mechanism in joint coordinates with the buffers that its functions need.

use gyro_jit::Compiled;
use gyro_model::Model;
use gyro_runner::Start;
use gyro_runner::motion::joints_near;
use gyro_sim::{JointPlace, JointSpace, Mechanism as _};

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

    /// What they are set to.
    pub(crate) fn inputs(&self) -> &[f64] {
        &self.inputs
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
        let others = y.len() - start.n_others();
        y[others..].iter_mut().zip(start.others()).for_each(|(element, value)| *element = value);
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
            if let JointPlace::Scalar { joint, coordinate } | JointPlace::Turn { joint, coordinate } = *place
            {
                angles[before(joint.into()) + usize::from(coordinate)] = state[at];
            }
            at += place.n_coordinates();
        }
        angles
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
            JointPlace::Scalar { joint, coordinate } | JointPlace::Turn { joint, coordinate } => {
                let mut own = shown.iter().filter(|s| s.joint == usize::from(joint) && !s.is_orientation());
                let name = own.nth(coordinate.into()).map_or(String::new(), |shown| shown.name.clone());
                if place.n_rates() == 1 {
                    u.push(format!("{name} rate"));
                }
                x.push(name);
            }
            JointPlace::State { state } => x.push(model.states[usize::from(state)].name.clone()),
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
