//! Bushings, against closed forms and against the equations of motion typed and integrated here.

use crate::support::{Folder, json, simulate, xtask};
use serde_json::Value;
use std::array::from_fn;
use std::fmt::Write;
use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

const RUNS: [&[&str]; 3] = [
    &["--integrator", "dop853", "--tolerance", "1e-13"],
    &["--coordinates", "maximal", "--integrator", "dop853", "--tolerance", "1e-13"],
    &["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-13"],
];

const AXES: [&str; 3] = ["x", "y", "z"];

/// A body of 2 kg on a bushing to the ground, as these lines start it and hold it.
fn page(start: &str, strengths: &str) -> String {
    format!(
        "format = 1\nname = \"mounted\"\n[[body]]\nname = \"ground\"\nfixed = true\n[[body]]\nname = \"block\"\n\
         free = true\nmass = 2\ninertia = [0.3, 0.4, 0.5]\n{start}\n[[force]]\nname = \"rubber\"\nkind = \"bushing\"\n\
         first = {{ body = \"ground\" }}\nsecond = {{ body = \"block\" }}\n{strengths}\n[[output]]\nname = \"seen\"\n\
         kind = \"bushing\"\nforce = \"rubber\"\n"
    )
}

fn run(page: &str, options: &[&str], t_end: f64) -> Value {
    static RUNS: AtomicUsize = AtomicUsize::new(0);
    let folder = Folder::new(&format!("bushings-{}", RUNS.fetch_add(1, Ordering::Relaxed)));
    fs::write(folder.0.join("page.toml"), page).unwrap();
    json(&folder, &[&["page.toml", "--t-end", &t_end.to_string()], options].concat())
}

fn numbers(run: &Value, output: &str) -> Vec<f64> {
    run["outputs"][output].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn all_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let is_near = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance * b.abs().max(1.0);
    let fits = found.len() == expected.len() && found.iter().zip(expected).all(is_near);
    assert!(fits, "{what}:\n{found:?} for\n{expected:?}");
}

/// `m ẍ + c ẋ + k x = 0` from rest at x0.
fn swung([m, c, k]: [f64; 3], x0: f64, t: f64) -> f64 {
    let (decay, natural) = (c / (2.0 * m), k / m);
    let w = (natural - decay * decay).sqrt();
    x0 * (-decay * t).exp() * ((w * t).cos() + decay / w * (w * t).sin())
}

/// The list of three numbers of which one is not zero.
fn only(k: usize, value: f64) -> String {
    format!("{:?}", from_fn::<_, 3, _>(|l| if l == k { value } else { 0.0 }))
}

#[test]
fn along_one_axis_a_body_swings_as_on_a_spring() {
    for k in 0..3 {
        let strengths = "stiffness = [50, 60, 70]\ndamping = [1, 0.5, 2]\ntorsion = [1, 2, 3]";
        let page = page(&format!("position = {}", only(k, 0.6)), strengths);
        let law = [2.0, [1.0, 0.5, 2.0][k], [50.0, 60.0, 70.0][k]];
        for options in RUNS {
            let run = run(&page, options, 1.7);
            let mut expected = vec![0.0; 12];
            expected[k] = swung(law, 0.6, 1.7);
            let rate = (swung(law, 0.6, 1.7 + 1e-5) - swung(law, 0.6, 1.7 - 1e-5)) / 2e-5;
            expected[6 + k] = -law[2] * expected[k] - law[1] * rate;
            all_near(&numbers(&run, "seen"), &expected, 1e-8, AXES[k]);
            assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-10, "{options:?}");
        }
    }
}

/// Through large angles: the torsion is linear in the angle, and so is the motion.
#[test]
fn about_one_axis_a_body_turns_as_on_a_torsion_spring() {
    for (k, angle) in [(0, 2.8_f64), (1, 1.4), (2, -2.8)] {
        let turn = only(k, (angle / 2.0).sin());
        let orientation = format!("orientation = [{:?}, {}", (angle / 2.0).cos(), &turn[1..]);
        let strengths = "stiffness = [50, 60, 70]\ntorsion = [5, 6, 7]\ntorsional_damping = [0.1, 0.05, 0.2]";
        let law = [[0.3, 0.4, 0.5][k], [0.1, 0.05, 0.2][k], [5.0, 6.0, 7.0][k]];
        for options in RUNS {
            let run = run(&page(&orientation, strengths), options, 1.3);
            let mut expected = vec![0.0; 12];
            expected[3 + k] = swung(law, angle, 1.3);
            let rate = (swung(law, angle, 1.3 + 1e-5) - swung(law, angle, 1.3 - 1e-5)) / 2e-5;
            expected[9 + k] = -law[2] * expected[3 + k] - law[1] * rate;
            all_near(&numbers(&run, "seen"), &expected, 1e-8, AXES[k]);
            assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-10, "{options:?}");
        }
    }
}

