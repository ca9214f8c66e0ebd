//! Many parallelograms in a row, benchmark A02 (*N-four-bar mechanism*) of the IFToMM technical committee for multibody
//! dynamics: released at 45 degrees, they swing as one pendulum, through poses in which all bars are in line and each
//! cell by itself could fold.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use crate::support::{Folder, json};
use gyro_reference::Pendulum;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::fmt::Write as _;
use std::fs;

/// Of a thin rod of 1 m and 1 kg, kg·m².
const INERTIA: f64 = 0.0833333333333;

/// s.
const T_END: f64 = 20.0;

fn model_file(n: usize) -> String {
    let mut text = format!(
        "format = 1\nname = \"cells\"\ngravity = [0, -9.81, 0]\n[simulation]\nt_end = {T_END:?}\nstep = 1e-3\n\
         [[body]]\nname = \"ground\"\nfixed = true\n"
    );
    let bars = (0..=n).map(|k| format!("bar{k}"));
    for rod in bars.chain((0..n).map(|k| format!("coupler{k}"))) {
        let _ =
            write!(text, "[[body]]\nname = \"{rod}\"\nmass = 1\ninertia = [1e-3, {INERTIA}, {INERTIA}]\n");
    }
    let mut hinge = |name: String, [first, second]: [(String, f64); 2], start: &str| {
        let [first, second] =
            [first, second].map(|(body, x)| format!("{{ body = \"{body}\", point = [{x:?}, 0, 0] }}"));
        let _ = write!(
            text,
            "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {first}\n\
             second = {second}\n{start}\n"
        );
    };
    for k in 0..=n {
        let start = if k == 0 { "angle_deg = 45\nrate = -1" } else { "angle_deg = 45\nrough = true" };
        hinge(format!("pin{k}"), [("ground".to_owned(), k as f64), (format!("bar{k}"), -0.5)], start);
    }
    for k in 0..n {
        for (bar, end) in [(k, -0.5), (k + 1, 0.5)] {
            let ends = [(format!("bar{bar}"), 0.5), (format!("coupler{k}"), end)];
            hinge(format!("joint{k}_{bar}"), ends, "angle_deg = -45\nrough = true");
        }
    }
    text
}

/// Couplers only go round with the tips of the bars. Angles count from gravity, which is along −y.
fn as_pendulum(n: usize) -> Pendulum {
    let n = n as f64;
    let (mass, moment, inertia) = (2.0 * n + 1.0, 1.5 * n + 0.5, (n + 1.0) * (INERTIA + 0.25) + n);
    let distance = moment / mass;
    let start = FRAC_PI_4 + FRAC_PI_2;
    Pendulum { mass, inertia: inertia - moment * distance, distance, gravity: 9.81, start, rate: -1.0 }
}

/// Twenty seconds, through some twenty-seven poses in line.
fn check(n: usize, integrator: &str, tolerance: &str, allowed: f64) {
    let folder = Folder::new(&format!("cells-{n}-{integrator}"));
    fs::write(folder.0.join("cells.toml"), model_file(n)).unwrap();
    let scene =
        ["cells.toml", "--coordinates", "joint", "--integrator", integrator, "--tolerance", tolerance];
    let run = json(&folder, &scene);
    let expected = as_pendulum(n).solve(&[T_END])[0].angle - FRAC_PI_2;
    let pins = (0..=n).map(|k| run["joints"][format!("pin{k}")]["position"].as_f64().unwrap());
    let error = pins.map(|angle| (angle - expected).abs()).fold(0.0, f64::max);
    println!(
        "{n} cells, {integrator} at {tolerance}: off by {error:.1e}, {} s, {} poses",
        run["run_time_s"], run["poses_stepped_over"]
    );
    assert!(error < allowed, "{n} cells, {integrator} at {tolerance}: off by {error:e}");
    assert!(run["poses_stepped_over"].as_u64().unwrap() > 20, "{run}");
}

/// `cargo test --release --package gyro-cli --test simulate -- --ignored cells --nocapture`: some minutes.
#[test]
#[ignore = "a study: compiles two optimised programs, of 9 and of 81 bodies"]
fn cells_pass_poses_in_line_for_twenty_seconds() {
    for n in [4, 40] {
        check(n, "dop853", "1e-11", 1e-6);
        check(n, "tsit5", "1e-9", 1e-6);
    }
}
