//! The interpreter over `f64` computes what the compiler makes of the same text, bit by bit.

use gyro_sim::{Equations, Mechanism, Ode, Ports};
use gyro_verifier::atoms::Elementary;
use gyro_verifier::interpreter::{Given, constants, run};
use gyro_verifier::module::Module;
use gyro_verifier::point::Point;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeSet;

#[path = "../../../gyro-sim/src/generated/four_bar.rs"]
#[rustfmt::skip]
#[allow(warnings, clippy::all, reason = "generated code is checked for what it computes, not for its style")]
mod four_bar;
#[path = "../../../gyro-sim/src/generated/torsion.rs"]
#[rustfmt::skip]
#[allow(warnings, clippy::all, reason = "generated code is checked for what it computes, not for its style")]
mod torsion;

const STATES: usize = 20;

#[test]
fn an_interpreted_tree_is_a_compiled_one() {
    check(
        "torsion",
        include_str!("../../../gyro-sim/src/generated/torsion.rs"),
        &torsion::Torsion::<f64>::default(),
    );
}

#[test]
fn an_interpreted_loop_is_a_compiled_one() {
    check(
        "four-bar",
        include_str!("../../../gyro-sim/src/generated/four_bar.rs"),
        &four_bar::FourBar::<f64>::default(),
    );
}

/// Takes each literal for exact: over `f64` only literals count.
fn literals(code: &str) -> String {
    let calls = code.split("k(").skip(1).filter_map(|rest| rest.split_once(')'));
    let literals: BTreeSet<&str> = calls.map(|(literal, _)| literal).collect();
    let exact =
        |literal: &str| gyro_model::parse_decimal(literal).map(|exact| format!("{literal} = {exact}\n"));
    literals.into_iter().filter_map(exact).collect()
}

fn check<M>(page: &str, code: &str, mechanism: &M)
where
    M: Ode<Scalar = f64> + Mechanism + Equations + Ports,
{
    let page = crate::support::page(page);
    // The start has literals that no formula has.
    let formulas = code.split("fn derivative").nth(1).expect("formulas after the start");
    let module = Module::read(&page.model, code, &literals(formulas)).expect("the emitted subset");
    let mut random = ChaCha8Rng::seed_from_u64(9);
    for _ in 0..STATES {
        let mut y = mechanism.start();
        y.as_mut().iter_mut().for_each(|x| *x = random.random_range(-1.0..1.0));
        let t = random.random_range(-1.0..1.0);
        compare(&module, &page.model, mechanism, t, &y);
    }
}

fn compare<M>(module: &Module, model: &gyro_model::Model, mechanism: &M, t: f64, y: &M::State)
where
    M: Ode<Scalar = f64> + Mechanism + Equations + Ports,
{
    let values =
        |fields: &[gyro_model::Parameter]| fields.iter().map(|f| gyro_model::to_f64(&f.value)).collect();
    let (parameters, inputs) = (values(&model.parameters), values(&model.inputs));
    let point = Point { context: (), t, state: y.as_ref().to_vec(), parameters, inputs };
    let numbers: Vec<f64> = constants((), module);
    let mut accelerations = mechanism.accelerations_buffer();
    mechanism.accelerations(t, y, &mut accelerations);
    let same = |function: &str, compiled: &[f64]| {
        let given = Given { point: &point, accelerations: accelerations.as_ref(), charts: &[], joints: &[] };
        let program = &module.programs[function];
        let interpreted = run(module, program, &numbers, &Elementary, &given).expect("numbers");
        let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&interpreted), bits(compiled), "{function}: {interpreted:?} {compiled:?}");
    };
    same("accelerations", accelerations.as_ref());
    let mut dy = y.clone();
    mechanism.derivative(t, y, &mut dy);
    same("derivative", dy.as_ref());
    let mut phi = mechanism.constraints();
    mechanism.phi(t, y, &mut phi);
    same("phi", phi.as_ref());
    let mut phi_q = mechanism.phi_q_values();
    mechanism.phi_q(t, y, &mut phi_q);
    same("phi_q", phi_q.as_ref());
    let mut gamma = mechanism.rows();
    mechanism.gamma(t, y, &mut gamma);
    same("gamma", gamma.as_ref());
    let mut lambda = mechanism.rows();
    mechanism.multipliers(t, y, &accelerations, &mut lambda);
    same("multipliers", lambda.as_ref());
    let energy = mechanism.energy(t, y);
    same("energy", &[energy.kinetic, energy.potential]);
    let mut readings = mechanism.readings();
    mechanism.read_joints(t, y, &mut readings);
    same("read_joints", readings.as_ref());
    let mut outputs = mechanism.outputs_buffer();
    mechanism.outputs(t, y, &mut outputs);
    same("outputs", outputs.as_ref());
}
