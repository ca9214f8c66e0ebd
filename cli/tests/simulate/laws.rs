//! Formulas as laws, couplings and motions, against the same equations typed and integrated here.

use crate::support::{Folder, json, simulate};
use serde_json::Value;
use std::array::from_fn;
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A rotor about the vertical, with an inertia of 0.5 kg·m².
pub(crate) const ROTOR: &str = "format = 1\nname = \"rotor\"\n[parameters]\nk = 3\n[inputs]\nu = 0.7\n[[body]]\nname = \"ground\"\n\
    fixed = true\n[[body]]\nname = \"wheel\"\nmass = 1\ninertia = [1, 1, 0.5]\n[[joint]]\nname = \"turn\"\n\
    kind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = { body = \"ground\" }\n\
    second = { body = \"wheel\" }\nangle = 0.4\nrate = 1.5\n";

/// A slider of 2 kg along x without weight, of a body that is 0.3 m above the rail.
pub(crate) const SLIDER: &str = "format = 1\nname = \"slider\"\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\nname = \"cart\"\n\
    mass = 2\ninertia = [1, 1, 1]\n[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\n\
    first = { body = \"ground\" }\nsecond = { body = \"cart\" }\ndisplacement = 0.5\nrate = -0.2\n";

pub(crate) const RUNS: [&[&str]; 4] = [
    &["--integrator", "dop853", "--tolerance", "1e-12"],
    &["--coordinates", "maximal", "--integrator", "dop853", "--tolerance", "1e-12"],
    &["--integrator", "tsit5", "--tolerance", "1e-11"],
    &["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-12"],
];

type Law = fn(f64, f64, f64) -> f64;

/// By Kutta's method in steps of 1e-5 s, of positions with their rates.
pub(crate) fn integrated<const N: usize>(
    mut y: [[f64; N]; 2],
    t_end: f64,
    acceleration: impl Fn([f64; N], [f64; N], f64) -> [f64; N],
) -> [[f64; N]; 2] {
    let n = (t_end / 1e-5).round() as u32;
    let h = t_end / f64::from(n);
    for step in 0..n {
        let t = f64::from(step) * h;
        let slope = |part: f64, k: [[f64; N]; 2]| {
            let [x, v] = [0, 1].map(|i: usize| from_fn(|j| y[i][j] + part * h * k[i][j]));
            [v, acceleration(x, v, t + part * h)]
        };
        let a = slope(0.0, [[0.0; N]; 2]);
        let b = slope(0.5, a);
        let c = slope(0.5, b);
        let d = slope(1.0, c);
        y = from_fn(|i| from_fn(|j| y[i][j] + h / 6.0 * (a[i][j] + 2.0 * b[i][j] + 2.0 * c[i][j] + d[i][j])));
    }
    y
}

/// The same of one coordinate.
pub(crate) fn integrated_one(
    y: [f64; 2],
    t_end: f64,
    acceleration: impl Fn(f64, f64, f64) -> f64,
) -> [f64; 2] {
    let [x, v] = integrated(y.map(|y| [y]), t_end, |[x], [v], t| [acceleration(x, v, t)]);
    [x[0], v[0]]
}

pub(crate) fn run(page: &str, options: &[&str], t_end: &str) -> Value {
    static RUNS: AtomicUsize = AtomicUsize::new(0);
    let folder = Folder::new(&format!("laws-{}", RUNS.fetch_add(1, Ordering::Relaxed)));
    fs::write(folder.0.join("page.toml"), page).unwrap();
    json(&folder, &[&["page.toml", "--t-end", t_end], options].concat())
}

/// Position and rate of the first joint, and the drift of the energy.
pub(crate) fn end(run: &Value) -> [f64; 3] {
    let joints = run["joints"].as_object().unwrap();
    let joint = joints.get("turn").or_else(|| joints.get("rail")).unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    [number(&joint["position"]), number(&joint["rate"]), number(&run["energy_drift"])]
}

