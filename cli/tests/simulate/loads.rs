//! Outputs of elements: couplers, springs and links.

use crate::support::{Folder, json};
use std::fs;

/// Two discs on parallel shafts 1 m apart, the second geared to turn by −2 with the first, a torsional spring at the
/// first and a damped link between points of both.
const DISCS: &str = r#"
format = 1
name = "discs"
gravity = [0, 0, -9.81]
[simulation]
t_end = 0.7
[[body]]
name = "ground"
fixed = true
[[body]]
name = "a"
mass = 1
inertia = [0.1, 0.1, 0.1]
[[body]]
name = "b"
mass = 2
inertia = [0.2, 0.2, 0.3]
[[joint]]
name = "ja"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "a" }
rate = 3
[[joint]]
name = "jb"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground", point = [1, 0, 0] }
second = { body = "b" }
rough = true
[[coupler]]
name = "gear"
first = { joint = "ja" }
second = { joint = "jb" }
ratio = -2
[[force]]
name = "s"
kind = "spring"
joint = "ja"
stiffness = 5
free = 0.2
[[force]]
name = "l"
kind = "link"
first = { body = "a", point = [0.3, 0, 0] }
second = { body = "b", point = [0.2, 0.1, 0] }
stiffness = 30
damping = 0.4
free_length = 0.5
[[output]]
name = "of_gear"
kind = "coupler"
coupler = "gear"
[[output]]
name = "of_spring"
kind = "spring"
force = "s"
[[output]]
name = "of_link"
kind = "link"
force = "l"
[[output]]
name = "of_b"
kind = "acceleration"
body = "b"
"#;

#[test]
fn loads_of_elements_are_those_of_their_laws() {
    let folder = Folder::new("loads");
    fs::write(folder.0.join("discs.toml"), DISCS).unwrap();
    for more in [&["jit"][..], &["jit", "--coordinates", "maximal"], &["assembled"]] {
        let run = json(&folder, &[&["discs.toml", "--engine"], more].concat());
        let hinge = |joint: &str, key: &str| run["joints"][joint][key].as_f64().unwrap();
        let outputs = &run["outputs"];
        let output = |name: &str, k: usize| outputs[name][k].as_f64().unwrap();
        let of_gear = outputs["of_gear"].as_f64().unwrap();
        let near = |found: f64, expected: f64| {
            assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{more:?}: {found} {expected}");
        };
        // A point of a body that turns about an axis z, and how fast it is.
        let point = |x: f64, [a, b]: [f64; 2], joint: &str| {
            let (sin, cos) = hinge(joint, "position").sin_cos();
            let (dx, dy, rate) = (a * cos - b * sin, a * sin + b * cos, hinge(joint, "rate"));
            ([x + dx, dy], [-rate * dy, rate * dx])
        };
        let (from, to) = (point(0.0, [0.3, 0.0], "ja"), point(1.0, [0.2, 0.1], "jb"));
        let line = [0, 1].map(|k| to.0[k] - from.0[k]);
        let length = line[0].hypot(line[1]);
        let growth = (line[0] * (to.1[0] - from.1[0]) + line[1] * (to.1[1] - from.1[1])) / length;
        let thrust = -30.0 * (length - 0.5) - 0.4 * growth;
        near(output("of_link", 0), thrust);
        near(output("of_link", 1), length);
        let deflection = hinge("ja", "position") - 0.2;
        near(output("of_spring", 0), -5.0 * deflection);
        near(output("of_spring", 1), deflection);
        // What accelerates the second disc besides the link's torque about its shaft.
        let torque = thrust * ((to.0[0] - 1.0) * line[1] - to.0[1] * line[0]) / length;
        near(of_gear, 0.3 * output("of_b", 5) - torque);
        assert!(of_gear.abs() > 0.1 && thrust.abs() > 0.1, "{run}");
    }
}
