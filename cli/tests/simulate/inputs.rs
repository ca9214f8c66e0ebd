//! Inputs, tables and columns.

use crate::support::{Folder, close, json, model, refused, simulate};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The name is that of something which programs around a mechanism use. A disc on a shaft that a motor turns, J = 0.5
/// kg·m², with a sledge that slides on a table beside it.
pub(super) const MOTOR: &str = r#"format = 1
name = "tree_with_jacobian"
[simulation]
t_end = 2
step = 1e-3
[inputs]
torque = 3
push = 0
[[body]]
name = "frame"
fixed = true
[[body]]
name = "disc"
mass = 1
inertia = [0.3, 0.3, 0.5]
[[body]]
name = "sledge"
mass = 2
inertia = [0.1, 0.1, 0.1]
[[joint]]
name = "shaft"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "frame" }
second = { body = "disc" }
[[joint]]
name = "table"
kind = "planar"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "frame" }
second = { body = "sledge" }
rate = [0.5, 0, 7]
[[force]]
name = "motor"
kind = "motor"
joint = "shaft"
value = "torque"
[[force]]
name = "pusher"
kind = "motor"
joint = "table"
coordinate = "y"
value = "push"
[[output]]
name = "spin"
kind = "velocity"
body = "disc"
[[output]]
name = "energies"
kind = "energy"
"#;

#[test]
fn inputs_come_from_the_page_from_numbers_and_from_tables() {
    let folder = Folder::new("inputs");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    fs::write(folder.0.join("ramp.csv"), "t,torque\n0,0\n1,2\n").unwrap();
    let run = |args: &[&str]| {
        let fixed = ["motor.toml", "--engine", "assembled", "--step", "1e-3", "--every", "0.5"];
        json(&folder, &[&fixed[..], args].concat())
    };
    let constant = run(&["--input", "push=0.5"]);
    close(&constant["joints"]["shaft"]["rate"], 3.0 / 0.5 * 2.0);
    close(&constant["joints"]["shaft"]["position"], 3.0 / 0.5 * 2.0);
    // Coordinates x, y, angle, of which the last has turned more than twice.
    for (k, (position, rate)) in [(1.0, 0.5), (0.5, 0.5), (14.0, 7.0)].into_iter().enumerate() {
        close(&constant["joints"]["table"]["position"][k], position);
        close(&constant["joints"]["table"]["rate"][k], rate);
    }
    close(&constant["outputs"]["spin"][5], 12.0);
    close(&constant["outputs"]["energies"][0], 0.25 * 144.0 + 0.25 + 0.25 + 0.05 * 49.0);
    assert_eq!(constant["degrees_of_freedom"], 4);
    let fixed = [
        "motor.toml",
        "--engine",
        "generated",
        "--coordinates",
        "maximal",
        "--step",
        "1e-3",
        "--every",
        "0.5",
    ];
    let generated = json(&folder, &[&fixed[..], &["--input", "torque=ramp.csv"]].concat());
    // The ramp is held over each of its thousand steps, then stays: Σ 2 k/1000 · 1e-3 = 0.999, and 2 N·m for a second.
    let ramp = run(&["--input", "torque=ramp.csv"]);
    for run in [&ramp, &generated] {
        close(&run["joints"]["shaft"]["rate"], (0.999 + 2.0) / 0.5);
    }
    assert_eq!(generated["engine"], "generated");
}

