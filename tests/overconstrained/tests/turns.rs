//! Loops that should not move, through whole turns: closed, of constant energy, and clear of singular poses as long
//! as the screws of their joints are.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use chacha20::ChaCha8Rng;
use gyro_assembled::Dense;
use gyro_codegen::{Effort, Functions};
use gyro_jit::Compiled;
use gyro_model::Model;
use gyro_overconstrained::whole_numbers::WholeNumbers;
use gyro_overconstrained::{KINDS, Loop, Placed, Pose};
use gyro_runner::motion::{Element, MotionBuilder, OperatingPoint, Tree};
use gyro_sim::{
    CloseLoops, Control, Corrected, CorrectedDynamics, Correction, Dop853, Joint, JointPlace, JointSpace,
    Mechanism, Ode, Partition, Partitioning, Solver, Statistics,
};
use gyro_verifier::{Depth, verify};
use nalgebra::{Quaternion, UnitQuaternion};
use rand::SeedableRng;
use std::f64::consts::TAU;

/// Of the runs.
const TOLERANCE: f64 = 1e-11;

/// How far the sides of a joint may be apart, m or rad.
const CLOSED: f64 = 1e-9;

/// Of the energy, as a part of the largest kinetic one: what some thousand steps at the tolerance may add up to.
const ENERGY: f64 = 1e-8;

/// Clearances are no singular values, but fall with them: to this part of the least one of the screws.
const CLEAR: f64 = 0.01;

/// At which states are looked, in seconds, and how many.
const SAMPLE: f64 = 0.05;
const SAMPLES: u32 = 120;

/// Screws whose least singular value, of those that are not zero, comes below this pass a pose that is singular.
const SINGULAR: f64 = 0.05;

/// How many loops of each kind, and from which seed on (`GYRO_LOOPS`, `GYRO_SEED`).
fn asked() -> (u64, u64) {
    let number = |name: &str, usual| std::env::var(name).ok().and_then(|n| n.parse().ok()).unwrap_or(usual);
    (number("GYRO_LOOPS", 1), number("GYRO_SEED", 1))
}

/// Loops of a kind with a pose, and what they are at the start.
fn loops(kind: &'static str) -> Vec<(Placed, Model)> {
    let (count, seed) = asked();
    let only = std::env::var("GYRO_KIND");
    if only.is_ok_and(|only| only != kind) {
        return Vec::new();
    }
    let of = |seed: u64| {
        let mut dice = ChaCha8Rng::seed_from_u64(seed);
        let pose = (0..200).find_map(|_| Loop::random(kind, &mut dice).pose(&mut dice));
        let axes = pose.unwrap_or_else(|| panic!("no {kind} from seed {seed} can be closed"));
        let placed = Placed::new(&axes);
        let page = placed.page(3.0, -1.0);
        let model = gyro_model::read("page.toml", &page);
        let model = model.unwrap_or_else(|error| panic!("{kind} from seed {seed}: {error}\n{page}"));
        assert_eq!(model.degrees_of_freedom(), 1, "{kind} from seed {seed}");
        (placed, model)
    };
    (seed..seed + count).map(of).collect()
}

/// What a run has been like.
struct Run {
    apart: f64,
    energy: f64,
    statistics: Statistics,
    clearance: f64,
    /// The least singular value of the screws but for the one that is zero.
    screws: f64,
    /// Poses at the end.
    end: Vec<Pose>,
    /// How far the first joint has turned in all, rad.
    turned: f64,
}

/// Runs and looks at each sample: `maximal` makes its state of what is integrated.
fn run<D, M, C>(
    placed: &Placed,
    (mechanism, dynamics, correction): (&M, D, C),
    start: &D::State,
    maximal: impl Fn(&D::State) -> M::State,
) -> Result<Run, gyro_sim::Error>
where
    M: Mechanism<Scalar = f64>,
    D: Ode<M, Scalar = f64>,
    C: Correction<D, M>,
{
    let n = mechanism.description().bodies.len();
    let poses = |y: &M::State| y.as_ref().as_chunks::<7>().0[..n].to_vec();
    let solver = Solver::with_correction(dynamics, Dop853::new(start), correction, 0.0, start);
    let mut solver = solver.with_control(Control::default().with_tolerance(TOLERANCE));
    let energy = |y: &M::State| mechanism.energy(0.0, y);
    let first = energy(&maximal(start));
    let (mut apart, mut change, mut most) = (0.0_f64, 0.0_f64, first.kinetic);
    let (mut clearance, mut screws) = (f64::INFINITY, f64::INFINITY);
    let (mut turned, mut last) = (0.0, poses(&maximal(start))[0]);
    for sample in 1..=SAMPLES {
        solver.advance_to(mechanism, SAMPLE * f64::from(sample))?;
        let y = maximal(solver.state());
        let (now, (gap, axes)) = (energy(&y), placed.apart(&poses(&y)));
        turned += turn_between(&last, &poses(&y)[0]);
        last = poses(&y)[0];
        apart = apart.max(gap);
        most = most.max(now.kinetic);
        change = change.max((now.kinetic + now.potential - first.kinetic - first.potential).abs());
        let values = Loop::screws(&axes).singular_values();
        let clear =
            solver.correction().clearance(mechanism, 0.0, solver.state()).map_or(1.0, |clear| clear.pivot);
        let least = values[values.len() - 2];
        (clearance, screws) = (clearance.min(clear / least), screws.min(least));
    }
    let y = maximal(solver.state());
    let (energy, statistics, end) = (change / most, *solver.statistics(), poses(&y));
    Ok(Run { apart, energy, statistics, clearance, screws, end, turned })
}