#[test]
fn motors_by_formula_move_as_their_equation_does() {
    let laws: [(&str, Law); 9] = [
        ("-k*turn^3 - 0.2*turn rate*abs(turn rate) + 0.5*sin(3*t) - 0.1*u", |x, v, t| {
            -3.0 * x.powi(3) - 0.2 * v * v.abs() + 0.5 * (3.0 * t).sin() - 0.07
        }),
        ("exp(-turn^2)*cos(4*t) - ln(2 + turn^2)*turn", |x, _, t| {
            (-x * x).exp() * (4.0 * t).cos() - (2.0 + x * x).ln() * x
        }),
        ("-2*(turn^2 + 0.1)^0.3*turn + step(t, 0.1, 0, 0.6, 1)", |x, _, t| {
            let s = ((t - 0.1) / 0.5).clamp(0.0, 1.0);
            -2.0 * (x * x + 0.1).powf(0.3) * x + s * s * (3.0 - 2.0 * s)
        }),
        ("-atan2(turn rate, 1 + turn^2) + tanh(turn)", |x, v, _| -v.atan2(1.0 + x * x) + x.tanh()),
        ("-asin(0.5*sin(turn)) - sinh(0.3*turn) + hypot(turn, turn rate)", |x, v, _| {
            -(0.5 * x.sin()).asin() - (0.3 * x).sinh() + x.hypot(v)
        }),
        ("-ramp(turn - 0.6, 0.01)*200", |x, _, _| -100.0 * (x - 0.6 + (x - 0.6).hypot(0.01))),
        ("if(turn > 0.6, -100*(turn - 0.6)^1.5, 0)", |x, _, _| {
            if x > 0.6 { -100.0 * (x - 0.6).powf(1.5) } else { 0.0 }
        }),
        ("min(turn, 0.5) + max(turn rate, 1.2)*0", |x, _, _| x.min(0.5)),
        // What is rational decides, of however many digits.
        (
            "max(-turn, ramp(0.3, 0.19)) - 1e-3*if(pi^3/4 < 0.2, 2, floor(pi^5)) + asin(0.3)*turn",
            |x, _, _| (-x).max(0.5 * (0.3 + 0.3_f64.hypot(0.19))) - 0.306 + 0.3_f64.asin() * x,
        ),
    ];
    for (text, law) in laws {
        let expected = integrated_one([0.4, 1.5], 0.8, |x, v, t| law(x, v, t) / 0.5);
        let force = "[[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"turn\"\n";
        for options in RUNS {
            let [x, v, drift] = end(&run(&format!("{ROTOR}{force}value = {text:?}\n"), options, "0.8"));
            let near = |found: f64, expected: f64| (found - expected).abs() < 2e-9;
            assert!(near(x, expected[0]) && near(v, expected[1]), "{text} {options:?}: {x} {v} {expected:?}");
            assert!(drift.abs() < 1e-8, "{text} {options:?}: {drift}");
        }
    }
}

#[test]
fn potentials_and_dissipations_act_by_their_slopes() {
    let page = format!(
        "{ROTOR}[[force]]\nname = \"well\"\nkind = \"potential\"\nenergy = \"2*(1 - cos(turn)) + turn^4 + if(turn > 0.5, \
         k*(turn - 0.5)^3, 0)\"\n[[force]]\nname = \"loss\"\nkind = \"dissipation\"\npower = \"0.3*turn rate^2*(1 + \
         turn^2)\"\n"
    );
    let expected = integrated_one([0.4, 1.5], 0.8, |x, v, _| {
        let above = (x - 0.5).max(0.0);
        (-2.0 * x.sin() - 4.0 * x.powi(3) - 9.0 * above * above - 0.3 * v * (1.0 + x * x)) / 0.5
    });
    for options in RUNS {
        let run = run(&page, options, "0.8");
        let [x, v, drift] = end(&run);
        assert!(
            (x - expected[0]).abs() < 2e-9 && (v - expected[1]).abs() < 2e-9,
            "{options:?}: {x} {v} {expected:?}"
        );
        // The energy is stored, and what is lost is counted as work.
        assert!(drift.abs() < 1e-8, "{options:?}: {drift}");
    }
}

