//! Rigid stops and friction that sticks in model files: sledges against their motion piece by piece, chains against the
//! ledger of their energy.

use crate::support::{Folder, json, model, refused, simulate};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;

const METHODS: [&[&str]; 5] = [
    &["--integrator", "tsit5", "--tolerance", "1e-6"],
    &["--integrator", "tsit5", "--tolerance", "1e-11"],
    &["--integrator", "dop853", "--tolerance", "1e-9"],
    &["--integrator", "dop853", "--tolerance", "1e-12"],
    &["--integrator", "dop853", "--tolerance", "1e-3"],
];

/// A sledge on a rail of its own, pushed by a constant force.
#[derive(Clone, Debug)]
struct Sledge {
    mass: f64,
    push: f64,
    start: [f64; 2],
    ends: [f64; 2],
    restitution: f64,
    levels: [f64; 2],
}

/// What happens to it: when, the word of the list, and the rates of a hit.
type Happening = (f64, &'static str, Option<[f64; 2]>);

impl Sledge {
    fn random(random: &mut ChaCha8Rng) -> Self {
        let mut between = |low: f64, high: f64| (random.random_range(low..high) * 1e3).round() / 1e3;
        let level = [0.0, between(0.1, 1.0), between(0.1, 1.0)][between(0.0, 2.49).round() as usize];
        Self {
            mass: between(0.5, 2.0),
            push: between(-2.0, 2.0),
            start: [between(-0.5, 0.5), between(-3.0, 3.0)],
            ends: [between(-2.0, -0.6), between(0.6, 2.0)],
            restitution: [0.0, between(0.2, 0.8), 1.0][between(0.0, 2.49).round() as usize],
            levels: [level, level * [1.0, between(1.0, 2.0)][between(0.0, 1.0).round() as usize]],
        }
    }

    /// Its motion up to a time: parabolas between impacts, Newton's law at them. Rebounds that are slower than 1e-12 of
    /// the fastest impact are none, as `gyro_sim::contact` says.
    fn exact(&self, t_end: f64) -> ([f64; 2], Vec<Happening>) {
        let ([mut x, mut v], mut t, mut found) = (self.start, 0.0, Vec::<Happening>::new());
        let mut fastest = 0.0_f64;
        loop {
            let end = if v > 0.0 || v == 0.0 && self.push > 0.0 { 1 } else { 0 };
            if v == 0.0 {
                // At rest: on a stop, by friction, or not at all.
                let is_stopped = x == self.ends[end];
                // The last flight may be lower than the place's rounding.
                if is_stopped && found.last().is_some_and(|(_, what, _)| what.starts_with("hits")) {
                    found.push((t, "rests", None));
                }
                if is_stopped || self.push.abs() <= self.levels[1] {
                    return ([x, 0.0], found);
                }
            }
            let way = if v != 0.0 { v.signum() } else { self.push.signum() };
            let a = (self.push - way * self.levels[0]) / self.mass;
            let stands = if a * way < 0.0 { -v / a } else { f64::INFINITY };
            let arrives = first_root(0.5 * a, v, x - self.ends[end]);
            let dt = stands.min(arrives);
            if t + dt >= t_end {
                let dt = t_end - t;
                return ([x + v * dt + 0.5 * a * dt * dt, v + a * dt], found);
            }
            t += dt;
            if arrives <= stands {
                let speed = (v + a * dt).abs();
                fastest = fastest.max(speed);
                let rebounds = self.restitution * speed > 1e-12 * fastest;
                let after = if rebounds { -way * self.restitution * speed } else { 0.0 };
                (x, v) = (self.ends[end], after);
                let what = if end == 1 { "hits upper" } else { "hits lower" };
                found.push((t, what, Some([way * speed, after])));
                if after == 0.0 && (self.push * way > 0.0 || self.push.abs() <= self.levels[1]) {
                    found.push((t, "rests", None));
                }
            } else {
                (x, v) = (x + v * dt + 0.5 * a * dt * dt, 0.0);
                if self.levels[1] > 0.0 && self.push.abs() <= self.levels[1] {
                    found.push((t, "sticks", None));
                }
            }
        }
    }

    fn write(&self, k: usize, text: &mut String) {
        let Self { mass, push, start: [x, v], ends: [lower, upper], restitution, levels } = self;
        let _ = write!(
            text,
            "[[body]]\nname = \"body_{k}\"\nmass = {mass:?}\ninertia = [1, 1, 1]\n[[joint]]\nname = \"slide_{k}\"\n\
             kind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = {{ body = \"ground\" }}\n\
             second = {{ body = \"body_{k}\" }}\ndisplacement = {x:?}\nrate = {v:?}\n[[force]]\nname = \"motor_{k}\"\n\
             kind = \"motor\"\njoint = \"slide_{k}\"\nvalue = {push:?}\n[[contact]]\nname = \"rail_{k}\"\n\
             joint = \"slide_{k}\"\nlower = {lower:?}\nupper = {upper:?}\nrestitution = {restitution:?}\n\
             friction = {:?}\nstatic_friction = {:?}\n",
            levels[0], levels[1]
        );
    }
}

/// The first time after now at which `a t² + b t + c` vanishes; the way leads there or does not come back.
fn first_root(a: f64, b: f64, c: f64) -> f64 {
    let roots = if a == 0.0 {
        [-c / b, f64::INFINITY]
    } else {
        let d = b * b - 4.0 * a * c;
        if d < 0.0 {
            return f64::INFINITY;
        }
        let q = -0.5 * (b + d.sqrt().copysign(b));
        [q / a, c / q]
    };
    roots.into_iter().filter(|t| *t > 1e-13).fold(f64::INFINITY, f64::min)
}

fn head(name: &str, t_end: f64) -> String {
    format!(
        "format = 1\nname = \"{name}\"\ngravity = [0, -9.81, 0]\n[simulation]\nt_end = {t_end:?}\n[[body]]\nname = \"ground\"\n\
         fixed = true\n"
    )
}

/// The list of one contact: what, when, rates.
fn listed(run: &Value, name: &str) -> Vec<(f64, String, Option<[f64; 2]>)> {
    let events = run["events"].as_array().unwrap();
    let own = events.iter().filter(|event| event["name"] == name);
    own.map(|event| {
        let rates = event["rates"].as_array().map(|r| [0, 1].map(|k: usize| r[k].as_f64().unwrap()));
        (event["t"].as_f64().unwrap(), event["what"].as_str().unwrap().to_owned(), rates)
    })
    .collect()
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_sledges_move_as_parabolas_do() {
    let folder = Folder::new("sledges");
    let mut random = ChaCha8Rng::seed_from_u64(2401);
    let mut kinds = std::collections::BTreeMap::<String, u32>::new();
    for case in 0..20 {
        let sledges: Vec<Sledge> =
            (0..random.random_range(1..=4)).map(|_| Sledge::random(&mut random)).collect();
        let (mut text, t_end) = (head("sledges", 3.0), 3.0);
        sledges.iter().enumerate().for_each(|(k, sledge)| sledge.write(k, &mut text));
        let file = format!("sledges-{case}.toml");
        fs::write(folder.0.join(&file), text).unwrap();
        let common = [&file[..], "--engine", "jit", "--effort", "quick", "--coordinates", "joint"];
        let run = json(&folder, &[&common[..], METHODS[case % METHODS.len()]].concat());
        let times: Vec<f64> =
            run["events"].as_array().unwrap().iter().map(|e| e["t"].as_f64().unwrap()).collect();
        assert!(times.is_sorted(), "case {case}: {times:?}");
        for (k, sledge) in sledges.iter().enumerate() {
            let ([x, v], expected) = sledge.exact(t_end);
            let found = listed(&run, &format!("rail_{k}"));
            let told = format!("case {case}, sledge {k}: {sledge:?}\n{found:?}\n{expected:?}");
            // Flights as low as some roundings of the stop's place, 1e-12 m, are not all told from none.
            let slow = |speed: f64| speed < 1e-5;
            let of_note = |rates: Option<[f64; 2]>| rates.is_none_or(|[before, _]| !slow(before.abs()));
            let found_all: Vec<_> = found.iter().filter(|(.., rates)| of_note(*rates)).collect();
            let expected_all: Vec<_> = expected.iter().filter(|(.., rates)| of_note(*rates)).collect();
            assert_eq!(found_all.len(), expected_all.len(), "{told}");
            for ((t, what, rates), (at, name, expected)) in found_all.iter().zip(&expected_all) {
                *kinds.entry(what.clone()).or_default() += 1;
                // They take as long as such a flight.
                let close = if what == "rests" { 1e-5 } else { 1e-10 };
                assert!(what == name && (t - at).abs() < close, "{what} at {t}: {told}");
                if let (Some(rates), Some(expected)) = (rates, expected) {
                    for (rate, expected) in rates.iter().zip(expected) {
                        assert!((rate - expected).abs() < 1e-10, "{told}");
                    }
                }
            }
            let joint = &run["joints"][format!("slide_{k}")];
            let [place, rate] = ["position", "rate"].map(|key| joint[key].as_f64().unwrap());
            assert!(
                (place - x).abs() < 1e-10 && (rate - v).abs() < 1e-10,
                "{place} {rate} for {x} {v}: {told}"
            );
        }
        assert!(run["energy_drift"].as_f64().unwrap() < 1e-10, "case {case}: {}", run["energy_drift"]);
    }
    for what in ["hits lower", "hits upper", "rests", "sticks"] {
        assert!(kinds.get(what).is_some_and(|count| *count > 4), "{kinds:?}");
    }
}

/// A chain of swinging and sliding bodies, with stops and friction in its joints.
pub(crate) fn chain(random: &mut ChaCha8Rng) -> String {
    let mut text = head("chain", 2.0);
    let mut between = |low: f64, high: f64| (random.random_range(low..high) * 1e3).round() / 1e3;
    let n = between(1.0, 4.49).round() as usize;
    for k in 0..n {
        let before = if k == 0 { "ground".to_owned() } else { format!("body_{}", k - 1) };
        let (kind, start) = if between(0.0, 1.0) < 0.7 {
            ("revolute", format!("angle = {:?}", between(-0.5, 0.5)))
        } else {
            ("prismatic", format!("displacement = {:?}", between(-0.1, 0.1)))
        };
        let axis = ["[0, 0, 1]", "[1, 0, 0]", "[0.6, 0, 0.8]"][between(0.0, 2.49).round() as usize];
        let level = [0.0, between(0.02, 0.3)][between(0.0, 1.0).round() as usize];
        let _ = write!(
            text,
            "[[body]]\nname = \"body_{k}\"\nmass = {:?}\ninertia = [0.02, 0.015, 0.018]\n[[joint]]\nname = \"joint_{k}\"\n\
             kind = \"{kind}\"\naxis = {axis}\nzero = [0, 1, 0]\nfirst = {{ body = \"{before}\", point = [0, {:?}, 0] }}\n\
             second = {{ body = \"body_{k}\", point = [0.02, 0.15, 0] }}\n{start}\nrate = {:?}\n[[contact]]\n\
             name = \"contact_{k}\"\njoint = \"joint_{k}\"\nlower = {:?}\nupper = {:?}\nrestitution = {:?}\n\
             friction = {level:?}\nstatic_friction = {:?}\n",
            between(0.3, 1.5),
            if k == 0 { 0.0 } else { -0.15 },
            between(-4.0, 4.0),
            between(-1.0, -0.55),
            between(0.55, 1.0),
            [0.0, between(0.1, 0.9)][between(0.0, 1.0).round() as usize],
            level * between(1.0, 1.5),
        );
    }
    text
}

/// By each method either the energy is balanced or the failure has a name; none is wrong in silence.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_chains_keep_the_ledger_of_their_energy_and_their_stops() {
    let folder = Folder::new("chains");
    let mut random = ChaCha8Rng::seed_from_u64(2402);
    let mut n_events = 0;
    for case in 0..16 {
        let file = format!("chain-{case}.toml");
        fs::write(folder.0.join(&file), chain(&mut random)).unwrap();
        let common = [&file[..], "--engine", "jit", "--effort", "quick", "--coordinates", "joint"];
        for (method, limit) in [(METHODS[2], 1e-6), (METHODS[3], 1e-9)] {
            let output = simulate(&folder, &[&common[..], method, &["--json"]].concat());
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(output.status.success(), "case {case}: {said}");
            let run: Value = serde_json::from_slice(&output.stdout).unwrap();
            let drift = run["energy_drift"].as_f64().unwrap();
            assert!(drift < limit, "case {case}, {method:?}: {drift:e}\n{}", run["events"]);
            n_events += run["events"].as_array().unwrap().len();
        }
    }
    assert!(n_events > 100, "{n_events}");
}

/// Its bearings stick where the vehicle turns back, and slip in between; a stop is hit when the vehicle rolls far.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn the_stabilised_gimbal_sticks_slips_and_hits_its_stop() {
    let folder = Folder::new("gimbal-contacts");
    let page = model("stabilised-gimbal.toml");
    let how = ["--engine", "jit", "--coordinates", "joint", "--integrator", "dop853", "--tolerance", "1e-9"];
    let run = |extra: &[&str]| json(&folder, &[&[&page[..]], &how[..], extra].concat());
    let count = |run: &Value, bearing: &str, what: &str| {
        listed(run, bearing).iter().filter(|(_, found, _)| found.starts_with(what)).count()
    };
    let (calm, rough) = (run(&[]), run(&["--set", "roll=0.6"]));
    for run in [&calm, &rough] {
        for bearing in ["pan_bearing", "tilt_bearing"] {
            let counts = ["sticks", "slips"].map(|what| count(run, bearing, what));
            assert!(counts.iter().all(|count| *count >= 2), "{bearing}: {counts:?}");
        }
        assert!(run["energy_drift"].as_f64().unwrap() < 1e-8, "{}", run["energy_drift"]);
    }
    assert_eq!(count(&calm, "tilt_bearing", "hits"), 0);
    assert!(count(&rough, "tilt_bearing", "hits upper") > 0, "{}", rough["events"]);
}

