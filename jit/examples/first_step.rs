//! How long it takes from a model file to the first step: `first_step [quick|full] FILE...`, in release mode.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

use gyro_codegen::{Effort, Functions, Group};
use gyro_jit::compile_scheduled;
use gyro_sim::{Joint, JointSpace, Solver, Tsit5};
use std::error::Error;
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let effort =
        if arguments.iter().any(|argument| argument == "quick") { Effort::Quick } else { Effort::Full };
    for file in arguments.iter().filter(|argument| argument.ends_with(".toml")) {
        let start = Instant::now();
        let folder = Path::new(file).parent().unwrap_or(Path::new("."));
        let mut load = |name: &str| std::fs::read_to_string(folder.join(name)).map_err(|e| e.to_string());
        let model = gyro_model::read_with(file, &std::fs::read_to_string(file)?, &mut load)
            .map_err(|e| e.to_string())?;
        let read = start.elapsed();
        let functions = Functions::of([Group::Joint, Group::Partition]);
        let scheduled = gyro_codegen::schedule(&model, &functions, effort)?;
        let derived = start.elapsed();
        let n: usize = scheduled.kernels.values().map(|kernel| kernel.tape.outside.operations.len()).sum();
        let mechanism = compile_scheduled::<f64>(&model, scheduled, None)?;
        let compiled = start.elapsed();
        let x = mechanism.joint_start();
        let mut solver = Solver::new(Joint, Tsit5::new(&x), 0.0, &x);
        solver.step(&mechanism, 1e-4)?;
        let stepped = start.elapsed();
        let ms = |from: std::time::Duration, to: std::time::Duration| 1e3 * (to - from).as_secs_f64();
        println!(
            "{file}: read {:.1} ms, derived {:.1} ms, compiled {:.1} ms ({n} operations), first step after {:.1} ms",
            ms(std::time::Duration::ZERO, read),
            ms(read, derived),
            ms(derived, compiled),
            ms(std::time::Duration::ZERO, stepped)
        );
    }
    Ok(())
}