#[test]
fn wires_pull_and_do_not_push() {
    let page = format!(
        "{SLIDER}[[force]]\nname = \"wire\"\nkind = \"link\"\nfirst = {{ body = \"ground\", point = [0, 0.3, 0] }}\n\
         second = {{ body = \"cart\" }}\ntension = \"if(length > 0.45, 50*(length - 0.45) + 3*length rate, 0)\"\n"
    );
    let expected = integrated_one([0.5, -0.2], 1.2, |x, v, _| {
        let length = x.hypot(0.3);
        let tension = if length > 0.45 { 50.0 * (length - 0.45) + 3.0 * x * v / length } else { 0.0 };
        -tension * x / length / 2.0
    });
    for options in RUNS {
        let [x, v, _] = end(&run(&page, options, "1.2"));
        // The force jumps where the wire goes slack while it is being wound up.
        assert!(
            (x - expected[0]).abs() < 1e-5 && (v - expected[1]).abs() < 1e-5,
            "{options:?}: {x} {v} {expected:?}"
        );
    }
}

/// `hypot` changes by nothing where both its operands are zero: what begins there is linearised and integrated.
#[test]
fn drag_has_its_derivatives_at_rest() {
    let page = format!(
        "{}[[force]]\nname = \"drag\"\nkind = \"motor\"\njoint = \"rail\"\n\
         value = \"2 - 3*hypot(rail rate, 0.5*t)*rail rate\"\n",
        SLIDER.replace("rate = -0.2", "rate = 0")
    );
    let expected = integrated_one([0.5, 0.0], 1.0, |_, v, t| (2.0 - 3.0 * v.hypot(0.5 * t) * v) / 2.0);
    for options in [RUNS[0], RUNS[3], &["--integrator", "rodas4", "--tolerance", "1e-10"]] {
        let [x, v, _] = end(&run(&page, options, "1"));
        let error = (x - expected[0]).abs().max((v - expected[1]).abs());
        assert!(error < 1e-8, "{options:?}: {x} {v} {expected:?}");
    }
    let still = page.replace("value = \"2 ", "value = \"");
    let folder = Folder::new("laws-at-rest");
    fs::write(folder.0.join("page.toml"), still).unwrap();
    let linear = json(&folder, &["page.toml", "--linearize", "0"]);
    assert_eq!(linear["linearization"]["A"], serde_json::json!([[0.0, 1.0], [0.0, 0.0]]));
}

/// A shaft with a cam that lifts a follower on a spring: `(I + m f'²) θ̈ + m f' f'' θ̇² + k f f' = 0`.
#[test]
fn cams_lift_by_their_formula() {
    let page = format!(
        "{ROTOR}[[body]]\nname = \"follower\"\nmass = 0.4\ninertia = [1, 1, 1]\n[[joint]]\nname = \"lift\"\n\
         kind = \"prismatic\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\" }}\n\
         second = {{ body = \"follower\" }}\n[[force]]\nname = \"spring\"\nkind = \"spring\"\njoint = \"lift\"\n\
         stiffness = 20\n[[coupler]]\nname = \"cam\"\nsecond = {{ joint = \"lift\" }}\n\
         formula = \"0.3*(1 - cos(turn)) + 0.1*sin(turn)^2\"\n"
    );
    let expected = integrated_one([0.4, 1.5], 0.8, |x, v, _| {
        let lift = 0.3 * (1.0 - x.cos()) + 0.1 * x.sin().powi(2);
        let slope = 0.3 * x.sin() + 0.1 * (2.0 * x).sin();
        let bend = 0.3 * x.cos() + 0.2 * (2.0 * x).cos();
        -(0.4 * slope * bend * v * v + 20.0 * lift * slope) / (0.5 + 0.4 * slope * slope)
    });
    for options in RUNS {
        let [x, v, drift] = end(&run(&page, options, "0.8"));
        assert!(
            (x - expected[0]).abs() < 2e-9 && (v - expected[1]).abs() < 2e-9,
            "{options:?}: {x} {v} {expected:?}"
        );
        assert!(drift.abs() < 1e-8, "{options:?}: {drift}");
    }
}