#[test]
fn contacts_are_refused_where_they_cannot_be() {
    let folder = Folder::new("contacts-refused");
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut text = head("sledges", 1.0);
    Sledge::random(&mut random).write(0, &mut text);
    fs::write(folder.0.join("sledge.toml"), text).unwrap();
    let run = |args: &[&str]| simulate(&folder, &[&["sledge.toml"], args].concat());
    refused(&run(&["--engine", "assembled"]), "are for generated code");
    let maximal = ["--engine", "jit", "--coordinates", "maximal"];
    let stiff = [&maximal[..], &["--integrator", "rodas4", "--tolerance", "1e-6"]].concat();
    refused(&run(&stiff), "choose --coordinates joint, or tsit5");
    let kept = [&maximal[..], &["--correction", "baumgarte=20"]].concat();
    refused(&run(&kept), "choose --correction partition or none");
    refused(&run(&["--engine", "jit", "--input", "rail_0=1"]), "this is the force of the contact `rail_0`");
}

/// A linkage of four bars with friction that sticks in all its joints and stops on three, one of them cut: from event
/// to event the same motion in joint coordinates, in maximal ones and by an implicit method.
#[test]
fn a_linkage_rubs_and_stops_in_all_its_joints() {
    let folder = Folder::new("contacts-linkage");
    let mut text = fs::read_to_string(model("four-bar-revolute.toml")).unwrap();
    for (joint, level, stop) in [
        ("crank_pivot", 0.02, ""),
        ("rocker_pivot", 0.01, "upper = 1.9"),
        ("elbow", 0.03, "lower = -1.2"),
        ("knee", 0.02, "lower = 0.6"),
    ] {
        let at_rest = 1.3 * level;
        let _ = write!(
            text,
            "\n[[contact]]\nname = \"on_{joint}\"\njoint = \"{joint}\"\nfriction = {level:?}\nstatic_friction = {at_rest:?}\n{stop}\n{}",
            if stop.is_empty() { "" } else { "restitution = 0.5\n" }
        );
    }
    fs::write(folder.0.join("linkage.toml"), text).unwrap();
    let run = |way: &[&str]| json(&folder, &[&["linkage.toml", "--no-prove", "--t-end", "2"], way].concat());
    let first = run(&["--tolerance", "1e-11"]);
    for joint in ["rocker_pivot", "elbow", "knee"] {
        assert!(!listed(&first, &format!("on_{joint}")).is_empty(), "{}", first["events"]);
    }
    let hits = |run: &Value| {
        let all = listed(run, "on_rocker_pivot").into_iter().chain(listed(run, "on_knee"));
        // Later rebounds are too low to be told from none.
        all.filter(|(t, what, _)| what.starts_with("hits") && *t < 1.16).map(|(t, ..)| t).collect::<Vec<_>>()
    };
    assert!(hits(&first).len() > 5, "{}", first["events"]);
    for (way, limit) in [
        (&["--coordinates", "maximal", "--tolerance", "1e-11"][..], 1e-9),
        (&["--coordinates", "maximal", "--correction", "none", "--tolerance", "1e-11"], 1e-9),
        (&["--integrator", "rodas4", "--tolerance", "1e-8"], 1e-6),
    ] {
        let other = run(way);
        assert!(other["energy_drift"].as_f64().unwrap() < limit, "{way:?}: {}", other["energy_drift"]);
        let (one, two) = (hits(&first), hits(&other));
        assert_eq!(one.len(), two.len(), "{way:?}: {one:?} {two:?}");
        assert!(one.iter().zip(&two).all(|(a, b)| (a - b).abs() < limit), "{way:?}: {one:?} {two:?}");
        for joint in ["crank_pivot", "knee"] {
            let [a, b] = [&first, &other].map(|run| run["joints"][joint]["position"].as_f64().unwrap());
            assert!((a - b).abs() < limit, "{way:?}: {joint} {a} {b}");
        }
    }
}

