//! What `simulate --verify` says of a run's error is held against the error.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_jit::Native;
use gyro_reference::{JointRow, scene};
use gyro_runner::{
    Approach, Coordinates, Difference, Integrator, JointSample, Sample, Settings, companions, differences,
};
use gyro_sim::Real;
use gyro_sim_suite::{
    Duals, EXTREME, Engine, duals, fixture_folders, generated, generated_in, model, moved, rotation, start_of,
};
use std::collections::HashMap;

/// How far a joint coordinate or its rate is off, and how large it is, both at worst.
#[derive(Clone, Copy, Debug, Default)]
pub struct Deviation {
    pub error: f64,
    pub size: f64,
}

impl Deviation {
    fn add(&mut self, error: f64, size: f64) {
        // NaN stays NaN.
        self.error = if error <= self.error || self.error.is_nan() { self.error } else { error };
        self.size = self.size.max(size);
    }
}

/// Of each joint coordinate over a run: of positions, then of rates. Orientations differ by an angle.
pub fn deviations(samples: &[Sample], rows: &[JointRow]) -> [Vec<Deviation>; 2] {
    let n = samples.first().map_or(0, |sample| sample.coordinates.len());
    let mut worst = [vec![Deviation::default(); n], vec![Deviation::default(); n]];
    for (sample, row) in samples.iter().zip(rows) {
        let mut scalars = row.positions.iter().zip(&row.rates);
        let mut orientations = row.orientations.iter();
        let [positions, rates] = &mut worst;
        for (joint, (position, rate)) in sample.coordinates.iter().zip(positions.iter_mut().zip(rates)) {
            match *joint {
                JointSample::Angle { position: x, rate: v }
                | JointSample::Length { position: x, rate: v } => {
                    let (expected, slope) = scalars.next().expect("a reference has all joints");
                    position.add((x - expected).abs(), expected.abs());
                    rate.add((v - slope).abs(), slope.abs());
                }
                JointSample::Orientation { position: p, rate: w } => {
                    let expected = orientations.next().expect("a reference has all joints");
                    let (found, is) = (rotation(p).concat(), expected.rotation.concat());
                    position.add(distance(&found, &is) / std::f64::consts::SQRT_2, 0.0);
                    let slope = expected.angular_velocity;
                    rate.add(distance(&w, &slope), distance(&slope, &[0.0; 3]));
                }
            }
        }
    }
    worst
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The reference of a model file at the times of samples.
pub fn expected(page: &str, settings: &Settings) -> Vec<JointRow> {
    let n = (settings.t_end / settings.sample_every).round() as u32;
    let times: Vec<f64> = (0..=n).map(|k| f64::from(k) * settings.sample_every).collect();
    scene(page).unwrap_or_else(|| panic!("{page} has no reference")).solve(&times)
}

/// The estimate of each coordinate's error as the command line makes it: by the first companion that comes to its end.
/// `run` makes companions.
pub fn estimate(
    samples: &[Sample],
    settings: &Settings,
    approach: &Approach,
    mut run: impl FnMut(&Settings, &Approach) -> Option<Vec<Sample>>,
) -> Option<Vec<Difference>> {
    let companions = companions(settings, approach);
    let other = companions.iter().find_map(|(settings, approach)| run(settings, approach))?;
    Some(differences(samples, &other))
}

/// Steps of a model file's own length, and samples of a run.
const STEPS: f64 = 1000.0;
const SAMPLES: f64 = 10.0;

/// The estimate is never so many times too small, nor so many times too large.
const TOO_SMALL: f64 = 10.0;
const TOO_LARGE: f64 = 100.0;

/// Errors smaller than a hundred units in the last place are rounding, and not estimated.
const ULPS: f64 = 100.0 * f64::EPSILON;

/// A model file whose motion leads through a singular pose, where a run may end.
const SINGULAR: &str = "four-bar-in-line";

/// A model file, and the companions that it has had.
struct Page {
    name: String,
    engine: Engine,
    rows: Vec<JointRow>,
    settings: Settings,
    companions: HashMap<String, Option<Vec<Sample>>>,
    /// Errors estimated, and the smallest and the largest estimate in terms of the error.
    n_estimates: u32,
    range: [f64; 2],
    wrong: Vec<String>,
}

impl Page {
    /// `None` for a model file that has no reference.
    fn new(name: &str) -> Option<Self> {
        scene(name)?;
        let step = model(name).simulation.step;
        let t_end = STEPS * step;
        let settings =
            Settings { t_end, step, correct_every: Some(5.0 * step), sample_every: t_end / SAMPLES };
        Some(Self {
            name: name.to_owned(),
            engine: generated(name),
            rows: expected(name, &settings),
            settings,
            companions: HashMap::new(),
            n_estimates: 0,
            range: [f64::INFINITY, 0.0],
            wrong: Vec::new(),
        })
    }

    fn duals<T: Native + Real>(&self) -> Duals<T> {
        if EXTREME.contains(&self.name.as_str()) { duals(&self.name) } else { Duals::none() }
    }

    /// A run by an approach in steps of so many times the model file's own.
    fn check<T: Native + Real>(&mut self, engine: &Engine<T>, times: f64, approach: &Approach) {
        let (step, start) = (times * self.settings.step, start_of(&model(&self.name)));
        let settings = Settings { step, correct_every: Some(5.0 * step), ..self.settings };
        let what = format!("{}, {approach}, step {step:e} s", self.name);
        let (samples, outcome) = moved(engine, &*engine.builder(self.duals()), (&settings, approach), &start);
        if let Err(failure) = outcome {
            // What ends in an error has no verdict.
            if self.name != SINGULAR {
                self.wrong.push(format!("{what}: {failure}"));
            }
            return;
        }
        let (double, builder) = (&self.engine, self.engine.builder(self.duals()));
        let companions = &mut self.companions;
        let estimates = estimate(&samples, &settings, approach, |settings, approach| {
            // Error control does not ask for a step.
            let step = approach.tolerance.map_or(settings.step, |_| 0.0);
            let run = || {
                let (samples, outcome) = moved(double, &*builder, (settings, approach), &start);
                outcome.is_ok().then_some(samples)
            };
            companions.entry(format!("{step} {approach:?}")).or_insert_with(run).clone()
        });
        let Some(estimates) = estimates else {
            return self.wrong.push(format!("{what}: no companion has come to its end"));
        };
        let [positions, rates] = deviations(&samples, &self.rows);
        let of = |deviations: Vec<Deviation>, estimate: fn(&Difference) -> f64| {
            let estimates: Vec<f64> = estimates.iter().map(estimate).collect();
            deviations.into_iter().zip(estimates).enumerate()
        };
        for (k, (deviation, estimate)) in of(positions, |e| e.position).chain(of(rates, |e| e.rate)) {
            let Deviation { error, size } = deviation;
            if error <= ULPS * (1.0 + size) {
                continue;
            }
            let ratio = estimate / error;
            self.n_estimates += 1;
            self.range = [self.range[0].min(ratio), self.range[1].max(ratio)];
            if !(1.0 / TOO_SMALL..=TOO_LARGE).contains(&ratio) {
                self.wrong
                    .push(format!("{what}: coordinate {k} is off by {error:.1e}, estimated {estimate:.1e}"));
            }
        }
    }
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn the_estimate_is_of_the_size_of_the_error() {
    let mut wrong = Vec::new();
    for name in fixture_folders()[0].pages() {
        let Some(mut page) = Page::new(&name) else { continue };
        let engine = page.engine.clone();
        let (is_tree, is_extreme) = (engine.is_tree(), EXTREME.contains(&name.as_str()));
        let controlled = |integrator, tolerance| Approach {
            integrator,
            tolerance: Some(tolerance),
            coordinates: if is_tree { Coordinates::Joint } else { Coordinates::Maximal },
            ..Approach::default()
        };
        page.check(&engine, 1.0, &Approach::default());
        page.check(&engine, 10.0, &Approach::default());
        page.check(&engine, 1.0, &controlled(Integrator::Dop853, 1e-6));
        if is_tree || is_extreme {
            page.check(&engine, 1.0, &controlled(Integrator::Rodas4, 1e-5));
        }
        if is_extreme {
            page.check(&generated_in::<f32>(&name), 1.0, &Approach::default());
        }
        assert!(page.n_estimates > 0, "{name}: nothing to estimate");
        println!("{name}: {} estimates, {:.2?} times the error", page.n_estimates, page.range);
        wrong.append(&mut page.wrong);
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn an_estimate_of_another_error_does_not_pass() {
    // The check must be able to fail: the error against the reference of another model file is not what companions
    // estimate.
    let mut page = Page::new("gyroscope").expect("it has a reference");
    page.rows = expected("gyroscope-light-rings", &page.settings);
    let engine = page.engine.clone();
    page.check(&engine, 1.0, &Approach::default());
    assert!(!page.wrong.is_empty(), "{:?}", page.range);
}