#[test]
fn motions_by_formula_are_what_they_say() {
    let page = format!(
        "{}[[driver]]\nname = \"shaker\"\njoint = \"turn\"\nmotion = \"0.1*sin(12*t)*tanh(t) + k*exp(-t)\"\n\
         [[output]]\nname = \"torque\"\nkind = \"driver\"\ndriver = \"shaker\"\n",
        ROTOR.replace("angle = 0.4\nrate = 1.5\n", "")
    );
    let t: f64 = 0.8;
    let place = |t: f64| 0.1 * (12.0 * t).sin() * t.tanh() + 3.0 * (-t).exp();
    // θ̈ by hand.
    let (s, c, h) = ((12.0 * t).sin(), (12.0 * t).cos(), t.tanh());
    let g = 1.0 - h * h;
    let second = 0.1 * (-144.0 * s * h + 24.0 * c * g - 2.0 * s * h * g) + 3.0 * (-t).exp();
    for options in RUNS {
        let run = run(&page, options, "0.8");
        let [x, ..] = end(&run);
        assert!((x - place(t)).abs() < 1e-12, "{options:?}: {x}");
        let torque = run["outputs"]["torque"].as_f64().unwrap();
        assert!((torque - 0.5 * second).abs() < 1e-9, "{options:?}: {torque}");
    }
}

/// Of a spring, a damper and a motor the formula takes the operations of the kind that is built in.
#[test]
fn formulas_cost_what_kinds_do() {
    let folder = Folder::new("costs");
    let row = |name: &str, force: &str| {
        let page = format!("{ROTOR}[[force]]\nname = \"law\"\n{force}\n");
        fs::write(folder.0.join(format!("{name}.toml")), page).unwrap();
        let (file, out) = (format!("{name}.toml"), format!("{name}.rs"));
        let output = crate::support::xtask(&folder, &["generate", &file, "--out", &out]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = fs::read_to_string(folder.0.join(out)).unwrap();
        let rows = text.lines().filter(|line| {
            ["| joint_accelerations |", "| joint_derivative |", "| corrected_accelerations |"]
                .iter()
                .any(|row| line.contains(row))
        });
        rows.map(str::to_owned).collect::<Vec<_>>()
    };
    let spring = row("spring", "kind = \"spring\"\njoint = \"turn\"\nstiffness = \"k\"\nfree = 0.2");
    let potential = row("potential", "kind = \"potential\"\nenergy = \"0.5*k*(turn - 0.2)^2\"");
    assert!(!spring.is_empty());
    assert_eq!(spring, potential);
    let damper = row("damper", "kind = \"damper\"\njoint = \"turn\"\ndamping = \"k\"");
    assert_eq!(damper, row("motor", "kind = \"motor\"\njoint = \"turn\"\nvalue = \"-k*turn rate\""));
    assert_eq!(damper, row("loss", "kind = \"dissipation\"\npower = \"k*turn rate^2\""));
}

#[test]
fn what_has_no_value_ends_a_run() {
    let folder = Folder::new("domain");
    let force =
        "[[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"turn\"\nvalue = \"sqrt(0.6 - turn)\"\n";
    fs::write(folder.0.join("page.toml"), format!("{ROTOR}{force}")).unwrap();
    for options in RUNS {
        let output = simulate(&folder, &[&["page.toml", "--t-end", "0.8"], options].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains("t ="), "{options:?}: {said}");
    }
}

/// A run of one of the examples, to 1e-12.
pub(crate) fn example(name: &str, t_end: &str) -> Value {
    let folder = Folder::new(name);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/laws").join(format!("{name}.toml"));
    let page = path.display().to_string();
    json(&folder, &[&page, "--t-end", t_end, "--integrator", "dop853", "--tolerance", "1e-12"])
}

pub(crate) fn joint(run: &Value, name: &str) -> [f64; 2] {
    ["position", "rate"].map(|key| run["joints"][name][key].as_f64().unwrap())
}

fn near(found: [f64; 2], expected: [f64; 2], tolerance: f64) {
    let is_near = |k: usize| (found[k] - expected[k]).abs() < tolerance * expected[k].abs().max(1.0);
    assert!(is_near(0) && is_near(1), "{found:?} for {expected:?}");
}

/// From y0 at x0 to y1 at x1.
pub(crate) fn step(x: f64, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2]) -> f64 {
    let s = ((x - x0) / (x1 - x0)).clamp(0.0, 1.0);
    y0 + (y1 - y0) * s * s * (3.0 - 2.0 * s)
}

