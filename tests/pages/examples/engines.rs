//! Compares many random model files in every engine: `engines [FILE...] [FIRST_SEED COUNT]`; with `--compile` generated
//! modules are compiled and run by the solvers, thirty model files to a program.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

#[path = "../tests/support/engines.rs"]
mod support;

#[path = "../tests/support/compiled.rs"]
mod compiled;

use std::panic::catch_unwind;
use support::compare;

fn main() {
    for file in std::env::args().skip(1).filter(|argument| argument.ends_with(".toml")) {
        let comparison = compare(&std::fs::read_to_string(&file).expect("a model file"));
        println!("{file}: {:?}", comparison.map(|comparison| comparison.found));
    }
    let numbers: Vec<u64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let (seed, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(0));
    if std::env::args().any(|argument| argument == "--compile") {
        return compile(seed, count);
    }
    let (mut n_compared, mut n_wrong, mut worst, mut n_forms) = (0, 0, 0.0_f64, 0);
    for seed in seed..seed + count {
        match catch_unwind(|| compare(&gyro_pages::page(seed))) {
            Ok(Some(comparison)) => {
                n_compared += 1;
                n_forms += comparison.n_forms;
                n_wrong += usize::from(!comparison.wrong().is_empty());
                worst = comparison.found.iter().fold(worst, |worst, (_, ratio)| worst.max(*ratio));
                comparison.wrong().iter().for_each(|(what, ratio)| println!("{seed}, {what}: {ratio:.1e}"));
            }
            Ok(None) => println!("{seed}: refused"),
            Err(_) => println!("{seed}: a panic"),
        }
    }
    println!(
        "{n_compared} model files in {n_forms} forms, {n_wrong} disagree, at worst {worst:.1e} of what is allowed"
    );
}

/// Model files to a program: compiling takes longer than running.
const BATCH: u64 = 30;

fn compile(first: u64, count: u64) {
    let (mut n_runs, mut n_wrong, mut worst) = (0, 0, 0.0_f64);
    for from in (first..first + count).step_by(usize::try_from(BATCH).expect("a small number")) {
        for (what, ratio) in compiled::compare(from..(from + BATCH).min(first + count)) {
            n_runs += 1;
            worst = worst.max(ratio);
            if ratio.is_nan() || ratio > 1.0 {
                n_wrong += 1;
                println!("{what}: {ratio:.1e}");
            }
        }
    }
    println!(
        "{count} model files, {n_runs} runs compared, {n_wrong} disagree, at worst {worst:.1e} of what is allowed"
    );
}
