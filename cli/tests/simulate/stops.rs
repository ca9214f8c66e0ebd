//! Every impact that is listed is one: on a stop that there is, at its gap, with the rate that leads there.

use crate::contacts::chain;
use crate::support::{Folder, json, refused, simulate};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::fs;

/// The teeth of a gear with backlash: a torque presses them to the upper flank, on which they come to rest.
const BACKLASH: &str = r#"
format = 1
name = "backlash"
[simulation]
t_end = 5
[[body]]
name = "ground"
fixed = true
[[body]]
name = "load"
mass = 1
inertia = [0.5, 0.5, 0.5]
[[body]]
name = "gear"
mass = 1
inertia = [0.1, 0.1, 0.1]
[[joint]]
name = "out"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "load" }
damping = 0.2
[[joint]]
name = "gap"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "load" }
second = { body = "gear" }
[[force]]
name = "m"
kind = "load"
body = "gear"
torque = [0, 0, 0.3]
[[contact]]
name = "teeth"
joint = "gap"
lower = -0.05
upper = 0.05
restitution = 0.3
"#;

/// A rod that falls from this angle onto a stop.
fn rod(angle_deg: f64, stop: &str) -> String {
    format!(
        "format = 1\nname = \"rod\"\ngravity = [0, -9.81, 0]\n[simulation]\nt_end = 5\n[[body]]\nname = \"ground\"\n\
         fixed = true\n[[body]]\nname = \"bar\"\nmass = 1\ninertia = [0.02, 1e-3, 0.02]\n[[joint]]\nname = \"h\"\n\
         kind = \"revolute\"\naxis = [0, 0, 1]\nzero = [0, 1, 0]\nfirst = {{ body = \"ground\" }}\n\
         second = {{ body = \"bar\", point = [0, 0.3, 0] }}\nangle_deg = {angle_deg:?}\n[[contact]]\nname = \"st\"\n\
         joint = \"h\"\n{stop}\n"
    )
}

/// How often a contact does what its words begin with.
fn count(run: &Value, contact: &str, what: &str) -> usize {
    let events = run["events"].as_array().unwrap();
    let is_one =
        |event: &&Value| event["name"] == contact && event["what"].as_str().unwrap().starts_with(what);
    events.iter().filter(is_one).count()
}

#[test]
fn a_series_of_rebounds_ends_on_the_stop_it_began_on() {
    let folder = Folder::new("one-stop");
    fs::write(folder.0.join("backlash.toml"), BACKLASH).unwrap();
    let run = json(&folder, &["backlash.toml"]);
    let hits = ["hits upper", "hits lower", "rests"].map(|what| count(&run, "teeth", what));
    assert!(hits[0] > 10 && hits[1..] == [0, 1], "{hits:?}: {}", run["events"]);
    for restitution in [0.05, 0.2, 0.5, 0.8] {
        fs::write(
            folder.0.join("rod.toml"),
            rod(-60.0, &format!("upper = -0.3\nrestitution = {restitution}")),
        )
        .unwrap();
        let how = ["rod.toml", "--engine", "jit", "--integrator", "dop853", "--tolerance", "1e-8"];
        let run = json(&folder, &how);
        let hits = ["hits upper", "hits lower", "rests"].map(|what| count(&run, "st", what));
        assert!(hits[0] > 3 && hits[1..] == [0, 1], "{restitution}: {hits:?}");
    }
}

/// Four bars in a plane, whose rocker starts at 80 degrees, 1.396 rad, short of its lower stop.
const FOUR_BAR: &str = r#"
format = 1
name = "four_bar"
gravity = [0, -9.81, 0]
[[body]]
name = "ground"
fixed = true
[[body]]
name = "crank"
mass = 0.5
inertia = [1e-5, 1e-3, 1e-3]
[[body]]
name = "coupler"
mass = 1.0
inertia = [1e-5, 1e-2, 1e-2]
[[body]]
name = "rocker"
mass = 0.8
inertia = [1e-5, 5e-3, 5e-3]
[[joint]]
name = "a"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "crank", point = [-0.05, 0, 0] }
angle_deg = 60
[[joint]]
name = "b"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "crank", point = [0.05, 0, 0] }
second = { body = "coupler", point = [-0.2, 0, 0] }
[[joint]]
name = "c"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "coupler", point = [0.2, 0, 0] }
second = { body = "rocker", point = [0.15, 0, 0] }
[[joint]]
name = "d"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground", point = [0.35, 0, 0] }
second = { body = "rocker", point = [-0.15, 0, 0] }
angle_deg = 80
rough = true
[[contact]]
name = "st"
joint = "d"
lower = 1.8
restitution = 0.2
"#;

