//! What keeps the source text easy to find one's way in: no circles of modules, stages that know nothing of later ones,
//! folders that ARCHITECTURE.md names, short files, short lines of prose.

mod modules;
mod prose;

use modules::{Modules, circles, stages};
use prose::{files, long_in_comments, long_in_markdown};
use std::fs;
use std::path::{Path, PathBuf};

/// The crates whose modules are looked at.
const CRATES: [&str; 24] = [
    "model",
    "program",
    "codegen",
    "gyro-sim",
    "assembled",
    "jit",
    "verifier",
    "runner",
    "sweep",
    "cli",
    "export",
    "schema",
    "show",
    "python",
    "xtask",
    "mechanisms",
    "mechanisms/build",
    "tests/reference",
    "tests/mutants",
    "tests/overconstrained",
    "tests/pages",
    "tests/robots",
    "benches",
    "yardstick",
];

/// The longest hand-written file, in lines.
const LINES: usize = 500;

/// Files and folders of crates, in their order: each uses earlier ones alone.
const STAGES: [(&str, &str); 5] = [
    (
        "model",
        "scalar coordinate number attraction spatial lines spline curve sight motion frames state coupler elements directions joint_kind shape keys kinematics tree \
         controller event contact sites validate assemble diagnostics numbers redundancy parse queries",
    ),
    (
        "codegen",
        "groups expr simplify effort derive solve joint_space equations kernels selection repeat tape scheduled emit",
    ),
    (
        "gyro-sim",
        "wire fused spline scalar charts sine floats admissible apart euler_parameters contract integrate violation turns \
         pivoting dual correct solver events contact generated joint_partition lanes sampled",
    ),
    (
        "runner",
        "approach schedule offers advice batch input touch path line formula control kink watch failure pivots motion forecast \
         sample companion summary grade spectrum run timing protocol child linkage loops remark spinner",
    ),
    (
        "cli",
        "failure words side_by_side remarks args progress choice contacts formulas controllers events kinks write files paths inputs scene lapse left_out rolling runs \
         invocation places rounding chain stability verify interrupt programs machine_code runtime nested batches \
         cache columns eigenvalues equilibrium verdict folder proof in_process closed_loop linearization json plot \
         spectrum fit linear compare summary simulate answer generate export show check variants inspect urdf library machine \
         new report schema sweep",
    ),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn no_modules_use_each_other_in_a_circle() {
    let mut found = Vec::new();
    for name in CRATES {
        let modules = Modules::of(&root().join(name).join("src"));
        found.extend(circles(&modules.uses).iter().map(|circle| format!("{name}: {}", circle.join(", "))));
    }
    assert!(found.is_empty(), "circles of modules:\n{}", found.join("\n"));
}

#[test]
fn no_stage_knows_of_a_later_one() {
    let mut wrong = Vec::new();
    for (name, order) in STAGES {
        let place = |module: &str| order.split_whitespace().position(|stage| stage == module);
        for (module, used) in stages(&root().join(name).join("src")) {
            let own = place(&module);
            assert!(own.is_some(), "{name}: {module} has no place among the stages");
            let later = used.iter().filter(|used| place(used) > own);
            wrong.extend(later.map(|used| format!("{name}: {module} uses {used}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The path of a file from the root.
fn shown(path: &Path) -> String {
    path.strip_prefix(root()).expect("a path below the root").display().to_string()
}

#[test]
fn no_file_is_long() {
    let lines = |path: &PathBuf| fs::read_to_string(path).expect("a text").lines().count();
    let long = files(&root(), "rs").into_iter().filter(|path| lines(path) > LINES);
    let long: Vec<_> = long.map(|path| shown(&path)).collect();
    assert!(long.is_empty(), "more than {LINES} lines: split by meaning\n{}", long.join("\n"));
}

/// Workspace lints refuse `unsafe` wherever it is not allowed by name; what is shipped allows it where compiled code is
/// called. Firmware and its interface in C are a workspace of their own.
#[test]
fn what_is_shipped_is_unsafe_in_one_file() {
    let of_crates = CRATES.iter();
    let sources = of_crates.flat_map(|name| files(&root().join(name).join("src"), "rs"));
    let is_unsafe = |path: &PathBuf| {
        let text = fs::read_to_string(path).expect("a text");
        ["unsafe {", "unsafe fn", "unsafe impl", "unsafe_code,"].iter().any(|word| text.contains(word))
    };
    let found: Vec<_> = sources.filter(is_unsafe).map(|path| shown(&path)).collect();
    assert_eq!(found, ["jit/src/calls.rs"]);
}

#[test]
fn no_line_of_prose_is_long() {
    let mut found = Vec::new();
    let mut read = |extension: &str, long: fn(&str) -> Vec<usize>| {
        for path in files(&root(), extension) {
            let name = shown(&path);
            let text = fs::read_to_string(&path).expect("a text");
            found.extend(long(&text).into_iter().map(|line| format!("{name}:{line}")));
        }
    };
    read("md", long_in_markdown);
    read("rs", long_in_comments);
    assert!(found.is_empty(), "{} lines of prose are too long:\n{}", found.len(), found.join("\n"));
}

#[test]
fn architecture_names_every_folder() {
    let page = fs::read_to_string(root().join("ARCHITECTURE.md")).expect("a document");
    let entries = fs::read_dir(root()).expect("the root").map(|entry| entry.expect("an entry"));
    let folders = entries.filter(|entry| entry.path().is_dir());
    let names = folders.map(|folder| folder.file_name().to_string_lossy().into_owned());
    let is_source = |name: &String| !name.starts_with('.') && !["target", "out"].contains(&name.as_str());
    let missing: Vec<_> =
        names.filter(is_source).filter(|name| !page.contains(&format!("`{name}/"))).collect();
    assert!(missing.is_empty(), "ARCHITECTURE.md does not name {missing:?}");
}
