//! Planar linkages drawn at random that pass a singular pose, in all kinds of runs: each goes on in the way that the
//! motion does, or the pose is named. None is wrong in silence.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use crate::poses::{HEAD, hinge, read, rod, rough};
use gyro_assembled::Dense;
use gyro_jit::Native;
use gyro_model::Model;
use gyro_runner::motion::{MotionBuilder, Projecting};
use gyro_runner::{
    Approach, BodySample, Correction, Failure, Integrator, Sample, Settings, Summary, When, balance,
};
use gyro_sim::Real;
use gyro_sim_suite::{Engine, Random, duals, generated, generated_in, model, moved, played, start_of};
use std::f64::consts::{PI, TAU};

/// Runs of the seeded sample; `GYRO_BRANCHES` asks for another number.
const RUNS: usize = 60;
const SEED: u64 = 3;

/// Bars that are off by more, rad, have gone another way, or the run is too coarse for what it was made for.
const WRONG: f64 = 2e-2;

const GRAVITY: f64 = 9.81;
const SAMPLES: f64 = 20.0;
const BUDGET: u64 = 20_000;

/// A bar of a linkage whose motion is a function of one angle.
#[derive(Clone, Copy, Debug)]
struct Bar {
    mass: f64,
    length: f64,
}

/// A linkage with one singular pose at the crank's angle zero.
#[derive(Clone, Debug)]
enum Linkage {
    /// As many bars on the ground as couplers and one more, so far apart.
    Parallelograms { bars: Vec<Bar>, couplers: Vec<Bar>, lean: f64 },
    /// Crank and ground of one length, coupler and rocker of another, longer one: the crank folds onto the ground.
    Kite { crank: Bar, coupler: Bar, rocker: Bar },
    /// `models/four-bar-in-line.toml`, generated.
    InLine,
}

/// Place of the mass centre, m, and angle, rad.
type Pose = [f64; 3];

fn along([x, y]: [f64; 2], length: f64, angle: f64) -> [f64; 2] {
    [x + length * angle.cos(), y + length * angle.sin()]
}

fn middle([a, b]: [f64; 2], [c, d]: [f64; 2], angle: f64) -> Pose {
    [0.5 * (a + c), 0.5 * (b + d), angle]
}

impl Linkage {
    fn draw(random: &mut Random) -> Self {
        let bar = |random: &mut Random, length: f64| Bar { mass: 10f64.powf(0.7 * random.signed()), length };
        let scale = 10f64.powf(0.5 * random.signed());
        match random.below(5) {
            0 => Self::InLine,
            1 | 2 => {
                let n = 1 + random.below(2);
                let (crank, spacing) = (scale, scale * (1.5 + random.signed()));
                Self::Parallelograms {
                    bars: (0..=n).map(|_| bar(random, crank)).collect(),
                    couplers: (0..n).map(|_| bar(random, spacing)).collect(),
                    lean: 0.5 * PI * random.signed(),
                }
            }
            _ => {
                let long = scale * (1.7 + 0.6 * random.signed());
                Self::Kite {
                    crank: bar(random, scale),
                    coupler: bar(random, long),
                    rocker: bar(random, long),
                }
            }
        }
    }

    /// Bodies in the order of the model file.
    fn bodies(&self) -> Vec<Bar> {
        match self {
            Self::Parallelograms { bars, couplers, .. } => [bars.clone(), couplers.clone()].concat(),
            Self::Kite { crank, coupler, rocker } => vec![*crank, *coupler, *rocker],
            Self::InLine => Vec::new(),
        }
    }

    /// Where all bodies are, as the crank is at this angle from the pose.
    fn poses(&self, angle: f64) -> Vec<Pose> {
        match self {
            Self::Parallelograms { bars, couplers, lean } => {
                let spacing = couplers[0].length;
                let pivots: Vec<[f64; 2]> =
                    (0..bars.len()).map(|k| along([0.0; 2], k as f64 * spacing, *lean)).collect();
                let tips: Vec<[f64; 2]> =
                    pivots.iter().map(|pivot| along(*pivot, bars[0].length, lean + angle)).collect();
                let standing =
                    pivots.iter().zip(&tips).map(|(pivot, tip)| middle(*pivot, *tip, lean + angle));
                standing.chain(tips.windows(2).map(|ends| middle(ends[0], ends[1], *lean))).collect()
            }
            Self::Kite { crank, coupler, .. } => {
                let (pivot, elbow) = ([crank.length, 0.0], along([0.0; 2], crank.length, angle));
                let half = 0.5 * angle;
                let (opening, axis) = (crank.length * half.sin(), half);
                let height = (coupler.length.powi(2) - opening * opening).sqrt();
                // From the middle between elbow and pivot along the kite's axis.
                let knee = along([0.5 * (pivot[0] + elbow[0]), 0.5 * (pivot[1] + elbow[1])], height, axis);
                let toward = |[a, b]: [f64; 2]| (knee[1] - b).atan2(knee[0] - a);
                vec![
                    middle([0.0; 2], elbow, angle),
                    middle(elbow, knee, toward(elbow)),
                    middle(pivot, knee, toward(pivot)),
                ]
            }
            Self::InLine => vec![[0.0, 0.0, angle]; 1],
        }
    }

