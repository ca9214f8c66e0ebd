//! Energy less the work of what is not conservative stays constant: for every force alone, for drivers and driven
//! bodies.

use crate::support::{Random, assert_close, dense, models, state_near, test_model};
use gyro_assembled::Dense;
use gyro_model::Model;
use gyro_sim::{Direct, Dynamics, Exact, Mechanism};

/// Step and length of the runs. The fourth power of the step times the rates of the test models, 30 rad/s, is 1e-10.
const STEP: f64 = 1e-4;
const STEPS: u32 = 200;

/// What the error of the integrator may take: of the energy that has come and gone, and, where tops spin at 150 rad/s,
/// of all.
const BALANCE: f64 = 1e-9;
const SPIN: f64 = 1e-11;

/// Checks the energy balance of a run of direct integration, in steps no longer than the model file's own.
fn check(what: &str, model: &Model, mechanism: &Dense<f64>) {
    let step = STEP.min(model.simulation.step);
    let mut y = mechanism.start();
    let start = mechanism.energy(0.0, &y);
    let mut solver = Direct::new(Exact, &y);
    solver.advance(mechanism, 0.0, step, STEPS, &mut y).expect("it runs");
    let end = mechanism.energy(step * f64::from(STEPS), &y);
    let work = mechanism.work(&y);
    let moved = (end.kinetic - start.kinetic).abs() + (end.potential - start.potential).abs() + work.abs();
    let missing = (end.total() - start.total() - work).abs();
    let whole = start.kinetic.abs() + start.potential.abs();
    assert!(missing <= BALANCE * moved + SPIN * whole, "{what}: {missing:e} of {moved:e} and {whole:e}");
}

/// The model with a part of its forces.
fn with_forces(model: &Model, keep: impl Fn(&str) -> bool) -> Dense<f64> {
    let mut model = model.clone();
    model.forces.retain(|force| keep(&force.name));
    dense(&model)
}

#[test]
fn the_balance_closes_for_every_model() {
    for model in models() {
        check(&model.name, &model, &dense(&model));
    }
}

#[test]
fn the_balance_closes_for_every_force_alone() {
    for model in ["kinds", "carried"].map(test_model) {
        let idle = with_forces(&model, |_| false);
        let mut rates = idle.start();
        idle.derivative(0.0, &idle.start(), &mut rates);
        for force in &model.forces {
            let what = format!("{} {}", model.name, force.name);
            let mechanism = with_forces(&model, |name| name == force.name);
            check(&what, &model, &mechanism);
            let mut with = mechanism.start();
            mechanism.derivative(0.0, &mechanism.start(), &mut with);
            let n = mechanism.description().bodies.len();
            assert_ne!(with[7 * n..13 * n], rates[7 * n..13 * n], "{what} does nothing");
        }
    }
}

#[test]
fn a_driver_and_driven_bodies_feed_in_what_the_powers_say() {
    let kinds = test_model("kinds");
    let mechanism = dense(&kinds);
    let outputs = outputs(&mechanism, 0.3, &mechanism.start());
    let value = |name: &str, suffix: &str| {
        outputs.iter().find(|(at, _)| at == &(name, suffix)).expect("it is there").1
    };
    // The driver's course is 0.2 + (0.1 + 0.05 t) sin 3t.
    let (t, rate) = (0.3f64, |t: f64| 0.05 * (3.0 * t).sin() + (0.1 + 0.05 * t) * 3.0 * (3.0 * t).cos());
    let expected = value("effort", "") * rate(t);
    assert_close("the driver's power", &[value("power", "drivers")], &[expected], 1e-3, 1e-12);
    assert!(expected.abs() > 1e-3, "the driver has something to do");
    let carried = dense(&test_model("carried"));
    let mut rates = carried.start();
    carried.derivative(0.3, &carried.start(), &mut rates);
    let powers = self::outputs(&carried, 0.3, &carried.start());
    let power: f64 = powers.iter().filter(|((name, _), _)| *name == "power").map(|(_, power)| power).sum();
    let work = 13 * carried.description().bodies.len();
    assert_close("the rate of work", &[power], &rates[work..=work], 1e-3, 1e-13);
}

/// Name and suffix of each output with its value.
fn outputs<'a>(mechanism: &'a Dense<f64>, t: f64, y: &Vec<f64>) -> Vec<((&'a str, &'a str), f64)> {
    let mut values = mechanism.buffers().outputs;
    mechanism.outputs(t, y, &mut values);
    let infos =
        (0..mechanism.description().outputs.len()).map(|index| mechanism.description().outputs[index]);
    infos.map(|info| (info.name, info.suffix)).zip(values).collect()
}

#[test]
fn an_input_is_what_the_caller_sets() {
    let model = test_model("kinds");
    let mut mechanism = dense(&model);
    let y = state_near(&mechanism, 0.1, &mut Random(3));
    let rates = |mechanism: &mut Dense<f64>, torque: f64| {
        let index = (0..mechanism.description().inputs.len())
            .find(|&index| mechanism.description().inputs[index] == "torque");
        assert!(mechanism.set_input(index.expect("it is there"), torque));
        let mut rates = y.clone();
        mechanism.derivative(0.0, &y, &mut rates);
        rates
    };
    let [before, none, one, two] = [0.02, 0.0, 1.0, 2.0].map(|torque| rates(&mut mechanism, torque));
    let mut untouched = y.clone();
    dense(&model).derivative(0.0, &y, &mut untouched);
    assert_eq!(before, untouched, "the model file's value holds until another is set");
    assert_ne!(none, one);
    let [first, second] = [(&none, &one), (&one, &two)]
        .map(|(from, to)| to.iter().zip(from).map(|(to, from)| to - from).collect::<Vec<f64>>());
    assert_close("the motor is linear", &first, &second, 1.0, 1e-11);
    assert!(!mechanism.set_input(mechanism.description().inputs.len(), 0.0));
}
