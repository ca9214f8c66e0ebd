//! Laws at their edges: where they have no value, and where they are not smooth.

use crate::laws::{ROTOR, end, run};
use crate::support::{Folder, json, simulate};
use serde_json::{Value, json};
use std::f64::consts::PI;
use std::fs;

/// A slider of 2 kg along x without weight, that comes towards the wall.
const SLIDER: &str = "format = 1\nname = \"slider\"\n[parameters]\nrest = 2\n[inputs]\npull = 0.25\n[[body]]\nname = \"ground\"\n\
    fixed = true\n[[body]]\nname = \"cart\"\nmass = 2\ninertia = [1, 1, 1]\n[[joint]]\nname = \"rail\"\nkind = \"prismatic\"\n\
    axis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = { body = \"ground\" }\nsecond = { body = \"cart\" }\n\
    displacement = 2.5\nrate = -1\n";

const RUNS: [&[&str]; 6] = [
    &["--integrator", "dop853", "--tolerance", "1e-9"],
    &["--coordinates", "maximal", "--integrator", "tsit5", "--tolerance", "1e-7"],
    &["--integrator", "rodas4", "--tolerance", "1e-6"],
    &["--method", "rk4", "--step", "1e-3"],
    &["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-9"],
    &["--engine", "assembled", "--method", "rk4", "--step", "1e-3"],
];

/// What a run says that fails.
fn failure(page: &str, options: &[&str]) -> String {
    let folder = Folder::new(&format!("edges-{:x}", page.len() * 31 + options.join("").len()));
    fs::write(folder.0.join("page.toml"), page).unwrap();
    let end: &[&str] = if options.contains(&"--t-end") { &[] } else { &["--t-end", "3"] };
    let output = simulate(&folder, &[&["page.toml", "--json"], options, end].concat());
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        output.status.code(),
        Some(1),
        "{options:?}: {words}{}",
        String::from_utf8_lossy(&output.stdout)
    );
    words
}

/// The value that is told of a name.
fn told(words: &str, name: &str) -> f64 {
    let (_, rest) = words.split_once(&format!("{name} = ")).unwrap_or_else(|| panic!("{name}: {words}"));
    let number: String = rest.chars().take_while(|c| c.is_ascii_digit() || "-.e".contains(*c)).collect();
    number.trim_end_matches('.').parse().unwrap_or_else(|_| panic!("{number}: {words}"))
}

fn check(page: &str, expected: &str, (name, range): (&str, std::ops::Range<f64>)) {
    for options in RUNS {
        let words = failure(page, options);
        assert!(words.contains(expected), "{options:?}: {words}");
        let value = told(words.split_once(expected).unwrap().1, name);
        assert!(range.contains(&value), "{options:?}: {words}");
    }
}

#[test]
fn a_force_without_a_value_is_named() {
    let wire = format!(
        "{SLIDER}[[force]]\nname = \"wire\"\nkind = \"link\"\nfirst = {{ body = \"ground\" }}\nsecond = {{ body = \"cart\" }}\n\
         tension = \"sqrt(length - rest)\"\n"
    );
    let place = "the tension of force `wire` has no value: it is \"sqrt(length - rest)\"";
    check(&wire, place, ("length", 1.99..2.0));
    let words = failure(&wire, RUNS[0]);
    assert_eq!(told(&words, "rest"), 2.0, "{words}");
    let motor = |law: &str| {
        format!("{SLIDER}[[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"rail\"\nvalue = {law:?}\n")
    };
    let root = "ln(rail - 2)*pull";
    check(&motor(root), "the value of force `law` has no value", ("rail", 1.99..2.000_001));
    assert_eq!(told(&failure(&motor(root), RUNS[3]), "pull"), 0.25);
    // What is not taken is of no matter.
    let folder = Folder::new("edges-guarded");
    fs::write(folder.0.join("page.toml"), motor("if(rail > 2, sqrt(rail - 2), 0)")).unwrap();
    json(&folder, &["page.toml", "--t-end", "3"]);
}

#[test]
fn a_named_formula_without_a_value_is_told_with_who_names_it() {
    let page = format!(
        "{SLIDER}[[formula]]\nname = \"depth\"\nof = \"asin(0.8*(rail - 1.7))\"\n[[formula]]\nname = \"more\"\nof = \"2*depth\"\n\
         [[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"rail\"\nvalue = \"-0.01*more - 0.1\"\n"
    );
    let expected =
        "where the formula `more` is \"2*depth\", where the formula `depth` is \"asin(0.8*(rail - 1.7))\"";
    check(&page, expected, ("rail", 0.43..0.45));
}

