//! What controllers of robots ask for, on a floating base with branches and on a manipulator with a moving base:
//! against virtual power with the dense runtime-assembled model, against energies, and against each other.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use chacha20::ChaCha8Rng;
use gyro_assembled::Dense;
use gyro_model::{Model, Number, to_f64};
use gyro_robots::legged::Legged;
use gyro_robots::manipulator::Manipulator;
use gyro_sim::{InverseDynamics, JointPlace, JointSpace, MassMatrix, Mechanism, Regressor};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use std::path::Path;

const STATES: usize = 50;

/// Rounding of some hundred operations, relative to the largest number: 1e-14 is seen.
const ROUNDING: f64 = 1e-12;

/// The five-point formula with [`STEP`]: 5e-10 is seen.
const DIFFERENCES: f64 = 1e-8;
const STEP: f64 = 1e-3;

fn model(name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("models/{name}.toml"));
    let text = std::fs::read_to_string(&path).expect("a model file");
    gyro_model::read(name, &text).expect("a correct model file")
}

/// Seeded random numbers, the same on every machine.
struct Random(ChaCha8Rng);

impl Random {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn signed(&mut self) -> f64 {
        self.0.random_range(-1.0..1.0)
    }

    fn vector(&mut self) -> [f64; 3] {
        [(); 3].map(|()| self.signed())
    }

    /// Euler parameters.
    fn unit(&mut self) -> [f64; 4] {
        let p = [(); 4].map(|()| self.signed());
        let length = p.iter().map(|e| e * e).sum::<f64>().sqrt();
        p.map(|e| e / length)
    }
}

/// A joint state anyhow, its Euler parameters unit vectors.
fn state<M: JointSpace<Scalar = f64>>(mechanism: &M, random: &mut Random) -> M::Joints {
    let mut x = Vec::new();
    for place in mechanism.joint_layout().places {
        match place {
            JointPlace::Scalar { .. } | JointPlace::Turn { .. } | JointPlace::State { .. } => {
                x.push(random.signed())
            }
            JointPlace::Orientation { .. } => x.extend(random.unit()),
            JointPlace::Body { .. } => x.extend(random.vector().into_iter().chain(random.unit())),
        }
    }
    x.extend((0..mechanism.joint_layout().n_rates()).map(|_| 3.0 * random.signed()));
    let mut state = mechanism.joint_start();
    state.as_mut()[..x.len()].copy_from_slice(&x);
    state
}

/// Some rates, or accelerations.
fn rates<M: JointSpace<Scalar = f64>>(mechanism: &M, random: &mut Random) -> M::Rates {
    let mut rates = mechanism.joint_buffers().rates;
    rates.as_mut().iter_mut().for_each(|rate| *rate = 5.0 * random.signed());
    rates
}

fn inverse<M: InverseDynamics<Scalar = f64>>(
    mechanism: &M,
    t: f64,
    x: &M::Joints,
    given: &M::Rates,
) -> Vec<f64> {
    let mut out = mechanism.joint_buffers().rates;
    mechanism.inverse_dynamics(t, x, given, &mut out);
    out.as_ref().to_vec()
}

fn bias<M: InverseDynamics<Scalar = f64>>(mechanism: &M, t: f64, x: &M::Joints) -> Vec<f64> {
    let mut out = mechanism.joint_buffers().rates;
    mechanism.bias_forces(t, x, &mut out);
    out.as_ref().to_vec()
}

fn gravity<M: InverseDynamics<Scalar = f64>>(mechanism: &M, t: f64, x: &M::Joints) -> Vec<f64> {
    let mut out = mechanism.joint_buffers().rates;
    mechanism.gravity_forces(t, x, &mut out);
    out.as_ref().to_vec()
}

fn masses<M: MassMatrix<Scalar = f64>>(mechanism: &M, t: f64, x: &M::Joints) -> DMatrix<f64> {
    let mut out = mechanism.mass_buffer();
    mechanism.mass_matrix(t, x, &mut out);
    let n = mechanism.mass_order().len();
    DMatrix::from_row_slice(n, n, out.as_ref())
}

