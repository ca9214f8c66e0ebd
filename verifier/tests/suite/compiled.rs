//! The interpreter over `f64` computes what the compiler makes of the same text, bit by bit.

use chacha20::ChaCha8Rng;
use gyro_mechanisms::{four_bar::FourBar, torsion::Torsion};
use gyro_sim::{CorrectedSolution, Dynamics, JointJacobian, Kinematics, Partition, Projection};
use gyro_verifier::atoms::Elementary;
use gyro_verifier::interpreter::{Given, constants, run};
use gyro_verifier::module::{Module, source_of_accelerations};
use gyro_verifier::point::Point;
use rand::{RngExt, SeedableRng};
use std::collections::BTreeSet;

const STATES: usize = 20;

#[test]
fn an_interpreted_tree_is_a_compiled_one() {
    let mechanism = Torsion::<f64>::default();
    check("torsion", &mechanism);
    check_joints("torsion", &mechanism);
}

#[test]
fn an_interpreted_loop_is_a_compiled_one() {
    check("four-bar", &FourBar::<f64>::default());
}

/// Takes each literal for exact: over `f64` only literals count.
fn literals(code: &str) -> String {
    let calls = code.split("k(").skip(1).filter_map(|rest| rest.split_once(')'));
    let literals: BTreeSet<&str> = calls.map(|(literal, _)| literal).collect();
    let exact =
        |literal: &str| gyro_model::parse_decimal(literal).map(|exact| format!("{literal} = {exact}\n"));
    literals.into_iter().filter_map(exact).collect()
}

fn check<M>(page: &str, mechanism: &M)
where
    M: Kinematics<Scalar = f64> + Dynamics + Projection,
{
    let (page, module) = read(page);
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for _ in 0..STATES {
        let mut y = mechanism.start();
        y.as_mut().iter_mut().for_each(|x| *x = random.random_range(-1.0..1.0));
        let t = random.random_range(-1.0..1.0);
        compare(&module, &page.model, mechanism, t, &y);
    }
}

fn read(page: &str) -> (crate::support::Page, Module) {
    let page = crate::support::page(page);
    // A start has literals that no formula has.
    let is_start = |function: &str| function.starts_with("start(") || function.starts_with("joint_start(");
    let formulas: String = page.code.split("fn ").filter(|function| !is_start(function)).collect();
    let module = Module::read(&page.model, &page.code, &literals(&formulas)).expect("the emitted subset");
    (page, module)
}

/// The functions of joint coordinates.
fn check_joints<M>(page: &str, mechanism: &M)
where
    M: JointJacobian<Scalar = f64> + CorrectedSolution + Partition,
{
    let (page, module) = read(page);
    let numbers: Vec<f64> = constants((), &module);
    let mut random = ChaCha8Rng::seed_from_u64(10);
    for _ in 0..STATES {
        let (t, mut x, mut y) = (random.random_range(-1.0..1.0), mechanism.joint_start(), mechanism.start());
        x.as_mut().iter_mut().chain(y.as_mut()).for_each(|x| *x = random.random_range(-1.0..1.0));
        let point = point(&page.model, t, y.as_ref());
        let run = |function: &str, accelerations: &[f64]| {
            let given = Given { point: &point, accelerations, charts: &[], changes: &[], joints: x.as_ref() };
            run(&module, &module.programs[function], &numbers, &Elementary, &given).expect("numbers")
        };
        let same = |function: &str, compiled: &[f64]| {
            let accelerations = run(source_of_accelerations(function), &[]);
            assert_same(function, &run(function, &accelerations), compiled);
        };
        let mut rates = mechanism.joint_buffers().rates;
        mechanism.joint_accelerations(t, &x, &mut rates);
        same("joint_accelerations", rates.as_ref());
        mechanism.joint_accelerations_at(t, &y, &mut rates);
        same("joint_accelerations_at", rates.as_ref());
        let mut dx = x.clone();
        mechanism.joint_derivative(t, &x, &mut dx);
        same("joint_derivative", dx.as_ref());
        let (mut by_state, mut by_time) = (mechanism.jacobian_buffers().jacobian, x.clone());
        mechanism.joint_jacobian(t, &x, &mut by_state, &mut by_time);
        same("joint_jacobian", &[by_state.as_ref(), by_time.as_ref()].concat());
        let mut joints = x.clone();
        mechanism.to_joints(t, &y, &mut joints);
        same("to_joints", joints.as_ref());
        let (mut maximal, mut dy) = (y.clone(), y.clone());
        mechanism.to_maximal(t, &x, &mut maximal);
        same("to_maximal", maximal.as_ref());
        let mut accelerations = mechanism.buffers().velocities;
        mechanism.corrected_accelerations(t, &y, &mut accelerations);
        same("corrected_accelerations", accelerations.as_ref());
        let mut lambda = mechanism.buffers().rows;
        mechanism.corrected_multipliers(t, &y, &accelerations, &mut lambda);
        same("corrected_multipliers", lambda.as_ref());
        let mut solution = mechanism.solution_buffer();
        mechanism.corrected_solution(t, &y, &mut solution);
        same("corrected_solution", solution.as_ref());
        mechanism.corrected_derivative(t, &y, &mut dy);
        same("corrected_derivative", dy.as_ref());
    }
}

