//! Curves in formulas, against the same equations typed and integrated here with curves of their own.

use crate::laws::{ROTOR, RUNS, end, example, integrated_one, joint, run};
use crate::support::{Folder, json, simulate};
use std::fmt::Write as _;
use std::fs;

const POINTS: &str = "[[-1, -4], [0, 0], [0.5, 1], [1, 5], [1.5, 15]]";

/// The natural cubic spline through those points in the form of second derivatives at the points, by the system
/// `h M₋ + 2 (h + h₊) M + h₊ M₊ = 6 (d₊ − d)` solved by repetition; straight beyond the ends.
struct Natural {
    x: Vec<f64>,
    y: Vec<f64>,
    m: Vec<f64>,
}

impl Natural {
    fn through(points: &[(f64, f64)]) -> Self {
        let (x, y): (Vec<f64>, Vec<f64>) = points.iter().copied().unzip();
        let mut m = vec![0.0; x.len()];
        for _ in 0..200 {
            for k in 1..x.len() - 1 {
                let (h, next) = (x[k] - x[k - 1], x[k + 1] - x[k]);
                let bend = 6.0 * ((y[k + 1] - y[k]) / next - (y[k] - y[k - 1]) / h);
                m[k] = (bend - h * m[k - 1] - next * m[k + 1]) / (2.0 * (h + next));
            }
        }
        Self { x, y, m }
    }

    fn at(&self, at: f64) -> [f64; 3] {
        let last = self.x.len() - 1;
        if at < self.x[0] || at > self.x[last] {
            let end = if at < self.x[0] { self.x[0] } else { self.x[last] };
            let [value, slope, _] = self.at(end);
            return [value + slope * (at - end), slope, 0.0];
        }
        let k = (1..last).filter(|&k| self.x[k] <= at).count();
        let h = self.x[k + 1] - self.x[k];
        let (a, b) = ((self.x[k + 1] - at) / h, (at - self.x[k]) / h);
        let (from, to) = (self.m[k] * h * h / 6.0, self.m[k + 1] * h * h / 6.0);
        let value = a * self.y[k] + b * self.y[k + 1] + (a * a * a - a) * from + (b * b * b - b) * to;
        let slope = (self.y[k + 1] - self.y[k] - (3.0 * a * a - 1.0) * from + (3.0 * b * b - 1.0) * to) / h;
        [value, slope, a * self.m[k] + b * self.m[k + 1]]
    }
}

fn progressive() -> Natural {
    Natural::through(&[(-1.0, -4.0), (0.0, 0.0), (0.5, 1.0), (1.0, 5.0), (1.5, 15.0)])
}

fn near(run: &serde_json::Value, expected: [f64; 2], tolerance: f64, what: &str) {
    let [x, v, _] = end(run);
    let is_near = (x - expected[0]).abs() < tolerance && (v - expected[1]).abs() < tolerance;
    assert!(is_near, "{what}: {x} {v} {expected:?}");
}

#[test]
fn a_progressive_spring_swings_as_its_equation_does() {
    let spline = progressive();
    let expected = integrated_one([0.4, 3.5], 1.3, |x, v, _| (-spline.at(x)[0] - 0.1 * v) / 0.5);
    let page = format!(
        "{}[[curve]]\nname = \"pull\"\npoints = {POINTS}\n[[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"turn\"\n\
         value = \"-pull(turn) - 0.1*turn rate\"\n",
        ROTOR.replace("rate = 1.5", "rate = 3.5")
    );
    for options in RUNS {
        near(&run(&page, options, "1.3"), expected, 2e-8, &format!("{options:?}"));
    }
    near(&run(&page, &["--method", "rodas4", "--tolerance", "1e-10"], "1.3"), expected, 2e-6, "rodas4");
}

/// The energy is the square of a curve: it acts by 2 f f'.
#[test]
fn a_potential_acts_by_the_slope_of_its_curve() {
    let spline = progressive();
    let expected = integrated_one([0.4, 1.5], 0.8, |x, v, _| {
        let [value, slope, _] = spline.at(x);
        let [drag, steepness, _] = spline.at(v);
        (-value * slope - 0.02 * drag * steepness) / 0.5
    });
    let page = format!(
        "{ROTOR}[[curve]]\nname = \"f\"\npoints = {POINTS}\n[[force]]\nname = \"well\"\nkind = \"potential\"\n\
         energy = \"0.5*f(turn)^2\"\n[[force]]\nname = \"loss\"\nkind = \"dissipation\"\n\
         power = \"0.02*f(turn rate)^2\"\n"
    );
    for options in RUNS {
        let run = run(&page, options, "0.8");
        near(&run, expected, 2e-8, &format!("{options:?}"));
        assert!(end(&run)[2].abs() < 1e-7, "{options:?}: {:?}", end(&run));
    }
}