/// The state after h seconds at these accelerations, to first order in all but angles; Euler parameters turn by the
/// whole angle of the rotation.
fn moved<M: JointSpace<Scalar = f64>>(mechanism: &M, x: &M::Joints, given: &[f64], h: f64) -> M::Joints {
    let (n_x, n_u) = (mechanism.joint_layout().n_coordinates(), mechanism.joint_layout().n_rates());
    let speeds: Vec<f64> =
        x.as_ref()[n_x..n_x + n_u].iter().zip(given).map(|(u, a)| h * (u + 0.5 * h * a)).collect();
    let mut state = displaced(mechanism, x, &speeds);
    state.as_mut()[n_x..].iter_mut().zip(given).for_each(|(u, a)| *u += h * a);
    state
}

/// The state moved by finite amounts along the rates.
fn displaced<M: JointSpace<Scalar = f64>>(mechanism: &M, x: &M::Joints, by: &[f64]) -> M::Joints {
    let mut state = x.clone();
    let (mut at, mut from) = (state.as_mut(), by);
    for place in mechanism.joint_layout().places {
        let (own, rest) = at.split_at_mut(place.n_coordinates());
        let (along, others) = from.split_at(place.n_rates());
        let n_straight = match place {
            JointPlace::Scalar { .. } => 1,
            JointPlace::Orientation { .. } | JointPlace::Turn { .. } | JointPlace::State { .. } => 0,
            JointPlace::Body { .. } => 3,
        };
        own.iter_mut().zip(&along[..n_straight]).for_each(|(x, by)| *x += by);
        if let [x, y, z] = along[n_straight..] {
            turn(&mut own[n_straight..], [x, y, z]);
        }
        (at, from) = (rest, others);
    }
    state
}

/// Euler parameters after a rotation about a vector in the body's frame, by its length.
fn turn(p: &mut [f64], [x, y, z]: [f64; 3]) {
    let half = 0.5 * (x * x + y * y + z * z).sqrt();
    let (cosine, factor) = (half.cos(), if half == 0.0 { 0.5 } else { 0.5 * half.sin() / half });
    let (a, [b, c, d]) = (cosine, [x, y, z].map(|e| factor * e));
    let [e0, e1, e2, e3] = [p[0], p[1], p[2], p[3]];
    p.copy_from_slice(&[
        e0 * a - e1 * b - e2 * c - e3 * d,
        e0 * b + e1 * a + e2 * d - e3 * c,
        e0 * c - e1 * d + e2 * a + e3 * b,
        e0 * d + e1 * c - e2 * b + e3 * a,
    ]);
}

fn maximal<M: JointSpace<Scalar = f64>>(mechanism: &M, t: f64, x: &M::Joints) -> Vec<f64> {
    let mut y = mechanism.start();
    mechanism.to_maximal(t, x, &mut y);
    y.as_ref().to_vec()
}

/// The five-point formula.
fn slope(mut f: impl FnMut(f64) -> Vec<f64>) -> Vec<f64> {
    let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k| f(k * STEP));
    (0..a.len()).map(|k| (a[k] - d[k] + 8.0 * (c[k] - b[k])) / (12.0 * STEP)).collect()
}

/// `diag(M, J')`, from the model file.
fn diagonal(model: &Model) -> DMatrix<f64> {
    let number = |number: &Number| model.value(number);
    let bodies = model.coordinate_bodies();
    let mut matrix = DMatrix::zeros(6 * bodies.len(), 6 * bodies.len());
    for (place, &body) in bodies.iter().enumerate() {
        let [xx, yy, zz, xy, xz, yz] = [0, 1, 2, 3, 4, 5].map(|k| number(&model.bodies[body].inertia[k]));
        for (k, row) in [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]].into_iter().enumerate() {
            matrix[(6 * place + k, 6 * place + k)] = number(&model.bodies[body].mass);
            (0..3).for_each(|l| matrix[(6 * place + 3 + k, 6 * place + 3 + l)] = row[l]);
        }
    }
    matrix
}

