//! One model file in every engine and in all coordinates: generated formulas as they were emitted, read back and run in
//! `f64`, beside the forms of the runtime-assembled model, all held against the same formulas in 384 bits.

use gyro_assembled::{Careful, Dense, Recursive};
use gyro_model::{Model, to_f64};
use gyro_sim::Dynamics;
use gyro_verifier::atoms::{Atoms, Elementary};
use gyro_verifier::field::{Field, Precision, Real};
use gyro_verifier::interpreter::{self, Given};
use gyro_verifier::module::Module;
use gyro_verifier::point::Point;

/// What any engine may be off by in terms of the [`noise`] of what is compared.
const ALLOWED: f64 = 16.0;

/// How often a function is asked anew with inputs that differ by a rounding.
const DITHERS: u64 = 6;

/// Accelerations that are smaller, m/s² or rad/s², are those of a mechanism at rest.
const AT_REST: f64 = 1e-6;

/// A trajectory, s, and its steps; again with twice as many, to see how much the method is off by. So many times as
/// many steps at most where motions are too stiff for fewer.
const T_END: f64 = 0.005;
const STEPS: u32 = 20;
const STIFF: u32 = 64;

/// No motion of a few milliseconds leads to larger numbers.
const BLOWN_UP: f64 = 1e9;

/// The worst difference of each comparison in terms of what is allowed.
#[derive(Clone, Debug, Default)]
pub struct Comparison {
    /// What was compared, and how it differs.
    pub found: Vec<(String, f64)>,
    /// Forms that do not do this model.
    pub n_forms: usize,
}

impl Comparison {
    /// What differs by more than it may.
    pub fn wrong(&self) -> Vec<&(String, f64)> {
        self.found.iter().filter(|(_, ratio)| ratio.is_nan() || *ratio > 1.0).collect()
    }
}

/// Generates, builds and compares; `None` where the model file is refused.
pub fn compare(text: &str) -> Option<Comparison> {
    let model = gyro_model::read_with("page.toml", text, &mut gyro_pages::load).ok()?;
    let module =
        gyro_codegen::generate_functions("page.toml", &model, &gyro_codegen::Functions::all()).ok()?;
    let module = Module::read(&model, &module.code, &module.constants).ok()?;
    let generated = Generated::new(&model, &module, (), |x| x);
    let forms = Forms::of(&model);
    let mut comparison = Comparison {
        n_forms: forms.list().len() + 1 + usize::from(module.joints.is_some()),
        ..Comparison::default()
    };
    accelerations_at(&model, &module, (0.0, &module.start), &generated, &forms, &mut comparison);
    let end = trajectories_agree(&module, &generated, &forms, &mut comparison);
    accelerations_at(&model, &module, (T_END, &normalised((), end)), &generated, &forms, &mut comparison);
    Some(comparison)
}

/// A derivative of the state.
type Derivative<'a> = Box<dyn Fn(f64, &Vec<f64>) -> Vec<f64> + 'a>;

struct Forms {
    dense: Dense<f64>,
    careful: Option<Careful<f64>>,
    recursive: Option<Recursive<f64>>,
}

impl Forms {
    fn of(model: &Model) -> Self {
        let careful = Careful::<f64>::supports(model).is_ok();
        let recursive = Recursive::<f64>::supports(model).is_ok();
        let message = "it is supported and can be assembled";
        Self {
            dense: Dense::new(model).expect("it does every model"),
            careful: careful.then(|| Careful::new(model).expect(message)),
            recursive: recursive.then(|| Recursive::new(model).expect(message)),
        }
    }

    /// Name, accelerations and derivative of each form that there is.
    fn list(&self) -> Vec<(&'static str, Derivative<'_>, Derivative<'_>)> {
        let mut list = vec![("dense", accelerations(&self.dense), derivative(&self.dense))];
        list.extend(self.careful.as_ref().map(|form| ("careful", accelerations(form), derivative(form))));
        list.extend(self.recursive.as_ref().map(|form| ("recursive", accelerations(form), derivative(form))));
        list
    }
}

fn accelerations<M: Dynamics<Scalar = f64, State = Vec<f64>>>(form: &M) -> Derivative<'_> {
    Box::new(|t, y| {
        let mut out = form.acceleration_buffer();
        form.accelerations(t, y, &mut out);
        out.as_ref()[..6 * form.description().bodies.len()].to_vec()
    })
}

fn derivative<M: Dynamics<Scalar = f64, State = Vec<f64>>>(form: &M) -> Derivative<'_> {
    Box::new(|t, y| {
        let mut dy = form.start();
        Dynamics::derivative(form, t, y, &mut dy);
        dy
    })
}

/// A module's functions over any numbers.
struct Generated<'a, F: Field> {
    module: &'a Module,
    context: F::Context,
    constants: Vec<F>,
    parameters: Vec<F>,
    inputs: Vec<F>,
    number: Box<dyn Fn(f64) -> F + 'a>,
}

