//! States of one's own, against closed forms and the same equations integrated here.

use crate::support::{Folder, json, simulate};
use serde_json::Value;
use std::array::from_fn;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A rotor about the vertical with an inertia of 2e-4 kg·m², on a motor with its current.
const MOTOR: &str = "format = 1\nname = \"motor\"\n[parameters]\nresistance = 2\ninductance = 0.01\nconstant = 0.05\n\
    [inputs]\nvoltage = 12\n[[body]]\nname = \"stator\"\nfixed = true\n[[body]]\nname = \"rotor\"\nmass = 0.5\n\
    inertia = [1e-4, 1e-4, 2e-4]\n[[joint]]\nname = \"shaft\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
    first = { body = \"stator\" }\nsecond = { body = \"rotor\" }\ndamping = 1e-3\n[[state]]\nname = \"current\"\n\
    rate = \"(voltage - resistance*current - constant*shaft rate)/inductance\"\n[[force]]\nname = \"torque\"\n\
    kind = \"motor\"\njoint = \"shaft\"\nvalue = \"constant*current\"\n";

pub(crate) const RUNS: [&[&str]; 5] = [
    &["--integrator", "dop853", "--tolerance", "1e-13"],
    &["--coordinates", "maximal", "--integrator", "dop853", "--tolerance", "1e-13"],
    &["--integrator", "tsit5", "--tolerance", "1e-12"],
    &["--integrator", "rodas4", "--tolerance", "1e-10"],
    &["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-13"],
];

pub(crate) fn run(page: &str, options: &[&str], t_end: &str) -> Value {
    printed(page, &[options, &["--t-end", t_end]].concat())
}

fn printed(page: &str, options: &[&str]) -> Value {
    static RUNS: AtomicUsize = AtomicUsize::new(0);
    let folder = Folder::new(&format!("states-{}", RUNS.fetch_add(1, Ordering::Relaxed)));
    fs::write(folder.0.join("page.toml"), page).unwrap();
    json(&folder, &[&["page.toml"], options].concat())
}

/// By Kutta's method in steps of 1e-5 s.
pub(crate) fn integrated<const N: usize>(
    mut y: [f64; N],
    t_end: f64,
    rates: impl Fn([f64; N], f64) -> [f64; N],
) -> [f64; N] {
    let n = (t_end / 1e-5).round() as u32;
    let h = t_end / f64::from(n);
    for step in 0..n {
        let t = f64::from(step) * h;
        let moved = |k: [f64; N], part: f64| from_fn(|i| y[i] + part * h * k[i]);
        let a = rates(y, t);
        let b = rates(moved(a, 0.5), t + 0.5 * h);
        let c = rates(moved(b, 0.5), t + 0.5 * h);
        let d = rates(moved(c, 1.0), t + h);
        y = from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    y
}

/// A run of one of the examples, to 1e-12.
fn example(name: &str, t_end: &str) -> Value {
    let folder = Folder::new(name);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/laws").join(format!("{name}.toml"));
    let page = path.display().to_string();
    json(&folder, &[&page, "--t-end", t_end, "--integrator", "dop853", "--tolerance", "1e-12"])
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

pub(crate) fn output(run: &Value, name: &str) -> f64 {
    let output = &run["outputs"][name];
    number(output.get(0).unwrap_or(output))
}

/// The step response of two linear equations: with `A = [[−R/L, −k/L], [k/J, −d/J]]` and its eigenvalues λ,
/// `y(t) = y∞ − Σ (A − λ_other) y∞ exp(λ t) / (λ − λ_other)`.
#[test]
fn the_motor_answers_a_step_as_its_closed_form_does() {
    let (r, l, k, d, j, u, t) = (2.0, 0.01, 0.05, 1e-3, 2e-4, 12.0, 0.03_f64);
    let a = [[-r / l, -k / l], [k / j, -d / j]];
    let (trace, determinant): (f64, f64) = (a[0][0] + a[1][1], a[0][0] * a[1][1] - a[0][1] * a[1][0]);
    let root = (trace * trace / 4.0 - determinant).sqrt();
    let lambda = [trace / 2.0 + root, trace / 2.0 - root];
    let rest = [u * d / (r * d + k * k), u * k / (r * d + k * k)];
    let part = |n: usize, row: usize| {
        let other = lambda[1 - n];
        let product = a[row][0] * rest[0] + a[row][1] * rest[1] - other * rest[row];
        product * (lambda[n] * t).exp() / (lambda[n] - other)
    };
    let [current, speed] = [0, 1].map(|row| rest[row] - part(0, row) - part(1, row));
    for options in RUNS {
        let run = run(MOTOR, options, "0.03");
        let found = [output(&run, "current"), number(&run["joints"]["shaft"]["rate"])];
        let near = |found: f64, expected: f64| (found - expected).abs() < 1e-9 * expected.abs();
        assert!(near(found[0], current) && near(found[1], speed), "{options:?}: {found:?} {current} {speed}");
        assert!(number(&run["energy_drift"]).abs() < 1e-8, "{options:?}");
    }
}

/// `"rest"`: where the rate is zero, other states and the motion being as they start.
#[test]
fn states_start_at_rest() {
    let page = MOTOR.replace("name = \"current\"\n", "name = \"current\"\nstart = \"rest\"\n")
        + "[[state]]\nname = \"heat\"\nstart = \"rest\"\nrate = \"resistance*current^2 - 0.3*heat - 1e-3*heat^4\"\n\
           [[state]]\nname = \"wheel\"\nstart = \"rest\"\nrate = \"at.vy - wheel/3\"\n[[output]]\nname = \"at\"\n\
           kind = \"velocity\"\nbody = \"rotor\"\npoint = [0.2, 0, 0]\n";
    let page = page.replace("damping = 1e-3", "damping = 1e-3\nrate = 4");
    for options in [RUNS[0], RUNS[4]] {
        let run = run(&page, options, "1e-9");
        let (current, heat) = (output(&run, "current"), output(&run, "heat"));
        assert!((current - (12.0 - 0.05 * 4.0) / 2.0).abs() < 1e-6, "{current}");
        let left = 2.0 * current * current - 0.3 * heat - 1e-3 * heat.powi(4);
        assert!(left.abs() < 1e-6 && heat > 0.0, "{heat}: {left}");
        assert!((output(&run, "wheel") - 3.0 * 0.2 * 4.0).abs() < 1e-6);
    }
}

/// Friction after Canudas de Wit and others (1995): bristles that bend, `ż = v − |v| z σ0 / g(v)`.
#[test]
fn bristles_hold_and_give_way() {
    let page = "format = 1\nname = \"lugre\"\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\nname = \"block\"\n\
        mass = 1\ninertia = [1, 1, 1]\n[[joint]]\nname = \"x\"\nkind = \"prismatic\"\naxis = [1, 0, 0]\n\
        zero = [0, 1, 0]\nfirst = { body = \"ground\" }\nsecond = { body = \"block\" }\n[[formula]]\nname = \"level\"\n\
        of = \"1 + 0.5*exp(-(x rate/0.01)^2)\"\n[[state]]\nname = \"z\"\nrate = \"x rate - abs(x rate)*z*1e3/level\"\n\
        [[force]]\nname = \"friction\"\nkind = \"motor\"\njoint = \"x\"\n\
        value = \"-1e3*z - 30*(x rate - abs(x rate)*z*1e3/level) - 0.4*x rate\"\n[[force]]\nname = \"pulled\"\n\
        kind = \"motor\"\njoint = \"x\"\nvalue = \"20*(0.1*t - x)\"\n";
    let rates = |[x, v, z]: [f64; 3], t: f64| {
        let level = 1.0 + 0.5 * (-(v / 0.01).powi(2)).exp();
        let bends = v - v.abs() * z * 1e3 / level;
        [v, -1e3 * z - 30.0 * bends - 0.4 * v + 20.0 * (0.1 * t - x), bends]
    };
    let y = integrated([0.0; 3], 2.0, rates);
    for options in RUNS {
        let run = run(page, options, "2");
        let found = [number(&run["joints"]["x"]["position"]), output(&run, "z")];
        assert!(
            (found[0] - y[0]).abs() < 1e-8 && (found[1] - y[2]).abs() < 1e-9,
            "{options:?}: {found:?} {y:?}"
        );
    }
}

/// A motor with its current on the crank of a four-bar linkage: the linearisation has the independent coordinate, its
/// rate and the current.
#[test]
fn states_are_linearised_with_loops() {
    let page = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../models/four-bar.toml")).unwrap();
    let joint = page.split("[[joint]]\nname = \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    let page = format!(
        "{page}\n[[state]]\nname = \"current\"\nstart = 0.2\nrate = \"(1 - 3*current - 0.5*{joint} rate)/0.1\"\n\
         [[force]]\nname = \"electric\"\nkind = \"motor\"\njoint = \"{joint}\"\nvalue = \"0.5*current\"\n"
    );
    for options in [&["--engine", "in-process"][..], &["--coordinates", "maximal"]] {
        let run = printed(&page, &[options, &["--linearize", "0"]].concat());
        let linear = &run["linearization"];
        let names: Vec<&str> =
            linear["states"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
        let at = names.iter().position(|name| *name == "current").expect("a state");
        assert_eq!(names.len(), 3, "{names:?}");
        assert!((number(&linear["A"][at][at]) + 30.0).abs() < 1e-9, "{linear}");
        let on_rate = names.iter().position(|name| name.ends_with("_rate")).unwrap();
        assert!(number(&linear["A"][on_rate][at]).abs() > 1e-3, "{linear}");
    }
}

#[test]
fn states_that_act_on_nothing_are_told() {
    let folder = Folder::new("unread-state");
    let page = format!("{MOTOR}[[state]]\nname = \"charge\"\nrate = \"current\"\n");
    fs::write(folder.0.join("page.toml"), page).unwrap();
    let output = simulate(&folder, &["page.toml"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("nothing depends on state `charge`"), "{said}");
}

/// In one coordinate, the angle θ of the crank: with its kinetic energy `½ M(θ) θ̇²`,
/// `M θ̈ + ½ M' θ̇² = k i − c θ̇ − F dx/dθ`.
#[test]
fn the_slider_crank_runs_up_as_its_equations_do() {
    let rod = |x: f64| (-0.25 * x.sin()).asin();
    let place = |x: f64| {
        let turned = rod(x);
        [0.05 * x.cos() + 0.1 * turned.cos(), 0.025 * x.sin(), 0.05 * x.cos() + 0.2 * turned.cos(), turned]
    };
    let slopes = |x: f64| {
        let turned = rod(x);
        let by = -0.25 * x.cos() / turned.cos();
        let [along, across] = [-0.05 * x.sin() - 0.1 * turned.sin() * by, 0.025 * x.cos()];
        [along, across, -0.05 * x.sin() - 0.2 * turned.sin() * by, by]
    };
    let mass = |x: f64| {
        let [along, across, piston, by] = slopes(x);
        8e-4 + 0.3 * (along * along + across * across) + 0.5 * piston * piston + 1.2e-3 * by * by
    };
    let [angle, speed, current] = integrated([1.0, 0.0, 0.0], 0.3, |[x, v, i], _| {
        let changes = (mass(x + 1e-5) - mass(x - 1e-5)) / 2e-5;
        let piston = slopes(x)[2];
        let damping = if piston * v > 0.0 { 60.0 } else { 5.0 };
        let torque = 0.08 * i - 1e-3 * v - damping * piston * piston * v - 0.5 * changes * v * v;
        [v, torque / mass(x), (24.0 - 1.2 * i - 0.08 * v) / 5e-3]
    });
    let run = example("dc_motor", "0.3");
    let shaft = &run["joints"]["shaft"];
    let found = [number(&shaft["position"]), number(&shaft["rate"]), output(&run, "motor_current")];
    for (found, expected) in found.into_iter().zip([angle, speed, current]) {
        assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{found} {expected}");
    }
    assert!((number(&run["joints"]["cylinder"]["position"]) - place(angle)[2]).abs() < 1e-9);
}

#[test]
fn the_block_sticks_and_slips_as_its_equations_do() {
    let [x, _, bristle] = integrated([0.0; 3], 4.0, |[x, v, z], t| {
        let level = 1.0 + 0.5 * (-(v / 0.001).powi(2)).exp();
        let bends = v - 1e5 * v.abs() * z / level;
        [v, -1e5 * z - 316.0 * bends - 0.4 * v + 2.0 * (0.1 * t - x), bends]
    });
    let run = example("stick_slip", "4");
    let found = [number(&run["joints"]["x"]["position"]), output(&run, "friction_bristles")];
    assert!((found[0] - x).abs() < 1e-9 && (found[1] - bristle).abs() < 1e-12, "{found:?} {x} {bristle}");
}
