//! Drivers along straight lines, whose velocities jump: exact motions between kinks, and the ledger of energy.

use crate::support::{Folder, json, refused, simulate, xtask};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;

/// Times and places of a saw-tooth, on beyond its ends; slopes between its rows.
struct Saw(Vec<[f64; 2]>);

impl Saw {
    fn random(random: &mut ChaCha8Rng, t_end: f64) -> Self {
        let mut rows = vec![[-0.1, 0.0]];
        while rows[rows.len() - 1][0] < t_end {
            let [t, _] = rows[rows.len() - 1];
            let place = random.random_range(-0.3..0.3);
            rows.push([t + random.random_range(0.1..0.6), (place * 1e3_f64).round() / 1e3]);
        }
        Self(rows)
    }

    fn write(&self, folder: &Folder, name: &str) {
        let mut text = "t,x\n".to_owned();
        self.0.iter().for_each(|[t, x]| _ = writeln!(text, "{t:?},{x:?}"));
        fs::write(folder.0.join(name), text).unwrap();
    }

    fn slope(&self, row: usize) -> f64 {
        (self.0[row + 1][1] - self.0[row][1]) / (self.0[row + 1][0] - self.0[row][0])
    }

    /// The kinks after zero, up to a time: when, and the velocities before and after.
    fn kinks(&self, t_end: f64) -> Vec<(f64, [f64; 2])> {
        let inner = (1..self.0.len() - 1).filter(|row| (0.0..=t_end).contains(&self.0[*row][0]));
        inner.map(|row| (self.0[row][0], [self.slope(row - 1), self.slope(row)])).collect()
    }
}

const HEAD: &str = "format = 1\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"ground\"\nfixed = true\n\
    [[body]]\nname = \"cart\"\nmass = 2\ninertia = [1, 1, 1]\n[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\n\
    axis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = { body = \"ground\" }\nsecond = { body = \"cart\" }\n\
    [[driver]]\nname = \"belt\"\njoint = \"rail\"\nmotion = { table = \"saw.csv\", between = \"linear\" }\n";

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn jumps(run: &Value) -> Vec<(f64, [f64; 2])> {
    let events = run["events"].as_array().unwrap().iter().filter(|event| event["what"] == "jumps");
    events.map(|event| (number(&event["t"]), [0, 1].map(|k: usize| number(&event["rates"][k])))).collect()
}