#[test]
fn states_and_curves_without_a_value_are_named() {
    let state = format!("{ROTOR}[[state]]\nname = \"heat\"\nstart = 1\nrate = \"-sqrt(heat - turn/10)\"\n");
    check(&state, "the rate of state `heat` has no value", ("heat", 0.0..1.0));
    let curve = format!(
        "{SLIDER}[[curve]]\nname = \"bump\"\npoints = [[2, 0], [2.4, 0.1], [3, 0.2]]\nbeyond = \"error\"\n[[force]]\n\
         name = \"law\"\nkind = \"motor\"\njoint = \"rail\"\nvalue = \"-bump(rail)\"\n"
    );
    check(&curve, "it is \"-bump(rail)\"", ("rail", 1.99..2.0));
}

#[test]
fn motions_and_couplers_without_a_value_are_named() {
    let motion =
        format!("{ROTOR}[[driver]]\nname = \"drive\"\njoint = \"turn\"\nmotion = \"0.1*sqrt(2 - t)\"\n")
            .replace("angle = 0.4\nrate = 1.5\n", "");
    check(&motion, "the motion of driver `drive` has no value", ("t", 1.999..2.01));
    let coupler = format!(
        "{ROTOR}[[body]]\nname = \"arm\"\nmass = 1\ninertia = [1, 1, 1]\n[[joint]]\nname = \"lift\"\nkind = \"prismatic\"\n\
         axis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {{ body = \"ground\" }}\nsecond = {{ body = \"arm\" }}\n[[coupler]]\n\
         name = \"cam\"\nsecond = {{ joint = \"lift\" }}\nformula = \"0.1*sqrt(2.5 - turn)\"\n"
    );
    check(&coupler, "coupler `cam` has no value", ("turn", 2.4..2.52));
}

#[test]
fn outputs_without_a_value_are_told_and_events_of_them_end_runs() {
    let page = format!("{SLIDER}[[output]]\nname = \"root\"\nkind = \"formula\"\nof = \"sqrt(rail - 2)\"\n");
    let folder = Folder::new("edges-output");
    fs::write(folder.0.join("page.toml"), &page).unwrap();
    let run = json(&folder, &["page.toml", "--t-end", "1"]);
    let warning = run["warnings"][0].as_str().unwrap();
    assert!(warning.contains("Output `root` has no value at t = 0.50"), "{warning}");
    let event = format!("{page}[[event]]\nname = \"far\"\nof = \"sqrt(rail - 2) - 0.1\"\n");
    check(&event, "event `far` has no value: it is \"sqrt(rail - 2) - 0.1\"", ("rail", -1.0..2.0));
}

#[test]
fn kinks_are_named_and_counted() {
    // A mass on a spring, without loss: sixteen passages of the middle in eight periods of 2 s.
    let page = format!(
        "{ROTOR}[[formula]]\nname = \"away\"\nof = \"abs(turn)\"\n[[force]]\nname = \"spring\"\nkind = \"motor\"\njoint = \"turn\"\n\
         value = \"-0.5*pi^2*turn + 0*min(turn, 5) + 0*away*u\"\n[[force]]\nname = \"stop\"\nkind = \"motor\"\njoint = \"turn\"\n\
         damping = \"if(turn rate > 100 and t <= 1000, floor(t), 0)\"\n"
    );
    let page = page.replace("damping", "value");
    let folder = Folder::new("edges-kinks");
    fs::write(folder.0.join("page.toml"), page).unwrap();
    let run = json(&folder, &["page.toml", "--method", "rk4", "--step", "1e-3", "--t-end", "15.9"]);
    // And fifteen whole numbers of t.
    assert_eq!(run["kinks_crossed"].as_u64(), Some(16 + 15), "{run}");
    let output = simulate(&folder, &["page.toml", "--method", "rk4", "--step", "1e-3", "--t-end", "1"]);
    let words = String::from_utf8(output.stdout).unwrap();
    assert!(words.contains("kinks of laws crossed"), "{words}");
    let code = fs::read_to_string(folder.0.join("out/rotor/rotor.rs")).unwrap();
    let expected = [
        "//! * not smooth: force `spring` where turn = 5, turn = 0 in formula `away`\n",
        "//! * not smooth: force `stop` where turn rate = 100, t = 1000, t is whole\n",
    ];
    assert!(expected.iter().all(|line| code.contains(line)), "{}", &code[..2000]);
}