#[test]
fn the_duffing_pendulum_moves_as_its_equation_does() {
    let expected = integrated_one([0.0, 0.0], 5.0, |x, v, t| {
        (-9.81 * 0.2 * x.sin() - 0.4 * x - 2.5 * x.powi(3) - 0.02 * v + 0.8 * (4.0 * t).sin()) / 0.09
    });
    near(joint(&example("duffing", "5"), "swing"), expected, 1e-9);
}

#[test]
fn the_cam_pushes_as_its_profile_asks() {
    let run = example("cam_follower", "0.3");
    let x: f64 = 25.0 * 0.3;
    let lift = 0.02 * (1.0 - x.cos()) + 0.004 * x.sin().powi(2);
    let second = 625.0 * (0.02 * x.cos() + 0.008 * (2.0 * x).cos());
    let push = 0.4 * (second + 9.81) + 300.0 * (lift + 0.05);
    near([joint(&run, "lift")[0], run["outputs"]["push"].as_f64().unwrap()], [lift, push], 1e-9);
}

#[test]
fn the_load_of_the_crane_swings_on_its_wire() {
    let out = |t: f64| 4.0 - step(t, [1.0, 0.0], [4.0, 1.5]);
    let trolley = |t: f64| step(t, [0.5, 0.0], [3.0, 2.0]);
    let rate = |t: f64| {
        let s = ((t - 0.5) / 2.5).clamp(0.0, 1.0);
        2.0 * 6.0 * s * (1.0 - s) / 2.5
    };
    let [[x, y], _] = integrated([[0.0, -4.02], [0.0; 2]], 4.0, |[x, y], [vx, vy], t| {
        let (dx, dv) = (x - trolley(t), vx - rate(t));
        let length = dx.hypot(y);
        let pull = 25e3 * (length - out(t)) + 600.0 * (dx * dv + y * vy) / length;
        let pull = if length > out(t) { pull.max(0.0) } else { 0.0 };
        [-pull * dx / length / 50.0, -pull * y / length / 50.0 - 9.81]
    });
    let run = example("crane", "4");
    let at = &run["outputs"]["at"];
    near([at[0].as_f64().unwrap(), at[1].as_f64().unwrap()], [x, y], 1e-9);
}

#[test]
fn the_quarter_car_drives_over_its_bump() {
    let expected = integrated([[0.0; 2]; 2], 0.9, |[u, travel], [_, rate], t| {
        let place = 8.0 * t;
        let road = 0.05 * (step(place, [4.0, 0.0], [4.5, 1.0]) - step(place, [5.0, 0.0], [5.5, 1.0]));
        let damper = if rate > 0.0 { -2500.0 * rate } else { -1100.0 * rate };
        let strut = damper - 18e3 * travel - 4e5 * travel.powi(3);
        let tyre = if u < road { 2e5 * (road - u) } else { 0.0 };
        let wheel = (tyre - strut) / 40.0 - 9.81;
        [wheel, strut / 300.0 - 9.81 - wheel]
    });
    let run = example("quarter_car", "0.9");
    for (k, name) in ["u", "travel"].into_iter().enumerate() {
        near(joint(&run, name), [expected[0][k], expected[1][k]], 1e-9);
    }
}

/// After a period it is where it began: 2π √(a³ / μ).
#[test]
fn the_satellite_comes_back() {
    let run = example("satellite", "8145.599631159027");
    let at = &run["outputs"]["at"];
    near([at[0].as_f64().unwrap(), at[1].as_f64().unwrap() / 7e6], [7e6, 0.0], 1e-9);
    let half = example("satellite", "4072.7998155795136");
    near([half["outputs"]["distance"].as_f64().unwrap(), 0.0], [10.5e6, 0.0], 1e-9);
}

