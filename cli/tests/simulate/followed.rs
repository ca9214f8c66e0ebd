//! Motions that follow inputs: shakers, roads, joints that are driven by position.

use crate::support::{Folder, json, simulate};
use serde_json::Value;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A wheel on a road whose height is an input, with a body on a spring and a damper above it.
const CAR: &str = "format = 1\nname = \"car\"\n[inputs]\nroad = 0\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\n\
    name = \"wheel\"\nmass = 10\ninertia = [1, 1, 1]\n[[body]]\nname = \"body\"\nmass = 4\ninertia = [1, 1, 1]\n[[joint]]\n\
    name = \"hub\"\nkind = \"prismatic\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = { body = \"ground\" }\n\
    second = { body = \"wheel\" }\n[[joint]]\nname = \"strut\"\nkind = \"prismatic\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
    first = { body = \"wheel\" }\nsecond = { body = \"body\" }\ndamping = 12\n[[driver]]\nname = \"shake\"\njoint = \"hub\"\n\
    motion = \"road\"\n[[force]]\nname = \"spring\"\nkind = \"spring\"\njoint = \"strut\"\nstiffness = 800\n";

const RUNS: [&[&str]; 4] = [
    &["--integrator", "dop853", "--tolerance", "1e-12"],
    &["--coordinates", "maximal", "--integrator", "dop853", "--tolerance", "1e-12"],
    &["--integrator", "rodas4", "--tolerance", "1e-10"],
    &["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-12"],
];

fn folder() -> Folder {
    static FOLDERS: AtomicUsize = AtomicUsize::new(0);
    Folder::new(&format!("followed-{}", FOLDERS.fetch_add(1, Ordering::Relaxed)))
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// The rows of a road of 0.05 sin(6 t).
fn road() -> String {
    let row = |k: u32| {
        let t = f64::from(k) * 0.05;
        format!("{t},{}\n", 0.05 * (6.0 * t).sin())
    };
    (0..=40).map(row).collect()
}

/// As the driver whose motion is the table of the same rows.
#[test]
fn a_road_by_input_moves_as_one_by_table_does() {
    let folder = folder();
    fs::write(folder.0.join("road.csv"), format!("t,z\n{}", road())).unwrap();
    fs::write(folder.0.join("input.toml"), CAR).unwrap();
    let table = CAR.replace("motion = \"road\"", "motion = { table = \"road.csv\" }");
    fs::write(folder.0.join("table.toml"), table).unwrap();
    for options in RUNS {
        let all = |page: &'static str, more: &[&'static str]| {
            json(&folder, &[&[page, "--t-end", "1.3"], more, options].concat())
        };
        let (found, expected) = (all("input.toml", &["--input", "road=road.csv"]), all("table.toml", &[]));
        for (joint, key) in [("strut", "position"), ("strut", "rate"), ("hub", "position"), ("hub", "rate")] {
            let [found, expected] = [&found, &expected].map(|run| number(&run["joints"][joint][key]));
            assert!((found - expected).abs() < 1e-9, "{options:?} {joint} {key}: {found} {expected}");
        }
        // The driver's work is counted.
        assert!(number(&found["energy_drift"]).abs() < 1e-7, "{options:?}");
    }
}

/// The body follows the road by `(c s + k) / (m s² + c s + k)`: of a harmonic road of frequency ω, value, rate and
/// acceleration of the road are 1, jω and −ω².
#[test]
fn roads_are_columns_of_the_linearisation() {
    let folder = folder();
    fs::write(folder.0.join("page.toml"), CAR).unwrap();
    let run = json(&folder, &["page.toml", "--linearize", "0"]);
    let linear = &run["linearization"];
    let inputs: Vec<&str> = linear["inputs"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(inputs, ["road", "road_rate", "road_acceleration"]);
    let at = |matrix: &str, row: usize, column: usize| number(&linear[matrix][row][column]);
    // The strut z: m (z̈ + r̈) = −k z − c ż.
    let expected =
        [("A", 1, 0, -200.0), ("A", 1, 1, -3.0), ("B", 1, 0, 0.0), ("B", 1, 1, 0.0), ("B", 1, 2, -1.0)];
    for (matrix, row, column, expected) in expected {
        assert!((at(matrix, row, column) - expected).abs() < 1e-12, "{linear}");
    }
}

/// Where the road begins, the wheel does, with its rate.
#[test]
fn runs_start_where_the_road_does() {
    let folder = folder();
    fs::write(
        folder.0.join("page.toml"),
        CAR.replace("motion = \"road\"", "motion = { sum = [0.3, \"-road\"] }"),
    )
    .unwrap();
    fs::write(folder.0.join("road.csv"), "0,0.1\n1,0.3\n").unwrap();
    for (input, t_end, expected) in [
        ("road=0.1", "0.5", [0.2, 0.0]),
        ("road=road.csv", "0.5", [0.1, -0.2]),
        ("road=road.csv", "2", [-0.2, -0.2]),
    ] {
        for options in RUNS {
            let run = json(&folder, &[&["page.toml", "--input", input, "--t-end", t_end], options].concat());
            let hub = &run["joints"]["hub"];
            let found = [number(&hub["position"]), number(&hub["rate"])];
            let is_near = |k: usize| (found[k] - expected[k]).abs() < 1e-12;
            assert!(is_near(0) && is_near(1), "{input} {options:?}: {found:?} {expected:?}");
        }
    }
}

#[test]
fn roads_with_corners_and_derivatives_alone_are_refused() {
    let folder = folder();
    fs::write(folder.0.join("page.toml"), CAR).unwrap();
    fs::write(folder.0.join("road.csv"), "0,0.1\n1,0.3\n2,0.3\n").unwrap();
    let cases: [(&str, &[&str], &str); 3] = [
        ("road=linear:road.csv", &[], "jump"),
        ("road_rate=1", &[], "give `road`"),
        ("road=road.csv", &["--integrator", "rk4"], "error control"),
    ];
    for (input, options, words) in cases {
        let output = simulate(&folder, &[&["page.toml", "--input", input], options].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains(words), "{input}: {said}");
    }
}