impl<'a, F: Field> Generated<'a, F>
where
    Elementary: Atoms<F>,
{
    fn new(model: &Model, module: &'a Module, context: F::Context, number: impl Fn(f64) -> F + 'a) -> Self {
        let values = |of: &[gyro_model::Parameter]| of.iter().map(|p| number(to_f64(&p.value))).collect();
        let (parameters, inputs) = (values(&model.parameters), values(&model.inputs));
        let constants = interpreter::constants(context, module);
        Self { module, context, constants, parameters, inputs, number: Box::new(number) }
    }

    fn run(&self, function: &str, t: f64, [y, x]: [&[f64]; 2], accelerations: &[F]) -> Vec<F> {
        self.run_at(function, t, [self.numbers(y), self.numbers(x)], accelerations)
    }

    fn numbers(&self, values: &[f64]) -> Vec<F> {
        values.iter().map(|&value| (self.number)(value)).collect()
    }

    fn run_at(&self, function: &str, t: f64, [state, joints]: [Vec<F>; 2], accelerations: &[F]) -> Vec<F> {
        let t = (self.number)(t);
        let (parameters, inputs) = (self.parameters.clone(), self.inputs.clone());
        let point = Point { context: self.context, t, state, parameters, inputs };
        let given = Given { point: &point, accelerations, charts: &[], changes: &[], joints: &joints };
        let program = &self.module.programs[function];
        interpreter::run(self.module, program, &self.constants, &Elementary, &given)
            .expect("no divisor is zero")
    }

    /// (s̈, ẇ') and what closes loops.
    fn accelerations(&self, t: f64, y: &[f64]) -> Vec<F> {
        self.run("accelerations", t, [y, &[]], &[])
    }
}

impl Generated<'_, f64> {
    fn derivative(&self, t: f64, y: &[f64]) -> Vec<f64> {
        self.run("derivative", t, [y, &[]], &self.accelerations(t, y))
    }

    fn joint_derivative(&self, t: f64, x: &[f64]) -> Vec<f64> {
        let rates = self.run("joint_accelerations", t, [&[], x], &[]);
        self.run("joint_derivative", t, [&[], x], &rates)
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |worst: f64, (a, b)| if (a - b).abs() <= worst { worst } else { (a - b).abs() })
}

/// With Euler parameters of length one, which neither rounding nor the method keeps: formulas hold where p is a unit
/// vector, and of others each engine makes something else.
fn normalised<F: Field>(context: F::Context, mut y: Vec<F>) -> Vec<F>
where
    Elementary: Atoms<F>,
{
    let n_bodies = n_bodies(&y);
    for body in y[..7 * n_bodies].chunks_mut(7) {
        let square = body[3..].iter().fold(F::zero(context), |sum, e| sum.add(&e.mul(e)));
        let scale = Elementary.sqrt(&square).inv().expect("no p is zero");
        body[3..].iter_mut().for_each(|e| *e = e.mul(&scale));
    }
    y
}

/// Every component moved by a unit in its last place, up, down or not at all, as the number of the series has it.
pub fn dithered(y: &[f64], series: u64) -> Vec<f64> {
    let moved = |(k, &value): (usize, &f64)| {
        let hash = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_mul(2 * series + 1) >> 33;
        match hash % 3 {
            0 => value.next_up(),
            1 => value.next_down(),
            _ => value,
        }
    };
    y.iter().enumerate().map(moved).collect()
}

/// How far roundings take what a function gives, as it shows itself: the largest change that changes of the inputs by a
/// unit in the last place make, be it that the problem amplifies them or the way in which it is solved; and a rounding
/// of what is added up to numbers of this scale.
fn noise(function: &dyn Fn(&Vec<f64>) -> Vec<f64>, y: &[f64], scale: f64) -> f64 {
    let result = function(&y.to_vec());
    let moved = |series| difference(&function(&dithered(y, series)), &result);
    (0..DITHERS).map(moved).fold(f64::EPSILON * scale, f64::max)
}

fn accelerations_at(
    model: &Model,
    module: &Module,
    (t, y): (f64, &Vec<f64>),
    generated: &Generated<f64>,
    forms: &Forms,
    comparison: &mut Comparison,
) {
    let n = 6 * model.coordinate_bodies().len();
    let precision = Precision::new();
    let exactly = Generated::new(model, module, &precision, |x| Real::new(&precision, x));
    let state = normalised(&precision, exactly.numbers(y));
    let expected = exactly.run_at("accelerations", t, [state, Vec::new()], &[]);
    let expected: Vec<f64> = expected[..n].iter().map(Real::to_f64).collect();
    let scales = [unrestrained(model, generated, t, y), prescribed(model, t), AT_REST];
    let scale = scales.into_iter().fold(largest(&expected), f64::max);
    let mut note = |name: &str, function: &dyn Fn(&Vec<f64>) -> Vec<f64>| {
        let ratio = difference(&function(y), &expected) / (ALLOWED * noise(function, y, scale));
        comparison.found.push((format!("{name}: accelerations at t = {t}"), ratio));
    };
    note("generated", &|y| generated.accelerations(t, y)[..n].to_vec());
    // The others take the constraints for granted, which hold to the end no better than the method keeps them.
    let is_start = t == 0.0;
    forms
        .list()
        .iter()
        .filter(|(name, ..)| is_start || *name != "recursive")
        .for_each(|(name, accelerations, _)| note(name, &|y| accelerations(t, y)));
    if is_start && module.joints.is_some() {
        note("generated, corrected", &|y| generated.run("corrected_accelerations", t, [y, &[]], &[]));
    }
}