/// Random mechanisms, with all that the format has, in these three ways.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_mechanisms_rub_and_stop_alike() {
    let folder = Folder::new("contacts-random");
    fs::write(folder.0.join("t.csv"), gyro_pages::TABLE).unwrap();
    let ways = [&[][..], &["--coordinates", "maximal"], &["--integrator", "rodas4"]];
    for seed in 100..112 {
        fs::write(folder.0.join("page.toml"), gyro_pages::rubbing(seed)).unwrap();
        let common = ["page.toml", "--no-prove", "--t-end", "0.5", "--tolerance", "1e-9"];
        let runs = ways.map(|way| json(&folder, &[&common[..], way].concat()));
        for (run, way) in runs.iter().zip(ways) {
            assert!(run["energy_drift"].as_f64().unwrap() < 1e-8, "{seed} {way:?}: {}", run["energy_drift"]);
            for (name, joint) in run["joints"].as_object().unwrap() {
                let places = [joint, &runs[0]["joints"][name]].map(|joint| joint["position"].as_f64());
                if let [Some(a), Some(b)] = places {
                    assert!((a - b).abs() < 1e-5, "{seed} {way:?}: {name} {a} {b}");
                }
            }
        }
    }
}

/// A mass on a spring that swings as far as its upper stop, or by so much further: it grazes.
fn grazing(beyond: f64) -> String {
    let mut text = head("grazing", 20.0);
    let _ = write!(
        text,
        "[[body]]\nname = \"mass\"\nmass = 1\ninertia = [1, 1, 1]\n[[joint]]\nname = \"slide\"\nkind = \"prismatic\"\n\
         axis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = {{ body = \"ground\" }}\nsecond = {{ body = \"mass\" }}\n\
         displacement = -1\n[[force]]\nname = \"spring\"\nkind = \"spring\"\njoint = \"slide\"\nstiffness = 1\n[[contact]]\n\
         name = \"end\"\njoint = \"slide\"\nupper = {:?}\nrestitution = 1\n",
        1.0 - beyond
    );
    text
}

