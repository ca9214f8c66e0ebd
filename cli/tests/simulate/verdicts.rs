//! Verdicts on runs whose truth is known, by every engine.

use crate::support::{Folder, json, simulate};
use serde_json::Value;
use std::fs;

/// A rod that hangs on a wall by a hinge, at this angle, with `more`.
fn rod(angle_deg: f64, more: &str) -> String {
    format!(
        "format = 1\nname = \"rod\"\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"wall\"\nfixed = true\n\
         [[body]]\nname = \"rod\"\nmass = 1\ninertia = [0.0833, 1e-4, 0.0833]\n\
         [[joint]]\nname = \"hinge\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [0, -1, 0]\n\
         first = {{ body = \"wall\" }}\nsecond = {{ body = \"rod\", point = [0, 0.5, 0] }}\n\
         angle_deg = {angle_deg:?}\n{more}"
    )
}

fn judged(folder: &Folder, args: &[&str]) -> (Option<i32>, Value) {
    let output = simulate(folder, &[args, &["--verify", "--json"]].concat());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let object = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{args:?}: {said}"));
    (output.status.code(), object)
}

/// A pulse of 0.9 ms, which steps of 10 ms step over: an impulse of 0.8 N·m·s, off by which no run is good.
#[test]
fn a_pulse_between_steps_is_seen_by_the_verdict() {
    let folder = Folder::new("pulse");
    let motor =
        "[inputs]\nu = 0\n[[force]]\nname = \"m\"\nkind = \"motor\"\njoint = \"hinge\"\nvalue = \"u\"\n";
    fs::write(folder.0.join("rod.toml"), rod(90.0, motor)).unwrap();
    let table = "t,u\n0,0\n0.1031,0\n0.1032,1000\n0.1039,1000\n0.1040,0\n1,0\n";
    fs::write(folder.0.join("u.csv"), table).unwrap();
    let fixed = ["--step", "0.01", "--correct-every", "0.01"];
    for engine in ["assembled", "jit"] {
        let run = ["rod.toml", "--engine", engine, "--input", "u=u.csv"];
        let (code, object) = judged(&folder, &[&run[..], &fixed].concat());
        assert_eq!((code, &object["verdict"]["grade"]), (Some(3), &"worthless".into()), "{engine}");
        // Steps under error control end at knots.
        let (code, object) = judged(&folder, &run);
        let hinge = &object["joints"]["hinge"];
        let [angle, rate] = ["position", "rate"].map(|key| hinge[key].as_f64().unwrap());
        assert!((angle + 1.4149).abs() < 1e-4 && (rate + 1.738).abs() < 1e-3, "{engine}: {hinge}");
        assert_eq!((code, &object["verdict"]["grade"]), (Some(0), &"good".into()), "{engine}");
    }
}

/// x = sin(2π t) / 2π, looked at once a period: what comes back at every sample has moved.
#[test]
fn a_motion_that_is_back_at_every_sample_is_not_held_against_nothing() {
    let folder = Folder::new("period");
    let page = "format = 1\nname = \"osc\"\n[simulation]\nt_end = 10\nsample_every = 1\n[[body]]\nname = \"wall\"\n\
        fixed = true\n[[body]]\nname = \"block\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\n[[joint]]\nname = \"rail\"\n\
        kind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = { body = \"wall\" }\n\
        second = { body = \"block\" }\nrate = 1\n[[force]]\nname = \"s\"\nkind = \"spring\"\njoint = \"rail\"\n\
        stiffness = \"(2*pi)^2\"\n";
    fs::write(folder.0.join("osc.toml"), page).unwrap();
    for more in [&[][..], &["--step", "1e-3", "--correct-every", "1e-3"]] {
        let (code, object) = judged(&folder, &[&["osc.toml", "--engine", "jit"], more].concat());
        assert_eq!((code, &object["verdict"]["grade"]), (Some(0), &"good".into()), "{more:?}: {object}");
        assert!(object["joints"]["rail"]["position"].as_f64().unwrap().abs() < 1e-6, "{object}");
    }
}

