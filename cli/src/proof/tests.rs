use super::*;
use crate::{Cli, Command};
use clap::Parser;

fn pendulum() -> (Scene, Functions) {
    let cli = Cli::try_parse_from(["gyro", "simulate", "../examples/pendulum.toml"]).expect("a command");
    let Command::Simulate(args) = cli.command else { panic!("simulate") };
    (Scene::new(&args).expect("a scene"), Functions::of_solvers())
}

/// What Cranelift is given.
fn given((scene, functions): &(Scene, Functions)) -> Compiled {
    let scheduled = gyro_codegen::schedule(&scene.page, functions, scene.effort).expect("kernels");
    let mut given = Compiled::default();
    let mut told = |input: Input<'_>| given.hear(input);
    gyro_jit::compile_scheduled::<f64>(&scene.page, scheduled, Some(&mut told)).expect("machine code");
    given
}

#[test]
fn what_runs_is_proved_and_what_is_not_what_was_proved_is_refused() {
    let of = pendulum();
    let settled = |compiled| {
        let proof = Proof::begin(&of.0, &of.1);
        proof.compare_with(compiled);
        proof.settle()
    };
    let (standing, module) = settled(given(&of)).unwrap();
    assert_eq!(standing, Standing::Proved);
    assert!(module.unwrap().code.contains("//! # Proof"));
    let mut other = given(&of);
    let (_, text) = other.kernels.iter_mut().find(|(_, text)| text.contains("fmul")).unwrap();
    *text = text.replacen("fmul", "fadd", 1);
    let refused = settled(other).unwrap_err();
    assert!(refused.words().contains("is not what was proved"), "{}", refused.words());
}

#[test]
fn a_proof_that_takes_too_long_is_not_waited_for() {
    let of = pendulum();
    // It waits for what is compiled, which does not come.
    let (standing, module) = Proof::begin(&of.0, &of.1).settle().unwrap();
    assert!(matches!(standing, Standing::NotRefuted(seconds) if seconds >= 3.0), "{standing:?}");
    let code = module.unwrap().code;
    assert!(code.contains("pub struct Pendulum") && !code.contains("//! # Proof"));
}
