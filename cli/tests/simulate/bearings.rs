//! Friction in proportion to reactions, in model files: blocks on inclines and a pendulum in a bearing against their
//! own equations, random chains and a loop against the law and the energy.

use crate::contacts::chain;
use crate::support::{Folder, json, refused, simulate};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;

const GRAVITY: f64 = 9.81;
const JOINT: [&str; 6] = ["--engine", "jit", "--effort", "quick", "--coordinates", "joint"];
const FINE: [&str; 4] = ["--integrator", "dop853", "--tolerance", "1e-12"];

fn head(name: &str, t_end: f64) -> String {
    format!(
        "format = 1\nname = \"{name}\"\ngravity = [0, -9.81, 0]\n[simulation]\nt_end = {t_end:?}\n[[body]]\nname = \"ground\"\n\
         fixed = true\n"
    )
}

fn run(folder: &Folder, name: &str, text: &str, method: &[&str]) -> Value {
    let file = format!("{name}.toml");
    fs::write(folder.0.join(&file), text).unwrap();
    json(folder, &[&[&file[..]], &JOINT[..], method].concat())
}

/// Position and rate of a joint at the end.
fn end(run: &Value, joint: &str) -> [f64; 2] {
    ["position", "rate"].map(|key| run["joints"][joint][key].as_f64().unwrap())
}

/// A block that is pushed up an incline along this direction; friction has a constant level besides.
struct Block {
    along: [f64; 3],
    rate: f64,
    mass: f64,
    levels: [f64; 2],
    coefficients: [f64; 2],
}

impl Block {
    fn text(&self) -> String {
        let Self { along: [a, b, c], rate, mass, levels, coefficients } = self;
        let mut text = head("block", 3.0);
        let _ = write!(
            text,
            "[[body]]\nname = \"block\"\nmass = {mass:?}\ninertia = [0.1, 0.2, 0.3]\n[[joint]]\nname = \"slide\"\n\
             kind = \"prismatic\"\naxis = [{a:?}, {b:?}, {c:?}]\nzero = [{:?}, {a:?}, 0]\n\
             first = {{ body = \"ground\" }}\nsecond = {{ body = \"block\", point = [0, 0.1, 0] }}\nrate = {rate:?}\n\
             [[contact]]\nname = \"guide\"\njoint = \"slide\"\nfriction = {:?}\nstatic_friction = {:?}\n\
             friction_coefficient = {:?}\nstatic_friction_coefficient = {:?}\n\
             [[output]]\nname = \"felt\"\nkind = \"acceleration\"\nbody = \"block\"\n",
            -b, levels[0], levels[1], coefficients[0], coefficients[1]
        );
        text
    }

    /// Position and rate after a time: up to where it stops, and back if it does not stay there.
    fn exact(&self, t: f64) -> [f64; 2] {
        let [a, b, c] = self.along;
        let slope = b / (a * a + b * b + c * c).sqrt();
        let [down, normal] = [GRAVITY * slope, GRAVITY * (1.0 - slope * slope).sqrt()];
        let [kinetic, at_rest] = [0, 1].map(|k| self.levels[k] / self.mass + self.coefficients[k] * normal);
        let slows = down + kinetic;
        let stops = self.rate / slows;
        if t < stops {
            return [self.rate * t - 0.5 * slows * t * t, self.rate - slows * t];
        }
        let top = 0.5 * self.rate * stops;
        if down <= at_rest {
            return [top, 0.0];
        }
        let (t, quickens) = (t - stops, down - kinetic);
        [top - 0.5 * quickens * t * t, -quickens * t]
    }
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn blocks_on_inclines_rub_by_the_normal_force() {
    let folder = Folder::new("inclines");
    let mut sticking = 0;
    for (case, (along, levels, coefficients)) in [
        ([0.8, 0.6, 0.0], [0.0; 2], [0.3, 0.8]),
        ([0.8, 0.6, 0.0], [0.0; 2], [0.3, 0.5]),
        ([0.48, 0.64, 0.6], [0.7, 0.9], [0.2, 0.3]),
        ([0.48, 0.64, 0.6], [0.7, 0.9], [0.2, 0.9]),
        ([3.0, 1.0, -2.0], [0.0; 2], [0.25, 0.28]),
        ([3.0, 1.0, -2.0], [1.5, 1.5], [0.25, 0.25]),
    ]
    .into_iter()
    .enumerate()
    {
        for (mass, rate) in [(1.0, 4.0), (7.5, 9.0)] {
            let block = Block { along, rate, mass, levels, coefficients };
            let text = block.text();
            for (method, limit) in
                [(&FINE[..], 1e-10), (&["--integrator", "tsit5", "--tolerance", "1e-6"], 1e-6)]
            {
                let run = run(&folder, &format!("block-{case}"), &text, method);
                let (found, expected) = (end(&run, "slide"), block.exact(3.0));
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < limit, "case {case}: {found} for {expected}");
                }
                assert!(
                    run["energy_drift"].as_f64().unwrap() < limit,
                    "case {case}: {}",
                    run["energy_drift"]
                );
                if expected[1] == 0.0 {
                    sticking += 1;
                    assert_eq!(found[1], 0.0, "case {case}");
                }
            }
        }
    }
    assert_eq!(sticking, 14, "of 24 runs so many end at rest");
}