#[test]
fn columns_have_the_names_of_coordinates_and_outputs() {
    let folder = Folder::new("columns");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    let output =
        simulate(&folder, &["motor.toml", "--engine", "assembled", "--out", ".", "--input", "push=0.5"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for words in [
        "dense form",
        "4 degrees of freedom",
        "input torque = 3.0",
        "input push = 0.5",
        "table.angle",
        "spin.wz",
    ] {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
    assert!(!text.contains("linear theory"), "{text}");
    let table = fs::read_to_string(folder.0.join("tree_with_jacobian.csv")).unwrap();
    let header = table.lines().next().unwrap();
    let expected = "t [s],torque [N*m],push [N],shaft [rad],shaft rate [rad/s],table.x [m],table.x rate [m/s],table.y [m],table.y rate [m/s],\
                    table.angle [rad],table.angle rate [rad/s],spin.vx [m/s],spin.vy [m/s],spin.vz [m/s],spin.wx [rad/s],\
                    spin.wy [rad/s],spin.wz [rad/s],energies.kinetic [J],energies.potential [J],kinetic energy [J],";
    assert!(header.starts_with(expected), "{header}");
    let motion = fs::read_to_string(folder.0.join("tree_with_jacobian-motion.svg")).unwrap();
    assert!(motion.contains("table.x [m]") && motion.contains("table.angle [rad]"));
    assert!(folder.files().contains(&"tree_with_jacobian-outputs.svg".to_owned()));
}

#[test]
fn bad_inputs_are_told_with_their_line() {
    let folder = Folder::new("bad-inputs");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    fs::write(folder.0.join("back.csv"), "t,torque\n0,0\n1,2\n1,3\n").unwrap();
    fs::write(folder.0.join("word.csv"), "t,torque\n0,zero\n").unwrap();
    let gyroscope = model("gyroscope.toml");
    for (page, inputs, message) in [
        ("motor.toml", &["torqe=1"][..], "unknown input `torqe`: write `torque`; there are `torque`, `push`"),
        ("motor.toml", &["torque=none.csv"], "--input torque=none.csv: the file cannot be read"),
        ("motor.toml", &["torque=back.csv"], "torque=back.csv: line 4: the time 1.0 is not after 1.0"),
        ("motor.toml", &["torque=word.csv"], "torque=word.csv: line 2: found `zero`"),
        ("motor.toml", &["torque=1", "torque=2"], "--input gives `torque` twice"),
        (&gyroscope, &["torque=1"], "has no inputs"),
    ] {
        let given: Vec<&str> = inputs.iter().flat_map(|input| ["--input", *input]).collect();
        let output = simulate(&folder, &[&[page, "--json"], &given[..]].concat());
        let words = String::from_utf8(output.stderr).unwrap();
        assert!(words.contains(message), "{inputs:?}: {words}");
        assert!(output.status.code() == Some(2) && output.stdout.is_empty(), "{inputs:?}");
    }
}

/// A pendulum whose pivot is moved along x as a table beside the model file says.
const SHAKEN: &str = r#"format = 1
name = "shaken"
[simulation]
t_end = 1
[[body]]
name = "cart"
driven = { translation = [{ table = "motions/shake.csv" }, 0, 0] }
[[body]]
name = "plate"
mass = 0.1
inertia = [1e-4, 1e-4, 2e-4]
[[joint]]
name = "slide"
kind = "prismatic"
axis = [0, 1, 0]
zero = [1, 0, 0]
first = { body = "cart" }
second = { body = "plate" }
rate = 0.25
[[output]]
name = "pose"
kind = "pose"
body = "plate"
"#;

#[test]
fn tables_of_motions_lie_beside_the_page() {
    let folder = Folder::new("tables");
    let pages = folder.0.join("pages");
    fs::create_dir_all(pages.join("motions")).unwrap();
    fs::write(pages.join("shaken.toml"), SHAKEN).unwrap();
    let missing = simulate(&folder, &["pages/shaken.toml"]);
    let words = String::from_utf8(missing.stderr).unwrap();
    assert!(words.contains("motions/shake.csv") && words.contains("cannot be read"), "{words}");
    fs::write(pages.join("motions/shake.csv"), "t,x\n0,0\n1,0.02\n2,0.04").unwrap();
    let run = json(&folder, &["pages/shaken.toml", "--engine", "assembled"]);
    close(&run["outputs"]["pose"][0], 0.02);
    close(&run["outputs"]["pose"][1], 0.25);
}

/// A body on a table that follows `shaken.csv`, which is also the name of what a run writes.
pub(super) const TABLED: &str = "format = 1
name = \"shaken\"
[simulation]
t_end = 0.01
[[body]]
name = \"table\"
driven = { translation = [{ table = \"shaken.csv\" }, 0, 0] }
[[body]]
name = \"plate\"
mass = 0.1
inertia = [1e-4, 1e-4, 2e-4]
[[joint]]
name = \"slide\"
kind = \"prismatic\"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = \"table\" }
second = { body = \"plate\" }
";

pub(super) const TABLE: &str = "t,x\n0,0\n1,0.01\n2,0\n";

#[test]
#[cfg(unix)]
fn tables_and_inputs_are_files() {
    let folder = Folder::new("pipes");
    fs::write(folder.0.join("shaken.toml"), TABLED).unwrap();
    assert!(Command::new("mkfifo").arg(folder.0.join("shaken.csv")).status().unwrap().success());
    refused(&simulate(&folder, &["shaken.toml", "--engine", "assembled"]), "a pipe or a device");
    refused(&simulate(&folder, &["shaken.csv"]), "a pipe or a device");
    let page = model("../tests/models/motor.toml");
    let input = ["--input", "torque=/dev/zero", "--engine", "assembled"];
    refused(&simulate(&folder, &[&[page.as_str()], &input[..]].concat()), "a pipe or a device");
}

/// What was fed in is in the table beside what came of it, and the object says what its numbers are and where the table
/// is.
#[test]
fn the_table_has_the_inputs_and_the_object_names_components_and_files() {
    let folder = Folder::new("inputs-checked");
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models/motor.toml");
    let text = fs::read_to_string(page).unwrap();
    let more = "\n[[output]]\nname = \"felt\"\nkind = \"acceleration\"\nbody = \"disc\"\n\
                [[output]]\nname = \"torque\"\nkind = \"power\"\n";
    let page = folder.0.join("motor.toml");
    fs::write(&page, text.replacen("torque = 0\n", "torque = 0\nspare = 2\n", 1) + more).unwrap();
    fs::write(folder.0.join("ramp.csv"), "t,torque\n0,0\n1,0.5\n").unwrap();
    let page = page.to_str().unwrap();
    let run =
        [page, "--engine", "assembled", "--t-end", "0.1", "--every", "0.05", "--input", "torque=ramp.csv"];
    let run = json(&folder, &[&run[..], &["--out", "here"]].concat());
    assert_eq!(run["inputs"]["spare"], 2.0);
    assert!((run["inputs"]["torque"].as_f64().unwrap() - 0.05).abs() < 1e-12, "{run}");
    assert_eq!(run["components"]["inputs"]["torque"], "N*m");
    assert_eq!(run["components"]["outputs"]["felt"][3]["name"], "dwx");
    assert_eq!(run["components"]["outputs"]["felt"][3]["unit"], "rad/s2");
    assert_eq!(run["components"]["outputs"]["felt"].as_array().unwrap().len(), 6);
    assert_eq!(run["components"]["joints"]["bearing"][0]["unit"], "rad");
    let table = fs::read_to_string(folder.0.join(run["files"]["time_series"].as_str().unwrap())).unwrap();
    let mut lines = table.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    // An output has the input's name.
    let column =
        |name: &str| head.iter().position(|other| *other == name).unwrap_or_else(|| panic!("{head:?}"));
    let (t, torque, spare) = (column("t [s]"), column("input torque [N*m]"), column("spare [1]"));
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!((row[torque] - 0.5 * row[t]).abs() < 1e-12 && row[spare] == 2.0, "{line}");
    }
    let nowhere = json(&folder, &[page, "--engine", "assembled", "--t-end", "0.01"]);
    assert!(nowhere["files"]["time_series"].is_null(), "{nowhere}");
    assert!(nowhere["files"]["note"].as_str().unwrap().contains("--out"), "{nowhere}");
}

/// A mass of 2 kg on a spring of 50 N/m, with a brake and a motor whose strengths are inputs.
const MASS: &str = r#"format = 1
name = "mass"
[inputs]
push = 0
drag = { value = 0.4, between = "held" }
[[body]]
name = "frame"
fixed = true
[[body]]
name = "block"
mass = 2
inertia = [0.1, 0.1, 0.1]
[[joint]]
name = "rail"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "frame" }
second = { body = "block" }
displacement = 0.3
rate = -0.5
[[force]]
name = "spring"
kind = "spring"
joint = "rail"
stiffness = 50
free = 0
[[force]]
name = "brake"
kind = "damper"
joint = "rail"
damping = "drag"
[[force]]
name = "pusher"
kind = "motor"
joint = "rail"
value = "push"
"#;

const PUSH: [[f64; 2]; 5] = [[0.0, 3.0], [0.2, -5.0], [0.21, 8.0], [0.5, 1.0], [0.8, -4.0]];
const DRAG: [[f64; 2]; 3] = [[0.0, 0.4], [0.3, 5.0], [0.6, 0.1]];

/// Position and rate after a second: between knots the exponential of the plant with its push, a straight line.
fn pushed(is_held: bool) -> [f64; 2] {
    let row = |rows: &[[f64; 2]], t: f64| rows.iter().rposition(|row| row[0] <= t).unwrap();
    let knots = [0.0, 0.2, 0.21, 0.3, 0.5, 0.6, 0.8, 1.0];
    knots.windows(2).fold([0.3, -0.5], |[x, v], knots| {
        let (t, k) = (knots[0], row(&PUSH, knots[0]));
        let rise =
            PUSH.get(k + 1).filter(|_| !is_held).map(|next| (next[1] - PUSH[k][1]) / (next[0] - PUSH[k][0]));
        let (slope, drag) = (rise.unwrap_or(0.0), DRAG[row(&DRAG, t)][1]);
        let push = PUSH[k][1] + slope * (t - PUSH[k][0]);
        let mut plant = nalgebra::Matrix4::zeros();
        (plant[(0, 1)], plant[(2, 3)]) = (1.0, 1.0);
        (plant[(1, 0)], plant[(1, 1)], plant[(1, 2)]) = (-25.0, -drag / 2.0, 0.5);
        let next = (plant * (knots[1] - t)).exp() * nalgebra::Vector4::new(x, v, push, slope);
        [next[0], next[1]]
    })
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn all_engines_follow_inputs_under_error_control() {
    let folder = Folder::new("inputs-controlled");
    fs::write(folder.0.join("mass.toml"), MASS).unwrap();
    let table = |rows: &[[f64; 2]]| rows.iter().map(|[t, u]| format!("{t},{u}\n")).collect::<String>();
    fs::write(folder.0.join("push.csv"), table(&PUSH)).unwrap();
    fs::write(folder.0.join("drag.csv"), table(&DRAG)).unwrap();
    let run = |between: &str, with: &str| {
        let push = format!("push={between}push.csv");
        let args = ["mass.toml", "--tolerance", "1e-10", "--input", &push, "--input", "drag=drag.csv"];
        json(&folder, &args.into_iter().chain(with.split(' ')).collect::<Vec<_>>())
    };
    let by = [
        "--engine assembled --integrator tsit5",
        "--engine assembled --integrator dop853",
        "--engine generated --integrator dop853 --coordinates joint",
        #[cfg(feature = "jit")]
        "--engine jit --integrator rodas4 --coordinates joint",
        #[cfg(feature = "jit")]
        "--engine jit --integrator rodas4 --correction mass-weighted",
        #[cfg(feature = "jit")]
        "--engine jit --integrator tsit5 --correction closed-form",
    ];
    for (between, is_held) in [("held:", true), ("linear:", false), ("", false)] {
        let expected = pushed(is_held);
        for with in by {
            let rail = &run(between, with)["joints"]["rail"];
            for (key, expected) in ["position", "rate"].into_iter().zip(expected) {
                let found = rail[key].as_f64().unwrap();
                assert!((found - expected).abs() < 1e-8, "{between} {with}: {found} for {expected}");
            }
        }
    }
}