#[test]
fn a_start_beyond_a_stop_is_refused_with_both_numbers() {
    let folder = Folder::new("beyond");
    let start = |angle_deg: f64, stop: &str| {
        fs::write(folder.0.join("rod.toml"), rod(angle_deg, stop)).unwrap();
        simulate(&folder, &["rod.toml", "--t-end", "0.1"])
    };
    refused(&start(30.0, "upper = 0.5\nrestitution = 0.5"), "0.52359877559829");
    refused(&start(30.0, "upper = 0.5\nrestitution = 0.5"), "0.5");
    refused(&start(-30.0, "lower = -0.5\nrestitution = 0.5"), "-0.52359877559829");
    assert!(start(30.0, "upper = 0.53\nrestitution = 0.5").status.success());
    fs::write(folder.0.join("loop.toml"), FOUR_BAR).unwrap();
    let output = simulate(&folder, &["loop.toml", "--t-end", "0.1"]);
    refused(&output, "1.8");
    // A closed form: the rocker's joint lies on the circles about the end of the crank and about its own pivot.
    let [x, y] = [0.35 - 0.1 * 60.0_f64.to_radians().cos(), -0.1 * 60.0_f64.to_radians().sin()];
    let far = x.hypot(y);
    let along = (far * far + 0.3 * 0.3 - 0.4 * 0.4) / (2.0 * far);
    let angle = (-y).atan2(-x) - (along / 0.3).acos();
    refused(&output, &format!("{angle:.12}")[..12]);
}

/// Samples between which an impact is looked for, s.
const EVERY: f64 = 1e-3;

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_chains_list_no_impact_that_did_not_happen() {
    let folder = Folder::new("listed");
    let mut dice = ChaCha8Rng::seed_from_u64(4005);
    let (mut n_hits, mut n_rests) = (0, 0);
    for case in 0..40 {
        // One stop or two, with rebounds and without.
        let mut n_stops = 0;
        let mut keep = |line: &&str| {
            let is_stop = ["lower = ", "upper = "].iter().any(|stop| line.starts_with(stop));
            n_stops += usize::from(is_stop);
            // Never both of a joint.
            !is_stop || n_stops % 2 == case % 2 || dice.random_bool(0.5)
        };
        let mut random = ChaCha8Rng::seed_from_u64(4005 + case as u64);
        let text: Vec<String> = chain(&mut random).lines().filter(&mut keep).map(str::to_owned).collect();
        fs::write(folder.0.join("chain.toml"), text.join("\n")).unwrap();
        let how =
            ["chain.toml", "--engine", "jit", "--effort", "quick", "--coordinates", "joint", "--out", "out"];
        let tolerance = ["--integrator", "dop853", "--tolerance", ["1e-6", "1e-9", "1e-12"][case % 3]];
        let every = EVERY.to_string();
        let run = json(&folder, &[&how[..], &tolerance, &["--every", &every]].concat());
        let table = fs::read_to_string(folder.0.join("out/chain.csv")).unwrap();
        let mut rows = table.lines().map(|row| row.split(',').collect::<Vec<_>>());
        let head = rows.next().unwrap();
        let rows: Vec<Vec<&str>> = rows.collect();
        let number =
            |row: usize, column: usize| rows[row.min(rows.len() - 1)][column].parse::<f64>().unwrap();
        for event in run["events"].as_array().unwrap() {
            let (t, what) = (event["t"].as_f64().unwrap(), event["what"].as_str().unwrap());
            n_rests += usize::from(what == "rests");
            let Some(side) = what.strip_prefix("hits ") else { continue };
            n_hits += 1;
            let k = event["name"].as_str().unwrap().strip_prefix("contact_").unwrap();
            let told = format!("case {case}, {event}\n{}", text.join("\n"));
            // The stop as the file has it, if it has it.
            let own = text.iter().position(|line| *line == format!("name = \"contact_{k}\"")).unwrap();
            let value = |key: &str| {
                let mut lines = text[own..].iter().take_while(|line| !line.starts_with("[[body]]"));
                lines.find_map(|line| line.strip_prefix(key)?.strip_prefix(" = ")?.parse::<f64>().ok())
            };
            let stop = value(side).unwrap_or_else(|| panic!("there is no such stop: {told}"));
            let way = if side == "upper" { 1.0 } else { -1.0 };
            let [before, after] = [0, 1].map(|k: usize| event["rates"][k].as_f64().unwrap());
            assert!(before * way > 0.0 && after * way <= 0.0, "rates: {told}");
            let rebound = -value("restitution").unwrap_or(0.0) * before;
            assert!(after == 0.0 || (after - rebound).abs() <= 1e-12 * before.abs(), "rebound: {told}");
            assert!(after != 0.0 || rebound.abs() < 1e-6, "a rebound is due: {told}");
            // At the samples around it the joint is as near as its rates allow.
            let column = |unit: &str| head.iter().position(|name| *name == format!("joint_{k} [{unit}]"));
            let column = column("rad").or_else(|| column("m")).unwrap();
            let row = (t / EVERY) as usize;
            let gaps = [row, row + 1].map(|row| (number(row, column) - stop).abs());
            let speeds = [row, row + 1].map(|row| number(row, column + 1).abs());
            let fastest = speeds.iter().fold(before.abs(), |most, speed| most.max(*speed));
            let reach = 2.0 * EVERY * fastest + 1e-5;
            assert!(gaps.iter().all(|gap| *gap <= reach), "gaps {gaps:?}, reach {reach}: {told}");
        }
    }
    println!("{n_hits} impacts, {n_rests} rests");
    assert!(n_hits > 200 && n_rests > 5, "{n_hits} {n_rests}");
}
