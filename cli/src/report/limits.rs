//! Limits of stability: in theory, from eigenvalues and the methods' own amplification; and as runs find them.

use super::lab::{Lab, Plan};
use crate::args::Precision;
use crate::linear::Linear;
use crate::report::curve::Engine;
use gyro_assembled::Dense;
use gyro_model::{ForceKind, Model, Number, Rational, to_f64};
use gyro_runner::{Approach, Coordinates, Correction, Integrator, JointSample, Sample, Settings, When};
use gyro_sim::integrate::{Method, Work};
use gyro_sim::{Dop853, Dynamics, Jacobian, Kutta4, Mechanism, Ode, Rodas4, System, Tsit5};
use nalgebra::{Complex, DMatrix, Schur};

/// `ẏ = λ y` for a complex y, in real and imaginary part.
struct Test(Complex<f64>);

impl Ode for Test {
    type Scalar = f64;
    type State = [f64; 2];

    fn derivative(&self, _: &(), _: f64, y: &[f64; 2], dy: &mut [f64; 2]) {
        let rate = self.0 * Complex::new(y[0], y[1]);
        *dy = [rate.re, rate.im];
    }
}

impl Jacobian for Test {
    type Matrix = [f64; 4];

    fn jacobian(&self, _: &(), _: f64, _: &[f64; 2], dfdy: &mut [f64; 4], dfdt: &mut [f64; 2]) {
        *dfdy = [self.0.re, -self.0.im, self.0.im, self.0.re];
        *dfdt = [0.0; 2];
    }
}

const START: [f64; 2] = [1.0, 0.0];

/// |R(z)|: by how much a step of a method changes a motion that grows or turns like e^z. The method itself says it.
pub(crate) fn amplification(integrator: Integrator, z: Complex<f64>) -> f64 {
    fn of<M: Method<Test>>(mut method: M, test: &Test) -> f64 {
        let system = System { dynamics: test, model: &() };
        method.attempt(system, 0.0, 1.0, &START, false, &mut Work::default());
        let [re, im] = *method.end();
        re.hypot(im)
    }
    let test = Test(z);
    let y = START;
    match integrator {
        Integrator::Rk4 => of(Kutta4::new(&y), &test),
        Integrator::Tsit5 => of(Tsit5::new(&y), &test),
        Integrator::Dop853 => of(Dop853::new(&y), &test),
        Integrator::Rodas4 => of(Rodas4::new(&y, [0.0; 4]), &test),
    }
}

/// What a step may add to a motion that does not grow: what adds less takes more steps to show than a run has.
const GROWTH: f64 = 1e-3;

/// The largest |z| along the ray of an eigenvalue up to which a method is stable; `None` if it is unbounded.
pub(crate) fn limit_along(integrator: Integrator, eigenvalue: Complex<f64>) -> Option<f64> {
    let direction = eigenvalue / eigenvalue.norm();
    let is_stable = |length: f64| {
        let z = direction * length;
        amplification(integrator, z) <= 1.0_f64.max(z.re.exp()) + GROWTH
    };
    let ladder =
        std::iter::successors(Some(FIRST), |length| Some(length * RATIO)).take_while(|length| *length < LAST);
    let mut high = ladder.into_iter().find(|length| !is_stable(*length))?;
    let mut low = high / RATIO;
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if is_stable(middle) { low = middle } else { high = middle }
    }
    Some(low)
}

/// Where a ray is looked at.
const FIRST: f64 = 0.05;
const RATIO: f64 = 1.01;
const LAST: f64 = 1e3;

/// The largest stable step for a system with these eigenvalues, 1/s.
pub(crate) fn limit(integrator: Integrator, eigenvalues: &[Complex<f64>]) -> Option<f64> {
    let fastest = eigenvalues.iter().map(|l| l.norm()).fold(0.0, f64::max);
    let steps = eigenvalues
        .iter()
        .filter(|l| l.norm() > NEGLIGIBLE * fastest)
        .filter_map(|l| Some(limit_along(integrator, *l)? / l.norm()));
    steps.min_by(f64::total_cmp)
}

/// Eigenvalues this much smaller than the largest are zeros as far as differences can tell.
const NEGLIGIBLE: f64 = 1e-4;

/// A number of a scene that is varied.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Knob {
    /// The damping of a force, by its index.
    Damping(usize, f64),
    /// All velocities of the start, by a factor.
    Rates,
}

impl Knob {
    /// The damping of the first damper, or else the rates of the start.
    pub(crate) fn of(model: &Model) -> Self {
        let damping = model.forces.iter().enumerate().find_map(|(index, force)| match &force.kind {
            ForceKind::Damper { damping: Number::Exact(value), .. } => {
                Some(Self::Damping(index, to_f64(value)))
            }
            _ => None,
        });
        damping.unwrap_or(Self::Rates)
    }

