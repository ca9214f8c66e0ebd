//! Every number of a model file and of the command line, drawn from all doubles.

use super::{Folder, double, fault, missing, written};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde_json::Value;

/// A model file that has a number in almost every place that there is.
const PAGE: &str = r#"
format = 1
name = "edges"
gravity = [0, -9.81, 0]
[simulation]
t_end = 0.2
step = 1e-3
sample_every = 0.05
correct_every = 1e-2
[parameters]
length = 0.5
[inputs]
push = 0.1
[[body]]
name = "ground"
fixed = true
[[body]]
name = "base"
driven = { translation = [{ polynomial = [0, 0.1] }, 0, { sinusoid = { amplitude = 0.1, frequency_hz = 2, phase = 0.3 } }] }
[[body]]
name = "rod"
mass = 1.5
inertia = [0.08, 1e-3, 0.08]
[[body]]
name = "bob"
mass = 0.7
inertia = [0.01, 0.012, 0.011]
[[body]]
name = "ball"
mass = 0.3
inertia = [0.01, 0.01, 0.01]
[[body]]
name = "bird"
free = true
mass = 0.4
inertia = [0.02, 0.03, 0.04]
position = [1, 2, 3]
orientation = [0.5, 0.5, 0.5, 0.5]
velocity = [0.1, 0.2, 0.3]
angular_velocity = [1, 2, 3]
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0, 0, 1]
zero = [0, -1, 0]
first = { body = "base", point = [0.1, 0, 0] }
second = { body = "rod", point = [0, "length", 0] }
angle_deg = 30
rate = 0.5
damping = 0.01
[[joint]]
name = "slide"
kind = "prismatic"
axis = [0, 1, 0]
zero = [1, 0, 0]
first = { body = "rod", point = [0, -0.4, 0] }
second = { body = "bob" }
displacement = 0.05
rate = -0.1
[[joint]]
name = "socket"
kind = "spherical"
first = { body = "ground", point = [2, 0, 0] }
second = { body = "ball", point = [0, 0.2, 0] }
orientation = [0.8, 0.6, 0, 0]
rate = [0.1, 0.2, 0.3]
[[force]]
name = "coil"
kind = "spring"
joint = "slide"
stiffness = 50
free = 0.01
[[force]]
name = "motor"
kind = "motor"
joint = "hinge"
value = "push"
[[force]]
name = "rope"
kind = "link"
first = { body = "ground", point = [0, 3, 0] }
second = { body = "bird", point = [0, 0, 0.1] }
stiffness = 5
damping = 0.2
free_length = 1.5
[[force]]
name = "wind"
kind = "load"
body = "ball"
force = [0.1, 0, 0.2]
torque = [0, 0.01, 0]
[[contact]]
name = "stop"
joint = "slide"
lower = -0.3
upper = 0.3
restitution = 0.4
friction = 0.05
static_friction = 0.06
[[output]]
name = "tip"
kind = "pose"
body = "bob"
point = [0, -0.1, 0]
"#;

/// Options that take a number.
const OPTIONS: [&str; 10] = [
    "--t-end",
    "--step",
    "--every",
    "--tolerance",
    "--correct-every",
    "--set=length",
    "--input=push",
    "--linearize",
    "--budget",
    "--event=hinge<",
];

/// The places of the numbers of a model file.
fn numbers(page: &str) -> Vec<(usize, usize)> {
    let bytes = page.as_bytes();
    let is_part = |byte: u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+' | b'e');
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        let starts = bytes[at].is_ascii_digit() || bytes[at] == b'-';
        if starts && matches!(bytes[at - 1], b' ' | b'[') {
            let end = at + bytes[at..].iter().take_while(|byte| is_part(**byte)).count();
            found.push((at, end));
            at = end;
        }
        at += 1;
    }
    found
}

/// A case of its number: a number in the file is another one, or one on the command line is.
fn case(random: &mut ChaCha8Rng) -> (String, Vec<String>) {
    let (mut page, mut args) = (PAGE.to_owned(), Vec::new());
    let places = numbers(PAGE);
    for _ in 0..random.random_range(1..=2) {
        let number = written(double(random));
        if random.random_bool(0.75) {
            let (from, to) = places[random.random_range(0..places.len())];
            // Places before it stay, those behind it are not used again.
            if page.len() == PAGE.len() {
                page.replace_range(from..to, &number);
            }
        } else {
            let option = OPTIONS[random.random_range(0..OPTIONS.len())];
            match option.split_once('=') {
                Some((option, "hinge<")) => args.extend([option.to_owned(), format!("hinge<{number}:stop")]),
                Some((option, name)) => args.extend([option.to_owned(), format!("{name}={number}")]),
                None => args.extend([option.to_owned(), number]),
            }
        }
    }
    let engines: [&[&str]; 4] = [
        &["--engine", "jit"],
        &["--engine", "jit", "--coordinates", "joint", "--method", "rk4"],
        &["--engine", "jit", "--precision", "f32"],
        &["--engine", "jit", "--verify"],
    ];
    args.extend(engines[random.random_range(0..engines.len())].iter().map(|word| (*word).to_owned()));
    (page, args)
}

/// Values of the summary that are null where there is nothing to say.
const OPTIONAL: [&str; 8] =
    [".tolerance", ".step", ".rates", ".verdict", ".files", ".poses_passed", ".linearization", ".from"];

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn every_double_in_every_place_gets_an_answer() {
    assert_eq!(numbers(PAGE).len(), 108, "the places of numbers");
    let folder = Folder::new("numbers");
    let mut counts = [0; 5];
    for index in 0..300 {
        let mut random = ChaCha8Rng::seed_from_u64(40_008);
        random.set_stream(index);
        let (page, args) = case(&mut random);
        folder.write("edges.toml", &page);
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        // Steps that would take long are too many for this budget.
        let budget: &[&str] = if args.contains(&"--budget") { &[] } else { &["--budget", "2000"] };
        let prove: &[&str] = if index % 4 == 0 { &[] } else { &["--no-prove"] };
        let command = &["simulate", "edges.toml", "--json", "--quiet"];
        let output = folder.gyro(&[command, prove, budget, &args].concat());
        let told = || {
            let changed = page.lines().zip(PAGE.lines()).filter(|(own, old)| own != old).map(|(own, _)| own);
            format!("case {index}: {args:?}, {:?}", changed.collect::<Vec<_>>())
        };
        if let Some(fault) = fault(output.as_ref()) {
            panic!("{}: {fault}", told());
        }
        let output = output.unwrap();
        let code = usize::try_from(output.status.code().unwrap()).unwrap();
        counts[code] += 1;
        if code == 0 {
            let mut object: Value = serde_json::from_slice(&output.stdout).unwrap();
            if !prove.is_empty() {
                object.as_object_mut().unwrap().remove("proof");
            }
            let missing = missing(&object, "");
            let is_fault =
                missing.as_ref().is_some_and(|path| !OPTIONAL.iter().any(|own| path.contains(own)));
            assert!(!is_fault, "{}: {missing:?} in {object}", told());
        }
        assert_eq!(folder.files(), ["edges.toml"], "{}", told());
    }
    println!("codes 0 to 4: {counts:?}");
    assert!(counts[0] > 50 && counts[2] > 50, "{counts:?}");
}