/// Small motions in all six directions at once are six oscillations.
#[test]
fn small_motions_do_not_know_of_each_other() {
    let start = "position = [1e-6, -2e-6, 3e-6]\norientation = [1, 1e-6, -5e-7, 2e-6]";
    let page = page(start, "stiffness = [50, 60, 70]\ntorsion = [5, 6, 7]");
    let (x0, k) = ([1e-6, -2e-6, 3e-6, 2e-6, -1e-6, 4e-6], [50.0, 60.0, 70.0, 5.0, 6.0, 7.0]);
    let m = [2.0, 2.0, 2.0, 0.3, 0.4, 0.5];
    for options in RUNS {
        let found: Vec<f64> =
            numbers(&run(&page, options, 1.1), "seen").iter().take(6).map(|x| x * 1e6).collect();
        let expected: [f64; 6] = from_fn(|l| 1e6 * swung([m[l], 0.0, k[l]], x0[l], 1.1));
        all_near(&found, &expected, 3e-5, "six");
    }
}

#[test]
fn a_preload_is_held() {
    let gravity = "gravity = [0, 0, -9.81]\n";
    let held =
        page("", "stiffness = [10, 10, 10]\nforce = [0, 0, 19.62]\ntorque = [0, 0, \"-3*sin(angle_z)\"]");
    let held = held.replacen("[[body]]", &format!("{gravity}[[body]]"), 1);
    let pushed = page("", "stiffness = [50, 0, 0]\nforce = [5, 0, 0]");
    for options in RUNS {
        all_near(&numbers(&run(&held, options, 3.0), "seen")[..6], &[0.0; 6], 1e-12, "at rest");
        let expected = 0.1 * (1.0 - (5.0_f64 * 0.7).cos());
        let run = run(&pushed, options, 0.7);
        all_near(&numbers(&run, "seen")[..1], &[expected], 1e-11, "pushed");
        assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-11, "{options:?}");
    }
}

/// `m ÿ + k y = k 0.1 sin(5 t)` on a base that is driven, whose work is counted.
#[test]
fn a_base_that_is_driven_shakes_the_body() {
    let page = page("", "stiffness = [0, 60, 0]\ntorsion = [1, 1, 1]").replacen(
        "fixed = true",
        "driven = { translation = [0, \"0.1*sin(5*t)\", 0] }",
        1,
    );
    let (natural, t) = (30.0_f64, 0.9_f64);
    let amplitude = 0.1 * natural / (natural - 25.0);
    let w = natural.sqrt();
    let y = amplitude * ((5.0 * t).sin() - 5.0 / w * (w * t).sin());
    // From rest in space: the base moves at once.
    for options in RUNS {
        let run = run(&page, options, t);
        all_near(&numbers(&run, "seen")[1..2], &[y - 0.1 * (5.0 * t).sin()], 1e-10, "shaken");
        assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-10, "{options:?}");
    }
}