/// The angle from one orientation to another, rad.
fn turn_between(one: &Pose, other: &Pose) -> f64 {
    let of = |[.., e0, e1, e2, e3]: Pose| UnitQuaternion::from_quaternion(Quaternion::new(e0, e1, e2, e3));
    of(*one).angle_to(&of(*other))
}

fn check(what: &str, run: &Run) {
    let Run { apart, energy, statistics, clearance, screws, turned, .. } = run;
    println!(
        "{what}: apart {apart:.1e}, energy {energy:.1e}, clearance {clearance:.2}, screws {screws:.3}, \
         turned by {turned:.1}, {} steps, {} leaps",
        statistics.accepted, statistics.leaps
    );
    assert!(*apart < CLOSED, "{what}: apart by {apart:e}");
    assert!(*energy < ENERGY, "{what}: energy changes by {energy:e}");
    let named = statistics.leaps + statistics.passages;
    assert!(
        named == 0 || *screws < SINGULAR,
        "{what}: {named} singular poses, where the screws have {screws:e}"
    );
    assert!(*turned > TAU, "{what}: turned by {turned}");
    assert!(*clearance > CLEAR, "{what}: clear by {clearance:e} of the least singular value");
}

/// In joint coordinates and in maximal ones, by what was compiled and by the model that is assembled at run time.
fn turns(kind: &'static str) {
    for (number, (placed, model)) in loops(kind).into_iter().enumerate() {
        let name = format!("{kind} {number}");
        let mechanism: Compiled<f64> =
            gyro_jit::compile(&model, &Functions::of_solvers(), Effort::Quick).expect("a mechanism");
        let x = mechanism.joint_start();
        let maximal = |x: &Vec<f64>| {
            let mut y = mechanism.start();
            mechanism.to_maximal(0.0, x, &mut y);
            y
        };
        let correction = CloseLoops::new(&mechanism);
        let of_joints = run(&placed, (&mechanism, Joint, correction), &x, maximal);
        let of_joints = of_joints.unwrap_or_else(|error| panic!("{name}: {error:?}"));
        check(&format!("{name}, joint coordinates"), &of_joints);
        let y = mechanism.start();
        let of_bodies = by_bodies(&placed, &mechanism, &y);
        check(&format!("{name}, maximal coordinates"), &of_bodies);
        let dense = Dense::<f64>::new(&model).expect("a consistent start");
        let duals = Tree(mechanism.interpreted());
        let linear = duals.linearise(&mechanism, &operating_point(&y)).expect("a joint form");
        assert_eq!(linear.state.len(), 2, "{name}: {linear:?}");
        let of_dense = by_bodies(&placed, &dense, &dense.start());
        check(&format!("{name}, assembled"), &of_dense);
        for (other, what) in [(&of_bodies, "maximal"), (&of_dense, "assembled")] {
            let pairs = of_joints.end.iter().flatten().zip(other.end.iter().flatten());
            let off = pairs.fold(0.0_f64, |off, (a, b)| off.max((a - b).abs().min((a + b).abs())));
            println!("{name}: {what} is off by {off:.1e}");
            assert!(off < 1e-6, "{name}: {what} is off by {off:e} at the end");
        }
    }
}

fn by_bodies<M>(placed: &Placed, mechanism: &M, y: &M::State) -> Run
where
    M: Mechanism<Scalar = f64> + Partition + CorrectedDynamics,
{
    let correction = Partitioning::new(mechanism, 0.0, y);
    run(placed, (mechanism, Corrected, correction), y, M::State::clone)
        .unwrap_or_else(|error| panic!("maximal coordinates: {error:?}"))
}