/// What armatures add to the mass matrix: of each the inertia times the squares of the rates that turn it, by couplers
/// too.
fn armatures<M: JointSpace<Scalar = f64>>(model: &Model, mechanism: &M) -> DMatrix<f64> {
    let n = mechanism.joint_layout().n_rates();
    let (mut turning, mut at) = (vec![DVector::zeros(n); model.joints.len()], 0);
    for place in mechanism.joint_layout().places {
        if let JointPlace::Scalar { joint, .. } = *place {
            turning[usize::from(joint)][at] = 1.0;
        }
        at += place.n_rates();
    }
    for coupler in &model.couplers {
        let Some((first, Number::Exact(ratio), _)) = coupler.linear() else {
            panic!("a ratio that is no parameter")
        };
        turning[coupler.second.expect("a coupler's").joint] = &turning[first.joint] * to_f64(ratio);
    }
    let joints = model.joints.iter().zip(&turning);
    joints.fold(DMatrix::zeros(n, n), |sum, (joint, turning)| {
        sum + turning * turning.transpose() * model.value(&joint.armature)
    })
}

/// B: how the velocities of the bodies depend on the rates.
fn free_motions<M: JointSpace<Scalar = f64>>(mechanism: &M, t: f64, x: &M::Joints) -> DMatrix<f64> {
    let (n_x, n_u) = (mechanism.joint_layout().n_coordinates(), mechanism.joint_layout().n_rates());
    let n = mechanism.description().bodies.len();
    let velocities = |x: &M::Joints| DVector::from_column_slice(&maximal(mechanism, t, x)[7 * n..13 * n]);
    let columns = (0..n_u).map(|rate| {
        let mut faster = x.clone();
        faster.as_mut()[n_x + rate] += 1.0;
        velocities(&faster) - velocities(x)
    });
    DMatrix::from_columns(&columns.collect::<Vec<_>>())
}

/// `Bᵀ (M v̇ − f)` with f of the runtime-assembled model, and what armatures take.
fn virtual_power<M>(
    model: &Model,
    mechanism: &M,
    inputs: &[f64],
    (t, x, given): (f64, &M::Joints, &[f64]),
) -> Vec<f64>
where
    M: JointSpace<Scalar = f64>,
{
    // What armatures take is added here.
    let mut bare = model.clone();
    bare.joints.iter_mut().for_each(|joint| joint.armature = Number::integer(0));
    let (mut dense, n) =
        (Dense::<f64>::new(&bare).expect("a dense form"), mechanism.description().bodies.len());
    inputs.iter().enumerate().for_each(|(index, &value)| assert!(dense.set_input(index, value)));
    let accelerations =
        slope(|h| maximal(mechanism, t + h, &moved(mechanism, x, given, h))[7 * n..13 * n].to_vec());
    let mut applied = dense.buffers().velocities;
    let mut y = dense.start();
    y.copy_from_slice(&maximal(mechanism, t, x));
    dense.applied_force(t, &y, &mut applied);
    let imbalance =
        diagonal(model) * DVector::from_vec(accelerations) - DVector::from_column_slice(applied.as_ref());
    let rotors = armatures(model, mechanism) * DVector::from_column_slice(given);
    (free_motions(mechanism, t, x).transpose() * imbalance + rotors).as_slice().to_vec()
}

/// The largest difference, relative to the largest number.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len());
    let largest = |values: &mut dyn Iterator<Item = f64>| {
        values.fold(0.0, |most: f64, x| if x.abs() <= most { most } else { x.abs() })
    };
    largest(&mut found.iter().zip(expected).map(|(a, b)| a - b))
        / largest(&mut expected.iter().copied()).max(1e-300)
}