    /// ∂(poses)/∂(angle) by differences of fourth order.
    fn slopes(&self, angle: f64) -> Vec<Pose> {
        const H: f64 = 1e-3;
        let at = |k: f64| self.poses(angle + k * H);
        let (a, b, c, d) = (at(-2.0), at(-1.0), at(1.0), at(2.0));
        let slope = |i: usize, k: usize| {
            let turned = |x: f64| if k == 2 { x - TAU * (x / TAU).round() } else { x };
            (8.0 * turned(c[i][k] - b[i][k]) - turned(d[i][k] - a[i][k])) / (12.0 * H)
        };
        (0..a.len()).map(|i| [0, 1, 2].map(|k| slope(i, k))).collect()
    }

    /// What the angle's kinetic energy is half of, over its rate squared, and the potential energy.
    fn inertia_and_potential(&self, angle: f64) -> [f64; 2] {
        if matches!(self, Self::InLine) {
            // The head of the model file: I = 0.0507 kg.m2, G = 2.7468 N.m.
            return [0.0507, 2.7468 * angle.sin()];
        }
        let (poses, slopes) = (self.poses(angle), self.slopes(angle));
        let mut sums = [0.0; 2];
        for ((bar, pose), [x, y, turn]) in self.bodies().iter().zip(&poses).zip(slopes) {
            sums[0] += bar.mass * (x * x + y * y + bar.length * bar.length / 12.0 * turn * turn);
            sums[1] += bar.mass * GRAVITY * pose[1];
        }
        sums
    }

    /// θ̈ = −(½ m' θ̇² + V') / m.
    fn acceleration(&self, angle: f64, rate: f64) -> f64 {
        const H: f64 = 1e-3;
        let of = |k: f64| self.inertia_and_potential(angle + k * H);
        let (a, b, c, d) = (of(-2.0), of(-1.0), of(1.0), of(2.0));
        let slope = |k: usize| (8.0 * (c[k] - b[k]) - (d[k] - a[k])) / (12.0 * H);
        -(0.5 * slope(0) * rate * rate + slope(1)) / self.inertia_and_potential(angle)[0]
    }

    /// Angle and rate after a time, by so many steps.
    fn advance(&self, [angle, rate]: [f64; 2], t: f64, n: usize) -> [f64; 2] {
        let h = t / n as f64;
        let slope = |y: [f64; 2]| [y[1], self.acceleration(y[0], y[1])];
        let mut y = [angle, rate];
        for _ in 0..n {
            let on = |k: [f64; 2], h: f64| [y[0] + h * k[0], y[1] + h * k[1]];
            let k1 = slope(y);
            let k2 = slope(on(k1, 0.5 * h));
            let k3 = slope(on(k2, 0.5 * h));
            let k4 = slope(on(k3, h));
            y = [0, 1].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
        }
        y
    }

    fn page(&self, angle: f64, rate: f64) -> String {
        let poses = self.poses(angle);
        let mut page = HEAD.to_owned();
        let names = |n: usize, what: &str| (0..n).map(|k| format!("{what}{k}")).collect::<Vec<_>>();
        let start = format!("angle_deg = {:?}\nrate = {rate:?}", poses[0][2].to_degrees());
        match self {
            Self::Parallelograms { bars, couplers, lean } => {
                let (standing, across) = (names(bars.len(), "bar"), names(couplers.len(), "coupler"));
                let all = standing.iter().chain(&across).zip(bars.iter().chain(couplers));
                all.for_each(|(name, bar)| page += &rod(name, bar.length, bar.mass));
                for (k, name) in standing.iter().enumerate() {
                    let [x, y] = along([0.0; 2], k as f64 * couplers[0].length, *lean);
                    let joint = hinge(
                        &format!("pivot{k}"),
                        ("ground", 0.0),
                        (name, -0.5 * bars[0].length),
                        &if k == 0 { start.clone() } else { rough(poses[k][2]) },
                    );
                    let ground = "{ body = \"ground\", point = [0.0, 0, 0] }";
                    page += &joint
                        .replace(ground, &format!("{{ body = \"ground\", point = [{x:?}, {y:?}, 0] }}"));
                }
                for (k, name) in across.iter().enumerate() {
                    for (bar, end) in [(k, -0.5), (k + 1, 0.5)] {
                        let angle = rough(lean - poses[bar][2]);
                        let tip = (&*standing[bar], 0.5 * bars[0].length);
                        page +=
                            &hinge(&format!("joint{k}_{bar}"), tip, (name, end * couplers[0].length), &angle);
                    }
                }
            }
            Self::Kite { crank, coupler, rocker } => {
                for (name, bar) in [("crank", crank), ("coupler", coupler), ("rocker", rocker)] {
                    page += &rod(name, bar.length, bar.mass);
                }
                page += &hinge("pivot", ("ground", 0.0), ("crank", -0.5 * crank.length), &start);
                page += &hinge(
                    "foot",
                    ("ground", crank.length),
                    ("rocker", -0.5 * rocker.length),
                    &rough(poses[2][2]),
                );
                let (elbow, knee) = (rough(poses[1][2] - poses[0][2]), rough(poses[2][2] - poses[1][2]));
                page += &hinge(
                    "elbow",
                    ("crank", 0.5 * crank.length),
                    ("coupler", -0.5 * coupler.length),
                    &elbow,
                );
                page +=
                    &hinge("knee", ("coupler", 0.5 * coupler.length), ("rocker", 0.5 * rocker.length), &knee);
            }
            Self::InLine => page = String::new(),
        }
        page
    }
}