/// Where it is: at each impact the phase jumps by twice the angle at which the stop is reached.
fn grazed(beyond: f64, t_end: f64) -> f64 {
    let angle = if beyond > 0.0 { (1.0 - beyond).acos() } else { 0.0 };
    let between = 2.0 * (std::f64::consts::PI - angle);
    let impacts = ((t_end - between / 2.0) / between).floor() + 1.0;
    -(t_end + 2.0 * angle * impacts).cos()
}

/// All integrators, coordinates, corrections and tolerances over what grazes and chatters: right, or refused by name.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn every_combination_is_right_or_refused() {
    let folder = Folder::new("contact-sweep");
    let mut random = ChaCha8Rng::seed_from_u64(2403);
    let mut chatter = Sledge::random(&mut random);
    (chatter.push, chatter.restitution, chatter.levels) = (1.5, 0.9, [0.1, 0.15]);
    let mut text = head("chatter", 20.0);
    chatter.write(0, &mut text);
    let mut cases = vec![("slide_0", text, chatter.exact(20.0).0[0], 0.0)];
    for beyond in [-1e-9, 0.0, 1e-9, 1e-6, 1e-3] {
        cases.push(("slide", grazing(beyond), grazed(beyond, 20.0), 1.0));
    }
    let methods: [&[&str]; 7] = [
        &["--step", "1e-3"],
        &["--integrator", "tsit5", "--tolerance", "1e-5"],
        &["--integrator", "tsit5", "--tolerance", "1e-10"],
        &["--integrator", "dop853", "--tolerance", "1e-3"],
        &["--integrator", "dop853", "--tolerance", "1e-7"],
        &["--integrator", "dop853", "--tolerance", "1e-13"],
        &["--integrator", "rodas4", "--tolerance", "1e-6"],
    ];
    // An error of the amplitude may make a hit of a miss, which moves the phase by its root.
    let limits = [1e-1_f64, 2e-1, 1e-3, 3e-1, 3e-2, 1e-4, 1e-1];
    let (mut right, mut refusals) = (0, 0);
    for (case, (joint, text, expected, grazes)) in cases.iter().enumerate() {
        let file = format!("case-{case}.toml");
        fs::write(folder.0.join(&file), text).unwrap();
        for (method, limit) in methods.iter().zip(limits) {
            for (coordinates, correction) in [
                ("joint", "none"),
                ("joint", "partition"),
                ("maximal", "partition"),
                ("maximal", "baumgarte=20"),
            ] {
                let around = ["--engine", "jit", "--effort", "quick", "--json"];
                let how = ["--coordinates", coordinates, "--correction", correction];
                let output = simulate(&folder, &[&[&file[..]], &around[..], method, &how].concat());
                let told = format!("case {case}: {method:?} {coordinates} {correction}");
                if coordinates == "maximal" && (correction != "partition" || method.contains(&"rodas4")) {
                    refused(&output, "rigid contacts");
                    refusals += 1;
                    continue;
                }
                assert!(output.status.success(), "{told}: {}", String::from_utf8_lossy(&output.stderr));
                let run: Value = serde_json::from_slice(&output.stdout).unwrap();
                let found = run["joints"][joint]["position"].as_f64().unwrap();
                let limit = if *grazes > 0.0 { limit } else { 1e-9 };
                let limit = if method.contains(&"--step") { limit.max(2e-2) } else { limit };
                assert!((found - expected).abs() <= limit, "{told}: {found} for {expected}");
                right += 1;
            }
        }
    }
    assert_eq!((right, refusals), (6 * (7 * 2 + 6), 6 * (7 + 1)));
}