/// The largest acceleration that forces would give the bodies without their joints: what cancels where joints hold
/// them.
fn unrestrained(model: &Model, generated: &Generated<f64>, t: f64, y: &[f64]) -> f64 {
    let forces = generated.run("applied_force", t, [y, &[]], &[]);
    let bodies = model.coordinate_bodies().into_iter().map(|body| &model.bodies[body]);
    let accelerations = bodies.zip(forces.chunks_exact(6)).map(|(body, force)| {
        let moments = body.inertia[..3].iter().map(|moment| model.value(moment));
        let smallest = moments.fold(f64::INFINITY, f64::min);
        (largest(&force[..3]) / model.value(&body.mass)).max(largest(&force[3..]) / smallest)
    });
    accelerations.fold(0.0, f64::max)
}

/// The largest acceleration of a driven body: of it a joint may hand on a small part.
fn prescribed(model: &Model, t: f64) -> f64 {
    let motions = model.bodies.iter().filter_map(|body| body.motion.as_ref());
    let components = motions
        .flat_map(|motion| motion.translation.iter().chain(motion.rotations.iter().map(|(_, angle)| angle)));
    components.fold(0.0, |largest, motion| largest.max(motion.value(model, t)[2].abs()))
}

/// Runge and Kutta's method.
fn integrated(derivative: &dyn Fn(f64, &Vec<f64>) -> Vec<f64>, start: &[f64], steps: u32) -> Vec<f64> {
    let (h, mut y) = (T_END / f64::from(steps), start.to_vec());
    for step in 0..steps {
        let t = h * f64::from(step);
        let on = |h: f64, k: &[f64]| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<f64>>();
        let first = derivative(t, &y);
        let second = derivative(t + h / 2.0, &on(h / 2.0, &first));
        let third = derivative(t + h / 2.0, &on(h / 2.0, &second));
        let fourth = derivative(t + h, &on(h, &third));
        let slopes = (0..y.len()).map(|k| (first[k] + 2.0 * (second[k] + third[k]) + fourth[k]) / 6.0);
        y = on(h, &slopes.collect::<Vec<f64>>());
    }
    y
}

/// Gives where the generated formulas have come to in the end.
fn trajectories_agree(
    module: &Module,
    generated: &Generated<f64>,
    forms: &Forms,
    comparison: &mut Comparison,
) -> Vec<f64> {
    let start = &module.start;
    let maximal = |y: &Vec<f64>, steps| integrated(&|t, y| generated.derivative(t, y), y, steps);
    let is_stable = |steps: &u32| maximal(start, *steps).iter().all(|x| x.abs() < BLOWN_UP);
    let steps = std::iter::successors(Some(STEPS), |steps| Some(2 * steps))
        .find(|steps| *steps >= STIFF * STEPS || is_stable(steps))
        .expect("the last will do");
    let end = maximal(start, steps);
    let method = difference(&maximal(start, 2 * steps), &end);
    let scale = f64::from(steps) * largest(&end).max(1.0);
    let own = noise(&|y| maximal(y, steps), start, scale);
    // The method does not keep the constraints and the length of Euler parameters, and off them each engine goes its
    // own way.
    let mut note = |name: &str, function: &dyn Fn(&Vec<f64>, u32) -> Vec<f64>, start: &[f64]| {
        let start = start.to_vec();
        let (found, finer) = (function(&start, steps), function(&start, 2 * steps));
        let noise = own + noise(&|y| function(y, steps), &start, scale);
        let method = method + difference(&finer, &found);
        let ratio = difference(&found, &end) / (ALLOWED * noise + 3.0 * method);
        comparison.found.push((format!("{name}: after {T_END} s"), ratio));
    };
    for (name, _, derivative) in forms.list() {
        note(name, &|y, steps| integrated(&*derivative, y, steps), start);
    }
    if module.joints.is_some() {
        let joint = |t: f64, x: &Vec<f64>| generated.joint_derivative(t, x);
        let by = |x: &Vec<f64>, steps| {
            let mut y = generated.run("to_maximal", T_END, [&[], &integrated(&joint, x, steps)], &[]);
            alike(&mut y, &end);
            y
        };
        note("generated, joint coordinates", &by, &module.joint_start);
    }
    end
}

/// Gives Euler parameters the signs of those of another state: both signs are one orientation.
pub fn alike(y: &mut [f64], other: &[f64]) {
    for (body, other) in y[..7 * n_bodies(other)].chunks_mut(7).zip(other.chunks(7)) {
        let same: f64 = body[3..].iter().zip(&other[3..]).map(|(a, b)| a * b).sum();
        body[3..].iter_mut().for_each(|e| *e *= same.signum());
    }
}

/// Bodies of a state of 13 numbers a body; the few beyond are work and turns.
fn n_bodies<F>(y: &[F]) -> usize {
    y.len() / 13
}