/// What outputs tell is what friction has made of them: at rest a block is not accelerated.
#[test]
fn outputs_know_of_the_forces_of_contacts() {
    let folder = Folder::new("felt");
    let block =
        Block { along: [0.8, 0.6, 0.0], rate: 4.0, mass: 2.0, levels: [0.5, 0.6], coefficients: [0.3, 0.8] };
    fs::write(folder.0.join("block.toml"), block.text()).unwrap();
    let output = simulate(&folder, &[&["block.toml", "--out", "out"], &JOINT[..], &FINE].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = fs::read_to_string(folder.0.join("out/block.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let columns: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let place = |name: &str| {
        columns
            .iter()
            .position(|column| column.starts_with(name))
            .unwrap_or_else(|| panic!("{name}: {columns:?}"))
    };
    let names = [
        "t ",
        "slide rate",
        "felt.ax",
        "felt.ay",
        "guide.force_f",
        "guide.force_g",
        "guide.force_h",
        "input guide",
    ];
    let places = names.map(place);
    let slows = GRAVITY * 0.6 + 0.5 / 2.0 + 0.3 * GRAVITY * 0.8;
    let (mut moving, mut resting) = (0, 0);
    for row in reader.records() {
        let row = row.unwrap();
        let [t, rate, ax, ay, f, g, h, force] = places.map(|place| row[place].parse::<f64>().unwrap());
        let expected = if rate == 0.0 { 0.0 } else { -slows };
        assert!((0.8 * ax + 0.6 * ay - expected).abs() < 1e-9, "at {t}: {ax} {ay} for {expected}");
        assert!((f.hypot(g) - 2.0 * GRAVITY * 0.8).abs() < 1e-9 && h.abs() < 1e-9, "at {t}: {f} {g} {h}");
        let weight = 2.0 * GRAVITY * 0.6;
        let expected = if rate == 0.0 { weight } else { weight - 2.0 * slows };
        assert!((force - expected).abs() < 1e-9, "at {t}: {force} for {expected}");
        *(if rate == 0.0 { &mut resting } else { &mut moving }) += 1;
    }
    assert!(moving > 50 && resting > 50, "{moving} {resting}");
}

/// A bob on a rod that turns in a bearing.
#[derive(Clone, Copy)]
struct Pendulum {
    mass: f64,
    length: f64,
    /// About the mass centre.
    inertia: f64,
    start: [f64; 2],
    levels: [f64; 2],
    coefficients: [f64; 2],
    radius: f64,
}

impl Pendulum {
    fn text(&self, t_end: f64) -> String {
        let Self { mass, length, inertia, start: [angle, rate], levels, coefficients, radius } = self;
        let mut text = head("pendulum", t_end);
        let _ = write!(
            text,
            "[[body]]\nname = \"bob\"\nmass = {mass:?}\ninertia = [{inertia:?}, {inertia:?}, {inertia:?}]\n[[joint]]\n\
             name = \"hinge\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [0, -1, 0]\nfirst = {{ body = \"ground\" }}\n\
             second = {{ body = \"bob\", point = [0, {length:?}, 0] }}\nangle = {angle:?}\nrate = {rate:?}\n[[contact]]\n\
             name = \"bearing\"\njoint = \"hinge\"\nfriction = {:?}\nstatic_friction = {:?}\n\
             friction_coefficient = {:?}\nstatic_friction_coefficient = {:?}\nradius = {radius:?}\n",
            levels[0], levels[1], coefficients[0], coefficients[1]
        );
        text
    }

    /// The acceleration while it turns this way: friction and reaction by bisection of what is left of the torque.
    fn acceleration(&self, [angle, rate]: [f64; 2], way: f64) -> f64 {
        let Self { mass, length, inertia, .. } = *self;
        let weight = mass * GRAVITY;
        let left = |a: f64| {
            let inward = mass * length * rate * rate + weight * angle.cos();
            let across = mass * length * a + weight * angle.sin();
            let level = self.levels[0] + self.coefficients[0] * self.radius * inward.hypot(across);
            (inertia + mass * length * length) * a + weight * length * angle.sin() + way * level
        };
        let (mut low, mut high) = (-1e4, 1e4);
        for _ in 0..120 {
            let middle = 0.5 * (low + high);
            if left(middle) < 0.0 { low = middle } else { high = middle }
        }
        0.5 * (low + high)
    }

    fn step(&self, [x, v]: [f64; 2], way: f64, h: f64) -> [f64; 2] {
        let slope = |[x, v]: [f64; 2]| [v, self.acceleration([x, v], way)];
        let ahead = |k: [f64; 2], h: f64| [x + h * k[0], v + h * k[1]];
        let a = slope([x, v]);
        let b = slope(ahead(a, 0.5 * h));
        let c = slope(ahead(b, 0.5 * h));
        let d = slope(ahead(c, h));
        let mean = |i: usize| h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
        [x + mean(0), v + mean(1)]
    }

    /// Whether it stays where it is at rest: the bearing carries the weight alone.
    fn stays(&self, angle: f64) -> bool {
        let weight = self.mass * GRAVITY;
        let level = self.levels[1] + self.coefficients[1] * self.radius * weight;
        (weight * self.length * angle.sin()).abs() <= level
    }

    /// The motion by small steps of Runge and Kutta's, each swing up to its end.
    fn exact(&self, t_end: f64) -> ([f64; 2], u32) {
        let (mut y, mut t, mut swings) = (self.start, 0.0, 0);
        loop {
            if y[1] == 0.0 {
                if self.stays(y[0]) {
                    return (y, swings);
                }
                swings += 1;
            }
            let way = if y[1] == 0.0 { -y[0].sin().signum() } else { y[1].signum() };
            loop {
                let h = STEP.min(t_end - t);
                let next = self.step(y, way, h);
                if next[1] * way < 0.0 {
                    let (mut low, mut high) = (0.0, h);
                    for _ in 0..60 {
                        let middle = 0.5 * (low + high);
                        if self.step(y, way, middle)[1] * way < 0.0 { high = middle } else { low = middle }
                    }
                    (y, t) = ([self.step(y, way, low)[0], 0.0], t + low);
                    break;
                }
                (y, t) = (next, t + h);
                if t >= t_end {
                    return (y, swings);
                }
            }
        }
    }
}

/// Of the reference, s.
const STEP: f64 = 5e-4;

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn a_pendulum_in_a_bearing_rubs_by_the_force_in_it() {
    let folder = Folder::new("bearing");
    let common = Pendulum {
        mass: 1.3,
        length: 0.4,
        inertia: 0.05,
        start: [1.2, 0.0],
        levels: [0.0; 2],
        coefficients: [0.3, 0.4],
        radius: 0.05,
    };
    let mut stuck = 0;
    for (case, pendulum) in [
        common,
        Pendulum { start: [0.3, -9.0], coefficients: [0.15, 0.15], ..common },
        Pendulum { start: [2.8, 0.0], levels: [0.1, 0.2], coefficients: [0.1, 0.3], ..common },
        // Of friction a third comes back through the reaction.
        Pendulum { start: [1.5, 3.0], coefficients: [0.3, 0.3], radius: 0.55, ..common },
        Pendulum { start: [0.05, 0.0], ..common },
    ]
    .into_iter()
    .enumerate()
    {
        let t_end = 4.0;
        let (expected, swings) = pendulum.exact(t_end);
        let run = run(&folder, &format!("pendulum-{case}"), &pendulum.text(t_end), &FINE);
        let found = end(&run, "hinge");
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() < 2e-9,
                "case {case}: {found} for {expected} after {swings} swings"
            );
        }
        if expected[1] == 0.0 {
            stuck += 1;
            assert_eq!(found[1], 0.0, "case {case}");
        }
        assert!(run["energy_drift"].as_f64().unwrap() < 1e-9, "case {case}: {}", run["energy_drift"]);
    }
    assert!(stuck >= 2, "{stuck}");
}

