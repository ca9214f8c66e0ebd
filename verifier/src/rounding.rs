//! How much emitted code loses by rounding, measured against 384 bits.
//!
//! The reference of a state is the emitted program itself in 384 bits, with exact constants: an identity test has shown
//! that it is the textbook. Both the code in `f64` and `f32` and any other implementation of the same functions are
//! given the state rounded to their precision and are compared with that one reference, so what is measured is how far
//! from the truth a user ends who has rounded once.

mod samples;
mod trial;

pub use samples::{Kind, Sample};
pub use trial::{KERNELS, Trial, relative_error, trial};

use crate::atoms::{Atoms, Elementary};
use crate::field::{Field, Precision, Real};
use crate::interpreter::{self, Given};
use crate::joints::JointLayout;
use crate::module::{Module, is_on_constraints, source_of_accelerations, takes_any_accelerations};
use crate::point::Point;
use crate::states;
use gyro_model::Model;

/// Errors over some states, each in units in the last place of the largest number of the function's results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// The largest.
    pub worst: f64,
    /// The middle one.
    pub median: f64,
}

/// The errors of one function over states of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Rounding {
    /// Name of the function.
    pub function: String,
    /// Which states.
    pub kind: Kind,
    /// Of the code in `f64`.
    pub double: Spread,
    /// Of the code in `f32`.
    pub single: Spread,
}

/// One state with what the functions should give there.
#[derive(Clone, Debug)]
pub struct Reference<'c> {
    /// Where.
    pub sample: Sample,
    /// Name and exact results of each function, rounded to 384 bits.
    pub results: Vec<(String, Vec<Real<'c>>)>,
    /// The special Euler parameters with which the partition's functions were run.
    pub charts: Vec<usize>,
    /// The maximal state of the sample's joint state in `f64`; empty where there are no joint coordinates.
    pub corrected: Vec<f64>,
}

/// The references of a module at some states of each kind.
pub fn references<'c>(
    model: &Model,
    module: &Module,
    precision: &'c Precision,
    states: usize,
    seed: u64,
) -> Vec<Reference<'c>> {
    let constants = interpreter::constants(precision, module);
    let samples = samples::draw(model, module, states, seed);
    let reference = |sample: Sample| {
        let point = exact_point(model, precision, &sample);
        let joints = exact_joints(module, precision, &sample);
        let corrected = corrected_point(module, &constants, &point, &joints)?;
        let charts = charts(module, &constants, &point);
        let changes = sample.changes.iter().map(|&x| Real::new(precision, x)).collect();
        let given = Inputs { point, corrected, changes, joints };
        let results = results(module, &constants, &Elementary, &given, &charts)?;
        let corrected = given.corrected.state.iter().map(Real::to_f64).collect();
        Some(Reference { sample, results, charts, corrected })
    };
    samples.into_iter().filter_map(reference).collect()
}

/// Error of computed results in units in the last place (of a number of `digits` binary digits) of the largest result.
/// `None` where all results are zero and computed exactly; infinite where a computed one is not a number.
pub fn error(reference: &[Real], computed: &[f64], digits: i32) -> Option<f64> {
    let largest = reference.iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max);
    let differences = reference.iter().zip(computed).map(|(x, &y)| x.sub(&x.like(y)).to_f64().abs());
    let error = differences.fold(0.0, |a: f64, b| if b.is_nan() { f64::INFINITY } else { a.max(b) });
    if largest == 0.0 {
        return (error > 0.0).then_some(f64::INFINITY);
    }
    // Units in the last place are those of the binade that the largest result is in.
    let unit = 2.0_f64.powi(largest.log2().floor() as i32 + 1 - digits);
    Some(error / unit)
}

/// Measures all functions of a module.
pub fn measure(model: &Model, module: &Module, states: usize, seed: u64) -> Vec<Rounding> {
    let precision = Precision::new();
    let references = references(model, module, &precision, states, seed);
    let mut rounding = Vec::new();
    for kind in Kind::ALL {
        let of_kind: Vec<_> = references.iter().filter(|r| r.sample.kind == kind).collect();
        let double: Vec<_> = of_kind.iter().map(|r| in_double(model, module, r)).collect();
        let single: Vec<_> = of_kind.iter().map(|r| in_single(model, module, r)).collect();
        for function in module.programs.keys() {
            let spread = |computed: &[Computed], digits| {
                let errors = of_kind.iter().zip(computed);
                Spread::of(
                    errors.filter_map(|(r, c)| error(r.of(function)?, c.of(function)?, digits)).collect(),
                )
            };
            let both = spread(&double, DOUBLE_DIGITS).zip(spread(&single, SINGLE_DIGITS));
            rounding.extend(both.map(|(double, single)| Rounding {
                function: function.clone(),
                kind,
                double,
                single,
            }));
        }
    }
    rounding
}

/// Binary digits of an `f64`.
pub const DOUBLE_DIGITS: i32 = 53;

/// Binary digits of an `f32`.
pub const SINGLE_DIGITS: i32 = 24;

impl Spread {
    /// Of some errors; `None` if there are none.
    pub fn of(mut errors: Vec<f64>) -> Option<Self> {
        errors.sort_by(f64::total_cmp);
        let (&worst, &median) = (errors.last()?, errors.get(errors.len() / 2)?);
        Some(Self { worst, median })
    }
}

impl<'c> Reference<'c> {
    /// The maximal state in `f64` at which a function is measured.
    pub fn state(&self, function: &str) -> &[f64] {
        if is_on_constraints(function) { &self.corrected } else { &self.sample.state }
    }

    /// The results of a function.
    pub fn of(&self, function: &str) -> Option<&[Real<'c>]> {
        let known = self.results.iter().find(|(name, _)| name == function);
        known.map(|(_, results)| results.as_slice())
    }
}

