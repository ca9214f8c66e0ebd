//! Lanes against as many scalar runs of shipped trees: the same bits, whatever happens in the other lanes.

use gyro_mechanisms::{
    driven_gyroscope::DrivenGyroscope,
    free_body::FreeBody,
    gyroscope::Gyroscope,
    gyroscope_parameters::{self, GyroscopeParameters},
    gyroscope_viscous::GyroscopeViscous,
    heavy_top::HeavyTop,
};
use gyro_sim::lanes::{self, Lanes, f32x8, f64x4, f64x8};
use gyro_sim::{
    CorrectedDynamics, Direct, Error, Joint, JointSpace, Mechanism, Partition, Partitioned, Real, Scalar,
};
use gyro_sim_suite::Random;

/// Long enough for a rotor at 100 rad/s to switch charts in every lane.
const INTERVALS: u32 = 100;
const STEP: f64 = 2e-4;
const STEPS: u32 = 5;

/// A state that is not a number, one that overflows on the way, and the others.
const BROKEN: usize = 1;
const OVERFLOWING: usize = 2;

/// Joint states, a little different in each lane; two of them come to nothing.
fn starts<S: JointSpace<Scalar: Real>>(scalar: &S, count: usize) -> Vec<S::Joints> {
    let mut random = Random::new(20_261_121);
    let mut start = |lane: usize| {
        let mut x = scalar.joint_start();
        for x in x.as_mut() {
            *x = *x + S::Scalar::constant(0.1 * random.signed());
        }
        if lane == BROKEN {
            x.as_mut()[0] = S::Scalar::constant(f64::NAN);
        }
        if lane == OVERFLOWING {
            let last = x.as_mut().iter_mut().rev().find(|x| x.abs() > S::Scalar::constant(0.0));
            *last.expect("something moves") = S::Scalar::constant(1e30);
        }
        x
    };
    (0..count).map(&mut start).collect()
}

/// What a run comes to: its state, and its error if it failed.
type Outcome<S> = (S, Option<Error>);

fn packed<T: Lanes, P: Clone + AsMut<[T]>, S: AsRef<[T::Lane]>>(like: &P, states: &[S]) -> P {
    let mut packed = like.clone();
    for (index, value) in packed.as_mut().iter_mut().enumerate() {
        *value = T::from_lanes(|lane| states[lane].as_ref()[index]);
    }
    packed
}

fn same<T: Lanes, S: AsRef<[T::Lane]>>(name: &str, found: (&[T], &lanes::Failures), expected: &[Outcome<S>]) {
    let (state, failures) = found;
    for (lane, (expected, error)) in expected.iter().enumerate() {
        // Errors may carry numbers that are not equal to themselves.
        assert_eq!(format!("{:?}", failures.of(lane)), format!("{error:?}"), "{name}, lane {lane}");
        for (index, (found, expected)) in state.iter().zip(expected.as_ref()).enumerate() {
            let (a, b) = (found.lane(lane).to_f64(), expected.to_f64());
            let is_same = a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
            assert!(is_same, "{name}, lane {lane}, element {index}: {a:e} {b:e}");
        }
    }
}

/// Runs until the end or the first error.
fn run(mut advance: impl FnMut(u32) -> Result<(), Error>) -> Option<Error> {
    (0..INTERVALS).find_map(|interval| advance(interval).err())
}

fn time<T: Scalar>(interval: u32) -> T {
    T::constant(f64::from(interval)) * T::constant(STEP) * T::constant(f64::from(STEPS))
}

/// In joint coordinates.
fn joint_coordinates_agree<S, P>(name: &str, scalar: &S, packs: &P)
where
    S: JointSpace<Scalar: Real>,
    P: JointSpace<Scalar: Lanes<Lane = S::Scalar>>,
{
    let states = starts(scalar, P::Scalar::COUNT);
    let mut x = packed::<P::Scalar, _, _>(&packs.joint_start(), &states);
    let mut solver = lanes::Direct::new(Joint, &x);
    for interval in 0..INTERVALS {
        solver.advance(packs, time(interval), P::Scalar::constant(STEP), STEPS, &mut x);
    }
    let alone = |mut x: S::Joints| {
        let mut solver = Direct::new(Joint, &x);
        let h = S::Scalar::constant(STEP);
        let error = run(|interval| solver.advance(scalar, time(interval), h, STEPS, &mut x));
        (x, error)
    };
    let expected: Vec<_> = states.into_iter().map(alone).collect();
    same(name, (x.as_ref(), solver.failures()), &expected);
}

/// In maximal coordinates with corrections. Returns how many lanes ran to the end and how often their charts switched.
fn corrected_runs_agree<S, P>(name: &str, scalar: &S, packs: &P) -> (usize, u64)
where
    S: JointSpace + CorrectedDynamics + Partition<Scalar: Real>,
    P: CorrectedDynamics + Partition<Scalar: Lanes<Lane = <S as Mechanism>::Scalar>>,
{
    let to_maximal = |x: &S::Joints| {
        let mut y = scalar.start();
        scalar.to_maximal(<S as Mechanism>::Scalar::constant(0.0), x, &mut y);
        y
    };
    let states: Vec<_> = starts(scalar, P::Scalar::COUNT).iter().map(to_maximal).collect();
    let mut y = packed::<P::Scalar, _, _>(&packs.start(), &states);
    let mut solver = lanes::Partitioned::new(packs, &y);
    for interval in 0..INTERVALS {
        solver.advance(packs, time(interval), P::Scalar::constant(STEP), STEPS, &mut y);
    }
    let mut switches = 0;
    let mut alone = |mut y: S::State| {
        let mut solver = Partitioned::new(scalar, &y);
        let h = <S as Mechanism>::Scalar::constant(STEP);
        let error = run(|interval| solver.advance(scalar, time(interval), h, STEPS, &mut y));
        switches += solver.switches();
        (y, error)
    };
    let expected: Vec<_> = states.into_iter().map(&mut alone).collect();
    same(name, (y.as_ref(), solver.failures()), &expected);
    (P::Scalar::COUNT - solver.failures().count(), switches)
}

