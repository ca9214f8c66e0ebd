//! The program of docs/export.md does what the page says.

use crate::program::program;
use gyro_export::Precision;
use std::process::Command;

const PAGE: &str = include_str!("../../../../docs/export.md");

/// The first block of the page in a language.
fn block(language: &str) -> &str {
    let start = format!("```{language}\n");
    let (_, rest) = PAGE.split_once(&start).expect("it has such a block");
    rest.split_once("```").expect("it ends").0
}

#[test]
fn the_program_of_the_page_prints_what_the_page_shows() {
    let page = "examples/pendulum.toml";
    let Some(program) = program(page, Precision::F64, ("main", block("c")), &[]) else { return };
    let output = Command::new(program).output().expect("the program starts");
    assert_eq!(String::from_utf8_lossy(&output.stdout), block("text"));
}
