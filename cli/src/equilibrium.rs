//! Unstable equilibria: starts at rest that nothing accelerates, from which every disturbance grows. What a run makes
//! of one is decided by rounding, in each engine by another.

use crate::scene::{self, Scene};
use crate::words::number;
use gyro_assembled::{Dense, Precision, quick_look};
use gyro_model::{Attraction, Model, Number, Rational};
use gyro_runner::{Approach, Event, Integrator, Sample, Settings, Start, any_varies, differences};
use gyro_sim::{Dynamics, Mechanism};

/// The rate of a disturbance, rad/s or m/s: a power of ten that is far above rounding.
const DISTURBANCE: f64 = 1e-7;
/// What it has to become, rad or parts of the mechanism's size, and how many times what it would be without growth.
const GROWN: f64 = 1e-3;
const TIMES: f64 = 1e3;
/// Accelerations of so many parts of gravity are rounding.
const ROUNDING: f64 = 1e-11;
/// Steps of a disturbed run.
const BUDGET: u64 = 20_000;

/// Why a run that starts in an unstable equilibrium cannot be judged; `None` for all others.
pub(crate) fn unstable(scene: &Scene) -> Option<String> {
    if !is_balanced(scene).unwrap_or(false) {
        return None;
    }
    let joints = (0..scene.model.joints.len()).filter(|joint| has_scalars(&scene.model, *joint));
    let (joint, reached) = joints.filter_map(|joint| Some((joint, disturbed(scene, joint)?))).next()?;
    Some(format!(
        "the start is an unstable equilibrium: it is at rest and nothing accelerates it, but a rate of {DISTURBANCE:e} of joint \
         `{}` grows to a motion of {} within the run. Whether and when the mechanism leaves is decided by rounding alone: start \
         it beside the equilibrium, or with a rate",
        scene.model.joints[joint].name,
        number(reached, 2)
    ))
}

fn has_scalars(model: &Model, joint: usize) -> bool {
    !model.joints[joint].kind.coordinates().is_empty()
}

/// Whether a start is at rest, and stays there but for rounding.
fn is_balanced(scene: &Scene) -> Option<bool> {
    let Start { positions, velocities, inputs, controllers, contacts, .. } = &scene.start;
    let is_still = velocities.iter().all(|v| *v == 0.0)
        && !scene.model.is_driven()
        && controllers.is_empty()
        && contacts.is_empty()
        && !any_varies(inputs);
    if !is_still {
        return Some(false);
    }
    let mut dense = Dense::<f64>::new(&scene.model).ok()?;
    for input in inputs {
        dense.set_input(input.index, input.at(0.0)).then_some(())?;
    }
    let mut y = dense.start();
    let state: &mut [f64] = y.as_mut();
    state.iter_mut().zip(positions.iter().chain(velocities)).for_each(|(to, from)| *to = *from);
    let mut slope = y.clone();
    dense.derivative(0.0, &y, &mut slope);
    let slope: &[f64] = slope.as_ref();
    let gravity = largest_gravity(&scene.model, positions);
    let limit = ROUNDING * (1.0 + gravity) * (1.0 + 1.0 / scene.model.size());
    let accelerations = &slope[positions.len()..positions.len() + velocities.len()];
    Some(accelerations.iter().all(|a| a.abs() <= limit))
}

/// The largest acceleration of gravity at the mass centre of a body, m/s².
fn largest_gravity(model: &Model, positions: &[f64]) -> f64 {
    let size = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let Some(Attraction { mu, centre }) = &model.attraction else {
        return size(model.values(&model.gravity));
    };
    let (mu, centre) = (model.value(mu), model.values(centre));
    let distance = |q: &[f64]| size([q[0] - centre[0], q[1] - centre[1], q[2] - centre[2]]);
    positions.chunks_exact(7).map(|q| mu / distance(q).powi(2)).fold(0.0, f64::max)
}

/// How far the mechanism goes when a joint of it is given a small rate, if that is far.
fn disturbed(scene: &Scene, joint: usize) -> Option<f64> {
    let mut model = scene.model.clone();
    model.bodies.iter_mut().for_each(|body| body.angular_velocity = None);
    model.joints.iter_mut().for_each(|joint| joint.start.rate = None);
    let mut rates = vec![Number::integer(0); model.joints[joint].kind.coordinates().len()];
    rates[0] = Number::Exact(Rational::from_float(DISTURBANCE)?);
    model.joints[joint].start.rate = Some(rates);
    let start = scene::start(&model, &model.assemble().ok()?);
    let start = Start { inputs: scene.start.inputs.clone(), watches: Vec::new(), ..start };
    let t_end = scene.settings.t_end;
    let settings = Settings { sample_every: t_end / 64.0, correct_every: None, ..scene.settings };
    let approach = Approach {
        integrator: Integrator::Dop853,
        tolerance: Some(1e-9),
        budget: Some(BUDGET),
        ..Approach::default()
    };
    let mut samples: Vec<Sample> = Vec::new();
    let mut tell = |event: Event<'_>| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    };
    // What it does up to a failure is enough.
    let _ = quick_look(&model, Precision::Double, (&settings, &approach), &start, &mut tell);
    let still = vec![samples.first()?.clone(); samples.len()];
    let size = model.size().min(1.0);
    let reached = differences(&samples, &still).iter().map(|d| d.position).fold(0.0, f64::max);
    (reached > GROWN * size && reached > TIMES * DISTURBANCE * t_end).then_some(reached)
}
