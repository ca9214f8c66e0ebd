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

/// Prints, at 101 times, the time, the joint state and the outputs.
const PROGRAM: &str = r#"
#include "name.h"
#include <stdio.h>
#include <stdlib.h>

int main(int count, char **words) {
    static name m;
    static name_solver s;
    name_real x[NAME_N_JOINTS], y[NAME_N_STATE], out[NAME_N_OUTPUTS + 1];
    double t_end = count > 1 ? atof(words[1]) : 1.0;
    name_control control = name_default_control(1e-12);
    name_init(&m);
    name_joint_start(&m, x);
    name_solver_init(&s, NAME_DOP853, 0.0, x);
    control.budget = 100000000;
    name_solver_set_control(&s, &control);
    for (int k = 0; k <= 100; k++) {
        double t = t_end * k / 100.0;
        if (name_solver_advance_to(&s, &m, t) != NAME_OK) return 1;
        name_to_maximal(&m, t, s.y, y);
        name_outputs(&m, t, y, out);
        printf("%.17g", t);
        for (int i = 0; i < NAME_N_JOINTS; i++) printf(",%.17g", s.y[i]);
        for (int i = 0; i < NAME_N_OUTPUTS; i++) printf(",%.17g", out[i]);
        printf("\n");
    }
    return 0;
}
"#;

fn done(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn rows(table: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|number| number.parse().unwrap()).collect();
    table.lines().map(row).collect()
}