#[test]
fn friction_that_may_jam_is_an_error() {
    let folder = Folder::new("jam");
    let pendulum = Pendulum {
        mass: 1.3,
        length: 0.4,
        inertia: 0.05,
        start: [1.2, 1.0],
        levels: [0.0; 2],
        coefficients: [0.5, 0.5],
        radius: 2.0,
    };
    // μ r m l / (I + m l²) = 2.016.
    fs::write(folder.0.join("jam.toml"), pendulum.text(1.0)).unwrap();
    for method in [&FINE[..], &["--step", "1e-3"]] {
        let output = simulate(&folder, &[&["jam.toml"], &JOINT[..], method].concat());
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains("friction on joint `hinge` may jam"), "{said}");
        assert!(said.contains("2.015"), "{said}");
    }
}

/// How joints share a load that one of them could carry is not unique, and so is not friction that depends on it.
#[test]
fn reactions_that_are_not_unique_carry_no_friction() {
    let folder = Folder::new("shared");
    let text = fs::read_to_string(crate::support::model("four-bar-revolute.toml")).unwrap();
    let contact = "\n[[contact]]\nname = \"bearing\"\njoint = \"crank_pivot\"\nfriction_coefficient = 0.1\nradius = 0.01\n";
    fs::write(folder.0.join("four-bar.toml"), text + contact).unwrap();
    refused(&simulate(&folder, &[&["four-bar.toml"], &JOINT[..]].concat()), "is not unique");
}

