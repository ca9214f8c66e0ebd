//! `cargo xtask export wasm` without a compiler: it says what is missing and how to get it, and writes nothing.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::Path;
use std::process::Command;
use std::{env, fs};

fn refusal(clang: &str) -> String {
    let out = env::temp_dir().join(format!("gyro-export-wasm-{}", std::process::id()));
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pendulum.toml");
    let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
    let output =
        command.args(["export", "wasm"]).arg(model).arg("--out").arg(&out).env("CLANG", clang).output();
    let output = output.unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(fs::metadata(&out).is_err(), "something was written");
    String::from_utf8(output.stderr).unwrap()
}

#[test]
fn without_a_compiler_it_says_which_and_how_to_get_it() {
    let words = refusal("no-such-clang");
    for word in ["`no-such-clang` cannot be started", "apt install clang lld", "setup.sh", "CLANG"] {
        assert!(words.contains(word), "{word}: {words}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_compiler_that_makes_no_webassembly_is_named() {
    // gcc, under another name.
    let words = refusal("cc");
    assert!(
        words.contains("`cc` does not make WebAssembly") && words.contains("apt install clang lld"),
        "{words}"
    );
}
