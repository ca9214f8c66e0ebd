//! The functions that robots are controlled with, of an arm on a moving base and of a floating base with branches, in
//! one run of criterion; the accelerations beside those of the runtime-assembled model. Every function is called at the
//! start of its model file. Operations are on the data sheets.
//!
//! Trust ratios, not nanoseconds.

use criterion::{Criterion, criterion_group, criterion_main};
use gyro_assembled::Dense;
use gyro_robots::legged::Legged;
use gyro_robots::manipulator::Manipulator;
use gyro_sim::{
    Dynamics, DynamicsDerivatives, Frames, JointJacobian, MassMatrix, Mechanism, OutputDerivatives,
    ParameterJacobian, Regressor,
};
use std::hint::black_box;
use std::time::Duration;

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = arm, legs
}
criterion_main!(benches);

/// The time at which all is evaluated, s.
const T: f64 = 0.0;

fn arm(criterion: &mut Criterion) {
    let text = include_str!("../tests/robots/models/manipulator.toml");
    robot(criterion, ("manipulator", text), &Manipulator::default());
}

fn legs(criterion: &mut Criterion) {
    let text = include_str!("../tests/robots/models/legged.toml");
    robot(criterion, ("legged", text), &Legged::default());
}

/// What a module of a robot may have.
trait Robot:
    DynamicsDerivatives<Scalar = f64>
    + MassMatrix
    + Regressor
    + Frames
    + OutputDerivatives
    + JointJacobian
    + ParameterJacobian
{
}

impl<M> Robot for M where
    M: DynamicsDerivatives<Scalar = f64>
        + MassMatrix
        + Regressor
        + Frames
        + OutputDerivatives
        + JointJacobian
        + ParameterJacobian
{
}

fn robot<M: Robot>(criterion: &mut Criterion, (name, text): (&str, &str), robot: &M) {
    let x = robot.joint_start();
    let mut group = criterion.benchmark_group(name);
    let mut bench = |function: &str, call: &mut dyn FnMut(&M::Joints)| {
        group.bench_function(function, |bencher| bencher.iter(|| call(black_box(&x))));
    };
    let rates = || robot.joint_buffers().rates;
    let mut given = rates();
    robot.joint_accelerations(T, &x, &mut given);

    let mut out = rates();
    bench("joint_accelerations", &mut |x| robot.joint_accelerations(T, x, black_box(&mut out)));
    assembled(&mut bench, text);
    bench("inverse_dynamics", &mut |x| robot.inverse_dynamics(T, x, &given, black_box(&mut out)));
    bench("bias_forces", &mut |x| robot.bias_forces(T, x, black_box(&mut out)));
    bench("gravity_forces", &mut |x| robot.gravity_forces(T, x, black_box(&mut out)));

    let mut mass = robot.mass_buffer();
    bench("mass_matrix", &mut |x| robot.mass_matrix(T, x, black_box(&mut mass)));
    bench("mass_factor", &mut |x| robot.mass_factor(T, x, black_box(&mut mass)));
    bench("mass_solve", &mut |_| {
        out.clone_from(&given);
        robot.mass_solve(&mass, black_box(&mut out));
    });

    let mut slopes = robot.inverse_buffer();
    bench("inverse_derivatives", &mut |x| robot.inverse_derivatives(T, x, &given, black_box(&mut slopes)));
    let mut slopes = robot.forward_buffer();
    bench("forward_derivatives", &mut |x| robot.forward_derivatives(T, x, black_box(&mut slopes)));
    let mut regressor = robot.regressor_buffer();
    bench("regressor", &mut |x| robot.regressor(T, x, &given, black_box(&mut regressor)));

    let mut frames = robot.frame_buffers();
    bench("frame_jacobians", &mut |x| robot.frame_jacobians(T, x, black_box(&mut frames.jacobians)));
    bench("frame_biases", &mut |x| robot.frame_biases(T, x, black_box(&mut frames.biases)));
    let mut outputs = robot.buffers().outputs;
    bench("joint_outputs", &mut |x| robot.joint_outputs(T, x, black_box(&mut outputs)));
    let mut slopes = robot.output_slopes();
    bench("outputs_by_state", &mut |x| {
        robot.outputs_by_state(T, x, &given, black_box(&mut slopes.by_state));
    });

    let (mut by_state, mut by_time) = (robot.jacobian_buffers().jacobian, robot.joint_start());
    bench("joint_jacobian", &mut |x| {
        robot.joint_jacobian(T, x, black_box(&mut by_state), black_box(&mut by_time));
    });
    let mut by_parameters = robot.parameter_buffer();
    bench("joint_parameter_jacobian", &mut |x| {
        robot.joint_parameter_jacobian(T, x, black_box(&mut by_parameters));
    });
    group.finish();
}

/// The accelerations of the bodies by the runtime-assembled model, which knows no joint coordinates.
fn assembled<J>(bench: &mut impl FnMut(&str, &mut dyn FnMut(&J)), text: &str) {
    let model = gyro_model::read("robot.toml", text).expect("a model file of the tests");
    let twin = Dense::<f64>::new(&model).expect("any mechanism");
    let (y, mut out) = (twin.start(), twin.acceleration_buffer());
    bench("accelerations, assembled, dense", &mut |_| {
        twin.accelerations(T, black_box(&y), black_box(&mut out))
    });
}
