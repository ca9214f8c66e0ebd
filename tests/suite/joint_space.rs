//! Joint coordinates against maximal ones: the maps lead there and back, and both describe one motion.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::{JointKind, Model, Support};
use gyro_sim::{CorrectedSolution, Dynamics, JointSpace, Partition};
use gyro_sim_suite::{Random, compiled, model};

/// What coordinates the joints of a model file have.
enum Kind {
    Angle,
    Length,
    Orientation,
    Position,
}

fn coordinates(model: &Model) -> Vec<Kind> {
    let mut kinds = Vec::new();
    for joint in &model.joints {
        let scalars = joint.kind.coordinates().iter();
        kinds.extend(scalars.map(|kind| if kind.is_angle() { Kind::Angle } else { Kind::Length }));
        if matches!(joint.kind, JointKind::Spherical | JointKind::PointOnLine) {
            kinds.push(Kind::Orientation);
        }
    }
    for _ in model.bodies.iter().filter(|body| body.support == Support::Free) {
        kinds.extend([Kind::Position, Kind::Orientation]);
    }
    kinds
}

/// A joint state anyhow, its Euler parameters unit vectors.
pub fn random_state<M: JointSpace<Scalar = f64>>(
    model: &Model,
    mechanism: &M,
    random: &mut Random,
) -> M::Joints {
    let mut state = mechanism.joint_start();
    let (mut x, mut n_x, mut n_u) = (Vec::new(), 0, 0);
    for kind in coordinates(model) {
        match kind {
            Kind::Angle => x.push(4.0 * random.signed()),
            Kind::Length => x.push(0.3 * random.signed()),
            Kind::Position => x.extend(random.vector(1.0)),
            Kind::Orientation => x.extend(random.unit()),
        }
        n_u += x.len() - n_x - usize::from(matches!(kind, Kind::Orientation));
        n_x = x.len();
    }
    x.extend((0..n_u).map(|_| RATE * random.signed()));
    state.as_mut()[..x.len()].copy_from_slice(&x);
    state
}

/// rad/s or m/s.
const RATE: f64 = 3.0;

/// Rounding of some hundred operations, relative to the largest number: of maps at most 4e-15 is seen, of accelerations
/// 5e-13, of multipliers 4e-11 (the cylindrical joint), each with a factor of some twenty or more for states without
/// luck.
const MAPS: f64 = 1e-13;
const ACCELERATIONS: f64 = 1e-11;
const MULTIPLIERS: f64 = 1e-9;
/// Central differences with a step of 1e-5.
const DIFFERENCES: f64 = 1e-7;

/// The largest absolute value.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, x| x.abs().max(largest))
}

/// The largest difference, relative to the largest number; zero where all are.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<_> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(a).max(largest(b)).max(f64::MIN_POSITIVE)
}

fn check<M: CorrectedSolution<Scalar = f64> + Dynamics + Partition>(page: &str, mechanism: &M) {
    let (model, mut random) = (model(page), Random::new(7));
    let mut worst = [0.0_f64; 7];
    for _ in 0..200 {
        let t = random.signed();
        let x = random_state(&model, mechanism, &mut random);
        let mut y = mechanism.start();
        mechanism.to_maximal(t, &x, &mut y);

        // The state satisfies the constraints, and leads back to the joint state.
        let (mut phi, mut residual) = (mechanism.buffers().constraints, mechanism.buffers().rows);
        mechanism.phi(t, &y, &mut phi);
        mechanism.velocity_residual(t, &y, &mut residual);
        worst[0] = worst[0].max(largest(phi.as_ref())).max(largest(residual.as_ref()));
        let mut back = x.clone();
        mechanism.to_joints(t, &y, &mut back);
        worst[1] = worst[1].max(difference(back.as_ref(), x.as_ref()));

        // One acceleration, three ways.
        let mut exact = mechanism.acceleration_buffer();
        mechanism.accelerations(t, &y, &mut exact);
        let mut corrected = mechanism.buffers().velocities;
        mechanism.corrected_accelerations(t, &y, &mut corrected);
        worst[2] = worst[2].max(difference(exact.as_ref(), corrected.as_ref()));
        let (mut lambda, mut short) = (mechanism.buffers().rows, mechanism.buffers().rows);
        mechanism.multipliers(t, &y, &exact, &mut lambda);
        mechanism.corrected_multipliers(t, &y, &corrected, &mut short);
        worst[6] = worst[6].max(difference(lambda.as_ref(), short.as_ref()));
        let mut both = mechanism.solution_buffer();
        mechanism.corrected_solution(t, &y, &mut both);
        let (v, of_rows) = both.as_ref().split_at(corrected.as_ref().len());
        worst[2] = worst[2].max(difference(exact.as_ref(), v));
        worst[6] = worst[6].max(difference(lambda.as_ref(), of_rows));
        let (mut rates, mut rates_at) = (mechanism.joint_buffers().rates, mechanism.joint_buffers().rates);
        mechanism.joint_accelerations(t, &x, &mut rates);
        mechanism.joint_accelerations_at(t, &y, &mut rates_at);
        worst[3] = worst[3].max(difference(rates.as_ref(), rates_at.as_ref()));
        let (mut derivative, mut short) = (y.clone(), y.clone());
        mechanism.derivative(t, &y, &mut derivative);
        mechanism.corrected_derivative(t, &y, &mut short);
        worst[4] = worst[4].max(difference(derivative.as_ref(), short.as_ref()));

        // The map carries one motion into the other.
        let mut dx = x.clone();
        mechanism.joint_derivative(t, &x, &mut dx);
        let at = |h: f64| {
            let (mut moved, mut y) = (x.clone(), mechanism.start());
            moved.as_mut().iter_mut().zip(dx.as_ref()).for_each(|(x, dx)| *x += h * dx);
            mechanism.to_maximal(t + h, &moved, &mut y);
            y
        };
        let (after, before) = (at(1e-5), at(-1e-5));
        let slope: Vec<_> = after.as_ref().iter().zip(before.as_ref()).map(|(a, b)| (a - b) / 2e-5).collect();
        worst[5] = worst[5].max(difference(&slope, derivative.as_ref()));
    }
    let [maps, back, accelerations, rates, derivative, slope, multipliers] =
        worst.map(|x| format!("{x:.1e}"));
    println!(
        "{page}: Φ {maps}, back {back}, (s̈, ẇ') {accelerations}, u̇ {rates}, ẏ {derivative}, slope {slope}, λ {multipliers}"
    );
    let allowed = [MAPS, MAPS, ACCELERATIONS, ACCELERATIONS, ACCELERATIONS, DIFFERENCES, MULTIPLIERS];
    assert!(worst.iter().zip(allowed).all(|(worst, allowed)| *worst <= allowed), "{page}: {worst:?}");
}

#[test]
fn joint_coordinates_describe_the_motion_of_every_tree() {
    for page in [
        "compound-pendulum",
        "free-body",
        "gyroscope",
        "gyroscope-combined-offsets",
        "gyroscope-maximal",
        "gyroscope-radial-imbalance",
        "gyroscope-viscous",
        "heavy-top",
        "pitching-gyroscope",
        "spinning-top",
        "cylindrical",
        "loads",
        "motor",
        "pendulum",
        "pitching-bearings",
        "planar",
        "point-on-line",
        "screw",
        "spherical",
        "torsion",
        "friction",
        "prismatic",
        "stops",
        "universal",
        "carried",
        "carried-block",
        "tether",
        "weld",
    ] {
        check(page, &compiled(page));
    }
}