type Vector = [f64; 3];
type Matrix = [Vector; 3];

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn cross(a: Vector, b: Vector) -> Vector {
    from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

fn sum(a: Vector, b: Vector) -> Vector {
    from_fn(|k| a[k] + b[k])
}

fn applied(m: Matrix, v: Vector) -> Vector {
    from_fn(|k| dot(&m[k], &v))
}

fn transposed(m: Matrix) -> Matrix {
    from_fn(|k| from_fn(|l| m[l][k]))
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    from_fn(|k| from_fn(|l| dot(&a[k], &transposed(b)[l])))
}

/// Of Euler parameters of any length, by `A v = v + 2 e × (e × v + e0 v)`, divided by their square.
fn rotation(p: [f64; 4]) -> Matrix {
    let (e0, e) = (p[0], [p[1], p[2], p[3]]);
    let square = dot(&p, &p);
    let column = |v: Vector| {
        let inner = sum(cross(e, v), v.map(|x| e0 * x));
        sum(v, cross(e, inner).map(|x| 2.0 * x / square))
    };
    transposed([column([1.0, 0.0, 0.0]), column([0.0, 1.0, 0.0]), column([0.0, 0.0, 1.0])])
}

/// Position, Euler parameters, velocity and angular velocity in the body's frame.
#[derive(Clone, Copy)]
struct Body {
    r: Vector,
    p: [f64; 4],
    v: Vector,
    w: Vector,
    mass: f64,
    inertia: Vector,
}

impl Body {
    /// A little further along one of its six velocities.
    fn moved(self, k: usize, by: f64) -> Self {
        let mut other = self;
        if k < 3 {
            other.r[k] += by;
        } else {
            let rate = turning(self.p, from_fn(|l| if l == k - 3 { by } else { 0.0 }));
            other.p = from_fn(|l| self.p[l] + rate[l]);
        }
        other
    }

    fn linear_momentum(&self) -> Vector {
        self.v.map(|v| self.mass * v)
    }

    fn angular_momentum(&self) -> Vector {
        let spin = applied(rotation(self.p), from_fn(|k| self.inertia[k] * self.w[k]));
        sum(cross(self.r, self.linear_momentum()), spin)
    }
}

/// `ṗ = ½ p ∘ (0, w)`.
fn turning(p: [f64; 4], w: Vector) -> [f64; 4] {
    let e = [p[1], p[2], p[3]];
    let [x, y, z] = sum(cross(e, w), w.map(|x| p[0] * x));
    [-dot(&e, &w), x, y, z].map(|x| x / 2.0)
}

/// A point of a body, and how the axes there are turned.
type Frame = (Vector, [f64; 4]);

const FRAMES: [Frame; 2] =
    [([0.1, 0.2, -0.3], [1.0, 0.2, -0.1, 0.3]), ([-0.2, 0.05, 0.15], [1.0, 0.6, -0.4, 0.2])];

/// Components of the line between the frames and the Cardan angles between them.
fn readings(bodies: &[Body; 2]) -> [f64; 6] {
    let place = |k: usize| sum(bodies[k].r, applied(rotation(bodies[k].p), FRAMES[k].0));
    let axes = |k: usize| product(rotation(bodies[k].p), rotation(FRAMES[k].1));
    let (from, to) = (place(0), place(1));
    let [x, y, z] = applied(transposed(axes(0)), from_fn(|k| to[k] - from[k]));
    let m = product(transposed(axes(0)), axes(1));
    [x, y, z, (-m[1][2]).atan2(m[2][2]), m[0][2].asin(), (-m[0][1]).atan2(m[0][0])]
}

/// The forces along the readings of the bushing below.
fn forces(u: [f64; 6], rate: [f64; 6]) -> [f64; 6] {
    let (k, c) = ([40.0, 50.0, 30.0, 4.0, 5.0, 3.0], [1.0, 0.0, 2.0, 0.05, 0.1, 0.0]);
    let mut f: [f64; 6] = from_fn(|l| -k[l] * u[l] - c[l] * rate[l]);
    f[0] += -3.0 - 100.0 * u[0].powi(3);
    f[1] += u[3] * rate[2];
    f[5] += -3.0 * u[5].sin() + 0.2 * rate[4];
    f
}

const STRENGTHS: &str = "stiffness = [40, 50, 30]\ndamping = [1, 0, 2]\ntorsion = [4, 5, 3]\n\
    torsional_damping = [0.05, 0.1, 0]\nforce = [\"-3 - 1e2*x^3\", \"angle_x*z rate\", 0]\n\
    torque = [0, 0, \"-3*sin(angle_z) + 0.2*angle_y rate\"]";

const BODIES: [Body; 2] = [
    Body {
        r: [0.3, -0.1, 0.2],
        p: [1.0, 0.1, -0.2, 0.05],
        v: [0.2, -0.4, 0.1],
        w: [0.5, -1.0, 0.7],
        mass: 1.5,
        inertia: [0.11, 0.14, 0.2],
    },
    Body {
        r: [0.2, 0.3, -0.2],
        p: [1.0, -0.2, 0.3, 0.1],
        v: [-0.1, 0.2, 0.3],
        w: [-1.2, 0.4, 0.9],
        mass: 0.8,
        inertia: [0.07, 0.05, 0.06],
    },
];

/// Both bodies, free, with a bushing between them.
fn pair(strengths: &str) -> String {
    let mut page = "format = 1\nname = \"pair\"\n[[body]]\nname = \"ground\"\nfixed = true\n".to_owned();
    for (name, body) in ["first", "second"].into_iter().zip(&BODIES) {
        let Body { r, p, v, w, mass, inertia } = body;
        write!(
            page,
            "[[body]]\nname = \"{name}\"\nfree = true\nmass = {mass}\ninertia = {inertia:?}\nposition = {r:?}\n\
             orientation = {p:?}\nvelocity = {v:?}\nangular_velocity = {w:?}\n[[output]]\nname = \"{name}_at\"\n\
             kind = \"pose\"\nbody = \"{name}\"\n[[output]]\nname = \"{name}_moves\"\nkind = \"velocity\"\n\
             body = \"{name}\"\n"
        )
        .unwrap();
    }
    page += "[[force]]\nname = \"rubber\"\nkind = \"bushing\"\n";
    for (side, (name, (point, p))) in
        ["first", "second"].into_iter().zip(["first", "second"].iter().zip(FRAMES))
    {
        writeln!(page, "{side} = {{ body = \"{name}\", point = {point:?}, orientation = {p:?} }}").unwrap();
    }
    page + strengths + "\n"
}

/// Both bodies at the end of a run.
fn ends(run: &Value) -> [Body; 2] {
    from_fn(|k| {
        let name = ["first", "second"][k];
        let (at, moves) = (numbers(run, &format!("{name}_at")), numbers(run, &format!("{name}_moves")));
        Body {
            r: from_fn(|l| at[l]),
            p: from_fn(|l| at[3 + l]),
            v: from_fn(|l| moves[l]),
            w: from_fn(|l| moves[3 + l]),
            ..BODIES[k]
        }
    })
}

/// What both bodies are accelerated by. The readings are differentiated in differences, and the forces have along each
/// unit velocity the power of the forces along the readings.
fn acceleration(bodies: &[Body; 2]) -> [[Vector; 2]; 2] {
    const STEP: f64 = 1e-3;
    let slopes: [[[f64; 6]; 6]; 2] = from_fn(|end| {
        from_fn(|k| {
            let at = |by: f64| {
                let mut moved = *bodies;
                moved[end] = bodies[end].moved(k, by);
                readings(&moved)
            };
            // To the sixth order in the step.
            let [a, b, c] = [1.0, 2.0, 3.0].map(|n| (at(n * STEP), at(-n * STEP)));
            from_fn(|l| {
                let [a, b, c] = [a, b, c].map(|(after, before)| after[l] - before[l]);
                (45.0 * a - 9.0 * b + c) / (60.0 * STEP)
            })
        })
    });
    let velocity = |end: usize, k: usize| if k < 3 { bodies[end].v[k] } else { bodies[end].w[k - 3] };
    let rate: [f64; 6] = from_fn(|l| (0..12).map(|i| slopes[i / 6][i % 6][l] * velocity(i / 6, i % 6)).sum());
    let f = forces(readings(bodies), rate);
    from_fn(|end| {
        let load: [f64; 6] = from_fn(|k| dot(&slopes[end][k], &f));
        let Body { w, mass, inertia, .. } = bodies[end];
        let gyroscopic = cross(w, from_fn(|k| inertia[k] * w[k]));
        [from_fn(|k| load[k] / mass), from_fn(|k| (load[3 + k] - gyroscopic[k]) / inertia[k])]
    })
}

/// Of each body the rates of position and Euler parameters, and of its velocities.
type Slope = [([f64; 7], [Vector; 2]); 2];

/// By Kutta's method.
fn integrated(mut bodies: [Body; 2], t_end: f64) -> [Body; 2] {
    for body in &mut bodies {
        let length = dot(&body.p, &body.p).sqrt();
        body.p = body.p.map(|e| e / length);
    }
    let n = 3000;
    let h = t_end / f64::from(n);
    let slope = |bodies: &[Body; 2]| -> Slope {
        let accelerations = acceleration(bodies);
        from_fn(|end| {
            let Body { p, v, w, .. } = bodies[end];
            let rate = turning(p, w);
            (from_fn(|k| if k < 3 { v[k] } else { rate[k - 3] }), accelerations[end])
        })
    };
    let moved = |bodies: &[Body; 2], slope: &Slope, by: f64| -> [Body; 2] {
        from_fn(|end| {
            let (body, (place, [v, w])) = (bodies[end], slope[end]);
            Body {
                r: from_fn(|k| body.r[k] + by * place[k]),
                p: from_fn(|k| body.p[k] + by * place[3 + k]),
                v: from_fn(|k| body.v[k] + by * v[k]),
                w: from_fn(|k| body.w[k] + by * w[k]),
                ..body
            }
        })
    };
    for _ in 0..n {
        let a = slope(&bodies);
        let b = slope(&moved(&bodies, &a, h / 2.0));
        let c = slope(&moved(&bodies, &b, h / 2.0));
        let d = slope(&moved(&bodies, &c, h));
        for (slope, share) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            bodies = moved(&bodies, &slope, h * share / 6.0);
        }
    }
    bodies
}

