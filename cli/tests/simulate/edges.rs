//! Laws at their edges: where they have no value, and where they are not smooth.

use crate::laws::ROTOR;
use crate::support::{Folder, json, simulate};
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
    let output = simulate(&folder, &[&["page.toml", "--t-end", "3", "--json"], options].concat());
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