/// Of an example, the worst difference of a column, over its largest magnitude if that is more than 1, and
/// how many columns there are: coordinates and rates by their names in the header, then all outputs.
fn difference_in_c(model: &Path, name: &str, folder: &Path) -> (f64, usize) {
    let gyro = || Command::new(env!("CARGO_BIN_EXE_gyro"));
    // With the work, as `simulate` has it: steps are as long as it allows, too.
    done(gyro().args(["export", "c", "-q", "--count-work", "--out"]).arg(folder).arg(model));
    let text = PROGRAM.replace("NAME", &name.to_uppercase()).replace("name", name);
    fs::write(folder.join("main.c"), text).unwrap();
    let sources = [format!("{name}.c"), "main.c".to_owned()];
    let mut compiler = Command::new(env::var_os("CC").unwrap_or_else(|| "cc".into()));
    done(
        compiler
            .args(["-std=c99", "-O1", "-ffp-contract=off", "-o", "main"])
            .args(sources)
            .arg("-lm")
            .current_dir(folder),
    );
    let page = fs::read_to_string(model).unwrap();
    let t_end = page.lines().find_map(|line| line.strip_prefix("t_end = ")).unwrap();
    let found = rows(&done(Command::new(folder.join("main")).arg(t_end)));
    let every = (t_end.parse::<f64>().unwrap() / 100.0).to_string();
    let options = ["-q", "--integrator", "dop853", "--tolerance", "1e-12", "--every", &every, "--out"];
    done(gyro().arg("simulate").arg(model).args(options).arg(folder.join("run")));
    let table = fs::read_to_string(folder.join(format!("run/{name}.csv"))).unwrap();
    let (titles, table) = table.split_once('\n').unwrap();
    let titles: Vec<&str> = titles.split(',').map(|title| title.split(" [").next().unwrap()).collect();
    let expected = rows(table);
    let header = fs::read_to_string(folder.join(format!("{name}.h"))).unwrap();
    let prefix = format!("{}_", name.to_uppercase());
    let numbers = header.lines().filter_map(|line| {
        let (key, number) = line.trim().strip_prefix(&prefix)?.split_once(" = ")?;
        Some((key, number.split(',').next()?.parse::<usize>().ok()?))
    });
    let numbers: Vec<(&str, usize)> = numbers.collect();
    let n = numbers.iter().find(|(key, _)| *key == "N_JOINTS").unwrap().1;
    // What begins with a name, in the header, in the table, and after how many columns of the program it counts.
    const KINDS: [(&str, &str, usize); 5] = [
        ("JOINT_RATE_", " rate", 1),
        ("JOINT_", "", 1),
        ("BODY_RATE_", " velocity x", 6),
        ("BODY_", " x", 7),
        ("OUTPUT_", "", 0),
    ];
    let mut columns: Vec<[usize; 2]> = Vec::new();
    for (key, place) in &numbers {
        let kind =
            KINDS.iter().find_map(|&(kind, ending, count)| Some((key.strip_prefix(kind)?, ending, count)));
        let Some((owner, ending, count)) = kind else { continue };
        let owner = owner.to_lowercase();
        // A joint of several coordinates has them before its name.
        let part = owner.split_once('_').map(|(part, joint)| format!("{joint}.{part}{ending}"));
        let part = part.filter(|part| titles.iter().any(|title| title.to_lowercase() == *part));
        let owner = part.unwrap_or(owner + ending);
        let is_its = |title: &str| title.to_lowercase() == owner;
        let is_part =
            |title: &str| title.to_lowercase().strip_prefix(&owner).is_some_and(|rest| rest.starts_with('.'));
        let first = titles.iter().position(|title| is_its(title) || is_part(title));
        let first = first.unwrap_or_else(|| panic!("{name}: the table has no {owner}"));
        let (from, count) = match count {
            0 => (
                1 + n + place,
                titles[first..].iter().take_while(|title| is_its(title) || is_part(title)).count(),
            ),
            count => (1 + place, count),
        };
        columns.extend((0..count).map(|k| [from + k, first + k]));
    }
    assert_eq!((found.len(), expected.len()), (101, 101), "{name}");
    let worst = columns.iter().map(|[from, to]| {
        let scale = expected.iter().map(|row| row[*to].abs()).fold(1.0, f64::max);
        let differences = found.iter().zip(&expected).map(|(a, b)| (a[*from] - b[*to]).abs() / scale);
        differences.fold(0.0, f64::max)
    });
    (worst.fold(0.0, f64::max), columns.len())
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn laws_and_constraints_in_c_move_as_they_do_here() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples");
    let folders = ["contact", "laws", "rolling"].map(|folder| fs::read_dir(examples.join(folder)).unwrap());
    let mut models: Vec<_> = folders.into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    models.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    // So stiff that explicit steps take minutes.
    models.retain(|path| path.file_stem().is_none_or(|name| name != "crates"));
    models.sort();
    assert!(models.len() >= 19, "{models:?}");
    for model in &models {
        let name = model.file_stem().unwrap().to_str().unwrap();
        let folder = env::temp_dir().join(format!("gyro-laws-in-c-{}-{name}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let (worst, count) = difference_in_c(model, name, &folder);
        println!("{name}: {worst:.1e} in {count} columns");
        // Its steps do not end where bodies begin to touch: what error control leaves there counts.
        let is_contact = model.parent().is_some_and(|folder| folder.ends_with("contact"));
        let allowed = if is_contact { 1e-6 } else { 1e-9 };
        assert!(worst < allowed && count > 0, "{name}: {worst} in {count} columns");
        fs::remove_dir_all(&folder).unwrap();
    }
}

/// A wheel with friction: only where it is asked for, a third number of the state is the work.
#[test]
fn work_is_carried_only_if_asked_for() {
    let folder = env::temp_dir().join(format!("gyro-work-in-c-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let model = folder.join("wheel.toml");
    let page = "format = 1\nname = \"wheel\"\n\
        body = [{ name = \"ground\", fixed = true }, { name = \"wheel\", mass = 1, inertia = [1, 1, 1] }]\n\
        [[joint]]\nname = \"shaft\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\ndamping = 0.1\n\
        first = { body = \"ground\" }\nsecond = { body = \"wheel\" }\n";
    fs::write(&model, page).unwrap();
    let gyro = |words: &[&str], more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
        done(command.current_dir(&folder).args(words).arg("wheel.toml").args(more))
    };
    for (more, joints, module) in
        [(&[][..], 2, "has_work: false"), (&["--count-work"][..], 3, "has_work: true")]
    {
        gyro(&["export", "c", "--out", "."], more);
        let header = fs::read_to_string(folder.join("wheel.h")).unwrap();
        assert!(header.contains(&format!("WHEEL_N_JOINTS = {joints},")), "{more:?}");
        gyro(&["generate", "--functions", "joint"], more);
        assert!(fs::read_to_string(folder.join("wheel.rs")).unwrap().contains(module), "{more:?}");
        gyro(&["verify", "--quick"], &[]);
    }
    fs::remove_dir_all(&folder).unwrap();
}
