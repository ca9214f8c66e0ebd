//! Calls that nobody should make: in C under sanitizers, of the ES module under Node. None of them crashes, reads
//! what it should not, is undefined, or changes what it should not.

use crate::program::program;
use crate::target::{es_module, tool};
use gyro_export::Precision;
use std::fs;
use std::process::Command;

const SANITIZERS: [&str; 2] = ["-fsanitize=address,undefined", "-fno-sanitize-recover=all"];

fn in_c(page: &str, precision: Precision) {
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

fn in_webassembly(page: &str, precision: Precision) {
    let module = es_module(page, precision, "hostile");
    let script = module.with_file_name("hostile.mjs");
    fs::write(&script, include_str!("hostile.mjs")).expect("a file");
    let output = Command::new(tool("node")).args([&script, &module]).output().expect("node starts");
    let (said, words) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{page}: {said}{words}");
    let count = said.split(' ').next().and_then(|count| count.parse::<u32>().ok());
    assert!(count.is_some_and(|count| count > 200), "{page}: {said}");
}

macro_rules! mechanism {
    ($name:ident, $page:expr, $precision:ident) => {
        mod $name {
            use super::*;

            #[test]
            fn in_c() {
                super::in_c($page, Precision::$precision);
            }

            #[test]
            #[ignore = "needs the tools of embedded/setup.sh"]
            fn in_webassembly() {
                super::in_webassembly($page, Precision::$precision);
            }
        }
    };
}

mechanism!(a_tree, "models/gyroscope.toml", F64);
mechanism!(driven, "models/driven-gyroscope.toml", F64);
mechanism!(a_loop, "models/four-bar.toml", F64);
mechanism!(a_loop_in_f32, "models/four-bar.toml", F32);
mechanism!(stiff, "models/gyroscope-stiff.toml", F64);
mechanism!(motor_and_spring, concat!(env!("OUT_DIR"), "/cart.toml"), F64);
mechanism!(motor_and_spring_in_f32, concat!(env!("OUT_DIR"), "/cart.toml"), F32);
mechanism!(motors, concat!(env!("OUT_DIR"), "/robot_arm.toml"), F64);
