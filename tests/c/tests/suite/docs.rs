//! The programs of docs/export.md do what the page says.

use crate::program::program;
use crate::target::{es_module, tool};
use gyro_export::Precision;
use std::fs;
use std::process::Command;

const PAGE: &str = include_str!("../../../../docs/export.md");

/// The first block of a page in a language.
pub(crate) fn block<'a>(page: &'a str, language: &str) -> &'a str {
    let start = format!("```{language}\n");
    let (_, rest) = page.split_once(&start).expect("it has such a block");
    rest.split_once("```").expect("it ends").0
}

#[test]
fn the_program_of_the_page_prints_what_the_page_shows() {
    let page = "examples/pendulum.toml";
    let Some(program) = program(page, Precision::F64, ("main", block(PAGE, "c")), &[]) else { return };
    let output = Command::new(program).output().expect("the program starts");
    assert_eq!(String::from_utf8_lossy(&output.stdout), block(PAGE, "text"));
}

#[test]
#[ignore = "needs the tools of embedded/setup.sh"]
fn the_script_of_the_page_prints_the_same_angles() {
    let script = es_module("examples/pendulum.toml", Precision::F64, "page").with_file_name("page.mjs");
    fs::write(&script, block(PAGE, "js")).expect("a file");
    let output = Command::new(tool("node")).arg(script).output().expect("node starts");
    let angles = |text: &str| -> Vec<String> {
        let shown = |line: &str| line.split(" rad").next().unwrap_or_default().replace('+', "");
        text.lines().map(shown).collect()
    };
    assert_eq!(angles(&String::from_utf8_lossy(&output.stdout)), angles(block(PAGE, "text")));
}