/// A run as it is drawn.
#[derive(Clone, Debug)]
struct Case {
    linkage: Linkage,
    start: [f64; 2],
    is_single: bool,
    settings: Settings,
    approach: Approach,
}

impl Case {
    /// From before the pose to behind it, at a speed there from slow to fast.
    fn draw(random: &mut Random) -> Self {
        let linkage = Linkage::draw(random);
        let (start, t_end) = match linkage {
            Linkage::InLine => ([-PI / 3.0, 12.0 * (1.15 + 0.25 * random.signed())], 0.5),
            _ => Self::throw(&linkage, random),
        };
        let is_single = random.below(4) == 0;
        let integrators = [Integrator::Rk4, Integrator::Tsit5, Integrator::Dop853, Integrator::Rodas4];
        let has_derivatives = matches!(linkage, Linkage::InLine);
        let integrator = integrators[random.below(if has_derivatives { 4 } else { 3 })];
        let corrections = [
            Correction::Partition,
            Correction::MassWeighted,
            Correction::Baumgarte(10f64.powf(1.0 + random.signed())),
            Correction::None,
        ];
        let correction = corrections[random.below(4)];
        let steers = matches!(correction, Correction::Baumgarte(_));
        let integrator =
            if steers && integrator == Integrator::Rodas4 { Integrator::Dop853 } else { integrator };
        let when =
            [None, Some(When::Steps(1)), Some(When::Steps(7)), Some(When::Violation(1e-6))][random.below(4)];
        let step = t_end * 10f64.powf(-2.4 + 0.6 * random.signed());
        let is_fixed = integrator == Integrator::Rk4 || random.below(2) == 0;
        let tolerance =
            10f64.powf(if is_single { -4.0 + random.signed() } else { -8.0 + 4.0 * random.signed() });
        Self {
            linkage,
            start,
            is_single,
            settings: Settings {
                t_end,
                step,
                correct_every: Some(5.0 * step),
                sample_every: t_end / SAMPLES,
            },
            approach: Approach {
                integrator,
                correction,
                when,
                tolerance: (!is_fixed).then_some(tolerance),
                budget: Some(if integrator == Integrator::Rodas4 { 2000 } else { BUDGET }),
                ..Approach::default()
            },
        }
    }

    fn throw(linkage: &Linkage, random: &mut Random) -> ([f64; 2], f64) {
        let (before, behind) = (0.7 + 0.4 * random.signed(), 0.7 + 0.4 * random.signed());
        let size = linkage.bodies()[0].length;
        let rate = 10f64.powf(0.3 + 0.7 * random.signed()) * (GRAVITY / size).sqrt();
        // Backwards from the pose, and on from there: what is thrown passes it with this speed.
        let mut y = [0.0, rate];
        let mut t = 0.0;
        let dt = 1e-2 / rate;
        while y[0] > -before && t < 1.0 / rate.min(1.0) && y[1] > 0.1 * rate {
            y = linkage.advance(y, -dt, 1);
            t += dt;
        }
        let start = y;
        let mut y = [0.0, rate];
        while y[0] < behind && y[1].abs() > 0.1 * rate {
            y = linkage.advance(y, dt, 1);
            t += dt;
        }
        (start, t)
    }

    fn run(&self) -> (Vec<Sample>, Result<Summary, Failure>) {
        if self.is_single { self.run_in::<f32>() } else { self.run_in::<f64>() }
    }