/// `(I + m f'²) θ̈ + m f' f'' θ̇² + k f f' = 0`, as of a cam by formula.
#[test]
fn a_cam_of_a_table_lifts_as_its_curve_does() {
    let spline =
        Natural::through(&[(-2.0, 0.3), (0.0, 0.0), (0.7, 0.15), (1.5, 0.4), (2.2, 0.2), (3.0, 0.0)]);
    let expected = integrated_one([0.4, 1.5], 0.8, |x, v, _| {
        let [lift, slope, bend] = spline.at(x);
        -(0.4 * slope * bend * v * v + 20.0 * lift * slope) / (0.5 + 0.4 * slope * slope)
    });
    let page = format!(
        "{ROTOR}[[body]]\nname = \"follower\"\nmass = 0.4\ninertia = [1, 1, 1]\n[[joint]]\nname = \"lift\"\n\
         kind = \"prismatic\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\" }}\n\
         second = {{ body = \"follower\" }}\n[[force]]\nname = \"spring\"\nkind = \"spring\"\njoint = \"lift\"\n\
         stiffness = 20\n[[curve]]\nname = \"profile\"\n\
         points = [[-2, 0.3], [0, 0], [0.7, 0.15], [1.5, 0.4], [2.2, 0.2], [3, 0]]\n[[coupler]]\nname = \"cam\"\n\
         second = {{ joint = \"lift\" }}\nformula = \"profile(turn)\"\n"
    );
    for options in RUNS {
        let run = run(&page, options, "0.8");
        near(&run, expected, 2e-8, &format!("{options:?}"));
        assert!(end(&run)[2].abs() < 1e-7, "{options:?}");
    }
    near(&run(&page, &["--method", "rodas4", "--tolerance", "1e-10"], "0.8"), expected, 2e-6, "rodas4");
}

#[test]
fn a_motion_follows_a_curve_of_time() {
    let spline = progressive();
    let page = format!(
        "{}[[curve]]\nname = \"course\"\npoints = {POINTS}\n[[driver]]\nname = \"shaker\"\njoint = \"turn\"\n\
         motion = \"course(t) + 0.1*course(2*t - 0.2)\"\n[[output]]\nname = \"torque\"\nkind = \"driver\"\n\
         driver = \"shaker\"\n",
        ROTOR.replace("angle = 0.4\nrate = 1.5\n", "")
    );
    let ([x, _, bend], [y, _, other]) = (spline.at(0.8), spline.at(1.4));
    for options in RUNS {
        let run = run(&page, options, "0.8");
        assert!((end(&run)[0] - x - 0.1 * y).abs() < 1e-11, "{options:?}");
        let torque = run["outputs"]["torque"].as_f64().unwrap();
        assert!((torque - 0.5 * (bend + 0.4 * other)).abs() < 1e-9, "{options:?}: {torque}");
    }
}