#[test]
fn distances_tell_of_kinks_as_coordinates_do() {
    // Both laws have the same kinks, in one of which there is a body that turns.
    let page = |law: &str| {
        format!(
            "{ROTOR}[[force]]\nname = \"wire\"\nkind = \"link\"\nfirst = {{ body = \"ground\", point = [1, 0, 0] }}\n\
             second = {{ body = \"wheel\", point = [0.5, 0, 0] }}\ntension = \"{law}\"\n"
        )
    };
    let laws = ["max(length - 0.8, 0)", "max(sqrt(1.25 - cos(pi/2 + spin)) - 0.8, 0)"];
    let formula = "[[formula]]\nname = \"spin\"\nof = \"turn - pi/2\"\n";
    let counts = laws.map(|law| {
        let folder = Folder::new(&format!("edges-distance-{}", law.len()));
        fs::write(folder.0.join("page.toml"), format!("{}{formula}", page(law))).unwrap();
        let run = json(&folder, &["page.toml", "--method", "rk4", "--step", "1e-3", "--t-end", "20"]);
        run["kinks_crossed"].as_u64().unwrap()
    });
    assert!(counts[0] > 3 && counts[0] == counts[1], "{counts:?}");
}

const MOTOR: &str = "[[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"turn\"\n";

/// All ways in which steps are controlled, with how far each may be off after 20 s.
const CONTROLLED: [(&[&str], f64); 6] = [
    (&["--integrator", "dop853", "--tolerance", "1e-9"], 5e-8),
    (&["--integrator", "dop853", "--tolerance", "1e-12"], 5e-11),
    (&["--integrator", "tsit5", "--tolerance", "1e-7"], 2e-5),
    (&["--integrator", "rodas4", "--tolerance", "1e-7"], 1e-4),
    (&["--coordinates", "maximal", "--integrator", "dop853", "--tolerance", "1e-9"], 5e-8),
    (&["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-9"], 5e-8),
];

/// The angle from 0.4 rad at 1.5 rad/s where ω is 2 above 0.1 rad and another below: half turns of either, in turn.
fn by_halves(below: f64, t: f64) -> [f64; 2] {
    let (x, v) = (0.3_f64, 1.5_f64);
    let (speed, phase) = (v.hypot(2.0 * x), (2.0 * x).atan2(v));
    let halves = [PI / 2.0, PI / below];
    let since = (t + phase / 2.0) % (halves[0] + halves[1]);
    let (omega, sign, since) =
        if since < halves[0] { (2.0, 1.0, since) } else { (below, -1.0, since - halves[0]) };
    let (sin, cos) = (omega * since).sin_cos();
    [0.1 + sign * speed / omega * sin, sign * speed * cos]
}

/// How far a run is off, and its figures.
fn off(page: &str, options: &[&str], expected: [f64; 2]) -> (f64, Value) {
    let run = run(page, options, "20");
    let [x, v, _] = end(&run);
    ((x - expected[0]).abs().max((v - expected[1]).abs()), run)
}

#[test]
fn steps_end_at_kinks_and_runs_are_as_exact_as_without() {
    let curve =
        "[[curve]]\nname = \"line\"\npoints = [[-2, 26.25], [0.1, 0], [3, -5.8]]\nbetween = \"linear\"\n";
    let laws = [
        ("", "-0.5*(14.5*(turn - 0.1) - 10.5*abs(turn - 0.1))"),
        ("", "0.5*max(-4*(turn - 0.1), -25*(turn - 0.1))"),
        ("", "-0.5*(turn - 0.1)*if(turn >= 0.1, 4, 25)"),
        (curve, "line(turn)"),
    ];
    // Beside a stop that is never reached too.
    let stop = "[[contact]]\nname = \"far\"\njoint = \"turn\"\nupper = 9\nrestitution = 0.5\n";
    for (rest, law) in laws {
        for (options, bound) in CONTROLLED {
            let page = format!("{ROTOR}{rest}{MOTOR}value = {law:?}\n");
            let (error, run) = off(&page, options, by_halves(5.0, 20.0));
            assert!(error < bound, "{law} {options:?}: {error}");
            assert_eq!(run["kinks_crossed"].as_u64(), Some(18), "{law} {options:?}: {run}");
            assert_eq!(run["warnings"].as_array().unwrap().len(), 0);
        }
        let (error, run) = off(
            &format!("{ROTOR}{rest}{stop}{MOTOR}value = {law:?}\n"),
            CONTROLLED[0].0,
            by_halves(5.0, 20.0),
        );
        assert!(error < CONTROLLED[0].1 && run["kinks_crossed"].as_u64() == Some(18), "{law}: {error} {run}");
    }
    let smooth = format!("{ROTOR}{MOTOR}value = \"-2*(turn - 0.1)\"\n");
    for (options, bound) in CONTROLLED {
        let (error, run) = off(&smooth, options, by_halves(2.0, 20.0));
        assert!(error < bound && run["kinks_crossed"].is_null(), "{options:?}: {error}");
    }
}