    pub(crate) fn label(self, model: &Model) -> String {
        match self {
            Self::Damping(force, _) => {
                format!("damping of `{}` in SI units", model.forces[force].name).replace('`', "")
            }
            Self::Rates => "rates of the start, as multiples of the model file's".to_owned(),
        }
    }

    /// How far it is turned either way, in decades: with slower rates other motions take over than those about the
    /// start.
    pub(crate) fn decades(self) -> u32 {
        match self {
            Self::Damping(..) => 2,
            Self::Rates => 1,
        }
    }

    /// The model file's own value.
    pub(crate) fn nominal(self) -> f64 {
        match self {
            Self::Damping(_, value) => value,
            Self::Rates => 1.0,
        }
    }
}

/// Eigenvalues about the start, in joint coordinates where linear theory has them, else in maximal ones.
#[derive(Clone, Debug)]
pub(crate) struct Spectrum {
    pub(crate) eigenvalues: Vec<Complex<f64>>,
    pub(crate) coordinates: Coordinates,
}

impl Spectrum {
    /// At a value of the knob, or the reason why there is none.
    pub(crate) fn new(model: &Model, knob: Knob, value: f64) -> Result<Self, String> {
        let (mut model, mut factor) = (model.clone(), 1.0);
        match knob {
            Knob::Rates => factor = value,
            Knob::Damping(force, _) => {
                if let ForceKind::Damper { damping, .. } = &mut model.forces[force].kind {
                    *damping =
                        Rational::from_float(value).map(Number::Exact).ok_or("the damping is not finite")?;
                }
            }
        }
        let matrix = |a: DMatrix<f64>| {
            if a.is_empty() {
                return Ok(Vec::new());
            }
            let schur = Schur::try_new(a, f64::EPSILON, 100_000).ok_or("the eigenvalues do not converge")?;
            Ok::<_, String>(schur.complex_eigenvalues().iter().copied().collect())
        };
        if let Ok(linear) = Linear::about_start_at(&model, factor) {
            return Ok(Self {
                eigenvalues: matrix(linear.matrix().clone())?,
                coordinates: Coordinates::Joint,
            });
        }
        let eigenvalues = matrix(maximal(&model, factor)?)?;
        Ok(Self { eigenvalues, coordinates: Coordinates::Maximal })
    }
}

/// The Jacobian in maximal coordinates by central differences of sixth order of the dense runtime-assembled model.
fn maximal(model: &Model, factor: f64) -> Result<DMatrix<f64>, String> {
    const WEIGHTS: [(f64, f64); 3] = [(1.0, 45.0), (2.0, -9.0), (3.0, 1.0)];
    let dense = Dense::<f64>::new(model).map_err(|e| e.to_string())?;
    let mut start = dense.start();
    let n_bodies = model.coordinate_bodies().len();
    let state: &mut [f64] = start.as_mut();
    state[7 * n_bodies..13 * n_bodies].iter_mut().for_each(|velocity| *velocity *= factor);
    let size = start.len();
    let mut jacobian: DMatrix<f64> = DMatrix::zeros(size, size);
    for column in 0..size {
        let step = STEP * start[column].abs().max(1e-2);
        for (distance, weight) in WEIGHTS {
            for side in [1.0, -1.0] {
                let (mut y, mut dy) = (start.clone(), start.clone());
                y[column] += side * distance * step;
                dense.derivative(0.0, &y, &mut dy);
                for (row, slope) in dy.iter().enumerate() {
                    jacobian[(row, column)] += side * weight * slope / (60.0 * step);
                }
            }
        }
    }
    if jacobian.iter().all(|x: &f64| x.is_finite()) {
        Ok(jacobian)
    } else {
        Err("the Jacobian is not finite".to_owned())
    }
}

/// Of differences, relative to an element.
const STEP: f64 = 1e-3;

/// Steps of a run that decides: growth of one in a thousand shows.
const STEPS: u64 = 4000;

/// Samples of such a run: a motion that bursts may die again, having taken the scene's energy with it.
const SAMPLES: f64 = 500.0;

/// Relative width to which a limit is found.
const WIDTH: f64 = 0.01;

/// A step that was tried, and whether the run stayed bounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Trial {
    pub(crate) step: f64,
    pub(crate) is_stable: bool,
}

/// What runs with fixed steps say of the limit of an integrator.
#[derive(Clone, Debug, Default)]
pub(crate) struct Found {
    pub(crate) trials: Vec<Trial>,
    /// The largest stable step, s, to one in a hundred.
    pub(crate) limit: Option<f64>,
}