fn point(model: &gyro_model::Model, t: f64, state: &[f64]) -> Point<f64> {
    let values =
        |fields: &[gyro_model::Parameter]| fields.iter().map(|f| gyro_model::to_f64(&f.value)).collect();
    let (parameters, inputs) = (values(&model.parameters), values(&model.inputs));
    Point { context: (), t, state: state.to_vec(), parameters, inputs }
}

fn assert_same(function: &str, interpreted: &[f64], compiled: &[f64]) {
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(interpreted), bits(compiled), "{function}: {interpreted:?} {compiled:?}");
}

fn compare<M>(module: &Module, model: &gyro_model::Model, mechanism: &M, t: f64, y: &M::State)
where
    M: Kinematics<Scalar = f64> + Dynamics + Projection,
{
    let point = point(model, t, y.as_ref());
    let numbers: Vec<f64> = constants((), module);
    let mut accelerations = mechanism.acceleration_buffer();
    mechanism.accelerations(t, y, &mut accelerations);
    let mut changes = mechanism.buffers().rows;
    changes.as_mut().iter_mut().zip(y.as_ref()).for_each(|(change, y)| *change = *y);
    let same = |function: &str, compiled: &[f64]| {
        let (accelerations, changes) = (accelerations.as_ref(), changes.as_ref());
        let given = Given { point: &point, accelerations, charts: &[], changes, joints: &[] };
        let program = &module.programs[function];
        let interpreted = run(module, program, &numbers, &Elementary, &given).expect("numbers");
        assert_same(function, &interpreted, compiled);
    };
    same("accelerations", accelerations.as_ref());
    let mut dy = y.clone();
    mechanism.derivative(t, y, &mut dy);
    same("derivative", dy.as_ref());
    let mut phi = mechanism.buffers().constraints;
    mechanism.phi(t, y, &mut phi);
    same("phi", phi.as_ref());
    let mut phi_q = mechanism.terms().phi_q;
    mechanism.phi_q(t, y, &mut phi_q);
    same("phi_q", phi_q.as_ref());
    let mut gamma = mechanism.buffers().rows;
    mechanism.gamma(t, y, &mut gamma);
    same("gamma", gamma.as_ref());
    let mut lambda = mechanism.buffers().rows;
    mechanism.multipliers(t, y, &accelerations, &mut lambda);
    same("multipliers", lambda.as_ref());
    let mut motion = mechanism.buffers().velocities;
    mechanism.project(t, y, &changes, &mut motion);
    same("project", motion.as_ref());
    let energy = mechanism.energy(t, y);
    same("energy", &[energy.kinetic, energy.potential]);
    let mut readings = mechanism.buffers().readings;
    mechanism.read_joints(t, y, &mut readings);
    same("read_joints", readings.as_ref());
    let mut outputs = mechanism.buffers().outputs;
    mechanism.outputs(t, y, &mut outputs);
    same("outputs", outputs.as_ref());
}