/// Free and on joints of each kind, at rest and on a base that moves, with friction, with parameters: not every model
/// file, as each costs its compilation.
macro_rules! each_tree {
    ($check:ident) => {{
        let trees = [
            each_tree!($check, DrivenGyroscope),
            each_tree!($check, FreeBody),
            each_tree!($check, Gyroscope),
            each_tree!($check, GyroscopeParameters),
            each_tree!($check, GyroscopeViscous),
            each_tree!($check, HeavyTop),
        ];
        trees
    }};
    ($check:ident, $tree:ident) => {
        $check(stringify!($tree), &$tree::<f64>::default(), &$tree::<f64x4>::default())
    };
}

#[test]
fn lanes_in_joint_coordinates_are_scalar_runs() {
    each_tree!(joint_coordinates_agree);
}

#[test]
fn corrected_lanes_are_scalar_runs() {
    let outcomes = each_tree!(corrected_runs_agree);
    // The broken lane has failed everywhere, two lanes have not, and charts have been left.
    assert!(outcomes.iter().all(|(running, _)| (2..4).contains(running)), "{outcomes:?}");
    assert!(outcomes.iter().filter(|(_, switches)| *switches > 0).count() > 3, "{outcomes:?}");
}

#[test]
fn other_packs_are_scalar_runs_too() {
    let (double, single) = (Gyroscope::<f64>::default(), Gyroscope::<f32>::default());
    joint_coordinates_agree("f64x8", &double, &Gyroscope::<f64x8>::default());
    corrected_runs_agree("f64x8", &double, &Gyroscope::<f64x8>::default());
    joint_coordinates_agree("f32x8", &single, &Gyroscope::<f32x8>::default());
    corrected_runs_agree("f32x8", &single, &Gyroscope::<f32x8>::default());
}

#[test]
fn each_lane_has_parameters_of_its_own() {
    let value = |lane: usize, parameter: usize| 1.0 + 0.01 * (lane * 5 + parameter) as f64;
    let with = |lane: usize| {
        let mut parameters = gyroscope_parameters::Parameters::<f64>::default();
        parameters.rotor_mass *= value(lane, 0);
        parameters.rotor_offset *= value(lane, 1);
        parameters.ring_axial_inertia *= value(lane, 2);
        parameters
    };
    let packs = GyroscopeParameters::new(gyroscope_parameters::Parameters {
        rotor_mass: f64x8::from_lanes(|lane| with(lane).rotor_mass),
        rotor_offset: f64x8::from_lanes(|lane| with(lane).rotor_offset),
        ring_axial_inertia: f64x8::from_lanes(|lane| with(lane).ring_axial_inertia),
        ..gyroscope_parameters::Parameters::default()
    });
    let start = |mechanism: &GyroscopeParameters<f64>| {
        let mut y = mechanism.start();
        mechanism.to_maximal(0.0, &mechanism.joint_start(), &mut y);
        y
    };
    let mut y = packs.start();
    packs.to_maximal(f64x8::splat(0.0), &packs.joint_start(), &mut y);
    let mut solver = lanes::Partitioned::new(&packs, &y);
    (0..INTERVALS).for_each(|i| solver.advance(&packs, time(i), f64x8::splat(STEP), STEPS, &mut y));
    let expected: Vec<_> = (0..8)
        .map(|lane| {
            let mechanism = GyroscopeParameters::new(with(lane));
            let mut y = start(&mechanism);
            let mut solver = Partitioned::new(&mechanism, &y);
            let error = run(|i| solver.advance(&mechanism, time(i), STEP, STEPS, &mut y));
            (y, error)
        })
        .collect();
    same("parameters", (&y, solver.failures()), &expected);
    assert_ne!(expected[0].0, expected[1].0);
}

/// A correction that starts off the constraints takes different numbers of Newton steps in different lanes.
#[test]
fn lanes_converge_one_by_one() {
    let (scalar, packs) = (Gyroscope::<f64>::default(), Gyroscope::<f64x8>::default());
    let state = |lane: usize| {
        let mut y = scalar.start();
        // From a state that meets the constraints to one that cannot be corrected.
        let away = [0.0, 1e-14, 1e-9, 1e-6, 1e-4, 1e-2, 0.1, 3.0][lane];
        (0u8..21).for_each(|k| y[usize::from(k)] += away * f64::from(k + 1).sin());
        y
    };
    let states: Vec<_> = (0..8).map(state).collect();
    let mut y = packed::<f64x8, _, _>(&packs.start(), &states);
    let mut solver = lanes::Partitioned::new(&packs, &y);
    solver.correct(&packs, f64x8::splat(0.0), &mut y);
    let alone = |mut y: [f64; 39]| {
        let error = Partitioned::new(&scalar, &y).correct(&scalar, 0.0, &mut y).err();
        (y, error)
    };
    let expected: Vec<_> = states.into_iter().map(alone).collect();
    same("corrections", (&y, solver.failures()), &expected);
    let mut phi = packs.buffers().constraints;
    packs.phi(f64x8::splat(0.0), &y, &mut phi);
    assert!(phi.iter().all(|row| row.lane(4).abs() < 1e-14));
}