#[test]
fn steps_that_end_at_kinks_are_fewer() {
    // The root of a square has the same kink, but none that the text names.
    let page = |size: &str| format!("{ROTOR}{MOTOR}value = \"-7.25*(turn - 0.1) + 5.25*{size}\"\n");
    for (options, bound) in [CONTROLLED[0], CONTROLLED[1], CONTROLLED[2], CONTROLLED[4], CONTROLLED[5]] {
        let [named, hidden] = ["abs(turn - 0.1)", "sqrt((turn - 0.1)^2)"].map(|size| {
            let (error, run) = off(&page(size), options, by_halves(5.0, 20.0));
            assert!(error < bound || size.starts_with("sqrt"), "{size} {options:?}: {error}");
            ["rejected_steps", "steps", "evaluations"].map(|key| run[key].as_u64().unwrap())
        });
        assert!(2 * named[0] < hidden[0], "{options:?}: {named:?} {hidden:?}");
        assert!(named[1] < hidden[1] && named[2] < hidden[2], "{options:?}: {named:?} {hidden:?}");
    }
}

#[test]
fn steps_end_at_jumps_in_space_and_in_time() {
    // Parabolas on either side, passed at the same speed each time.
    let speed = (1.5_f64 * 1.5 + 2.0 * 0.8 * 0.4).sqrt();
    let half = 2.0 * speed / 0.8;
    let since = 20.0 + (speed - 1.5) / 0.8;
    let (sign, since) = (if (since / half).floor() % 2.0 == 0.0 { 1.0 } else { -1.0 }, since % half);
    let expected = [sign * (speed - 0.4 * since) * since, sign * (speed - 0.8 * since)];
    let page = format!("{ROTOR}{MOTOR}value = \"-0.4*sign(turn)\"\n");
    for (options, bound) in CONTROLLED {
        let (error, run) = off(&page, options, expected);
        assert!(error < bound, "{options:?}: {error}");
        assert_eq!(run["kinks_crossed"].as_u64(), Some((20.0 / half) as u64), "{options:?}: {run}");
    }
    // Two radians per second² more each second.
    let page = format!("{ROTOR}{MOTOR}value = \"floor(t)\"\n");
    let rates = (0..20).map(|k| 2.0 * f64::from(k));
    let ahead = (0..20).map(|k| 2.0 * f64::from(k) * (19.5 - f64::from(k)));
    let expected = [0.4 + 20.0 * 1.5 + ahead.sum::<f64>(), 1.5 + rates.sum::<f64>()];
    for (options, bound) in CONTROLLED {
        let (error, run) = off(&page, options, expected);
        assert!(error < 1e3 * bound, "{options:?}: {error}");
        assert!(run["kinks_crossed"].as_u64().unwrap() >= 19, "{options:?}: {run}");
    }
}

#[test]
fn motions_that_stay_at_kinks_end_in_bounded_time() {
    // Friction by a sign, that would hold.
    let page = format!("{ROTOR}{MOTOR}value = \"-0.4*sign(turn rate) - 0.1*turn\"\n");
    for options in [CONTROLLED[0].0, CONTROLLED[2].0, CONTROLLED[5].0] {
        let words = failure(&page, &[options, &["--t-end", "20"]].concat());
        let expected = "the motion stays where a law is not smooth: force `law` where turn rate = 0";
        assert!(words.contains(expected) && words.contains("[[contact]]"), "{options:?}: {words}");
    }
    // What is within reach is computed all the same, and told of.
    let run = run(&page, CONTROLLED[0].0, "1.457");
    let warning = run["warnings"][0].as_str().unwrap();
    assert!(warning.contains("on the motion stays where a law is not smooth: force `law`"), "{warning}");
    assert!(end(&run)[1].abs() < 1e-8, "{run}");
    // What comes to rest at a kink stays there in long steps.
    let page = format!("{ROTOR}{MOTOR}value = \"-0.5*abs(turn rate)*turn rate - 0.1*turn rate - turn\"\n");
    for options in [CONTROLLED[0].0, CONTROLLED[3].0, CONTROLLED[4].0] {
        let run = crate::laws::run(&page, options, "1000");
        assert!(
            run["steps"].as_u64().unwrap() < 10_000 && run["warnings"] == json!([]),
            "{options:?}: {run}"
        );
    }
}
