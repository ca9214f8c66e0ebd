//! Tests of loops in joint coordinates: they are closed, run, named and linearised.

use crate::linkage::Linkage;
use crate::motion::{COLUMNS, Element, Linear, MotionBuilder, OperatingPoint, Tree};
use crate::{
    Approach, Coordinates, Correction, Event, Failure, Integrator, Sample, Settings, Start, describe_in,
    run_by,
};
use gyro_sim::{CloseLoops, ClosedForm, Dual, Error, JointPlace, JointSpace, Mechanism, Owner, Real};

const KNEE: Owner = Owner::Joint(3);

/// The joint state that a crank's angle and rate determine, the knee above.
fn closed<T: Real>(linkage: &Linkage<T>, crank: f64, rate: f64) -> [T; 6] {
    let mut x = linkage.joint_start();
    let (from, n) = (x[0].to_f64(), 200);
    let mut closing = CloseLoops::new(linkage);
    // In small steps, as it moves.
    for step in 1..=n {
        for _ in 0..40 {
            let missing = from + (crank - from) * f64::from(step) / f64::from(n) - x[0].to_f64();
            (x[0], x[2]) = (x[0] + T::constant(missing), x[2] - T::constant(missing));
            closing.correct(linkage, T::constant(0.0), &mut x).expect("a crank turns");
        }
    }
    (x[3], x[4], x[5]) = (T::constant(1.0), T::constant(0.0), T::constant(0.0));
    closing.correct(linkage, T::constant(0.0), &mut x).expect("a crank turns");
    let scale = T::constant(rate) / x[3];
    for rate in &mut x[3..] {
        *rate = *rate * scale;
    }
    x
}

/// The largest row of the closure and of its rate.
fn violations<T: Real>(linkage: &Linkage<T>, x: &[T; 6]) -> [f64; 2] {
    let (mut y, mut buffers) = (linkage.start(), linkage.buffers());
    linkage.to_maximal(T::constant(0.0), x, &mut y);
    linkage.phi(T::constant(0.0), &y, &mut buffers.constraints);
    linkage.velocity_residual(T::constant(0.0), &y, &mut buffers.rows);
    let largest = |rows: &[T]| rows.iter().fold(0.0, |worst: f64, row| worst.max(row.abs().to_f64()));
    [largest(&buffers.constraints), largest(&buffers.rows)]
}

/// The linkage of the tests itself is right: rows of the generated code, at any state.
#[test]
fn the_closure_has_the_rows_that_the_tree_leaves() {
    let linkage = Linkage::<f64>::default();
    let x = [0.7, 1.9, -0.4, 3.0, -1.0, 2.0];
    let (mut y, mut phi, mut closure) = (linkage.start(), linkage.buffers().constraints, [0.0; 2]);
    linkage.to_maximal(0.0, &x, &mut y);
    linkage.phi(0.0, &y, &mut phi);
    linkage.loop_closure(0.0, &x, &mut closure);
    for (row, phi) in phi.into_iter().enumerate() {
        let expected = if (14..16).contains(&row) { closure[row - 14] } else { 0.0 };
        assert!((phi.abs() - expected.abs()).abs() < 1e-15, "{row}: {phi} for {expected}");
    }
    let mut back = [0.5, 2.0, 0.0, 0.0, 0.0, 0.0];
    linkage.to_joints(0.0, &y, &mut back);
    assert!(x.iter().zip(back).all(|(a, b)| (a - b).abs() < 1e-14), "{back:?}");
}

#[test]
fn loops_are_closed_to_rounding() {
    let linkage = Linkage::<f64>::default();
    let mut x = closed(&linkage, 1.3, 5.0);
    let before = x;
    (x[1], x[2], x[4]) = (x[1] + 1e-3, x[2] - 2e-3, x[4] + 0.1);
    assert!(violations(&linkage, &x).into_iter().all(|violation| violation > 1e-4));
    CloseLoops::new(&linkage).correct(&linkage, 0.0, &mut x).unwrap();
    assert!(violations(&linkage, &x).into_iter().all(|violation| violation < 1e-14));
    assert!(x.iter().zip(before).all(|(a, b)| (a - b).abs() < 0.1), "{x:?}");
}

#[test]
fn loops_are_closed_by_way_of_joint_coordinates_too() {
    let linkage = Linkage::<f64>::default();
    let (mut x, mut y) = (closed(&linkage, 1.3, 5.0), linkage.start());
    (x[1], x[4]) = (x[1] + 1e-3, x[4] + 0.1);
    linkage.to_maximal(0.0, &x, &mut y);
    ClosedForm::new(&linkage).correct(&linkage, 0.0, &mut y).unwrap();
    linkage.to_joints(0.0, &y, &mut x);
    assert!(violations(&linkage, &x).into_iter().all(|violation| violation < 1e-14));
}