/// Upright and at rest: whether it falls is up to rounding, in each engine to another.
#[test]
fn an_unstable_equilibrium_is_named_by_every_engine() {
    let folder = Folder::new("upright");
    fs::write(folder.0.join("rod.toml"), rod(180.0, "[simulation]\nt_end = 12\n")).unwrap();
    for engine in ["assembled", "jit"] {
        let (code, object) = judged(&folder, &["rod.toml", "--engine", engine]);
        let verdict = object["verdict"].to_string();
        assert!(code == Some(4) && verdict.contains("unstable equilibrium"), "{engine}: {verdict}");
        assert!(object["joints"]["hinge"]["position"].is_number(), "{engine}: the run is told");
    }
    // Hanging, and leaning, it is judged as ever.
    for (angle, t_end) in [(0.0, "3"), (179.0, "1")] {
        fs::write(folder.0.join("rod.toml"), rod(angle, "")).unwrap();
        let (code, object) = judged(&folder, &["rod.toml", "--engine", "jit", "--t-end", t_end]);
        assert_eq!((code, &object["verdict"]["grade"]), (Some(0), &"good".into()), "{angle}: {object}");
    }
}

/// An end by an event, at a time that the companion has on the other side of a sample.
#[test]
fn an_end_by_an_event_beside_a_sample_is_compared() {
    let folder = Folder::new("beside");
    fs::write(folder.0.join("rod.toml"), rod(90.0, "")).unwrap();
    let fixed =
        ["rod.toml", "--engine", "jit", "--every", "0.1", "--step", "2e-2", "--correct-every", "2e-2"];
    // The angle at a sample, to the last digit.
    let at = json(&folder, &[&fixed[..], &["--t-end", "0.3"]].concat());
    let level = at["joints"]["hinge"]["position"].as_f64().unwrap();
    for off in [-1e-8, 0.0, 1e-8] {
        let event = format!("hinge<{:?}:stop", level + off);
        let (code, object) = judged(&folder, &[&fixed[..], &["--t-end", "1", "--event", &event]].concat());
        assert_eq!((code, &object["verdict"]["grade"]), (Some(0), &"good".into()), "{off}: {object}");
    }
}

/// An arm that turns by `t^12`, and a load that friction in its hinge carries along: in the first hundredth of a second
/// the arm turns by 1e-24 rad, of which no step makes an error that matters.
#[test]
fn a_run_in_which_hardly_anything_moves_is_not_worthless() {
    let folder = Folder::new("hardly");
    let page = "format = 1\nname = \"hardly\"\n[simulation]\nt_end = 0.01\nsample_every = 0.001\n[[body]]\nname = \"wall\"\n\
        fixed = true\n[[body]]\nname = \"arm\"\nmass = 1\ninertia = [0.1, 0.1, 0.1]\n[[body]]\nname = \"load\"\nmass = 1\n\
        inertia = [0.1, 0.1, 0.1]\n[[joint]]\nname = \"drive\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\n\
        first = { body = \"wall\" }\nsecond = { body = \"arm\" }\n[[joint]]\nname = \"idle\"\nkind = \"revolute\"\n\
        axis = [0, 0, 1]\nzero = [1, 0, 0]\ndamping = 0.1\nfirst = { body = \"arm\" }\nsecond = { body = \"load\" }\n\
        [[driver]]\nname = \"m\"\njoint = \"drive\"\nmotion = { polynomial = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1] }\n";
    fs::write(folder.0.join("hardly.toml"), page).unwrap();
    for end in ["0.01", "0.03", "2"] {
        let (code, object) = judged(&folder, &["hardly.toml", "--t-end", end]);
        assert_eq!((code, &object["verdict"]["grade"]), (Some(0), &"good".into()), "{end}: {object}");
    }
}
