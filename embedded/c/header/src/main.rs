//! Prints the C header of the gimbal, from the source beside this package.

use std::io::Write;
use std::process::ExitCode;

const ABOUT: &str =
    "/* A generated gimbal: base, outer ring, inner ring and rotor, with a motor on the outer axis. SI units.
 * Written by `cargo xtask embedded` from embedded/c/src/lib.rs. Do not edit. */";

fn main() -> ExitCode {
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../src/lib.rs");
    let mut config = cbindgen::Config {
        language: cbindgen::Language::C,
        header: Some(ABOUT.to_owned()),
        include_guard: Some("GIMBAL_H".to_owned()),
        cpp_compat: true,
        no_includes: true,
        sys_includes: vec!["stdint.h".to_owned()],
        ..cbindgen::Config::default()
    };
    config.enumeration.rename_variants = cbindgen::RenameRule::QualifiedScreamingSnakeCase;
    config.export.include = ["GimbalJoint", "GimbalParameter", "GimbalInput"].map(str::to_owned).to_vec();
    let builder = cbindgen::Builder::new().with_config(config).with_src(source);
    let mut text = Vec::new();
    match builder.generate() {
        Ok(bindings) => bindings.write(&mut text),
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    }
    match std::io::stdout().write_all(&text) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}