/// Angles of many turns are known to fewer digits; a correction that asks for more finds none.
#[test]
fn loops_that_have_turned_often_are_closed_as_far_as_angles_are_known() {
    let linkage = Linkage::<f64>::default();
    let mut x = closed(&linkage, 1.3, 5.0);
    let turns = core::f64::consts::TAU * 1e6;
    (x[0], x[2]) = (x[0] + turns, x[2] - turns + 1e-4);
    CloseLoops::new(&linkage).correct(&linkage, 0.0, &mut x).unwrap();
    assert!(violations(&linkage, &x)[0] < 1e-8);
    let single = Linkage::<f32>::default();
    let mut x = single.joint_start();
    (x[0], x[1]) = (x[0] + 1e3, x[1] + 1e-3);
    x[2] -= 1e3;
    CloseLoops::new(&single).correct(&single, 0.0, &mut x).unwrap();
    assert!(violations(&single, &x)[0] < 1e-3);
}

#[test]
fn what_cannot_be_closed_is_named() {
    let linkage = Linkage::<f64>::default();
    let x = closed(&linkage, 1.3, 5.0);
    let fails = |linkage: &Linkage<f64>, mut x: [f64; 6]| {
        CloseLoops::new(linkage).correct(linkage, 0.25, &mut x).expect_err("this is not closed")
    };
    let words = |error| describe_in(&linkage, Some(linkage.joint_layout()), error);
    // Towards the knee below.
    let jump = fails(&linkage, [x[0], x[1] - 1.5, x[2] - 0.7, 0.0, 0.0, 0.0]);
    assert!(matches!(jump, Error::Jump { t: 0.25, limit: 0.5, owner: KNEE, .. }), "{jump:?}");
    assert!(words(jump).contains("joint `knee` can be met only by a change of"), "{}", words(jump));
    // A knee that does not reach: by a little, so that no step is long.
    let mut apart = Linkage::default();
    apart.ground = 1.1 + 1e-6;
    let apart = fails(&apart, [0.0, core::f64::consts::PI + 1e-3, 1e-3, 0.0, 0.0, 0.0]);
    assert!(matches!(apart, Error::NoConvergence { owner: KNEE, .. } | Error::Jump { .. }), "{apart:?}");
    for (index, what) in [(1, "position of joint `rocker_pivot`"), (5, "rate of joint `elbow`")] {
        let mut x = x;
        x[index] = f64::NAN;
        let error = fails(&linkage, x);
        assert!(matches!(error, Error::NotFinite { t: 0.25, .. }), "{error:?}");
        assert!(index == 5 || words(error).contains(what), "{}", words(error));
    }
    let past = words(Error::NotFinite { t: 0.0, index: 6 });
    assert!(past.contains("the work done"), "{past}");
}

const SETTINGS: Settings = Settings { t_end: 1.0, step: 1e-3, correct_every: None, sample_every: 0.05 };

fn start(linkage: &Linkage<f64>, x: &[f64; 6]) -> Start {
    let mut y = linkage.start();
    linkage.to_maximal(0.0, x, &mut y);
    Start {
        positions: y[..21].to_vec(),
        velocities: y[21..].to_vec(),
        angles: vec![x[0], x[1], x[2], 0.0, 0.0],
        ..Start::default()
    }
}

fn samples(approach: &Approach) -> Result<(Vec<Sample>, u64), Failure> {
    let mut linkage = Linkage::<f64>::default();
    let (builder, start) =
        (Tree(Linkage::<Dual<f64, COLUMNS>>::default()), start(&linkage, &linkage.joint_start()));
    let mut samples = Vec::new();
    let summary = run_by(&mut linkage, &builder, (&SETTINGS, approach), &start, |event| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    })?;
    Ok((samples, summary.statistics.corrections))
}

/// More than a turn of the crank, by every method, against maximal coordinates; the loop stays closed.
#[test]
fn loops_run_in_joint_coordinates() {
    let exact = Approach { integrator: Integrator::Dop853, tolerance: Some(1e-12), ..Approach::default() };
    let (expected, _) = samples(&exact).unwrap();
    let turned = crate::companion::distance(&expected[0].coordinates[0], &expected[20].coordinates[0]);
    assert!(turned > 6.3, "{turned}");
    for (integrator, tolerance, error) in [
        (Integrator::Rk4, None, 1e-7),
        (Integrator::Tsit5, Some(1e-9), 1e-6),
        (Integrator::Dop853, Some(1e-10), 1e-7),
        (Integrator::Rodas4, Some(1e-7), 1e-4),
    ] {
        let approach =
            Approach { integrator, tolerance, coordinates: Coordinates::Joint, ..Approach::default() };
        let (found, corrections) = samples(&approach).unwrap();
        assert!(corrections > 10, "{approach}");
        for (sample, expected) in found.iter().zip(&expected) {
            for (joint, other) in sample.coordinates.iter().zip(&expected.coordinates) {
                let distance = crate::companion::distance(joint, other);
                assert!(distance < error, "{approach} at {}: {distance:e}", sample.t);
            }
            assert!(sample.position_violation < 1e-14, "{approach}: {:e}", sample.position_violation);
            assert!(sample.velocity_violation < 1e-12, "{approach}: {:e}", sample.velocity_violation);
        }
        let drifting = Approach { correction: Correction::None, ..approach };
        let (found, corrections) = samples(&drifting).unwrap();
        assert_eq!(corrections, 0, "{drifting}");
        let worst = found.iter().map(|sample| sample.position_violation).fold(0.0, f64::max);
        assert!(worst > 1e-13, "{drifting}: {worst:e}");
    }
}