/// Lines, steps and what is monotone, inside of the points and beyond them, by their definitions.
#[test]
fn kinds_of_curves_are_what_they_say() {
    let mut page = ROTOR.replace("rate = 1.5", "rate = 0");
    let kinds = ["monotone", "linear", "steps", "smooth"];
    for kind in kinds {
        for beyond in ["line", "hold"] {
            let _ = write!(
                page,
                "[[curve]]\nname = \"{kind}_{beyond}\"\npoints = [[0, 0], [1, 2], [2, 3]]\nbetween = \"{kind}\"\n\
                 beyond = \"{beyond}\"\n"
            );
            for (name, at) in [("inner", "turn + 0.1"), ("below", "turn - 1.4"), ("above", "turn + 2.6")] {
                let _ = write!(
                    page,
                    "[[output]]\nname = \"{kind}_{beyond}_{name}\"\nkind = \"formula\"\nof = \"{kind}_{beyond}({at})\"\n"
                );
            }
        }
    }
    // Slopes of the monotone one: 2.5, 4/3 and 0.5; of the spline 2.25, 1.5 and 0.75.
    let hermite = |u: f64, [y0, y1]: [f64; 2], [m0, m1]: [f64; 2]| {
        (2.0 * u * u * u - 3.0 * u * u + 1.0) * y0
            + (u * u * u - 2.0 * u * u + u) * m0
            + (3.0 * u * u - 2.0 * u * u * u) * y1
            + (u * u * u - u * u) * m1
    };
    let expected = |kind: &str, beyond: &str| {
        let [first, middle, last] = match kind {
            "monotone" => [2.5, 4.0 / 3.0, 0.5],
            "linear" => [2.0, 2.0, 1.0],
            "steps" => [0.0; 3],
            _ => [2.25, 1.5, 0.75],
        };
        let inner = match kind {
            "linear" => 1.0,
            "steps" => 0.0,
            _ => hermite(0.5, [0.0, 2.0], [first, middle]),
        };
        let out = if beyond == "hold" { 0.0 } else { 1.0 };
        [("inner", inner), ("below", -first * out), ("above", 3.0 + last * out)]
    };
    for options in RUNS {
        let run = run(&page, options, "0.01");
        for kind in kinds {
            for beyond in ["line", "hold"] {
                for (name, value) in expected(kind, beyond) {
                    let found = run["outputs"][format!("{kind}_{beyond}_{name}")].as_f64().unwrap();
                    assert!(
                        (found - value).abs() < 1e-12,
                        "{kind} {beyond} {name} {options:?}: {found} {value}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_curve_that_has_no_value_ends_a_run() {
    let folder = Folder::new("curve-ends");
    let page = format!(
        "{ROTOR}[[curve]]\nname = \"f\"\npoints = [[-1, 0], [0.6, 1]]\nbeyond = \"error\"\n[[force]]\nname = \"law\"\n\
         kind = \"motor\"\njoint = \"turn\"\nvalue = \"f(turn)\"\n"
    );
    fs::write(folder.0.join("page.toml"), page).unwrap();
    for options in RUNS {
        let ends = simulate(&folder, &[&["page.toml", "--t-end", "0.8"], options].concat());
        let said = String::from_utf8_lossy(&ends.stderr);
        assert!(!ends.status.success() && said.contains("t ="), "{options:?}: {said}");
        let output = simulate(&folder, &[&["page.toml", "--t-end", "0.1"], options].concat());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// In the process, in a program of its own, and in events that a program of its own looks for.
#[test]
fn bits_and_events_are_the_same_in_a_compiled_program() {
    let folder = Folder::new("curve-bits");
    let page = format!(
        "{ROTOR}[[curve]]\nname = \"f\"\npoints = {POINTS}\n[[curve]]\nname = \"g\"\npoints = {POINTS}\n\
         between = \"monotone\"\nbeyond = \"hold\"\n[[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"turn\"\n\
         value = \"-f(turn) - 0.1*g(turn rate)\"\n[[event]]\nname = \"high\"\nof = \"f(turn) - g(0.4)\"\nlevel = 0.1\n"
    );
    fs::write(folder.0.join("page.toml"), page).unwrap();
    let ran = |options: &[&str]| {
        let run = json(&folder, &[&["page.toml", "--t-end", "0.7", "--method", "rk4"], options].concat());
        (run["joints"].clone(), run["events"].clone())
    };
    let (joints, events) = ran(&[]);
    assert!(!events.as_array().unwrap().is_empty());
    assert_eq!((joints, events), ran(&["--engine", "generated"]));
}

/// Rows of a table cost a search, and no statements.
#[test]
fn a_long_table_takes_a_search_and_no_code() {
    let folder = Folder::new("curve-long");
    let statements = |n: u32| {
        let mut table = "x,y\n".to_owned();
        for k in 0..n {
            let x = f64::from(k) / f64::from(n - 1) * 8.0 - 4.0;
            let _ = writeln!(table, "{x},{}", 3.0 * x + x.powi(3));
        }
        fs::write(folder.0.join("table.csv"), table).unwrap();
        let page = format!(
            "{ROTOR}[[curve]]\nname = \"f\"\ntable = \"table.csv\"\ncolumns = [\"x\", \"y\"]\n[[force]]\nname = \"law\"\n\
             kind = \"motor\"\njoint = \"turn\"\nvalue = \"-f(turn)\"\n"
        );
        fs::write(folder.0.join("page.toml"), page).unwrap();
        let output = crate::support::xtask(&folder, &["generate", "page.toml", "--out", "page.rs"]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = fs::read_to_string(folder.0.join("page.rs")).unwrap();
        text.lines().filter(|line| line.contains("let ") || line.contains("spline")).count()
    };
    assert_eq!(statements(10), statements(100_000));
    let expected = integrated_one([0.4, 1.5], 0.5, |x, _, _| -(3.0 * x + x.powi(3)) / 0.5);
    let run = json(&folder, &["page.toml", "--t-end", "0.5", "--tolerance", "1e-10"]);
    near(&run, expected, 1e-6, "a long table");
}

#[test]
fn the_measured_spring_moves_as_its_equation_does() {
    let spring = Natural::through(&[
        (-0.08, -2600.0),
        (-0.05, -1050.0),
        (-0.02, -330.0),
        (0.0, 0.0),
        (0.02, 330.0),
        (0.05, 1050.0),
        (0.08, 2600.0),
        (0.1, 5000.0),
    ]);
    let damper = |v: f64| match v {
        v if v < -0.2 => -180.0 + 400.0 * (v + 0.2),
        v if v < 0.0 => 900.0 * v,
        v if v < 0.2 => 450.0 * v,
        v => 90.0 + 200.0 * (v - 0.2),
    };
    let expected = integrated_one([0.09, 0.0], 0.6, |x, v, _| -(spring.at(x)[0] + damper(v)) / 25.0 - 9.81);
    let found = joint(&example("progressive_spring", "0.6"), "travel");
    let is_near = |k: usize| (found[k] - expected[k]).abs() < 1e-9;
    assert!(is_near(0) && is_near(1), "{found:?} {expected:?}");
}