    fn run_in<T: Native + Real + gyro_assembled::Number + 'static>(
        &self,
    ) -> (Vec<Sample>, Result<Summary, Failure>) {
        let by = (&self.settings, &self.approach);
        if let Linkage::InLine = self.linkage {
            let page = "four-bar-in-line";
            let mut start = start_of(&model(page));
            start.velocities.iter_mut().for_each(|v| *v *= self.start[1] / 12.0);
            let engine = generated_in::<T>(page);
            return moved(&engine, &*engine.builder(duals(page)), by, &start);
        }
        let model: Model = read(&self.linkage.page(self.start[0], self.start[1]));
        let engine = Engine::new(Dense::<T>::new(&model).unwrap_or_else(|error| panic!("{error}")));
        moved(&engine, &Projecting as &dyn MotionBuilder<Engine<T>>, by, &start_of(&model))
    }

    /// The worst error of an angle of a bar at any sample, rad.
    fn error(&self, samples: &[Sample]) -> f64 {
        let (mut y, mut t, mut worst) = (self.start, 0.0, 0.0_f64);
        for sample in samples {
            if sample.t > t {
                let n = (400.0 * (sample.t - t) / self.settings.t_end).ceil() as usize;
                y = self.linkage.advance(y, sample.t - t, n);
                t = sample.t;
            }
            for ([_, _, expected], body) in self.linkage.poses(y[0]).iter().zip(&sample.bodies) {
                let off = (angle_of(body) - expected).rem_euclid(TAU);
                let off = off.min(TAU - off);
                worst = if off <= worst { worst } else { off };
            }
        }
        worst
    }
}

/// Of a body that turns about the third axis.
fn angle_of(body: &BodySample) -> f64 {
    let [_, _, _, e0, _, _, e3] = body.pose;
    2.0 * e3.atan2(e0)
}

#[derive(Debug, Default)]
struct Tally {
    right: usize,
    named_and_right: usize,
    refused: usize,
    named_and_wrong: usize,
    unbalanced: usize,
    silent: Vec<String>,
}

impl Tally {
    fn add(&mut self, case: &Case) {
        let (samples, outcome) = case.run();
        let error = case.error(&samples);
        let is_right = error <= WRONG;
        let what = format!(
            "{:?} from {:?}, {}{}, {:?}, step {:.1e} s of {:.3} s: off by {error:.1e}",
            case.linkage,
            case.start,
            case.approach,
            if case.is_single { ", f32" } else { "" },
            case.approach.when,
            case.settings.step,
            case.settings.t_end
        );
        match outcome {
            // An error tells what has come before too.
            Err(failure) if !names_pose(&failure) => self.silent.push(format!("{what}, {failure}")),
            Err(_) => self.refused += 1,
            Ok(summary) => {
                let is_named = summary.statistics.passages > 0;
                match (is_right, is_named) {
                    (true, false) => self.right += 1,
                    (true, true) => self.named_and_right += 1,
                    (false, true) => self.named_and_wrong += 1,
                    (false, false) if !balance(&summary, true).is_empty() => self.unbalanced += 1,
                    (false, false) => self.silent.push(format!("{what}, {summary:?}")),
                }
            }
        }
    }
}

fn names_pose(failure: &Failure) -> bool {
    let words = failure.to_string();
    words.contains("singular pose") && words.contains("the constraints of ")
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn no_way_on_is_wrong_in_silence() {
    let asked = |name: &str| std::env::var(name).ok().and_then(|n| n.parse::<u64>().ok());
    let n_runs = asked("GYRO_BRANCHES").unwrap_or(RUNS as u64);
    let mut random = Random::new(asked("GYRO_SEED").unwrap_or(SEED));
    let mut tally = Tally::default();
    for _ in 0..n_runs {
        tally.add(&Case::draw(&mut random));
    }
    let Tally { right, named_and_right, refused, named_and_wrong, unbalanced, silent } = &tally;
    println!(
        "{n_runs} runs: {right} right, {named_and_right} right past a pose that is named, {refused} ended naming it, {named_and_wrong} wrong \
         and named, {unbalanced} with an open balance, {} silent",
        silent.len()
    );
    assert!(silent.is_empty(), "{} silent:\n{}", silent.len(), silent.join("\n"));
    assert!(right + named_and_right > 0, "no run is right");
}

/// Loops that have no singular pose on their way, and gears whose elimination takes another pivot now and then.
#[test]
fn where_there_is_no_pose_none_is_named() {
    for page in [
        "four-bar",
        "four-bar-revolute",
        "differential",
        "planetary",
        "gear",
        "gear-pair",
        "rack-and-screw",
        "driven-shaft",
        "driven-four-bar",
    ] {
        let run = played(&generated(page), &model(page));
        let statistics = run.summary.statistics;
        assert_eq!((statistics.passages, statistics.first_passage), (0, None), "{page}");
    }
}