/// A contact of a chain: coefficients, radius of the bearing, and whether its joint turns.
struct Loaded {
    coefficients: [f64; 2],
    radius: f64,
    turns: bool,
}

/// A chain in whose contacts friction grows with the reactions of the joints.
fn loaded_chain(random: &mut ChaCha8Rng) -> (String, Vec<Loaded>) {
    let text = chain(random);
    let mut parts = text.split("[[contact]]\n");
    let mut loaded = parts.next().unwrap().to_owned();
    let (mut before, mut contacts) = (loaded.clone(), Vec::new());
    for part in parts {
        let mut between = |low: f64, high: f64| (random.random_range(low..high) * 1e3).round() / 1e3;
        let kinetic = between(0.05, 0.4);
        let more = [0.0, between(0.01, 0.1)][between(0.0, 1.0).round() as usize];
        let turns = before.rsplit("kind = ").next().unwrap().starts_with("\"revolute\"");
        let contact = Loaded { coefficients: [kinetic, kinetic + more], radius: between(0.005, 0.05), turns };
        let _ = write!(
            loaded,
            "[[contact]]\nfriction_coefficient = {:?}\nstatic_friction_coefficient = {:?}\n",
            contact.coefficients[0], contact.coefficients[1]
        );
        if turns {
            let _ = writeln!(loaded, "radius = {:?}", contact.radius);
        }
        loaded += part;
        before = part.to_owned();
        contacts.push(contact);
    }
    (loaded, contacts)
}