/// Upwards against the square of its velocity: `v = √(f/b) tanh(t √(f b) / m)` for a thrust f beyond the weight.
#[test]
fn the_quadrotor_rises() {
    let (force, resistance, mass, t) =
        (4.0 * 1.1e-5 * 560.0_f64.powi(2) - 1.2 * 9.81, 0.5 * 1.2 * 0.09 * 1.1_f64, 1.2, 2.0);
    let velocity = (force / resistance).sqrt() * (t * (force * resistance).sqrt() / mass).tanh();
    let run = example("quadrotor", "2");
    near([run["outputs"]["resistance_air"][2].as_f64().unwrap(), 0.0], [velocity, 0.0], 1e-9);
}

/// The bushing is a force between coupler and rocker: three angles, the coupler's being that of its body.
#[test]
fn the_four_bar_gives_way_in_its_bushing() {
    let start = [[FRAC_PI_2, 0.0, FRAC_PI_2], [6.0, 0.0, 6.0]];
    let [[crank, coupler, rocker], rates] = integrated(start, 0.2, |x, v, _| linkage(x, v));
    let run = example("bushed_four_bar", "0.2");
    let [input, elbow, output] = ["input", "elbow", "output"].map(|name| joint(&run, name));
    near([input[0], output[0]], [crank, rocker], 1e-9);
    near([elbow[0], input[1]], [coupler - crank, rates[0]], 1e-9);
    let (u, _) = gap([crank, coupler, rocker], rates);
    let pin = &run["outputs"]["pin"];
    near([0, 1].map(|k| 1e4 * pin[k].as_f64().unwrap()), u.map(|u| 1e4 * u), 1e-6);
}

/// Where the rocker's end is, seen from the coupler's, and how fast that changes there.
fn gap([crank, coupler, rocker]: [f64; 3], [a, b, c]: [f64; 3]) -> ([f64; 2], [f64; 2]) {
    let arm = |length: f64, angle: f64| [length * angle.cos(), length * angle.sin()];
    let turned = |[x, y]: [f64; 2], rate: f64| [-rate * y, rate * x];
    let (first, second, third) = (arm(0.2, crank), arm(0.6, coupler), arm(0.2, rocker));
    let d: [f64; 2] = from_fn(|k| [0.6, 0.0][k] + third[k] - first[k] - second[k]);
    let (da, db, dc) = (turned(first, a), turned(second, b), turned(third, c));
    let carried = turned(d, b);
    let rate: [f64; 2] = from_fn(|k| dc[k] - da[k] - db[k] - carried[k]);
    let seen =
        |[x, y]: [f64; 2]| [x * coupler.cos() + y * coupler.sin(), y * coupler.cos() - x * coupler.sin()];
    (seen(d), seen(rate))
}

/// Accelerations by Lagrange's equations, crank and coupler a double pendulum, the rocker one of its own.
fn linkage(x: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    let [crank, coupler, rocker] = x;
    let (u, rate) = gap(x, v);
    let f: [f64; 2] = from_fn(|k| -8e4 * u[k] - 40.0 * rate[k] - 1e9 * u[k].powi(3));
    // The power of these, and of the damper of the angle between the bodies, along each unit rate.
    let mut load: [f64; 3] = from_fn(|k| {
        let unit = from_fn(|l| if l == k { 1.0 } else { 0.0 });
        let [x, y] = gap(x, unit).1;
        x * f[0] + y * f[1]
    });
    let drag = 0.02 * (v[2] - v[1]);
    load[1] += drag;
    load[2] -= drag;
    let (difference, coupling) = (crank - coupler, 0.2 * 0.3);
    load[0] -= 9.81 * (0.5 * 0.1 + 0.2) * crank.cos() + coupling * difference.sin() * v[1] * v[1];
    load[1] -= 9.81 * 0.3 * coupler.cos() - coupling * difference.sin() * v[0] * v[0];
    load[2] -= 9.81 * 0.8 * 0.1 * rocker.cos();
    let (m, n) = (2e-3 + 0.5 * 0.01 + 0.04, 0.03 + 0.09);
    let across = coupling * difference.cos();
    let determinant = m * n - across * across;
    [
        (n * load[0] - across * load[1]) / determinant,
        (m * load[1] - across * load[0]) / determinant,
        load[2] / (0.02 + 0.8 * 0.01),
    ]
}
