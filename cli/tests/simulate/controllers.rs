//! Controllers of model files: random linear plants in random loops, and what they do not go with.

use crate::plants::{Law, Loop, Plant, WHEEL, difference, exact};
use crate::support::{Folder, json, model, refused, simulate, xtask};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::fs;

const METHODS: [&[&str]; 6] = [
    &["--engine", "jit", "--integrator", "tsit5", "--tolerance", "1e-11", "--coordinates", "joint"],
    &["--engine", "jit", "--integrator", "dop853", "--tolerance", "1e-12", "--coordinates", "joint"],
    &["--engine", "jit", "--integrator", "rodas4", "--tolerance", "1e-9", "--coordinates", "joint"],
    &["--engine", "jit", "--integrator", "dop853", "--tolerance", "1e-12", "--coordinates", "maximal"],
    &[
        "--engine",
        "assembled",
        "--integrator",
        "tsit5",
        "--tolerance",
        "1e-11",
        "--correction",
        "mass-weighted",
    ],
    &["--engine", "assembled", "--integrator", "dop853", "--tolerance", "1e-12", "--correction", "none"],
];

/// What methods at these tolerances are right to, of motions of the size of one.
const CLOSE: f64 = 1e-8;

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_plants_in_random_loops_move_as_matrix_exponentials_say() {
    let folder = Folder::new("random-loops");
    let mut random = ChaCha8Rng::seed_from_u64(24);
    let mut kinds = [0; 3];
    for case in 0..24 {
        let plant = Plant::random(&mut random);
        let mut motors: Vec<usize> = (0..plant.n()).collect();
        let mut loops = Vec::new();
        while !motors.is_empty() && loops.len() < 2 {
            let split = random.random_range(1..=motors.len());
            let sets = motors.drain(..split).collect();
            loops.push(Loop::random(&mut random, &plant, sets));
        }
        for one in &loops {
            kinds[match one.law {
                Law::Pid(_) => 0,
                Law::StateFeedback(_) => 1,
                Law::TransferFunction(..) => 2,
            }] += 1;
        }
        let file = format!("plant-{case}.toml");
        fs::write(folder.0.join(&file), plant.text(&loops, 0.777)).unwrap();
        let expected = exact(&plant, &loops, 777);
        let found = json(&folder, &[&[&file[..]], METHODS[case % METHODS.len()]].concat());
        let error = difference(&found, &expected);
        assert!(error < CLOSE, "case {case}: {error:e}\n{plant:?}\n{loops:?}\n{expected:?}");
    }
    assert!(kinds.iter().all(|count| *count > 3), "each kind of law: {kinds:?}");
}

/// Without limits, converters and random numbers: two controllers at several periods, one of them late.
pub(super) fn smooth() -> (Plant, Vec<Loop>) {
    let mut plants = (0..).map(|seed| Plant::random(&mut ChaCha8Rng::seed_from_u64(seed)));
    let plant = plants.find(|plant| plant.n() == 3).unwrap();
    let free = |law, period, tenths, sees, sets: Vec<usize>| {
        let setpoints = vec![0.3; Vec::len(&sees)];
        Loop { law, period, tenths, sees, sets, setpoints, limits: None, steps: [0.0; 2] }
    };
    let rows = vec![vec![0.5, 0.25, -0.5], vec![0.0, 1.0, 0.125]];
    let loops = vec![
        free(Law::Pid([3.0, 5.0, 0.1]), [3, 100], 4, vec![2], vec![1]),
        free(Law::StateFeedback(rows), [2, 100], 10, vec![0, 1, 6], vec![0, 2]),
    ];
    (plant, loops)
}

/// Steps of which the periods are multiples keep their order.
#[test]
fn with_fixed_steps_runs_converge_to_the_exact_motion() {
    let folder = Folder::new("fixed-step-loops");
    let (plant, mut loops) = smooth();
    loops[0].tenths = 0;
    fs::write(folder.0.join("plant.toml"), plant.text(&loops, 0.6)).unwrap();
    let expected = exact(&plant, &loops, 600);
    let fixed = ["plant.toml", "--engine", "jit", "--coordinates", "joint", "--every", "0.6", "--step"];
    let error = |step| difference(&json(&folder, &[&fixed[..], &[step]].concat()), &expected);
    let errors = ["1e-2", "5e-3"].map(error);
    assert!(errors[0] < 1e-5 && errors[1] < errors[0] / 12.0 && errors[1] > errors[0] / 20.0, "{errors:?}");
    // At instants that are no ends of steps controllers are late by a part of a step.
    let late = error("7e-4");
    assert!(late > 1e-6 && late < 1e-2, "{late:e}");
}

#[test]
fn the_table_has_inputs_as_controllers_set_them() {
    let folder = Folder::new("table-of-loops");
    let (plant, loops) = smooth();
    fs::write(folder.0.join("plant.toml"), plant.text(&loops, 0.2)).unwrap();
    let method =
        ["--engine", "jit", "--integrator", "dop853", "--tolerance", "1e-12", "--coordinates", "joint"];
    let output =
        simulate(&folder, &[&["plant.toml", "--every", "0.005", "--out", "out"], &method[..]].concat());
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("input push_1: set by controller loop_0"), "{said}");
    let text = fs::read_to_string(folder.0.join("out/sledges.csv")).unwrap();
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let columns: Vec<usize> = (0..plant.n())
        .map(|k| head.iter().position(|name| *name == format!("push_{k} [N]")).unwrap())
        .collect();
    let mut seen = 0;
    for (row, line) in lines.enumerate() {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let (_, forces) = exact(&plant, &loops, 5 * row as u64);
        for (column, force) in columns.iter().zip(forces) {
            assert!((cells[*column] - force).abs() < 1e-9, "row {row}: {} for {force}", cells[*column]);
        }
        seen += 1;
    }
    assert_eq!(seen, 41);
}