/// Results of the functions in a shorter precision.
struct Computed(Vec<(String, Vec<f64>)>);

impl Computed {
    fn of(&self, function: &str) -> Option<&[f64]> {
        let known = self.0.iter().find(|(name, _)| name == function);
        known.map(|(_, results)| results.as_slice())
    }
}

fn in_double(model: &Model, module: &Module, reference: &Reference) -> Computed {
    let given = Inputs::rounded(model, (), reference, |x| x);
    let constants: Vec<f64> = interpreter::constants((), module);
    let results = results(module, &constants, &Elementary, &given, &reference.charts);
    Computed(results.unwrap_or_default())
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
fn in_single(model: &Model, module: &Module, reference: &Reference) -> Computed {
    let given = Inputs::rounded(model, (), reference, |x| x as f32);
    let constants: Vec<f32> = interpreter::constants((), module);
    let results = results(module, &constants, &Elementary, &given, &reference.charts).unwrap_or_default();
    let widened = |results: Vec<f32>| results.into_iter().map(f64::from).collect();
    Computed(results.into_iter().map(|(name, results)| (name, widened(results))).collect())
}

/// The sample with Euler parameters of length one.
fn exact_point<'c>(model: &Model, precision: &'c Precision, sample: &Sample) -> Point<Real<'c>> {
    let mut point = states::point(model, precision, &sample.raw, sample.t, |x| Real::new(precision, x));
    for position in point.state[..7 * model.coordinate_bodies().len()].chunks_mut(7) {
        to_length_one(&mut position[3..]);
    }
    point
}

/// The sample's joint state with Euler parameters of length one.
fn exact_joints<'c>(module: &Module, precision: &'c Precision, sample: &Sample) -> Vec<Real<'c>> {
    let mut joints: Vec<_> = sample.raw_joints.iter().map(|&x| Real::new(precision, x)).collect();
    for first in module.joints.iter().flat_map(JointLayout::euler) {
        to_length_one(&mut joints[first..first + 4]);
    }
    joints
}

fn to_length_one(p: &mut [Real<'_>]) {
    let square = p.iter().map(|e| e.mul(e)).reduce(|sum, e| sum.add(&e));
    let length = square.map(|square| square.sqrt());
    for e in p {
        *e = length.as_ref().and_then(|length| e.div(length)).unwrap_or_else(|| e.clone());
    }
}

/// The point with the maximal state of a joint state; without joint coordinates the point itself.
fn corrected_point<'c>(
    module: &Module,
    constants: &[Real<'c>],
    point: &Point<Real<'c>>,
    joints: &[Real<'c>],
) -> Option<Point<Real<'c>>> {
    let Some(program) = module.programs.get("to_maximal") else { return Some(point.clone()) };
    let given = Given { point, accelerations: &[], charts: &[], changes: &[], joints };
    let state = interpreter::run(module, program, constants, &Elementary, &given).ok()?;
    Some(Point { state, ..point.clone() })
}

/// What functions are given.
struct Inputs<F: Field> {
    point: Point<F>,
    corrected: Point<F>,
    changes: Vec<F>,
    joints: Vec<F>,
}

impl<F: Field> Inputs<F> {
    fn rounded(
        model: &Model,
        context: F::Context,
        reference: &Reference<'_>,
        number: impl Fn(f64) -> F,
    ) -> Self {
        let sample = &reference.sample;
        let point = |state: &[f64]| states::point(model, context, state, sample.t, &number);
        let [changes, joints] =
            [&sample.changes, &sample.joints].map(|numbers| numbers.iter().map(|&x| number(x)).collect());
        Self { point: point(&sample.state), corrected: point(&reference.corrected), changes, joints }
    }
}

/// The charts that the partition takes at a state: of each vector the largest component.
fn charts<'c>(module: &Module, constants: &[Real<'c>], point: &Point<Real<'c>>) -> Vec<usize> {
    let given = Given { point, accelerations: &[], charts: &[], changes: &[], joints: &[] };
    let Some(program) = module.programs.get("chart_vectors") else { return Vec::new() };
    let vectors = interpreter::run(module, program, constants, &Elementary, &given).unwrap_or_default();
    let size = |x: &Real| x.to_f64().abs();
    let largest = |vector: &[Real]| {
        (0..4).fold(0, |best, k| if size(&vector[k]) > size(&vector[best]) { k } else { best })
    };
    vectors.chunks(4).map(largest).collect()
}

/// What each function gives at a point; `None` where one divides by zero.
fn results<F: Field>(
    module: &Module,
    constants: &[F],
    atoms: &dyn Atoms<F>,
    inputs: &Inputs<F>,
    charts: &[usize],
) -> Option<Vec<(String, Vec<F>)>> {
    let context = inputs.point.context;
    let one_hot = |chart: &usize| [0, 1, 2, 3].map(|k| F::integer(context, i64::from(k == *chart)));
    let charts: Vec<_> = charts.iter().map(one_hot).collect();
    let run = |function: &str, accelerations: &[F]| {
        let point = if is_on_constraints(function) { &inputs.corrected } else { &inputs.point };
        let given =
            Given { point, accelerations, charts: &charts, changes: &inputs.changes, joints: &inputs.joints };
        interpreter::run(module, &module.programs[function], constants, atoms, &given).ok()
    };
    let result = |function: &String| {
        let mut accelerations = run(source_of_accelerations(function), &[])?;
        if takes_any_accelerations(function) {
            // At those of the equations of motion no force is left.
            accelerations.iter_mut().for_each(|x| *x = x.add(x));
        }
        Some((function.clone(), run(function, &accelerations)?))
    };
    module.programs.keys().map(result).collect()
}