#[test]
fn two_bodies_move_as_newton_and_euler_say() {
    let expected = integrated(BODIES, 0.6);
    for options in RUNS {
        let run = run(&pair(STRENGTHS), options, 0.6);
        for (found, expected) in ends(&run).iter().zip(&expected) {
            let same = if dot(&found.p, &expected.p) < 0.0 { -1.0 } else { 1.0 };
            let flat =
                |body: &Body, sign: f64| [&body.r[..], &body.p.map(|e| sign * e), &body.v, &body.w].concat();
            all_near(&flat(found, same), &flat(expected, 1.0), 3e-9, &format!("{options:?}"));
        }
        assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-10, "{options:?}");
    }
}

/// Action and reaction: what acts between two bodies changes neither of their momenta.
#[test]
fn momenta_are_kept() {
    let both = |bodies: &[Body; 2]| {
        let [linear, angular] =
            [Body::linear_momentum, Body::angular_momentum].map(|of| sum(of(&bodies[0]), of(&bodies[1])));
        [linear, angular].concat()
    };
    for strengths in [STRENGTHS, "stiffness = [40, 50, 30]\ntorsion = [4, 5, 3]"] {
        for options in RUNS {
            let run = run(&pair(strengths), options, 2.0);
            all_near(&both(&ends(&run)), &both(&BODIES), 2e-12, &format!("{options:?}"));
            assert!(run["energy_drift"].as_f64().unwrap().abs() < 1e-10, "{options:?}");
        }
    }
}