/// Bisects between steps around a guess.
pub(crate) fn search(guess: f64, mut is_stable: impl FnMut(f64) -> bool) -> Found {
    let mut found = Found::default();
    let mut tried = |step: f64, found: &mut Found| {
        let is_stable = is_stable(step);
        found.trials.push(Trial { step, is_stable });
        is_stable
    };
    let (mut low, mut high) = (0.5 * guess, 2.0 * guess);
    for _ in 0..8 {
        if tried(low, &mut found) {
            break;
        }
        (low, high) = (0.25 * low, low);
    }
    for _ in 0..8 {
        if !tried(high, &mut found) {
            break;
        }
        (low, high) = (high, 4.0 * high);
    }
    let was = |step: f64, is_stable: bool| found.trials.contains(&Trial { step, is_stable });
    if !was(low, true) || !was(high, false) {
        return found;
    }
    while high / low > 1.0 + WIDTH {
        let middle = (low * high).sqrt();
        if tried(middle, &mut found) { low = middle } else { high = middle }
    }
    found.limit = Some(low);
    found
}

/// A run counts as unstable when it fails or when a rate exceeds the largest that it has in an accurate run this many
/// times. What hardly turns there may turn as fast as this part of the fastest.
const BOUND: f64 = 10.0;
const SLOW: f64 = 1e-4;

/// The limits of an integrator on a lab's scene as it is set.
pub(crate) fn find(
    lab: &mut Lab,
    integrator: Integrator,
    coordinates: Coordinates,
    guess: f64,
) -> Result<Found, String> {
    let who = (Engine::Generated, Precision::F64);
    let approach = |integrator, tolerance| Approach {
        integrator,
        tolerance,
        coordinates,
        correction: Correction::Partition,
        when: Some(When::Steps(1)),
        budget: tolerance.map(|_: f64| 200_000),
        patience: None,
        examine: false,
        leaves_stiff: false,
        meets_knots: false,
    };
    let plan = |t_end: f64, step: f64, approach| Plan {
        settings: Settings { t_end, step, correct_every: None, sample_every: t_end / SAMPLES },
        approach,
        measure_for: None,
    };
    let t_end = lab.t_end.min(STEPS as f64 * guess);
    let accurate = lab.run(who, &plan(t_end, t_end, approach(Integrator::Rodas4, Some(1e-6))))?;
    let largest = accurate.samples.iter().map(rates).reduce(larger).unwrap_or_default();
    let fastest = largest.iter().copied().fold(0.0, f64::max);
    let is_bounded = |rates: &[f64]| {
        // What is not a number is not bounded.
        rates.iter().zip(&largest).all(|(rate, largest)| *rate <= BOUND * largest.max(SLOW * fastest))
    };
    Ok(search(guess, |step| {
        let run = lab.run(who, &plan(STEPS as f64 * step, step, approach(integrator, None)));
        run.is_ok_and(|run| run.samples.iter().map(rates).all(|rates| is_bounded(&rates)))
    }))
}

/// The sizes of all rates of a sample.
fn rates(sample: &Sample) -> Vec<f64> {
    let mut rates = Vec::new();
    for coordinate in &sample.coordinates {
        match coordinate {
            JointSample::Angle { rate, .. } | JointSample::Length { rate, .. } => rates.push(rate.abs()),
            JointSample::Orientation { rate, .. } => rates.extend(rate.map(f64::abs)),
        }
    }
    rates.extend(sample.bodies.iter().flat_map(|body| body.velocity.map(f64::abs)));
    rates
}

fn larger(a: Vec<f64>, b: Vec<f64>) -> Vec<f64> {
    a.iter().zip(&b).map(|(a, b)| a.max(*b)).collect()
}

/// A lab in which the knob can be turned.
pub(crate) fn turnable(lab: &Lab, knob: Knob) -> Result<Lab, crate::failure::Failure> {
    let Knob::Damping(force, value) = knob else { return lab.again() };
    let mut model = lab.model.clone();
    let mut parameters: Vec<f64> = model.parameters.iter().map(|p| to_f64(&p.value)).collect();
    parameters.push(value);
    if let ForceKind::Damper { damping, .. } = &mut model.forces[force].kind {
        *damping = Number::Parameter { index: model.parameters.len(), negated: false };
    }
    let value = Rational::from_float(value).unwrap_or_default();
    model.parameters.push(gyro_model::Parameter { name: "map_damping".to_owned(), value });
    lab.variant(model, parameters)
}

/// Turns the knob.
pub(crate) fn turn(lab: &mut Lab, nominal: &Lab, knob: Knob, value: f64) {
    match knob {
        Knob::Damping(..) => {
            let mut parameters: Vec<f64> =
                nominal.model.parameters.iter().map(|p| to_f64(&p.value)).collect();
            parameters.push(value);
            lab.set_parameters(parameters);
        }
        Knob::Rates => {
            lab.start.velocities = nominal.start.velocities.iter().map(|velocity| value * velocity).collect();
        }
    }
}

#[cfg(test)]
mod tests;
