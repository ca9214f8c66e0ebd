//! Compares many random pages in every engine: `engines [FILE...] [FIRST_SEED COUNT]`.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

#[path = "../tests/support/engines.rs"]
mod support;

use std::panic::catch_unwind;
use support::compare;

fn main() {
    for file in std::env::args().skip(1).filter(|argument| argument.ends_with(".toml")) {
        let comparison = compare(&std::fs::read_to_string(&file).expect("a page"));
        println!("{file}: {:?}", comparison.map(|comparison| comparison.found));
    }
    let numbers: Vec<u64> = std::env::args().filter_map(|argument| argument.parse().ok()).collect();
    let (seed, count) = (numbers.first().copied().unwrap_or(0), numbers.get(1).copied().unwrap_or(0));
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
        "{n_compared} pages in {n_forms} forms, {n_wrong} disagree, at worst {worst:.1e} of what is allowed"
    );
}