#[test]
fn what_controllers_do_not_go_with_is_refused_or_said() {
    let folder = Folder::new("loops-refused");
    let page = format!("{WHEEL}[[event]]\nname = \"round\"\nof = \"shaft\"\nlevel = 6\nstop = true\n");
    fs::write(folder.0.join("wheel.toml"), page).unwrap();
    let run = |args: &[&str]| simulate(&folder, &[&["wheel.toml", "--engine", "jit"], args].concat());
    refused(&run(&["--input", "torque=1"]), "the controller `hold` sets this input");
    refused(&run(&["--step", "0.1"]), "longer than the period of a controller");
    let exported = xtask(&folder, &["export", "c", "wheel.toml", "--out", "c"]);
    let said = String::from_utf8_lossy(&exported.stderr);
    assert!(exported.status.success(), "{said}");
    for left_out in ["controller `hold`: what it sets, `torque`", "event `round`: nothing ends there"] {
        assert!(said.contains(left_out), "{left_out}: {said}");
    }
}

/// The camera is held still in space while the vehicle moves.
#[test]
fn the_stabilised_gimbal_is_still_in_space() {
    let folder = Folder::new("gimbal");
    let page = model("stabilised-gimbal.toml");
    let method =
        ["--engine", "jit", "--integrator", "dop853", "--tolerance", "1e-8", "--coordinates", "joint"];
    let rates = |extra: &[&str]| {
        // A third of a second after a bearing has stuck.
        let run = json(&folder, &[&[&page[..], "--t-end", "0.9"], &method[..], extra].concat());
        [4, 5].map(|k| run["outputs"]["gyro"][k].as_f64().unwrap().abs())
    };
    let (held, loose) = (rates(&[]), rates(&["--set", "bandwidth=0"]));
    assert!(held.iter().all(|rate| *rate < 5e-3), "{held:?}");
    assert!(loose.iter().any(|rate| *rate > 0.05), "{loose:?}");
}

/// A cart of 2 kg with a spring of 3 N/m that is written in its one motor, beside the inputs of two controllers: one
/// follows a formula of time, the other, of the rate, what an outer loop wants. Between samples it swings as a cosine.
#[test]
fn set_points_follow_formulas_and_outer_loops() {
    let page = "format = 1\nname = \"cart\"\n[inputs]\npush = 0.25\nwanted = 0\nhold = 0\n[parameters]\nk = 3\n[[body]]\n\
        name = \"ground\"\nfixed = true\n[[body]]\nname = \"cart\"\nmass = 2\ninertia = [1, 1, 1]\n[[joint]]\n\
        name = \"rail\"\nkind = \"prismatic\"\naxis = [1, 0, 0]\nzero = [0, 1, 0]\nfirst = { body = \"ground\" }\n\
        second = { body = \"cart\" }\ndisplacement = 0.5\nrate = -0.2\n[[force]]\nname = \"motor\"\nkind = \"motor\"\n\
        joint = \"rail\"\nvalue = \"push + 2*hold - k*rail\"\n[[controller]]\nname = \"outer\"\nkind = \"pid\"\nkp = 1.5\n\
        outputs = [\"rail\"]\ninputs = [\"wanted\"]\nperiod = 0.04\nsetpoint = \"0.3*sin(2*t) + k/30\"\n[[controller]]\n\
        name = \"inner\"\nkind = \"pid\"\nkp = 4\noutputs = [\"rail rate\"]\ninputs = [\"hold\"]\nperiod = 0.01\n\
        setpoint = \"wanted - 0.1*rail\"\n[[controller]]\nname = \"other\"\nkind = \"state_feedback\"\n\
        outputs = [\"rail\", \"rail rate\"]\ninputs = [\"push\"]\ngains = [[1, 0.5]]\nperiod = 0.02\n\
        setpoint = [0.2, \"-0.2*t\"]\n";
    let (mut x, mut v, mut wanted, mut push) = (0.5, -0.2, 0.0, 0.0);
    let (frequency, t_end) = (1.5_f64.sqrt(), 200);
    for k in 0..t_end {
        let t = 0.01 * f64::from(k);
        let before = wanted;
        if k % 4 == 0 {
            wanted = 1.5 * (0.3 * (2.0 * t).sin() + 0.1 - x);
        }
        let hold = 4.0 * (before - 0.1 * x - v);
        if k % 2 == 0 {
            push = (0.2 - x) + 0.5 * (-0.2 * t - v);
        }
        let rest = (push + 2.0 * hold) / 3.0;
        let (sine, cosine) = (frequency * 0.01).sin_cos();
        (x, v) =
            (rest + (x - rest) * cosine + v / frequency * sine, v * cosine - (x - rest) * frequency * sine);
    }
    let folder = Folder::new("setpoints");
    fs::write(folder.0.join("cart.toml"), page).unwrap();
    let ways: [&[&str]; 3] = [&[], &["--coordinates", "maximal"], &["--engine", "assembled"]];
    for options in ways {
        let scene = ["cart.toml", "--t-end", "2", "--integrator", "dop853", "--tolerance", "1e-12"];
        let run = json(&folder, &[&scene, options].concat());
        for (key, expected) in [("position", x), ("rate", v)] {
            let found = run["joints"]["rail"][key].as_f64().unwrap();
            assert!((found - expected).abs() < 1e-10, "{options:?}: {key} {found} for {expected}");
        }
    }
    let linear = json(&folder, &["cart.toml", "--linearize", "0"]);
    let words = linear["linearization"]["closed_loop"]["none"].to_string();
    assert!(words.contains("a set point of `inner` depends on the motion"), "{linear}");
}
