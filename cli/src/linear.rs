//! Linear theory of any tree of revolute joints: the motion linearised about the angles and the fast rates of its
//! start.
//!
//! With `x` the departure of joint angles and rates from there, `ẋ = f₀ + A x`; `f₀` and `A` are taken from the
//! runtime-assembled model, `A` by central differences of sixth order. At the start `x` holds the slow rates: a
//! gyroscope that is kicked departs from its spin. The response follows from the matrix exponential of `[A f₀; 0 0]`.
//! Nothing here knows what the mechanism is.

use crate::eigenvalues;
use gyro_assembled::Careful;
use gyro_model::{
    Joint, JointKind, JointStartSpec, Model, Number, Quaternion, Rational, Support, Tree, Vector,
};
use gyro_sim::{Dynamics, Mechanism};
use nalgebra::{DMatrix, DVector};

/// A mechanism linearised about its start.
#[derive(Clone, Debug)]
pub(crate) struct Linear {
    /// Indices of the revolute joints.
    joints: Vec<usize>,
    /// Their angles and rates where the mechanism is linearised.
    base: DVector<f64>,
    /// The departure from there at the start.
    x0: DVector<f64>,
    f0: DVector<f64>,
    a: DMatrix<f64>,
}

/// What linear theory says of the joint angles.
#[derive(Clone, Debug)]
pub(crate) struct Response {
    /// Indices of the joints.
    pub(crate) joints: Vec<usize>,
    /// For each of them the angle at each sample time, rad.
    pub(crate) angles: Vec<Vec<f64>>,
}

/// A rate below this part of the largest one is slow: a departure, of which the square is neglected.
const SLOW: f64 = 0.1;

/// Linear theory is worth a comparison as long as its accelerations are right to this part of the largest one.
const HOLDS: f64 = 0.1;

/// Times at which that is looked at, evenly spread over the run.
const CHECKS: usize = 16;

/// Powers of a matrix are summed as long as its elements are below this: the exponential of larger ones never ends.
const LONGEST: f64 = 1e15;

/// Step of the differences: rad for angles, rad/s for rates. Accelerations are quadratic in the rates, so there the
/// step is free; for angles the truncation, about h⁶/140, and the rounding, 1e-14/h, are both below 1e-12.
const ANGLE_STEP: f64 = 0.01;
const RATE_STEP: f64 = 1.0;

impl Linear {
    /// Whether this theory is about such models at all: bodies on revolute, spherical and fixed joints, with viscous
    /// friction and gravity and nothing else.
    pub(crate) fn is_about(model: &Model) -> bool {
        let kinds = [JointKind::Revolute, JointKind::Spherical, JointKind::Fixed];
        model.forces.is_empty()
            && model.attraction.is_none()
            && model.couplers.is_empty()
            && !model.is_driven()
            && model.joints.iter().all(|joint| kinds.contains(&joint.kind))
            && Tree::of(model).loop_joints.is_empty()
    }

    /// Linearises a model about its start; says why that cannot be done.
    pub(crate) fn about_start(model: &Model) -> Result<Self, String> {
        Self::about_start_at(model, 1.0)
    }

    /// The same with all rates of the start multiplied.
    pub(crate) fn about_start_at(model: &Model, factor: f64) -> Result<Self, String> {
        let joints = revolute_joints(model)?;
        let assembled = model.assemble().map_err(|e| e.to_string())?;
        let angles = joints.iter().map(|&j| assembled.joints[j].position[0]);
        let rates = joints.iter().map(|&j| factor * assembled.joints[j].rate[0]);
        let start = DVector::from_iterator(2 * joints.len(), angles.chain(rates));
        let (system, n) = (System { model, joints: &joints }, joints.len());
        let fastest = start.rows(n, n).amax();
        let is_slow = |k: usize| k >= n && start[k].abs() < SLOW * fastest;
        let x0 = DVector::from_fn(2 * n, |k, _| if is_slow(k) { start[k] } else { 0.0 });
        let base = &start - &x0;
        let f0 = system.derivative(&base)?;
        let steps = DVector::from_fn(2 * n, |k, _| if k < n { ANGLE_STEP } else { RATE_STEP });
        let a = jacobian(|x| system.derivative(x), &base, &steps)?;
        Ok(Self { joints, base, x0, f0, a })
    }

