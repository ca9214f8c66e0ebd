//! Calls that nobody should make, under sanitizers: none of them crashes, reads what it should not or is undefined.

use crate::program::program;
use gyro_export::Precision;
use std::process::Command;

const SANITIZERS: [&str; 2] = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"];

fn check(page: &str, precision: Precision) {
    let Some(program) = program(page, precision, ("hostile", include_str!("hostile.c")), &SANITIZERS) else {
        return;
    };
    let output = Command::new(program).output().expect("the program starts");
    let (said, words) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{page}: {said}{words}");
    // Most of them are refused, and for more than one reason.
    let counts = said.lines().filter_map(|line| line.split(' ').next()?.parse::<u32>().ok());
    assert!(counts.filter(|count| *count > 0).count() > 5, "{page}: {said}");
}

#[test]
fn of_a_tree() {
    check("models/gyroscope.toml", Precision::F64);
}

#[test]
fn of_a_loop_in_single_precision() {
    check("models/four-bar.toml", Precision::F32);
}