/// At time zero, with angles as they are read.
fn operating_point(y: &Vec<f64>) -> OperatingPoint<'_, Vec<f64>> {
    OperatingPoint { t: 0.0, y, angles: &[0.0; 6], inputs: &[] }
}

macro_rules! kinds {
    ($($(#[$is_long:meta])? $name:ident: $kind:literal),* $(,)?) => {
        $(#[test]
        $(#[$is_long])?
        fn $name() {
            assert!(KINDS.contains(&$kind));
            turns($kind);
        })*
    };
}

kinds! {
    bennett_turns: "bennett",
    goldbergs_five_bars_turn: "goldberg-5r",
    myard_turns: "myard",
    #[ignore = "takes long: `.ci/steps` runs it"]
    line_symmetric_bricard_turns: "line-symmetric",
    #[ignore = "takes long: `.ci/steps` runs it"]
    plane_symmetric_bricard_turns: "plane-symmetric",
    #[ignore = "takes long: `.ci/steps` runs it"]
    trihedral_bricard_turns: "trihedral",
    #[ignore = "takes long: `.ci/steps` runs it"]
    line_symmetric_octahedron_turns: "octahedral-line",
    sarrus_turns: "sarrus",
    planar_linkages_turn: "planar",
    spherical_linkages_turn: "spherical",
}

/// What is generated is what the textbook says, rows that depend on each other included.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn what_is_generated_is_proved() {
    for (_, model) in loops("bennett") {
        let module =
            gyro_codegen::generate_by_effort("page.toml", &model, &Functions::of_solvers(), Effort::Quick);
        let module = module.expect("a mechanism");
        let report = verify(&model, &module.code, &module.constants, Depth::Quick);
        assert!(report.is_proved(), "{report}");
    }
}

/// Mechanisms whose rows depend on each other in one way everywhere, as planar loops, lose nothing by it.
#[test]
fn shipped_models_drop_what_they_dropped() {
    let folders = [
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../models"),
        concat!(env!("CARGO_MANIFEST_DIR"), "/../models"),
    ];
    let mut n_dropping = 0;
    for entry in folders.into_iter().flat_map(|folder| std::fs::read_dir(folder).expect("a folder of models"))
    {
        let path = entry.expect("a file").path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&path).expect("a model file");
        let mut load = |file: &str| {
            std::fs::read_to_string(path.with_file_name(file)).map_err(|error| error.to_string())
        };
        let name = path.display().to_string();
        let model = gyro_model::read_with(&name, &text, &mut load).expect("a good model file");
        assert!(model.dependent_rows().is_empty(), "{name}");
        n_dropping += u32::from(model.dropped().next().is_some());
    }
    assert!(n_dropping > 3, "{n_dropping} models have redundant rows");
}

/// Bennett's linkage of sides 1 and 2, twisted by 30 and 90 degrees.
const SIDES_ONE_AND_TWO: &str = r#"
format = 1
name = "bennett"
gravity = [0, 0, -9.81]
[simulation]
t_end = 3.0
step = 0.001
[[body]]
name = "ground"
fixed = true
[[body]]
name = "l0"
mass = 1.0
inertia = [0.001, 0.083333, 0.083333]
[[body]]
name = "l1"
mass = 2.0
inertia = [0.002, 0.666667, 0.666667]
[[body]]
name = "l2"
mass = 1.0
inertia = [0.001, 0.083333, 0.083333]
[[joint]]
name = "j0"
kind = "revolute"
first = { body = "ground", point = [0, 0, 0], axis = [0, 0, 1], zero = [1, 0, 0] }
second = { body = "l0", point = [-0.5, 0, 0], axis = [0, 0, 1], zero = [1, 0, 0] }
angle = 1.5707963267948966
rate = 1.0
[[joint]]
name = "j1"
kind = "revolute"
first = { body = "l0", point = [0.5, 0, 0], axis = [0, -1, "sqrt(3)"], zero = [1, 0, 0] }
second = { body = "l1", point = [-1, 0, 0], axis = [0, 0, 1], zero = [1, 0, 0] }
angle = 2.0943951023931953
rough = true
[[joint]]
name = "j2"
kind = "revolute"
first = { body = "l1", point = [1, 0, 0], axis = [0, -1, 0], zero = [1, 0, 0] }
second = { body = "l2", point = [-0.5, 0, 0], axis = [0, 0, 1], zero = [1, 0, 0] }
angle = -1.5707963267948966
rough = true
[[joint]]
name = "j3"
kind = "revolute"
first = { body = "l2", point = [0.5, 0, 0], axis = [0, -1, "sqrt(3)"], zero = [1, 0, 0] }
second = { body = "ground", point = [-2.0, 0.0, -0.0], axis = [0.0, 1.0, 0.0], zero = [1.0, 0.0, -0.0] }
"#;

/// Until when the closed form is integrated, s.
const END: f64 = 10.0;

/// It was named to pass sixteen singular poses in twenty seconds, which it has not: in joint coordinates and in maximal
/// ones against the closed form, reduced to one freedom.
#[test]
fn a_bennett_of_whole_numbers_moves_as_its_closed_form() {
    let model = gyro_model::read("bennett.toml", SIDES_ONE_AND_TWO).expect("a good model file");
    // One of the twenty is the same combination of others everywhere.
    assert_eq!((model.rows().len(), model.degrees_of_freedom()), (19, 1));
    let mechanism: Compiled<f64> =
        gyro_jit::compile(&model, &Functions::of_solvers(), Effort::Quick).expect("a mechanism");
    let y = mechanism.start();
    let energy = |y: &Vec<f64>| {
        let energy = mechanism.energy(0.0, y);
        energy.kinetic + energy.potential
    };
    let expected = WholeNumbers::places(WholeNumbers::after(END, 1e-3)[0]);
    let check = |y: &Vec<f64>, statistics: &Statistics, what: &str| {
        let change = energy(y) - energy(&mechanism.start());
        let places = y.as_chunks::<7>().0[..3].iter().map(|pose| [pose[0], pose[1], pose[2]]);
        let off =
            places.flatten().zip(expected.as_flattened()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{what}: off by {off:.1e}, energy changes by {change:.1e}, {} steps", statistics.accepted);
        assert!(change.abs() < 1e-10, "{what}: energy changes by {change:e}");
        assert!(off < 1e-9, "{what}: off by {off:e}");
        assert_eq!(statistics.leaps + statistics.passages, 0, "{what}");
    };
    let control = Control::default().with_tolerance(1e-12);
    let correction = Partitioning::new(&mechanism, 0.0, &y);
    let solver = Solver::with_correction(Corrected, Dop853::new(&y), correction, 0.0, &y);
    let mut solver = solver.with_control(control);
    solver.advance_to(&mechanism, END).expect("no singular pose");
    check(solver.state(), solver.statistics(), "maximal coordinates");
    let x = mechanism.joint_start();
    let solver = Solver::with_correction(Joint, Dop853::new(&x), CloseLoops::new(&mechanism), 0.0, &x);
    let mut solver = solver.with_control(control);
    solver.advance_to(&mechanism, END).expect("no singular pose");
    let mut y = mechanism.start();
    mechanism.to_maximal(END, solver.state(), &mut y);
    check(&y, solver.statistics(), "joint coordinates");
}

/// A of the independent joint, against differences of the closed form.
#[test]
fn a_bennett_of_whole_numbers_is_linearised_as_its_closed_form() {
    let model = gyro_model::read("bennett.toml", SIDES_ONE_AND_TWO).expect("a good model file");
    let mechanism: Compiled<f64> =
        gyro_jit::compile(&model, &Functions::of_solvers(), Effort::Quick).expect("a mechanism");
    let y = mechanism.start();
    let linear =
        Tree(mechanism.interpreted()).linearise(&mechanism, &operating_point(&y)).expect("a joint form");
    assert_eq!((linear.state.len(), linear.by_state.len()), (2, 4), "{linear:?}");
    let Element::Position { place: JointPlace::Scalar { joint, .. }, .. } = linear.elements[0] else {
        panic!("{linear:?}")
    };
    let of = |state: [f64; 2]| WholeNumbers::joint(usize::from(joint), state);
    let here = of(WholeNumbers::START);
    assert!((linear.slope[1] - here[2]).abs() < 1e-9 * here[2].abs(), "{linear:?}: {here:?}");
    for along in [[1e-3, 0.0], [0.0, 1e-3]] {
        let at = |steps: f64| {
            let [angle, rate] = WholeNumbers::START;
            of([angle + steps * along[0], rate + steps * along[1]])
        };
        let [far, near, beyond, past] = [-2.0, -1.0, 1.0, 2.0].map(at);
        let slope = |k: usize| (8.0 * (beyond[k] - near[k]) - (past[k] - far[k])) / 12e-3;
        for row in 0..2 {
            let found = linear.by_state[2 * row] * slope(0) + linear.by_state[2 * row + 1] * slope(1);
            let expected = slope(1 + row);
            println!("row {row}: {found} for {expected}");
            assert!(
                (found - expected).abs() < 1e-7 * expected.abs().max(1.0),
                "row {row}: {found} {expected}"
            );
        }
    }
}