/// All that holds of any mechanism.
fn check<M: InverseDynamics<Scalar = f64> + MassMatrix + Clone>(name: &str, mechanism: &M) {
    let (model, mut random) = (model(name), Random::new(3));
    let mut worst = [0.0_f64; 6];
    for _ in 0..STATES {
        let (mut mechanism, t) = (mechanism.clone(), random.signed());
        let inputs: Vec<f64> = mechanism.description().inputs.iter().map(|_| 5.0 * random.signed()).collect();
        inputs.iter().enumerate().for_each(|(index, &value)| assert!(mechanism.set_input(index, value)));
        let (x, given) = (state(&mechanism, &mut random), rates(&mechanism, &mut random));
        let (tau, h, mass) =
            (inverse(&mechanism, t, &x, &given), bias(&mechanism, t, &x), masses(&mechanism, t, &x));

        // Virtual power.
        let expected = virtual_power(&model, &mechanism, &inputs, (t, &x, given.as_ref()));
        worst[0] = worst[0].max(difference(&tau, &expected));
        // τ = M a + h.
        let sum = &mass * DVector::from_column_slice(given.as_ref()) + DVector::from_column_slice(&h);
        worst[1] = worst[1].max(difference(&tau, sum.as_slice()));
        // M = Bᵀ diag(M, J') B, and armatures.
        let b = free_motions(&mechanism, t, &x);
        let composed = b.transpose() * diagonal(&model) * &b + armatures(&model, &mechanism);
        worst[2] = worst[2].max(difference(mass.as_slice(), composed.as_slice()));
        // The accelerations of the joints take no force.
        let mut free = mechanism.joint_buffers().rates;
        mechanism.joint_accelerations(t, &x, &mut free);
        let at_rest: Vec<_> =
            inverse(&mechanism, t, &x, &free).iter().zip(&h).map(|(tau, h)| tau + h).collect();
        worst[3] = worst[3].max(difference(&at_rest, &h));
        // M⁻¹ (τ − h) = a.
        let (mut factor, mut found) = (mechanism.mass_buffer(), given.clone());
        mechanism.mass_factor(t, &x, &mut factor);
        found.as_mut().iter_mut().zip(tau.iter().zip(&h)).for_each(|(x, (tau, h))| *x = tau - h);
        mechanism.mass_solve(&factor, &mut found);
        worst[4] = worst[4].max(difference(found.as_ref(), given.as_ref()));
        // The weights of the bodies.
        let weights = (0..model.coordinate_bodies().len()).flat_map(|body| {
            let g =
                model.gravity.each_ref().map(|g| if let Number::Exact(g) = g { to_f64(g) } else { f64::NAN });
            let mass = diagonal(&model)[(6 * body, 6 * body)];
            g.map(|g| -mass * g).into_iter().chain([0.0; 3])
        });
        let weights = DVector::from_vec(weights.collect());
        worst[5] =
            worst[5].max(difference(&gravity(&mechanism, t, &x), (b.transpose() * weights).as_slice()));
    }
    println!("{name}: {worst:?}");
    assert!(worst[0] <= DIFFERENCES, "{name}: {worst:?}");
    assert!(worst[1..].iter().all(|error| *error <= ROUNDING), "{name}: {worst:?}");
}

#[test]
fn forces_and_masses_are_those_of_virtual_power() {
    check("legged", &Legged::default());
    check("manipulator", &Manipulator::default());
}

/// Without dissipation and moving carriers the power of τ is what the energy grows by.
#[test]
fn the_power_of_forces_is_the_rate_of_the_energy() {
    let (mechanism, mut random, mut worst) = (Legged::<f64>::default(), Random::new(4), 0.0_f64);
    for _ in 0..STATES {
        let (x, given) = (state(&mechanism, &mut random), rates(&mechanism, &mut random));
        let tau = inverse(&mechanism, 0.0, &x, &given);
        let (n_x, n_u) = (mechanism.joint_layout().n_coordinates(), mechanism.joint_layout().n_rates());
        let power: f64 = tau.iter().zip(&x[n_x..n_x + n_u]).map(|(tau, u)| tau * u).sum();
        let energy = |h: f64| {
            let mut y = mechanism.start();
            mechanism.to_maximal(0.0, &moved(&mechanism, &x, &given, h), &mut y);
            vec![mechanism.energy(0.0, &y).total()]
        };
        worst = worst.max(difference(&[power], &slope(energy)));
    }
    println!("legged: {worst:.1e}");
    assert!(worst <= DIFFERENCES, "{worst:e}");
}