    /// A of `ẋ = f₀ + A x`; x has angles, then rates.
    pub(crate) fn matrix(&self) -> &DMatrix<f64> {
        &self.a
    }

    /// The angles at so many times, `interval` apart from zero on; says why linear theory does not hold so long.
    pub(crate) fn response(&self, model: &Model, interval: f64, n_times: usize) -> Result<Response, String> {
        if interval * self.a.amax().max(self.f0.amax()) > LONGEST {
            return Err(format!("{interval:?} s between samples are too long for it"));
        }
        self.refuse_growth(interval * n_times as f64)?;
        let mut angles = vec![Vec::with_capacity(n_times); self.joints.len()];
        let mut checked = Vec::new();
        let (propagator, mut x) = (self.propagator(interval), self.x0.push(1.0));
        for time in 0..n_times {
            for (k, angles) in angles.iter_mut().enumerate() {
                angles.push(self.base[k] + x[k]);
            }
            if time % n_times.div_ceil(CHECKS) == 0 || time + 1 == n_times {
                checked.push(x.rows(0, self.f0.len()).into_owned());
            }
            x = &propagator * x;
        }
        self.refuse_curvature(model, &checked)?;
        Ok(Response { joints: self.joints.clone(), angles })
    }

    /// What takes `(x, 1)` on by an interval.
    fn propagator(&self, interval: f64) -> DMatrix<f64> {
        let size = self.f0.len();
        let mut augmented = DMatrix::zeros(size + 1, size + 1);
        augmented.view_mut((0, 0), (size, size)).copy_from(&self.a);
        augmented.view_mut((0, size), (size, 1)).copy_from(&self.f0);
        (augmented * interval).exp()
    }

    fn refuse_growth(&self, length: f64) -> Result<(), String> {
        let growth = eigenvalues::of(&self.a).iter().map(|l| l.re).fold(0.0, f64::max);
        if growth * length > 1.0 {
            return Err(format!("departures from the start grow by e in {:.2e} s", 1.0 / growth));
        }
        Ok(())
    }

    /// Compares the linear accelerations with the runtime-assembled model's where the linear motion has gone. An angle
    /// that nothing depends on may turn without end.
    fn refuse_curvature(&self, model: &Model, departures: &[DVector<f64>]) -> Result<(), String> {
        let (system, n) = (System { model, joints: &self.joints }, self.joints.len());
        let (mut scale, mut error) = (self.f0.rows(n, n).amax(), 0.0_f64);
        for x in departures {
            let linear = &self.f0 + &self.a * x;
            let whole = system.derivative(&(&self.base + x))?;
            scale = scale.max(whole.rows(n, n).amax());
            error = error.max((whole - linear).rows(n, n).amax());
        }
        if error > HOLDS * scale {
            return Err(format!(
                "over this run its accelerations err by up to {:.0} %",
                100.0 * error / scale
            ));
        }
        Ok(())
    }
}

/// The revolute joints of a model that has no other motion.
fn revolute_joints(model: &Model) -> Result<Vec<usize>, String> {
    if model.bodies.iter().any(|b| b.support == Support::Free) {
        return Err("a body is free".to_owned());
    }
    if let Some(joint) = model.joints.iter().find(|j| j.kind == JointKind::Spherical) {
        return Err(format!("`{}` is spherical", joint.name));
    }
    if !Tree::of(model).loop_joints.is_empty() {
        return Err("the joints form a loop".to_owned());
    }
    let is_revolute = |j: &usize| model.joints[*j].kind == JointKind::Revolute;
    let joints: Vec<usize> = (0..model.joints.len()).filter(is_revolute).collect();
    if joints.is_empty() { Err("there is no revolute joint".to_owned()) } else { Ok(joints) }
}

/// The runtime-assembled model in joint angles and rates.
struct System<'a> {
    model: &'a Model,
    joints: &'a [usize],
}