/// A number of a contact in a model file.
fn key(text: &str, contact: usize, key: &str) -> f64 {
    let of = text.split("[[contact]]\n").nth(contact + 1).unwrap();
    let line = of.lines().find(|line| line.starts_with(&format!("{key} = "))).unwrap();
    line.rsplit(' ').next().unwrap().parse().unwrap()
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_chains_rub_by_the_forces_in_their_joints() {
    let folder = Folder::new("loaded-chains");
    let mut random = ChaCha8Rng::seed_from_u64(2407);
    let (mut slipping, mut sticking, mut events) = (0, 0, 0);
    for case in 0..6 {
        let (text, contacts) = loaded_chain(&mut random);
        let file = format!("chain-{case}.toml");
        fs::write(folder.0.join(&file), &text).unwrap();
        for (tolerance, limit) in [("1e-9", 1e-6), ("1e-12", 1e-9)] {
            let method = ["--integrator", "dop853", "--tolerance", tolerance, "--json", "--out", "out"];
            let output = simulate(&folder, &[&[&file[..]], &JOINT[..], &method].concat());
            assert!(output.status.success(), "case {case}: {}", String::from_utf8_lossy(&output.stderr));
            let run: Value = serde_json::from_slice(&output.stdout).unwrap();
            let drift = run["energy_drift"].as_f64().unwrap();
            assert!(drift < limit, "case {case}: {drift:e}\n{}\n{text}", run["events"]);
            events += run["events"].as_array().unwrap().len();
        }
        let table = fs::read_to_string(folder.0.join("out/chain.csv")).unwrap();
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let columns: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
        let place = |name: &str| {
            let found = columns.iter().position(|column| column.starts_with(&format!("{name} [")));
            found.unwrap_or_else(|| panic!("{name}: {columns:?}"))
        };
        for row in reader.records() {
            let row = row.unwrap();
            let number = |name: &str| row[place(name)].parse::<f64>().unwrap();
            for (k, contact) in contacts.iter().enumerate() {
                let load = ["f", "g", "h"].map(|axis| number(&format!("contact_{k}.force_{axis}")));
                let load = load.iter().map(|force| force * force).sum::<f64>().sqrt();
                let arm = if contact.turns { contact.radius } else { 1.0 };
                let level =
                    |constant: &str, i: usize| key(&text, k, constant) + contact.coefficients[i] * arm * load;
                let (kinetic, at_rest) = (level("friction", 0), level("static_friction", 1));
                let [force, x, rate] =
                    [format!("input contact_{k}"), format!("joint_{k}"), format!("joint_{k} rate")]
                        .map(|name| number(&name));
                let told = format!("case {case} at {}: {force} {x} {rate}, {kinetic} {at_rest}", &row[0]);
                // Rates are read off the bodies: of what sticks there is rounding.
                if rate.abs() > 1e-12 {
                    slipping += 1;
                    assert!((force + rate.signum() * kinetic).abs() < 1e-8 * (1.0 + kinetic), "{told}");
                } else if ["lower", "upper"].iter().all(|end| (x - key(&text, k, end)).abs() > 1e-12) {
                    sticking += 1;
                    assert!(force.abs() <= at_rest * (1.0 + 1e-9), "{told}");
                }
            }
        }
    }
    assert!(slipping > 3000 && sticking > 300 && events > 100, "{slipping} {sticking} {events}");
}

/// In a loop, too: the crank and the rocker of a four-bar in bearings.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn a_loop_rubs_by_the_forces_in_its_joints_until_it_stands() {
    let folder = Folder::new("loaded-loop");
    let text = fs::read_to_string(crate::support::model("four-bar.toml")).unwrap();
    let contact = |joint: &str| {
        format!(
            "\n[[contact]]\nname = \"{joint}_bearing\"\njoint = \"{joint}\"\nfriction_coefficient = 0.2\nradius = 0.02\n"
        )
    };
    for joints in [&["crank_pivot"][..], &["rocker_pivot"], &["crank_pivot", "rocker_pivot"]] {
        let contacts: String = joints.iter().map(|joint| contact(joint)).collect();
        let run = run(&folder, "four-bar", &(text.clone() + &contacts), &FINE);
        assert!(run["energy_drift"].as_f64().unwrap() < 1e-9, "{joints:?}: {}", run["energy_drift"]);
        let events = run["events"].as_array().unwrap();
        let has_stood = events.iter().any(|event| event["what"] == "sticks");
        assert_eq!(has_stood, joints.contains(&"crank_pivot"), "{joints:?}: {events:?}");
    }
}