/// Motors that give τ beside what they give already make of the joints what was asked.
#[test]
fn motors_with_these_forces_bring_about_the_accelerations() {
    let (mut mechanism, mut random, mut worst) = (Manipulator::<f64>::default(), Random::new(5), 0.0_f64);
    for _ in 0..STATES {
        let (t, x, given) = (random.signed(), state(&mechanism, &mut random), rates(&mechanism, &mut random));
        (0..3).for_each(|motor| assert!(mechanism.set_input(motor, 0.0)));
        for (motor, tau) in inverse(&mechanism, t, &x, &given).into_iter().enumerate() {
            assert!(mechanism.set_input(motor, tau));
        }
        let mut found = mechanism.joint_buffers().rates;
        mechanism.joint_accelerations(t, &x, &mut found);
        worst = worst.max(difference(&found, &given));
    }
    println!("manipulator: {worst:.1e}");
    assert!(worst <= ROUNDING, "{worst:e}");
}

fn regressor<M: Regressor<Scalar = f64>>(
    mechanism: &M,
    t: f64,
    x: &M::Joints,
    given: &M::Rates,
) -> DMatrix<f64> {
    let (n, bodies) = (mechanism.joint_layout().n_rates(), mechanism.description().bodies.len());
    let mut out = mechanism.regressor_buffer();
    mechanism.regressor(t, x, given, &mut out);
    DMatrix::from_row_slice(n, 10 * bodies, out.as_ref())
}

/// θ of a model file.
fn parameters(model: &Model) -> DVector<f64> {
    let matrix = diagonal(model);
    let of_body = |body: usize| {
        let entry = |row: usize, column: usize| matrix[(6 * body + row, 6 * body + column)];
        let inertia =
            [(3, 3), (4, 4), (5, 5), (3, 4), (3, 5), (4, 5)].map(|(row, column)| entry(row, column));
        [entry(0, 0), 0.0, 0.0, 0.0].into_iter().chain(inertia)
    };
    DVector::from_vec((0..matrix.nrows() / 6).flat_map(of_body).collect())
}

/// Without dissipation forces at two motions through one position differ by what inertia takes, for springs give the
/// same.
#[test]
fn forces_are_a_product_with_inertial_parameters() {
    let (mechanism, model, mut random) = (Legged::<f64>::default(), model("legged"), Random::new(7));
    let (theta, mut worst) = (parameters(&model), 0.0_f64);
    for _ in 0..STATES {
        let (x, mut y) = (state(&mechanism, &mut random), state(&mechanism, &mut random));
        let n_x = mechanism.joint_layout().n_coordinates();
        y.as_mut()[..n_x].copy_from_slice(&x[..n_x]);
        let [a, b] = [x, y].map(|x| {
            let given = rates(&mechanism, &mut random);
            let tau = DVector::from_vec(inverse(&mechanism, 0.0, &x, &given));
            (tau, regressor(&mechanism, 0.0, &x, &given))
        });
        worst = worst.max(difference(((b.1 - a.1) * &theta).as_slice(), (b.0 - a.0).as_slice()));
    }
    println!("legged: {worst:.1e}");
    assert!(worst <= ROUNDING, "{worst:e}");
}

/// A heavier payload takes what its column says.
#[test]
fn a_column_is_what_a_parameter_changes() {
    let (light, mut heavy) = (Manipulator::<f64>::default(), Manipulator::<f64>::default());
    let mut values = *heavy.parameters();
    values.payload += 1.0;
    heavy.set_parameters(values);
    let hand = light.description().bodies.iter().position(|body| *body == "hand").expect("it has one");
    let (mut random, mut worst) = (Random::new(8), 0.0_f64);
    for _ in 0..STATES {
        let (t, x, given) = (random.signed(), state(&light, &mut random), rates(&light, &mut random));
        let [a, b] = [&light, &heavy].map(|m| DVector::from_vec(inverse(m, t, &x, &given)));
        let column = regressor(&light, t, &x, &given).column(10 * hand).into_owned();
        worst = worst.max(difference((b - a).as_slice(), column.as_slice()));
    }
    println!("manipulator: {worst:.1e}");
    assert!(worst <= ROUNDING, "{worst:e}");
}
