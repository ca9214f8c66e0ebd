//! Which numbers of reactions are unique: random linkages with redundant rows against the null space of the whole
//! Jacobian, found by singular values.

use crate::redundancy::{Pin, model, pinned};
use chacha20::ChaCha8Rng;
use gyro_model::{Kinematics, Model, analyse};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Vector3};
use rand::{RngExt, SeedableRng};

/// Singular values below this part of the largest are zero; of a null vector's reactions numbers below this are.
const ZERO: f64 = 1e-7;

/// A body's rotation and mass centre at the start.
fn placed(model: &Model, q: &[f64], body: usize) -> (Rotation3<f64>, Vector3<f64>, Option<usize>) {
    let Some(place) = model.coordinate_bodies().iter().position(|other| *other == body) else {
        return (Rotation3::identity(), Vector3::zeros(), None);
    };
    let q = &q[7 * place..7 * place + 7];
    let p = nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[3], q[4], q[5], q[6]));
    (p.to_rotation_matrix(), Vector3::new(q[0], q[1], q[2]), Some(place))
}

/// Of each joint the numbers of its reaction that something in the null space of the transposed Jacobian changes.
fn by_singular_values(model: &Model) -> Vec<[bool; 6]> {
    let (start, kinematics) = (model.assemble().expect("a good model file"), Kinematics::at(model, 0.0));
    let near: Vec<Vec<f64>> = start.joints.iter().map(|joint| joint.position.clone()).collect();
    let jacobian = kinematics.jacobian(&start.q, &near);
    let n = jacobian.nrows();
    let square = DMatrix::from_fn(n, n.max(jacobian.ncols()), |row, column| {
        if column < jacobian.ncols() { jacobian[(row, column)] } else { 0.0 }
    });
    let svd = square.svd(true, false);
    let (u, largest) = (svd.u.expect("it was asked for"), svd.singular_values.max());
    let idle: Vec<DVector<f64>> = (0..n)
        .filter(|&k| svd.singular_values[k] < ZERO * largest)
        .map(|k| u.column(k).into_owned())
        .collect();
    let changed = |joint: usize| {
        let described = &model.joints[joint];
        let [first, second] =
            [described.first.body, described.second.body].map(|body| placed(model, &start.q, body));
        let body = if second.2.is_some() { second } else { first };
        let vector =
            |numbers: &[gyro_model::Number; 3]| Vector3::from(numbers.each_ref().map(|x| model.value(x)));
        let axis = vector(&described.first.axis).normalize();
        let across = vector(&described.first.zero);
        let across = (across - axis * axis.dot(&across)).normalize();
        let frame = first.0 * Matrix3::from_columns(&[across, axis.cross(&across), axis]);
        let point = second.1 + second.0 * vector(&described.second.point);
        let mut all = [false; 6];
        for idle in &idle {
            let own = kinematics.rows().iter().enumerate();
            let own = own.filter(|(_, row)| row.owner == gyro_model::RowOwner::Joint(joint));
            let six = own.fold(DVector::zeros(6), |sum, (row, _)| {
                sum + jacobian.view((row, 6 * body.2.expect("it moves")), (1, 6)).transpose() * idle[row]
            });
            let force = Vector3::new(six[0], six[1], six[2]);
            let torque = body.0 * Vector3::new(six[3], six[4], six[5]) + (body.1 - point).cross(&force);
            let numbers = [force, torque].map(|v| frame.transpose() * v);
            for k in 0..6 {
                all[k] |= numbers[k / 3][k % 3].abs() > ZERO;
            }
        }
        all
    };
    (0..model.joints.len()).map(changed).collect()
}

fn found(model: &Model) -> Vec<[bool; 6]> {
    let mut all = vec![[false; 6]; model.joints.len()];
    for (joint, changed) in
        analyse(model).expect("a good model file").redundant.iter().flat_map(|dropped| dropped.loads.clone())
    {
        (0..6).for_each(|k| all[joint][k] |= changed[k]);
    }
    all
}

fn some(random: &mut ChaCha8Rng) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.random_range(-1.0..1.0))
}

/// A linkage of a kind, turned in space at random: bodies and pins.
fn linkage(kind: usize, random: &mut ChaCha8Rng) -> (usize, Vec<Pin>) {
    let turn = Rotation3::from_scaled_axis(3.0 * some(random));
    let pin = |bodies, at: Vector3<f64>, axis: Vector3<f64>| Pin {
        bodies,
        at: (turn * at).into(),
        axis: (turn * axis).into(),
    };
    let mut flat = |x: f64, y: f64| {
        Vector3::new(x, y, 0.0)
            + 0.2 * Vector3::new(random.random_range(-1.0..1.0), random.random_range(-1.0..1.0), 0.0)
    };
    let four = [flat(0.0, 0.0), flat(0.2, 1.0), flat(1.3, 1.4), flat(1.0, 0.0)];
    let (z, loops) = (Vector3::z(), [[0, 1], [1, 2], [2, 3], [0, 3]]);
    let bodies = loops.into_iter().zip(four);
    match kind {
        // In a plane.
        0 => (4, bodies.map(|(bodies, at)| pin(bodies, at, z)).collect()),
        // The same with a hinge that is made of two.
        1 => {
            let twice = pin([0, 1], four[0] + 0.5 * z, z);
            (4, bodies.map(|(bodies, at)| pin(bodies, at, z)).chain([twice]).collect())
        }
        // All axes through one point.
        2 => {
            let lifted = |at: Vector3<f64>| at + Vector3::new(-0.5, -0.5, 1.5);
            (4, bodies.map(|(bodies, at)| pin(bodies, lifted(at), lifted(at))).collect())
        }
        // A door on two hinges.
        3 => (2, vec![pin([0, 1], four[0], z), pin([0, 1], four[0] + z, z)]),
        // Two loops in a plane, one behind the other.
        _ => {
            let more = [([2, 4], flat(0.8, 2.5)), ([4, 5], flat(2.0, 2.2)), ([0, 5], flat(2.4, 0.1))];
            let all = bodies.chain(more);
            (6, all.map(|(bodies, at)| pin(bodies, at, z)).collect())
        }
    }
}

#[test]
fn reactions_are_unique_where_nothing_idle_reaches_them() {
    let cases = std::env::var("GYRO_LOADS").ok().and_then(|cases| cases.parse().ok()).unwrap_or(40);
    let mut random = ChaCha8Rng::seed_from_u64(4010);
    for case in 0..cases {
        let (n_bodies, pins) = linkage(case % 5, &mut random);
        let model = model(&pinned(n_bodies, &pins));
        let expected = by_singular_values(&model);
        assert_eq!(found(&model), expected, "case {case}");
        let mixed = expected.iter().flatten().any(|x| *x) && expected.iter().flatten().any(|x| !*x);
        assert!(mixed, "case {case}: {expected:?}");
    }
}

#[test]
fn in_a_planar_linkage_the_loads_in_its_plane_are_unique() {
    let mut random = ChaCha8Rng::seed_from_u64(4011);
    let (n_bodies, pins) = linkage(0, &mut random);
    let out_of_plane = [false, false, true, true, true, false];
    assert_eq!(found(&model(&pinned(n_bodies, &pins))), vec![out_of_plane; 4]);
}