/// A formula takes the operations of the key that is built in, and what is not used takes none.
#[test]
fn formulas_cost_what_keys_do() {
    let folder = Folder::new("bushing-costs");
    let rows = |name: &str, strengths: &str, wanted: &[&str]| {
        // Without the output, which tells all of it.
        let page = page("", strengths);
        let page = page.split("[[output]]").next().unwrap();
        fs::write(folder.0.join(format!("{name}.toml")), page).unwrap();
        let (file, out) = (format!("{name}.toml"), format!("{name}.rs"));
        let output = xtask(&folder, &["generate", &file, "--out", &out]);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = fs::read_to_string(folder.0.join(out)).unwrap();
        let rows = text.lines().filter(|line| wanted.iter().any(|row| line.contains(&format!("| {row} |"))));
        let rows: Vec<_> = rows.map(str::to_owned).collect();
        assert_eq!(rows.len(), wanted.len(), "{rows:?}");
        (rows, text)
    };
    let (spring, text) = rows("spring", "stiffness = [7, 0, 0]", &["joint_accelerations"]);
    assert_eq!(spring, rows("pull", "force = [\"-7*x\", 0, 0]", &["joint_accelerations"]).0);
    assert!(!text.contains("atan2"), "no angle is asked for");
    let both = ["joint_accelerations", "joint_derivative"];
    let damper = rows("damper", "damping = [7, 0, 0]", &both).0;
    assert_eq!(damper, rows("drag", "force = [\"-7*x rate\", 0, 0]", &both).0);
    let torsion = rows("torsion", "torsion = [0, 0, 7]", &["joint_accelerations"]).0;
    assert_eq!(torsion, rows("turn", "torque = [0, 0, \"-7*angle_z\"]", &["joint_accelerations"]).0);
}

/// Half a turn is on the border of an angle, where it has no value.
#[test]
fn a_run_ends_where_an_angle_does() {
    let folder = Folder::new("bushing-pole");
    let page = page("orientation = [0, 0, 1, 0]", "torsion = [1, 1, 1]");
    fs::write(folder.0.join("page.toml"), page).unwrap();
    for options in RUNS {
        let output = simulate(&folder, &[&["page.toml", "--t-end", "0.8"], options].concat());
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && said.contains("t ="), "{options:?}: {said}");
    }
}