impl System<'_> {
    /// Rates and accelerations of the joint angles.
    fn derivative(&self, x: &DVector<f64>) -> Result<DVector<f64>, String> {
        let n = self.joints.len();
        let model = self.at(x)?;
        let start = model.assemble().map_err(|e| e.to_string())?;
        let careful = Careful::<f64>::new(&model).map_err(|e| e.to_string())?;
        let mut y = careful.start();
        let state: &mut [f64] = y.as_mut();
        for (element, value) in state.iter_mut().zip(start.q.iter().chain(&start.v)) {
            *element = *value;
        }
        let mut dy = y.clone();
        careful.derivative(0.0, &y, &mut dy);
        let spins = body_accelerations(&model, y.as_ref(), dy.as_ref());
        let acceleration =
            |k: usize| joint_acceleration(&model, &model.joints[self.joints[k]], y.as_ref(), &spins);
        let derivative = DVector::from_fn(2 * n, |k, _| if k < n { x[n + k] } else { acceleration(k - n) });
        let is_finite = derivative.iter().all(|d| d.is_finite());
        if is_finite {
            Ok(derivative)
        } else {
            Err("the accelerations at the start are not finite".to_owned())
        }
    }

    /// The model with other joint angles and rates at its start.
    fn at(&self, x: &DVector<f64>) -> Result<Model, String> {
        let mut model = self.model.clone();
        let number = |x: f64| {
            Rational::from_float(x)
                .map(Number::Exact)
                .ok_or_else(|| "a joint's start is not finite".to_owned())
        };
        for (k, &joint) in self.joints.iter().enumerate() {
            let (angle, rate) = (number(x[k])?, number(x[self.joints.len() + k])?);
            model.joints[joint].start = JointStartSpec {
                position: vec![Some(angle)],
                rate: Some(vec![rate]),
                ..JointStartSpec::default()
            };
        }
        for body in &mut model.bodies {
            body.angular_velocity = None;
        }
        Ok(model)
    }
}

/// The angular acceleration of each body in the global frame; zero for folded bodies. As `w̃'w' = 0`, it is `A ẇ'`.
fn body_accelerations(model: &Model, y: &[f64], dy: &[f64]) -> Vec<Vector> {
    let moving_bodies = model.coordinate_bodies();
    let mut accelerations = vec![Vector::zeros(); model.bodies.len()];
    for (moving_body, &body) in moving_bodies.iter().enumerate() {
        let at = 7 * moving_bodies.len() + 6 * moving_body + 3;
        accelerations[body] =
            orientation(y, moving_body).rotate(Vector::from([dy[at], dy[at + 1], dy[at + 2]]));
    }
    accelerations
}

/// `θ̈ = h·(ω̇_second − ω̇_first)`: the remaining term of the relative acceleration, `ω_first × h θ̇`, is normal to h.
fn joint_acceleration(model: &Model, joint: &Joint, y: &[f64], accelerations: &[Vector]) -> f64 {
    let end = if is_folded(model, joint.second.body) { &joint.first } else { &joint.second };
    let moving_body = model.coordinate_bodies().iter().position(|&b| b == end.body);
    let axis = Vector::from(model.values(&end.axis)).normalize();
    let h = moving_body.map_or(axis, |moving_body| orientation(y, moving_body).rotate(axis));
    h.dot(&accelerations[joint.second.body]) - h.dot(&accelerations[joint.first.body])
}

fn is_folded(model: &Model, body: usize) -> bool {
    model.bodies[body].support == Support::Fixed
}

fn orientation(y: &[f64], moving_body: usize) -> Quaternion {
    Quaternion(std::array::from_fn(|k| y[7 * moving_body + 3 + k]))
}

/// Central differences of sixth order: ((f₁ − f₋₁)·45 − (f₂ − f₋₂)·9 + (f₃ − f₋₃)) / 60 h.
fn jacobian(
    f: impl Fn(&DVector<f64>) -> Result<DVector<f64>, String>,
    x: &DVector<f64>,
    steps: &DVector<f64>,
) -> Result<DMatrix<f64>, String> {
    const WEIGHTS: [(f64, f64); 3] = [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)];
    let mut jacobian = DMatrix::zeros(x.len(), x.len());
    for column in 0..x.len() {
        let at = |steps_away: f64| {
            let mut moved = x.clone();
            moved[column] += steps_away * steps[column];
            f(&moved)
        };
        let mut sum = DVector::zeros(x.len());
        for (distance, weight) in WEIGHTS {
            sum += (at(distance)? - at(-distance)?) * weight;
        }
        jacobian.set_column(column, &(sum / (60.0 * steps[column])));
    }
    Ok(jacobian)
}

#[cfg(test)]
mod tests;