/// A pendulum on a driven cart: `(I + m l²) θ̈ = −m g l sin θ` between kinks, at which θ̇ jumps by
/// `−m l cos θ Δẋ / (I + m l²)`; by Kutta's method in steps of 1e-4 s.
fn pendulum([mass, length, inertia]: [f64; 3], saw: &Saw, [angle, rate]: [f64; 2], t_end: f64) -> [f64; 2] {
    let whole = inertia + mass * length * length;
    let slope = |[x, v]: [f64; 2]| [v, -mass * 9.81 * length * x.sin() / whole];
    let (mut y, mut t) = ([angle, rate], 0.0);
    let ends = saw.kinks(t_end).into_iter().chain([(t_end, [0.0; 2])]);
    for (end, [before, after]) in ends {
        let n = ((end - t) / 1e-4_f64).ceil().max(1.0);
        let h = (end - t) / n;
        for _ in 0..n as u32 {
            let ahead = |k: [f64; 2], part: f64| [y[0] + part * h * k[0], y[1] + part * h * k[1]];
            let a = slope(y);
            let b = slope(ahead(a, 0.5));
            let c = slope(ahead(b, 0.5));
            let d = slope(ahead(c, 1.0));
            y = [0, 1].map(|k: usize| y[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
        }
        y[1] -= mass * length * y[0].cos() * (after - before) / whole;
        t = end;
    }
    y
}

/// Engine, coordinates and method of a run, and the error that it may have.
const RUNS: [(&[&str], f64); 9] = [
    (&["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-11"], 1e-9),
    (&["--engine", "assembled", "--integrator", "tsit5", "--tolerance", "1e-9"], 1e-7),
    (
        &["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-11", "--correction", "none"],
        1e-9,
    ),
    (
        &["--engine", "jit", "--coordinates", "maximal", "--integrator", "dop853", "--tolerance", "1e-11"],
        1e-9,
    ),
    (
        &[
            "--engine",
            "jit",
            "--integrator",
            "dop853",
            "--tolerance",
            "1e-11",
            "--correction",
            "mass-weighted",
        ],
        1e-9,
    ),
    (&["--engine", "jit", "--coordinates", "joint", "--integrator", "dop853", "--tolerance", "1e-12"], 1e-10),
    (&["--engine", "jit", "--coordinates", "joint", "--integrator", "tsit5", "--tolerance", "1e-9"], 1e-7),
    (&["--engine", "jit", "--coordinates", "joint", "--integrator", "rodas4", "--tolerance", "1e-9"], 1e-6),
    (
        &[
            "--engine",
            "jit",
            "--correction",
            "baumgarte=50",
            "--integrator",
            "dop853",
            "--tolerance",
            "1e-11",
        ],
        1e-8,
    ),
];

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn a_pendulum_on_a_cart_that_jerks_is_right_by_all_engines_and_methods() {
    let folder = Folder::new("kinks");
    let mut random = ChaCha8Rng::seed_from_u64(2411);
    for (case, (run, close)) in RUNS.iter().cycle().take(18).enumerate() {
        let saw = Saw::random(&mut random, 2.0);
        saw.write(&folder, "saw.csv");
        let [mass, length, inertia] =
            [(0.5, 2.0), (0.2, 0.6), (0.01, 0.1)].map(|(a, b)| random.random_range(a..b));
        let [angle, rate] = [(-1.0, 1.0), (-3.0, 3.0)].map(|(a, b)| random.random_range(a..b));
        let text = format!(
            "name = \"jerks\"\n{HEAD}[simulation]\nt_end = 2\n[[body]]\nname = \"bob\"\nmass = {mass:?}\n\
             inertia = [{inertia:?}, {inertia:?}, {inertia:?}]\n[[joint]]\nname = \"hinge\"\nkind = \"revolute\"\n\
             axis = [0, 0, 1]\nzero = [0, -1, 0]\nfirst = {{ body = \"cart\" }}\n\
             second = {{ body = \"bob\", point = [0, {length:?}, 0] }}\nangle = {angle:?}\nrate = {rate:?}\n"
        );
        fs::write(folder.0.join("jerks.toml"), text).unwrap();
        let run = json(&folder, &[&["jerks.toml", "--effort", "quick"], *run].concat());
        let expected = pendulum([mass, length, inertia], &saw, [angle, rate], 2.0);
        let found = ["position", "rate"].map(|key| number(&run["joints"]["hinge"][key]));
        let error = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
        assert!(error < *close, "case {case}: {found:?} for {expected:?}");
        let drift = number(&run["energy_drift"]);
        assert!(drift < 10.0 * close, "case {case}: {drift:e}");
        let (jumps, kinks) = (jumps(&run), saw.kinks(2.0));
        assert!(jumps.len() == kinks.len() && kinks.len() > 2, "case {case}: {jumps:?} for {kinks:?}");
        for ((t, rates), (at, expected)) in jumps.iter().zip(&kinks) {
            let near = (0..2).all(|k| (rates[k] - expected[k]).abs() < 1e-12);
            assert!((t - at).abs() < 1e-15 && near, "case {case}: {jumps:?} for {kinks:?}");
        }
    }
}

/// A slider on the driven cart, pushed along it by a constant force, between stops.
struct Rider {
    mass: f64,
    push: f64,
    start: [f64; 2],
    ends: [f64; 2],
    restitution: f64,
}

impl Rider {
    fn write(&self) -> String {
        let Self { mass, push, start: [z, rate], ends: [lower, upper], restitution } = self;
        format!(
            "[[body]]\nname = \"rider\"\nmass = {mass:?}\ninertia = [1, 1, 1]\n[[joint]]\nname = \"slide\"\n\
             kind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = {{ body = \"cart\" }}\n\
             second = {{ body = \"rider\" }}\ndisplacement = {z:?}\nrate = {rate:?}\n[[force]]\nname = \"motor\"\n\
             kind = \"motor\"\njoint = \"slide\"\nvalue = {push:?}\n[[contact]]\nname = \"end\"\njoint = \"slide\"\n\
             lower = {lower:?}\nupper = {upper:?}\nrestitution = {restitution:?}\n"
        )
    }

    /// Where it is on the cart and how fast: parabolas, impacts, and jumps of −Δẋ at kinks, which a stop that it rests
    /// on may take up. Slow rebounds are none.
    fn exact(&self, saw: &Saw, t_end: f64) -> [f64; 2] {
        let ([mut z, mut v], a) = (self.start, self.push / self.mass);
        let (mut t, mut fastest) = (0.0, 0.0_f64);
        for (end, [before, after]) in saw.kinks(t_end).into_iter().chain([(t_end, [0.0; 2])]) {
            while t < end {
                let rests = v == 0.0 && (z == self.ends[0] && a < 0.0 || z == self.ends[1] && a > 0.0);
                if rests {
                    t = end;
                    continue;
                }
                let hit = |place: f64| {
                    let (b, c) = (v, z - place);
                    let root = (b * b - 2.0 * a * c).sqrt();
                    let q = -(b + root.copysign(b));
                    let roots = [q / a, 2.0 * c / q];
                    roots.into_iter().filter(|dt| *dt > 1e-13).fold(f64::INFINITY, f64::min)
                };
                let [lower, upper] = self.ends.map(hit);
                let dt = lower.min(upper);
                if t + dt >= end {
                    let dt = end - t;
                    (z, v, t) = (z + v * dt + 0.5 * a * dt * dt, v + a * dt, end);
                } else {
                    let speed = v + a * dt;
                    (z, t) = (self.ends[usize::from(upper < lower)], t + dt);
                    fastest = fastest.max(speed.abs());
                    let rebound = -self.restitution * speed;
                    v = if rebound.abs() <= 1e-12 * fastest { 0.0 } else { rebound };
                }
            }
            let jumped = v - (after - before);
            let into = z == self.ends[0] && jumped < 0.0 || z == self.ends[1] && jumped > 0.0;
            v = if v == 0.0 && into { 0.0 } else { jumped };
        }
        [z, v]
    }
}

#[test]
fn stops_on_a_cart_that_jerks_push_along() {
    let folder = Folder::new("kinks-stops");
    let mut random = ChaCha8Rng::seed_from_u64(2412);
    let (mut rests, mut hits) = (0, 0);
    for case in 0..24 {
        let saw = Saw::random(&mut random, 2.0);
        saw.write(&folder, "saw.csv");
        let mut between = |low: f64, high: f64| random.random_range(low..high);
        let rider = Rider {
            mass: between(0.5, 2.0),
            push: [-1.0, 1.0][case % 2] * between(2.0, 20.0),
            start: [between(-0.1, 0.1), between(-1.0, 1.0)],
            ends: [between(-0.4, -0.2), between(0.2, 0.4)],
            restitution: [0.0, 0.3, 0.5][case % 3],
        };
        let text = format!("name = \"rider\"\n{HEAD}[simulation]\nt_end = 2\n{}", rider.write());
        fs::write(folder.0.join("rider.toml"), text).unwrap();
        let method = [["dop853", "1e-11"], ["tsit5", "1e-10"]][case / 2 % 2];
        // In maximal coordinates a stop is on what only the system sees.
        let coordinates = ["joint", "maximal"][case / 4 % 2];
        let how =
            ["--engine", "jit", "--effort", "quick", "--coordinates", coordinates, "--integrator", method[0]];
        let run = json(&folder, &[&["rider.toml"], &how[..], &["--tolerance", method[1]]].concat());
        let expected = rider.exact(&saw, 2.0);
        let found = ["position", "rate"].map(|key| number(&run["joints"]["slide"][key]));
        let error = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
        assert!(error < 1e-9, "case {case}: {found:?} for {expected:?}\n{}", run["events"]);
        assert!(number(&run["energy_drift"]) < 1e-9, "case {case}: {}", run["energy_drift"]);
        let count = |what: &str| {
            let events = run["events"].as_array().unwrap().iter();
            events.filter(|event| event["what"].as_str().unwrap().starts_with(what)).count()
        };
        (rests, hits) = (rests + count("rests"), hits + count("hits"));
    }
    assert!(rests > 20 && hits > 100, "{rests} {hits}");
}

/// The stop is reached at 1 m/s at the very instant at which the cart is kicked: the rates after the kick rebound.
#[test]
fn a_stop_that_is_hit_at_a_kink_is_resolved_with_it() {
    let folder = Folder::new("kinks-at-once");
    fs::write(folder.0.join("saw.csv"), "t,x\n0,0\n0.25,0\n0.5,-0.125\n").unwrap();
    let ways = ["joint", "maximal"].map(|way| [("0.25", true, way), ("1", false, way)]);
    for (upper, kicked, coordinates) in ways.into_iter().flatten() {
        let text = format!(
            "name = \"rider\"\n{HEAD}[simulation]\nt_end = 0.25\n[[body]]\nname = \"rider\"\nmass = 1\n\
             inertia = [1, 1, 1]\n[[joint]]\nname = \"slide\"\nkind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\n\
             first = {{ body = \"cart\" }}\nsecond = {{ body = \"rider\" }}\nrate = 1\n[[contact]]\nname = \"end\"\n\
             joint = \"slide\"\nupper = {upper}\nrestitution = 0.5\n"
        );
        fs::write(folder.0.join("rider.toml"), text).unwrap();
        let how = ["rider.toml", "--engine", "jit", "--effort", "quick", "--coordinates", coordinates];
        let run = json(&folder, &[&how[..], &["--integrator", "dop853", "--tolerance", "1e-9"]].concat());
        // Kicked by 0.5 m/s backwards it goes at 1.5 m/s relative to the cart, into the stop or on.
        let expected = if kicked { -0.75 } else { 1.5 };
        let found = number(&run["joints"]["slide"]["rate"]);
        assert!((found - expected).abs() < 1e-12, "{found}: {}", run["events"]);
        assert!(number(&run["energy_drift"]) < 1e-12, "{}", run["energy_drift"]);
    }
}

/// Chains under a driven joint and on a driven body: two engines, two kinds of coordinates, and the energy's ledger.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_driven_chains_agree_and_keep_their_ledger() {
    let folder = Folder::new("kinks-chains");
    let mut random = ChaCha8Rng::seed_from_u64(2413);
    let mut n_jumps = 0;
    for case in 0..5 {
        Saw::random(&mut random, 1.0).write(&folder, "saw.csv");
        Saw::random(&mut random, 1.0).write(&folder, "tilt.csv");
        let mut text =
            "format = 1\nname = \"chain\"\ngravity = [0, -9.81, 0]\n[simulation]\nt_end = 1\n".to_owned();
        if case % 2 == 0 {
            text.push_str("[[body]]\nname = \"base\"\nfixed = true\n");
        } else {
            text.push_str(
                "[[body]]\nname = \"base\"\n[body.driven]\ntranslation = [{ table = \"saw.csv\", between = \"linear\" }, 0, \
                 { product = [0.5, { table = \"tilt.csv\", between = \"linear\" }] }]\n\
                 rotations = [{ axis = [0, 0, 1], angle = { table = \"tilt.csv\", between = \"linear\" } }]\n",
            );
        }
        for k in 0..3 {
            let before = if k == 0 { "base".to_owned() } else { format!("body_{}", k - 1) };
            let mut between = |low: f64, high: f64| random.random_range(low..high);
            let axis = [between(-1.0, 1.0), between(-1.0, 1.0), between(0.3, 1.0)];
            let is_driven = case % 2 == 0 && k == case / 2 % 3;
            let start = format!("angle = {:?}\nrate = {:?}\n", between(-1.0, 1.0), between(-2.0, 2.0));
            let _ = write!(
                text,
                "[[body]]\nname = \"body_{k}\"\nmass = {:?}\ninertia = [0.02, 0.015, 0.018]\n[[joint]]\n\
                 name = \"joint_{k}\"\nkind = \"revolute\"\naxis = {axis:?}\nzero = [{:?}, 0, {:?}]\n\
                 first = {{ body = \"{before}\", point = [0, {:?}, 0] }}\n\
                 second = {{ body = \"body_{k}\", point = [0.02, 0.15, 0] }}\n{}",
                between(0.3, 1.5),
                axis[2],
                -axis[0],
                if k == 0 { 0.0 } else { -0.15 },
                if is_driven { "" } else { &start }
            );
            if is_driven {
                let _ = write!(
                    text,
                    "[[driver]]\nname = \"drive\"\njoint = \"joint_{k}\"\n\
                     motion = {{ sum = [{{ sinusoid = {{ amplitude = 0.2, angular_frequency = 3 }} }}, \
                     {{ table = \"tilt.csv\", between = \"linear\" }}] }}\n"
                );
            }
        }
        fs::write(folder.0.join("chain.toml"), &text).unwrap();
        if case < 2 {
            let proved = xtask(&folder, &["generate", "chain.toml", "--out", "chain.rs"]);
            assert!(proved.status.success(), "{}", String::from_utf8_lossy(&proved.stderr));
        }
        let how = ["--effort", "quick", "--integrator", "dop853", "--tolerance", "1e-12"];
        let run = |args: &[&str]| json(&folder, &[&["chain.toml"], &how[..], args].concat());
        let [assembled, maximal, joint] = [
            run(&["--engine", "assembled"]),
            run(&["--engine", "jit", "--coordinates", "maximal"]),
            run(&["--engine", "jit", "--coordinates", "joint"]),
        ];
        for k in 0..3 {
            for key in ["position", "rate"] {
                let [a, b, c] = [&assembled, &maximal, &joint]
                    .map(|run| number(&run["joints"][format!("joint_{k}")][key]));
                assert!((a - c).abs() < 1e-8 && (b - c).abs() < 1e-8, "case {case}: {a} {b} {c}\n{text}");
            }
        }
        for run in [&assembled, &maximal, &joint] {
            assert!(number(&run["energy_drift"]) < 1e-9, "case {case}: {}\n{text}", run["energy_drift"]);
            n_jumps += jumps(run).len();
        }
    }
    assert!(n_jumps > 60, "{n_jumps}");
}

#[test]
fn what_cannot_follow_kinks_says_so() {
    let folder = Folder::new("kinks-refused");
    fs::write(folder.0.join("saw.csv"), "t,x\n0,0\n0.25,0.1\n0.5,-0.125\n").unwrap();
    fs::write(folder.0.join("belt.toml"), format!("name = \"belt\"\n{HEAD}")).unwrap();
    refused(
        &xtask(&folder, &["export", "c", "belt.toml", "--out", "c"]),
        "cannot follow a motion along straight lines",
    );
    let run = |args: &[&str]| simulate(&folder, &[&["belt.toml"], args].concat());
    refused(&run(&["--input", "belt_rate=1"]), "this is part of the motion of `belt`");
    let wrong = HEAD.replace("\"linear\"", "\"held\"");
    fs::write(folder.0.join("belt.toml"), format!("name = \"belt\"\n{wrong}")).unwrap();
    refused(&run(&[]), "unknown way between rows `held`");
}
