//! Eq. (17): both forms solve it, and they agree.

use crate::support::{Random, assert_close, careful_models, dense_phi_pi, state_near};
use gyro_assembled::{Careful, Dense};
use gyro_sim::{Dynamics, Kinematics, Mechanism, Projection};
use nalgebra::{DMatrix, DVector};

const STATES: usize = 200;

/// Any time at which what is driven moves and accelerates.
const TIME: f64 = 0.3;

/// How closely both engines must agree: rounding of eq. (17), with a margin of some decades.
const AGREEMENT: f64 = 1e-10;

fn accelerations<M: Kinematics<Scalar = f64> + Dynamics + Projection>(
    mechanism: &M,
    y: &M::State,
) -> (Vec<f64>, Vec<f64>) {
    let (mut a, mut lambda) = (mechanism.acceleration_buffer(), mechanism.buffers().rows);
    mechanism.accelerations(TIME, y, &mut a);
    mechanism.multipliers(TIME, y, &a, &mut lambda);
    (a.as_ref()[..6 * mechanism.description().bodies.len()].to_vec(), lambda.as_ref().to_vec())
}

fn for_each_state(
    spread: f64,
    mut check: impl FnMut(&str, &gyro_model::Model, &Dense<f64>, &Careful<f64>, Vec<f64>),
) {
    for (seed, model) in (0..).zip(careful_models()) {
        let dense = Dense::<f64>::new(&model).expect("the model has a start");
        let careful = Careful::<f64>::new(&model).expect("the model has a start");
        let mut random = Random(seed);
        for state in 0..STATES {
            let y = state_near(&dense, spread, &mut random);
            check(&format!("{} state {state}", model.name), &model, &dense, &careful, y);
        }
    }
}

#[test]
fn both_forms_agree_on_and_off_the_manifold() {
    let mut n_different = 0;
    for spread in [0.0, 1e-3, 0.3, 0.5] {
        for_each_state(spread, |what, _, dense, careful, y| {
            let (a, lambda) = accelerations(dense, &y);
            let (b, mu) = accelerations(careful, &y);
            assert_close(&format!("{what} acceleration"), &a, &b, 1.0, AGREEMENT);
            assert_close(&format!("{what} multiplier"), &lambda, &mu, 1e-3, AGREEMENT);
            n_different += usize::from(a != b);
        });
    }
    assert!(n_different > 4 * STATES, "the forms hardly ever differ: is one compared with itself?");
}

#[test]
fn both_forms_leave_no_residual_in_equation_17() {
    for_each_state(0.3, |what, model, dense, careful, y| {
        let phi_pi = dense_phi_pi(dense, TIME, &y);
        let mass = mass_matrix(model, &y);
        let (mut force, mut gamma) = (dense.buffers().velocities, dense.buffers().rows);
        dense.applied_force(TIME, &y, &mut force);
        dense.gamma(TIME, &y, &mut gamma);
        for (a, lambda) in [accelerations(dense, &y), accelerations(careful, &y)] {
            let (a, lambda) = (DVector::from_vec(a), DVector::from_vec(lambda));
            let balance = &mass * &a + phi_pi.transpose() * &lambda;
            let scale = (&mass * &a).amax().max(lambda.amax());
            assert_close(&format!("{what} balance"), balance.as_slice(), &force, scale, 1e-11);
            assert_close(&format!("{what} γ"), (&phi_pi * &a).as_slice(), &gamma, a.amax(), 1e-11);
        }
    });
}

#[test]
fn single_precision_follows_double() {
    for model in careful_models() {
        let (careful, dense) = (Careful::<f32>::new(&model), Dense::<f32>::new(&model));
        let (careful, dense) = (careful.expect("it has a start"), dense.expect("it has a start"));
        let reference = Careful::<f64>::new(&model).expect("it has a start");
        let mut expected = reference.start();
        reference.derivative(0.0, &reference.start(), &mut expected);
        let scale = crate::support::max_norm(&expected);
        let mut out = careful.start();
        careful.derivative(0.0, &careful.start(), &mut out);
        let wide: Vec<f64> = out.iter().map(|&x| f64::from(x)).collect();
        assert_close(&model.name, &wide, &expected, scale, 1e-4);
        dense.derivative(0.0, &dense.start(), &mut out);
        let wide: Vec<f64> = out.iter().map(|&x| f64::from(x)).collect();
        // The plain form mixes kilograms and kg·m² in one unscaled matrix: single precision leaves it little.
        assert_close(&model.name, &wide, &expected, scale, 1e-2);
    }
}

/// `diag(M, J')`, and `J b bᵀ` of armatures about the second bodies' axes.
fn mass_matrix(model: &gyro_model::Model, y: &[f64]) -> DMatrix<f64> {
    let moving_bodies = model.coordinate_bodies();
    let mut matrix = DMatrix::zeros(6 * moving_bodies.len(), 6 * moving_bodies.len());
    for (moving_body, &body) in moving_bodies.iter().enumerate() {
        let body = &model.bodies[body];
        let [xx, yy, zz, xy, xz, yz] = model.values(&body.inertia);
        let inertia = nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        (0..3).for_each(|k| matrix[(6 * moving_body + k, 6 * moving_body + k)] = model.value(&body.mass));
        matrix.fixed_view_mut::<3, 3>(6 * moving_body + 3, 6 * moving_body + 3).copy_from(&inertia);
    }
    for joint in model.joints.iter().filter(|joint| !joint.armature.is_zero()) {
        assert_eq!(joint.kind, gyro_model::JointKind::Revolute);
        let slot = |end: &gyro_model::JointEnd| moving_bodies.iter().position(|&body| body == end.body);
        let rotation = |slot: usize| {
            let p = &y[7 * slot + 3..7 * slot + 7];
            nalgebra::UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(p[0], p[1], p[2], p[3]))
        };
        let (axis, second) =
            (nalgebra::Vector3::from(model.values(&joint.second.axis)).normalize(), slot(&joint.second));
        let second = second.expect("armatures lead to moving bodies");
        let mut b = DVector::zeros(matrix.nrows());
        b.fixed_rows_mut::<3>(6 * second + 3).copy_from(&axis);
        if let Some(first) = slot(&joint.first) {
            let on_first = rotation(first).inverse() * (rotation(second) * axis);
            b.fixed_rows_mut::<3>(6 * first + 3).copy_from(&-on_first);
        }
        matrix += &b * b.transpose() * model.value(&joint.armature);
    }
    matrix
}