fn linear(x: &[f64; 6]) -> Linear {
    let linkage = Linkage::<f64>::default();
    let mut y = linkage.start();
    linkage.to_maximal(0.0, x, &mut y);
    let builder = Tree(Linkage::<Dual<f64, COLUMNS>>::default());
    let angles = [x[0], x[1], x[2], 0.0, 0.0];
    let at = OperatingPoint { t: 0.0, y: &y, angles: &angles, inputs: &[] };
    builder.linearise(&linkage, &at).expect("a joint form")
}

/// ẋ by central differences of fourth order along crank's angle and rate, of what is linearised too.
#[test]
fn a_linearised_loop_has_its_degrees_of_freedom_and_the_slopes_of_its_closed_motion() {
    let linkage = Linkage::<f64>::default();
    for (crank, rate) in [(1.3, 5.0), (-2.0, -3.0), (2.9, 0.0)] {
        let linear = linear(&closed(&linkage, crank, rate));
        assert_eq!((linear.state.len(), linear.by_state.len(), linear.by_inputs.len()), (2, 4, 0));
        let Element::Position { place: JointPlace::Scalar { joint, .. }, .. } = linear.elements[0] else {
            panic!("{linear:?}")
        };
        let k = usize::from(joint);
        let at = |crank: f64, rate: f64| {
            let (x, mut dx) = (closed(&linkage, crank, rate), [0.0; 6]);
            linkage.joint_derivative(0.0, &x, &mut dx);
            [x[k], x[3 + k], dx[k], dx[3 + k]]
        };
        let here = at(crank, rate);
        assert!((linear.state[0] - here[0]).abs() < 1e-12 && (linear.slope[1] - here[3]).abs() < 1e-9);
        for along in [[1e-3, 0.0], [0.0, 1e-3]] {
            let slopes = |steps: f64| at(crank + steps * along[0], rate + steps * along[1]);
            let [far, near, beyond, past] = [-2.0, -1.0, 1.0, 2.0].map(slopes);
            let slope = |k: usize| (8.0 * (beyond[k] - near[k]) - (past[k] - far[k])) / 12e-3;
            for row in 0..2 {
                let found = linear.by_state[2 * row] * slope(0) + linear.by_state[2 * row + 1] * slope(1);
                let expected = slope(2 + row);
                assert!(
                    (found - expected).abs() < 1e-7 * expected.abs().max(1.0),
                    "{row} of {linear:?}: {found} for {expected}"
                );
            }
        }
    }
}

/// A maximal state does not know of turns: they are told.
#[test]
fn a_linearised_loop_has_the_turns_that_it_has_made() {
    let mut x = closed(&Linkage::default(), 1.3, 5.0);
    for (angle, turns) in x.iter_mut().zip([2.0, -1.0, -3.0]) {
        *angle += core::f64::consts::TAU * turns;
    }
    let linear = linear(&x);
    let Element::Position { place: JointPlace::Scalar { joint, .. }, .. } = linear.elements[0] else {
        panic!("{linear:?}")
    };
    assert!((linear.state[0] - x[usize::from(joint)]).abs() < 1e-12, "{linear:?}");
}

/// About the pose of least potential energy V the motion is `θ̈ = −(V″/M) θ`, M from the kinetic energy at a rate of
/// one.
#[test]
fn a_hanging_linkage_has_the_frequency_of_its_energies() {
    let linkage = Linkage::<f64>::default();
    let energy = |crank: f64| {
        let mut y = linkage.start();
        linkage.to_maximal(0.0, &closed(&linkage, crank, 1.0), &mut y);
        linkage.energy(0.0, &y)
    };
    let slope = |crank: f64| {
        let at = |steps: f64| energy(crank + 1e-3 * steps).potential;
        (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / 12e-3
    };
    let (mut low, mut high) = (-2.5, -0.3);
    assert!(slope(low) < 0.0 && slope(high) > 0.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if slope(middle) < 0.0 { low = middle } else { high = middle }
    }
    let bend =
        (8.0 * (slope(low + 1e-3) - slope(low - 1e-3)) - (slope(low + 2e-3) - slope(low - 2e-3))) / 12e-3;
    let square = bend / (2.0 * energy(low).kinetic);
    let linear = linear(&closed(&linkage, low, 0.0));
    assert!(linear.by_state[3].abs() < 1e-9 && (linear.by_state[1] - 1.0).abs() < 1e-12, "{linear:?}");
    let error = linear.by_state[2] + square;
    assert!(error.abs() < 1e-6 * square, "{linear:?}: {square}");
}
